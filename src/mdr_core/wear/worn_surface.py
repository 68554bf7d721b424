"""Worn contact from the states of its annulus: scalars and fields in the caller's units.

Functions of a state alone are in the units of `mdr_core.wear.initial_state`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import fields, normal
from mdr_core.abel.annulus import inverse_hypot
from mdr_core.elementwise import in_blocks
from mdr_core.typing import Array
from mdr_core.validation import checked_radii
from mdr_core.wear.annulus_state import AnnulusState
from mdr_core.wear.initial_state import InitialState


@dataclass(frozen=True)
class WornSurface:
    """Worn contact at each number of cycles: scalars (cycles,) and fields (cycles, radii)."""

    initial: InitialState
    cycles: Array
    states: tuple[AnnulusState, ...] = ()
    """One for each number of cycles; none if there is no slip."""
    settled_at: float = inf
    """Number of cycles after which wear has stopped."""

    @cached_property
    def indentation_depth(self) -> Array:
        """d [length]: it grows where the normal force is constant."""
        start, unit = float(self.initial.normal.indentation_depth), self.initial.depth_unit
        return start + self._each(lambda state: unit * state.depth_increase, 0.0)

    @cached_property
    def stick_radius(self) -> Array:
        """c [length]: it moves where one force and one displacement are constant."""
        unit = self.initial.length_unit
        return self._each(
            lambda state: unit * state.stick, self.initial.tangential_contact.stick_radius
        )

    @cached_property
    def contact_radius(self) -> Array:
        """a [length]: it grows as the contact edge wears."""
        start, unit = float(self.initial.normal.contact_radius), self.initial.length_unit
        return start + self._each(lambda state: unit * state.growth, 0.0)

    @cached_property
    def normal_force(self) -> Array:
        """F_N [force]: it falls where the depth is constant."""
        initial, force = self.initial, self.initial.normal.normal_force
        if initial.constant_force:
            return np.full(self.cycles.shape, float(force))
        unit = 2 * float(initial.normal.e_star) * initial.depth_unit * initial.length_unit
        # Once nothing touches, rounding errors are left of either sign.
        return np.maximum(self._each(lambda state: unit * state.force, force), 0.0)

    @cached_property
    def worn_volume(self) -> Array:
        """V = 2 pi int h r dr [length^3]."""
        unit = self.initial.depth_unit * self.initial.length_unit**2
        return self._each(lambda state: unit * _worn_volume(state), 0.0)

    @property
    def dissipated_energy(self) -> Array:
        """Friction work V/K of all cycles so far, by the law of wear [force length]."""
        return self.worn_volume / self.initial.wear_coefficient

    def spring_wear(self, radius: Array) -> Array:
        """Return the wear g - g_0 of the springs at radii of the annulus [length], (cycles, m)."""
        unit, x = self.initial.depth_unit, radius / self.initial.length_unit
        return unit * np.array([state.spring_wear(x) for state in self.states])

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
            row[:] = _field_in_blocks(_worn_depth, state, r / initial.length_unit)
        return initial.depth_unit * np.maximum.accumulate(result, axis=0)

    def profile(self, radius: ArrayLike) -> Array:
        """Return the worn profile f(r) [length], (cycles, m). Errors as for `worn_depth`."""
        r = self._radii(radius)
        return np.asarray(self.initial.normal.profile.f(r) + self.worn_depth(r))

    def pressure(self, radius: ArrayLike) -> Array:
        """Return p(r) [pressure], (cycles, m). Errors as for `worn_depth`.

        Never negative, zero outside the contact. In the limit it is that of a flat punch of
        radius c, infinite at c; before, it has a narrow peak there.

        Source: mdr-5, Eq. (5.79).
        """
        r = self._radii(radius)
        result = np.empty((self.cycles.size, r.size))
        unworn = self.worn_volume <= 0
        if unworn.any():
            result[unworn] = fields.pressure(self.initial.normal, r)
        for index in np.flatnonzero(~unworn):
            result[index] = _field_in_blocks(self._pressure, self.states[index], r)
        return result

    def _radii(self, radius: ArrayLike) -> Array:
        return checked_radii(radius, float(np.asarray(self.initial.normal.profile.domain)))

    def _pressure(self, state: AnnulusState, radius: Array) -> Array:
        initial, e_star = self.initial, float(self.initial.normal.e_star)
        scaled, unit = radius / initial.length_unit, initial.depth_unit / initial.length_unit
        result = np.zeros(radius.shape)
        sticks = scaled < state.stick
        slips = ~sticks & (scaled < state.x[-1])
        result[slips] = e_star * unit * _annulus_pressure(state, scaled[slips])
        if sticks.any():
            # The pressure of the unworn foundation inside c, and that of the worn one.
            within = normal.solve(
                initial.normal.profile, e_star, contact_radius=initial.length_unit * state.stick
            )
            worn = _stick_pressure(state, scaled[sticks])
            result[sticks] = fields.pressure(within, radius[sticks]) + e_star * unit * worn
        return np.maximum(result, 0.0)

    def _each(self, value: Callable[[AnnulusState], float], otherwise: Array | float) -> Array:
        """Return a scalar of every state."""
        if not self.states:
            return np.full(self.cycles.shape, float(otherwise))
        return np.array([value(state) for state in self.states])


def _field_in_blocks(
    field: Callable[[AnnulusState, Array], Array], state: AnnulusState, radius: Array
) -> Array:
    """Return a field, in blocks of radii that bound the memory."""
    blocks = in_blocks(radius.size, state.x.size + state.trail.shape[1])
    return np.concatenate([field(state, radius[block]) for block in blocks])


def _worn_depth(state: AnnulusState, radius: Array) -> Array:
    """Return h(r) = (sigma - S_0) H(r - c) + (2/pi) int_c0^min(r,c) arccos(x/r) dw_c(x).

    The second term is of the springs that a growing stick zone has passed.
    Source: mdr-5, Eq. (5.75), integrated by parts; notes, §11.
    """
    result = np.zeros(radius.shape)
    a = float(state.x[-1])
    full_slip = state.initial.full_slip
    inside = ((radius > state.stick) | full_slip) & (radius < a)
    s = inverse_hypot(radius[inside], state.stick)
    worn = state.initial.maps.at(state.worn, np.minimum((s / state.end) ** 2, 1.0))
    result[inside] = (state.end if full_slip else s) * worn
    at, step = state.passed
    within = radius < a
    root = inverse_hypot(radius[within][:, None], at)
    result[within] += 2 / np.pi * (np.arctan2(root, at) @ step)
    # Below rounding at the edges, and between nodes that are too few, the polynomials may be < 0.
    return np.maximum(result, 0.0)


def _worn_volume(state: AnnulusState) -> float:
    """Return 2 pi int h r dr. Source: notes, §11."""
    b, a = state.end, float(state.x[-1])
    total = b**3 * float(state.initial.maps.volume @ state.worn)
    at, step = state.passed
    root = inverse_hypot(np.full(at.shape, a), at)
    total += float(step @ (a * a * np.arctan2(root, at) - at * root)) / np.pi
    return 2 * np.pi * total


def _annulus_pressure(state: AnnulusState, radius: Array) -> Array:
    """Return p/E* at radii of the annulus, c < r < a. Source: mdr-5, Eq. (5.79)."""
    maps = state.initial.maps
    even = np.append(state.pressure[:-1] / maps.cosine[:-1], 0.0)
    # At the edge, from the even polynomial of degree 4 through its three neighbours.
    even[-1] = (15 * even[-2] - 6 * even[-3] + even[-4]) / 10
    squares = np.minimum((inverse_hypot(radius, state.stick) / state.end) ** 2, 1.0)
    return np.asarray(maps.at(maps.cosine, squares) * maps.at(even, squares))


def _stick_pressure(state: AnnulusState, radius: Array) -> Array:
    """Return the part of p/E* at r < c that is not of the unworn shape inside c.

    (1/pi) int g'(x)/sqrt(x^2 - r^2) dx over c < x < a, with the step g(c+) - g(c) of a worn
    layer that is too thin for the nodes, and over the worn part of the springs inside c.

    Source: mdr-5, Eqs. (5.34), (5.79).
    """
    maps, c = state.initial.maps, state.stick
    inner = inverse_hypot(np.full(radius.shape, c), radius)
    total = (1 / np.sqrt(np.add.outer(inner**2, state.end**2 * maps.points))) @ (
        maps.steps @ state.gamma
    )
    total += float(maps.at_stick @ state.gamma) / inner
    return np.asarray((total + _trail_stress(state.trail, radius)) / np.pi)


def _trail_stress(trail: Array, radius: Array) -> Array:
    """Return int dw_c(x)/sqrt(x^2 - r^2) over the part of the trail above each radius."""
    (passed, worn), at = trail, radius[:, None]
    ends = np.maximum(passed, at)
    logs = np.log(ends + np.sqrt((ends - at) * (ends + at)))
    # The first steps of the edge are below rounding.
    width = np.where(np.diff(passed) > 0, np.diff(passed), inf)
    return np.asarray(np.diff(logs, axis=1) @ (np.diff(worn) / width))
