"""One scene of fretting wear: what is held, its units, and the unworn shape in them."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from mdr_core.lazy import cached_property
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.wear.annulus_maps import annulus_maps
from mdr_core.wear.rates import Control, Outside, Shape, System

# Widths by which the contact may grow at c = a; it carries the force on less where c is small.
_GROWTH: Final = 4.0
# Polynomials in variables between the radius and its square, by halves: few maps serve all.
_SMALLEST_SPREAD: Final = -6.0
# As near to the end of a profile as its functions are asked for.
_ALMOST: Final = 1 - 1e-9


@dataclass(frozen=True)
class Scene:
    """A contact that slips to and fro, before the first cycle."""

    sideways: TangentialContact
    wear_coefficient: float
    control: Control

    @property
    def contact(self) -> NormalContact:
        """The normal contact."""
        return self.sideways.normal

    @property
    def slips(self) -> bool:
        """Whether anything slips, and so wears."""
        return float(self.sideways.slip_width) > 0

    @cached_property
    def stick(self) -> float:
        """c_0 [length]."""
        return float(self.sideways.stick_radius)

    @cached_property
    def length_unit(self) -> float:
        """b_0 = sqrt(a_0^2 - c_0^2) [length]."""
        width, a = float(self.sideways.slip_width), float(self.contact.contact_radius)
        return float(np.sqrt(width * (2 * a - width)))

    @cached_property
    def depth_unit(self) -> float:
        """D_0 = d_0 - g(c_0) [length]: the displacement without its compliance."""
        moved = abs(float(self.sideways.tangential_displacement))
        return moved / float(self.sideways.compliance)

    @cached_property
    def cycle_unit(self) -> float:
        """b_0 G*/(4 K mu^2 E*^2 D_0) [1]: about how many cycles wear the annulus down."""
        friction = float(np.asarray(self.sideways.friction_coefficient))
        slipped = 4 * float(self.sideways.compliance) * self.depth_unit
        pressed = float(np.asarray(self.contact.e_star)) * self.depth_unit / self.length_unit
        return self.depth_unit / (self.wear_coefficient * friction * pressed * slipped)

    @property
    def domain(self) -> float:
        """Radius up to which the profile is asked for [length]."""
        return _ALMOST * float(np.asarray(self.contact.profile.domain))

    @cached_property
    def outside(self) -> Outside | None:
        """Where a stick edge that moves shows outside the contact."""
        if not self.control.stick_moves:
            return None
        a = float(self.contact.contact_radius)
        stop = a + _GROWTH * float(self.sideways.slip_width) * (a / self.stick) ** 2
        return Outside(a / self.length_unit, stop / self.length_unit)

    @property
    def stop(self) -> float:
        """Contact radius at which the course has to end, in its unit."""
        domain = self.domain / self.length_unit
        return min(domain, self.outside.stop) if self.outside else domain

    def system(self, nodes: int) -> System:
        """The scene in its units on so many nodes."""
        a = float(self.contact.contact_radius)
        spread = np.clip(np.round(np.log2(2 * self.stick / (a + self.stick))), _SMALLEST_SPREAD, 0)
        maps, stick = annulus_maps(nodes, float(2.0**spread)), self.stick / self.length_unit
        return System(maps, self.shape, self.control, stick, self.outside)

    @cached_property
    def shape(self) -> Shape:
        """The unworn shape in the scene's units."""
        profile, across, along = self.contact.profile, self.depth_unit, self.length_unit
        level, end = float(profile.g(np.array([self.stick]))[0]), self.domain

        def rise(x: Array) -> Array:
            return np.asarray((profile.g(np.minimum(x * along, end)) - level) / across)

        def slope(x: Array) -> Array:
            return np.asarray(profile.dg(np.minimum(x * along, end)) * (along / across))

        return Shape(rise, slope)
