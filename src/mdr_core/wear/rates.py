"""Rates of change of the worn annulus with the number of cycles, and their Jacobian matrix.

All rates are linear in those of the edges, b' = db/dN, c' and d': each is a row of four columns,
times (1, b', c', d'). The edges follow from what holds at all times:

    gamma(a) = D, and d in full slip,
    int_0^a (d - g) dx is constant under a constant normal force,
    c D + int_c^a (D - gamma) dx is constant where the stick zone shrinks,
    gamma(c) = 0 where it grows over worn material.

In the units of `mdr_core.wear.initial_state`. Source: notes, §11.
"""

from functools import cached_property
from math import sqrt
from typing import Final

import numpy as np

from mdr_core.doubles import EPS
from mdr_core.errors import AccuracyError
from mdr_core.typing import Array
from mdr_core.wear.annulus_state import AnnulusState
from mdr_core.wear.initial_state import InitialState

# Columns of a rate: by wear alone, and per unit of the rates of b, c and w_c, or d.
_WEAR, _END, _STICK, _RETAINED = range(4)
# Rate at which the integrator's errors of gamma(a) - D, and of the force in full slip, decay: fast
# beside the wear, whose unit is 1, and slow beside the steps of the first cycles. By trial, rates
# from 1 to 1000 give results within their estimates in as many steps.
_RETURN: Final = 10.0


def rates(initial: InitialState, vector: Array) -> Array:
    """Return the derivative of the vector with respect to the scaled number of cycles."""
    return _MovingAnnulus.of(initial, vector).rates


def jacobian(initial: InitialState, vector: Array) -> Array:
    """Return the derivative of the rates with respect to the vector, for Newton's method.

    By the worn depth exactly, by the edges from differences; the tilt's effect on the edges'
    rates is neglected.
    """
    state = _MovingAnnulus.of(initial, vector)
    inner, tilted = initial.parts
    in_worn, in_edges = state.gradients()
    gradient = np.concatenate([in_worn[:-1], in_edges[_END:]])
    found = np.zeros((vector.size, vector.size))
    if initial.stick_grows:
        passing = np.multiply.outer(state.tilt_rates, in_edges[_RETAINED])
        gradient = np.concatenate([gradient, passing])
        # The wear at the last node is the tilt there.
        found[:, tilted:] = np.multiply.outer(gradient[:, -1], state.tilt_basis[0] / state.end)
    found[:, :inner] = gradient[:, :-1]
    for edge in state.moving:
        # The root of the rounding error suits a difference quotient.
        step, at = sqrt(EPS) * (state.offset[-1] if edge == _STICK else 1.0), inner + edge - _END
        moved = vector.copy()
        moved[at] += step
        found[:, at] = (rates(initial, moved) - state.rates) / step
    return found


class _MovingAnnulus(AnnulusState):
    """Annulus with the rates of its edges, from the quantities that are constant."""

    @cached_property
    def stick_slope(self) -> float:
        """g_0'(c) of a stick edge that moves."""
        if not self.initial.stick_moves:
            return 0.0
        return float(self.initial.slope(np.array([self.stick]))[0])

    @cached_property
    def motion(self) -> Array:
        """dx/dN of the nodes per unit of the rates of b and c, (2, n)."""
        stick = np.full(self.x.size, self.stick)
        return np.stack([self.end * self.initial.maps.squares, stick]) / self.x

    @property
    def convected(self) -> tuple[Array, Array]:
        """Rate of `worn` per unit of b'/b, L in `worn_rates`, and its gradient in `worn`."""
        along, gradient = self._along(self.initial.maps.inward)
        # In full slip the worn depth is b times `worn`.
        if self.initial.full_slip:
            return along - self.worn, gradient - np.eye(along.size)
        return along, gradient

    def _along(self, slope: Array) -> tuple[Array, Array]:
        """L = 2 z d worn/dz and its gradient in `worn`, by one of the two maps to slopes.

        Material outside a shrinking stick zone has worn exponentially with its distance from the
        edge, so that v differs by orders of magnitude between neighbours. The slope of ln(v/z)
        keeps v positive there; that of v overshoots where the layer is thin.
        """
        if not self.initial.stick_shrinks:
            return slope @ self.worn, slope
        v, first = self.slip, self.slip - self.worn
        steep = 2 + slope @ np.log(v / self.initial.maps.squares)
        along = self.worn * steep + first * (slope @ np.log1p(self.worn / first))
        return along, np.diag(steep) + v[:, None] * slope / v

    @property
    def past_stick(self) -> tuple[Array, Array]:
        """Rate of `worn` per unit of c', (c/s^2) (worn + L), and its gradient in `worn`."""
        maps = self.initial.maps
        along, gradient = self._along(maps.inward if self.initial.stick_grows else maps.outward)
        scale = self.stick / (self.end**2 * maps.squares)
        return scale * (self.worn + along), scale[:, None] * (np.eye(along.size) + gradient)

    @cached_property
    def worn_rates(self) -> Array:
        """Rates of `worn` at nodes that move with the edges, (n, 4).

        With s^2 = r^2 - c^2 = b^2 z the slip beyond that of the unworn shape is s worn. At a place
        r it grows by p sigma - (2/pi) arccos(c/r) w_c'. A node keeps its z: r r' = c c' + z b b',
        so that

            worn' = p v + (b'/b) L + (c c'/s^2) (worn + L) - (2/pi) arccos(c/r) w_c'/s.
        """
        b = self.end
        columns = np.zeros((self.x.size, 4))
        columns[:, _WEAR] = self.pressure * self.slip
        columns[:, _END] = self.convected[0] / b
        if self.initial.stick_moves:
            columns[:, _STICK] = self.past_stick[0]
        if self.initial.stick_grows:
            # The growth of w_c lowers all slip outside.
            zeta = b * np.sqrt(self.initial.maps.squares)
            lever = 2 / np.pi * np.arctan2(zeta, self.stick) / zeta
            columns[:, _RETAINED] = -lever
            # The wear at the last node is the tilt there.
            value, slope = self.tilt
            columns[-1, _END] = (slope * self.motion[0, -1] - value / b) / b
            columns[-1, _STICK] = slope * self.motion[1, -1] / b
        return columns

    @property
    def moving(self) -> list[int]:
        """Columns of the edges that move."""
        moves = (True, self.initial.stick_moves, self.initial.constant_force)
        return [column for column, edge in enumerate(moves, _END) if edge]

    @cached_property
    def velocity(self) -> Array:
        """1 and the rates of b, c and w_c, or d."""
        found = np.array([1.0, 0.0, 0.0, 0.0])
        found[self.moving] = self._solve(self.conditions[:, _WEAR])
        return found

    @cached_property
    def rates(self) -> Array:
        """Rates of the whole vector."""
        worn = self.worn_rates @ self.velocity
        grows = self.initial.stick_grows
        tilt = self.tilt_rates * self.velocity[_RETAINED] if grows else self.tilt_terms
        return np.concatenate([worn[:-1], self.velocity[_END:], tilt])

    def _solve(self, right: Array) -> Array:
        """Rates of the moving edges at which the conditions stay met, by their other terms."""
        try:
            return np.asarray(-np.linalg.solve(self.conditions[:, self.moving], right))
        except np.linalg.LinAlgError:
            # Where the surface at the edge is flat the edge may move at any rate.
            detail = "the wear is not resolved at its edges: increase the resolution"
            raise AccuracyError(detail, ("resolution",)) from None

    @cached_property
    def conditions(self) -> Array:
        """Rates that are zero, one row for each edge that moves, (k, 4)."""
        rows = [self._outer_edge]
        if self.initial.constant_force or self.initial.stick_shrinks:
            rows.append(self._carried_force)
        if self.initial.stick_grows:
            worn_slope = self.x[0] * self.worn_omega[0] / self.offset[0]
            rows.append(np.array([0.0, 0.0, worn_slope, -1.0]))
        return np.array(rows)

    @cached_property
    def _omega_rates(self) -> Array:
        """Rates of `worn_omega` at the moving nodes, (n, 4)."""
        return np.asarray(self.initial.maps.from_slip @ self.worn_rates)

    @property
    def _radius_rate(self) -> Array:
        """Rate of the contact radius."""
        return np.array([0.0, *self.motion[:, -1], 0.0])

    @property
    def _amplitude_rate(self) -> Array:
        """Rate of D."""
        initial = self.initial
        grows = initial.constant_force and not initial.constant_displacement
        falls = self.stick_slope if initial.stick_shrinks else 0.0
        return np.array([0.0, 0.0, -falls, float(grows)])

    @property
    def _outer_edge(self) -> Array:
        """Rate of gamma(a) - D, with the return of its error.

        As gamma = x omega, it is a omega(a)' + a' omega(a) - D' + RETURN (gamma(a) - D).
        """
        omega, a = self._omega_rates[-1].copy(), self.x[-1]
        slope = float(self.initial.slope(self.x[-1:])[0])
        omega[_END:_RETAINED] += (slope - self.unworn[-1]) / a * self.motion[:, -1]
        omega[_STICK] -= self.stick_slope / a
        row = a * omega + self._radius_rate * self.omega[-1] - self._amplitude_rate
        row[_WEAR] += _RETURN * (self.gamma[-1] - self.reduced_amplitude)
        return row

    @property
    def _carried_force(self) -> Array:
        """Rate of the integral of the loads, normal or, where the stick zone shrinks, tangential.

        The integral of gamma_0 changes at its ends only: by values at nodes it would jump where one
        passes a break of the slope.
        """
        initial, a, b, c = self.initial, self.x[-1], self.end, self.stick
        # Rate of int_c^a (gamma - D) dx, with gamma(a) = D.
        rate = b * b * (initial.maps.mean @ self._omega_rates)
        rate -= self._radius_rate * a * self.worn_omega[-1]
        rate[_END] += 2 * self.worn_integral / b
        rate[_RETAINED] += (a - c) * float(initial.stick_grows)
        if initial.full_slip:
            rate[_WEAR] -= _RETURN * (self.force - initial.unworn_force(0.0))
        whole = np.array([0.0, 0.0, a * self.stick_slope, a])
        return (whole if initial.constant_force else c * self._amplitude_rate) - rate

    def gradients(self) -> tuple[Array, Array]:
        """Return the gradients by `worn`, of its rates (n, n) and of the velocity (4, n)."""
        initial, maps = self.initial, self.initial.maps
        b, (_, end, stick, _) = self.end, self.velocity
        stress = maps.to_pressure @ (self.lever[:, None] * maps.from_slip) / b
        direct = self.slip[:, None] * stress + end / b * self.convected[1]
        direct += np.diag(self.pressure)
        if initial.stick_moves:
            direct += stick * self.past_stick[1]
        direct[-1] = 0.0
        last, mean = maps.from_slip[-1], maps.mean @ maps.from_slip
        edge = end * self.motion[0, -1] + stick * self.motion[1, -1]
        rows = [self.x[-1] * (last @ direct) + (edge + _RETURN * self.x[-1]) * last]
        if initial.constant_force or initial.stick_shrinks:
            rows.append(-b * b * (mean @ direct) - 2 * b * end * mean)
            if initial.full_slip:
                rows[-1] += _RETURN * (b * b) * (last - mean)
        if initial.stick_grows:
            rows.append(stick * self.x[0] / self.offset[0] * maps.from_slip[0])
        edges = np.zeros((4, self.x.size))
        edges[self.moving] = self._solve(np.array(rows))
        return direct + self.worn_rates @ edges, edges
