"""Slip memory of the tangential foundation, stored as a polyline.

Each spring has a normal coordinate n, which increases from the axis to the contact edge, and an
anchor, the tangential coordinate at which its tangential force is zero. The points (n, anchor)
form a polyline from the axis to the load point. Friction limits its slope to +-1, so both

    forward = n + anchor,    backward = n - anchor

increase along the polyline and never exceed their values at the load point. A load step removes
the vertices that exceed the new load point and appends a straight segment.

Coordinates are unevaluated sums (high, low) of two doubles. Load points and most corners are
therefore exact copies of the input, and differences stay accurate at small amplitudes. Normal
coordinates are depths where displacements are prescribed, and reduced normal forces where forces
are. Source: notes, §10.
"""

from dataclasses import dataclass
from math import fsum
from typing import NamedTuple

import numpy as np

from mdr_core.cached import cached_property
from mdr_core.elementwise import every, indices
from mdr_core.history import slip_memory_kernel as kernel
from mdr_core.typing import Array, Flags, Indices

# A step adds at most three vertices: the one on the axis, a corner and the load point.
_VERTICES = 3
# The slip front passes every removed vertex once, and on each step its start and its end.
_VISITS = _VERTICES + 2
# Place of the vertex on the axis on the kernel's stack.
_AXIS = 3


class LoadPoints(NamedTuple):
    """Ends of straight load steps."""

    normal: Array
    """Normal coordinate, shape (n,); <= 0 in separation."""
    tangential: Array
    """Tangential coordinate, shape (n,)."""
    continues: Flags
    """Steps that continue the straight line of the step before."""
    load_step: Indices
    """Load step that each belongs to."""


class Polyline(NamedTuple):
    """Vertices from the axis to the load point; in separation the load point alone."""

    forward: Array
    """normal + anchor of each vertex as (high, low), shape (n, 2)."""
    backward: Array
    """normal - anchor of each vertex as (high, low), shape (n, 2)."""
    load_step: Indices
    """Load step that laid the segment below each vertex."""
    anchor: Array
    """Growth of the anchor over the segment below each vertex, shape (n,)."""

    @property
    def load_point(self) -> tuple[float, float]:
        """Normal and tangential coordinate of the load point, exactly as they were given."""
        forward, backward = self.forward[-1].tolist(), self.backward[-1].tolist()
        return fsum(forward + backward) / 2, fsum(forward + [-part for part in backward]) / 2

    @property
    def in_contact(self) -> bool:
        """True unless the bodies are separated."""
        return len(self.forward) > 1

    @property
    def growth(self) -> Array:
        """Growth of both sums over the segment below each vertex; 1 on the axis, shape (n, 2)."""
        growth = np.ones((len(self.forward), 2))
        for column, part in enumerate((self.forward, self.backward)):
            growth[1:, column] = np.diff(part, axis=0).sum(axis=1)
        return growth


@dataclass(frozen=True)
class VertexTree:
    """All vertices of a sequence of polylines, each with its neighbour towards the axis."""

    parent: Indices
    """Index of the vertex below, -1 on the axis."""
    normal: Array
    """Normal coordinate of each vertex, >= 0."""
    growth: Array
    """Growth of both sums over the segment below each vertex, without cancellation."""
    anchor: Array
    """Growth of the anchor over the segment below each vertex, without cancellation."""
    top: Indices
    """Vertex of the load point after each step; -1 in separation."""

    @cached_property
    def span(self) -> Array:
        """Length of the segment below each vertex in the normal coordinate."""
        return np.asarray(self.growth.sum(axis=1) / 2)

    @cached_property
    def slope(self) -> Array:
        """Slope of the anchor on the segment below each vertex, from -1 to 1."""
        return np.asarray(self.anchor / self.span)

    def at_load_points(self, values: Array) -> Array:
        """Return the values of the vertices of the load points, zero in separation."""
        return np.where(self.top >= 0, values[self.top], 0.0)

    def summed(self, step: Array) -> Array:
        """Return for each vertex the sum of the steps from the axis to it."""
        total = np.empty(step.shape)
        kernel.accumulate(self.parent, np.ascontiguousarray(step), total)
        return total


class FrontPath(NamedTuple):
    """Vertices reached by the slip front, in chronological order."""

    step: Indices
    """Step of each visit, shape (k,)."""
    distance: Array
    """Distance from the load point at the start of the step, in both sums and in the anchor, shape
    (k, 3)."""
    normal: Array
    """Normal coordinate of the vertex; -1 on the axis."""
    moved: Array
    """Decrease of both sums and of the anchor of the load point on each step, shape (steps, 3)."""
    load: Array
    """Normal coordinate of the load point after each step."""


class SlipSegments(NamedTuple):
    """Segments of the polyline swept by the slip front."""

    step: Indices
    normal: Array
    """Normal coordinate of the lower end."""
    span: Array
    """Length in the normal coordinate."""
    slip: Array
    """Displacement of the anchors above the front while it sweeps the segment, > 0."""
    upper_gap: Array
    """Distance from the front to the load point at the upper end, in the normal coordinate."""
    lower_gap: Array
    """Distance from the front to the load point at the lower end."""
    full: Flags
    """Slip of all springs, with the front on the axis; `lower_gap` is at the end of the step."""


def apply_steps(start: Polyline, points: LoadPoints) -> tuple[VertexTree, FrontPath, Polyline]:
    """Return the vertices of the polylines after a sequence of straight load steps.

    The path of the slip front and the last polyline come with them. A load point with a normal
    coordinate <= 0 separates the bodies and erases the memory.
    """
    count = points.normal.size
    held = len(start.forward) if start.in_contact else 0
    places, made = _AXIS + held + _VERTICES * count, held + _VERTICES * count
    high, low = np.zeros((places, 2)), np.zeros((places, 2))
    growth, anchor = np.zeros((places, 2)), np.zeros(places)
    number, load_step = np.full(places, -1, dtype=np.intp), np.zeros(places, dtype=np.intp)
    parent, normal = np.empty(made, dtype=np.intp), np.empty(made)
    steps, anchors, moved = np.empty((made, 2)), np.empty(made), np.zeros((count, 3))
    visits = held + _VISITS * count
    front_step, front = np.empty(visits, dtype=np.intp), np.empty((visits, 4))
    if held:
        own = slice(_AXIS, _AXIS + held)
        for part, column in ((high, 0), (low, 1)):
            part[own, 0], part[own, 1] = start.forward[:, column], start.backward[:, column]
        growth[own], load_step[own], number[own] = start.growth, start.load_step, np.arange(held)
        anchor[own] = anchors[:held] = start.anchor
        tree = as_tree(start)
        parent[:held], normal[:held], steps[:held] = tree.parent, tree.normal, tree.growth
    top = _AXIS - 1 + held
    filled = parent, normal, steps, anchors, held, moved, front_step, front
    stack = kernel.PolylineStack(high, low, growth, anchor, number, load_step, top, *filled)
    tops = np.empty(count, dtype=np.intp)
    stack.run(
        np.ascontiguousarray(points.normal),
        np.ascontiguousarray(points.tangential),
        points.continues.view(np.uint8),
        np.ascontiguousarray(points.load_step),
        tops,
        *start.load_point,
    )
    used, visited = stack.made, stack.visited
    tree = VertexTree(parent[:used], normal[:used], steps[:used], anchors[:used], tops)
    path = FrontPath(
        front_step[:visited],
        front[:visited, :3],
        front[:visited, 3],
        moved,
        np.maximum(points.normal, 0.0),
    )
    if tops[-1] < 0:
        return tree, path, separated(float(points.normal[-1]), float(points.tangential[-1]))
    own = slice(_AXIS, stack.top + 1)
    forward, backward = np.array([high[own], low[own]]).T
    return tree, path, Polyline(forward, backward, load_step[own].copy(), anchor[own].copy())


def slip_segments(path: FrontPath) -> SlipSegments:
    """Return the segments between the visits of the slip front, and the slip of all springs."""
    follows = np.append(path.step[1:] == path.step[:-1], False)
    # After the last visit, on the axis, all springs slip until the end of the step.
    visit = indices(follows | (path.normal < 0))
    full, below = ~follows[visit], np.minimum(visit + 1, follows.size - 1)
    step, upper = path.step[visit], path.distance[visit]
    moved = path.moved[step]
    lower = np.where(full[:, None], moved, path.distance[below])
    normal = np.maximum(np.where(full, 0.0, path.normal[below]), 0.0)
    ends = np.array([upper, lower])
    crosswise = _crosswise(ends, moved)
    side, lower_side = _sides(crosswise, moved)
    crossed = indices(side * lower_side < 0)
    if crossed.size:
        # The load point passes through the segment: the friction limit acts in both sums in turn.
        share = side[crossed] / (side[crossed] - lower_side[crossed])
        middle = upper[crossed] + share[:, None] * (lower[crossed] - upper[crossed])
        rest = (lower[crossed] - middle)[:, :2].sum(axis=1) / 2
        step, moved = np.append(step, step[crossed]), np.append(moved, moved[crossed], axis=0)
        upper, lower = np.append(upper, middle, axis=0), np.append(lower, lower[crossed], axis=0)
        normal, full = np.append(normal, normal[crossed]), np.append(full, full[crossed])
        lower[crossed], normal[crossed] = middle, normal[crossed] + rest
        lower_side[crossed] = 0.0
        side, lower_side = np.append(side, 0 * share), np.append(lower_side, -side[crossed])
        ends = np.array([upper, lower])
        crosswise = _crosswise(ends, moved)
    slip, gaps = _slip(ends, crosswise, moved, side + lower_side)
    span = np.where(full, 0.0, (lower - upper)[:, :2].sum(axis=1) / 2)
    end = np.where(full, path.load[step], gaps[1])
    found = SlipSegments(step, normal, span, slip, gaps[0], end, full)
    return SlipSegments._make(row[slip > 0] for row in found)


def _crosswise(ends: Array, moved: Array) -> Array:
    """Distance in the forward sum times the backward movement, less the other product.

    With the normal coordinate and the anchor it is twice the same difference, which keeps its
    digits where the anchor moves far less than the normal coordinate.

    Parameters
    ----------
    ends : distances at both ends of each segment, in both sums and in the anchor, shape (2, k, 3).
    moved : decrease of the same on the whole step, shape (k, 3).
    """
    (near, other, anchor), (forward, backward, further) = ends.transpose(2, 0, 1), moved.T
    by_anchor = anchor * (forward + backward) - (near + other) * further
    small = 2 * np.abs(further) < np.minimum(forward, backward)
    return np.where(small, by_anchor, near * backward - other * forward)


def _sides(crosswise: Array, moved: Array) -> tuple[Array, Array]:
    """Signs at both ends of the sum in which the load point reaches a spring first.

    They are positive in the backward sum and negative in the forward one.
    """
    forward, backward, _ = moved.T
    if not every((forward > 0) & (backward > 0)):
        crosswise = np.where(forward <= 0, 1.0, np.where(backward <= 0, -1.0, crosswise))
    side, lower_side = crosswise
    return side, lower_side


def _slip(ends: Array, crosswise: Array, moved: Array, side: Array) -> tuple[Array, Array]:
    """Slip while the front moves between two ends, and its distance to the load point at both."""
    some = np.arange(side.size)
    bound = np.where(side >= 0, 1, 0)
    reached = ends[:, some, bound]
    behind = (2 * bound - 1) * crosswise
    return reached[1] - reached[0], np.maximum(behind / moved[some, bound], 0.0) / 2


def as_tree(line: Polyline) -> VertexTree:
    """Return one polyline as a tree without branches."""
    count = len(line.forward)
    sums = line.forward + line.backward
    return VertexTree(
        np.arange(count, dtype=np.intp) - 1,
        np.maximum(sums[:, 0] + sums[:, 1], 0.0) / 2,
        line.growth,
        line.anchor,
        np.array([count - 1], dtype=np.intp),
    )


def separated(normal: float, tangential: float) -> Polyline:
    """Return the polyline of bodies in separation: the load point alone, at `normal` <= 0."""
    forward, backward = normal + tangential, normal - tangential
    rounding = tangential - (forward - normal), -tangential - (backward - normal)
    sums = np.array([[[forward, rounding[0]]], [[backward, rounding[1]]]])
    return Polyline(sums[0], sums[1], np.zeros(1, dtype=np.intp), np.zeros(1))


def stacked(span: Array, slope: Array, load_step: Indices) -> Polyline:
    """Return the polyline from the axis whose segments have the given lengths and slopes."""
    growth = np.stack([span * (1 + slope), span * (1 - slope)], axis=1)
    rows = np.zeros((2, len(growth) + 1, 2))
    for column, steps in enumerate(growth.T):
        high = low = 0.0
        for i, step in enumerate(steps.tolist(), start=1):
            # Knuth's two-sum keeps the rounding error.
            total = high + step
            part = total - high
            low += (high - (total - part)) + (step - part)
            high = total
            rows[column, i] = high, low
    return Polyline(rows[0], rows[1], np.append(0, load_step), np.append(0.0, span * slope))
