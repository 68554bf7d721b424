"""Virgin curves of torsion: rotation, torque and friction work over the stick radius.

A twist turns nested discs of all radii from c to a, so that the traction is mu p outside c. The
rotation is proportional to

    P(c) = int_c^a K(c/x) dg(x)/x,    K(q) = int_0^(pi/2) dt/sqrt(cos^2 t + q^2 sin^2 t).

In ln c, and beyond a break b in arcsinh(sqrt(c^2 - b^2)/b), P is analytic in a strip of half-width
pi/2. It is stored on pieces from the contact edge inwards, as the distance from the top of a piece
times a Chebyshev series, which keeps its relative accuracy in a narrow slip annulus.

Source: notes, §16; jaeger.
"""

from functools import cached_property, lru_cache, partial
from typing import Any, Final

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import ellipkm1

from mdr_core.abel.displacement import Branch, smooth_parts
from mdr_core.doubles import EPS, TINY
from mdr_core.elementwise import quotient
from mdr_core.inversion import invert
from mdr_core.profiles import Profile
from mdr_core.quadrature import NODES, STEEP, composite_rule
from mdr_core.typing import Array, Indices

DEEPEST: Final = -float(np.log(EPS))
"""ln(a/c) beyond which a - c equals a in double precision."""
# Length of a piece at which a strip of half-width pi/2 leaves 6.4^-NODES: rounding error.
_LONGEST: Final = 1.0


@lru_cache(maxsize=64)
def _chebyshev(points: int) -> tuple[Array, Array]:
    """Return Chebyshev's nodes in [0, 1], ascending, and the matrix from values to coefficients."""
    nodes = chebyshev.chebpts1(points)
    matrix: Array = np.linalg.inv(chebyshev.chebvander(nodes, points - 1)).astype(float)
    return (1 + nodes) / 2, matrix


_NODES, _MATRIX = _chebyshev(NODES)
# Weights of the integrals from 0 to each of the nodes, and to 1.
_SUMS: Final = chebyshev.chebint(_MATRIX, lbnd=-1) / 2
_UP_TO: Final = chebyshev.chebval(2 * np.append(_NODES, 1.0) - 1, _SUMS).T
# Matrix from a series to the series of its derivative over the relative position in the piece.
_SLOPES: Final = 2 * np.pad(chebyshev.chebder(_MATRIX), ((0, 1), (0, 0)))
_ALL: Final = slice(None), slice(None)


class VirginCurves:
    """Virgin curves of n contacts with one profile.

    Pieces have arrays of shape (pieces, n). A place on a curve is given by the distance `along`
    from the top of a piece, and by the indices `at` of its piece and contact.
    """

    def __init__(self, profile: Profile, edge: Array, depth: float) -> None:
        """Compute the curves of the contacts.

        Parameters
        ----------
        profile : its parameters are single numbers.
        edge : contact radii as contact coordinates, > 0, shape (n,).
        depth : ln(a/c) at the end of the curves.
        """
        self.a, punch, self.depth = profile.contact_radius(edge), profile.is_flat_punch, depth
        # A flat punch is a flat with one step of g, at the edge.
        self.step = edge / self.a if punch else 0 * self.a
        flat, past = (0.0, self.a) if punch else (float(profile.first_radius), edge)
        # Beyond another flat, a may round to its radius.
        parts = [
            (part.base, max(part.base, part.start), part.stop, owner)
            for owner, branch in enumerate(() if punch else profile.branches)
            for part in smooth_parts([branch], np.nextafter(self.a.max(), np.inf))
        ]
        if not parts or parts[0][1] > 0:
            parts.insert(0, (0.0, 0.0, parts[0][1] if parts else np.inf, -1))
        base, low, stop, owner = (np.array(each)[::-1, None] for each in zip(*parts, strict=True))
        # Distances from the base are more accurate than radii next to a flat.
        bottom = np.clip(self.a * np.exp(-depth), low, stop) - base
        top = np.maximum(np.minimum(stop - base, past + (flat - base)), bottom)
        root, inner = (np.sqrt(each * (2 * base + each)) for each in (top, bottom))
        crossed = root * (base + bottom) + inner * (base + top)
        fall = (top - bottom) * (2 * base + top + bottom)
        length = np.arcsinh(fall / np.maximum(crossed, TINY))
        longest = _LONGEST / max(profile.steepness / STEEP, 1.0)
        row = np.repeat(np.arange(len(base)), np.ceil(length.max(axis=1) / longest).astype(int))
        before = np.arange(row.size) - np.searchsorted(row, row)
        self.length = length[row] / np.bincount(row)[row, None]
        start = before[:, None] * self.length
        self.base = np.broadcast_to(base[row], start.shape)
        self._angle = np.arcsinh(root / np.where(base > 0, base, 1.0))[row] - start
        self._top = (base + top)[row] * np.exp(-start)
        self._last = len(row) - 1 - np.argmax(self.length[::-1] > 0, axis=0)
        self._x, s = self.place(np.multiply.outer(_NODES, self.length))
        self._rise, pressed = np.zeros_like(s), np.flatnonzero(owner[row, 0] >= 0)
        if pressed.size:
            x, s = (each[:, pressed].reshape(NODES, -1) for each in (self._x, s))
            weight = profile.branch_weights(x, s, np.repeat(owner[row, 0][pressed], edge.size))
            self._rise[:, pressed] = weight.reshape(NODES, -1, edge.size) * self.length[pressed]

    def place(self, along: Array, at: Any = _ALL) -> tuple[Array, Array]:
        """Return x and sqrt(x^2 - b^2) at places along the pieces."""
        base, angle = self.base[at], np.maximum(self._angle[at] - along, 0.0)
        s = np.where(base > 0, base * np.sinh(angle), self._top[at] * np.exp(-along))
        return np.hypot(base, s), s

    def _width(self, along: Array, at: Any = _ALL) -> Array:
        """Difference of the radii at the top of a piece and at a place."""
        return 2 * self.place(along / 2, at)[1] * np.sinh(along / 2)

    @property
    def second_moment(self) -> Array:
        """int x^2 dg [length^3], shape (n,)."""
        inside = np.tensordot(_UP_TO[-1], self._rise * self._x**3, 1).sum(axis=0)
        return np.asarray(inside + self.step * self.a**3)

    @cached_property
    def _resolved(self) -> tuple[Array, Array, Array]:
        """Values and moments at the tops of pieces and at the end, and the series.

        Values (4, pieces + 1, n): P, a - x [length], A = int y^2 P dy and the work P A - int y^2
        P^2 dy [length^3]. Series (NODES, 2, pieces, n): the increase of P divided by the distance,
        and its derivative.

        The kernel K(y/x) is analytic in ln y up to a distance of pi from the real line: over few y
        it is a series, whose coefficients are integrals over dg alone.
        """
        points = 4 + int(np.ceil(DEEPEST / np.arcsinh(2 * np.pi / self.depth)))
        shares, matrix = _chebyshev(points)
        y = self.a * np.exp(-self.depth * shares[:, None, None, None])
        kernel = ellipkm1(np.square(y / self._x)) * self._rise
        sums = (_UP_TO @ kernel.reshape(points, NODES, -1)).reshape(points, -1, *self.length.shape)
        sums[:, :, 1:] += np.cumsum(sums[:, -1:, :-1], axis=2)
        x = np.concatenate([self._x, self.place(self.length)[0][None]])
        place = 2 * np.log(self.a / x) / self.depth - 1
        rotation = chebyshev.chebval(place, np.tensordot(matrix, sums, 1), tensor=False)
        rotation = rotation + self.step * ellipkm1(np.square(x / self.a))
        tops = np.zeros((4, len(self.length) + 1, self.a.size))
        tops[0] = np.concatenate([[self.step * np.pi / 2], rotation[-1]])
        along = np.multiply.outer(_NODES, self.length)
        rate = quotient(rotation[:-1] - tops[0, :-1], along)
        series = np.stack([np.tensordot(each, rate, 1) for each in (_MATRIX, _SLOPES)], axis=1)
        gains, weights = self._inside(self.length, series)
        area, gain = weights * (tops[0, :-1] + gains), np.diff(tops[0], axis=0)
        tops[1, 1:] = np.cumsum(self._width(self.length), axis=0)
        tops[2, 1:] = np.cumsum(area.sum(axis=0), axis=0)
        work = gain * tops[2, :-1] + (area * (gain - gains)).sum(axis=0)
        tops[3, 1:] = np.cumsum(work, axis=0)
        return tops, np.concatenate([[self.a], x[-1]]) ** 3 * tops[0] + 3 * tops[2], series

    def _inside(self, along: Array, series: Array, at: Any = _ALL) -> tuple[Array, Array]:
        """Increase of P at nodes up to a place, and weights of integrals of y^2 dy, (nodes, k)."""
        shares, weights = (np.multiply.outer(each, along) for each in composite_rule(NODES))
        y, s = self.place(shares, at)
        place = 2 * shares / np.maximum(self.length[at], TINY) - 1
        gains = shares * chebyshev.chebval(place, series[:, 0, *at], tensor=False)
        return gains, weights * y * y * s

    def _gain(self, along: Array, at: tuple[Indices, Indices]) -> tuple[Array, Array]:
        """Increase of P from the top of a piece to a place, and its derivative in the distance."""
        share, series = along / self.length[at], self._resolved[2][:, :, *at]
        rate, change = chebyshev.chebval(2 * share - 1, series, tensor=False)
        return along * rate, rate + share * change

    def _moment_gain(self, along: Array, at: tuple[Indices, Indices]) -> tuple[Array, Array]:
        """Increase of the moment from the top of a piece to a place, and its derivative."""
        gains, weights = self._inside(along, self._resolved[2], at)
        cube, (gain, slope) = self.place(along, at)[0] ** 3, self._gain(along, at)
        return cube * gain + 3 * (weights * gains).sum(axis=0), cube * slope

    def _state(self, along: Array, at: tuple[Indices, Indices]) -> Array:
        """States at places; see `at_load`."""
        tops, _, series = self._resolved
        (x, s), (gain, slope) = self.place(along, at), self._gain(along, at)
        rotation, width, area, work = tops[:, *at]
        gains, weights = self._inside(along, series, at)
        inside = weights * (rotation + gains)
        work = work + gain * area + (inside * (gain - gains)).sum(axis=0)
        rotation, area = rotation + gain, area + inside.sum(axis=0)
        moment, width = x**3 * rotation + 3 * area, width + self._width(along, at)
        return np.array([x, width, rotation, moment, work, slope / s])

    def tops(self, *, of_moment: bool) -> Array:
        """Return P or the moment at the tops of pieces and at the end, shape (pieces + 1, n)."""
        return self._resolved[1] if of_moment else self._resolved[0][0]

    def at_load(self, load: Array, contact: Indices, *, of_moment: bool) -> Array:
        """Return the states at given values of P or of the moment; beyond the end, the last state.

        Parameters
        ----------
        load : P [1] or moment [length^3], shape (k,).
        contact : index of the contact of each load, shape (k,).

        Returns
        -------
        c, a - c [length], P(c) [1], moment c^3 P + 3 int_c^a y^2 P dy and work int_c^a y^2 P(y)
        (P(c) - P(y)) dy [length^3], slope -dP/dc [1/length]; shape (6, k).
        """
        tops = self.tops(of_moment=of_moment)
        rise = self._moment_gain if of_moment else self._gain
        at = np.minimum((tops[1:, contact] <= load).sum(axis=0), self._last[contact]), contact
        length, need, most = self.length[at], load - tops[at], tops[1:][at] - tops[at]
        within = (need > 0) & (need < most)

        def sloped(along: Array) -> tuple[Array, Array]:
            value, slope = rise(along, at)
            return value, along * slope / value

        start = np.where(within, length * need / np.where(within, most, 1.0), 1.0)
        need = np.where(within, need, 0.0)
        along = invert(sloped, need, start, 0 * length, length)
        state = self._state(np.where(load >= tops[1:][at], length, along), at)
        # Below the step of P at the edge a flat punch sticks completely.
        state[2:4] *= np.minimum(quotient(load, tops[0, contact], 1.0), 1.0)
        return state

    def at_stick(self, stick: Array, width: Array, contact: Indices) -> Array:
        """Return the states of stick radii c and widths a - c, each accurate by itself.

        Parameters and states: see `at_load`.
        """
        tops, ends = self._resolved[0], self.place(self.length)[0][:, contact]
        at = np.minimum((ends >= stick).sum(axis=0), self._last[contact]), contact
        (x, s), base = self.place(0 * stick, at), self.base[at]
        inside = np.maximum(np.where(width < stick, width - tops[1][at], x - stick), 0.0)
        own = np.sqrt(np.maximum(stick - base, 0.0) * (stick + base))
        along = np.arcsinh(inside * (x + stick) / (s * stick + own * x))
        return self._state(np.minimum(along, self.length[at]), at)

    @property
    def branches(self) -> list[Branch]:
        """Intervals of -dP/dx of a single contact, without the step of a flat punch."""
        starts, stops = (self.place(each)[0][:, 0] for each in (self.length, 0 * self.length))
        # A contact radius may differ from the top by rounding.
        columns = self.base[:, 0], range(len(starts)), [np.inf, *stops[1:]], starts
        return [
            Branch(float(base), partial(self._weight, piece), float(stop), float(start))
            for base, piece, stop, start in zip(*columns, strict=True)
        ]

    def _weight(self, piece: int, x: Array, s: Array) -> Array:
        """-(dP/dx) s/x on a piece of a single contact."""
        base, angle, top = (each[piece, 0] for each in (self.base, self._angle, self._top))
        along = angle - np.arcsinh(s / base) if base > 0 else np.log(top / x)
        share = np.clip(along / self.length[piece, 0], 0.0, 1.0)
        rate, change = chebyshev.chebval(2 * share - 1, self._resolved[2][..., piece, 0])
        return np.asarray((rate + share * change) / x)
