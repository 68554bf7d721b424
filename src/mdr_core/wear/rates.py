"""Rates of change of the worn annulus with the number of cycles, and their Jacobian matrix.

The contact's edge, the stick edge and the depth follow from the quantities that are constant. In
the units of `mdr_core.wear.initial_state`. Source: notes, §11.
"""

from functools import cached_property
from typing import Final

import numpy as np

from mdr_core.errors import AccuracyError
from mdr_core.typing import Array
from mdr_core.wear.annulus_state import AnnulusState
from mdr_core.wear.initial_state import InitialState

# Step of a difference quotient, about the root of the rounding error.
_STEP: Final = 1e-7
# Rate at which the integrator's error of gamma(a) - D decays: fast beside the wear, whose unit is
# 1, and slow beside the steps of the first cycles.
_RETURN: Final = 10.0


def rates(initial: InitialState, vector: Array) -> Array:
    """Return the derivative of the vector with respect to the scaled number of cycles."""
    return _MovingAnnulus(initial, vector).rates


def jacobian(initial: InitialState, vector: Array) -> Array:
    """Return the derivative of the rates with respect to the vector, for Newton's method.

    By the worn depth exactly, by the edges from differences; the tilt's effect on the edges'
    rates is neglected.
    """
    state = _MovingAnnulus(initial, vector)
    n, maps = initial.first_edge, initial.maps
    in_worn, in_edges = state.gradients()
    in_omega = state.end**2 * maps.mean * (state.reduced_amplitude - 2 * state.gamma)
    gradient = np.concatenate([in_worn[:-1], in_edges, (in_omega @ maps.from_slip)[None]])
    found = np.zeros((vector.size, vector.size))
    if initial.stick_grows:
        passing = in_edges[2] - state.stick_slope * in_edges[1]
        gradient = np.concatenate([gradient, np.multiply.outer(state.tilt_rates, passing)])
        found[:, n + 4 :] = np.multiply.outer(gradient[:, -1], state.tilt_basis[0] / state.end)
    found[:, :n] = gradient[:, :-1]
    for edge in state.unknown:
        step = _STEP * (state.offset[-1] if edge == 1 else 1.0)
        moved = vector.copy()
        moved[n + edge] += step
        found[:, n + edge] = (rates(initial, moved) - state.rates) / step
    return found


class _MovingAnnulus(AnnulusState):
    """Rates of the edges from the constant quantities; all others are linear in them.

    Columns: by wear alone, and per unit of the rates of b, c and d.
    """

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

    @cached_property
    def inward(self) -> tuple[Array, Array]:
        """2 z d worn/dz for material that moves inwards, and its gradient in `worn`."""
        return self._along(self.initial.maps.inward)

    @cached_property
    def outward(self) -> tuple[Array, Array]:
        """2 z d worn/dz for material that moves outwards, and its gradient in `worn`."""
        return self._along(self.initial.maps.outward)

    def _along(self, slope: Array) -> tuple[Array, Array]:
        """2 z d worn/dz and its gradient in `worn`, by a map to slopes.

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
        """Rate of `worn` per unit of the rate of c, and its gradient in `worn`."""
        along, gradient = self.inward if self.initial.stick_grows else self.outward
        scale = self.stick / (self.end**2 * self.initial.maps.squares)
        return scale * (self.worn + along), scale[:, None] * (np.eye(along.size) + gradient)

    @cached_property
    def worn_rates(self) -> Array:
        """Rates of `worn` at nodes that move with the edges, (n, 4)."""
        b = self.end
        columns = np.zeros((self.x.size, 4))
        columns[:, 0] = self.pressure * self.slip
        columns[:, 1] = self.inward[0] / b
        if self.initial.stick_moves:
            columns[:, 2] = self.past_stick[0]
        if self.initial.stick_grows:
            # The growth of w_c lowers all slip outside.
            zeta = b * np.sqrt(self.initial.maps.squares)
            lever = 2 / np.pi * np.arctan2(zeta, self.stick) / zeta
            columns[:, 2] += lever * self.stick_slope
            columns[:, 3] = -lever
            value, slope = self.tilt
            columns[-1, 1] = (slope * self.motion[0, -1] - value / b) / b
            columns[-1, 2] = slope * self.motion[1, -1] / b + lever[-1] * self.stick_slope
        return columns

    @cached_property
    def edges(self) -> Array:
        """Rates of b, c and d."""
        found = np.zeros(3)
        found[self.unknown] = self._solve(self.rows[:, 0])
        return found

    @cached_property
    def rates(self) -> Array:
        """Rates of the whole vector."""
        worn = self.worn_rates @ np.append(1.0, self.edges)
        found = [worn[:-1], self.edges, np.array([self.power])]
        if self.initial.stick_grows:
            found.append(self.tilt_rates * (self.edges[2] - self.stick_slope * self.edges[1]))
        return np.concatenate(found)

    @property
    def unknown(self) -> list[int]:
        """Indices of the edges that move, of b, c and d."""
        return [0] + [1] * self.initial.stick_moves + [2] * self.initial.constant_force

    def _solve(self, right: Array) -> Array:
        square = self.rows[:, 1:][:, self.unknown]
        try:
            return np.asarray(-np.linalg.solve(square, right))
        except np.linalg.LinAlgError:
            # Where the surface at the edge is flat the edge may move at any rate.
            raise AccuracyError("the wear over the cycles was not resolved at its edges") from None

    @cached_property
    def rows(self) -> Array:
        """Rates that are zero: of gamma(a) - D, of the constant force, of gamma(c).

        One row for each unknown edge, (k, 4).
        """
        initial, maps = self.initial, self.initial.maps
        a, b, c = self.x[-1], self.end, self.stick
        # Rates of (gamma - gamma_0)/x at the moving nodes, and of omega at the edge.
        worn = maps.from_slip @ self.worn_rates
        omega = worn[-1].copy()
        slope = float(initial.slope(self.x[-1:])[0])
        omega[1:3] += (slope - self.unworn[-1]) / a * self.motion[:, -1]
        omega[2] -= self.stick_slope / a
        # Rates of D and of d - D, the depth g(c) of the stick edge.
        grows = initial.constant_force and not initial.constant_displacement
        amplitude_rate = np.array([0.0, 0.0, 0.0, float(grows)])
        stick_depth_rate = np.array([0.0, 0.0, 0.0, float(initial.stick_grows)])
        if initial.stick_shrinks:
            amplitude_rate[2], stick_depth_rate[2] = -self.stick_slope, self.stick_slope
        edge = np.array([0.0, *self.motion[:, -1], 0.0])
        rows = [a * omega + edge * self.omega[-1] - amplitude_rate]
        rows[0][0] += _RETURN * (self.gamma[-1] - self.reduced_amplitude)
        if initial.constant_force or initial.stick_shrinks:
            # Rate of int_c^a (gamma - D) dx, with gamma(a) = D. The integral of gamma_0 changes at
            # its ends only: by values at nodes it would jump where one passes a break of the slope.
            integral_rate = b * b * (maps.mean @ worn) - edge * a * self.worn_omega[-1]
            integral_rate[1] += 2 * self.worn_integral / b
            integral_rate[2] -= (a - c) * self.stick_slope
            integral_rate += (a - c) * stick_depth_rate
            total = np.array([0, 0, 0, a]) if initial.constant_force else c * amplitude_rate
            rows.append(total - integral_rate)
        if initial.stick_grows:
            rows.append(np.array([0.0, 0.0, self.gamma[0] / self.offset[0], -1.0]))
        return np.array(rows)

    def gradients(self) -> tuple[Array, Array]:
        """Return the gradients by `worn`, of its rates (n, n) and of the edges' rates (3, n)."""
        initial, maps = self.initial, self.initial.maps
        b, (end, stick, _) = self.end, self.edges
        stress = maps.to_pressure @ (self.x[:, None] * maps.from_slip) / b
        direct = self.slip[:, None] * stress + end / b * self.inward[1]
        direct += np.diag(self.pressure)
        if initial.stick_moves:
            direct += stick * self.past_stick[1]
        direct[-1] = 0.0
        last, mean = maps.from_slip[-1], maps.mean @ maps.from_slip
        edge = end * self.motion[0, -1] + stick * self.motion[1, -1]
        rows = [self.x[-1] * (last @ direct) + (edge + _RETURN * self.x[-1]) * last]
        if initial.constant_force or initial.stick_shrinks:
            rows.append(-b * b * (mean @ direct) - 2 * b * end * mean)
        if initial.stick_grows:
            rows.append(stick * self.x[0] / self.offset[0] * maps.from_slip[0])
        edges = np.zeros((3, self.x.size))
        edges[self.unknown] = self._solve(np.array(rows))
        return direct + self.worn_rates[:, 1:] @ edges, edges
