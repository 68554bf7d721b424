"""Rates of change of the worn annulus with the number of cycles.

All rates are linear in the rates b' = db/dN, c' and d' of edges and depth: each is four numbers
times (1, b', c', d'). The edges follow from identities that hold at all times:

    gamma(a) = D, and d in full slip,
    int_0^a (d - g) dx is constant under a constant normal force,
    c D + int_c^a (D - gamma) dx is constant where the stick zone shrinks,
    gamma(c) = 0 where it grows over worn material.

The number of cycles is in the unit of `InitialState`. Source: notes, §11.
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

# Parts of a rate: due to wear alone, and per unit of the rates of b, of c, and of w_c or d.
_WEAR, _END, _STICK, _RETAINED = range(4)
# Rate at which the integrator's errors of gamma(a) - D, and of the force in full slip, decay: fast
# beside the wear, whose unit is 1, and slow beside the steps of the first cycles. By trial, rates
# from 1 to 1000 give results within their estimates in as many steps.
_RETURN: Final = 10.0


def rates(initial: InitialState, vector: Array) -> Array:
    """Return the derivative of vectors in the scaled number of cycles, (n,) or (n, k)."""
    found = _MovingAnnulus(initial, vector.reshape(len(vector), -1)).rates
    return found.reshape(vector.shape)


def jacobian(initial: InitialState, vector: Array) -> Array:
    """Return the derivative of the rates in the vector, for Newton's method, (n, n).

    It is exact in the worn depth, and a difference quotient in the edges; the effect of the tilt on
    the rates of the edges is neglected.
    """
    state = _MovingAnnulus(initial, vector[:, None])
    inner = initial.maps.squares.size - 1
    in_worn, in_edges = state.gradients()
    parts = [in_worn[:-1], in_edges[_END:]]
    if initial.stick_grows:
        parts.append(state.tilt_rates * in_edges[_RETAINED])
    gradient, found = np.concatenate(parts), np.zeros((vector.size, vector.size))
    found[:, :inner] = gradient[:, :-1]
    if initial.stick_grows:
        # The wear at the last node is the tilt there.
        found[:, inner + 3 :] = gradient[:, [-1]] * state.tilt_basis.T / state.end
    found *= initial.units.T / initial.units
    # The root of the rounding error suits a difference quotient.
    steps = sqrt(EPS) * np.array([1.0, initial.width / initial.length_unit, 1.0])
    moved = [edge - _END for edge in state.moving]
    edges = [inner + edge for edge in moved]
    near = rates(initial, vector[:, None] + steps[moved] * np.eye(vector.size)[:, edges])
    found[:, edges] = (near - state.rates) / steps[moved]
    return found


class _MovingAnnulus(AnnulusState):
    """Annulus with the rates of its edges, from the quantities that are constant."""

    @cached_property
    def stick_slope(self) -> Array:
        """g_0'(c) of a stick edge that moves."""
        if not self.initial.stick_moves:
            return 0 * self.stick_radius
        return self.initial.slope(self.stick_radius)

    @cached_property
    def motion(self) -> Array:
        """dx/dN of the nodes per unit of the rates of b and c, (2, n, k)."""
        return np.stack([self.end * self.initial.maps.squares / self.x, self.stick_radius / self.x])

    def _along(self, slope: Array) -> Array:
        """L = 2 z d worn/dz, by one of the two maps to slopes.

        Material outside a shrinking stick zone has worn exponentially with its distance from the
        edge, so that v differs by orders of magnitude between neighbours. The slope of ln(v/z)
        keeps v positive there; the slope of v overshoots where the layer is thin.
        """
        if not self.initial.stick_shrinks:
            return np.asarray(slope @ self.worn)
        v, first = self.slip, self.slip - self.worn
        steep = 2 + slope @ np.log(v / self.initial.maps.squares)
        return np.asarray(self.worn * steep + first * (slope @ np.log1p(self.worn / first)))

    def _along_gradient(self, slope: Array) -> Array:
        """Gradient of L in `worn`, for a single state."""
        if not self.initial.stick_shrinks:
            return slope
        v = self.slip[:, 0]
        steep = 2 + slope @ np.log(v / self.initial.maps.squares[:, 0])
        return np.asarray(np.diag(steep) + v[:, None] * slope / v)

    @cached_property
    def worn_rates(self) -> Array:
        """Rates of `worn` at nodes that move with the edges, (4, n, k).

        With s^2 = r^2 - c^2 = b^2 z the slip in excess of the unworn shape is s worn. At a place
        r it grows by p sigma - (2/pi) arccos(c/r) w_c'. A node keeps its z: r r' = c c' + z b b',
        so that

            worn' = p v + (b'/b) L + (c c'/s^2) (worn + L) - (2/pi) arccos(c/r) w_c'/s.
        """
        initial, maps, b = self.initial, self.initial.maps, self.end
        rate = np.zeros((4, *self.x.shape))
        rate[_WEAR] = initial.length_unit / initial.depth_unit * self.stress * self.slip
        along = self._along(maps.inward)
        # In full slip the worn depth is b times `worn`.
        rate[_END] = (along - self.worn if initial.full_slip else along) / b
        if initial.stick_moves:
            along = along if initial.stick_grows else self._along(maps.outward)
            rate[_STICK] = self.stick_radius / (b**2 * maps.squares) * (self.worn + along)
        if initial.stick_grows:
            # The growth of w_c lowers all slip outside.
            zeta = b * np.sqrt(maps.squares)
            rate[_RETAINED] = -2 / np.pi * np.arctan2(zeta, self.stick_radius) / zeta
            # The wear at the last node is the tilt there.
            value, slope = self.tilt
            rate[_END, -1] = (slope * self.motion[0, -1] - value / b) / b
            rate[_STICK, -1] = slope * self.motion[1, -1] / b
        return rate

    @property
    def moving(self) -> list[int]:
        """Edges that move."""
        moves = (True, self.initial.stick_moves, self.initial.constant_force)
        return [edge for edge, moved in enumerate(moves, _END) if moved]

    @cached_property
    def velocity(self) -> Array:
        """1 and the rates of b, c and w_c, or d, (4, k)."""
        found = np.zeros((4, self.end.size))
        found[_WEAR] = 1.0
        found[self.moving] = self._solve(self.conditions[:, _WEAR].T[:, :, None])[:, :, 0].T
        return found

    def _solve(self, right: Array) -> Array:
        """Rates of the moving edges that keep the conditions met, given their other terms."""
        conditions = self.conditions[:, self.moving].transpose(2, 0, 1)
        try:
            return np.asarray(-np.linalg.solve(conditions, right))
        except np.linalg.LinAlgError:
            # Where the surface at the edge is flat the edge may move at any rate.
            detail = "the wear is not resolved at its edges: increase the resolution"
            raise AccuracyError(detail, ("resolution",)) from None

    @property
    def rates(self) -> Array:
        """Rates of the whole vector."""
        worn = (self.worn_rates * self.velocity[:, None]).sum(axis=0)
        parts = [worn[:-1], self.velocity[_END:]]
        if self.initial.stick_grows:
            parts.append(self.tilt_rates * self.velocity[_RETAINED])
        return np.concatenate(parts) / self.initial.units

    @cached_property
    def conditions(self) -> Array:
        """Rates of depths that must be zero, one for each edge that moves, (m, 4, k)."""
        rows = [self._outer_edge]
        if self.initial.constant_force or self.initial.stick_shrinks:
            rows.append(self._carried_force / self.initial.length_unit)
        if self.initial.stick_grows:
            row = np.zeros((4, self.end.size))
            row[_STICK] = self.x[0] * self.worn_omega[0] / self.offset[0]
            row[_RETAINED] = -1.0
            rows.append(row)
        return np.array(rows)

    @cached_property
    def _radius_rate(self) -> Array:
        """Rate of the contact radius."""
        rate = np.zeros((4, self.end.size))
        rate[_END:_RETAINED] = self.motion[:, -1]
        return rate

    @property
    def _amplitude_rate(self) -> Array:
        """Rate of D."""
        initial, rate = self.initial, np.zeros((4, self.end.size))
        if initial.stick_shrinks:
            rate[_STICK] = -self.stick_slope
        if initial.constant_force and not initial.constant_displacement:
            rate[_RETAINED] = 1.0
        return rate

    @property
    def _outer_edge(self) -> Array:
        """Rate of gamma(a) - D, plus a term that drives its error to zero.

        As gamma = x omega, it is a omega(a)' + a' omega(a) - D' + RETURN (gamma(a) - D).
        """
        omega, a = self.initial.maps.from_slip[-1] @ self.worn_rates, self.x[-1]
        slope = self.initial.slope(a)
        omega[_END:_RETAINED] += (slope - self.unworn[-1]) / a * self.motion[:, -1]
        omega[_STICK] -= self.stick_slope / a
        whole = self.gamma[-1] / self.lever[-1]
        row = a * omega + self._radius_rate * whole - self._amplitude_rate
        row[_WEAR] += _RETURN * (self.gamma[-1] - self.reduced_amplitude)
        return np.asarray(row)

    @property
    def _carried_force(self) -> Array:
        """Rate of the integral of the loads, normal or, where the stick zone shrinks, tangential.

        The integral of gamma_0 changes at its ends only: a sum over nodes would jump when a node
        passes a break of the slope.
        """
        initial, maps, a, b, c = (
            self.initial,
            self.initial.maps,
            self.x[-1],
            self.end,
            self.stick_radius,
        )
        # Rate of int_c^a (gamma - D) dx, with gamma(a) = D.
        rate = b * b * (maps.mean @ maps.from_slip @ self.worn_rates)
        rate -= self._radius_rate * a * self.worn_omega[-1]
        rate[_END] += 2 * self.worn_integral / b
        rate[_RETAINED] += (a - c) * float(initial.stick_grows)
        if initial.full_slip:
            rate[_WEAR] -= _RETURN * (self.force - initial.unworn_force(0 * a))
        if not initial.constant_force:
            return np.asarray(c * self._amplitude_rate - rate)
        rate[_STICK] -= a * self.stick_slope
        rate[_RETAINED] -= a
        return -rate

    def gradients(self) -> tuple[Array, Array]:
        """Return the gradients in `worn`, of its rates (n, n) and of the velocity (4, n).

        The state must be a single one.
        """
        initial, maps, worn_rates = self.initial, self.initial.maps, self.worn_rates[:, :, 0]
        (b,), (_, end, stick, _) = self.end, self.velocity[:, 0]
        stress = maps.to_pressure @ (self.lever * maps.from_slip) / b
        direct = self.slip * stress + np.diag(self.stress[:, 0])
        direct *= initial.length_unit / initial.depth_unit
        along = self._along_gradient(maps.inward)
        direct += end / b * (along - np.eye(len(along)) if initial.full_slip else along)
        if initial.stick_moves:
            along = along if initial.stick_grows else self._along_gradient(maps.outward)
            scale = self.stick_radius / (b**2 * maps.squares)
            direct += stick * scale * (np.eye(len(along)) + along)
        direct[-1] = 0.0
        last, mean, a = maps.from_slip[-1], maps.mean @ maps.from_slip, self.x[-1]
        edge = end * self.motion[0, -1] + stick * self.motion[1, -1]
        rows = [a * (last @ direct) + (edge + _RETURN * a) * last]
        if initial.constant_force or initial.stick_shrinks:
            rows.append(-b * b * (mean @ direct) - 2 * b * end * mean)
            if initial.full_slip:
                rows[-1] += _RETURN * (b * b) * (last - mean)
            rows[-1] /= initial.length_unit
        if initial.stick_grows:
            rows.append(stick * self.x[0] / self.offset[0] * maps.from_slip[0])
        edges = np.zeros((4, len(direct)))
        edges[self.moving] = self._solve(np.array(rows)[None])[0]
        return direct + worn_rates.T @ edges, edges
