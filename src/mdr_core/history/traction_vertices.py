"""Force, displacement and stored energy of the tangential foundation, from its polyline.

Along the polyline the anchor grows by k dw, where w is the depth at which a spring comes into
contact. With I(w) = F_N/E* of the contact of depth w,

    F_x/(mu E*) = sum k_i (I_i - I_i-1),    I = 2 int a dw,

for every profile. Where forces are prescribed the normal coordinate is I itself, and the anchors
follow from the same slopes: u_x G*/(mu E*) = sum k_i (w_i - w_i-1). Source: notes, §10.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core.cached import cached_property
from mdr_core.elementwise import indices
from mdr_core.equivalent_1d import stick_edge
from mdr_core.history.slip_memory import VertexTree
from mdr_core.interval_moments import IntervalMoments, interval_moments
from mdr_core.typing import Array

# Up to this part of its normal coordinate a segment is so short that a difference over it would
# lose more than three of sixteen digits.
_SHORT: Final = 2e-3


@dataclass(frozen=True)
class TractionVertices:
    """Vertices of the polyline, with the contact whose edge each of them is."""

    moments: IntervalMoments
    tree: VertexTree
    coordinate: Array
    """Contact coordinate of each vertex."""

    @cached_property
    def radius(self) -> Array:
        """Contact radius of each vertex [length]."""
        return self.moments.profile.contact_radius(self.coordinate)

    @cached_property
    def depth(self) -> Array:
        """Depth w of each vertex [length]."""
        moments = self.moments
        return moments.conjugate(self.coordinate) if moments.over_forces else self.tree.normal

    @cached_property
    def depth_step(self) -> Array:
        """Depth of each vertex above that of its parent [length]."""
        return self._conjugate_step if self.moments.over_forces else self.tree.span

    @cached_property
    def force_step(self) -> Array:
        """Reduced force I of each vertex above that of its parent [length^2]."""
        return self.tree.span if self.moments.over_forces else self._conjugate_step

    @cached_property
    def shear(self) -> Array:
        """F_x/(mu E*) of each vertex as the load point [length^2]."""
        return self.tree.summed(self.tree.slope * self.force_step)

    @cached_property
    def anchor(self) -> Array:
        """Anchor of each vertex above that of the axis, a depth [length]."""
        return self.tree.summed(self.tree.slope * self.depth_step)

    @cached_property
    def square(self) -> Array:
        """int (anchor of the vertex - anchor)^2 dx over 0 < x < a of each vertex [length^3].

        With the mean m = F_x/(2 mu E* a) it is a m^2 + V, by the theorem of parallel axes. The
        variance V does not depend on the load point and grows along the polyline by squares:
        the energy of every traction is a sum of squares.
        """
        tree, radius = self.tree, self.radius
        below, own = np.maximum(tree.parent, 0), np.arange(tree.parent.size)
        ends = self.coordinate[np.array([below, own])]
        some = indices((tree.parent >= 0) & (self.depth_step > 0))
        moments = interval_moments(self.moments.profile, over_forces=False)
        given = self.depth[below], np.maximum(self.depth_step, 0.0), ends
        # The measure of the moments is 2 dx.
        weights = np.zeros((3, tree.normal.size))
        weights[:, some] = moments.over(*(each[..., some] for each in given)).weights / 2
        low, middle, high = weights
        width = low + middle + high
        inner, outer = radius[below], np.where(radius > 0, radius, 1.0)
        some_width, some_inner = np.where(width > 0, width, 1.0), np.where(inner > 0, inner, 1.0)
        # Anchors of a segment: mean above its lower end in parts of their growth, and variance.
        mean, spread = (high + middle / 2) / some_width, low * high - np.square(middle) / 4
        growth = tree.slope * self.depth_step
        apart = growth * mean + np.where(inner > 0, self.shear[below] / (2 * some_inner), 0.0)
        added = np.square(growth) * spread / some_width + inner * width / outer * np.square(apart)
        return np.asarray(np.square(self.shear) / (4 * outer) + tree.summed(added))

    @cached_property
    def _conjugate_step(self) -> Array:
        """Conjugate of each vertex above that of its parent."""
        moments, tree = self.moments, self.tree
        conjugate = self.depth if moments.over_forces else moments.conjugate(self.coordinate)
        if moments.profile.has_no_partial_slip:
            # Depth and force are proportional.
            some = np.where(tree.normal > 0, tree.normal, 1.0)
            return np.asarray(conjugate / some * tree.span)
        step = conjugate - conjugate[tree.parent]
        short = indices(tree.span < _SHORT * tree.normal)
        if short.size:
            lower = tree.normal[tree.parent[short]]
            step[short] = moments.conjugate_step(lower, tree.span[short])
        return np.asarray(step)


def widths(moments: IntervalMoments, tree: VertexTree, coordinate: Array) -> Array:
    """Return the widths of a polyline's segments in the contact coordinate, shape (n - 1,).

    `coordinate` has the contact coordinates of its vertices, shape (n,).
    """
    width = coordinate[1:] - coordinate[:-1]
    short = indices(tree.span[1:] < _SHORT * tree.normal[1:])
    if short.size:
        upper, span = tree.normal[1:][short], tree.span[1:][short]
        edges = coordinate[1:][short], span / upper, tree.normal[short] / upper
        _, width[short] = stick_edge(moments.profile, *edges, of_force=moments.over_forces)
    return width
