"""Interface of a profile, with a general method for every quantity that a kind may override.

The interface is one class, and therefore one long file.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from functools import cached_property
from math import inf
from typing import Any, ClassVar, Final, Self

import numpy as np

from mdr_core.abel.annulus import Annulus
from mdr_core.abel.displacement import (
    STEEPNESS,
    Branch,
    Kernel,
    arccosine,
    arcsine,
    slope_integral,
)
from mdr_core.abel.stress import stress_integral
from mdr_core.doubles import EPS, LOG_RANGE
from mdr_core.elementwise import full, number, some, where
from mdr_core.inversion import invert
from mdr_core.profiles.power_law_integral import power_law_integral
from mdr_core.typing import Array, Flags, Indices, Parameter
from mdr_core.validation import as_positive, require_inside

# Quantities of a normal contact, as `Profile.closed_forms` names them.
NORMAL_QUANTITIES: Final = (
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "mean_pressure",
    "maximum_pressure",
    "normal_stiffness",
    "elastic_energy",
)
# Fields of a contact, as `Profile.closed_forms` names them.
FIELDS: Final = ("pressure", "shear_stress", "slip", "normal_displacement")


class Profile(ABC):
    """Rigid axisymmetric profile f(r) with f(0) = 0 and its equivalent profile g(x).

    The contact edge is described by the *contact coordinate* of the kind, a number from which
    radius, depth and force are all accurate: the radius a, or the distance a - b from a flat of
    radius b, next to which a does not resolve depth and force. It is zero at zero load.

    A kind defines f, f', g, g', F_N/E* and its closed forms. Every other method has a general
    implementation here. Parameters may be arrays over the cases of a sweep; they broadcast with the
    loads. Arrays called c, r, x, coordinate have the dimension [length] unless stated otherwise.
    """

    kind: ClassVar[str]
    formula: ClassVar[str]
    # Quantities in closed form; all others need quadrature or iteration.
    closed_forms: ClassVar[tuple[str, ...]] = ("normal_force", "mean_pressure", "normal_stiffness")
    is_flat_punch: ClassVar[bool] = False
    """True if the radius is the same at every load: the punch sticks as a whole."""
    flattens: bool = False
    """True if g' may fall towards zero, where the contact radius is ill-conditioned."""
    steepens: bool = False
    """True if the contact radius may not resolve the load just beyond a break."""

    def __post_init__(self) -> None:
        """Raise InputError unless all parameters are positive and finite."""
        for name, value in self.parameters.items():
            vars(self)[name] = as_positive(("profile", name), value)

    @property
    def parameters(self) -> dict[str, Any]:
        """Parameters by name, if they fully define the profile; otherwise empty."""
        names: tuple[str, ...] = getattr(self, "__match_args__", ())
        return {name: getattr(self, name) for name in names}

    @cached_property
    def swept(self) -> tuple[str, ...]:
        """Names of the parameters that are arrays over the cases of a sweep."""
        return tuple(
            name
            for name, value in self.parameters.items()
            if isinstance(value, np.ndarray) and value.ndim
        )

    def with_parameters(self, parameters: Mapping[str, Any]) -> Self:
        """Return the profile with some parameters replaced, without a check."""
        if not parameters:
            return self
        part = object.__new__(type(self))
        vars(part).update({**self.parameters, **parameters})
        return part

    @property
    def normal_method(self) -> str:
        """Most expensive method among the quantities of a normal contact."""
        closed = set(NORMAL_QUANTITIES) <= set(self.closed_forms)
        return "closed_form" if closed else "quadrature"

    @property
    def tangential_method(self) -> str:
        """Most expensive method among the quantities of a tangential contact."""
        closed = "closed_form" if "slip" in self.closed_forms else "quadrature"
        return closed if self.normal_method == "closed_form" else self.normal_method

    def rounding_at(self, coordinate: Array) -> Parameter:
        """Bound on the relative rounding error of the closed forms at a contact coordinate."""
        return 3e-14

    # The shape.

    @abstractmethod
    def f(self, radius: Array) -> Array:
        """Shape f(r) [length]."""

    @abstractmethod
    def df(self, radius: Array) -> Array:
        """Slope f'(r) [1]; at a break, the limit from outside."""

    @abstractmethod
    def g(self, x: Array) -> Array:
        """Equivalent profile g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr [length].

        Source: mdr-5, Eq. (5.74).
        """

    @abstractmethod
    def dg(self, x: Array) -> Array:
        """Slope g'(x) of the equivalent profile [1]; infinite at a break where f' jumps."""

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        """Radii where f' or one of its derivatives jumps [length]."""
        return ()

    @property
    def domain(self) -> Parameter:
        """Radius up to which the profile is defined and admissible [length].

        In a profile with an end, contact coordinates are radii.
        """
        return inf

    @property
    def end(self) -> tuple[str, str]:
        """Words for the end of the domain in an error: the reason, and what to do."""
        return "where the profile ends or ceases to be admissible", "extend a table"

    @property
    def body_radii(self) -> tuple[Parameter, Parameter] | None:
        """Radii of two round bodies, infinite if flat and negative if concave; else None."""
        return None

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        """Radii at which the pressure of every contact that contains them is infinite [length].

        By default 0 for a sharp tip.
        A sweep has one radius for each case, infinite for a case that has none.
        """
        sharp = where(self.tip_pressure > 0, 0.0, inf)
        return (sharp,) if some(sharp == 0) else ()

    @property
    def pole(self) -> Parameter:
        """Coordinate of the pole of the continued g'; inf if there is none."""
        return inf

    @property
    def opposite_singularity(self) -> Parameter:
        """Distance of g's singularity at s = -`opposite_singularity` beyond a break [length]."""
        return inf

    @property
    def tip_pressure(self) -> Parameter:
        """Limit g'(0)/pi of mean pressure/E* as the load vanishes [1]: zero for smooth tips."""
        return self.dg(number(0.0)) / np.pi

    @property
    def exponents(self) -> tuple[float, ...]:
        """Exponents of powers of which g is a sum; none if all lie from 1 to `STEEPNESS`."""
        return ()

    @property
    def steepness(self) -> float:
        """Largest local exponent of g; it sets the number of nodes."""
        return max((STEEPNESS, *self.exponents))

    # Methods over the contact coordinate.

    @property
    def first_radius(self) -> Parameter:
        """Contact radius at zero load: the radius of a flat, 0 without one [length]."""
        return self.contact_radius(number(0.0))

    @cached_property
    def largest_loads(self) -> tuple[Parameter, Parameter]:
        """Depth [length] and F_N/E* [length^2] at the end of the domain; infinite without one."""
        end = number(1.0) * self.domain
        return (inf, inf) if some(end == inf) else (self.depth(end), self.reduced_force(end))

    @property
    def scale(self) -> Parameter:
        """Characteristic contact coordinate, such as the coordinate of a break."""
        raise NotImplementedError(f"a {self.kind} has no scale, because its inverses are closed")

    @property
    def coordinate_breaks(self) -> Array:
        """Contact coordinates at which the depth is not smooth, ascending; in a sweep by case."""
        return np.empty(0)

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        """Contact coordinate of a contact radius."""
        return contact_radius

    def contact_radius(self, coordinate: Array) -> Array:
        """Contact radius a [length]."""
        return coordinate

    # Methods of the normal contact.

    def depth(self, coordinate: Array) -> Array:
        """Indentation depth d = g(a) [length]."""
        return self.g(coordinate)

    def depth_slope(self, coordinate: Array) -> Array:
        """Derivative of the depth with respect to the contact coordinate."""
        return self.dg(coordinate)

    def depth_slope_beyond(self, coordinate: Array, start: Array, past: Array) -> Array:
        """`depth_slope` at start + past, with the relative accuracy of `past` beyond a break.

        Parameters
        ----------
        coordinate : start + past.
        start : contact coordinate of the break below.
        past : distance from that break.
        """
        return self.depth_slope(coordinate)

    @abstractmethod
    def reduced_force(self, coordinate: Array) -> Array:
        """Normal force over E*, F_N/E* = 2 int_0^a x g'(x) dx [length^2]."""

    def force_slope(self, coordinate: Array) -> Array:
        """Derivative of F_N/E* with respect to the contact coordinate s, 2 a d'(s)."""
        return 2 * self.contact_radius(coordinate) * self.depth_slope(coordinate)

    def load_and_slope(self, coordinate: Array, *, of_force: bool) -> tuple[Array, Array]:
        """F_N/E* [length^2], or the depth [length], and its derivative.

        Source: notes, §1.
        """
        if of_force:
            return self.reduced_force(coordinate), self.force_slope(coordinate)
        return self.depth(coordinate), self.depth_slope(coordinate)

    def reduced_energy(self, coordinate: Array) -> Array:
        """Elastic energy over E*, int_0^a (d - g)^2 dx = int_0^d F_N/E* dd [length^3]."""
        depth = self.depth(coordinate)
        return self._integral(lambda s: np.square(depth - self.depth(s)), coordinate)

    def _integral(self, density: Callable[[Array], Array], coordinate: Array) -> Array:
        """Integral of a density over the contact coordinate, from the axis to the edge."""
        return power_law_integral(density, coordinate, self.scale)

    def coordinate_from_load(self, load: Array, *, of_force: bool) -> Array:
        """Contact coordinate at which F_N/E* [length^2] or the depth g(a) [length] has a value.

        Source: mdr-5, Eqs. (5.7), (5.14), (5.59), (5.61); notes, §1.

        Raises InputError beyond the end of the profile.
        """
        if of_force:
            return self.coordinate_from_reduced_force(load)
        return self.coordinate_from_depth(load)

    def coordinate_from_depth(self, depth: Array) -> Array:
        """Inverse of `depth`, iterated where it has no closed form."""
        return self._root(depth, of_force=False)

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array:
        """Inverse of `reduced_force`, iterated where it has no closed form."""
        return self._root(reduced_force, of_force=True)

    def _root(self, target: Array, *, of_force: bool) -> Array:
        """Contact coordinate at which a load has a value within the domain."""
        name = "normal_force" if of_force else "indentation_depth"
        require_inside(("load", name), target > self.largest_loads[of_force], self)
        # At a pole the load is infinite, and no power is known.
        scale = number(1.0) * np.minimum(self.scale, self.pole / 2)
        with np.errstate(all="ignore"):
            # The first approximation takes the load as a power of the coordinate, fitted at the
            # scale.
            load, slope = self.load_and_slope(scale, of_force=of_force)
            ratio = np.log(target / load) * (load / (scale * slope))
            # Where a load hardly rises at the scale, this power leaves the range of doubles.
            start = scale * np.exp(np.clip(ratio, -LOG_RANGE, LOG_RANGE))
        start = np.minimum(where(start > 0, start, scale), self.domain)

        def sloped(s: Array) -> tuple[Array, Array]:
            value, slope = self.load_and_slope(s, of_force=of_force)
            return value, s * slope / value

        low, high = (full(end, start) for end in (0.0, self.domain))
        return invert(sloped, target, start, low, high)

    # Methods over the slip annulus.

    def stick_parts(
        self, ratio: Array, rest: Array, *, of_force: bool
    ) -> tuple[Array, Array] | None:
        """c/a and 1 - c/a in the contact coordinate if the load is a power of it, else None.

        Parameters: see `equivalent_1d.stick_edge`.
        """
        return None

    def force_step(self, coordinate: Array, width: Array, stick: Array) -> Array | None:
        """(F(a) - F(c))/E* if there is a closed form free of cancellation, else None.

        Parameters
        ----------
        coordinate : contact coordinate of a.
        width : coordinate - stick, accurate in a narrow annulus.
        stick : contact coordinate of c, accurate in a wide annulus.
        """
        return None

    def depth_step(self, coordinate: Array, width: Array, stick: Array) -> Array | None:
        """d(a) - d(c) if there is a closed form free of cancellation, else None.

        Parameters: see `force_step`.
        """
        return None

    def interval_moments(self, span: Array, ends: Array, *, over_forces: bool) -> Array | None:
        """Moments of `IntervalMoments` if a closed form holds for every interval, else None.

        Parameters
        ----------
        span : lengths of the intervals in the normal coordinate, > 0, shape (m,).
        ends : both ends in the contact coordinate, shape (2, m).
        over_forces : True if the normal coordinate is the reduced force, false for the depth.
        """
        return None

    # Fields.

    @property
    def branches(self) -> tuple[Branch, ...]:
        """Intervals on which g' is smooth except for the root at the start of each."""
        tip = min((1.0, *self.exponents))
        pole = float(np.asarray(self.pole))
        return (Branch(0.0, lambda x, _: self.dg(x), tip=tip, steepness=self.steepness, pole=pole),)

    def branch_weights(self, x: Array, s: Array, owner: Indices) -> Array:
        """Weights g'(x) s/x of the integrals over s [1], shape (n, m).

        Parameters
        ----------
        x, s : radii, and contact coordinates from the base of each branch [length], shape (n, m).
        owner : index of the branch of each column, shape (m,).
        """
        found, weights = np.empty_like(x), [branch.weight for branch in self.branches]
        for weight in set(weights):
            own = np.array([weight is each for each in weights])[owner]
            found[:, own] = weight(x[:, own], s[:, own])
        return found

    def annulus_integrals(
        self, low: Array, width: Array, *kernels: Kernel, degree: float = 0.0
    ) -> Array:
        """Integrals int_low^r g'(x) K(x, sqrt(r^2 - x^2)) dx, r = low + width, shape (k, m).

        Parameters
        ----------
        low, width : inner radii and widths of the annuli [length], shape (m,).
        kernels : k functions K.
        degree : see `slope_integral`.
        """
        r = low + width
        return slope_integral(self.branches, low, r, r, *kernels, width=width, degree=degree)

    def slip_integral(self, c: Array, r: Array) -> Array:
        """Slip S(c; r) = (2/pi) int_c^r (g(x) - g(c))/sqrt(r^2 - x^2) dx [length].

        S(0; r) is the profile itself. Source: mdr-5, Eqs. (5.40), (5.41).

        Parameters
        ----------
        c, r : stick radii and radii, 0 <= c <= r [length], shape (m,).
        """
        # Next to the axis arccos(x/r) = pi/2 - x/r, for which the integrals are closed.
        near = np.maximum(c, np.cbrt(EPS) * r)
        value = slope_integral(self.branches, near, r, r, arccosine)[0]
        if np.any(near > c):
            value += np.pi / 2 * (self.g(near) - self.g(c))
            step = self.force_within(near) - self.force_within(c)
            value -= step / (2 * np.where(r > 0, r, 1.0))
        return 2 / np.pi * value

    def outer_displacement(self, a: Array, r: Array, coordinate: float) -> Array:
        """Displacement (2/pi) int_0^a (d - g(x))/sqrt(r^2 - x^2) dx of the surface [length].

        Source: mdr-5, Eq. (5.75), with the foundation's displacement d - g.

        Parameters
        ----------
        a, r : contact radius and radii r >= a [length], shape (m,).
        coordinate : contact coordinate of a, which may be more accurate than a.
        """
        # Next to the axis arcsin(x/r) = x/r, for which the integral is closed.
        near = np.minimum(a, np.cbrt(EPS * r * r * a))
        value = slope_integral(self.branches, near, a, r, arcsine)[0]
        value += self.force_within(near) / (2 * r)
        return 2 / np.pi * value

    def force_within(self, x: Array) -> Array:
        """2 int_0^x x g'(x) dx, zero on a flat [length^2]."""
        return self.reduced_force(self.coordinate_from_radius(np.maximum(x, self.first_radius)))

    def falls_from_axis(self, coordinate: Array) -> Flags:
        """True where the pressure is known to fall from the axis to the contact edge.

        The pressure falls if g'(x)/x does not increase, or if its increase is small enough. Source:
        notes, §7.
        """
        return coordinate < 0

    def axis_stress(self, coordinate: Array) -> Array:
        """Stress integral at the axis of each contact, (1/pi) int_0^a g'(x)/x dx [1]."""
        stress = self._integral(lambda s: self.depth_slope(s) / self.contact_radius(s), coordinate)
        return stress / np.pi

    def pressure_kernel(self, annulus: Annulus, radius: Array) -> Array:
        """Stress integral (1/pi) int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx [1].

        Source: mdr-5, Eqs. (5.68), (5.70), (5.79).

        Parameters
        ----------
        annulus : a and c in the contact coordinate.
        radius : radii 0 <= r < a [length], shape (m,).
        """
        axis = (radius == 0) & (annulus.inner == 0)
        places = np.where(axis, annulus.outer, radius)
        total = stress_integral(self.branches, annulus, places) / np.pi
        if some(axis):
            total[axis] = self.axis_stress(annulus.at(axis).outer)
        return total

    def pressure_kernel_at(self, annulus: Annulus, coordinate: Array) -> Array:
        """Stress integral at places given as contact coordinates, zero at the edge [1].

        Beyond a flat a radius is less accurate than its contact coordinate.

        Parameters
        ----------
        annulus : see `pressure_kernel`.
        coordinate : contact coordinates up to the coordinate of a, shape (m,).
        """
        r, values = self.contact_radius(coordinate), np.zeros(coordinate.shape)
        inside = r < self.contact_radius(annulus.outer)
        values[inside] = self.pressure_kernel(annulus.at(inside), r[inside])
        return values
