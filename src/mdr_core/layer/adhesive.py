"""Adhesive states of a contact with an elastic layer.

Source: notes, §13; manual, Contact with a layer.
"""

from functools import cached_property
from typing import Any, Final

import numpy as np

from mdr_core import adhesion
from mdr_core.layer.contact import LayerContact
from mdr_core.layer.equation import Range, States, allowed, largest_coordinate, states
from mdr_core.materials import Layer
from mdr_core.profiles import FlatPunch, Profile
from mdr_core.typing import Array, Indices

# Contact radius over the thickness below which the layer changes a contact by a few per cent.
_THICK: Final = 0.03


class LayerCurve(adhesion.Curve):
    """Adhesive equilibrium states of a profile and a layer over the contact coordinate."""

    def __init__(self, profile: Profile, c: float, layer: Layer) -> None:
        self.layer = layer
        self.half_space = adhesion.Curve(profile, c)
        super().__init__(profile, c)

    @property
    def start(self) -> float:
        """Coordinate below which the layer is a half-space, and its states are not stable."""
        stable = self.half_space.stable["indentation_depth"][0]
        thin = _THICK * self.layer.thickness + self.profile.first_radius
        least = self.profile.coordinate_from_radius(np.atleast_1d(thin))
        return min(float(stable.min()) / 2, float(least[0]))

    @property
    def end(self) -> float:
        """Coordinate of the largest contact."""
        return largest_coordinate(self.profile, self.layer)

    @property
    def allowed(self) -> Range:
        """Contact radii that the profile and the layer allow."""
        return allowed(self.profile, self.layer)

    def pressed(self, *known: Any) -> LayerContact:
        """Return a contact without adhesion; `known` are the arguments of `NormalContact`."""
        return LayerContact(*known, layer=self.layer)

    def correction(self, contact: adhesion.AdhesiveContact, load: Indices, r: Array) -> Array:
        """Pressure over E* beyond the half-space's at radii, each under the load of an index.

        Parameters: the contact; indices of loads and radii [length], both of shape (k,).
        """
        radii, retraction = map(np.ravel, (contact.contact_radius, contact.retraction))
        known = contact.profile, contact.e_star, contact.coordinate
        parts = self.pressed(*known), self.pressed(FlatPunch(radii), 1.0, retraction)
        whole, punch = (part.correction(load, r) for part in parts)
        return np.asarray(whole - punch)

    @cached_property
    def _at_nodes(self) -> States:
        return states(self.profile, self.layer, self._nodes)

    def _found(self, coordinate: Array) -> States:
        """Contacts without adhesion, in the shape of the coordinates."""
        if coordinate is vars(self).get("_nodes"):
            return self._at_nodes
        found = states(self.profile, self.layer, np.ravel(coordinate))
        return States(*(part.reshape((*part.shape[:-1], *np.shape(coordinate))) for part in found))

    def stiffness(self, coordinate: Array) -> Array:
        """dF_N/dd over E* at constant contact radius [length]."""
        return self._found(coordinate).stiffness[()]

    def retraction(self, coordinate: Array) -> Array:
        """Delta_l = c sqrt(a)/q1(a) [length]."""
        return super().retraction(coordinate) / self._found(coordinate).edge[()]

    def load(self, name: str, coordinate: Array) -> Array:
        """Depth or F_N/E*."""
        found = self._found(coordinate)
        retraction = super().retraction(coordinate) / found.edge
        if name == "indentation_depth":
            return np.asarray(found.depth - retraction)[()]
        return np.asarray(found.force - found.stiffness * retraction)[()]

    def excess(self, share: float, coordinate: Array) -> Array:
        """Slope of the load in a, over c/sqrt(a) and, of a force, the punch's stiffness [1]."""
        found, a = self._found(coordinate), self.profile.contact_radius(coordinate)
        with np.errstate(all="ignore"):
            excess = found.depth_slope * np.sqrt(a) / self.c - 1 / (2 * found.edge)
            excess = excess + found.edge_growth / found.edge**2
            if share > 1:
                excess = excess - 2 * a * found.edge / found.stiffness
        return np.asarray(excess)[()]
