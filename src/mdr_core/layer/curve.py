"""Force over depth of one profile on a layer, for fits of many points."""

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final, Self

import numpy as np
from numpy.polynomial.chebyshev import chebpts1, chebvander
from scipy.interpolate import CubicHermiteSpline

from mdr_core.elementwise import number
from mdr_core.errors import InputError
from mdr_core.layer.equation import largest_coordinate, states
from mdr_core.layer.solver import solve
from mdr_core.materials import Layer, Material
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# Polynomials over the contact radius between two breaks of the profile, and one more for each a/h.
_COUNT, _MORE = 20, 3
# Knots of the spline between two breaks, an odd number: every second one holds both ends.
_KNOTS: Final = 801
# Error of the spline over its difference from one with half the knots: 1/16, with a margin.
_PART: Final = 0.1
# Smallest z: its force is below rounding error, but its slope is still a quotient of two numbers.
_LEAST: Final = 1e-8


@dataclass(frozen=True, eq=False)
class DepthCurve:
    """Force and stiffness over E* as functions of the depth.

    The ratios of depth, force and stiffness to a half-space with the contact coordinate s are
    polynomials in z between breaks, s = low + (high - low) z^2. A spline gives the force in terms
    of the z of the depth, defined in the same way.
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
        with suppress(InputError):
            contact = solve(profile, Material(1.0, layer=layer), indentation_depth=depth)
            return cls(profile, layer, float(contact.coordinate))
        return cls(profile, layer, largest_coordinate(profile, layer))

    @cached_property
    def _edges(self) -> Array:
        """Contact coordinates of the breaks, from 0 to the largest one."""
        if self.profile.is_flat_punch:
            return np.array([0.0, self.end])
        breaks = self.profile.coordinate_from_radius(np.array(self.profile.breaks, dtype=float))
        return np.unique([0.0, *breaks[(breaks > 0) & (breaks < self.end)], self.end])

    @cached_property
    def _ratios(self) -> Array:
        """Chebyshev coefficients, shape (modes, quantities, intervals)."""
        part = self.profile.contact_radius(number(self.end)) / self.layer.thickness
        nodes, edges = chebpts1(_COUNT + int(_MORE * part)), self._edges
        s = edges[:-1] + np.diff(edges) * np.square((nodes[:, None] + 1) / 2)
        found = states(self.profile, self.layer, s.ravel())
        own = found.depth, found.force, found.stiffness
        # Next to the tip a quantity may underflow; the layer then acts as a half-space.
        with np.errstate(divide="ignore", invalid="ignore"):
            ratios = [
                np.where(of > 0, part.reshape(s.shape) / of, 1.0)
                for part, of in zip(own, self._plain(s), strict=True)
            ]
        to_modes = np.linalg.inv(chebvander(nodes, nodes.size - 1))
        return np.asarray(np.einsum("ij,pjk->ipk", to_modes, np.array(ratios)))

    def _plain(self, s: Array) -> tuple[Array, ...]:
        """Quantities of a half-space over E*."""
        profile = self.profile
        return profile.depth(s), profile.reduced_force(s), 2 * profile.contact_radius(s)

    @cached_property
    def _parts(self) -> tuple[Array, list[CubicHermiteSpline], float]:
        """Depths of the breaks, from 0 to the largest one, the force between them, and its error.

        The force is a spline over z, and its error is relative to the largest force.
        """
        shares, depths, splines, errors = np.linspace(0.0, 1.0, _KNOTS), [0.0], [], []
        for k, (low, high) in enumerate(pairwise(self._edges)):
            # Knots in z^(1/2) next to the tip, which resolve small depths and sharp powers; in z
            # beyond a break, where a smaller step of the depth would be its rounding error.
            first, last = self.profile.depth(np.array([low, high]))
            even = np.minimum(first + (last - first) * shares ** (2 if low else 4), last)
            s = np.clip(self.profile.coordinate_from_depth(even), low, high)
            modes = chebvander(2 * _share(s, low, high) - 1, len(self._ratios) - 1)
            depth, force, stiffness = self._ratios[..., k].T @ modes.T * np.array(self._plain(s))
            z = _share(depth, depth[0], depth[-1])
            slope = 2 * stiffness * (depth[-1] - depth[0]) * z
            splines.append(CubicHermiteSpline(z, force, slope))
            coarse = CubicHermiteSpline(z[::2], force[::2], slope[::2])
            errors.append(_PART * np.abs(coarse(z[1::2]) - force[1::2]).max())
            depths.append(float(depth[-1]))
        return np.array(depths), splines, float(max(errors) / force[-1])

    @property
    def error(self) -> float:
        """Estimated error of the interpolation, relative to the largest force [1]."""
        return self._parts[2] + 2 * float(np.abs(self._ratios[-2:]).max())

    @cached_property
    def deepest(self) -> float:
        """Largest depth [length]."""
        return float(self._parts[0][-1])

    def __call__(self, depth: Array) -> tuple[Array, Array]:
        """Return F_N/E* [length^2] and its slope [length] at depths from 0 to the deepest."""
        depths, splines, _ = self._parts
        force, slope = 0 * depth, 0 * depth
        place = np.clip(np.searchsorted(depths, depth) - 1, 0, len(splines) - 1)
        for k, spline in enumerate(splines):
            low, high = depths[k : k + 2]
            z = np.maximum(_share(depth[place == k], low, high), _LEAST)
            force[place == k] = spline(z)
            slope[place == k] = spline(z, 1) / (2 * (high - low) * z)
        return force, slope


def _share(depth: Array, low: float, high: float) -> Array:
    """Return z at depths."""
    return np.sqrt(np.clip((depth - low) / (high - low), 0.0, 1.0))
