"""Partial slip before the first cycle: constant quantities, units, and the unworn shape.

The integrator takes lengths along the surface in units of b_0 = sqrt(a_0^2 - c_0^2), depths in
units of D_0 = d_0 - g_0(c_0), and cycles in units of b_0/(kappa E* D_0), kappa = 4 K mu^2 E*/G*.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from mdr_core import equivalent_1d
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.wear.annulus_maps import AnnulusMaps, annulus_maps
from mdr_core.wear.worn_annulus import ALMOST

# Growth limit of the contact in widths at c = a; it carries the force on less where c is small.
# The contact of a paraboloid grows by half a width, of a power 100 by less.
_GROWTH: Final = 4.0
# Chebyshev terms of the tilt: the branch point of its arccosine lies a quarter of the interval
# before it, so that 16 terms resolve it to (3/2 + sqrt(5)/2)^-16 = 2e-7.
TILT_TERMS: Final = 16
# Largest slope of g_0 [D_0/b_0]: it is infinite at a jump of f', and no edge would pass it. Slopes
# are larger only within 1e-10 of the jump.
_STEEPEST: Final = 1e5


@dataclass(frozen=True)
class InitialState:
    """A contact in partial slip before the first cycle, with the nodes of its annulus."""

    tangential_contact: TangentialContact
    wear_coefficient: float
    nodes: int

    @property
    def normal(self) -> NormalContact:
        """Normal contact before wear."""
        return self.tangential_contact.normal

    @cached_property
    def slips(self) -> bool:
        """True if there is a loaded slip annulus, and so wear."""
        return float(self.tangential_contact.slip_width) > 0 and float(self.normal.normal_force) > 0

    @cached_property
    def constant_force(self) -> bool:
        """True if the normal force is constant and the depth grows; false for a constant depth."""
        return self.normal.control == "normal_force"

    @cached_property
    def full_slip(self) -> bool:
        """True if there is no stick zone: all of the contact wears."""
        return bool(self.tangential_contact.full_slip)

    @cached_property
    def constant_displacement(self) -> bool:
        """True if the displacement amplitude, and D, is constant; false if the force amplitude is.

        In full slip d is constant instead of D, unless the normal force is constant.
        """
        if self.full_slip:
            return not self.constant_force
        return self.tangential_contact.control == "tangential_displacement"

    @cached_property
    def stick_grows(self) -> bool:
        """True if the growing depth moves the stick edge outwards, over worn material."""
        return self.slips and self.constant_force and self.constant_displacement

    @cached_property
    def stick_shrinks(self) -> bool:
        """True if the falling normal force moves the stick edge inwards, over unworn material."""
        return not (self.constant_force or self.constant_displacement)

    @cached_property
    def stick_moves(self) -> bool:
        """True if the stick edge moves."""
        return self.constant_force == self.constant_displacement

    @cached_property
    def length_unit(self) -> float:
        """b_0 = sqrt(a_0^2 - c_0^2) [length]."""
        return float(np.sqrt(self.width * (2 * self.stick + self.width)))

    @cached_property
    def depth_unit(self) -> float:
        """D_0 = u_x/(mu E*/G*) [length]: d_0 - g(c_0) in partial slip, more in full slip."""
        moved = abs(float(self.tangential_contact.tangential_displacement))
        return moved / float(self.tangential_contact.displacement_ratio)

    @cached_property
    def step(self) -> float:
        """gamma(a) before wear [length]; the depth in full slip."""
        return float(self.normal.indentation_depth) if self.full_slip else self.depth_unit

    @cached_property
    def cycle_unit(self) -> float:
        """b_0 G*/(4 K mu^2 E*^2 D_0) [1], about the number of cycles that wear the annulus."""
        friction = float(np.asarray(self.tangential_contact.friction_coefficient))
        slipped = 4 * float(self.tangential_contact.displacement_ratio) * self.depth_unit
        pressed = float(np.asarray(self.normal.e_star)) * self.depth_unit / self.length_unit
        return self.depth_unit / (self.wear_coefficient * friction * pressed * slipped)

    @cached_property
    def stick(self) -> float:
        """c_0 [length]."""
        return float(self.tangential_contact.stick_radius)

    @cached_property
    def width(self) -> float:
        """a_0 - c_0 [length]."""
        return float(self.tangential_contact.slip_width)

    @cached_property
    def domain(self) -> float:
        """Radius up to which the profile is evaluated [length]."""
        return ALMOST * float(np.asarray(self.normal.profile.domain))

    @cached_property
    def growth_to_end(self) -> float:
        """Growth at which the contact reaches the profile's end [length]."""
        return self.domain - float(self.normal.contact_radius)

    @cached_property
    def largest_growth(self) -> float:
        """Growth of the contact up to which this method resolves it [length]."""
        if not self.stick_grows:
            return self.growth_to_end
        return min(self.growth_to_end, _GROWTH * self.width * (1 + self.width / self.stick) ** 2)

    @cached_property
    def maps(self) -> AnnulusMaps:
        """Maps between values at the nodes.

        A shrinking stick zone has half as many again: the layer outside it is eight times thinner
        than its distance from the edge, but as thick in other cases. Source: notes, §11.
        """
        nodes = self.nodes * 3 // 2 if self.stick_shrinks else self.nodes
        return annulus_maps(nodes, full_slip=self.full_slip)

    @cached_property
    def units(self) -> Array:
        """Units of the integrator's vector, (n, 1).

        It holds the wear at the inner nodes, b, c - c_0, w_c or d - d_0, and the tilt.
        """
        length, depth = self.length_unit, self.depth_unit
        worn = np.full(self.maps.squares.size - 1, depth / (length or 1.0))
        tilt = np.full(TILT_TERMS if self.stick_grows else 0, depth)
        return np.concatenate([worn, (length, length, depth), tilt])[:, None]

    @property
    def vector(self) -> Array:
        """Vector of `AnnulusState` before the first cycle, (n,)."""
        found = np.zeros(self.units.size)
        found[self.maps.squares.size - 1] = 1.0
        return found

    def unworn_force(self, growth: Array) -> Array:
        """Return F_N/(2 E*) of the unworn profile after a growth of the contact [length^2]."""
        profile = self.normal.profile
        radius = float(self.normal.contact_radius) + growth
        return np.asarray(profile.reduced_force(profile.coordinate_from_radius(radius)) / 2)

    def rise(self, stick_shift: Array, offset: Array) -> Array:
        """Return g_0(c + offset) - g_0(c) for c = c_0 + stick_shift [length], (m, k)."""
        profile, stick = self.normal.profile, self.stick + stick_shift
        ends = stick + np.stack([np.minimum(offset, 0.0), np.maximum(offset, 0.0)])
        ends = np.clip(ends, float(profile.first_radius), self.domain)
        low, high = profile.coordinate_from_radius(ends)
        width = np.minimum(np.abs(offset), high)
        if (width[-1] > equivalent_1d.NARROW * high[-1]).all():
            rise = profile.depth(high) - profile.depth(low)
        else:
            # A difference has rounding errors above the tolerance of the integration.
            rise = equivalent_1d.depth_step(profile, high, width, low)
        return np.asarray(np.sign(offset) * rise)

    def slope(self, x: Array) -> Array:
        """Return g_0'(x) [1], with a bound at a jump of f'."""
        steepest = _STEEPEST * self.depth_unit / self.length_unit
        return np.minimum(self.normal.profile.dg(np.minimum(x, self.domain)), steepest)
