"""Sequential loops of load histories: the polyline after each step, and the sweep of the front.

Every load point depends on the previous one, so that NumPy cannot vectorise the loop. Cython
compiles this file as it stands, with the C types of `slip_kernel.pxd`; uncompiled it returns
bit-identical results, about a hundred times slower. One file holds all functions, since Cython
inlines within a module only.
"""

from mdr_core.history.slip_layout import NORMAL, SLOPE
from mdr_core.typing import Array, Flags, Indices

# Columns of the sums of a vertex.
FORWARD = 0  # normal + anchor
BACKWARD = 1  # normal - anchor
# Relative size below which a change of a corner's sums is rounding error. It is the constant of
# `doubles`, which has no C type.
ADJACENT = 2.0**-50


class PolylineStack:
    """Polyline as a stack of vertices V_0 ... V_m, from the axis to the load point P.

    With the sums f = normal + anchor and b = normal - anchor, a straight step to P' leaves

        V_0 ... V_m, P'      if f_m <= f' and b_m <= b': all springs stick,
        V_0 ... V_k, C, P'   otherwise; k is the last vertex with f_k <= f' and b_k <= b'.

    The corner C is the place between V_k and V_k+1 at which the second of the two sums falls to
    its value at P'. The other sum of C is interpolated on the segment, and only this sum grows from
    C to P'. If the vertex on the axis exceeds P' as well, all springs slip, and C lies on the axis.

    Parameters
    ----------
    rows : the vertices, with the columns of `slip_layout`.
    top : place of the last vertex; -1 in separation.
    x, y : normal and tangential coordinate of the load point.
    """

    def __init__(self, rows: Array, top: int, x: float, y: float) -> None:
        self.rows = rows
        self.top = top
        self.x = x
        self.y = y
        # Lowest place that the last step has changed.
        self.changed = top + 1
        # True if the last step was straight and without slip, so that the next step may continue
        # it.
        self.straight = False

    def run(
        self,
        path: Array,
        continues: Flags,
        number: Indices,
        parent: Indices,
        vertices: Array,
        tops: Indices,
    ) -> int:
        """Move the load point along all steps; return the number of vertices of all polylines.

        Parameters
        ----------
        path : normal and tangential coordinate of the load points, shape (2, n).
        continues : see `move`, shape (n,).
        number : index of each vertex on the stack.
        parent, vertices : parent (-1 on the axis), and normal coordinate and slope, of each vertex
            on the stack. The loop adds the values of every new vertex.
        tops : receives the vertex of each load point, -1 in separation.
        """
        made = self.top + 1
        for i in range(len(tops)):
            self.move(path[0, i], path[1, i], continues[i])
            for at in range(self.changed, self.top + 1):
                number[at] = made
                parent[made] = number[at - 1] if at > 0 else -1
                vertices[0, made] = self.rows[at, NORMAL]
                vertices[1, made] = self.rows[at, SLOPE]
                made += 1
            tops[i] = number[self.top] if self.top >= 0 else -1
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
            self.rows[:size] = vertices[begin : ends[i]]
            self.top = size - 1
            self.x = path[0, i]
            self.y = path[1, i]
            self.move(path[2, i], path[3, i], continues=False)
            size = self.top + 1
            moved[made : made + size] = self.rows[:size]
            begin = ends[i]
            made += size
            moved_ends[i] = made
        return made

    def move(self, x: float, y: float, continues: bool) -> None:  # noqa: FBT001
        """Move the load point by one straight step.

        Parameters
        ----------
        x, y : normal and tangential coordinate after the step; x <= 0 in separation.
        continues : true if the step continues the straight line of the previous step; without slip
            it extends the last segment.
        """
        x0 = self.x
        y0 = self.y
        self.x = x
        self.y = y
        self.changed = self.top + 1
        if x <= 0:
            self.top = -1
            self.changed = 0
            self.straight = False
            return
        if self.top < 0:
            # Contact begins where the straight step crosses normal coordinate zero.
            y0 = y0 + (y - y0) * (-x0 / (x - x0))
            x0 = 0.0
            self._put(0, y0, -y0, 0.0, 0.0)
            self.top = self.changed = 0
        rise = x + y - self.rows[self.top, FORWARD]
        fall = x - y - self.rows[self.top, BACKWARD]
        if rise < 0 or fall < 0:
            self._slip(x + y, x - y)
            self.straight = False
        else:
            self.straight = self.straight and continues
            if rise > 0 or fall > 0:
                self._stick(x - x0, y - y0)
                self.straight = True

    def _stick(self, deeper: float, further: float) -> None:
        """Extend the polyline straight to the load point, by one segment for each straight line."""
        below = self.top
        if self.straight and below > 0:
            span = self.rows[below, NORMAL] - self.rows[below - 1, NORMAL]
            deeper += span
            further += self.rows[below, SLOPE] * span
            below -= 1
        if self.x + self.y <= self.rows[below, FORWARD]:
            slope = -1.0
        elif self.x - self.y <= self.rows[below, BACKWARD]:
            slope = 1.0
        else:
            slope = min(max(further / deeper, -1.0), 1.0)
        self._extend(below, slope)

    def _slip(self, forward: float, backward: float) -> None:
        """Cut the polyline where it exceeds the sums of the load point, and extend it to there."""
        upper = self.top
        while upper > 0 and (
            self.rows[upper - 1, FORWARD] > forward or self.rows[upper - 1, BACKWARD] > backward
        ):
            upper -= 1
        over_forward = self.rows[upper, FORWARD] - forward
        over_backward = self.rows[upper, BACKWARD] - backward
        if upper == 0:
            # All springs slip.
            in_forward = over_forward > 0
            if in_forward:
                self._put(0, forward, -forward, 0.0, 0.0)
            else:
                self._put(0, -backward, backward, 0.0, 0.0)
        else:
            # Length of the segment above the corner by either cone face; the larger value holds.
            slope = self.rows[upper, SLOPE]
            by_forward = over_forward / (1 + slope) if over_forward > 0 and slope > -1 else 0.0
            by_backward = over_backward / (1 - slope) if over_backward > 0 and slope < 1 else 0.0
            in_forward = by_forward > by_backward
            error = ADJACENT * (abs(self.rows[upper, FORWARD]) + abs(self.rows[upper, BACKWARD]))
            if in_forward:
                at_vertex = self.rows[upper - 1, FORWARD] >= forward
                other = self.rows[upper, BACKWARD] - by_forward * (1 - slope)
                backward = other if other < backward - error else backward
            else:
                at_vertex = self.rows[upper - 1, BACKWARD] >= backward
                other = self.rows[upper, FORWARD] - by_backward * (1 + slope)
                forward = other if other < forward - error else forward
            if at_vertex:
                upper -= 1
            else:
                normal = max((forward + backward) / 2, self.rows[upper - 1, NORMAL])
                self._put(upper, forward, backward, normal, slope)
        self.top = self.changed = upper
        self._extend(upper, -1.0 if in_forward else 1.0)

    def _extend(self, below: int, slope: float) -> None:
        """Push the load point onto a vertex; two segments on the same face become one."""
        forward = self.x + self.y
        backward = self.x - self.y
        if below > 0 and abs(slope) == 1 and self.rows[below, SLOPE] == slope:
            below -= 1
        if forward > self.rows[below, FORWARD] or backward > self.rows[below, BACKWARD]:
            below += 1
            self._put(below, forward, backward, self.x, slope)
            self.changed = min(self.changed, below)
        self.top = below
        self.rows[below, NORMAL] = self.x

    def _put(self, at: int, forward: float, backward: float, normal: float, slope: float) -> None:
        self.rows[at, FORWARD] = forward
        self.rows[at, BACKWARD] = backward
        self.rows[at, NORMAL] = normal
        self.rows[at, SLOPE] = slope


class SlipFront:
    """Slip front of straight load steps: swept pieces of the polyline, and their work.

    On a step from P to P' a place of the polyline slips as soon as it exceeds the load point in one
    of the sums f and b. The front moves down from P to where neither sum exceeds its value at P'.
    Segments are divided into pieces at the breaks of the work M, see `friction_work`.

    Parameters
    ----------
    pieces : receives six numbers of each piece with work as long as there is room: step, normal
        coordinate of the lower end, length in the normal coordinate, and the Bernstein coefficients
        of M, upwards; shape (6, room).
    """

    def __init__(self, pieces: Array) -> None:
        self.pieces = pieces
        self.count = 0
        self.step = 0
        # Decrease of the normal and of the tangential coordinate of the load point on the step.
        self.down = 0.0
        self.aside = 0.0

    def run(
        self, parent: Indices, vertices: Array, tops: Indices, before: Array, after: Array
    ) -> int:
        """Sweep on all steps; return the number of pieces, of which some may have had no room.

        Parameters
        ----------
        parent, vertices : tree of all polylines, see `PolylineStack.run`.
        tops : vertex of the load point before each step, shape (n,).
        before, after : normal and tangential coordinate before and after each step, shape (2, n).
        """
        for i in range(len(tops)):
            x, y = before[0, i], before[1, i]
            x_end, y_end = after[0, i], after[1, i]
            if x <= 0 and x_end <= 0:
                continue
            # Contact begins, or ends, where the straight step crosses normal coordinate zero.
            if x <= 0:
                y += (y_end - y) * x / (x - x_end)
                x = 0.0
            elif x_end <= 0:
                y_end = y + (y_end - y) * x / (x - x_end)
                x_end = 0.0
            self.step = i
            self.down, self.aside = x - x_end, y - y_end
            self._descend(parent, vertices, tops[i])
            # Springs that come into contact slip at once where the path is steeper than friction.
            if self.down < 0 and abs(self.aside) > -self.down:
                self._divide(x, self.down, self.aside, -self.down, -self.aside)
        return self.count

    def _descend(self, parent: Indices, vertices: Array, at: int) -> None:
        """Sweep the segments below a vertex, the load point, on one step."""
        f_end = self.down + self.aside
        b_end = self.down - self.aside
        n = 0.0
        s = 0.0
        part = 1.0
        below = parent[at] if at >= 0 and max(f_end, b_end) > 0 else -1
        while below >= 0:
            span = max(vertices[0, at] - vertices[0, below], 0.0)
            turn = vertices[1, at] * span
            f = n + s
            b = n - s
            if f + (span + turn) >= f_end and b + (span - turn) >= b_end:
                part = (f_end - f) / (span + turn) if f < f_end else 0.0
                other = (b_end - b) / (span - turn) if b < b_end else 0.0
                part = min(max(part, other), 1.0)
            low = vertices[0, below] + (1 - part) * span
            self._divide(low, n, s, part * span, part * turn)
            n += part * span
            s += part * turn
            at = below
            below = parent[at] if part == 1 else -1

    def _divide(self, low: float, n: float, s: float, span: float, turn: float) -> None:
        """Divide a swept segment at the breaks of M: at P', and where the path of P crosses it.

        Parameters
        ----------
        low : normal coordinate of the lower end.
        n, s : distances in normal coordinate and anchor from P down to the upper end.
        span, turn : differences of normal coordinate and anchor from the upper to the lower end.
        """
        upper = s * self.down - n * self.aside
        lower = upper + (turn * self.down - span * self.aside)
        at_end = (self.down - n) / span if span > 0 else 0.0
        crossing = upper / (upper - lower) if upper * lower < 0 else 0.0
        first = min(max(min(at_end, crossing), 0.0), 1.0)
        second = min(max(at_end, crossing, 0.0), 1.0)
        self._piece(low, n, s, span, turn, 0.0, first)
        self._piece(low, n, s, span, turn, first, second)
        self._piece(low, n, s, span, turn, second, 1.0)

    def _piece(
        self, low: float, n: float, s: float, span: float, turn: float, start: float, stop: float
    ) -> None:
        """Append the piece between two shares of a swept segment, with the coefficients of M."""
        length = (stop - start) * span
        if length <= 0:
            return
        if self.count < self.pieces.shape[1]:
            self.pieces[0, self.count] = self.step
            self.pieces[1, self.count] = low + (1 - stop) * span
            self.pieces[2, self.count] = length
            n, s = n + start * span, s + start * turn
            turn *= stop - start
            # Cross products of P' and both ends: positive where b is exceeded first.
            upper = s * self.down - n * self.aside
            lower = (s + turn) * self.down - (n + length) * self.aside
            backward = self.down + self.aside <= 0 or (
                self.down > self.aside and upper + lower >= 0
            )
            sign = -1.0 if backward else 1.0
            fall = self.down + sign * self.aside
            before = max(-sign * upper / fall, 0.0)
            high_friction = (before + max(n - self.down, 0.0)) / 2
            high = self._fall(n, fall - (n + sign * s), before * fall)
            n, s = n + length, s + turn
            before = max(-sign * lower / fall, 0.0)
            low_friction = (before + max(n - self.down, 0.0)) / 2
            low = self._fall(n, fall - (n + sign * s), before * fall)
            self.pieces[3, self.count] = low * low_friction
            self.pieces[4, self.count] = (low * high_friction + high * low_friction) / 2
            self.pieces[5, self.count] = high * high_friction
        self.count += 1

    def _fall(self, n: float, in_contact: float, apart: float) -> float:
        """Return the decrease of the sum; springs above P' lose contact before the step ends."""
        return apart / self.down if n < self.down else max(in_contact, 0.0)


def accumulate(parent: Indices, step: Array, total: Array) -> None:
    """Add to the step of each vertex the total of its parent, which precedes it."""
    for i in range(len(parent)):
        below = parent[i]
        total[i] = 0.0 if below < 0 else total[below] + step[i]
