"""Oblique impact: elastic normal motion, and friction with the memory of the slip annulus.

The normal motion is a quadrature of the energy. The tangential one follows by iteration over the
whole impact: forces by the displacements, displacements by the forces, until nothing changes.

Source: notes, §14.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import history, normal, validity
from mdr_core.elementwise import every, number
from mdr_core.errors import AccuracyError, InputError, Notice
from mdr_core.history import ContactState
from mdr_core.inversion import invert
from mdr_core.materials import Material
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.quadrature import composite_rule
from mdr_core.typing import Array
from mdr_core.validation import (
    FINITE,
    POSITIVE,
    as_numbers,
    first_index,
    require_inside,
    require_single_positive,
    require_tolerance,
)

_APPROACH: Final = f"{POSITIVE} and finite: approach is positive"
# Samples of the compression. The error is estimated by half as many.
_SAMPLES: Final = 400
# Nodes and weights of the time between two samples, in the root of the distance from the first one,
# where g' may be infinite as one over this root.
_ROOTS, _SHARES = composite_rule(5)
_NODES, _WEIGHTS = np.square(_ROOTS), 2 * _ROOTS * _SHARES
# Change of the displacements, over the largest, at which the iteration ends: rounding errors may
# keep a change of 1e-11. Sweeps that it may take: 20 for a solid sphere, more if the contact point
# oscillates.
_CONVERGED, _SWEEPS = 1e-10, 100


@dataclass(frozen=True, eq=False, repr=False)
class Impact(validity.ContactResults):
    """Results of impacts, arrays over the velocities."""

    normal: NormalContact
    """Normal contact at the largest depth."""
    g_star: float
    """Effective shear modulus [pressure]."""
    normal_velocity: Array
    """Velocity of approach [length/time]."""
    tangential_velocity: Array
    """Tangential velocity of the contact point before the impact [length/time]."""
    tangential_rebound_velocity: Array
    """Tangential velocity of the contact point after the impact [length/time]."""
    duration: Array
    """Time of contact [time]."""
    tangential_impulse: Array
    """int F_x dt, the loss of tangential momentum [force time]."""
    dissipated_energy: Array
    """Energy dissipated by friction [force length]."""
    regime: "np.ndarray[Any, np.dtype[np.str_]]"
    """Slip regime: "stick" without tangential motion, "full_slip" if all slides throughout."""
    error_estimate: float
    """Estimate of the error of all results, over the larger value before or after the impact."""
    rtol: float
    """Required relative accuracy, which `error_estimate` is compared with."""
    quantities: ClassVar[tuple[str, ...]] = (
        "normal_velocity",
        "tangential_velocity",
        "normal_rebound_velocity",
        "tangential_rebound_velocity",
        "duration",
        "maximum_indentation_depth",
        "maximum_normal_force",
        "tangential_impulse",
        "dissipated_energy",
        "regime",
    )
    method: ClassVar[str] = "waveform_iteration"

    @property
    def normal_rebound_velocity(self) -> Array:
        """Velocity of separation [length/time]: that of approach, because the motion is elastic."""
        return self.normal_velocity

    @property
    def maximum_indentation_depth(self) -> Array:
        """Largest d [length]."""
        return self.normal.indentation_depth

    @property
    def maximum_normal_force(self) -> Array:
        """Largest F_N [force]."""
        return self.normal.normal_force

    @property
    def slips_from(self) -> Array:
        """Least radius with slip [length], in full slip alone; else infinite."""
        return np.where(self.regime == "full_slip", 0.0, np.inf)

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        return self.normal.warnings_with(self.error_estimate, self.rtol)


class _Motion(NamedTuple):
    """Samples of the normal motion, from first contact to separation."""

    depth: Array
    """Indentation depths after first contact [length]."""
    step: Array
    """Times from each sample to the next [time]."""
    impulse: Array
    """int F_N dt over each step [force time]."""
    lag: Array
    """int F_N (t_end - t) dt over each step, the loss of distance times the mass [mass length]."""


class _Rebound(NamedTuple):
    """Results of one impact."""

    velocity: float
    duration: float
    impulse: float
    dissipated: float
    slides: bool


def solve(
    profile: Profile,
    e_star: float | Material,
    g_star: float | Material | None,
    friction_coefficient: float,
    *,
    normal_mass: float,
    tangential_mass: float,
    normal_velocity: ArrayLike,
    tangential_velocity: ArrayLike,
    rtol: float = 1e-3,
) -> Impact:
    """Return the rebound of two bodies that hit each other obliquely.

    The normal motion m d'' = -F_N is elastic. In the tangential one, m_t u'' = -F_x, the force
    follows from the history of depth and displacement of the contact point: every part of the
    contact sticks until its own limit of friction.

    Source: notes, §14.

    Parameters
    ----------
    profile : profile of any kind, with single numbers as parameters.
    e_star, g_star : effective moduli [pressure], > 0, or the material that has them, for each.
    friction_coefficient : mu [1], > 0.
    normal_mass, tangential_mass : effective masses m and m_t of the contact point [mass]. A free
        body of mass m and moment of inertia I about its centre, at the distance rho from the
        contact point, has 1/m_t = 1/m + rho^2/I: a solid sphere 2/7 m. Of two free bodies the
        inverse masses add.
    normal_velocity : velocity of approach [length/time], > 0, shape (n,).
    tangential_velocity : velocity of the contact point [length/time], of either sign, shape (n,).
    rtol : accuracy required of the results, 1e-13 to 1e-3; the warning `accuracy` tells where it is
        missed. They are mostly accurate to 1e-5.

    Returns
    -------
    Results for each pair of velocities, shape (n,).

    Raises
    ------
    InputError : a mass or a velocity that is not positive and finite, or an impact that takes the
        contact beyond the end of the profile.
    AccuracyError : a tangential mass so small that the contact point oscillates many times.

    Examples
    --------
    Sliding throughout changes the tangential velocity by mu 2 m v_n/m_t.

    >>> from mdr_core.profiles import Paraboloid
    >>> hit = solve(Paraboloid(0.01), 1e9, 8e8, 0.1, normal_mass=1.0, tangential_mass=2 / 7,
    ...             normal_velocity=1.0, tangential_velocity=3.0)
    >>> round(float(hit.tangential_rebound_velocity), 9)
    2.3
    """
    start = history.unloaded(profile, e_star, g_star, friction_coefficient)
    require_tolerance(rtol)
    require_single_positive(("normal_mass",), normal_mass)
    require_single_positive(("tangential_mass",), tangential_mass)
    speeds, along = _velocities(normal_velocity, tangential_velocity)
    last = _largest_coordinates(profile, normal_mass / (2 * start.e_star) * np.square(speeds))
    results, errors = [], [float(np.max(profile.rounding_at(last)))]
    cases = zip(*(each.ravel().tolist() for each in (last, speeds, along)), strict=True)
    for end, v, w in cases:
        coarse, fine = (
            _rebound(start, _motion(profile, end, normal_mass, v, count), tangential_mass, w)
            for count in (_SAMPLES // 2, _SAMPLES)
        )
        results.append(fine)
        errors.append(_error(coarse, fine, tangential_mass, w))
    after, duration, impulse, dissipated, slides = (
        np.reshape(each, speeds.shape)[()] for each in zip(*results, strict=True)
    )
    return Impact(
        normal.solve(profile, e_star, indentation_depth=profile.depth(last)),
        start.g_star,
        speeds[()],
        along[()],
        after,
        duration,
        impulse,
        dissipated,
        np.where(along == 0, "stick", np.where(slides, "full_slip", "partial_slip")),
        max(errors),
        rtol,
    )


def _velocities(normal_velocity: ArrayLike, tangential_velocity: ArrayLike) -> tuple[Array, ...]:
    """Velocities of one shape, or an InputError."""
    speeds = as_numbers(("normal_velocity",), normal_velocity)
    along = as_numbers(("tangential_velocity",), tangential_velocity)
    for name, good, detail in (
        ("normal_velocity", (speeds > 0) & np.isfinite(speeds), _APPROACH),
        ("tangential_velocity", np.isfinite(along), FINITE),
    ):
        if not np.size(good):
            raise InputError((name,), "at least one value is needed")
        if not every(good):
            raise InputError((name, *first_index(~good)), detail)
    try:
        return np.broadcast_arrays(speeds, along)
    except ValueError:
        shapes = f"has the shape {along.shape}, but normal_velocity {speeds.shape}"
        detail = f"{shapes}: give one, or as many"
        raise InputError(("tangential_velocity",), detail) from None


def _largest_coordinates(profile: Profile, energy: Array) -> Array:
    """Contact coordinates at which E/E* of the contact is the kinetic energy [length^3]."""
    if profile.domain < np.inf:
        beyond = energy > profile.reduced_energy(number(profile.domain))
        require_inside(("normal_velocity",), beyond, profile.domain, "velocity or the mass")

    def stored(s: Array) -> tuple[Array, Array]:
        value = profile.reduced_energy(s)
        return value, s * profile.reduced_force(s) * profile.depth_slope(s) / value

    goal = np.ravel(energy)
    low, high = np.zeros_like(goal), np.full_like(goal, profile.domain)
    with np.errstate(all="ignore"):
        found = invert(stored, goal, np.minimum(high / 2, 1.0), low, high, profile.kind)
    return found.reshape(np.shape(energy))


def _motion(profile: Profile, end: float, mass: float, velocity: float, count: int) -> _Motion:
    """Return the compression up to the contact coordinate `end`, and its mirror image.

    dt = dd/(v sqrt(1 - E/E_max)) is smooth in phi for the contact coordinate end sin^2(phi), except
    at breaks of the profile, which are samples.
    """
    breaks = profile.coordinate_breaks
    known = np.arcsin(np.sqrt(breaks[breaks < end] / end))
    sides = np.unique(np.concatenate([np.pi / 2 * np.linspace(0.0, 1.0, count + 1), known]))
    width = np.diff(sides)
    phi = sides[:-1] + width * _NODES[:, None]

    def slowed(s: Array) -> Array:
        """Velocity over that before the impact."""
        stored = profile.reduced_energy(s) / profile.reduced_energy(number(end))
        return np.sqrt(np.maximum(1 - stored, 0.0))

    # The tip takes the time d/v, also where d' is infinite on the axis.
    s, corners = end * np.sin(phi) ** 2, np.append(end * np.sin(sides[:-1]) ** 2, end)
    longer = profile.depth_slope(s) * end * np.sin(2 * phi) * (1 / slowed(s) - 1)
    depth, speed = profile.depth(corners), velocity * slowed(corners)
    step = (np.diff(depth) + width * (_WEIGHTS @ longer)) / velocity
    depth, speed = np.append(depth, depth[-2::-1]), np.append(speed, -speed[-2::-1])
    step = np.append(step, step[::-1])
    lag = mass * (speed[:-1] * step - np.diff(depth))
    return _Motion(depth[1:], step, -mass * np.diff(speed), lag)


def _rebound(start: ContactState, motion: _Motion, mass: float, velocity: float) -> _Rebound:
    """Solve m_t u'' = -F_x along a normal motion.

    F_x/F_N is linear between the samples, so that sliding is exact, and so is sticking with the
    normal motion's frequency.
    """
    step, u = motion.step, velocity * np.cumsum(motion.step)
    moduli = start.e_star, start.g_star, start.friction_coefficient
    for _ in range(_SWEEPS):
        path = history.solve(
            start.profile, *moduli, indentation_depth=motion.depth, tangential_displacement=u
        )
        ratio = path.tangential_force[:-1] / path.normal_force[:-1]
        ratio = np.concatenate([ratio[:1], ratio, ratio[-1:]])
        low, high = ratio[:-1], ratio[1:]
        impulse = np.cumsum(motion.impulse * (low + high) / 2)
        before = velocity - np.append(0.0, impulse[:-1]) / mass
        moved = step * before - motion.lag * (2 * low + high) / (3 * mass)
        last, u = u, np.cumsum(moved)
        if np.abs(u - last).max() <= _CONVERGED * np.abs(u).max():
            break
    else:
        detail = "is so small that the contact point oscillates many times: increase it"
        raise AccuracyError(detail, ("tangential_mass",))
    total = float(impulse[-1])
    slides = bool(np.all(path.regime[:-1] == "full_slip"))
    dissipated = float(path.dissipated_energy[-1])
    return _Rebound(velocity - total / mass, float(step.sum()), total, dissipated, slides)


def _error(coarse: _Rebound, fine: _Rebound, mass: float, velocity: float) -> float:
    """Difference of two resolutions, and of the work of friction and the loss of energy."""
    duration = abs(coarse.duration / fine.duration - 1)
    if velocity == 0:
        return duration
    scale = max(abs(velocity), abs(fine.velocity))
    energy = mass * scale**2 / 2
    lost = mass * (velocity - fine.velocity) * (velocity + fine.velocity) / 2
    return max(
        duration,
        abs(coarse.velocity - fine.velocity) / scale,
        abs(coarse.dissipated - fine.dissipated) / energy,
        abs(lost - fine.dissipated) / energy,
    )
