"""Worn contact from the states of its annulus: scalars and fields in the caller's units."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf, isfinite

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import fields, normal
from mdr_core.errors import AccuracyError, InputError
from mdr_core.typing import Array
from mdr_core.validation import checked_radii
from mdr_core.wear import surface_fields
from mdr_core.wear.annulus_state import AnnulusState
from mdr_core.wear.initial_state import InitialState
from mdr_core.wear.integrator import NO_TRAIL, StickTrail, integrate


@dataclass(frozen=True)
class WornSurface:
    """Worn contact at each number of cycles: scalars (cycles,) and fields (cycles, radii)."""

    initial: InitialState
    cycles: Array
    states: tuple[AnnulusState, ...] = ()
    """One for each number of cycles; none if there is no slip."""
    trail: StickTrail = NO_TRAIL
    settled: float = inf
    """Number of cycles after which wear has stopped."""

    def at(self, index: int) -> "WornSurface":
        """Return the surface at one of the numbers of cycles."""
        which = slice(index, index + 1)
        parts = self.cycles[which], self.states[which]
        return WornSurface(self.initial, *parts, self.trail, self.settled)

    @cached_property
    def indentation_depth(self) -> Array:
        """d [length]: it grows where the normal force is constant."""
        start, unit = float(self.initial.contact.indentation_depth), self.initial.depth_unit
        return start + self._each(lambda state: unit * state.risen, 0.0)

    @cached_property
    def stick_radius(self) -> Array:
        """c [length]: it moves where one force and one displacement are constant."""
        unit = self.initial.length_unit
        return self._each(lambda state: unit * state.stick, self.initial.sideways.stick_radius)

    @cached_property
    def contact_radius(self) -> Array:
        """a [length]: it grows as the contact edge wears."""
        start, unit = float(self.initial.contact.contact_radius), self.initial.length_unit
        return start + self._each(lambda state: unit * state.growth, 0.0)

    @cached_property
    def normal_force(self) -> Array:
        """F_N [force]: at a constant depth F_N0(a) + 2 E* (a w(a) - int_c^a w dx), w = g - g_0."""
        initial = self.initial
        contact, profile = initial.contact, initial.contact.profile
        if initial.held.force or not self.states:
            return np.full(self.cycles.shape, float(contact.normal_force))
        edge = profile.coordinate_from_radius(self.contact_radius)
        e_star, unit = float(contact.e_star), initial.depth_unit * initial.length_unit

        def worn(state: AnnulusState) -> float:
            return float(state.x[-1] ** 2 * state.worn_omega[-1]) - state.lifted

        return np.asarray(e_star * (profile.reduced_force(edge) + 2 * unit * self._each(worn, 0.0)))

    @cached_property
    def worn_volume(self) -> Array:
        """V = 2 pi int h r dr [length^3]."""
        unit = self.initial.depth_unit * self.initial.length_unit**2
        return self._each(
            lambda state: unit * surface_fields.worn_volume(state, self.trail.until(state)), 0.0
        )

    @cached_property
    def dissipated_energy(self) -> Array:
        """Friction work of all cycles so far [force length].

        (8 mu^2 E*^2/G*) int_c^a (d - g)(g - g(c)) dx per cycle. Source: notes, §6.
        """
        initial = self.initial
        unit = 2 * initial.depth_unit * initial.length_unit**2 / initial.wear_coefficient
        return self._each(lambda state: unit * state.work, 0.0)

    def worn_depth(self, radius: ArrayLike) -> Array:
        """Return h(r) = f - f_0 [length], (cycles, m), which is never negative and never falls.

        Where numerical errors would reduce it from one number of cycles to the next, the earlier
        depth is returned for both, which is no further from the truth.

        Raises
        ------
        InputError : a radius that is negative, not finite or beyond the profile's end.
        """
        initial, r = self.initial, self._radii(radius)
        result = np.zeros((self.cycles.size, r.size))
        for row, state in zip(result, self.states, strict=False):
            scaled = r / initial.length_unit
            row[:] = surface_fields.worn_depth(state, self.trail.until(state), scaled)
        return initial.depth_unit * np.maximum.accumulate(result, axis=0)

    def profile(self, radius: ArrayLike) -> Array:
        """Return the worn profile f(r) [length], (cycles, m). Errors as of `worn_depth`."""
        r = self._radii(radius)
        return np.asarray(self.initial.contact.profile.f(r) + self.worn_depth(r))

    def pressure(self, radius: ArrayLike) -> Array:
        """Return p(r) [pressure], (cycles, m). Errors as of `worn_depth`.

        Never negative, zero outside the contact. In the limit it is that of a flat punch of
        radius c, infinite at c; before, it has a narrow peak there.

        Source: mdr-5, Eq. (5.79).
        """
        r = self._radii(radius)
        result = np.empty((self.cycles.size, r.size))
        unworn = self.worn_volume <= 0
        if unworn.any():
            result[unworn] = fields.pressure(self.initial.contact, r)
        for index in np.flatnonzero(~unworn):
            result[index] = self._pressure(self.states[index], r)
        return result

    def _radii(self, radius: ArrayLike) -> Array:
        return checked_radii(radius, float(np.asarray(self.initial.contact.profile.domain)))

    def _pressure(self, state: AnnulusState, radius: Array) -> Array:
        initial, e_star = self.initial, float(self.initial.contact.e_star)
        scaled, unit = radius / initial.length_unit, initial.depth_unit / initial.length_unit
        result = np.zeros(radius.shape)
        sticks = scaled < state.stick
        slips = ~sticks & (scaled < state.x[-1])
        result[slips] = e_star * unit * surface_fields.annulus_pressure(state, scaled[slips])
        if sticks.any():
            # The pressure of the unworn foundation inside c, and that of the worn one.
            within = normal.solve(
                initial.contact.profile, e_star, contact_radius=initial.length_unit * state.stick
            )
            worn = surface_fields.stick_pressure(state, self.trail.until(state), scaled[sticks])
            result[sticks] = fields.pressure(within, radius[sticks]) + e_star * unit * worn
        return np.maximum(result, 0.0)

    def _each(self, value: Callable[[AnnulusState], float], otherwise: Array | float) -> Array:
        """Return a scalar of every state."""
        if not self.states:
            return np.full(self.cycles.shape, float(otherwise))
        return np.array([value(state) for state in self.states])


def worn_surface(initial: InitialState, cycles: Array, nodes: int, rtol: float) -> WornSurface:
    """Return the worn surface at ascending numbers of cycles.

    Parameters
    ----------
    initial : contact before the first cycle.
    cycles : numbers of cycles, (k,).
    nodes : number of nodes of the annulus.
    rtol : relative tolerance of the integration.

    Raises
    ------
    InputError : the contact reaches the end of the profile, or slides.
    AccuracyError : the wear is not resolved.
    """
    if not initial.slips:
        return WornSurface(initial, cycles)
    unit, scaled = initial.cycle_unit, cycles / initial.cycle_unit
    found = integrate(initial.model(nodes), scaled, rtol, initial.ends)
    if isfinite(found.left):
        cycle = found.left * unit
        if initial.reach < initial.room:
            detail = "the contact grows beyond the range of this method"
            raise AccuracyError(detail, ("cycles",))
        raise InputError(
            ("cycles", int(np.searchsorted(cycles, cycle))),
            f"after {cycle:.3g} cycles the worn contact reaches radius {initial.domain:.6g}, where "
            "the profile ends or is no longer admissible",
        )
    if isfinite(found.lost):
        cycle = found.lost * unit
        raise InputError(
            ("cycles", int(np.searchsorted(cycles, cycle))),
            f"after {cycle:.3g} cycles the whole contact slides: wear at this depth reduces the "
            "normal force until it no longer carries the tangential force",
        )
    return WornSurface(initial, cycles, found.states, found.trail, found.settled * unit)
