"""Rates of change of the worn annulus with the number of cycles, and their Jacobian matrix.

In the units of `mdr_core.wear.annulus_state`. Source: notes, §11.
"""

from typing import Final

import numpy as np

from mdr_core.typing import Array
from mdr_core.wear.annulus_state import AnnulusModel, AnnulusState
from mdr_core.wear.edge_rates import EdgeBalance

# Step of a difference quotient, about the root of the rounding error.
_STEP: Final = 1e-7


class WearModel(AnnulusModel):
    """Right-hand side of the wear law on the nodes of the annulus."""

    def rates(self, vector: Array) -> Array:
        """Return the derivative of the vector with respect to the scaled number of cycles."""
        return self._rates(EdgeBalance(AnnulusState(self, vector)))

    def _rates(self, balance: EdgeBalance) -> Array:
        edges = balance.edges
        worn = balance.worn @ np.append(1.0, edges)
        found = [worn[:-1], edges, np.array([balance.state.power])]
        if self.tilt:
            found.append(self.tilt.rates(balance.state.shift) * balance.passing)
        return np.concatenate(found)

    def jacobian(self, vector: Array) -> Array:
        """Return the derivative of the rates with respect to the vector, for Newton's method.

        By the worn depth exactly, by the edges from differences; the tilt's effect on the edges'
        rates is neglected.
        """
        balance = EdgeBalance(AnnulusState(self, vector))
        state, n = balance.state, self.first_edge
        in_worn, in_edges = balance.gradients()
        in_omega = state.end**2 * self.maps.mean * (state.drive - 2 * state.gamma)
        gradient = np.concatenate([in_worn[:-1], in_edges, (in_omega @ self.maps.from_slip)[None]])
        found = np.zeros((vector.size, vector.size))
        if self.tilt:
            passing = in_edges[2] - balance.stick_slope * in_edges[1]
            rows = np.multiply.outer(self.tilt.rates(state.shift), passing)
            gradient = np.concatenate([gradient, rows])
            weights = self.tilt.weights(state.growth) / state.end
            found[:, n + 4 :] = np.multiply.outer(gradient[:, -1], weights)
        found[:, :n] = gradient[:, :-1]
        base = self._rates(balance)
        for edge in balance.unknown:
            step = _STEP * (state.offset[-1] if edge == 1 else 1.0)
            moved = vector.copy()
            moved[n + edge] += step
            found[:, n + edge] = (self.rates(moved) - base) / step
        return found
