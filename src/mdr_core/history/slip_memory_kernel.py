"""Sequential loop of `slip_memory`: the polyline after each load point.

Every load point depends on the one before, so there is nothing for NumPy to vectorise. Cython
compiles this file as it stands, with the C types of `slip_memory_kernel.pxd`; uncompiled it gives
the same bits, about a hundred times slower.

The polyline is a stack of vertices. On a random path branch prediction fails, so what can be
selected by an index is not selected by an `if`. One file holds all functions, since Cython inlines
within a module only.
"""

from mdr_core.typing import Array, Indices

# Column of the sum normal + anchor.
FORWARD = 0
# Column of the sum normal - anchor.
BACKWARD = 1
# Column of the anchor.
ANCHOR = 2
# Mark of a segment on which both sums grow.
NEITHER = 2
# Place of the new load point on the stack.
POINT = 0
# Place of the corner that it makes.
CORNER = 1
# Place of its mirror image, below the axis as a vertex that it never exceeds.
MIRROR = 2
# Place of the vertex on the axis.
AXIS = 3


class PolylineStack:
    """Vertices of the polyline, and the arrays that the loop fills.

    Coordinate sums are unevaluated sums high + low of two doubles. `growth` is the growth of both
    sums over the segment below a vertex and `anchor` that of the anchor, which a difference of both
    would lose where it is small; `number` the index of the vertex among all that were made,
    `load_step` the load step that laid the segment.

    Parameters
    ----------
    high, low, growth, anchor, number, load_step : columns of the stack.
    top : place of its last vertex.
    parent, normal, steps, anchors : to be filled with parent, normal coordinate, growth and growth
        of the anchor of every vertex.
    made : number of vertices that these four hold already.
    moved : to be filled with the decrease of both sums and of the anchor of the load point over
        each step.
    front_step, front : to be filled with the step of each visit of the slip front, and its row of
        `_visit`.
    """

    def __init__(
        self,
        high: Array,
        low: Array,
        growth: Array,
        anchor: Array,
        number: Indices,
        load_step: Indices,
        top: int,
        parent: Indices,
        normal: Array,
        steps: Array,
        anchors: Array,
        made: int,
        moved: Array,
        front_step: Indices,
        front: Array,
    ) -> None:
        self.high = high
        self.low = low
        self.growth = growth
        self.anchor = anchor
        self.number = number
        self.load_step = load_step
        self.top = top
        self.parent = parent
        self.normal = normal
        self.steps = steps
        self.anchors = anchors
        self.made = made
        self.moved = moved
        self.front_step = front_step
        self.front = front
        self.visited = 0

    def run(
        self,
        normal: Array,
        tangential: Array,
        continues: Array,
        load_steps: Indices,
        tops: Indices,
        start_normal: float,
        start_tangential: float,
    ) -> None:
        """Move the load point along all steps.

        Parameters
        ----------
        normal, tangential : coordinates of the load points, shape (n,).
        continues : nonzero for steps on the straight line of the step before.
        load_steps : load step that each belongs to.
        tops : receives the vertex of each load point, -1 in separation.
        start_normal, start_tangential : load point before the first step.
        """
        at = self.top
        x0 = start_normal
        y0 = start_tangential
        straight = False
        for i in range(len(normal)):
            x = normal[i]
            y = tangential[i]
            contact = x > 0
            if contact and at < AXIS:
                # Contact begins where the straight step crosses normal coordinate zero.
                y0 = y0 + (y - y0) * (-x0 / (x - x0))
                x0 = 0.0
                at = self._begin_contact(y0)
            elif not contact and at >= AXIS:
                # The last springs slip until the straight step crosses normal coordinate zero.
                y = y0 + (y - y0) * (x0 / (x0 - x))
                x = 0.0
            if at >= AXIS:
                self._aim(x, y)
                rise = self._excess(at, POINT, FORWARD)
                fall = self._excess(at, POINT, BACKWARD)
                if max(rise, fall) > 0:
                    self.moved[i, FORWARD] = rise
                    self.moved[i, BACKWARD] = fall
                    self.moved[i, ANCHOR] = self._anchor_step(at, POINT)
                    at = self._slip(at, x, i)
                    straight = False
                else:
                    straight = straight and continues[i]
                    if rise < 0 or fall < 0:
                        at = self._stick(at, x - x0, y - y0, rise, fall, straight, x, load_steps[i])
                        straight = True
            if not contact:
                at = MIRROR
                straight = False
            tops[i] = self.number[at]
            x0 = normal[i]
            y0 = tangential[i]
        self.top = at

    def _begin_contact(self, tangential: float) -> int:
        """Put the first vertex on the axis."""
        self._put(AXIS, FORWARD, tangential, 0.0, 1.0)
        self._put(AXIS, BACKWARD, -tangential, 0.0, 1.0)
        self._make(AXIS, 0.0)
        return AXIS

    def _aim(self, x: float, y: float) -> None:
        """Set the load point and its mirror image."""
        forward = x + y
        backward = x - y
        forward_low = _rounding(x, y, forward)
        backward_low = _rounding(x, -y, backward)
        self._put(POINT, FORWARD, forward, forward_low, 0.0)
        self._put(POINT, BACKWARD, backward, backward_low, 0.0)
        self._put(MIRROR, FORWARD, -backward, -backward_low, 0.0)
        self._put(MIRROR, BACKWARD, -forward, -forward_low, 0.0)

    def _stick(
        self,
        at: int,
        deeper: float,
        further: float,
        rise: float,
        fall: float,
        continues: bool,  # noqa: FBT001 -- positional, as C takes it
        x: float,
        load_step: int,
    ) -> int:
        """Extend the polyline straight to the load point; return the place of its vertex.

        Where one sum is constant both coordinates move by the same amount.
        """
        forward_step = max(deeper + further, 0.0) if rise < 0 else 0.0
        backward_step = max(deeper - further, 0.0) if fall < 0 else 0.0
        if continues and at > AXIS:
            # One segment for one straight line.
            further += self.anchor[at]
            forward_step += self.growth[at, FORWARD]
            backward_step += self.growth[at, BACKWARD]
            at -= 1
        return self._extend(at, forward_step, backward_step, further, x, load_step)

    def _slip(self, start: int, x: float, step: int) -> int:
        """Cut the polyline where it exceeds the load point; return the place of its vertex."""
        self._visit(start, start, step)
        lower = start - 1
        # The mirror image never exceeds the load point.
        while max(self._excess(lower, POINT, FORWARD), self._excess(lower, POINT, BACKWARD)) > 0:
            self._visit(start, lower, step)
            lower -= 1
        upper = lower + 1
        # The cut is in the sum `own`; on a face of an earlier cone the other one is constant.
        other = self._constant(upper)
        full = upper == AXIS
        oblique = other == NEITHER and not full
        if full:
            other = BACKWARD if self._excess(AXIS, POINT, FORWARD) > 0 else FORWARD
        elif oblique:
            other = self._last_reached(lower, upper)
        own = 1 - other
        keep = self._excess(POINT, lower, own)
        if keep <= 0:
            if not full:
                self._visit(start, lower, step)
            # One of the two is zero.
            forward_step = self._excess(POINT, lower, FORWARD)
            backward_step = self._excess(POINT, lower, BACKWARD)
            return self._extend(lower, forward_step, backward_step, 0.0, x, self.load_step[upper])
        # In full slip the corner is that of the mirror image, and both sums grow from the axis.
        source = upper - full
        rest = keep * full
        further = 0.0
        if oblique:
            self._cut(lower, upper, own, other, keep)
            source = CORNER
            rest = self.growth[CORNER, other]
            span = self.growth[upper, FORWARD] + self.growth[upper, BACKWARD]
            further = self.anchor[upper] * ((keep + rest) / span)
        high = self.high[source, other]
        low = self.low[source, other]
        if not full:
            self._settle(CORNER, own)
            self._put(CORNER, other, high, low, rest)
            self._visit(start, CORNER, step)
        self._put(upper, own, self.high[POINT, own], self.low[POINT, own], keep)
        self._put(upper, other, high, low, rest)
        self._lay(upper, further)
        self._make(upper, self._normal(upper))
        reach = (self.high[POINT, other] - high) + (self.low[POINT, other] - low)
        if reach <= 0:
            # The corner is the load point.
            self._put(upper, other, self.high[POINT, other], self.low[POINT, other], rest)
            return upper
        at = upper + 1
        self._put(at, own, self.high[POINT, own], self.low[POINT, own], 0.0)
        self._put(at, other, self.high[POINT, other], self.low[POINT, other], reach)
        self._lay(at, 0.0)
        self._make(at, x)
        return at

    def _cut(self, lower: int, upper: int, own: int, other: int, keep: float) -> None:
        """Find the corner's other sum, `keep` above the lower end of a segment in its own."""
        growth = self.growth[upper, other]
        over = self._excess(upper, POINT, own)
        # From the nearer end, so that the distances to both are free of cancellation.
        near = keep <= over
        base = lower if near else upper
        distance = keep if near else -over
        # On the whole segment both sums differ by twice the growth of the anchor.
        anchor = self.anchor[upper] if own == FORWARD else -self.anchor[upper]
        less = distance * (2 * anchor / self.growth[upper, own])
        if 2 * abs(less) < abs(distance):
            # The sums grow nearly alike: to both parts of the own step a small one is added, so
            # that small slopes keep their digits and none arises from rounding errors.
            move = self.high[POINT, own] - self.high[base, own]
            move_low = _rounding(self.high[POINT, own], -self.high[base, own], move)
            move_low += self.low[POINT, own] - self.low[base, own] - less
            step = distance - less
        else:
            move = distance * (growth / self.growth[upper, own])
            move_low = 0.0
            step = move
        rest = max(step if near else growth + step, 0.0)
        high = self.high[base, other]
        total = high + move
        low = _rounding(high, move, total) + move_low + self.low[base, other]
        self._put(CORNER, other, total + low, _rounding(total, low, total + low), rest)

    def _last_reached(self, lower: int, upper: int) -> int:
        """Sum in which the load point is reached further out on a segment where both grow."""
        over_forward = self._excess(upper, POINT, FORWARD)
        over_backward = self._excess(upper, POINT, BACKWARD)
        # Parts of the segment, compared crosswise.
        forward = self._excess(POINT, lower, FORWARD) * self.growth[upper, BACKWARD]
        backward = self._excess(POINT, lower, BACKWARD) * self.growth[upper, FORWARD]
        first = (over_forward > 0) & ((over_backward <= 0) | (forward <= backward))
        return BACKWARD if first else FORWARD

    def _extend(
        self,
        below: int,
        forward_step: float,
        backward_step: float,
        further: float,
        x: float,
        load_step: int,
    ) -> int:
        """Push the load point; two segments on the same face become one.

        `further` is the growth of the anchor if both sums grow.
        """
        if below > AXIS and (
            (backward_step <= 0 and self.growth[below, BACKWARD] == 0)
            or (forward_step <= 0 and self.growth[below, FORWARD] == 0)
        ):
            below -= 1
            forward_step = self._excess(POINT, below, FORWARD)
            backward_step = self._excess(POINT, below, BACKWARD)
        at = below
        if forward_step > 0 or backward_step > 0:
            at = below + 1
            self.growth[at, FORWARD] = max(forward_step, 0.0)
            self.growth[at, BACKWARD] = max(backward_step, 0.0)
            self.load_step[at] = load_step
            self._lay(at, further)
            self._make(at, x)
        self._settle(at, FORWARD)
        self._settle(at, BACKWARD)
        return at

    def _lay(self, at: int, further: float) -> None:
        """Set the growth of the anchor; if one sum alone grows, it is half of that growth."""
        if self.growth[at, BACKWARD] == 0:
            further = self.growth[at, FORWARD] / 2
        elif self.growth[at, FORWARD] == 0:
            further = -self.growth[at, BACKWARD] / 2
        self.anchor[at] = further

    def _constant(self, at: int) -> int:
        """Sum that is constant on the segment below a vertex."""
        if self.growth[at, BACKWARD] == 0:
            return BACKWARD
        return FORWARD if self.growth[at, FORWARD] == 0 else NEITHER

    def _settle(self, at: int, own: int) -> None:
        """Copy a sum of the load point to a vertex."""
        self.high[at, own] = self.high[POINT, own]
        self.low[at, own] = self.low[POINT, own]

    def _make(self, at: int, normal: float) -> None:
        """Number the vertex; record its parent, its normal coordinate and the growth below it."""
        new = self.made
        self.made = new + 1
        self.number[at] = new
        self.parent[new] = self.number[at - 1]
        self.normal[new] = normal
        self.steps[new, FORWARD] = self.growth[at, FORWARD]
        self.steps[new, BACKWARD] = self.growth[at, BACKWARD]
        self.anchors[new] = self.anchor[at]

    def _visit(self, start: int, at: int, step: int) -> None:
        """Record a vertex that the slip front reaches: distances from the start, normal coordinate.

        The distances are those in both sums and in the anchor.
        On the axis, where all springs slip, -1 takes the place of the coordinate.
        """
        row = self.visited
        self.visited = row + 1
        self.front_step[row] = step
        self.front[row, FORWARD] = self._excess(start, at, FORWARD)
        self.front[row, BACKWARD] = self._excess(start, at, BACKWARD)
        self.front[row, ANCHOR] = self._anchor_step(start, at)
        self.front[row, 3] = -1.0 if at == AXIS else self._normal(at)

    def _put(self, at: int, own: int, high: float, low: float, growth: float) -> None:
        self.high[at, own] = high
        self.low[at, own] = low
        self.growth[at, own] = growth

    def _excess(self, upper: int, lower: int, own: int) -> float:
        """Difference of a sum between two vertices."""
        difference: float = (self.high[upper, own] - self.high[lower, own]) + (
            self.low[upper, own] - self.low[lower, own]
        )
        return difference

    def _anchor_step(self, upper: int, lower: int) -> float:
        """Difference of the anchor between two vertices, half of that of the sums."""
        high: float = (self.high[upper, FORWARD] - self.high[upper, BACKWARD]) - (
            self.high[lower, FORWARD] - self.high[lower, BACKWARD]
        )
        low: float = (self.low[upper, FORWARD] - self.low[upper, BACKWARD]) - (
            self.low[lower, FORWARD] - self.low[lower, BACKWARD]
        )
        return (high + low) / 2

    def _normal(self, at: int) -> float:
        """Normal coordinate of a vertex, half of both sums."""
        high: float = self.high[at, FORWARD] + self.high[at, BACKWARD]
        low: float = self.low[at, FORWARD] + self.low[at, BACKWARD]
        return max(high + low, 0.0) / 2


def accumulate(parent: Indices, step: Array, total: Array) -> None:
    """Add to the step of each vertex the total of its parent, which precedes it."""
    for i in range(len(parent)):
        below = parent[i]
        total[i] = 0.0 if below < 0 else total[below] + step[i]


def _rounding(a: float, b: float, total: float) -> float:
    """Rounding error of total = a + b, exactly (Knuth's two-sum)."""
    part = total - a
    return (a - (total - part)) + (b - part)
