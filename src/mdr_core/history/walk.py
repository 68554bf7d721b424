"""The steps of `memory`, one after the other, on plain numbers.

Sequential, so nothing for NumPy: `walk.pxd` gives the numbers C's types, and Cython
compiles this very text. Uncompiled it gives the same digits, some hundred times slower.
"""

from mdr_core.typing import Array, Indices

# Rows of the vertices: forward and backward as (high, low), their growth from the parent.
FORWARD = 0
BACKWARD = 2
FORWARD_STEP = 4
BACKWARD_STEP = 5
# Rows of the links: the vertex below, and the leg of a straight piece.
PARENT = 0
LEG = 1
# Rows of the pieces.
LEVEL = 0
SPAN = 1
SLIP = 2
UPPER_GAP = 3
LOWER_GAP = 4
# Indices into `counts`.
VERTICES = 0
PIECES = 1


def run(
    level: Array,
    shift: Array,
    leg: Indices,
    vertices: Array,
    links: Indices,
    top: Indices,
    pieces: Array,
    piece_step: Indices,
    counts: Indices,
    start_level: float,
    start_shift: float,
    record: bool,  # noqa: FBT001
) -> None:
    """Walk all steps, from the vertices already there; `counts` says how many, and is updated."""
    at = counts[VERTICES] - 1 if start_level > 0 else -1
    x0 = start_level
    y0 = start_shift
    for i in range(len(level)):
        x1 = level[i]
        y1 = shift[i]
        if x1 > 0:
            if at < 0:
                # Contact begins where the straight way crosses level zero.
                touch = y0 + (y1 - y0) * (-x0 / (x1 - x0))
                at = _push(vertices, links, counts, -1, -1)
                _place(vertices, at, touch, 0.0, -touch, 0.0)
                x0 = 0.0
                y0 = touch
            at = _step(
                vertices, links, pieces, piece_step, counts, at,
                x0, y0, x1, y1, i, leg[i], record,
            )  # fmt: skip
        elif at >= 0:
            leave = y0 + (y1 - y0) * (x0 / (x0 - x1))
            if record:
                _step(
                    vertices, links, pieces, piece_step, counts, at,
                    x0, y0, 0.0, leave, i, leg[i], record,
                )  # fmt: skip
            at = -1
        top[i] = at
        x0 = x1
        y0 = y1


def accumulate(parent: Indices, increment: Array, total: Array) -> None:
    """Add to each vertex' increment the total of its parent, which stands before it."""
    for i in range(len(parent)):
        below = parent[i]
        total[i] = increment[i] + (total[below] if below >= 0 else 0.0)


def _step(
    vertices: Array,
    links: Indices,
    pieces: Array,
    piece_step: Indices,
    counts: Indices,
    at: int,
    x0: float,
    y0: float,
    x: float,
    y: float,
    step: int,
    leg: int,
    record: bool,  # noqa: FBT001
) -> int:
    """One straight step to the level x and the shift y; returns the new load point's vertex."""
    forward = x + y
    forward_low = _lost(x, y, forward)
    backward = x - y
    backward_low = _lost(x, -y, backward)
    rise = _above(vertices, FORWARD, at, forward, forward_low)
    fall = _above(vertices, BACKWARD, at, backward, backward_low)
    # How far the old load point exceeds the new one, negative where it lies below.
    if (rise <= 0) & (fall <= 0):
        if (rise == 0) & (fall == 0):
            return at
        # Straight on, from the load point itself: where one sum of the two shifts stands still
        # both grow by the same number.
        forward_step = max((x - x0) + (y - y0), 0.0) if rise < 0 else 0.0
        backward_step = max((x - x0) - (y - y0), 0.0) if fall < 0 else 0.0
        below = at
        if links[LEG, at] == leg and links[PARENT, at] >= 0:
            # The same straight line goes on.
            forward_step += vertices[FORWARD_STEP, at]
            backward_step += vertices[BACKWARD_STEP, at]
            below = links[PARENT, at]
        return _extend(
            vertices, links, counts, below, forward_step, backward_step,
            forward, forward_low, backward, backward_low, leg,
        )  # fmt: skip
    start = at
    upper = _last_above(vertices, links, at, forward, forward_low, backward, backward_low)
    at = links[PARENT, upper]
    if at >= 0:
        at = _corner(
            vertices, links, counts, at, upper,
            forward, forward_low, backward, backward_low,
        )  # fmt: skip
    if record:
        _record(vertices, links, pieces, piece_step, counts, start, at, rise, fall, x, step)
    if at < 0:
        # Everything slips, the axis included, back to where the load point leaves it.
        at = _push(vertices, links, counts, -1, -1)
        if _above(vertices, FORWARD, upper, forward, forward_low) > 0:
            _place(vertices, at, forward, forward_low, -forward, -forward_low)
        else:
            _place(vertices, at, -backward, -backward_low, backward, backward_low)
        if not x > 0:
            return at
    return _extend(
        vertices, links, counts, at,
        -_above(vertices, FORWARD, at, forward, forward_low),
        -_above(vertices, BACKWARD, at, backward, backward_low),
        forward, forward_low, backward, backward_low, -1,
    )  # fmt: skip


def _last_above(
    vertices: Array,
    links: Indices,
    at: int,
    forward: float,
    forward_low: float,
    backward: float,
    backward_low: float,
) -> int:
    """The vertex nearest to the axis that exceeds the load point in either sum; `at` does."""
    below = at
    # Both are looked at, whatever the first says: on a random path no guess pays.
    while below >= 0 and (
        (_above(vertices, FORWARD, below, forward, forward_low) > 0)
        | (_above(vertices, BACKWARD, below, backward, backward_low) > 0)
    ):
        at = below
        below = links[PARENT, below]
    return at


def _corner(
    vertices: Array,
    links: Indices,
    counts: Indices,
    lower: int,
    upper: int,
    forward: float,
    forward_low: float,
    backward: float,
    backward_low: float,
) -> int:
    """The vertex where the piece from `lower` to `upper` is cut: `lower` itself if there."""
    forward_step = vertices[FORWARD_STEP, upper]
    backward_step = vertices[BACKWARD_STEP, upper]
    over_forward = _above(vertices, FORWARD, upper, forward, forward_low)
    over_backward = _above(vertices, BACKWARD, upper, backward, backward_low)
    keep_forward = -_above(vertices, FORWARD, lower, forward, forward_low)
    keep_backward = -_above(vertices, BACKWARD, lower, backward, backward_low)
    # The cut nearer to the axis holds; shares of the piece are compared crosswise.
    by_forward = (over_forward > 0) & (
        (over_backward <= 0) | (keep_forward * backward_step <= keep_backward * forward_step)
    )
    keep = keep_forward if by_forward else keep_backward
    if keep <= 0:
        return lower
    new = _push(vertices, links, counts, lower, -1)
    row = FORWARD if by_forward else BACKWARD
    _cut(vertices, new, lower, upper, row, keep, over_forward if by_forward else over_backward)
    vertices[row, new] = forward if by_forward else backward
    vertices[row + 1, new] = forward_low if by_forward else backward_low
    return new


def _cut(
    vertices: Array, new: int, lower: int, upper: int, row: int, keep: float, over: float
) -> None:
    """Place `new` on the piece, `keep` above its lower end and `over` below its upper one."""
    other = BACKWARD if row == FORWARD else FORWARD
    own_step = FORWARD_STEP if row == FORWARD else BACKWARD_STEP
    other_step = BACKWARD_STEP if row == FORWARD else FORWARD_STEP
    ratio = vertices[other_step, upper] / vertices[own_step, upper]
    # From the nearer end, so that the distance to either keeps its digits.
    if keep <= over:
        base = lower
        move = keep * ratio
    else:
        base = upper
        move = -over * ratio
    high = vertices[other, base]
    total = high + move
    low = _lost(high, move, total) + vertices[other + 1, base]
    vertices[other, new] = total + low
    vertices[other + 1, new] = _lost(total, low, total + low)
    vertices[own_step, new] = keep
    rest = keep * ratio if keep <= over else vertices[other_step, upper] - over * ratio
    vertices[other_step, new] = max(rest, 0.0)


def _record(
    vertices: Array,
    links: Indices,
    pieces: Array,
    piece_step: Indices,
    counts: Indices,
    start: int,
    end: int,
    rise: float,
    fall: float,
    x: float,
    step: int,
) -> None:
    """Note what slips while the load point goes straight from `start` to where `end` is cut.

    `rise` and `fall` are what the start exceeds the load point by. A vertex is reached after the
    share (start - vertex)/(start - load point) of the way, in whichever sum comes first.
    """
    upper = start
    while upper != end and links[PARENT, upper] >= 0:
        lower = links[PARENT, upper]
        if end >= 0 and lower == links[PARENT, end] and end != lower:
            # The last piece is cut at the corner.
            lower = end
        _record_piece(vertices, pieces, piece_step, counts, start, lower, upper, rise, fall, step)
        upper = lower
    if end < 0:
        _record_slide(vertices, pieces, piece_step, counts, start, upper, rise, fall, x, step)


def _record_piece(
    vertices: Array,
    pieces: Array,
    piece_step: Indices,
    counts: Indices,
    start: int,
    lower: int,
    upper: int,
    rise: float,
    fall: float,
    step: int,
) -> None:
    forward_high = _between(vertices, FORWARD, start, upper)
    forward_low = _between(vertices, FORWARD, start, lower)
    backward_high = _between(vertices, BACKWARD, start, upper)
    backward_low = _between(vertices, BACKWARD, start, lower)
    level = (
        vertices[FORWARD, lower]
        + vertices[BACKWARD, lower]
        + (vertices[FORWARD + 1, lower] + vertices[BACKWARD + 1, lower])
    ) / 2
    level = max(level, 0.0)
    # Which of the two bounds is reached first, at either end.
    high = forward_high * fall - backward_high * rise
    low = forward_low * fall - backward_low * rise
    if rise <= 0 or (fall > 0 and high >= 0 and low >= 0):
        _note(
            pieces, piece_step, counts, step, level, 0.0, 1.0,
            forward_high, forward_low, backward_high, backward_low, -rise / fall,
        )  # fmt: skip
    elif fall <= 0 or (high <= 0 and low <= 0):
        _note(
            pieces, piece_step, counts, step, level, 0.0, 1.0,
            backward_high, backward_low, forward_high, forward_low, -fall / rise,
        )  # fmt: skip
    else:
        # Both in turn: the load point passes through the piece, where nothing slips.
        share = high / (high - low)
        if high > 0:
            _note(
                pieces, piece_step, counts, step, level, 1.0 - share, 1.0,
                forward_high, forward_low, backward_high, backward_low, -rise / fall,
            )  # fmt: skip
            _note(
                pieces, piece_step, counts, step, level, 0.0, 1.0 - share,
                backward_high, backward_low, forward_high, forward_low, -fall / rise,
            )  # fmt: skip
        else:
            _note(
                pieces, piece_step, counts, step, level, 1.0 - share, 1.0,
                backward_high, backward_low, forward_high, forward_low, -fall / rise,
            )  # fmt: skip
            _note(
                pieces, piece_step, counts, step, level, 0.0, 1.0 - share,
                forward_high, forward_low, backward_high, backward_low, -rise / fall,
            )  # fmt: skip


def _note(
    pieces: Array,
    piece_step: Indices,
    counts: Indices,
    step: int,
    level: float,
    below: float,
    above: float,
    free_high: float,
    free_low: float,
    bound_high: float,
    bound_low: float,
    climb: float,
) -> None:
    """Write one piece, from the shares `below` to `above` of a straight one.

    `bound` is how far its ends lie below the start in the sum that is reached first, `free` in
    the other one, and `climb` is how the load point moves in that for each unit of the first.
    """
    bound_step = bound_low - bound_high
    slip = bound_step * (above - below)
    if not slip > 0:
        return
    free_step = free_low - free_high
    free_upper = free_high + free_step * (1.0 - above)
    free_lower = free_high + free_step * (1.0 - below)
    bound_upper = bound_high + bound_step * (1.0 - above)
    bound_lower = bound_high + bound_step * (1.0 - below)
    half_span = (bound_step + free_step) / 2
    index = counts[PIECES]
    pieces[LEVEL, index] = level + below * half_span
    pieces[SPAN, index] = (above - below) * half_span
    pieces[SLIP, index] = slip
    pieces[UPPER_GAP, index] = max(free_upper + bound_upper * climb, 0.0) / 2
    pieces[LOWER_GAP, index] = max(free_lower + bound_lower * climb, 0.0) / 2
    piece_step[index] = step
    counts[PIECES] = index + 1


def _record_slide(
    vertices: Array,
    pieces: Array,
    piece_step: Indices,
    counts: Indices,
    start: int,
    bottom: int,
    rise: float,
    fall: float,
    x: float,
    step: int,
) -> None:
    """Note the slide of everything, after the front has reached the axis."""
    forward = _between(vertices, FORWARD, start, bottom)
    backward = _between(vertices, BACKWARD, start, bottom)
    if rise > 0 and (fall <= 0 or forward * fall <= backward * rise):
        slip = rise - forward
        gap = (backward - forward * (fall / rise)) / 2
    else:
        slip = fall - backward
        gap = (forward - backward * (rise / fall)) / 2
    if not slip > 0:
        return
    index = counts[PIECES]
    # A level below the axis says that nothing sticks.
    pieces[LEVEL, index] = -1.0
    pieces[SPAN, index] = 0.0
    pieces[SLIP, index] = slip
    pieces[UPPER_GAP, index] = max(gap, 0.0)
    pieces[LOWER_GAP, index] = x
    piece_step[index] = step
    counts[PIECES] = index + 1


def _extend(
    vertices: Array,
    links: Indices,
    counts: Indices,
    below: int,
    forward_step: float,
    backward_step: float,
    forward: float,
    forward_low: float,
    backward: float,
    backward_low: float,
    leg: int,
) -> int:
    """Push the load point; one piece stands for two that slip the same way."""
    if links[PARENT, below] >= 0 and (
        (backward_step <= 0 and vertices[BACKWARD_STEP, below] == 0)
        or (forward_step <= 0 and vertices[FORWARD_STEP, below] == 0)
    ):
        below = links[PARENT, below]
        forward_step = -_above(vertices, FORWARD, below, forward, forward_low)
        backward_step = -_above(vertices, BACKWARD, below, backward, backward_low)
    if forward_step <= 0 and backward_step <= 0:
        return below
    new = _push(vertices, links, counts, below, leg)
    _place(vertices, new, forward, forward_low, backward, backward_low)
    vertices[FORWARD_STEP, new] = max(forward_step, 0.0)
    vertices[BACKWARD_STEP, new] = max(backward_step, 0.0)
    return new


def _push(vertices: Array, links: Indices, counts: Indices, below: int, leg: int) -> int:
    new: int = counts[VERTICES]
    counts[VERTICES] = new + 1
    links[PARENT, new] = below
    links[LEG, new] = leg
    vertices[FORWARD_STEP, new] = 1.0
    vertices[BACKWARD_STEP, new] = 1.0
    return new


def _place(
    vertices: Array, at: int, forward: float, forward_low: float, backward: float, low: float
) -> None:
    vertices[FORWARD, at] = forward
    vertices[FORWARD + 1, at] = forward_low
    vertices[BACKWARD, at] = backward
    vertices[BACKWARD + 1, at] = low


def _above(vertices: Array, row: int, at: int, high: float, low: float) -> float:
    """What a vertex exceeds the number (high, low) by."""
    above: float = (vertices[row, at] - high) + (vertices[row + 1, at] - low)
    return above


def _between(vertices: Array, row: int, upper: int, lower: int) -> float:
    """What one vertex exceeds another by."""
    above: float = (vertices[row, upper] - vertices[row, lower]) + (
        vertices[row + 1, upper] - vertices[row + 1, lower]
    )
    return above


def _lost(a: float, b: float, total: float) -> float:
    """The rounding error of total = a + b, exactly (Knuth's two-sum)."""
    part = total - a
    return (a - (total - part)) + (b - part)
