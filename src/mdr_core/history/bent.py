"""The walk of `walk` with arcs in place of straight pieces, for loads of mixed control.

A step ends where a sample is, or where its arc is as steep as the cone: so on each step both sums
of the load point only grow or only fall. Where both grow the springs that touch take the arc as
their anchors, otherwise the polyline is cut, and what is left depends on the end of the step alone.
Pieces are arcs, or lie on a face of the cone. Source: notes, §10.
"""

from dataclasses import replace
from math import isnan, nan
from typing import Final

import numpy as np

from mdr_core.history.arcs import Plane, rising_root
from mdr_core.history.vertices import (
    BACKWARD,
    FORWARD,
    SIGNS,
    Points,
    Slips,
    Sum,
    Vertex,
    excess,
    growth_over,
    moved_by,
    sum_of,
)
from mdr_core.typing import Array, Indices

# Up to this part of its level a load point goes through a vertex.
_ROUNDING: Final = 8 * float(np.finfo(float).eps)


class Walk:
    """The polyline on the way, and all vertices that it ever had."""

    def __init__(self, plane: Plane, points: Points) -> None:
        self.plane = plane
        self.points = points
        self.stack: list[Vertex] = []
        self.slips = Slips()
        self.parent: list[int] = []
        self.level: list[float] = []
        self.growth: list[tuple[float, float]] = []
        self.coordinate: list[float] = []
        self.rate: list[float] = []

    def run(self) -> Indices:
        """Walk all steps; returns the number of each load point, -1 in a gap."""
        points, tops, before, straight = self.points, [], 0.0, False
        goes_on = points.goes_on.tolist()
        columns = (points.coordinate, points.level, points.shift)
        for i, (s, level, shift) in enumerate(zip(*(row.tolist() for row in columns), strict=True)):
            if level > 0 and not self.stack:
                self._touch(before)
                straight = False
            if self.stack:
                touches = level > 0
                point = Vertex(
                    (sum_of(max(level, 0.0), shift), sum_of(max(level, 0.0), -shift)), (0, 0), s
                )
                stuck = self._step(i, point, straight=straight and goes_on[i])
                straight = straight if stuck is None else stuck
                if not touches:
                    self.stack = []
            tops.append(self.stack[-1].number if self.stack else -1)
            before = shift
        return np.array(tops, dtype=np.intp)

    def _touch(self, shift: float) -> None:
        first = float(self.plane.profile.first_coordinate)
        self._push(Vertex(((shift, 0.0), (-shift, 0.0)), (1.0, 1.0), first))

    def _push(self, vertex: Vertex) -> None:
        self.parent.append(self.stack[-1].number if self.stack else -1)
        self.level.append(vertex.level)
        self.growth.append(vertex.growth)
        self.coordinate.append(vertex.coordinate)
        self.rate.append(vertex.rate)
        self.stack.append(replace(vertex, number=len(self.level) - 1))

    def _step(self, i: int, point: Vertex, *, straight: bool) -> bool | None:
        """Move the load point; tells whether it went on along its arc, None if it rests."""
        top = self.stack[-1]
        rise, fall = (excess(a, b) for a, b in zip(top.sums, point.sums, strict=True))
        if max(rise, fall) > 0:
            self._slip(i, point, rise, fall)
            return False
        if rise == fall == 0:
            return None
        if straight and len(self.stack) > 1:
            self.stack.pop()
        self._extend(point, float(self.points.rate[i]))
        return True

    def _extend(self, point: Vertex, rate: float) -> None:
        """Go straight on to the load point; one piece stands for two that slip the same way."""
        growth = growth_over(point, self.stack[-1])
        below = self.stack[-1]
        if len(self.stack) > 1 and any(
            growth[own] <= 0 and below.growth[own] == 0 for own in (FORWARD, BACKWARD)
        ):
            self.stack.pop()
            growth = growth_over(point, self.stack[-1])
        forward, backward = max(growth[0], 0.0), max(growth[1], 0.0)
        if isnan(rate):
            # Along a face, up to rounding.
            forward, backward = (0.0, backward) if forward < backward else (forward, 0.0)
        if forward == backward == 0:
            last = self.stack[-1]
            self.stack[-1] = replace(last, sums=point.sums, coordinate=point.coordinate)
            return
        face = forward == 0 or backward == 0
        self._push(replace(point, growth=(forward, backward), rate=nan if face else rate))

    def _slip(self, i: int, point: Vertex, rise: float, fall: float) -> None:
        """Cut the polyline where it exceeds the load point, and go on along the face."""
        lower = len(self.stack) - 2
        while lower >= 0 and max(growth_over(self.stack[lower], point)) > 0:
            lower -= 1
        record = _Record(self, i, point, rise, fall)
        if lower < 0:
            own = FORWARD if excess(self.stack[0].sums[FORWARD], point.sums[FORWARD]) > 0 else 1
            corner = self._mirrored(point, own)
            record.pieces(0)
            record.slide(own)
        else:
            own, found = self._corner(lower, point)
            if found is None:
                record.pieces(lower)
                del self.stack[lower + 1 :]
                self._extend(point, nan)
                return
            corner = found
            record.pieces(lower + 1)
            record.piece(corner, self.stack[lower + 1], own)
        del self.stack[lower + 1 :]
        other = 1 - own
        reach = excess(point.sums[other], corner.sums[other])
        if reach <= 0:
            self._push(replace(corner, sums=point.sums, coordinate=point.coordinate))
            return
        self._push(corner)
        self._push(replace(point, growth=(0.0, reach) if own == FORWARD else (reach, 0.0)))

    def _mirrored(self, point: Vertex, own: int) -> Vertex:
        """The corner on the axis where everything slips."""
        high, low = point.sums[own]
        sums = (point.sums[own], (-high, -low))
        first = float(self.plane.profile.first_coordinate)
        return Vertex(sums if own == FORWARD else (sums[1], sums[0]), (1.0, 1.0), first)

    def _corner(self, lower: int, point: Vertex) -> tuple[int, Vertex | None]:
        """The sum in which the polyline is cut, and the corner; None where that is a vertex."""
        below, above = self.stack[lower], self.stack[lower + 1]
        if above.growth[FORWARD] == 0 or above.growth[BACKWARD] == 0:
            own = BACKWARD if above.growth[FORWARD] == 0 else FORWARD
            keep = excess(point.sums[own], below.sums[own])
            if keep <= 0:
                return own, None
            other = 1 - own
            return own, self._made(own, point, above.sums[other], (keep, 0.0), nan, nan)
        if above.rate == 0:
            # Both sums grow alike, which no rounding is to change.
            keep, own = min(
                (excess(point.sums[own], below.sums[own]), own) for own in (FORWARD, BACKWARD)
            )
            if keep <= 0:
                return own, None
            other_sum = moved_by(below.sums[1 - own], point.sums[own], below.sums[own])
            return own, self._made(own, point, other_sum, (keep, keep), nan, 0.0)
        found = []
        for own in (FORWARD, BACKWARD):
            keep = excess(point.sums[own], below.sums[own])
            if keep <= 0:
                return own, None
            if excess(above.sums[own], point.sums[own]) > 0:
                found.append((self._on_arc(below, above, own, keep), own, keep))
        s, own, keep = min(found)
        other, sign = 1 - own, SIGNS[1 - own]
        near = s - below.coordinate <= above.coordinate - s
        base = below if near else above
        move = self.along(base.coordinate, s, sign * above.rate)
        rest = min(max(move if near else above.growth[other] + move, 0.0), above.growth[other])
        total, lost = sum_of(base.sums[other][0], move)
        sums = sum_of(total, lost + base.sums[other][1])
        rate = above.rate if rest > 0 else nan
        return own, self._made(own, point, sums, (keep, rest), s, rate)

    @staticmethod
    def _made(
        own: int, point: Vertex, other_sum: Sum, growth: tuple[float, float], s: float, rate: float
    ) -> Vertex:
        sums = point.sums[own], other_sum
        if own == BACKWARD:
            return Vertex((sums[1], sums[0]), (growth[1], growth[0]), s, rate=rate)
        return Vertex(sums, growth, s, rate=rate)

    def along(self, start: float, end: float, slope: float) -> float:
        """What level + slope x other grows by between two coordinates."""
        s = np.array([start, end])
        level, other = self.plane.level(s).tolist(), self.plane.other(s).tolist()
        return float(level[1] - level[0] + slope * (other[1] - other[0]))

    def _on_arc(self, below: Vertex, above: Vertex, own: int, keep: float) -> float:
        """Coordinate at which a sum has grown by so much on an arc."""
        plane, slope = self.plane, SIGNS[own] * above.rate
        low, high = np.array([below.coordinate]), np.array([above.coordinate])
        level, other = plane.level(low), plane.other(low)

        def miss(_: Indices, s: Array) -> tuple[Array, Array]:
            value = (plane.level(s) - level) + slope * (plane.other(s) - other) - keep
            steep = plane.slopes(s)
            return value, steep[0] + slope * steep[1]

        return float(rising_root(miss, low, high, np.array([keep]))[0])


class _Record:
    """Notes what slips on one step: all pieces from the top down to the corner."""

    def __init__(self, walk: Walk, step: int, point: Vertex, rise: float, fall: float) -> None:
        self._walk = walk
        self._step = step
        self._point = point
        self._start = walk.stack[-1]
        self._moved = rise, fall

    def pieces(self, end: int) -> None:
        """Note the pieces above the vertex of this place on the stack."""
        stack = self._walk.stack
        for at in range(len(stack) - 1, end, -1):
            self.piece(stack[at - 1], stack[at], None)

    def piece(self, lower: Vertex, upper: Vertex, own: int | None) -> None:
        """Note one piece; `own` is the sum in which its lower end is reached, if it is known."""
        rise, fall = self._moved
        if fall <= 0 or rise <= 0:
            self._note(BACKWARD if rise <= 0 else FORWARD, lower, upper)
            return
        low = self._side(lower) if own is None else own
        high = None if upper is self._start else self._side(upper)
        if low is None or high is None or low == high:
            known = low if low is not None else high
            self._note(FORWARD if known is None else known, lower, upper)
            return
        # The load point passes through the piece, where nothing slips.
        middle = self._crossing(lower, upper, high)
        self._note(high, middle, upper)
        self._note(low, lower, replace(middle, growth=upper.growth))

    def slide(self, own: int) -> None:
        """Note the slide of everything, after the front has reached the axis."""
        over, fall = excess(self._start.sums[own], self._walk.stack[0].sums[own]), self._moved[own]
        self._walk.slips.note(self._step, own, (max(over, 0.0), fall), fall, None)

    def _note(self, own: int, lower: Vertex, upper: Vertex) -> None:
        over = tuple(excess(self._start.sums[own], end.sums[own]) for end in (upper, lower))
        if isnan(upper.rate) and upper.growth[own] == 0:
            # A face that stands still in this sum: all of it at once, which is no way.
            return
        fall = self._moved[own]
        bounded = min(max(over[0], 0.0), fall), min(over[1], fall)
        self._walk.slips.note(self._step, own, bounded, fall, (upper, lower))

    def _side(self, vertex: Vertex) -> int | None:
        """The sum in which the load point reaches a vertex first; None where it goes through."""
        over = growth_over(vertex, self._point)
        if over[BACKWARD] <= 0:
            return FORWARD
        if over[FORWARD] <= 0:
            return BACKWARD
        s = self._coordinate(vertex)
        # Where the load point is at the vertex' level, above or below it.
        ahead = self._walk.along(self._start.coordinate, s, float(self._rate))
        ahead += excess(self._start.sums[FORWARD], vertex.sums[FORWARD])
        if abs(ahead) <= _ROUNDING * self._start.level:
            return None
        return BACKWARD if ahead > 0 else FORWARD

    def _coordinate(self, vertex: Vertex) -> float:
        """Contact coordinate of a vertex, found by its level where it is not known."""
        if isnan(vertex.coordinate):
            return float(self._walk.plane.at_level(np.array([vertex.level]))[0])
        return vertex.coordinate

    @property
    def _rate(self) -> float:
        return float(self._walk.points.rate[self._step])

    def _crossing(self, lower: Vertex, upper: Vertex, high: int) -> Vertex:
        """The point of a piece that the load point passes through."""
        walk, start = self._walk, self._start
        plane = walk.plane
        ends = [self._coordinate(end) for end in (lower, upper)]
        still = upper.growth[BACKWARD] == 0
        face = isnan(upper.rate)
        top = np.array([ends[1]])
        over = excess(start.sums[FORWARD], upper.sums[FORWARD])
        sign = 1.0 if high == BACKWARD else -1.0

        def ahead(_: Indices, s: Array) -> tuple[Array, Array]:
            level, other = plane.level(s), plane.other(s)
            began = np.array([start.coordinate])
            load = self._rate * (other - plane.other(began)) + (level - plane.level(began))
            steep, other_slope = plane.slopes(s)
            rise = level - plane.level(top)
            if face:
                own = (2 * rise if still else 0 * rise) - over
                slope = steep if still else -steep
            else:
                own = rise + upper.rate * (other - plane.other(top)) - over
                slope = upper.rate * other_slope
            return sign * (load - own), sign * (self._rate * other_slope - slope)

        s = rising_root(ahead, np.array([ends[0]]), top)
        moved = [walk.along(start.coordinate, float(s[0]), sign * self._rate) for sign in SIGNS]
        sums = tuple(
            sum_of(part[0], by + part[1]) for part, by in zip(start.sums, moved, strict=True)
        )
        return Vertex((sums[0], sums[1]), (1.0, 1.0), float(s[0]), rate=upper.rate)
