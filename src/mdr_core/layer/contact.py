"""Results of a contact with an elastic layer.

Source: lebedev; hayes; manual, Contact with a layer.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Any, ClassVar, Final

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebval
from scipy.special import j0

from mdr_core import materials
from mdr_core.elementwise import where
from mdr_core.extrema import largest_with
from mdr_core.layer.equation import POINTS, States, angles, states, waves
from mdr_core.materials import Layer
from mdr_core.normal import NormalContact
from mdr_core.quadrature import composite_rule
from mdr_core.typing import Array, Indices

# Distance from the contact over the thickness at which its displacement is below rounding error: it
# decays at least as exp(-1.5 r/h).
_FAR: Final = 30.0
# Rounding error of the solved equation, over its condition; random cases have a quarter of it.
_ROUNDING: Final = 2e-13


@dataclass(frozen=True, repr=False, kw_only=True)
class LayerContact(NormalContact):
    """Profile pressed into an elastic layer on a rigid base, under any number of loads."""

    layer: Layer
    unusable: ClassVar[str] = f"a layer {materials.UNUSABLE}"

    @cached_property
    def half_space(self) -> NormalContact:
        """Contact of a half-space with the same contact coordinate."""
        known = self.profile, self.e_star, self.coordinate, self.control, self.material
        vars(contact := NormalContact(*known))["contact_radius"] = self.contact_radius
        return contact

    @cached_property
    def states(self) -> States:
        """Results over E*, of flattened loads."""
        return states(self.profile, self.layer, np.ravel(self.coordinate))

    def _shaped(self, values: Array, unit: Any = 1.0) -> Array:
        return np.asarray(unit * values).reshape(np.shape(self.coordinate))[()]

    @cached_property
    def indentation_depth(self) -> Array:
        """d = g(a) - int_0^a K(a, t) q dt/E* [length]."""
        return self._shaped(self.states.depth)

    @cached_property
    def normal_force(self) -> Array:
        """F_N = 2 int_0^a q dx [force]."""
        return self._shaped(self.states.force, self.e_star)

    @cached_property
    def normal_stiffness(self) -> Array:
        """dF_N/dd = 2 E* int_0^a q1 dx [force/length]."""
        return self._shaped(self.states.stiffness, self.e_star)

    @cached_property
    def elastic_energy(self) -> Array:
        """int_0^a q (d - g) dx = int_0^d F_N dd [force length]."""
        return self._shaped(self.states.energy, self.e_star)

    @cached_property
    def maximum_pressure(self) -> Array:
        """Largest pressure [pressure]."""
        part = largest_with(self.profile, self.coordinate, self.loaded, self.correction)
        return where(self.loaded, self.e_star * part, 0.0)

    def correction(self, load: Indices, radius: Array) -> Array:
        """Excess of the pressure over the half-space, by E*, each under the load of an index [1].

        With the excess y(x) of the foundation load over the half-space, by E*,
        y(a)/(pi sqrt(a^2 - r^2)) - (1/pi) int_r^a y'(x)/sqrt(x^2 - r^2) dx,
        x^2 = r^2 + (a^2 - r^2) z^2.
        """
        found, a = self.states.correction[:, load], np.ravel(self.contact_radius)[load]
        a = np.where(a > 0, a, 1.0)
        z, weights = (part[:, None] for part in composite_rule(len(found)))
        square = (radius / a) ** 2
        at = 2 * (square + (1 - square) * z * z) - 1
        rate = (weights * chebval(at, chebder(found)[:, None], tensor=False)).sum(axis=0)
        root = np.sqrt(np.maximum(a - radius, 0.0) * (a + radius))
        jump = found.sum(axis=0) if self.profile.is_flat_punch else 0.0
        with np.errstate(divide="ignore"):
            edge = jump / np.where(root > 0, root, np.inf)
        return np.asarray((edge - 4 * root / (a * a) * rate) / pi)

    def load_correction(self, load: Indices, x: Array) -> Array:
        """Foundation load over E* beyond the half-space's, each under the load of an index."""
        a = np.ravel(self.contact_radius)[load]
        at = 2 * (x / np.where(a > 0, a, 1.0)) ** 2 - 1
        return np.asarray(chebval(at, self.states.correction[:, load], tensor=False))

    def displacement(self, load: int, radius: Array, half_space: Array) -> Array:
        """Displacement of the surface at radii r > a, given the one of the half-space [length].

        (2/pi) int_0^a q(t)/E* B(t) dt, with
        B = 1/sqrt(r^2 - t^2) - (s/h) int_0^oo (1 - L) cos(w t/h) J_0(w r/h) dw.

        Parameters
        ----------
        load : index of the load.
        radius : radii outside the contact [length], shape (m,).
        half_space : displacement of a half-space there [length], shape (m,).
        """
        a, h = float(np.ravel(self.contact_radius)[load]), self.layer.thickness
        shares, weights = composite_rule(POINTS)
        angle = np.arcsin(a / radius) * shares[:, None]
        smooth = self.load_correction(np.array([load]), radius * np.sin(angle))
        whole = half_space + 2 / pi * np.arcsin(a / radius) * (weights @ smooth)
        only = states(self.profile, self.layer, np.ravel(self.coordinate)[[load]])
        reach = a / h + _FAR
        w, strength = waves(self.layer, reach)
        places = a / h * np.cos(angles(len(only.loads)))
        bend = strength * (np.cos(np.multiply.outer(w, places)) @ only.loads[:, 0]) / h
        near = whole - j0(np.multiply.outer(np.minimum(radius / h, reach), w)) @ bend
        return np.where(radius < reach * h, near, whole * (1 - self.layer.share))

    @property
    def method(self) -> str:
        """Method: the integral equation is solved by quadrature."""
        return "quadrature"

    @cached_property
    def error_estimates(self) -> Array:
        """Upper bound of the relative error of each case [1]."""
        condition = self._shaped(self.states.condition)
        return (self.half_space.error_estimates + _ROUNDING) * condition

    @property
    def edge_errors(self) -> Array:
        """Relative error of the contact radius of each case [1]."""
        return self.error_estimates * (self.control != "contact_radius")
