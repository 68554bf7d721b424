"""From the memory's polyline to what the foundation carries.

Along the polyline the anchor grows by k dw, where w is the depth at which a spring touches. With
I(w) = F_N/E* of the contact of depth w, and En(w) = int_0^w I dw,

    F_x/(mu E*) = sum k (I_i - I_i-1),    I = 2 int a dw,

for every profile: the tangential force needs the shape of the bodies at the vertices only. Where
forces are controlled the levels are I itself, and the anchors follow from the slopes the other
way: the slope of F_x/mu in F_N is the same k. Source: notes, §10.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core import annulus
from mdr_core.foundation import coordinate_from_depth, coordinate_from_force
from mdr_core.history.memory import Tree, total
from mdr_core.lazy import cached_property
from mdr_core.profiles import Profile
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Indices

# Up to this part of its level a span is so short that a difference over it costs more than three
# of sixteen digits: steps over it are integrals.
_SHORT: Final = 2e-3
# Of a lens, a second difference, as much is lost up to here.
NARROW: Final = 0.05
# Over so narrow a span all is smooth, away from breaks: this rule reaches rounding.
_POINTS: Final = 10


@dataclass(frozen=True)
class Branches:
    """The vertices of a walk, with the contacts whose edge lies at each."""

    profile: Profile
    tree: Tree
    by_force: bool
    """Levels are I = F_N/E* [length^2], not depths."""

    @cached_property
    def coordinate(self) -> Array:
        """Contact coordinate of each vertex."""
        return coordinate_from_level(self.profile, self.tree.level, by_force=self.by_force)

    @cached_property
    def depth(self) -> Array:
        """w of each vertex [length]."""
        return self.profile.depth(self.coordinate) if self.by_force else self.tree.level

    @cached_property
    def force(self) -> Array:
        """I(w) of each vertex [length^2]."""
        return self.tree.level if self.by_force else self.profile.reduced_force(self.coordinate)

    @cached_property
    def depth_step(self) -> Array:
        """w above the parent's [length]."""
        return self._other_step(self.depth) if self.by_force else self.tree.span

    @cached_property
    def force_step(self) -> Array:
        """I above the parent's [length^2]."""
        return self.tree.span if self.by_force else self._other_step(self.force)

    @cached_property
    def shear(self) -> Array:
        """F_x/(mu E*) of each vertex as a load point [length^2]."""
        return total(self.tree, self.force_step)

    @cached_property
    def anchor(self) -> Array:
        """Anchor of each vertex above that of the axis [length]."""
        return total(self.tree, self.depth_step)

    @cached_property
    def square(self) -> Array:
        """int_0^x (anchor of the vertex - anchor)^2 dx up to each vertex [length^3].

        It grows by 2 M dv + k^2 int (I - I_p) dw over a piece, M = F_x/(2 mu E*) at its lower end.
        """
        slope, below = self.tree.slope, self.shear[self.tree.parent]
        return total(self.tree, below * self.depth_step + slope * self._lens)

    @cached_property
    def _lens(self) -> Array:
        """int (I - I_parent) dw over each piece [length^3]."""
        below = self.tree.parent
        energy, depth_step = self.profile.reduced_energy(self.coordinate), self.depth_step
        lens = energy - energy[below] - self.force[below] * depth_step
        narrow = np.flatnonzero((depth_step > 0) & (depth_step < NARROW * self.depth))
        if narrow.size:
            lens[narrow] = lens_integral(self.profile, self.depth[narrow], depth_step[narrow])
        return lens

    @cached_property
    def _narrow(self) -> Indices:
        """Vertices so near their parent that a difference would lose digits."""
        return np.flatnonzero(self.tree.span < _SHORT * self.tree.level)

    @property
    def width(self) -> Array:
        """Contact coordinate of each vertex above its parent's, with its own digits."""
        width = self.coordinate - self.coordinate[self.tree.parent]
        if self._narrow.size:
            width[self._narrow] = self._narrow_edges[1]
        return width

    @cached_property
    def _narrow_edges(self) -> tuple[Array, Array]:
        """Contact coordinate of the parents of narrow pieces, and its distance."""
        tree, narrow = self.tree, self._narrow
        top, low = tree.level[narrow], tree.level[tree.parent[narrow]]
        shares = tree.span[narrow] / top, low / top
        at = self.coordinate[narrow]
        return ends_below(self.profile, at, *shares, by_force=self.by_force)

    def _other_step(self, values: Array) -> Array:
        """Step of what is not the level from each vertex' parent."""
        profile, tree, narrow = self.profile, self.tree, self._narrow
        if profile.slips_at_once:
            # Depth and force are proportional.
            return np.asarray(values / np.where(tree.level > 0, tree.level, 1.0) * tree.span)
        step = values - values[tree.parent]
        if narrow.size:
            between = annulus.depth_step if self.by_force else annulus.force_step
            edge, width = self._narrow_edges
            step[narrow] = between(profile, self.coordinate[narrow], width, edge)
        return step


def coordinate_from_level(profile: Profile, level: Array, *, by_force: bool) -> Array:
    """Contact coordinate of a level: a depth, or a reduced force."""
    return (coordinate_from_force if by_force else coordinate_from_depth)(profile, level)


def ends_below(
    profile: Profile, coordinate: Array, ratio: Array, rest: Array, *, by_force: bool
) -> tuple[Array, Array]:
    """Coordinate `ratio` = 1 - `rest` of the level below an edge, and its distance."""
    find = annulus.stick_from_force if by_force else annulus.stick_from_depth
    return find(profile, coordinate, ratio, rest)


def radius_at_depth(profile: Profile, depth: Array) -> Array:
    """x(w), the inverse of g [length]."""
    return profile.contact_radius(coordinate_from_depth(profile, depth))


def radius_at_force(profile: Profile, reduced_force: Array) -> Array:
    """Contact radius under a force [length]."""
    return profile.contact_radius(coordinate_from_force(profile, reduced_force))


def radius_slope_at_depth(profile: Profile, depth: Array) -> Array:
    """dx/dw = 1/g' [1]."""
    s = coordinate_from_depth(profile, depth)
    return profile.radius_slope(s) / profile.depth_slope(s)


def lens_integral(profile: Profile, depth: Array, span: Array) -> Array:
    """int (I(w) - I(depth - span)) dw = int 2 x (depth - w) dw over a narrow span [length^3]."""
    breaks = breaks_below(profile, float(depth.max()), by_force=False)
    return integral(
        lambda left, w: 2 * left * radius_at_depth(profile, w), depth - span, span, breaks
    )


def integral(
    function: Callable[[Array, Array], Array], low: Array, span: Array, breaks: Array
) -> Array:
    """int function(high - w, w) dw over narrow spans [low, high], cut at the first break inside."""
    if not breaks.size:
        return span * mean(lambda t, w: function(span[..., None] * (1 - t), w), low, span)
    below = np.clip(next_break(breaks, low) - low, 0.0, span)
    beyond = span - below

    def until(t: Array, w: Array) -> Array:
        return function(span[..., None] - below[..., None] * t, w)

    def after(t: Array, w: Array) -> Array:
        return function(beyond[..., None] * (1 - t), w)

    first = below * mean(until, low, below, last_break(breaks, low))
    return first + beyond * mean(after, low + below, beyond, low + below)


def breaks_below(profile: Profile, level: float, *, by_force: bool) -> Array:
    """Depths, or forces, of the profile's breaks inside the contact of the given level."""
    breaks = profile.coordinate_breaks
    breaks = breaks[breaks < coordinate_from_level(profile, np.array([level]), by_force=by_force)]
    return profile.reduced_force(breaks) if by_force else profile.depth(breaks)


def next_break(breaks: Array, level: Array) -> Array:
    """The first of some ascending breaks above each level, infinity if there is none."""
    return np.append(breaks, np.inf)[np.searchsorted(breaks, level, side="right")]


def last_break(breaks: Array, level: Array) -> Array:
    """The last of some ascending breaks at or below each level, zero if there is none."""
    return np.append(0.0, breaks)[np.searchsorted(breaks, level, side="right")]


def mean(
    function: Callable[[Array, Array], Array], low: Array, span: Array, base: Array | None = None
) -> Array:
    """Mean of function(t, low + t span) over 0 < t < 1; nodes go along the last axis.

    `base` <= low is a break, behind which functions are smooth in the root of the distance.
    """
    nodes, weights = gauss_legendre(_POINTS)
    t, weights = (1 + nodes) / 2, weights / 2
    if base is None:
        values = function(t, low[..., None] + span[..., None] * t)
        return np.asarray((values * weights).sum(axis=-1))
    start = np.sqrt(np.maximum(low - base, 0.0))
    sum_of_roots = start + np.sqrt(np.maximum(low - base, 0.0) + span)
    # Of an empty span any value is the mean.
    step = span / np.where(sum_of_roots > 0, sum_of_roots, 1.0)
    climbed = step[..., None] * t
    root = start[..., None] + climbed
    share = climbed * (root + start[..., None]) / np.where(span > 0, span, 1.0)[..., None]
    density = 2 * root * (step / np.where(span > 0, span, 1.0))[..., None]
    values = function(share, base[..., None] + root * root)
    return np.asarray((values * density * weights).sum(axis=-1))
