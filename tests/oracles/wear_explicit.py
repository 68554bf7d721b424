"""Fretting wear cycle by cycle: an explicit scheme on a uniform grid of radii.

The scheme is independent of the product: no substitution, no moving coordinate, no implicit step.
All fields live on one grid r_i = i dr; f and q are linear between its points, so that each integral
of the method is elementary. Linear interpolation is first order at a square root, so the error is
about dr/a of the depth.

Per cycle: f -> g -> depth and stick level from the constant loads -> p and slip -> f += K mu p
4|s|. A wavy profile of wavenumber k causes a pressure of E* k/2 times its height, so the step is
stable only while 4 K mu S_max E* pi/(2 dr) stays below 2; several cycles are merged within that
bound.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@dataclass(frozen=True)
class Controls:
    """Quantities held constant over the cycles: exactly one of each pair [length or force]."""

    depth: float | None = None
    normal_force: float | None = None
    displacement: float | None = None
    tangential_force: float | None = None


@dataclass
class State:
    """State after `cycles`; `dissipated` is the accumulated friction work."""

    cycles: float
    profile: Array
    pressure: Array
    depth: float
    normal_force: float
    contact_radius: float
    stick_radius: float
    worn_volume: float
    dissipated: float


class Scene:
    """A profile f0(r) on the grid, E* and G*, the friction coefficient and K."""

    def __init__(
        self, r: Array, f0: Array, e_star: float, g_star: float, friction: float, wear: float
    ) -> None:
        self.r, self.f0 = r, np.array(f0)
        self.e_star, self.g_star, self.friction, self.wear = e_star, g_star, friction, wear
        self.dr = float(r[1] - r[0])
        low, high = r[:-1], r[1:]
        # g(x) = x sum of f'_k [arcsin(r/x)] over each piece below x.
        x = r[1:, None]
        part = np.arcsin(np.minimum(high / x, 1.0)) - np.arcsin(np.minimum(low / x, 1.0))
        self._forward = x * part
        # p(r) = -(1/pi) sum of q'_k [ln(x + sqrt(x^2 - r^2))] over each piece above r; on the axis,
        # where the logarithm is infinite for a tip, evaluated half a step off.
        at = np.maximum(r, self.dr / 2)[:, None]
        log_high, log_low = (
            np.log(np.maximum(end, at) + np.sqrt(np.maximum(end, at) ** 2 - at**2))
            for end in (high, low)
        )
        self._stress = -(log_high - log_low) / np.pi
        # s(r) = (2/pi) int u/sqrt(r^2 - x^2) dx with u linear on each piece.
        angle = np.arcsin(np.minimum(high / x, 1.0)) - np.arcsin(np.minimum(low / x, 1.0))
        root = np.sqrt(np.maximum(x**2 - low**2, 0.0)) - np.sqrt(np.maximum(x**2 - high**2, 0.0))
        slope_part = (root - low * angle) / self.dr
        slip = np.zeros((r.size, r.size))
        slip[1:, :-1] += angle - slope_part
        slip[1:, 1:] += slope_part
        # On the axis the kernel is a point's, whose integral is pi/2.
        slip[0, 0] = np.pi / 2
        self._slip = 2 / np.pi * slip

    def equivalent(self, f: Array) -> Array:
        """g on the grid."""
        return f[0] + np.append(0.0, self._forward @ (np.diff(f) / self.dr))

    def run(
        self,
        controls: Controls,
        cycles: list[float],
        safety: float = 0.4,
        longest: float = float("inf"),
    ) -> list[State]:
        """States at ascending numbers of cycles, with at most `longest` cycles per step."""
        f, count, dissipated, states = self.f0.copy(), 0.0, 0.0, []
        for target in cycles:
            while True:
                state, slip = self._state(f, controls, count, dissipated)
                if count >= target:
                    states.append(state)
                    break
                rate = self._rate(state, slip)
                bound = 4 * self.dr / (np.pi * self.e_star)
                per_cycle = self.wear * self.friction * 4 * float(slip.max())
                step = min(target - count, longest)
                if per_cycle > 0:
                    step = min(step, safety * bound / per_cycle)
                f = f + step * rate
                work = self.friction * state.pressure * 4 * slip
                dissipated += step * self._over_area(work)
                count += step
                if target - count < 1e-9 * target:
                    count = target
        return states

    def rate(self, f: Array, controls: Controls) -> Array:
        """df/dN of a profile on the grid."""
        return self._rate(*self._state(f, controls, 0.0, 0.0))

    def _rate(self, state: State, slip: Array) -> Array:
        return self.wear * self.friction * state.pressure * 4 * slip

    def _over_area(self, values: Array) -> float:
        return float(2 * np.pi * np.sum(values * self.r) * self.dr)

    def _state(
        self, f: Array, controls: Controls, count: float, dissipated: float
    ) -> tuple[State, Array]:
        g = self.equivalent(f)
        depth = controls.depth
        if depth is None:
            assert controls.normal_force is not None
            depth = self._root(lambda d: self._force(g, d) - controls.normal_force, g)
        load = np.maximum(depth - g, 0.0)
        # The contact ends at the first point out of contact.
        load[np.argmax(load <= 0) :] = 0.0
        if controls.displacement is not None:
            level = self.g_star * controls.displacement / (self.friction * self.e_star)
        else:
            assert controls.tangential_force is not None
            wanted = controls.tangential_force / (2 * self.friction * self.e_star)
            level = self._root(lambda v: self._sum(np.minimum(load, v)) - wanted, g)
        ahead = np.maximum(level - load, 0.0)
        ahead[load <= 0] = level
        compliance = self.friction * self.e_star / self.g_star
        slip = compliance * (self._slip @ ahead)
        pressure = np.maximum(self.e_star * (self._stress @ np.diff(load) / self.dr), 0.0)
        slip[load <= 0] = 0.0
        pressure[load <= 0] = 0.0
        last = int(np.argmax(load <= 0))
        edge = self.r[last - 1] + self.dr * load[last - 1] / (g[last] - g[last - 1])
        stuck = int(np.argmax(ahead > 0))
        rise = ahead[stuck] / max(load[stuck - 1] - load[stuck], 1e-300)
        stick = self.r[stuck] - self.dr * min(rise, 1.0)
        state = State(
            count,
            f,
            pressure,
            float(depth),
            2 * self.e_star * self._sum(load),
            float(edge),
            float(stick),
            self._over_area(f - self.f0),
            dissipated,
        )
        return state, slip

    def _sum(self, load: Array) -> float:
        """int load dx by the trapezoidal rule."""
        return float((load.sum() - load[0] / 2) * self.dr)

    def _force(self, g: Array, depth: float) -> float:
        return 2 * self.e_star * self._sum(np.maximum(depth - g, 0.0))

    @staticmethod
    def _root(function: object, g: Array) -> float:
        """Bisection between 0 and the last depth of the grid."""
        low, high = 0.0, float(g[-1])
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if function(middle) < 0 else (low, middle)  # type: ignore[operator]
        return (low + high) / 2
