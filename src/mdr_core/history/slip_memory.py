"""Slip memory of the tangential foundation, stored as a polyline.

Each spring has a normal coordinate n, which increases from the axis to the contact edge, and an
anchor, the tangential coordinate at which its tangential force is zero. The points (n, anchor)
form a polyline from the axis to the load point. Friction limits its slope to +-1, so both

    forward = n + anchor,    backward = n - anchor

increase along the polyline and never exceed their values at the load point. From the vertices
V_0 ... V_m a straight load step to P leaves

    V_0 ... V_m, P       if no vertex exceeds P in either sum: all springs stick,
    V_0 ... V_k, C, P    otherwise; V_k is the last vertex that does not, and the corner C the place
                         above it where the polyline exceeds P.

`slip_kernel.PolylineStack` is this recurrence.

A corner takes its sums from load points, so that errors do not accumulate. Normal coordinates are
depths where displacements are prescribed, and reduced normal forces where tangential forces are
prescribed. Source: notes, §10.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.history import slip_kernel as kernel
from mdr_core.history.slip_layout import COLUMNS, NORMAL, SLOPE
from mdr_core.typing import Array, Flags, Indices

# A step adds at most three vertices: one on the axis, a corner and the load point.
_VERTICES: Final = 3


@dataclass(frozen=True)
class VertexTree:
    """All vertices of a sequence of polylines, each with its neighbour towards the axis."""

    parent: Indices
    """Index of the vertex below, -1 on the axis; shape (m,)."""
    vertices: Array
    """Normal coordinate, and slope of the anchor below each vertex, shape (2, m)."""
    top: Indices
    """Vertex of the load point after each step, -1 in separation; shape (n,)."""
    start: tuple[Indices, Array]
    """Vertex and coordinates of the load point before the first step, or before each of them."""
    path: Array
    """Normal and tangential coordinate of each load point, shape (2, n)."""

    @property
    def normal(self) -> Array:
        """Normal coordinate of each vertex, >= 0."""
        return self.vertices[0]

    @property
    def slope(self) -> Array:
        """Slope of the anchor on the segment below each vertex, from -1 to 1."""
        return self.vertices[1]

    @cached_property
    def span(self) -> Array:
        """Length of the segment below each vertex (normal coordinate); arbitrary on the axis."""
        return np.maximum(self.normal - self.normal[self.parent], 0.0)

    def at_load_points(self, values: Array) -> Array:
        """Return the values of the vertices of the load points, zero in separation."""
        return np.append(values, 0.0)[self.top]

    def summed(self, step: Array) -> Array:
        """Return for each vertex the sum of the steps from the axis to it."""
        total = np.empty(step.shape)
        kernel.accumulate(self.parent, step, total)
        return total


class Polylines(NamedTuple):
    """Polylines of one contact or of many, each from the axis to the load point."""

    vertices: Array
    """Vertices of all polylines, one after another, with the columns of `slip_layout`."""
    ends: Indices
    """End of each polyline among the vertices, shape (n,)."""
    load_points: Array
    """Normal and tangential coordinate of each load point, exact copies of the input, shape (2, n).

    The normal coordinate is <= 0 in separation.
    """

    @property
    def sizes(self) -> Indices:
        """Number of vertices of each polyline, 0 in separation."""
        sizes = self.ends.copy()
        sizes[1:] -= self.ends[:-1]
        return sizes

    @property
    def owners(self) -> Indices:
        """Index of the contact of each vertex."""
        return np.repeat(np.arange(self.ends.size), self.sizes)

    def at(self, chosen: Indices) -> "Polylines":
        """Return the chosen polylines."""
        sizes = self.sizes[chosen]
        ends = np.cumsum(sizes)
        rows = np.arange(sizes.sum()) + np.repeat(self.ends[chosen] - ends, sizes)
        return Polylines(read_only(self.vertices[rows]), ends, self.load_points[:, chosen])

    def tree(self, load_points: Array) -> VertexTree:
        """Return all polylines as a tree, with the step of each contact to a load point."""
        sizes, in_contact = self.sizes, self.sizes > 0
        parent = np.arange(-1, len(self.vertices) - 1)
        parent[(self.ends - sizes)[in_contact]] = -1
        top, rows = np.where(in_contact, self.ends - 1, -1), self.vertices[:, NORMAL:].T
        return VertexTree(parent, rows, top, (top, self.load_points), load_points)


def follow(start: Polylines, path: Array, continues: Flags) -> tuple[VertexTree, Polylines]:
    """Return the vertices of the polylines after straight steps, and the last polyline.

    A load point with a normal coordinate <= 0 separates the bodies and erases the memory.

    Parameters
    ----------
    start : polyline before the first step.
    path : normal and tangential coordinate of the load points, shape (2, n).
    continues : True for steps that continue the straight line of the step before, shape (n,).
    """
    held, path = start.tree(start.load_points), np.ascontiguousarray(path)
    made, count = held.parent.size, continues.size
    most = made + _VERTICES * count
    number, parent = np.arange(most), np.empty(most, dtype=np.intp)
    vertices, top = np.empty((2, most)), np.empty(count, dtype=np.intp)
    parent[:made], vertices[:, :made] = held.parent, held.vertices
    rows, stack = _stacked(start, count)
    made = stack.run(path, continues, number, parent, vertices, top)
    line = _single(rows[: stack.top + 1].copy(), path[:, -1])
    return VertexTree(parent[:made], vertices[:, :made], top, held.start, path), line


def moved(line: Polylines, load_point: tuple[float, float]) -> tuple[Polylines, int]:
    """Return a polyline after one straight step, and the number of unchanged vertices."""
    rows, stack = _stacked(line, 1)
    stack.move(*load_point, continues=False)
    return _single(rows[: stack.top + 1].copy(), load_point), stack.changed


def moved_each(lines: Polylines, load_points: Array) -> Polylines:
    """Return many polylines after a straight step of each to a load point, shape (2, n)."""
    vertices, ends, before = lines
    path = np.vstack([before, load_points])
    rows = np.empty((int(lines.sizes.max(initial=0)) + _VERTICES, COLUMNS))
    moved, moved_ends = np.empty((len(vertices) + _VERTICES * ends.size, COLUMNS)), ends.copy()
    stack = kernel.PolylineStack(rows, -1, 0.0, 0.0)
    made = stack.run_each(ends, path, vertices, moved, moved_ends)
    return Polylines(read_only(moved[:made]), moved_ends, load_points)


def joined(lines: Sequence[Polylines]) -> Polylines:
    """Return the polylines of several sets of contacts as one set."""
    vertices = np.concatenate([each.vertices for each in lines])
    ends = np.cumsum(np.concatenate([each.sizes for each in lines]))
    return Polylines(read_only(vertices), ends, np.hstack([each.load_points for each in lines]))


def _stacked(line: Polylines, steps: int) -> tuple[Array, kernel.PolylineStack]:
    """Return a stack that starts with a polyline, and its rows, with room for some steps."""
    size = len(line.vertices)
    rows = np.empty((size + _VERTICES * steps, COLUMNS))
    rows[:size] = line.vertices
    return rows, kernel.PolylineStack(rows, size - 1, *line.load_points[:, 0].tolist())


def _single(vertices: Array, load_point: ArrayLike) -> Polylines:
    """Return the polyline of a single contact."""
    ends = np.array([len(vertices)])
    return Polylines(read_only(vertices), ends, np.array(load_point).reshape(2, 1))


def separated(load_points: Array) -> Polylines:
    """Return the polylines of bodies in separation, with normal coordinates <= 0."""
    none = np.zeros(load_points.shape[1], dtype=np.intp)
    return Polylines(read_only(np.zeros((0, COLUMNS))), none, load_points)


def stacked(span: Array, slope: Array) -> Polylines:
    """Return the polyline from the axis whose segments have the given lengths and slopes."""
    vertices = np.zeros((span.size + 1, COLUMNS))
    growth = span * (1 + slope), span * (1 - slope), span
    vertices[1:, : NORMAL + 1] = np.cumsum(growth, axis=1).T
    vertices[1:, SLOPE] = slope
    forward, backward, normal = vertices[-1, : NORMAL + 1]
    return _single(vertices, (normal, (forward - backward) / 2))


def through(sums: Array, load_point: Array) -> Polylines:
    """Return the polyline through vertices to a load point, without a check.

    Parameters
    ----------
    sums : normal + anchor and normal - anchor, from the axis, shape (n, 2).
    load_point : normal and tangential coordinate of the load point, shape (2,).
    """
    vertices, (normal, tangential) = np.zeros((len(sums) + 1, COLUMNS)), load_point
    vertices[:, :NORMAL] = np.vstack([sums, [normal + tangential, normal - tangential]])
    vertices[:, NORMAL] = vertices[:, :NORMAL].sum(axis=1) / 2
    vertices[-1, NORMAL] = normal
    rise, fall = np.diff(vertices[:, :NORMAL], axis=0).T
    with np.errstate(invalid="ignore"):
        vertices[1:, SLOPE] = np.clip((rise - fall) / (rise + fall), -1.0, 1.0)
    return _single(vertices, load_point)


def read_only(values: Array) -> Array:
    """Return the array, marked read-only."""
    values.flags.writeable = False
    return values
