"""Oblique impact: elastic normal motion, and friction with the memory of the slip annulus.

The normal motion is a quadrature of the energy. The tangential motion follows by iteration over the
whole impact: displacements determine forces, and forces determine displacements, until nothing
changes. Samples are doubled until the estimated error is small enough. Source: notes, §14.
"""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import history, normal, validity
from mdr_core.elementwise import full, number
from mdr_core.errors import AccuracyError, InputError, Notice
from mdr_core.history import ContactState, LoadHistory
from mdr_core.history.load_path import SampledPath
from mdr_core.inversion import invert
from mdr_core.materials import Material
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.quadrature import composite_rule
from mdr_core.typing import Array
from mdr_core.validation import (
    POSITIVE,
    as_numbers,
    common_shape,
    reject,
    require_finite,
    require_inside,
    require_single_positive,
    require_tolerance,
)

# Numbers of samples of the compression, used one after the other.
_SAMPLES: Final = tuple(12 << doublings for doublings in range(11))
# Number of differences of successive solutions in an estimate. The error falls by a factor of
# four with each doubling, but unevenly, because slip begins and ends anywhere between two samples.
# In 200 random impacts single differences understated it by a factor of up to 4, and the largest of
# three did not.
_DIFFERENCES: Final = 3
# With this number of samples the iteration converges, unless the contact point oscillates about ten
# times.
_ENOUGH: Final = 384
# Nodes and weights for the time between two samples. The variable is the root of the distance from
# the first sample, because g' may grow there like the inverse of this root.
_ROOTS, _SHARES = composite_rule(5)
_NODES, _WEIGHTS = np.square(_ROOTS), 2 * _ROOTS * _SHARES
# The iteration ends at this change of the displacements, relative to the largest; rounding errors
# may sustain a change of 1e-11.
_CONVERGED: Final = 1e-10
# Maximum number of iterations: a solid sphere takes 12, a contact point that oscillates takes more.
_SWEEPS: Final = 100


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
    """Slip regime: "stick" without tangential motion, "full_slip" if the whole contact always
    slides."""
    error_estimate: float
    """Estimate of the error of all results, relative to the larger value before or after the
    impact."""
    rtol: float
    """Required relative accuracy, to compare with `error_estimate`."""
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
        """Velocity of separation [length/time], equal to the velocity of approach."""
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
        """Smallest radius with slip [length] in full slip; infinite otherwise."""
        return np.where(self.regime == "full_slip", 0.0, np.inf)

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        inaccurate = validity.inaccurate(self.error_estimate, self.rtol)
        return tuple(validity.notices([*self.normal.findings, inaccurate]))


class _Motion(NamedTuple):
    """Samples of the normal motion from first contact to separation."""

    depth: Array
    """Indentation depths, from zero to zero [length]."""
    force: Array
    """F_N/E* after first contact [length^2]."""
    step: Array
    """Times since the sample before [time]."""
    impulse: Array
    """int F_N dt over each step [force time]."""
    lag: Array
    """int F_N (t_end - t) dt over each step, the loss of distance times the mass [mass length]."""


class _Scene(NamedTuple):
    """Impact of one velocity of approach and one tangential velocity."""

    start: ContactState
    end: float
    """Contact coordinate at the largest depth."""
    normal_mass: float
    tangential_mass: float
    normal_velocity: float
    tangential_velocity: float


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
    rtol: float = 1e-4,
) -> Impact:
    """Return the rebound of two bodies that hit each other obliquely.

    The normal motion m d'' = -F_N is elastic. In the tangential motion m_t u'' = -F_x the force
    follows from the history of depth and displacement of the contact point. Every part of the
    contact sticks up to its own limit of friction.

    Source: notes, §14.

    Parameters
    ----------
    profile : profile of any kind, with single numbers as parameters.
    e_star, g_star : effective moduli [pressure], > 0, or the material that has them, for each.
    friction_coefficient : mu [1], > 0.
    normal_mass, tangential_mass : effective masses m and m_t of the contact point [mass]. For a
        free body of mass m and moment of inertia I about its centre, which is at the distance rho
        from the contact point, 1/m_t = 1/m + rho^2/I; a solid sphere has m_t = 2/7 m. The inverse
        masses of two free bodies add.
    normal_velocity : velocity of approach [length/time], > 0, shape (n,).
    tangential_velocity : velocity of the contact point [length/time], of either sign, shape (n,).
    rtol : required relative accuracy, 1e-13 to 1e-3. A looser tolerance takes less time. The best
        accuracy is about 2e-7; the warning `accuracy` is raised where `rtol` is not reached.

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
    # NumPy's unsigned integers have no negative values.
    normal_mass, tangential_mass = float(normal_mass), float(tangential_mass)
    speeds, along = _velocities(normal_velocity, tangential_velocity)
    last = _largest_coordinates(profile, normal_mass / (2 * start.e_star) * np.square(speeds))
    cases = zip(*(each.ravel().tolist() for each in (last, speeds, along)), strict=True)
    scenes = [_Scene(start, end, normal_mass, tangential_mass, v, w) for end, v, w in cases]
    rebounds, slides, errors = zip(*(_refined(scene, rtol) for scene in scenes), strict=True)
    after, duration, impulse, dissipated = (
        np.reshape(each, speeds.shape)[()] for each in np.transpose(rebounds)
    )
    regime = np.where(np.reshape(slides, speeds.shape), "full_slip", "partial_slip")
    known = e_star if isinstance(e_star, Material) else Material(start.e_star)
    # The depth of flying bodies is measured against their centres.
    material = replace(known, held=("free", "free"))
    return Impact(
        normal.solve(profile, material, indentation_depth=profile.depth(last)),
        start.g_star,
        speeds[()],
        along[()],
        after,
        duration,
        impulse,
        dissipated,
        np.where(along == 0, "stick", regime),
        max(*errors, float(np.max(profile.rounding_at(last)))),
        rtol,
    )


def _velocities(normal_velocity: ArrayLike, tangential_velocity: ArrayLike) -> tuple[Array, ...]:
    """Return the velocities in their common shape; raise InputError if they are invalid."""
    speeds = as_numbers(("normal_velocity",), normal_velocity)
    along = as_numbers(("tangential_velocity",), tangential_velocity)
    for name, values in (("normal_velocity", speeds), ("tangential_velocity", along)):
        if not values.size:
            raise InputError((name,), "at least one value is needed")
    detail = f"{POSITIVE} and finite: approach is positive"
    reject(("normal_velocity",), speeds, ~((speeds > 0) & np.isfinite(speeds)), detail)
    require_finite(("tangential_velocity",), along)
    common_shape(("tangential_velocity",), along, "normal_velocity", speeds)
    return np.broadcast_arrays(speeds, along)


def _largest_coordinates(profile: Profile, energy: Array) -> Array:
    """Contact coordinates at which the elastic energy over E* has a value [length^3]."""
    if profile.domain < np.inf:
        beyond = energy > profile.reduced_energy(number(profile.domain))
        require_inside(("normal_velocity",), beyond, profile, "velocity or the mass")

    def stored(s: Array) -> tuple[Array, Array]:
        value = profile.reduced_energy(s)
        return value, s * profile.reduced_force(s) * profile.depth_slope(s) / value

    low, high = full(0.0, energy), full(profile.domain, energy)
    with np.errstate(all="ignore"):
        return invert(stored, energy, np.minimum(high / 2, 1.0), low, high)


def _refined(scene: _Scene, rtol: float) -> tuple[Array, bool, float]:
    """Return the extrapolated results of `_rebound`, and an estimate of their error.

    The estimate is the largest difference between solutions with two numbers of samples, each
    divided by four with every later doubling, or the difference between the work of friction and
    the loss of energy, if that is larger. Differences are relative to the larger velocity, its
    momentum and energy, and to the duration.
    """
    solved: list[Array] = []
    error, course, before = 0.0, np.zeros((2, 1)), scene.tangential_velocity
    for count in _SAMPLES:
        found = _rebound(scene, _motion(scene, count), course)
        if found is None and count < _ENOUGH:
            solved, error = [], 0.0
            continue
        if found is None and len(solved) > 1:
            break
        if found is None:
            detail = "is so small that the contact point oscillates many times: increase it"
            raise AccuracyError(detail, ("tangential_mass",))
        fine, slides, course = found
        solved.append(fine)
        if len(solved) > 1:
            speed, mass = max(abs(before), abs(fine[0])) or 1.0, scene.tangential_mass
            energy = mass * speed**2 / 2
            if not energy > 0:
                detail = "is too small for its energy in double precision: change the units"
                raise InputError(("tangential_velocity",), detail)
            change = fine - solved[-2]
            relative = np.abs(change / [speed, fine[1], mass * speed, energy])
            error = max(error / 4, float(relative.max()))
            result = fine + change / 3
            # Richardson's extrapolation must not make an energy negative that is below its error.
            result[3] = max(result[3], 0.0)
            lost = mass / 2 * (before - result[0]) * (before + result[0])
            estimate = max(error, abs(lost - result[3]) / energy)
            if len(solved) > _DIFFERENCES and estimate <= rtol:
                break
    return result, slides, estimate


def _motion(scene: _Scene, count: int) -> _Motion:
    """Return the compression up to the largest depth, and its mirror image.

    dt = dd/(v sqrt(1 - E/E_max)) is smooth in phi for the contact coordinate end sin^2(phi), except
    at breaks of the profile, which are samples.
    """
    profile, end, velocity = scene.start.profile, scene.end, scene.normal_velocity
    breaks = profile.coordinate_breaks
    known = np.arcsin(np.sqrt(breaks[breaks < end] / end))
    sides = np.unique(np.concatenate([np.pi / 2 * np.linspace(0.0, 1.0, count + 1), known]))
    width = np.diff(sides)
    phi = sides[:-1] + width * _NODES[:, None]

    def slowed(s: Array) -> Array:
        """Normal velocity over the velocity of approach."""
        stored = profile.reduced_energy(s) / profile.reduced_energy(number(end))
        return np.sqrt(np.maximum(1 - stored, 0.0))

    # The tip takes the time d/v, also where d' is infinite on the axis.
    s, corners = end * np.sin(phi) ** 2, np.append(end * np.sin(sides[:-1]) ** 2, end)
    longer = profile.depth_slope(s) * end * np.sin(2 * phi) * (1 / slowed(s) - 1)
    depth, force = profile.depth(corners), profile.reduced_force(corners)
    step = (np.diff(depth) + width * (_WEIGHTS @ longer)) / velocity
    speed, mass = velocity * slowed(corners), scene.normal_mass
    depth, force = (np.append(each, each[-2::-1]) for each in (depth, force))
    speed, step = np.append(speed, -speed[-2::-1]), np.append(step, step[::-1])
    lag = mass * (speed[:-1] * step - np.diff(depth))
    return _Motion(depth, force[1:], step, -mass * np.diff(speed), lag)


def _rebound(scene: _Scene, motion: _Motion, guess: Array) -> tuple[Array, bool, Array] | None:
    """Solve m_t u'' = -F_x along a normal motion.

    Returns the tangential velocity after the impact, its duration, the impulse and the dissipated
    energy; whether all springs slip throughout; and times and displacements, shape (2, n). Returns
    None if the iteration does not converge. F_x/F_N is linear between the samples. Sliding
    is therefore exact, and so is sticking if the tangential motion has the frequency of the normal
    motion.

    Parameters
    ----------
    guess : times and displacements from which the iteration starts, both beginning with zero, shape
        (2, n); n = 1 means free motion.
    """
    start, mass, velocity = scene.start, scene.tangential_mass, scene.tangential_velocity
    step, time = motion.step, np.append(0.0, np.cumsum(motion.step))
    u = np.interp(time, *guess) if guess.shape[1] > 1 else velocity * time
    for _ in range(_SWEEPS):
        loads = np.array([motion.depth, u])
        path = SampledPath(start, ("indentation_depth", "tangential_displacement"), loads)
        course = LoadHistory(path, start.e_star, start.polyline)
        ratio = course.tangential_force[:-1] / (start.e_star * motion.force[:-1])
        ratio = np.concatenate([ratio[:1], ratio, ratio[-1:]])
        low, high = ratio[:-1], ratio[1:]
        impulse = np.cumsum(motion.impulse * (low + high) / 2)
        before = velocity - np.append(0.0, impulse[:-1]) / mass
        moved = step * before - motion.lag * (2 * low + high) / (3 * mass)
        last, u = u, np.append(0.0, np.cumsum(moved))
        if np.abs(u - last).max() <= _CONVERGED * np.abs(u).max():
            break
    else:
        return None
    slides, dissipated = np.all(course.regime[:-1] == "full_slip"), course.dissipation.sum()
    results = np.array([velocity - impulse[-1] / mass, time[-1], impulse[-1], dissipated])
    return results, bool(slides), np.array([time, u])
