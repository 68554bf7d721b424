"""A contact that wears: its answers over the numbers of cycles, each when it is asked for."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import fields, normal
from mdr_core.errors import AccuracyError, InputError, Notice
from mdr_core.lazy import cached_property
from mdr_core.typing import Array
from mdr_core.wear import readout
from mdr_core.wear.course import Course, Progress, Trail, course
from mdr_core.wear.rates import State
from mdr_core.wear.scene import Scene

# The second run of the error estimate: fewer nodes and a looser integrator.
_COARSER: Final = 2 / 3
_LOOSER: Final = 4.0
# That difference, for errors that fall no slower than with the spacing, and half as much again.
_SAFETY: Final = 3.0
_SAMPLES: Final = 65
_EPS: Final = 2.0**-52
# Beyond such an estimate neither of its two runs is near the truth.
_UNRESOLVED: Final = 0.25
_SCALARS: Final = (
    "worn_volume",
    "indentation_depth",
    "normal_force",
    "stick_radius",
    "contact_radius",
    "dissipated_energy",
)


@dataclass(frozen=True)
class WearEvolution:
    """A contact under +-u_0 or +-F_x at every listed number of cycles.

    All answers are arrays over the cycles; each is computed when it is first asked for, but for
    the course itself.
    """

    scene: Scene
    cycles: Array
    resolution: int
    rtol: float
    progress: Progress | None = None

    @cached_property
    def course(self) -> Course | None:
        """The annulus over the cycles; None where nothing slips."""
        scene = self.scene
        if not scene.slips:
            return None
        found = course(
            scene.system(self.resolution),
            self.cycles / scene.cycle_unit,
            self.rtol,
            scene.stop,
            self.progress,
        )
        if isfinite(found.left):
            self._refuse(found.left * scene.cycle_unit)
        return found

    def _refuse(self, left: float) -> None:
        scene = self.scene
        if scene.stop * scene.length_unit < scene.domain:
            detail = "the worn contact grows further than this method carries it"
            raise AccuracyError(detail, ("cycles",))
        raise InputError(
            ("cycles", int(np.searchsorted(self.cycles, left))),
            f"after {left:.3g} cycles the worn contact reaches radius {scene.domain:.6g}, where "
            "the profile ends or ceases to be admissible",
        )

    @cached_property
    def indentation_depth(self) -> Array:
        """d [length], (cycles,): it rises where the normal force is held."""
        start = float(self.scene.contact.indentation_depth)
        return start + self._each(lambda state: self.scene.depth_unit * state.risen)

    @cached_property
    def stick_radius(self) -> Array:
        """c [length], (cycles,): it grows where force and displacement are held."""
        return self._each(
            lambda state: self.scene.length_unit * state.stick, self.scene.sideways.stick_radius
        )

    @cached_property
    def contact_radius(self) -> Array:
        """a [length], (cycles,): the edge wears, the contact grows outwards."""
        unit = self.scene.length_unit
        return self._each(
            lambda state: unit * float(state.x[-1]), self.scene.contact.contact_radius
        )

    @cached_property
    def normal_force(self) -> Array:
        """F_N = F_N0(c) + 2 E* int_0^a (d - max(g, g(c))) dx [force], (cycles,)."""
        start = self.scene.contact.normal_force
        if self.scene.control.force or self.course is None:
            return np.full(self.cycles.shape, float(start))
        profile, e_star = self.scene.contact.profile, float(self.scene.contact.e_star)
        edge = profile.coordinate_from_radius(np.asarray(self.scene.sideways.stick_radius))
        within = e_star * float(profile.reduced_force(edge))
        unit = 2 * e_star * self.scene.depth_unit * self.scene.length_unit
        return within + unit * self._each(
            lambda state: state.drive * float(state.x[-1]) - state.gained
        )

    @cached_property
    def worn_volume(self) -> Array:
        """V = 2 pi int h r dr [length^3], (cycles,)."""
        unit = self.scene.depth_unit * self.scene.length_unit**2
        found = [unit * readout.worn_volume(*pair) for pair in self._moments]
        return np.array(found) if found else np.zeros(self.cycles.shape)

    @cached_property
    def dissipated_energy(self) -> Array:
        """Friction work of all cycles so far [force length], (cycles,).

        (8 mu^2 E*^2/G*) int_c^a (d - g)(g - g(c)) dx a cycle, summed. Source: notes, §6.
        """
        scene = self.scene
        unit = 2 * scene.depth_unit * scene.length_unit**2 / scene.wear_coefficient
        return self._each(lambda state: unit * state.work)

    def worn_depth(self, radius: ArrayLike) -> Array:
        """Return h(r) = f - f_0 [length], (cycles, m): never negative, never falling.

        What wears is gone. Where the errors of two moments would have it come back, the earlier
        depth is answered for the later one as well, which is no further from the truth.
        """
        r = _checked(radius)
        result = np.zeros((self.cycles.size, r.size))
        for row, (state, trail) in zip(result, self._moments, strict=False):
            row[:] = self.scene.depth_unit * readout.worn_depth(
                state, trail, r / self.scene.length_unit
            )
        return np.maximum.accumulate(result, axis=0)

    def profile(self, radius: ArrayLike) -> Array:
        """Return the worn profile f(r) [length], (cycles, m)."""
        return np.asarray(self.scene.contact.profile.f(_checked(radius)) + self.worn_depth(radius))

    def pressure(self, radius: ArrayLike) -> Array:
        """Return p(r) [pressure], (cycles, m): never negative, zero outside the contact.

        In the limit it is that of a flat punch at the stick radius, infinite there.

        Source: mdr-5, Eq. (5.79).
        """
        r = _checked(radius)
        if self.course is None:
            return np.tile(fields.pressure(self.scene.contact, r), (self.cycles.size, 1))
        return np.stack([self._pressure(state, trail, r) for state, trail in self._moments])

    def _pressure(self, state: State, trail: Trail, radius: Array) -> Array:
        e_star, scaled = float(self.scene.contact.e_star), radius / self.scene.length_unit
        unit = e_star * self.scene.depth_unit / self.scene.length_unit
        result = np.zeros(radius.shape)
        sticks = scaled < state.stick
        slips = ~sticks & (scaled < state.x[-1])
        result[slips] = unit * readout.annulus_pressure(state, scaled[slips])
        if sticks.any():
            stick = self.scene.length_unit * state.stick
            within = normal.solve(self.scene.contact.profile, e_star, contact_radius=stick)
            result[sticks] = fields.pressure(within, radius[sticks])
            result[sticks] += unit * readout.stick_pressure(state, trail, scaled[sticks])
        return np.maximum(result, 0.0)

    @cached_property
    def _moments(self) -> list[tuple[State, Trail]]:
        if self.course is None:
            return []
        return [(state, self.course.trail.until(state)) for state in self.course.states]

    def _each(self, answer: Callable[[State], float], otherwise: ArrayLike = 0.0) -> Array:
        if self.course is None:
            return np.full(self.cycles.shape, float(np.asarray(otherwise)))
        return np.array([answer(state) for state in self.course.states])

    @cached_property
    def error_estimate(self) -> float:
        """Bound on the error of each answer but the pressure, relative to its size.

        Of the worn depth and of the profile relative to the depth d. It is the difference to a
        run on fewer nodes with a looser integrator, and what rounding leaves. The pressure's
        narrow peak at the stick edge is not resolved to this accuracy.

        Raises
        ------
        AccuracyError : the two runs have little in common; a bound on that says nothing.
        """
        if self.course is None:
            return self.scene.sideways.error_estimate
        nodes = max(int(self.resolution * _COARSER), 4)
        other = replace(self, resolution=nodes, rtol=_LOOSER * self.rtol)
        c, a = float(self.scene.sideways.stick_radius), float(self.contact_radius.max())
        radii = c + (a - c) * np.linspace(0.0, 1.0, _SAMPLES)
        depth = self.indentation_depth
        found = [np.abs(self.worn_depth(radii) - other.worn_depth(radii)).max(axis=1) / depth]
        for name in _SCALARS:
            mine, theirs = getattr(self, name), getattr(other, name)
            found.append(np.abs(mine - theirs) / np.where(mine > 0, mine, 1.0))
        rounding = _EPS * float(depth[0]) / self.scene.depth_unit * self.resolution**2
        estimate = _SAFETY * float(np.max(found)) + 10 * self.rtol + rounding
        if estimate > _UNRESOLVED:
            raise AccuracyError(
                "the worn annulus is not resolved: ask for a finer resolution, or for an "
                "amplitude further from full slip",
                ("resolution",),
            )
        return estimate

    @property
    def method(self) -> str:
        """The route."""
        return "quadrature"

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """Those of the contact, and `limit_reached`."""
        found = list(self.scene.sideways.warnings)
        if self.course is not None and isfinite(self.course.settled):
            last = self.course.settled * self.scene.cycle_unit
            found.append(
                Notice(
                    "limit_reached",
                    f"from about {last:.2g} cycles on nothing wears any more: the profile is the "
                    "limiting one",
                )
            )
        return tuple(found)


def _checked(radius: ArrayLike) -> Array:
    r = np.atleast_1d(np.asarray(radius, dtype=float))
    bad = ~((r >= 0) & (r < inf))
    if bad.any():
        raise InputError(("radius", int(np.flatnonzero(bad)[0])), "must be finite and not negative")
    return r
