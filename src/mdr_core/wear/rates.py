"""How fast the worn annulus changes with the cycles: the right-hand side and its unknown edges.

All in units of the annulus' first coordinate b_0 = sqrt(a_0^2 - c_0^2) along the surface and of
D_0 = d_0 - g_0(c_0) across it; the cycles in units of b_0/(kappa E* D_0), kappa = 4 K mu^2 E*/G*.

A slipping point has |s| = mu (E*/G*) sigma, sigma = (2/pi) int_c^r (g - g(c))/sqrt(r^2 - x^2) dx,
and wears by dh/dN = kappa p sigma. While the stick edge rests sigma = S_0 + h: the slip grows by
just what is worn off. Source: notes, §11.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.errors import AccuracyError
from mdr_core.lazy import cached_property
from mdr_core.typing import Array
from mdr_core.wear.annulus_maps import AnnulusMaps

# Where y = (sigma - S_0)/s at the inner nodes ends in the state, and what follows it.
_EDGES = 4
# Part of D by which g has risen at the first node when its layer has become too thin, if that is
# more than twice what it rises by at first.
_RISEN = 0.02
# Beyond this part of itself the volume's rate is taken as it is.
_LARGEST_MISS = 0.2
# A cycle's work, over b_0/a, from which on it and the volume's rate are noise, and the wear that is
# left no longer counts.
_FAINT = 1e-4


@dataclass(frozen=True)
class Control:
    """What is held: it decides which of the edges and of the depth move."""

    force: bool
    """The normal force is held and the depth rises; else the depth is held."""
    displacement: bool
    """The tangential displacement is held, D = d - g(c) with it; else the force, and c with it."""

    @property
    def stick_moves(self) -> bool:
        """A rising depth under a held displacement drags the stick edge outwards."""
        return self.force and self.displacement


@dataclass(frozen=True)
class Shape:
    """The unworn g_0 in the units of the annulus: its rise above g_0(c_0), and its slope."""

    rise: Callable[[Array], Array]
    slope: Callable[[Array], Array]


@dataclass(frozen=True)
class Outside:
    """C(r) = sigma - S_0 - h beyond the contact, on Chebyshev points in 1/r, start < r < stop.

    Where the stick edge has moved, what the passed springs keep of their wear, w_c, tilts the
    surface outside it by C = -(2/pi) int arccos(c/r) dw_c.
    """

    start: float
    stop: float
    count: int = 16

    @cached_property
    def radii(self) -> Array:
        """Where C is kept."""
        return 1 / (1 / self.stop + self._range * (1 + chebyshev.chebpts1(self.count)) / 2)

    @property
    def _range(self) -> float:
        length = 1 / self.start - 1 / self.stop
        if not length > 0:
            detail = "the slip annulus is narrower than the rounding of its radius"
            raise AccuracyError(detail, ("oscillation",))
        return length

    @cached_property
    def _inverse(self) -> Array:
        return np.asarray(
            np.linalg.inv(chebyshev.chebvander(chebyshev.chebpts1(self.count), self.count - 1))
        )

    def at(self, values: Array, radius: float) -> tuple[float, float]:
        """C and its slope at a radius."""
        series = self._inverse @ values
        scale = 2 / self._range
        place = (1 / radius - 1 / self.stop) * scale - 1
        slope = chebyshev.chebval(place, chebyshev.chebder(series))
        return float(chebyshev.chebval(place, series)), float(-slope * scale / radius**2)


@dataclass(frozen=True)
class State:
    """One moment: what the integrator's vector means, and the fields that follow from it."""

    system: "System"
    vector: Array

    @property
    def end(self) -> float:
        """b = sqrt(a^2 - c^2)."""
        return float(self.vector[-_EDGES - self.system.kept])

    @property
    def stick(self) -> float:
        """c."""
        # Of c itself the integrator would not keep the digits of a narrow annulus.
        return self.system.first_stick + float(self.vector[1 - _EDGES - self.system.kept])

    @property
    def risen(self) -> float:
        """d - d_0."""
        return float(self.vector[2 - _EDGES - self.system.kept])

    @property
    def work(self) -> float:
        """Int of int_c^a (D - gamma) gamma dx over the cycles."""
        return float(self.vector[3 - _EDGES - self.system.kept])

    @property
    def drive(self) -> float:
        """D = d - g(c), the displacement's image."""
        return 1.0 if self.system.control.displacement else 1.0 + self.risen

    @cached_property
    def outer(self) -> tuple[float, float]:
        """C(a) and C'(a)."""
        outside = self.system.outside
        if outside is None:
            return 0.0, 0.0
        return outside.at(self.vector[-outside.count :], float(self.x[-1]))

    @cached_property
    def x(self) -> Array:
        """Radii of the nodes; the last one is a."""
        return np.sqrt(self.stick**2 + self.end**2 * self.system.maps.squares)

    @cached_property
    def unworn(self) -> Array:
        """(g_0(x) - g_0(c))/x."""
        shape = self.system.shape
        rise = shape.rise(self.x)
        if self.system.control.stick_moves:
            rise = rise - shape.rise(np.array([self.stick]))
        return rise / self.x

    @cached_property
    def worn(self) -> Array:
        """y = (sigma - S_0)/s: while the stick edge rests, the worn depth over s."""
        inner = self.vector[: self.system.maps.zeta.size - 1]
        return np.append(inner, self.outer[0] / self.end)

    @cached_property
    def omega(self) -> Array:
        """(g(x) - g(c))/x."""
        return np.asarray(self.unworn + self.system.maps.from_slip @ self.worn)

    @cached_property
    def gamma(self) -> Array:
        """g(x) - g(c)."""
        return self.x * self.omega

    @cached_property
    def smooth_pressure(self) -> Array:
        """p b/(E* sqrt(1 - zeta^2))."""
        return np.asarray(self.system.maps.to_pressure @ self.gamma)

    @cached_property
    def pressure(self) -> Array:
        """p/E* at the nodes."""
        return self.smooth_pressure * self.system.root / self.end

    @cached_property
    def slip(self) -> Array:
        """v = sigma/s."""
        return np.asarray(self.system.maps.to_slip @ self.unworn + self.worn)

    @property
    def gained(self) -> float:
        """int_c^a (g - g(c)) dx."""
        return float(self.end**2 * (self.system.maps.mean @ self.omega))

    @property
    def power(self) -> float:
        """int_c^a (D - gamma) gamma dx: the friction work of a cycle. Source: notes, §6."""
        maps = self.system.maps
        rest = self.drive - maps.fine @ self.gamma
        return float(self.end**2 * (maps.fine_weights @ (rest * (maps.fine @ self.omega))))


@dataclass(frozen=True)
class System:
    """The maps, the shape and what is held: all that the rates depend on."""

    maps: AnnulusMaps
    shape: Shape
    control: Control
    first_stick: float
    """c_0."""
    outside: Outside | None = None

    @cached_property
    def root(self) -> Array:
        """sqrt(1 - zeta^2)."""
        return np.sqrt((1 - self.maps.zeta) * (1 + self.maps.zeta))

    @cached_property
    def kept(self) -> int:
        """How many values of C the state carries."""
        return self.outside.count if self.outside else 0

    @property
    def start(self) -> Array:
        """The state before the first cycle."""
        edges = (1.0, 0.0, 0.0, 0.0)
        return np.concatenate([np.zeros(self.maps.zeta.size - 1), edges, np.zeros(self.kept)])

    def rates(self, vector: Array, *, moving: bool) -> Array:
        """Change of the state with the scaled number of cycles.

        The rates of b, c and d follow from what stays: g(a) = d, the normal force, and no
        jump of g at a moving stick edge. All are linear in them.
        """
        state = State(self, vector)
        columns = _Columns(state, moving=moving)
        edge, stick, rise = columns.solve()
        change = columns.worn @ np.array([1.0, edge, stick, rise])
        passed = rise - stick * columns.slope_at_stick if self.control.stick_moves else 0.0
        kept = (
            -2 / np.pi * np.arccos(state.stick / self.outside.radii) * passed
            if self.outside
            else np.empty(0)
        )
        clock = _clock(
            state.power, columns.volume(change, edge, stick, passed), _FAINT / float(state.x[-1])
        )
        moves = np.concatenate([change[:-1], (edge, stick, rise, 0.0), kept])
        moves *= clock
        moves[self.maps.zeta.size + 2] = state.power
        return moves

    def settling(self, vector: Array) -> float:
        """Positive once the layer in which g rises behind the stick edge is thinner than resolved.

        Then g has risen by the first node already, and that node wears faster than the rising
        depth relieves it: the edge rests from there on.
        """
        state = State(self, vector)
        rise = _Columns(state, moving=True).solve()[2]
        relief = 4 / np.pi * rise / state.stick
        wear = float(state.pressure[0] * state.slip[0])
        part = max(_RISEN, 2 * float(self.maps.squares[0]))
        return min(wear - relief, float(state.gamma[0]) - part * state.drive)


def _clock(power: float, volume: float, faint: float) -> float:
    """What all rates are multiplied by, so that the volume follows the friction work.

    The rates are one factor, the wear, times functions of the state. What the nodes do not
    resolve at the edges makes that factor wrong by little; the work does not suffer from it.
    """
    if not abs(2 * power - volume) < _LARGEST_MISS * abs(volume):
        return 1.0
    return 1.0 + (2 * power / volume - 1.0) * power / (power + faint)


class _Columns:
    """Rates as columns: what happens by itself, and per unit of the rates of b, c and d."""

    def __init__(self, state: State, *, moving: bool) -> None:
        self.state, self.moving = state, moving
        self.system = state.system
        self.slope_at_stick = (
            float(self.system.shape.slope(np.array([state.stick]))[0])
            if self.system.control.stick_moves
            else 0.0
        )
        maps, b, c = self.system.maps, state.end, state.stick
        # dx/dN of the nodes per unit of the rates of b and c.
        self.shift = np.stack([b * maps.squares, np.full(maps.zeta.size, c)]) / state.x
        self.worn = self._worn_columns()

    def _worn_columns(self) -> Array:
        """dy/dN at a node that moves with the edges, (nodes, 4)."""
        state, maps, b, c = self.state, self.system.maps, self.state.end, self.state.stick
        along = 2 * maps.squares * (maps.derivative @ state.worn)
        columns = np.zeros((maps.zeta.size, 4))
        columns[:, 0] = state.pressure * state.slip
        columns[:, 1] = along / b
        columns[-1, :2] = 0.0, 0.0
        if self.system.control.stick_moves:
            # What the rise of g(c) - g_0(c) takes from all slip outside, per unit of it.
            tilt = 2 / np.pi * np.arctan2(b * maps.zeta, c) / (b * maps.zeta)
            columns[:, 2] = (state.worn + along) * c / (b * b * maps.squares)
            columns[:, 2] += tilt * self.slope_at_stick
            columns[:, 3] = -tilt
            value, slope = state.outer
            columns[-1, 1] = (slope * self.shift[0, -1] - value / b) / b
            columns[-1, 2] = slope * self.shift[1, -1] / b + tilt[-1] * self.slope_at_stick
        return columns

    def volume(self, change: Array, edge: float, stick: float, passed: float) -> float:
        """dV/dN of the worn volume."""
        state, maps, b, c, a = self.state, self.system.maps, *self._ends
        rate = b * b * (3 * edge * (maps.volume @ state.worn) + b * (maps.volume @ change))
        if self.system.control.stick_moves:
            # What the passed springs keep shows outside the stick edge as well.
            rate += passed / np.pi * (a * a * np.arctan2(b, c) - c * b)
            rate -= (self.shift[0, -1] * edge + self.shift[1, -1] * stick) * a * state.outer[0]
        return float(2 * np.pi * rate)

    @property
    def _ends(self) -> tuple[float, float, float]:
        """b, c and a."""
        return self.state.end, self.state.stick, float(self.state.x[-1])

    def solve(self) -> tuple[float, float, float]:
        """Rates of b, c and d."""
        state, maps, control = self.state, self.system.maps, self.system.control
        a, b, c = state.x[-1], state.end, state.stick
        slope = self.system.shape.slope(state.x)
        # d omega/dN, first of g_0 at the moving nodes, then of the wear.
        omega = maps.from_slip @ self.worn
        omega[:, 1:3] += ((slope - state.unworn) / state.x)[:, None] * self.shift.T
        omega[:, 2] -= self.slope_at_stick / state.x
        follow = 0.0 if control.displacement else 1.0
        at_edge = a * omega[-1]
        at_edge[1:3] += self.shift[:, -1] * state.omega[-1]
        at_edge[3] -= follow
        rows = [at_edge]
        unknown = [1]
        if control.force:
            load = -(b**2) * (maps.mean @ omega)
            load[1] -= 2 * b * (maps.mean @ state.omega)
            load[1:3] += state.drive * self.shift[:, -1]
            load[3] += c + follow * (a - c)
            rows.append(load)
            unknown.append(3)
        if self.moving:
            rows.append(maps.at_stick @ self.worn)
            unknown.append(2)
        system = np.array(rows)
        found = np.zeros(4)
        try:
            found[unknown] = np.linalg.solve(system[:, unknown], -system[:, 0])
        except np.linalg.LinAlgError:
            # The surface at the edge is so flat that the edge may move at any rate.
            raise AccuracyError("the wear over the cycles was not resolved at its edges") from None
        return float(found[1]), float(found[2]), float(found[3])
