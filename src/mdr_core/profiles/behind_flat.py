"""The contact coordinate of all that start with a flat: s = sqrt(a^2 - b^2)."""

import numpy as np

from mdr_core.abel.roots import leg
from mdr_core.checks import first_index
from mdr_core.errors import InputError
from mdr_core.profiles.profile import Profile
from mdr_core.typing import Array, Parameter


class BehindFlat(Profile):
    """Flat up to b = `flat_radius`, where a has no digits of a - b. Source: notes, §4."""

    flat_radius: Parameter

    def contact_radius(self, coordinate: Array) -> Array:
        return np.asarray(np.hypot(self.flat_radius, coordinate))

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        inside = np.asarray(contact_radius < self.flat_radius)
        if inside.any():
            raise InputError(
                ("load", "contact_radius", *first_index(inside)),
                f"the contact cannot be smaller than the flat, flat_radius = {self.flat_radius}",
                inside,
            )
        return leg(contact_radius, self.flat_radius)

    def radius_slope(self, coordinate: Array) -> Array:
        return coordinate / self.contact_radius(coordinate)

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        return (a - c) * (a + c) / np.where(s_a > 0, s_a + s_c, 1.0)

    def radius_width(self, s_a: Array, width: Array) -> Array:
        total = self.contact_radius(s_a) + self.contact_radius(s_a - width)
        return width * (2 * s_a - width) / total
