"""Partial slip before the first cycle: constant quantities, and the units of the rates."""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.wear.annulus_maps import annulus_maps
from mdr_core.wear.annulus_state import AnnulusModel, ConstantQuantities, UnwornShape
from mdr_core.wear.surface_tilt import SurfaceTilt

# Widths by which the contact may grow at c = a; it carries the force on less where c is small. The
# contact of a paraboloid grows by half a width, that of a power 100 by less.
_GROWTH: Final = 4.0
# Full slip: the stick zone has shrunk to this part of its first distance from the flat or the axis.
_VANISHED: Final = 1e-3
# As near to the end of a profile as its functions are evaluated: they may be infinite there.
_ALMOST: Final = 1 - 1e-9


@dataclass(frozen=True)
class InitialState:
    """A contact in partial slip before the first cycle."""

    tangential_contact: TangentialContact
    wear_coefficient: float
    constant: ConstantQuantities

    @property
    def contact(self) -> NormalContact:
        """Normal contact before wear."""
        return self.tangential_contact.normal

    @property
    def slips(self) -> bool:
        """There is a slip annulus, and so wear."""
        return float(self.tangential_contact.slip_width) > 0

    @cached_property
    def stick(self) -> float:
        """c_0 [length]."""
        return float(self.tangential_contact.stick_radius)

    @cached_property
    def length_unit(self) -> float:
        """b_0 = sqrt(a_0^2 - c_0^2) [length]."""
        width = float(self.tangential_contact.slip_width)
        return float(np.sqrt(width * (2 * self.stick + width)))

    @cached_property
    def depth_unit(self) -> float:
        """D_0 = d_0 - g(c_0) [length], u_x/(mu E*/G*)."""
        moved = abs(float(self.tangential_contact.tangential_displacement))
        return moved / float(self.tangential_contact.displacement_ratio)

    @cached_property
    def cycle_unit(self) -> float:
        """b_0 G*/(4 K mu^2 E*^2 D_0) [1], about the number of cycles that wear the annulus."""
        friction = float(np.asarray(self.tangential_contact.friction_coefficient))
        slipped = 4 * float(self.tangential_contact.displacement_ratio) * self.depth_unit
        pressed = float(np.asarray(self.contact.e_star)) * self.depth_unit / self.length_unit
        return self.depth_unit / (self.wear_coefficient * friction * pressed * slipped)

    @property
    def domain(self) -> float:
        """Radius up to which the profile is evaluated [length]."""
        return _ALMOST * float(np.asarray(self.contact.profile.domain))

    @property
    def room(self) -> float:
        """Length by which the contact may grow before it reaches the profile's end [length]."""
        return self.domain - float(self.contact.contact_radius)

    @cached_property
    def reach(self) -> float:
        """Length by which the contact may grow in this method [length]."""
        if not self.constant.stick_grows:
            return self.room
        wide = 1 + float(self.tangential_contact.slip_width) / self.stick
        return min(self.room, _GROWTH * float(self.tangential_contact.slip_width) * wide**2)

    @property
    def ends(self) -> tuple[float, float]:
        """`reach` and the smallest stick radius, where the integration ends, in its unit."""
        profile = self.contact.profile
        flat = float(profile.first_radius)
        least = flat + _VANISHED * (self.stick - flat)
        return self.reach / self.length_unit, least / self.length_unit

    def model(self, nodes: int) -> AnnulusModel:
        """Return the rates of wear on so many nodes, in their units.

        A shrinking stick zone takes half as many again: the front outside it is eight times thinner
        than its distance from the edge, elsewhere both are alike. Source: notes, §11.
        """
        nodes = nodes * 3 // 2 if self.constant.stick_shrinks else nodes
        unit = self.length_unit
        stick, width = self.stick / unit, float(self.tangential_contact.slip_width) / unit
        tilt = SurfaceTilt(stick, width, self.reach / unit) if self.constant.stick_grows else None
        parts = self.stick, unit, self.depth_unit, self.domain
        shape = UnwornShape(self.contact.profile, *parts)
        return AnnulusModel(annulus_maps(nodes), shape, self.constant, stick, width, tilt)
