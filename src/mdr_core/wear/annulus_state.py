"""State of the worn annulus, and the quantities that follow from it.

Lengths along the surface are in units of b_0 = sqrt(a_0^2 - c_0^2), depths in units of
D_0 = d_0 - g_0(c_0), cycles in units of b_0/(kappa E* D_0), kappa = 4 K mu^2 E*/G*.

A slipping point has |s| = mu (E*/G*) sigma, sigma = (2/pi) int_c^r gamma(x)/sqrt(r^2 - x^2) dx with
gamma(x) = g(x) - (d - D), and wears by dh/dN = kappa p sigma. D is the displacement amplitude
divided by mu E*/G*. Source: notes, §11.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from mdr_core.profiles import Profile
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array
from mdr_core.wear.annulus_maps import AnnulusMaps
from mdr_core.wear.surface_tilt import COUNT, SurfaceTilt

# Up to this part of the stick radius a step of g is the integral of its slope: a difference has
# a rounding error of 1e-16/_NARROW, the rule of 8 points an error of _NARROW^16.
_NARROW: Final = 0.05
# Points of this rule.
_POINTS: Final = 8


class ConstantQuantities(NamedTuple):
    """Quantities that are held constant over the cycles."""

    force: bool
    """The normal force, so that the depth grows; otherwise the depth."""
    displacement: bool
    """The displacement amplitude, and with it D; otherwise the amplitude of the force."""

    @property
    def stick_grows(self) -> bool:
        """The growing depth moves the stick edge outwards, over worn material."""
        return self.force and self.displacement

    @property
    def stick_shrinks(self) -> bool:
        """The falling normal force moves the stick edge inwards, over unworn material."""
        return not (self.force or self.displacement)

    @property
    def stick_moves(self) -> bool:
        """The stick edge is not at rest."""
        return self.force == self.displacement


@dataclass(frozen=True)
class UnwornShape:
    """Equivalent profile g_0 before wear, in the units of the annulus."""

    profile: Profile
    stick: float
    """c_0 [length]."""
    length_unit: float
    """b_0 [length]."""
    depth_unit: float
    """D_0 [length]."""
    end: float
    """Radius up to which the profile is evaluated [length]."""

    @cached_property
    def singular(self) -> Array:
        """Radii at which g_0 is not smooth: the flat's, the breaks and the end [length]."""
        profile = self.profile
        inner = np.append(profile.first_coordinate, profile.coordinate_breaks)
        return np.append(profile.contact_radius(inner), profile.domain)

    def rise(self, stick_shift: float, offset: Array) -> Array:
        """Return g_0(c + offset) - g_0(c) for the stick radius c = c_0 + stick_shift."""
        stick, by = self.stick + self.length_unit * stick_shift, self.length_unit * offset
        # A narrow annulus at a break has less accuracy to lose than Gauss points at a singularity.
        near = np.abs(self.singular - stick) < 2 * by[-1]
        if by[-1] > _NARROW * stick or near.any():
            g = self.profile.g(np.minimum(np.append(stick, stick + by), self.end))
            return np.asarray((g[1:] - g[0]) / self.depth_unit)
        nodes, weights = gauss_legendre(_POINTS)
        at = stick + np.multiply.outer(by, (1 + nodes) / 2)
        return np.asarray(by / 2 * (self.profile.dg(at) @ weights) / self.depth_unit)

    def slope(self, x: Array) -> Array:
        """Return g_0'(x)."""
        slope = self.profile.dg(np.minimum(x * self.length_unit, self.end))
        return np.asarray(slope * (self.length_unit / self.depth_unit))


@dataclass(frozen=True)
class AnnulusState:
    """The worn annulus at one number of cycles, from the vector of the integrator.

    The vector holds (sigma - S_0)/s at all nodes but the last, S_0 being sigma of the unworn
    shape; b, c - c_0, d - d_0, the work so far; and the series of the tilt outside the contact.
    """

    model: "AnnulusModel"
    vector: Array

    @property
    def end(self) -> float:
        """b = sqrt(a^2 - c^2)."""
        return float(self.vector[self.model.first_edge])

    @property
    def stick_shift(self) -> float:
        """c - c_0, without the rounding error of c in a narrow annulus."""
        return float(self.vector[self.model.first_edge + 1])

    @property
    def stick(self) -> float:
        """c."""
        return self.model.first_stick + self.stick_shift

    @property
    def depth_increase(self) -> float:
        """d - d_0."""
        return float(self.vector[self.model.first_edge + 2])

    @property
    def work(self) -> float:
        """Integral of the power over the cycles."""
        return float(self.vector[self.model.first_edge + 3])

    @cached_property
    def retained_wear(self) -> float:
        """w_c = g(c) - g_0(c): wear that the springs keep when the growing stick zone gets there.

        At a stick edge at rest w_c is the height of g's step that is inside the stick zone.
        """
        return self.depth_increase - self._stick_rise if self.model.constant.stick_grows else 0.0

    @cached_property
    def _stick_rise(self) -> float:
        """g_0(c) - g_0(c_0)."""
        return -float(self.model.shape.rise(self.stick_shift, np.array([-self.stick_shift]))[0])

    @cached_property
    def reduced_amplitude(self) -> float:
        """D."""
        if self.model.constant.displacement:
            return 1.0
        rise = self._stick_rise if self.model.constant.stick_shrinks else 0.0
        return 1.0 + self.depth_increase - rise

    @cached_property
    def x(self) -> Array:
        """Radii of the nodes; the last one is a."""
        return np.sqrt(self.stick**2 + self.end**2 * self.model.maps.squares)

    @cached_property
    def offset(self) -> Array:
        """x - c."""
        return np.asarray(self.end**2 * self.model.maps.squares / (self.x + self.stick))

    @cached_property
    def growth(self) -> float:
        """a - a_0."""
        return self.stick_shift + float(self.offset[-1]) - self.model.first_width

    @cached_property
    def unworn(self) -> Array:
        """(g_0(x) - g_0(c))/x."""
        return self.model.shape.rise(self.stick_shift, self.offset) / self.x

    @cached_property
    def tilt(self) -> tuple[float, float]:
        """Tilt of the surface at the contact's edge, and its slope."""
        if not self.model.tilt:
            return 0.0, 0.0
        series = self.vector[self.model.first_edge + 4 :]
        value, slope = (terms @ series for terms in self.model.tilt.basis(self.growth))
        return float(value), float(slope)

    @cached_property
    def worn(self) -> Array:
        """(sigma - S_0)/s: while the stick edge rests, the worn depth divided by s."""
        return np.append(self.vector[: self.model.first_edge], self.tilt[0] / self.end)

    @cached_property
    def worn_omega(self) -> Array:
        """(gamma - gamma_0)/x, gamma_0 being gamma of the unworn shape."""
        return np.asarray(self.model.maps.from_slip @ self.worn)

    @cached_property
    def omega(self) -> Array:
        """gamma/x."""
        return self.unworn + self.worn_omega

    @cached_property
    def gamma(self) -> Array:
        """g(x) - (d - D)."""
        return self.x * self.omega

    @cached_property
    def pressure(self) -> Array:
        """p/E* at the nodes."""
        return np.asarray(self.model.maps.to_pressure @ self.gamma) / self.end

    @cached_property
    def slip(self) -> Array:
        """v = sigma/s."""
        return np.asarray(self.model.maps.to_slip @ self.unworn + self.worn)

    @cached_property
    def worn_integral(self) -> float:
        """int_c^a (gamma - gamma_0) dx."""
        return float(self.end**2 * (self.model.maps.mean @ self.worn_omega))

    @cached_property
    def power(self) -> float:
        """int_c^a (D - gamma) gamma dx, the friction work of a cycle. Source: notes, §6."""
        maps, omega = self.model.maps, self.omega
        weights = self.reduced_amplitude * maps.mean - self.gamma @ maps.product
        return float(self.end**2 * weights @ omega)


@dataclass(frozen=True)
class AnnulusModel:
    """Nodes of the annulus, its unworn shape, and the quantities that are constant."""

    maps: AnnulusMaps
    shape: UnwornShape
    constant: ConstantQuantities
    first_stick: float
    """c_0."""
    first_width: float
    """a_0 - c_0."""
    tilt: SurfaceTilt | None = None
    """Only with a growing stick zone."""

    @property
    def first_edge(self) -> int:
        """Index of b in the vector."""
        return self.maps.squares.size - 1

    @property
    def start(self) -> Array:
        """Vector before the first cycle."""
        edges = (1.0, 0.0, 0.0, 0.0)
        tilt = np.zeros(COUNT if self.tilt else 0)
        return np.concatenate([np.zeros(self.first_edge), edges, tilt])
