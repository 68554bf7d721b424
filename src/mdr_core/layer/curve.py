"""Force over depth of one profile on a layer, for fits of many points."""

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Final, Self

import numpy as np
from numpy.polynomial.chebyshev import chebpts1, chebvander

from mdr_core.elementwise import full, number
from mdr_core.errors import InputError
from mdr_core.inversion import invert
from mdr_core.layer.equation import largest_coordinate, states
from mdr_core.layer.solver import solve
from mdr_core.materials import Layer, Material
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# Polynomials over the contact radius between two breaks of the profile, and one more for each a/h.
_COUNT, _MORE = 20, 3
# Depths from which a search starts: two steps reach rounding error.
_STARTS: Final = 500


@dataclass(frozen=True, eq=False)
class DepthCurve:
    """Force and stiffness over E* as functions of the depth.

    Depth, force, stiffness and dd/ds over those of a half-space with the same contact coordinate s
    are polynomials in z between breaks, s = low + (high - low) z^2.
    """

    profile: Profile
    layer: Layer
    end: float
    """Largest contact coordinate."""

    @classmethod
    def up_to(cls, profile: Profile, layer: Layer, depth: float) -> Self:
        """Return the curve up to a depth, or to the largest contact that the layer allows.

        Parameters: the profile, the layer, and the depth [length].
        """
        if profile.is_flat_punch:
            return cls(profile, layer, np.inf)
        with suppress(InputError):
            contact = solve(profile, Material(1.0, layer=layer), indentation_depth=depth)
            return cls(profile, layer, float(contact.coordinate))
        return cls(profile, layer, largest_coordinate(profile, layer))

    @cached_property
    def _edges(self) -> Array:
        """Contact coordinates of the breaks, from 0 to the largest one."""
        breaks = self.profile.coordinate_from_radius(np.array(self.profile.breaks, dtype=float))
        return np.unique([0.0, *breaks[(breaks > 0) & (breaks < self.end)], self.end])

    @cached_property
    def _ratios(self) -> Array:
        """Chebyshev coefficients, shape (modes, quantities, intervals)."""
        part = self.profile.contact_radius(number(self.end)) / self.layer.thickness
        nodes, edges = chebpts1(_COUNT + int(_MORE * part)), self._edges
        s = edges[:-1] + np.diff(edges) * np.square((nodes[:, None] + 1) / 2)
        found = states(self.profile, self.layer, s.ravel())
        own = found.depth, found.force, found.stiffness, found.depth_slope
        ratios = [part.reshape(s.shape) / of for part, of in zip(own, self._plain(s), strict=True)]
        to_modes = np.linalg.inv(chebvander(nodes, nodes.size - 1))
        return np.asarray(np.einsum("ij,pjk->ipk", to_modes, np.array(ratios)))

    def _plain(self, s: Array) -> tuple[Array, ...]:
        """Quantities of a half-space over E*."""
        profile = self.profile
        arm = 2 * profile.contact_radius(s)
        return profile.depth(s), profile.reduced_force(s), arm, profile.depth_slope(s)

    def _at(self, s: Array) -> tuple[Array, ...]:
        edges = self._edges
        place = np.clip(np.searchsorted(edges, s) - 1, 0, edges.size - 2)
        z = np.sqrt(np.clip((s - edges[place]) / np.diff(edges)[place], 0.0, 1.0))
        modes, ratios = chebvander(2 * z - 1, len(self._ratios) - 1), np.empty((4, s.size))
        for k in np.unique(place):
            ratios[:, place == k] = self._ratios[..., k].T @ modes[place == k].T
        return tuple(ratio * part for ratio, part in zip(ratios, self._plain(s), strict=True))

    @cached_property
    def _coarse(self) -> tuple[Array, Array]:
        """Depths and contact coordinates between which a search starts."""
        s = self.end * np.linspace(0.0, 1.0, _STARTS) ** 2
        return np.append(0.0, self._at(s[1:])[0]), s

    @property
    def error(self) -> float:
        """Estimated relative error by the interpolation [1]."""
        if self.profile.is_flat_punch:
            return 0.0
        return float(np.abs(self._ratios[-2:]).max())

    @cached_property
    def deepest(self) -> float:
        """Largest depth [length], infinite under a flat punch."""
        if self.profile.is_flat_punch:
            return np.inf
        return float(self._at(np.atleast_1d(self.end))[0][0])

    def __call__(self, depth: Array) -> tuple[Array, Array]:
        """Return F_N/E* [length^2] and its slope [length] at depths from 0 to the deepest."""

        def sloped(s: Array) -> tuple[Array, Array]:
            value, _, _, slope = self._at(s)
            return value, s * slope / value

        if self.profile.is_flat_punch:
            stiffness = states(self.profile, self.layer, np.ones(1)).stiffness[0]
            return stiffness * depth, full(stiffness, depth)
        goal = np.minimum(depth.ravel(), self.deepest)
        start = np.interp(goal, *self._coarse)
        ends = full(0.0, goal), full(self.end, goal)
        s = invert(sloped, goal, np.where(goal > 0, start, self.end), *ends, "layer")
        _, force, stiffness, _ = self._at(s)
        return force.reshape(depth.shape), stiffness.reshape(depth.shape)
