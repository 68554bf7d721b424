"""What every profile answers, and the one generic route for what a kind does not know."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from math import inf
from typing import Any, ClassVar, Final

import numpy as np

from mdr_core import checks
from mdr_core.abel.displacement import Branch, slope_integral
from mdr_core.abel.stress import StressPanels
from mdr_core.checks import first_index
from mdr_core.errors import InputError
from mdr_core.lazy import cached_property
from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array, Flags, Parameter

# The answers of a normal query, in the words of `Profile.closed_forms`.
NORMAL_ANSWERS: Final = (
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "mean_pressure",
    "normal_stiffness",
    "elastic_energy",
)
# Below the last _DECAY of w lies exp(-2 _DECAY) of the energy: less than rounding.
_DECAY: Final = 20.0
# Rule and piece: the integrand grows at most like exp(5 w), the bound is 1e-17 (quadrature).
_POINTS: Final = 16
_PIECE: Final = 1.5
_BLOCK: Final = 12_288
_NO_BREAKS: Final = np.empty(0)
# Within these a product of a few factors is a double with all its digits.
SMALLEST_HELD: Final = 1e-300
LARGEST_HELD: Final = 1e300
# Of factors within these, some of them cubed or squared, even an energy is a double.
ORDINARY: Final = (1e-30, 1e30)
NOWHERE: Final = (inf, 0.0)


def require_positive(name: str, value: Parameter) -> None:
    """Raise InputError unless the profile's parameter is positive and finite."""
    checks.require_positive(("profile", name), value)


def refuse_load(name: str, bad: Flags) -> None:
    """Raise InputError where depth or force would overflow, or vanish under a load that is none.

    Next to the smallest double a number has few digits or none, which no error estimate says.
    """
    if bad.any():
        raise InputError(
            ("load", name, *first_index(bad)),
            "the depth or the force that goes with this load leaves the range of double precision",
            bad,
        )


class Profile(ABC):
    """A rigid axisymmetric profile f(r) and its one-dimensional image g(x).

    The edge of the contact is described by the kind's *contact coordinate*, one number in which
    radius, depth and force all keep their digits: the radius a itself, or sqrt(a^2 - b^2) behind
    a flat of radius b, where a alone would lose them. It is zero at zero load.

    Parameters of the closed-form kinds may be arrays over the scenes of a sweep; they broadcast
    with the loads.
    """

    kind: ClassVar[str]
    formula: ClassVar[str]
    # The answers that are closed form; the rest is quadrature.
    closed_forms: ClassVar[tuple[str, ...]]
    # Bound on the relative rounding error of the closed forms.
    rounding: float = 3e-14

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters by name of a profile that is no more than they are, else none."""
        names: tuple[str, ...] = getattr(self, "__match_args__", ())
        return {name: getattr(self, name) for name in names}

    @property
    def swept(self) -> tuple[str, ...]:
        """Names of the parameters that are arrays over the scenes of a sweep."""
        return tuple(
            name
            for name, value in self.parameters.items()
            if isinstance(value, np.ndarray) and value.ndim
        )

    @cached_property
    def ordinary_coordinates(self) -> tuple[float, float]:
        """Contact coordinates between which no answer leaves the range of doubles.

        Parameters that are arrays are taken for ordinary ones.
        """
        single = [value for value in self.parameters.values() if isinstance(value, (int, float))]
        return ORDINARY if all(ORDINARY[0] < one < ORDINARY[1] for one in single) else NOWHERE

    @property
    def normal_method(self) -> str:
        """The dearest route among the answers of a normal query."""
        return "closed_form" if set(NORMAL_ANSWERS) <= set(self.closed_forms) else "quadrature"

    @property
    def tangential_method(self) -> str:
        """The dearest route among the answers of a tangential query."""
        closed = "closed_form" if "slip" in self.closed_forms else "quadrature"
        return closed if self.normal_method == "closed_form" else self.normal_method

    @property
    def breaks(self) -> tuple[Parameter, ...]:
        """Radii where f' or one of its derivatives jumps [length]."""
        return ()

    @property
    def domain(self) -> Parameter:
        """Radius up to which the profile is defined and admissible [length]."""
        return inf

    @property
    def first_coordinate(self) -> float:
        """Contact coordinate at zero load."""
        return 0.0

    @property
    def last_coordinate(self) -> float | None:
        """Contact coordinate of the domain's end, None where there is none."""
        return None

    @abstractmethod
    def f(self, radius: Array) -> Array:
        """Shape f(r) [length]."""

    @abstractmethod
    def df(self, radius: Array) -> Array:
        """Slope f'(r) [1]; at a break, the limit from outside."""

    @abstractmethod
    def g(self, x: Array) -> Array:
        """Equivalent profile g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr [length]."""

    @abstractmethod
    def dg(self, x: Array) -> Array:
        """Its derivative g'(x) [1]; infinite at a break where f' jumps."""

    def coordinate_from_radius(self, contact_radius: Array) -> Array:
        """Contact coordinate of a contact radius."""
        return contact_radius

    def contact_radius(self, coordinate: Array) -> Array:
        """Contact radius a [length]."""
        return coordinate

    def depth(self, coordinate: Array) -> Array:
        """Indentation depth d = g(a) [length]."""
        return self.g(coordinate)

    def depth_slope(self, coordinate: Array) -> Array:
        """Derivative of the depth with respect to the contact coordinate."""
        return self.dg(coordinate)

    def depth_slope_behind(self, coordinate: Array, start: Array, past: Array) -> Array:
        """`depth_slope` at start + past, by the digits of `past` where a kink lies at `start`."""
        return self.depth_slope(coordinate)

    def radius_slope(self, coordinate: Array) -> Array:
        """Derivative of the contact radius with respect to the contact coordinate."""
        return np.ones_like(coordinate)

    @abstractmethod
    def reduced_force(self, coordinate: Array) -> Array:
        """F_N / E* = 2 int_0^a x g'(x) dx [length^2]."""

    def coordinate_from_depth(self, depth: Array) -> Array | None:
        """Inverse of `depth` where it is closed, else None."""
        return None

    def coordinate_from_reduced_force(self, reduced_force: Array) -> Array | None:
        """Inverse of `reduced_force` where it is closed, else None."""
        return None

    @property
    def scale(self) -> Parameter:
        """Contact coordinate at which the profile changes its character."""
        raise NotImplementedError(f"a {self.kind} has no scale: it inverts in closed form")

    def reduced_energy(self, coordinate: Array) -> Array:
        """Elastic energy / E* = int_0^a (d - g)^2 dx = int_0^d F/E* dd [length^3]."""
        return energy_integral(
            lambda s: self.reduced_force(s) * self.depth_slope(s), coordinate, self.scale
        )

    @property
    def coordinate_breaks(self) -> Array:
        """Contact coordinates inside a contact where the depth's slope is not smooth, ascending.

        Of a sweep the one of each scene, or none.
        """
        return _NO_BREAKS

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        """Radii where every contact that reaches them has an infinite pressure [length].

        Of a sweep those of each scene; infinite for a scene that has none.
        """
        return ()

    @property
    def steepness(self) -> float:
        """Highest power that g resembles over a stretch of the contact: how fine to resolve it."""
        return 3.5

    @property
    def tip_exponent(self) -> float:
        """Lowest power with which g leaves the axis: how far towards it to resolve."""
        return 1.0

    @property
    def slips_at_once(self) -> bool:
        """No slip annulus exists: the contact sticks wholly until it slides."""
        return False

    def coordinate_width(self, a: Array, c: Array, s_a: Array, s_c: Array) -> Array:
        """s_a - s_c of two contact radii a >= c, with the digits of a - c."""
        return a - c

    def radius_width(self, s_a: Array, width: Array) -> Array:
        """a - c, from the difference of the contact coordinates."""
        return width

    def stick_from_force_ratio(
        self, coordinate: Array, ratio: Array, rest: Array
    ) -> tuple[Array, Array] | None:
        """Stick edge at F_x/(mu F_N) = ratio = 1 - rest, and its width, where closed, else None.

        Both in the contact coordinate. Source: mdr-5, Eqs. (5.16), (5.31), (5.49).
        """
        return None

    def stick_from_depth_ratio(
        self, coordinate: Array, ratio: Array, rest: Array
    ) -> tuple[Array, Array] | None:
        """The same at u_x/u_x,max = ratio. Source: mdr-5, Eqs. (5.12), (5.29), (5.47)."""
        return None

    def force_step(self, coordinate: Array, width: Array, stick: Array) -> Array | None:
        """F(a)/E* - F(c)/E* where it is closed without cancellation, else None.

        `stick` = coordinate - width, with the digits that the difference may not have.
        """
        return None

    def depth_step(self, coordinate: Array, width: Array, stick: Array) -> Array | None:
        """d(a) - d(c) where it is closed without cancellation, else None."""
        return None

    def slip_moment(self, coordinate: Array, width: Array, stick: Array) -> Array | None:
        """int_c^a (g(a) - g)(g - g(c)) dx [length^3] where it is closed; else NaN, or None."""
        return None

    @property
    def branches(self) -> tuple[Branch, ...]:
        """The stretches on which g' is smooth, but for the root at each one's start.

        A profile smooth from the axis on needs no more than g' itself.
        """
        return (Branch(0.0, lambda x, _s, _index: self.dg(x), steepness=self.steepness),)

    def panels(self, rtol: float) -> StressPanels | None:
        """g' as panels that are resolved to a tolerance, where that is what is known of it."""
        return None

    def slip_kernel(self, c: Array, r: Array, rtol: float) -> Array:
        """S(c; r) = (2/pi) int_c^r (g(x) - g(c))/sqrt(r^2 - x^2) dx [length], c <= r; (m,).

        S(0; r) is the profile itself. Source: mdr-5, Eqs. (5.40), (5.41).
        """
        value = slope_integral(self.branches, c, r, r, rtol, outside=False)
        return 2 / np.pi * value

    def outer_displacement(self, a: Array, r: Array, rtol: float, coordinate: float) -> Array:
        """(2/pi) int_0^a (d - g(x))/sqrt(r^2 - x^2) dx [length] for r >= a; shape (m,).

        Where a has no digits of what counts, the contact's coordinate has them.

        Source: mdr-5, Eq. (5.75), with the foundation's displacement d - g.
        """
        value = slope_integral(self.branches, np.zeros_like(r), a, r, rtol, outside=True)
        return 2 / np.pi * value

    @property
    def tip_pressure(self) -> Parameter:
        """Limit of mean pressure / E* as the load vanishes [1]: zero for smooth and blunt tips."""
        return 0.0

    @abstractmethod
    def pressure_kernel(
        self,
        coordinate: Array,
        radius: Array,
        rtol: float,
        width: Array | None = None,
        edge: Array | None = None,
        modulus: float = 1.0,
        inner: Array | None = None,
    ) -> Array:
        """(M/pi) int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx, for 0 <= r < a; M = `modulus`.

        All arrays have one shape (m,). The stick edge c is given by `width`, its distance from
        the contact's edge in the contact coordinate; None stands for c = 0. `edge` is the contact
        radius where it is what was given: then a - r is exact, otherwise the coordinate is.
        `inner` is c as a radius, where it is known as one: near it, c - r is exact.
        Source: mdr-5, Eqs. (5.68), (5.70), (5.79).
        """


def energy_integral(density: Callable[[Array], Array], upper: Array, scale: Parameter) -> Array:
    """Return int_0^upper density(s) ds for a positive density, a power of s at either end.

    With density = (F/E*) dd/ds this is the elastic energy without any cancellation.
    s = scale sinh(w) resolves it also where s is much larger than the scale.
    """
    scale = np.asarray(scale, dtype=float)
    top = np.arcsinh(upper / scale)
    length = np.minimum(top, _DECAY)
    # Every load has its own pieces, and its terms are summed in their order: it is answered
    # alike alone and among others.
    count = np.maximum(np.ceil(length / _PIECE), 1.0)
    nodes, weights = gauss_legendre(_POINTS)
    most = int(np.max(count, initial=1.0))
    places = (np.arange(most)[:, None] + (1 - nodes) / 2).ravel()
    weights = np.tile(weights, most)
    step = max(_BLOCK // max(top.size, 1), 1)
    total = np.zeros_like(top)
    for start in range(0, places.size, step):
        part = slice(start, start + step)
        fraction = np.divide.outer(places[part], count)
        own = fraction < 1
        w = top - np.where(own, fraction, 0.0) * length
        values = np.where(own, density(scale * np.sinh(w)) * np.cosh(w), 0.0)
        values *= weights[part].reshape(-1, *[1] * top.ndim)
        values[0] += total
        total = np.cumsum(values, axis=0)[-1] if len(values) > 1 else values[0]
    return np.asarray(total * scale * length / (2 * count))
