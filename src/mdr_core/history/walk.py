"""The steps of `memory`, one after the other, on plain numbers.

Sequential, so nothing for NumPy: `walk.pxd` gives the numbers C's types, and Cython
compiles this very text. Uncompiled it gives the same digits, some hundred times slower.

The polyline is a stack, its first vertex on the axis. On a random path no guess of a branch
pays: what can be chosen by an index is not asked for by an if.
"""

from mdr_core.history import slots
from mdr_core.typing import Array, Indices


class Walk:
    """The stack, and what is made on the way: vertices, and pieces that slip."""

    def __init__(
        self,
        stack: Array,
        marks: Indices,
        top: int,
        made: int,
        level: Array,
        growth: Array,
        parent: Indices,
        pieces: Array,
        piece_step: Indices,
    ) -> None:
        self.stack = stack
        self.marks = marks
        self.top = top
        self.level = level
        self.growth = growth
        self.parent = parent
        self.pieces = pieces
        self.piece_step = piece_step
        self.made = made
        self.noted = 0

    def run(
        self,
        level: Array,
        shift: Array,
        goes_on: Array,
        tops: Indices,
        start_level: float,
        start_shift: float,
        record: bool,  # noqa: FBT001 -- by place, as C takes it
    ) -> None:
        """Walk all steps, and tell the number of each load point; -1 in a gap."""
        at = self.top
        x0 = start_level
        y0 = start_shift
        straight = False
        last_forward = self.stack[8 * at + slots.FORWARD]
        last_forward_low = self.stack[8 * at + slots.LOW + slots.FORWARD]
        last_backward = self.stack[8 * at + slots.BACKWARD]
        last_backward_low = self.stack[8 * at + slots.LOW + slots.BACKWARD]
        for i in range(len(level)):
            x = level[i]
            y = shift[i]
            touches = x > 0
            if touches and at < slots.AXIS:
                # Contact begins where the straight way crosses level zero.
                y0 = y0 + (y - y0) * (-x0 / (x - x0))
                x0 = 0.0
                last_forward = y0
                last_forward_low = 0.0
                last_backward = -y0
                last_backward_low = 0.0
                at = self._touch(y0)
            elif not touches and at >= slots.AXIS and record:
                # The last that slips, until the straight way crosses level zero.
                y = y0 + (y - y0) * (x0 / (x0 - x))
                x = 0.0
            if touches or (at >= slots.AXIS and record):
                forward = x + y
                forward_low = _lost(x, y, forward)
                backward = x - y
                backward_low = _lost(x, -y, backward)
                self._aim(forward, forward_low, backward, backward_low)
                # How far the old load point, which is the top, exceeds the new one.
                rise = (last_forward - forward) + (last_forward_low - forward_low)
                fall = (last_backward - backward) + (last_backward_low - backward_low)
                if max(rise, fall) > 0:
                    at = self._slip(at, x, i, record)
                    straight = False
                else:
                    straight = straight and goes_on[i]
                    if rise < 0 or fall < 0:
                        at = self._follow(at, x - x0, y - y0, rise, fall, straight, x)
                        straight = True
                last_forward = forward
                last_forward_low = forward_low
                last_backward = backward
                last_backward_low = backward_low
            if not touches:
                at = slots.MIRROR
                straight = False
            tops[i] = self.marks[2 * at + slots.NUMBER]
            x0 = level[i]
            y0 = shift[i]
        self.top = at

    def _aim(
        self, forward: float, forward_low: float, backward: float, backward_low: float
    ) -> None:
        """Set the load point, and its mirror image."""
        self.stack[8 * slots.POINT + slots.FORWARD] = forward
        self.stack[8 * slots.POINT + slots.BACKWARD] = backward
        self.stack[8 * slots.POINT + slots.LOW + slots.FORWARD] = forward_low
        self.stack[8 * slots.POINT + slots.LOW + slots.BACKWARD] = backward_low
        self.stack[8 * slots.MIRROR + slots.FORWARD] = -backward
        self.stack[8 * slots.MIRROR + slots.BACKWARD] = -forward
        self.stack[8 * slots.MIRROR + slots.LOW + slots.FORWARD] = -backward_low
        self.stack[8 * slots.MIRROR + slots.LOW + slots.BACKWARD] = -forward_low

    def _touch(self, shift: float) -> int:
        """Put the first vertex on the axis."""
        self._put(slots.AXIS, slots.FORWARD, shift, 0.0, 1.0)
        self._put(slots.AXIS, slots.BACKWARD, -shift, 0.0, 1.0)
        self._make(slots.AXIS, 0.0)
        return slots.AXIS

    def _follow(
        self,
        at: int,
        deeper: float,
        further: float,
        rise: float,
        fall: float,
        goes_on: bool,  # noqa: FBT001 -- as above
        x: float,
    ) -> int:
        """Go straight on from the load point, whose anchors stay; returns the new one.

        Where one sum of the two shifts stands still both grow by the same number.
        """
        forward_step = max(deeper + further, 0.0) if rise < 0 else 0.0
        backward_step = max(deeper - further, 0.0) if fall < 0 else 0.0
        if goes_on and at > slots.AXIS:
            # The same straight line goes on.
            forward_step += self.stack[8 * at + slots.GROWTH + slots.FORWARD]
            backward_step += self.stack[8 * at + slots.GROWTH + slots.BACKWARD]
            at -= 1
        return self._extend(at, forward_step, backward_step, x)

    def _slip(
        self,
        start: int,
        x: float,
        step: int,
        record: bool,  # noqa: FBT001 -- as above
    ) -> int:
        """Cut the polyline where it exceeds the load point, as its top does; returns the corner."""
        lower = start - 1
        # The mirror image never exceeds the load point.
        while (
            max(
                self._excess(lower, slots.POINT, slots.FORWARD),
                self._excess(lower, slots.POINT, slots.BACKWARD),
            )
            > 0
        ):
            lower -= 1
        upper = lower + 1
        # The cut is in its `own` sum; on a face of an older cone the other one stands still.
        other = self.marks[2 * upper + slots.STILL]
        if upper == slots.AXIS:
            other = (
                slots.BACKWARD
                if self._excess(slots.AXIS, slots.POINT, slots.FORWARD) > 0
                else slots.FORWARD
            )
        elif other == slots.NEITHER:
            other = self._later(lower, upper)
        own = 1 - other
        keep = self._excess(slots.POINT, lower, own)
        if keep <= 0:
            if record:
                self._record(start, upper, lower, x, step)
            forward_step = self._excess(slots.POINT, lower, slots.FORWARD)
            backward_step = self._excess(slots.POINT, lower, slots.BACKWARD)
            return self._extend(lower, forward_step, backward_step, x)
        # Where everything slips the corner is the mirror image's, and both sums grow from the axis.
        whole = upper == slots.AXIS
        source = upper - whole
        rest = keep * whole
        if self.marks[2 * upper + slots.STILL] == slots.NEITHER:
            self._cut(lower, upper, own, other, keep)
            source = slots.CORNER
            rest = self.stack[8 * source + slots.GROWTH + other]
        high = self.stack[8 * source + other]
        low = self.stack[8 * source + slots.LOW + other]
        if record:
            self._settle(slots.CORNER, own)
            self._put(slots.CORNER, other, high, low, rest)
            self._record(start, upper, slots.CORNER, x, step)
        own_high = self.stack[8 * slots.POINT + own]
        own_low = self.stack[8 * slots.POINT + slots.LOW + own]
        self._put(upper, own, own_high, own_low, keep)
        self._put(upper, other, high, low, rest)
        level = max((own_high + high) + (own_low + low), 0.0) / 2
        self._make(upper, level)
        point_high = self.stack[8 * slots.POINT + other]
        point_low = self.stack[8 * slots.POINT + slots.LOW + other]
        reach = (point_high - high) + (point_low - low)
        if reach <= 0:
            # The corner is the load point.
            self._put(upper, other, point_high, point_low, rest)
            return upper
        at = upper + 1
        self._put(at, own, own_high, own_low, 0.0)
        self._put(at, other, point_high, point_low, reach)
        self.marks[2 * at + slots.STILL] = own
        self._make(at, x)
        return at

    def _cut(self, lower: int, upper: int, own: int, other: int, keep: float) -> None:
        """Find the corner's other sum where a straight piece is cut `keep` above its lower end."""
        growth = self.stack[8 * upper + slots.GROWTH + other]
        ratio = growth / self.stack[8 * upper + slots.GROWTH + own]
        over = self._excess(upper, slots.POINT, own)
        # From the nearer end, so that the distance to either keeps its digits.
        near = keep <= over
        base = lower if near else upper
        move = keep * ratio if near else -over * ratio
        rest = max(move if near else growth + move, 0.0)
        high = self.stack[8 * base + other]
        total = high + move
        low = _lost(high, move, total) + self.stack[8 * base + slots.LOW + other]
        self._put(slots.CORNER, other, total + low, _lost(total, low, total + low), rest)
        if rest <= 0:
            self.marks[2 * upper + slots.STILL] = other

    def _later(self, lower: int, upper: int) -> int:
        """The sum in which the load point is reached farther from the axis, on a straight piece."""
        over_forward = self._excess(upper, slots.POINT, slots.FORWARD)
        over_backward = self._excess(upper, slots.POINT, slots.BACKWARD)
        # Shares of the piece are compared crosswise.
        forward = (
            self._excess(slots.POINT, lower, slots.FORWARD)
            * self.stack[8 * upper + slots.GROWTH + slots.BACKWARD]
        )
        backward = (
            self._excess(slots.POINT, lower, slots.BACKWARD)
            * self.stack[8 * upper + slots.GROWTH + slots.FORWARD]
        )
        first = (over_forward > 0) & ((over_backward <= 0) | (forward <= backward))
        return slots.BACKWARD if first else slots.FORWARD

    def _extend(
        self,
        below: int,
        forward_step: float,
        backward_step: float,
        x: float,
    ) -> int:
        """Push the load point; one piece stands for two that slip the same way."""
        if below > slots.AXIS and (
            (backward_step <= 0 and self.stack[8 * below + slots.GROWTH + slots.BACKWARD] == 0)
            or (forward_step <= 0 and self.stack[8 * below + slots.GROWTH + slots.FORWARD] == 0)
        ):
            below -= 1
            forward_step = self._excess(slots.POINT, below, slots.FORWARD)
            backward_step = self._excess(slots.POINT, below, slots.BACKWARD)
        at = below
        if forward_step > 0 or backward_step > 0:
            at = below + 1
            self.stack[8 * at + slots.GROWTH + slots.FORWARD] = max(forward_step, 0.0)
            self.stack[8 * at + slots.GROWTH + slots.BACKWARD] = max(backward_step, 0.0)
            self.marks[2 * at + slots.STILL] = (
                slots.BACKWARD
                if backward_step <= 0
                else slots.FORWARD
                if forward_step <= 0
                else slots.NEITHER
            )
            self._make(at, x)
        self._settle(at, slots.FORWARD)
        self._settle(at, slots.BACKWARD)
        return at

    def _settle(self, at: int, row: int) -> None:
        """Give the vertex the very number of the load point."""
        self.stack[8 * at + row] = self.stack[8 * slots.POINT + row]
        self.stack[8 * at + slots.LOW + row] = self.stack[8 * slots.POINT + slots.LOW + row]

    def _make(
        self,
        at: int,
        level: float,
    ) -> None:
        """Number the vertex, and tell its level, its growth and its parent."""
        new = self.made
        self.made = new + 1
        self.marks[2 * at + slots.NUMBER] = new
        self.parent[new] = self.marks[2 * at - 2 + slots.NUMBER]
        self.level[new] = level
        self.growth[2 * new + slots.FORWARD] = self.stack[8 * at + slots.GROWTH + slots.FORWARD]
        self.growth[2 * new + slots.BACKWARD] = self.stack[8 * at + slots.GROWTH + slots.BACKWARD]

    def _put(self, at: int, row: int, high: float, low: float, growth: float) -> None:
        self.stack[8 * at + row] = high
        self.stack[8 * at + slots.LOW + row] = low
        self.stack[8 * at + slots.GROWTH + row] = growth

    def _excess(self, upper: int, lower: int, row: int) -> float:
        """What one vertex exceeds another by."""
        above: float = (self.stack[8 * upper + row] - self.stack[8 * lower + row]) + (
            self.stack[8 * upper + slots.LOW + row] - self.stack[8 * lower + slots.LOW + row]
        )
        return above

    def _record(
        self,
        start: int,
        upper: int,
        end: int,
        x: float,
        step: int,
    ) -> None:
        """Note what slips while the load point goes straight from `start`: all from there to `end`.

        `end` is on the piece below `upper`, or below the axis. A vertex is reached after the share
        (start - vertex)/(start - load point) of the way, in whichever sum comes first.
        """
        for at in range(start, upper, -1):
            self._record_piece(start, at - 1, at, step)
        if upper == slots.AXIS:
            self._record_slide(start, x, step)
        else:
            self._record_piece(start, end, upper, step)

    def _record_piece(
        self,
        start: int,
        lower: int,
        upper: int,
        step: int,
    ) -> None:
        rise = self._excess(start, slots.POINT, slots.FORWARD)
        fall = self._excess(start, slots.POINT, slots.BACKWARD)
        # Which of the two bounds is reached first, at either end.
        high = (
            self._excess(start, upper, slots.FORWARD) * fall
            - self._excess(start, upper, slots.BACKWARD) * rise
        )
        low = (
            self._excess(start, lower, slots.FORWARD) * fall
            - self._excess(start, lower, slots.BACKWARD) * rise
        )
        if rise <= 0 or (fall > 0 and high >= 0 and low >= 0):
            self._note(start, lower, upper, slots.BACKWARD, 0.0, 1.0, step)
        elif fall <= 0 or (high <= 0 and low <= 0):
            self._note(start, lower, upper, slots.FORWARD, 0.0, 1.0, step)
        else:
            # Both in turn: the load point passes through the piece, where nothing slips.
            rest = 1.0 - high / (high - low)
            bound = slots.BACKWARD if high > 0 else slots.FORWARD
            self._note(start, lower, upper, bound, rest, 1.0, step)
            self._note(start, lower, upper, 1 - bound, 0.0, rest, step)

    def _note(
        self,
        start: int,
        lower: int,
        upper: int,
        bound: int,
        below: float,
        above: float,
        step: int,
    ) -> None:
        """Write one piece, from the shares `below` to `above` of a straight one.

        `bound` is the sum that is reached first.
        """
        free = 1 - bound
        bound_high = self._excess(start, upper, bound)
        bound_step = self._excess(start, lower, bound) - bound_high
        slip = bound_step * (above - below)
        if not slip > 0:
            return
        free_high = self._excess(start, upper, free)
        free_step = self._excess(start, lower, free) - free_high
        # How the load point moves in the other sum for each unit of the first.
        climb = -self._excess(start, slots.POINT, free) / self._excess(start, slots.POINT, bound)
        upper_gap = free_high + free_step * (1.0 - above)
        lower_gap = free_high + free_step * (1.0 - below)
        upper_gap += (bound_high + bound_step * (1.0 - above)) * climb
        lower_gap += (bound_high + bound_step * (1.0 - below)) * climb
        level = (
            self.stack[8 * lower + slots.FORWARD]
            + self.stack[8 * lower + slots.BACKWARD]
            + (
                self.stack[8 * lower + slots.LOW + slots.FORWARD]
                + self.stack[8 * lower + slots.LOW + slots.BACKWARD]
            )
        )
        half_span = (bound_step + free_step) / 2
        self._write(
            step, max(level, 0.0) / 2 + below * half_span,
            (above - below) * half_span, slip, max(upper_gap, 0.0) / 2, max(lower_gap, 0.0) / 2,
        )  # fmt: skip

    def _record_slide(
        self,
        start: int,
        x: float,
        step: int,
    ) -> None:
        """Note the slide of everything, after the front has reached the axis."""
        rise = self._excess(start, slots.POINT, slots.FORWARD)
        fall = self._excess(start, slots.POINT, slots.BACKWARD)
        forward = self._excess(start, slots.AXIS, slots.FORWARD)
        backward = self._excess(start, slots.AXIS, slots.BACKWARD)
        if rise > 0 and (fall <= 0 or forward * fall <= backward * rise):
            slip = rise - forward
            gap = (backward - forward * (fall / rise)) / 2
        else:
            slip = fall - backward
            gap = (forward - backward * (rise / fall)) / 2
        if slip > 0:
            # A level below the axis says that nothing sticks.
            self._write(step, -1.0, 0.0, slip, max(gap, 0.0), x)

    def _write(
        self,
        step: int,
        level: float,
        span: float,
        slip: float,
        upper_gap: float,
        lower_gap: float,
    ) -> None:
        index = self.noted
        self.noted = index + 1
        self.piece_step[index] = step
        self.pieces[slots.LEVEL, index] = level
        self.pieces[slots.SPAN, index] = span
        self.pieces[slots.SLIP, index] = slip
        self.pieces[slots.UPPER_GAP, index] = upper_gap
        self.pieces[slots.LOWER_GAP, index] = lower_gap


def accumulate(parent: Indices, growth: Array, rise: Array, total: Array) -> None:
    """Add to each vertex' slope times rise the total of its parent, which stands before it."""
    for i in range(len(parent)):
        below = parent[i]
        if below < 0:
            total[i] = 0.0
        else:
            forward = growth[2 * i + slots.FORWARD]
            backward = growth[2 * i + slots.BACKWARD]
            total[i] = total[below] + (forward - backward) / (forward + backward) * rise[i]


def _lost(a: float, b: float, total: float) -> float:
    """The rounding error of total = a + b, exactly (Knuth's two-sum)."""
    part = total - a
    return (a - (total - part)) + (b - part)
