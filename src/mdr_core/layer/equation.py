"""Integral equation of the contact of any profile with an elastic layer on a rigid base.

To the contact of radius a with a half-space, a layer adds a smooth correction v of the foundation
load, q = E* [g(a) - g(x) + v(x)], v(a) = 0:

    v(x) = int_0^a [K(x, t) - K(a, t)] q(t)/E* dt,    d = g(a) - int_0^a K(a, t) q(t)/E* dt,
    K(x, t) = (2/(pi h)) s int_0^oo [1 - L(w)] cos(w x/h) cos(w t/h) dw,

where s is the share of the layer in the compliance. A flat punch has q = E* d q1, (I - K) q1 = 1,
and S = dF_N/dd = 2 E* int_0^a q1 dx. v and q1 are even polynomials in x, and the integral over the
profile consists of the moments of g' with Chebyshev's polynomials.

Source: lebedev; hayes; manual, Contact with a layer.
"""

from math import ceil, inf, pi
from typing import Final, NamedTuple

import numpy as np

from mdr_core.abel.displacement import Kernel
from mdr_core.elementwise import full, in_blocks, where
from mdr_core.errors import InputError
from mdr_core.layer_response import softening
from mdr_core.materials import Layer
from mdr_core.profiles import Profile
from mdr_core.quadrature import composite_rule
from mdr_core.typing import Array, Indices

LARGEST: Final = 10.0
"""Largest contact radius over the thickness."""
POINTS: Final = 32
"""Points of Gauss's rule on each interval of w, one more interval for each a/h: they resolve
cos(2 w a/h)."""
# w at which 1 - L is below the rounding error.
_WAVES: Final = 22.0
# Minimum number of polynomials, and ln(1/EPS)/2: K is analytic up to 2h from the real axis.
_LEAST, _DIGITS = 16, 18.4


class States(NamedTuple):
    """Contacts with a layer over E*, all (m,) but the last two, (n, m)."""

    depth: Array
    force: Array
    stiffness: Array
    energy: Array
    edge: Array
    """q1(a)."""
    edge_growth: Array
    """a dq1(a)/da."""
    depth_slope: Array
    """dd/da at the contact edge, infinite under a flat punch."""
    condition: Array
    """Amplification of rounding errors."""
    correction: Array
    """Chebyshev coefficients of the foundation load over E* beyond a half-space's, over
    2 (x/a)^2 - 1."""
    loads: Array
    """Parts of int_0^a q dx/E* at the zeros of T_2n(x/a) [length^2]."""


def waves(layer: Layer, reach: float) -> tuple[Array, Array]:
    """Wave numbers times h, and weights of (2/pi) s [1 - L]; for places up to `reach` times h."""
    shares, weights = composite_rule(POINTS, 2 + ceil(reach))
    w = _WAVES * shares
    return w, 2 / pi * layer.share * _WAVES * weights * softening(layer, w)


def states(profile: Profile, layer: Layer, coordinate: Array) -> States:
    """Contacts at contact coordinates (m,)."""
    a = profile.contact_radius(coordinate)
    part = a / layer.thickness
    # Contacts with about as many polynomials together, in blocks of bounded size.
    size = 2 ** np.ceil(np.log2(np.maximum(part, 1.0)))
    found: list[tuple[Indices, States]] = []
    for most in np.unique(size):
        index = np.flatnonzero(size == most)
        count = max(ceil(_DIGITS / np.arcsinh(2 / min(most, LARGEST))) + 4, _LEAST)
        for block in in_blocks(index.size, count * count):
            own = index[block]
            found.append((own, _block(profile, layer, coordinate[own], a[own], count, most)))
    modes = max((len(states.correction) for _, states in found), default=0)
    sizes = [(part.size,)] * (len(States._fields) - 2) + [(modes, part.size)] * 2
    whole = States(*map(np.zeros, sizes))
    for own, states in found:
        for every, each in zip(whole, states, strict=True):
            every[: len(each) if every.ndim > 1 else None][..., own] = each
    return whole


def _block(
    profile: Profile, layer: Layer, coordinate: Array, a: Array, count: int, largest: float
) -> States:
    """Contacts of radii a with `count` polynomials, for radii up to `largest` times h."""
    modes = np.arange(count)
    part = a / layer.thickness
    angle = angles(count)
    # From values at x = a cos(angle) to coefficients of T_2k(x/a).
    to_modes = 2 / count * np.cos(np.multiply.outer(2 * modes, angle))
    to_modes[0] /= 2
    whole, rise = 1 / (1 - 4 * modes**2) @ to_modes, 4 * modes**2 @ to_modes
    w, strength = waves(layer, largest)
    places = np.append(np.cos(angle), 1.0)
    cosines = np.cos(part[:, None, None] * np.multiply.outer(places, w))
    kernel = part[:, None, None] * (cosines * strength) @ cosines.swapaxes(1, 2)
    inside, edge = kernel[:, :-1, :-1] * whole, kernel[:, -1, :-1] * whole
    unit = np.eye(count)
    ends = np.stack([np.ones_like(edge), kernel[:, :-1, -1]], axis=2)
    punch, moved = np.moveaxis(np.linalg.solve(unit - inside, ends), 2, 0)
    q1 = 1 + _dot(edge, punch)
    stiffness = 2 * a * (punch @ whole)
    growth = punch @ rise + q1 * (kernel[:, -1, -1] + _dot(edge, moved))
    condition = stiffness / where(a > 0, 2 * a, 1.0) + 0 * part
    if profile.is_flat_punch:
        # The contact coordinate of a flat punch is its depth; each contact may have its own radius.
        depth = coordinate
        force, correction = depth * stiffness, depth[:, None] * (punch - 1)
        weights = depth[:, None] * whole
        energy, slope = depth * force / 2, full(inf, depth)
    else:
        start = full(1.0, a) * profile.first_radius
        # The rule resolves the least number of polynomials in any case.
        rates = profile.annulus_integrals(
            start, coordinate, *_odd_polynomials(count + 1), degree=count - _LEAST
        ).T
        rates = rates / np.arange(1, 2 * count + 2, 2)
        moments = np.concatenate([rates[:, :1], (rates[:, 1:-1] - rates[:, :-2]) / 2], axis=1)
        weights = moments @ to_modes
        depth, force = profile.depth(coordinate), profile.reduced_force(coordinate)
        source = _dot(kernel[:, :, :-1], weights[:, None, :])
        relative = inside - edge[:, None, :]
        correction = np.linalg.solve(unit - relative, (source[:, :-1] - source[:, -1:])[..., None])
        correction = correction[..., 0]
        sinking = source[:, -1] + _dot(edge, correction)
        added = a * (correction @ whole)
        energy = profile.reduced_energy(coordinate) + a * _dot(weights, correction)
        energy = energy - sinking * (force / 2 + added)
        left = depth - sinking
        condition = condition * where(left > 0, depth / where(left > 0, left, 1.0), 1.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = (profile.depth_slope(coordinate) - correction @ rise / a) / q1
        depth, force = depth - sinking, force + 2 * added
    return States(
        *(depth, force, stiffness, energy, q1, growth, slope, condition),
        to_modes @ correction.T,
        (a[:, None] * (weights + whole * correction)).T,
    )


def angles(count: int) -> Array:
    """Angles of the positive zeros cos(angle) of T_2n."""
    return pi * (2 * np.arange(count) + 1) / (4 * count)


def _dot(left: Array, right: Array) -> Array:
    return np.asarray((left * right).sum(axis=-1))


def _odd_polynomials(count: int) -> list[Kernel]:
    """Chebyshev's polynomials T_1, T_3, ... of x/a, root = sqrt(a^2 - x^2), called in this order.

    T_(k+2) = 2 T_2 T_k - T_(k-2) takes a fifth of the time of cosines.
    """
    last: list[Array] = []

    def first(x: Array, root: Array) -> Array:
        t = x / np.hypot(x, root)
        last[:] = 4 * t * t - 2, t, t
        return t

    def following(_x: Array, _root: Array) -> Array:
        twice, before, value = last
        last[1:] = value, twice * value - before
        return last[2]

    return [first] + [following] * (count - 1)


class Range(NamedTuple):
    """Contact radii that a profile and a layer allow."""

    domain: float
    """Largest contact radius [length]."""
    end: tuple[str, str]
    """Words for the end: the reason, and what to do."""


def allowed(profile: Profile, layer: Layer) -> Range:
    """Contact radii up to the end of the profile and to `LARGEST` times the thickness."""
    reach = LARGEST * layer.thickness
    if profile.domain <= reach:
        return Range(float(profile.domain), profile.end)
    reason = f"where it exceeds {LARGEST:g} times the thickness of the layer"
    return Range(reach, (reason, "use finite elements"))


def require_flat_within(profile: Profile, layer: Layer, path: tuple[str, ...]) -> None:
    """Raise InputError at the layer's path if a flat face alone exceeds the largest contact."""
    if profile.first_radius > LARGEST * layer.thickness:
        detail = f"must be at least 1/{LARGEST:g} of the radius of the flat face"
        raise InputError((*path, "thickness"), detail)


def largest_coordinate(profile: Profile, layer: Layer) -> float:
    """Contact coordinate of the largest contact."""
    return float(profile.coordinate_from_radius(np.asarray(allowed(profile, layer).domain)))
