"""Discrete foundation of independent springs with slip memory, Eqs. (5.4)-(5.9), step by step.

A spring at x carries q = E* (d - g(x)) per length while d > g(x). Its tangential load follows the
displacement, q_x' = q_x + G* (u' - u), and is clipped at mu q (Eq. 5.9); the excess is slip. During
a straight load step all of these change linearly in time, so that the final state, the work and the
dissipated energy of each spring follow in closed form.

The only error is that of the sum over springs. Their positions are midpoints of a coordinate in
which g is smooth between its breaks, so the error decreases with the square of their number. The
order is limited to that because q_x has kinks at former slip fronts.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from mpmath import mp, mpf

from tests.oracles.shapes import kappa
from tests.oracles.slip_reference import WORK_DIGITS, ShapeBody

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from tests.oracles.slip_reference import Material

    Array = NDArray[np.float64]

Profile = dict[str, Any]

#: x = a t^2 at a tip, so that the midpoint rule keeps its order for r^n down to n = 1/2.
GRADING = 2.0


@dataclass(frozen=True)
class Foundation:
    """Springs: the depth g(x) of first contact of each, and its length.

    The length covers both sides of the axis. All springs under a flat are identical and form one.
    """

    first_contact_depth: Array
    length: Array


def foundation(profile: Mapping[str, Any], depth: float, count: int) -> Foundation:
    """About `count` springs for every contact not deeper than `depth`."""
    if profile["kind"] == "flat_punch":
        return Foundation(np.zeros(1), np.array([2 * profile["radius"]]))
    with mp.workdps(WORK_DIGITS):
        body = ShapeBody(profile)
        edge = float(body.radius("indentation_depth", mpf(depth)))
        flat = float(body.b) if body.blunt else 0.0
        knots = [0.0, *(k for k in [float(body.b)] if 0 < k < edge), edge]
    first_contact_depth, length = [], []
    for low, high in itertools.pairwise(knots):
        if high <= flat:
            continue
        end = np.sqrt((high - low) * (high + low))
        number = max(count // (len(knots) - 1), 1)
        grading = GRADING if low == 0 else 1.0
        # x(t) at midpoints of t; the length is dx/dt there, as required by the midpoint rule.
        t = (np.arange(number) + 0.5) / number
        middle = end * t**grading
        rate = grading * end * t ** (grading - 1) / number
        x = np.hypot(low, middle)
        first_contact_depth.append(equivalent_profile(profile, x, middle, low))
        length.append(2 * rate * middle / x)
    if flat:
        first_contact_depth.append(np.zeros(1))
        length.append(np.array([2 * flat]))
    return Foundation(np.concatenate(first_contact_depth), np.concatenate(length))


def equivalent_profile(profile: Mapping[str, Any], x: Array, s: Array, low: float) -> Array:
    """g at the radii x = sqrt(low^2 + s^2); `low` is the break at or below them."""
    kind = profile["kind"]
    if kind in _POWERS:
        return sum((c * float(kappa(mpf(n))) * x**n for c, n in _POWERS[kind](profile)), 0 * x)
    return _EQUIVALENT_PROFILES[kind](profile, x, s, np.arctan2(s, low), low > 0)


_POWERS = {
    "paraboloid": lambda p: [(1 / (2 * p["radius"]), 2.0)],
    "cone": lambda p: [(p["slope"], 1.0)],
    "power": lambda p: [(p["coefficient"], p["exponent"])],
    "series": lambda p: [(t["coefficient"], t["exponent"]) for t in p["terms"]],
}


def _ellipsoid(radius: float, height: float, x: Array) -> Array:
    return height / radius * x * np.arctanh(x / radius)


def _spherical_tip(p: Profile, x: Array, s: Array, phi: Array) -> Array:
    big, t = p["tip_radius"], p["slope"]
    return x * (np.log((big + x) / (big / np.hypot(1, t) + s)) + t * phi)


#: (profile, x, s, angle, whether beyond the break) -> g, for kinds that are not sums of powers.
_EQUIVALENT_PROFILES: dict[str, Any] = {
    "sphere": lambda p, x, s, phi, far: _ellipsoid(p["radius"], p["radius"], x),
    "ellipsoid": lambda p, x, s, phi, far: _ellipsoid(p["radius"], p["height"], x),
    "hyperboloid": lambda p, x, s, phi, far: (
        p["slope"] * x * np.arctan(x / (p["tip_radius"] * p["slope"]))
    ),
    "rounded_punch": lambda p, x, s, phi, far: (
        x * (s - p["flat_radius"] * phi) / p["rounding_radius"]
    ),
    "truncated_cone": lambda p, x, s, phi, far: p["slope"] * x * phi,
    "truncated_paraboloid": lambda p, x, s, phi, far: x * s / p["radius"],
    "rounded_cone": lambda p, x, s, phi, far: (
        p["slope"] * x * (p["tip_radius"] * p["slope"] / (x + s) + phi)
        if far
        else x**2 / p["tip_radius"]
    ),
    "spherical_tip_cone": lambda p, x, s, phi, far: (
        _spherical_tip(p, x, s, phi) if far else _ellipsoid(p["tip_radius"], p["tip_radius"], x)
    ),
    "capped_paraboloid": lambda p, x, s, phi, far: (
        x**2 / p["tip_radius"] + (x * s * (1 / p["radius"] - 1 / p["tip_radius"]) if far else 0 * x)
    ),
}


@dataclass(frozen=True)
class Samples:
    """Sums over the springs at the end of each step; `work` and `dissipated` accumulate."""

    normal_force: Array
    tangential_force: Array
    dissipated_energy: Array
    tangential_energy: Array
    work: Array
    #: Tangential load of each spring at the end of the history.
    load: Array


def simulate(
    springs: Foundation,
    material: Material,
    depth: Sequence[float] | Array,
    displacement: Sequence[float] | Array,
    *,
    substeps: int = 1,
    start: tuple[float, float] = (0.0, 0.0),
) -> Samples:
    """Follow straight load steps in (depth, displacement), from an unloaded contact at `start`.

    A negative depth is a separation. Substeps only change rounding errors.
    """
    e, g_star, mu = material.e_star, material.g_star, material.mu
    w, length = springs.first_contact_depth, springs.length
    q = np.zeros_like(w)
    d, u = start
    rows = []
    dissipated = work = 0.0
    for end_d, end_u in zip(depth, displacement, strict=True):
        begin_d, begin_u = d, u
        for number in range(1, substeps + 1):
            part = number / substeps
            new_d = end_d if number == substeps else begin_d + part * (end_d - begin_d)
            new_u = end_u if number == substeps else begin_u + part * (end_u - begin_u)
            q, one_dissipated, one_work = _step(q, w, (d, u), (new_d, new_u), (e, g_star, mu))
            dissipated += float(length @ one_dissipated)
            work += float(length @ one_work)
            d, u = new_d, new_u
        bearing = e * np.maximum(d - w, 0.0)
        stored = float(length @ (q * q)) / (2 * g_star)
        rows.append((float(length @ bearing), float(length @ q), dissipated, stored, work))
    columns = np.array(rows).reshape(-1, 5).T
    return Samples(*columns, load=q)


def _step(
    q: Array,
    w: Array,
    begin: tuple[float, float],
    end: tuple[float, float],
    constants: tuple[float, float, float],
) -> tuple[Array, Array, Array]:
    """Loads after one straight step, and each spring's dissipated energy and work, per length."""
    (d, u), (new_d, new_u) = begin, end
    e, g_star, mu = constants
    rise, push = new_d - d, new_u - u
    # Times of contact and of separation of a spring, in units of the step.
    first = np.zeros_like(w)
    last = np.ones_like(w)
    if rise > 0:
        first = np.clip((w - d) / rise, 0.0, 1.0)
    elif rise < 0:
        last = np.clip((d - w) / -rise, 0.0, 1.0)
    touched = np.maximum(d, new_d) > w
    span = np.where(touched, last - first, 0.0)
    limit_first = mu * e * np.maximum(d - w, 0.0)
    limit_last = np.where(touched, mu * e * np.maximum(new_d - w, 0.0), 0.0)
    trial = q + g_star * push * span
    new = np.clip(trial, -limit_last, limit_last)
    excess = np.abs(trial - new)
    slipping = excess > 0
    # |q + G* push t| reaches the limit after this fraction of the spring's own time.
    room = limit_first - np.sign(trial) * q
    share = np.where(slipping, room / np.where(slipping, room + excess, 1.0), 1.0)
    limit_share = limit_first + (limit_last - limit_first) * share
    dissipated = np.where(slipping, excess / g_star * (limit_share + limit_last) / 2, 0.0)
    turn = np.where(slipping, np.sign(trial) * limit_share, new)
    mean = (q + turn) / 2 * share + (turn + new) / 2 * (1 - share)
    return new, dissipated, push * span * mean
