"""Traction of the tangential foundation, from the polylines of its slip memory.

Along the polyline the anchor grows by k dw, where w is the depth at which a spring comes into
contact. With I(w) = F_N/E* of the contact of depth w,

    F_x/(mu E*) = sum k_i (I_i - I_i-1),    I = 2 int a dw,

for every profile. Where forces are prescribed the normal coordinate is I itself, and the anchors
follow from the same slopes: u_x G*/(mu E*) = sum k_i (w_i - w_i-1). Source: notes, §10.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from mdr_core.doubles import ROUNDING
from mdr_core.history.friction_work import dissipation
from mdr_core.history.slip_memory import VertexTree
from mdr_core.interval_moments import IntervalMoments, interval_moments
from mdr_core.typing import Array, Flags, Indices

# Slip regimes, in the order of their codes.
REGIMES: Final = ("no_contact", "stick", "partial_slip", "full_slip")
# If a segment is shorter than this part of its normal coordinate, a difference of conjugates loses
# more than three of sixteen digits.
SHORT: Final = 2e-3


@dataclass(frozen=True)
class TractionVertices:
    """Vertices of the polylines, each with the contact that has its edge there."""

    moments: IntervalMoments
    tree: VertexTree

    @cached_property
    def coordinate(self) -> Array:
        """Contact coordinate of each vertex."""
        return self.moments.contact_coordinate(self.tree.normal)

    @cached_property
    def conjugate(self) -> Array:
        """Reduced force of each vertex, or its depth where forces are prescribed."""
        return self.moments.conjugate(self.tree.normal, self.coordinate)

    @cached_property
    def conjugate_step(self) -> Array:
        """Growth of the conjugate from the parent of each vertex to the vertex."""
        tree, conjugate = self.tree, self.conjugate
        step = np.maximum(conjugate - conjugate[tree.parent], 0.0)
        short = np.flatnonzero(tree.span < SHORT * tree.normal)
        if short.size:
            ends = self.coordinate[tree.parent[short]], self.coordinate[short]
            step[short] = tree.span[short] * self.moments.part(short).mean_slope(*ends)
        return step

    @cached_property
    def shear(self) -> Array:
        """F_x/(mu E*) of each vertex as the load point [length^2]."""
        return self._summed(conjugate=not self.moments.over_forces)

    @cached_property
    def anchor(self) -> Array:
        """Growth of the anchor from the axis to each vertex [length]."""
        return self._summed(conjugate=self.moments.over_forces)

    def _summed(self, *, conjugate: bool) -> Array:
        """Sum of the slopes times the steps in the normal coordinate, or in its conjugate."""
        tree = self.tree
        return tree.summed(tree.slope * (self.conjugate_step if conjugate else tree.span))

    @property
    def dissipation(self) -> Array:
        """G* D/(mu E*)^2 of every step [length^3], >= 0."""
        return dissipation(self.moments, self.tree)

    @cached_property
    def square(self) -> Array:
        """int (anchor of the vertex - anchor)^2 dx over 0 < x < a of each vertex [length^3].

        With the mean m = F_x/(2 mu E* a) it is a m^2 + V: see `variance_growth`.
        """
        tree, moments, coordinate = self.tree, self.moments, self.coordinate
        depth, step = tree.normal, tree.span
        if moments.over_forces:
            depth, step = self.conjugate, self.conjugate_step
        upper = np.flatnonzero(tree.parent >= 0)
        lower, grown = tree.parent[upper], np.zeros(tree.parent.shape)
        ends = np.array([coordinate[lower], coordinate[upper]])
        over_depths = interval_moments(moments.profile, over_forces=False).part(upper)
        growth = tree.slope[upper] * step[upper]
        segments = depth[lower], step[upper], growth, ends, self.shear[lower]
        grown[upper] = variance_growth(over_depths, *segments)
        radius = moments.profile.contact_radius(coordinate)
        shear = np.square(self.shear) / np.where(radius > 0, 4 * radius, 1.0)
        return np.asarray(shear + tree.summed(grown))


def variance_growth(
    moments: IntervalMoments, low: Array, span: Array, growth: Array, ends: Array, shear: Array
) -> Array:
    """Return the growth of V = int (anchor - mean)^2 dx over 0 < x < a along segments [length^3].

    By the parallel axis theorem the integral about another anchor is larger by a m^2, where m is
    the distance of that anchor from the mean. V does not depend on the load point. It grows along
    the polyline by squares, so that the energy of every traction is a sum of squares.

    Parameters
    ----------
    moments : moments over intervals of depth.
    low, span, growth : lower end, length in depth, and growth of the anchor, shape (n,).
    ends : contact coordinates of both ends, shape (2, n).
    shear : F_x/(mu E*) of the lower end as the load point.
    """
    # The measure of the moments is 2 dx.
    first, middle, last = moments.over(low, span, ends).weights / 2
    width = first + middle + last
    inner, outer = moments.profile.contact_radius(ends)
    outer = np.where(outer > 0, outer, 1.0)
    some_width, some_inner = np.where(width > 0, width, 1.0), np.where(inner > 0, inner, 1.0)
    # Anchors of a segment: mean above the lower end, relative to the growth of the anchor, and
    # variance.
    mean, spread = (last + middle / 2) / some_width, first * last - np.square(middle) / 4
    apart = growth * mean + np.where(inner > 0, shear / (2 * some_inner), 0.0)
    return np.asarray(
        np.square(growth) * spread / some_width + inner * width / outer * np.square(apart)
    )


def regime_codes(vertices: TractionVertices) -> Indices:
    """Return the index in `REGIMES` for the springs at their limit: none, the outermost, or all."""
    tree, slips = vertices.tree, 1 if vertices.moments.profile.is_flat_punch else 2
    at_limit = np.abs(tree.slope) == 1
    full = at_limit & (tree.parent[tree.parent] < 0)
    codes = np.where(full, 3, np.where(at_limit, slips, 1))
    return tree.at_load_points(codes).astype(np.intp)


def decides_regime(codes: Indices, normal: Array, deeper: Array, further: Array) -> Flags:
    """Return True for steps after which the code is the slip regime; others keep the previous one.

    Springs that reach their friction limit without slip do not change the regime, for example
    while both forces grow in the ratio mu.

    Parameters
    ----------
    codes : result of `regime_codes`.
    normal : normal coordinate after each step.
    deeper, further : growth of the normal and of the tangential coordinate.
    """
    rounding = np.where(deeper > 0, ROUNDING * normal, 0.0)
    return (codes < 2) | (np.abs(further) - deeper > rounding)
