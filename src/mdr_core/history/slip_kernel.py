"""Sequential loops of load histories: the polyline after each step, and the path of the slip front.

Every load point depends on the one before, so there is nothing for NumPy to vectorise. Cython
compiles this file as it stands, with the C types of `slip_kernel.pxd`; uncompiled it gives the same
bits, about a hundred times slower.

On a random path branch prediction fails, so what can be selected by an index is not selected by an
`if`. One file holds all functions, since Cython inlines within a module only.
"""

from mdr_core.history.slip_layout import ANCHOR, AXIS, GROWTH, LOW, MIRROR, NORMAL, STEP
from mdr_core.typing import Array, Flags, Indices

# Columns of the sums of a vertex.
FORWARD = 0  # normal + anchor
BACKWARD = 1  # normal - anchor
# Mark of a segment on which both sums grow.
NEITHER = 2
# Places on the stack, below the mirror image of the load point: a vertex below the axis that the
# load point never exceeds.
POINT = 0  # new load point
CORNER = 1  # corner that it makes
# Rows of the vertices of a tree, those of the columns from NORMAL on.
PLACE = 0  # normal coordinate
RISE = 1  # growth of normal + anchor
FALL = 2  # growth of normal - anchor
TURN = 3  # growth of the anchor


class PolylineStack:
    """Polyline as a stack of vertices V_0 ... V_m, from the axis to the load point P.

    With the sums f = normal + anchor and b = normal - anchor, a straight step to P' leaves

        V_0 ... V_m, P'      if f_m <= f' and b_m <= b': all springs stick,
        V_0 ... V_k, C, P'   otherwise; k is the last vertex with f_k <= f' and b_k <= b'.

    The corner C is the place between V_k and V_k+1 at which the second of the two sums falls to
    that of P'. Its other sum is that of the segment there; between C and P' the other sum grows
    alone. If the axis exceeds P' as well, all springs slip, and C lies on the axis.

    Parameters
    ----------
    rows : the vertices, with the columns above, from the place `AXIS` on.
    top : place of the last vertex; `MIRROR` in separation.
    x, y : normal and tangential coordinate of the load point.
    """

    def __init__(self, rows: Array, top: int, x: float, y: float) -> None:
        self.rows = rows
        self.top = top
        self.x = x
        self.y = y
        # Lowest place that the last step has changed, and highest of all steps.
        self.changed = top + 1
        self.highest = top
        # The last step was straight and without slip, so that another one may continue it.
        self.straight = False

    def run(
        self,
        path: Array,
        continues: Flags,
        load_step: Indices,
        number: Indices,
        parent: Indices,
        vertices: Array,
        tops: Indices,
    ) -> int:
        """Move the load point along all steps; return the number of vertices of all polylines.

        Parameters
        ----------
        path : normal and tangential coordinate of the load points, shape (2, n).
        continues, load_step : see `move`, shape (n,).
        number : index of each vertex on the stack, -1 below the axis.
        parent, vertices : those on the stack; receive the parent of every new one, and its rows.
        tops : receives the vertex of each load point, -1 in separation.
        """
        made = self.top + 1 - AXIS
        for i in range(len(tops)):
            self.move(path[0, i], path[1, i], continues[i], load_step[i])
            for at in range(self.changed, self.top + 1):
                number[at] = made
                parent[made] = number[at - 1]
                for row in range(TURN + 1):
                    vertices[row, made] = self.rows[at, NORMAL + row]
                made += 1
            tops[i] = number[self.top]
            self.highest = max(self.highest, self.top)
        return made

    def run_each(
        self, ends: Indices, path: Array, vertices: Array, moved: Array, moved_ends: Indices
    ) -> int:
        """Move the load points of many contacts by one step each; return the number of vertices.

        Parameters
        ----------
        ends : ends of the contacts' polylines among the vertices, shape (n,).
        path : normal and tangential coordinate before the step and after it, shape (4, n).
        vertices : rows of all polylines.
        moved, moved_ends : receive the rows and the ends after the step.
        """
        begin = made = 0
        for i in range(len(ends)):
            size = ends[i] - begin
            self.rows[AXIS : AXIS + size] = vertices[begin : ends[i]]
            self.top = MIRROR + size
            self.x = path[0, i]
            self.y = path[1, i]
            self.move(path[2, i], path[3, i], continues=False, load_step=0)
            size = self.top - MIRROR
            moved[made : made + size] = self.rows[AXIS : AXIS + size]
            begin = ends[i]
            made += size
            moved_ends[i] = made
        return made

    def move(self, x: float, y: float, continues: bool, load_step: int) -> None:  # noqa: FBT001
        """Move the load point straight to (x, y), normal and tangential coordinate.

        A step without slip that `continues` the straight line of the one before extends its
        segment.
        """
        x0 = self.x
        y0 = self.y
        self.x = x
        self.y = y
        self.changed = self.top + 1
        if x <= 0:
            self.top = MIRROR
            self.changed = AXIS
            self.straight = False
            return
        if self.top < AXIS:
            # Contact begins where the straight step crosses normal coordinate zero.
            y0 = y0 + (y - y0) * (-x0 / (x - x0))
            x0 = 0.0
            self._put(AXIS, FORWARD, y0, 0.0, 1.0)
            self._put(AXIS, BACKWARD, -y0, 0.0, 1.0)
            self.rows[AXIS, NORMAL] = self.rows[AXIS, ANCHOR] = self.rows[AXIS, STEP] = 0.0
            self.top = self.changed = AXIS
        self._aim(x, y)
        rise = self._excess(self.top, POINT, FORWARD)
        fall = self._excess(self.top, POINT, BACKWARD)
        if max(rise, fall) > 0:
            self._slip()
            self.straight = False
        else:
            self.straight = self.straight and continues
            if rise < 0 or fall < 0:
                self._stick(y - y0, load_step)
                self.straight = True

    def _aim(self, x: float, y: float) -> None:
        """Set the load point and its mirror image."""
        forward = x + y
        backward = x - y
        forward_low = rounding(x, y, forward)
        backward_low = rounding(x, -y, backward)
        self._put(POINT, FORWARD, forward, forward_low, 0.0)
        self._put(POINT, BACKWARD, backward, backward_low, 0.0)
        self._put(MIRROR, FORWARD, -backward, -backward_low, 0.0)
        self._put(MIRROR, BACKWARD, -forward, -forward_low, 0.0)

    def _stick(self, further: float, load_step: float) -> None:
        """Extend the polyline straight to the load point; one segment for one straight line."""
        below = self.top
        if self.straight and below > AXIS:
            further += self.rows[below, ANCHOR]
            below -= 1
        self._extend(below, further, load_step)

    def _slip(self) -> None:
        """Cut the polyline where it exceeds the load point, and extend it to there."""
        lower = self.top - 1
        # The mirror image never exceeds the load point.
        while max(self._excess(lower, POINT, FORWARD), self._excess(lower, POINT, BACKWARD)) > 0:
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
            self._extend(lower, 0.0, self.rows[upper, STEP])
            return
        # In full slip the corner is that of the mirror image, and both sums grow from the axis.
        source = upper - full
        rest = keep * full
        further = 0.0
        if oblique:
            self._cut(lower, upper, own, other, keep)
            source = CORNER
            rest = self.rows[CORNER, GROWTH + other]
            span = self.rows[upper, GROWTH + FORWARD] + self.rows[upper, GROWTH + BACKWARD]
            further = self.rows[upper, ANCHOR] * ((keep + rest) / span)
        self._copy(upper, POINT, own, keep)
        self._copy(upper, source, other, rest)
        self.rows[upper, ANCHOR] = further if rest > 0 else keep * (0.5 - own)
        self.rows[upper, NORMAL] = self._normal(upper)
        self.top = self.changed = upper
        reach = self._excess(POINT, upper, other)
        if reach <= 0:
            # The corner is the load point.
            self._copy(upper, POINT, other, rest)
        else:
            self.top = upper + 1
            self._copy(self.top, POINT, own, 0.0)
            self._copy(self.top, POINT, other, reach)
            self.rows[self.top, ANCHOR] = reach * (0.5 - other)
            self.rows[self.top, STEP] = self.rows[upper, STEP]
        self.rows[self.top, NORMAL] = self.x

    def _cut(self, lower: int, upper: int, own: int, other: int, keep: float) -> None:
        """Find the corner's other sum, `keep` above the lower end of a segment in its own."""
        growth = self.rows[upper, GROWTH + other]
        over = self._excess(upper, POINT, own)
        # From the nearer end, so that the distances to both are free of cancellation.
        near = keep <= over
        base = lower if near else upper
        distance = keep if near else -over
        # On the whole segment both sums differ by twice the growth of the anchor.
        twice = self.rows[upper, ANCHOR] * (2 - 4 * own)
        less = distance * (twice / self.rows[upper, GROWTH + own])
        if 2 * abs(less) < abs(distance):
            # The sums grow nearly alike: to both parts of the own step a small one is added, so
            # that small slopes keep their digits and none arises from rounding errors.
            move = self.rows[POINT, own] - self.rows[base, own]
            move_low = rounding(self.rows[POINT, own], -self.rows[base, own], move)
            move_low += self.rows[POINT, LOW + own] - self.rows[base, LOW + own] - less
            step = distance - less
        else:
            move = distance * (growth / self.rows[upper, GROWTH + own])
            move_low = 0.0
            step = move
        rest = max(step if near else growth + step, 0.0)
        high = self.rows[base, other]
        total = high + move
        low = rounding(high, move, total) + move_low + self.rows[base, LOW + other]
        self._put(CORNER, other, total + low, rounding(total, low, total + low), rest)

    def _last_reached(self, lower: int, upper: int) -> int:
        """Sum in which the load point is reached further out on a segment where both grow."""
        over_forward = self._excess(upper, POINT, FORWARD)
        over_backward = self._excess(upper, POINT, BACKWARD)
        # Parts of the segment, compared crosswise.
        forward = self._excess(POINT, lower, FORWARD) * self.rows[upper, GROWTH + BACKWARD]
        backward = self._excess(POINT, lower, BACKWARD) * self.rows[upper, GROWTH + FORWARD]
        first = (over_forward > 0) & ((over_backward <= 0) | (forward <= backward))
        return BACKWARD if first else FORWARD

    def _extend(self, below: int, further: float, load_step: float) -> None:
        """Push the load point onto a vertex; two segments on the same face become one.

        `further` is the growth of the anchor if both sums grow; if one does, it is half of that.
        """
        forward = self._excess(POINT, below, FORWARD)
        backward = self._excess(POINT, below, BACKWARD)
        if below > AXIS and (
            (backward <= 0 and self.rows[below, GROWTH + BACKWARD] == 0)
            or (forward <= 0 and self.rows[below, GROWTH + FORWARD] == 0)
        ):
            below -= 1
            forward = self._excess(POINT, below, FORWARD)
            backward = self._excess(POINT, below, BACKWARD)
        at = below
        if forward > 0 or backward > 0:
            at = below + 1
            self.rows[at, STEP] = load_step
            self.rows[at, ANCHOR] = further
            if forward <= 0 or backward <= 0:
                self.rows[at, ANCHOR] = (max(forward, 0.0) - max(backward, 0.0)) / 2
            self.rows[at, GROWTH + FORWARD] = max(forward, 0.0)
            self.rows[at, GROWTH + BACKWARD] = max(backward, 0.0)
            self.changed = min(self.changed, at)
        self.top = at
        self.rows[at, NORMAL] = self.x
        self._copy(at, POINT, FORWARD, self.rows[at, GROWTH + FORWARD])
        self._copy(at, POINT, BACKWARD, self.rows[at, GROWTH + BACKWARD])

    def _constant(self, at: int) -> int:
        """Sum that is constant on the segment below a vertex."""
        if self.rows[at, GROWTH + BACKWARD] == 0:
            return BACKWARD
        return FORWARD if self.rows[at, GROWTH + FORWARD] == 0 else NEITHER

    def _put(self, at: int, own: int, high: float, low: float, growth: float) -> None:
        self.rows[at, own] = high
        self.rows[at, LOW + own] = low
        self.rows[at, GROWTH + own] = growth

    def _copy(self, at: int, source: int, own: int, growth: float) -> None:
        """Give a vertex a sum of another one."""
        self._put(at, own, self.rows[source, own], self.rows[source, LOW + own], growth)

    def _excess(self, upper: int, lower: int, own: int) -> float:
        """Difference of a sum between two vertices."""
        difference: float = (self.rows[upper, own] - self.rows[lower, own]) + (
            self.rows[upper, LOW + own] - self.rows[lower, LOW + own]
        )
        return difference

    def _normal(self, at: int) -> float:
        """Normal coordinate of a vertex, half of both sums."""
        high: float = self.rows[at, FORWARD] + self.rows[at, BACKWARD]
        low: float = self.rows[at, LOW + FORWARD] + self.rows[at, LOW + BACKWARD]
        return max(high + low, 0.0) / 2


class SlipFront:
    """Path of the slip front down the polylines of a tree, and the work of friction above it.

    On a step from P to P' the load point moves evenly. A place of the old polyline slips as soon as
    it exceeds the load point in one of the sums, f or b. While the front sweeps a segment of length
    h, from its upper end down, all springs above slip by s, the decrease of that sum, under the
    friction mu E* (n_P - n) of each. Interchanged, the integrals over front and springs give

        G* D/(mu E*)^2 = int M(n) 2 dx,   M(n) = (s/h) int_(front < n) max(n_P - n, 0) dn_front.

    Both paths are straight, so M is of degree 2 on each of the three intervals between their four
    ends. Its Bernstein coefficients are not negative.

    In full slip, the front on the axis, friction is mu F_N. Its mean over a path of length h is
    I + a h at the shallow end of the path, plus such an integral over the path.

    Parameters
    ----------
    parent, vertices : tree of all polylines, see `PolylineStack.run`.
    tops, path : vertex and coordinates of the load point before the first step and after each,
        shapes (n + 1,) and (2, n + 1).
    intervals : receives the seven numbers of each interval: normal coordinate of the lower end,
        length, the three coefficients, upwards, s in full slip, else zero, and the step.
    """

    def __init__(
        self, parent: Indices, vertices: Array, tops: Indices, path: Array, intervals: Array
    ) -> None:
        self.parent = parent
        self.vertices = vertices
        self.tops = tops
        self.path = path
        self.intervals = intervals
        self.count = 0
        # Distance of the front from the load point before the step, in both sums and the anchor.
        self.f = self.b = self.s = 0.0
        # The same of the load point after it.
        self.f_end = self.b_end = self.s_end = 0.0

    def run(self) -> int:
        """Follow the front on all steps; return the number of intervals."""
        for i in range(len(self.tops) - 1):
            if self.path[0, i] > 0 or self.path[0, i + 1] > 0:
                self._descend(i)
        return self.count

    def _descend(self, i: int) -> None:
        """Follow the front on one step."""
        x0 = self.path[0, i]
        y0 = self.path[1, i]
        x = self.path[0, i + 1]
        y = self.path[1, i + 1]
        if x0 <= 0:
            # Contact begins, or ends, where the straight step crosses normal coordinate zero.
            y0 = y0 + (y - y0) * (-x0 / (x - x0))
            x0 = 0.0
        elif x <= 0:
            y = y0 + (y - y0) * (x0 / (x0 - x))
            x = 0.0
        self.f = self.b = self.s = 0.0
        self.f_end = decrease(x0, y0, x, y)
        self.b_end = decrease(x0, -y0, x, -y)
        self.s_end = y0 - y
        if max(self.f_end, self.b_end) <= 0:
            return
        at = self.tops[i]
        below = self.parent[at] if at >= 0 else -1
        while below >= 0:
            rise = self.vertices[RISE, at]
            fall = self.vertices[FALL, at]
            part = 1.0
            if self.f + rise >= self.f_end and self.b + fall >= self.b_end:
                # The front ends where neither sum exceeds that of the new load point any more.
                part = (self.f_end - self.f) / rise if self.f < self.f_end else 0.0
                other = (self.b_end - self.b) / fall if self.b < self.b_end else 0.0
                part = min(max(part, other), 1.0)
            lower = self.vertices[PLACE, below] + (1 - part) * (rise + fall) / 2
            self._sweep(i, part * rise, part * fall, part * self.vertices[TURN, at], lower)
            if part < 1:
                return
            at = below
            below = self.parent[at]
        # The front rests on the axis, and all springs slip until the end of the step.
        side = self._side()
        in_backward = self._is_in_backward(side)
        slip = self.b_end - self.b if in_backward else self.f_end - self.f
        if slip > 0:
            start = self._gap(in_backward, side)
            span = abs(x - start)
            self._add(i, min(start, x), span, slip * span / 2, 0.0, 0.0, slip)

    def _sweep(self, i: int, rise: float, fall: float, turn: float, lower: float) -> None:
        """Move the front down a segment, to the normal coordinate `lower`."""
        upper_side = self._side()
        self.f += rise
        self.b += fall
        self.s += turn
        lower_side = self._side()
        if (upper_side > 0 and lower_side < 0) or (upper_side < 0 and lower_side > 0):
            # The load point passes through the segment: friction acts in both sums in turn.
            part = upper_side / (upper_side - lower_side)
            rest = 1 - part
            middle = lower + rest * (rise + fall) / 2
            self._slip(i, part * rise, part * fall, upper_side, 0.0, middle)
            self._slip(i, rest * rise, rest * fall, 0.0, lower_side, lower)
        else:
            self._slip(i, rise, fall, upper_side, lower_side, lower)

    def _slip(
        self, i: int, rise: float, fall: float, upper_side: float, lower_side: float, lower: float
    ) -> None:
        """Add the intervals of a segment on which friction acts in one sum."""
        in_backward = self._is_in_backward(upper_side + lower_side)
        slip = fall if in_backward else rise
        if slip <= 0:
            return
        span = (rise + fall) / 2
        start = self._gap(in_backward, upper_side)
        end = self._gap(in_backward, lower_side)
        # Above `lower` the front moves from `span` to 0, the load point from span + start to end.
        first = min(span, end)
        fallen = (span - end) + start
        # M at both ends of the second interval, and its coefficient between.
        if end <= span:
            second = span - end
            third = start
            low = fallen / span * end * end / 2
            high = start * start * span / (2 * fallen) if fallen > 0 else 0.0
            between = end * start / 2
        else:
            second = min(start, end - span)
            third = abs(fallen)
            low = span * ((end - span) + start) / 2
            high = span * third / 2
            between = (low + high) / 2
        ratio = slip / span
        low *= ratio
        high *= ratio
        self._add(i, lower, first, 0.0, ratio * first * end / 2, low, 0.0)
        self._add(i, lower + first, second, low, ratio * between, high, 0.0)
        self._add(i, lower + first + second, third, high, 0.0, 0.0, 0.0)

    def _add(self, i: int, at: float, span: float, a: float, b: float, c: float, s: float) -> None:
        """Add an interval, unless it is empty and nothing slides there."""
        if span > 0 or s > 0:
            new = self.count
            self.count = new + 1
            self.intervals[0, new], self.intervals[1, new] = at, span
            self.intervals[2, new], self.intervals[3, new], self.intervals[4, new] = a, b, c
            self.intervals[5, new], self.intervals[6, new] = s, i

    def _side(self) -> float:
        """Distance of the front in f times the step in b, less the other product.

        It is positive where b is exceeded first, negative where f is. With the normal coordinate
        and the anchor it is twice the same difference, which keeps its digits where the anchor
        moves far less than the normal coordinate.
        """
        if 2 * abs(self.s_end) < min(self.f_end, self.b_end):
            return self.s * (self.f_end + self.b_end) - (self.f + self.b) * self.s_end
        return self.f * self.b_end - self.b * self.f_end

    def _is_in_backward(self, side: float) -> bool:
        """True where friction acts in b: by the side, where both sums decrease."""
        return self.f_end <= 0 or (self.b_end > 0 and side >= 0)

    def _gap(self, in_backward: bool, side: float) -> float:  # noqa: FBT001 -- as C takes it
        """Distance of the load point from the front in the normal coordinate."""
        return max(side / self.b_end if in_backward else -side / self.f_end, 0.0) / 2


def accumulate(parent: Indices, step: Array, total: Array) -> None:
    """Add to the step of each vertex the total of its parent, which precedes it."""
    for i in range(len(parent)):
        below = parent[i]
        total[i] = 0.0 if below < 0 else total[below] + step[i]


def decrease(x0: float, y0: float, x: float, y: float) -> float:
    """Return x0 + y0 - (x + y) of four doubles, with the rounding errors of both sums."""
    before = x0 + y0
    after = x + y
    return (before - after) + (rounding(x0, y0, before) - rounding(x, y, after))


def rounding(a: float, b: float, total: float) -> float:
    """Return the rounding error of total = a + b, exactly (Knuth's two-sum)."""
    part = total - a
    return (a - (total - part)) + (b - part)
