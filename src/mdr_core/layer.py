"""Normal and adhesive contact of any profile with an elastic layer on a rigid base.

The contact of radius a is that of a half-space with the same radius, and a smooth correction v of
its foundation load, q = E* [g(a) - g(x) + v(x)], v(a) = 0:

    v(x) = int_0^a [K(x, t) - K(a, t)] q(t)/E* dt,    d = g(a) - int_0^a K(a, t) q(t)/E* dt,
    K(x, t) = (2/(pi h)) s int_0^oo [1 - L(w)] cos(w x/h) cos(w t/h) dw,

where s is the share of the layer in the compliance. A flat punch has q = E* d q1, (I - K) q1 = 1,
and S = dF_N/dd = 2 E* int_0^a q1 dx. v and q1 are even polynomials in x, and the integral over the
profile consists of the moments of g' with Chebyshev's polynomials.

Source: lebedev; hayes; notes, §19.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, pi, sqrt
from typing import Any, ClassVar, Final, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebval
from numpy.typing import ArrayLike
from scipy.special import j0

from mdr_core import adhesion, materials, validation
from mdr_core.abel.displacement import Kernel
from mdr_core.doubles import EPS
from mdr_core.elementwise import full, in_blocks, where
from mdr_core.equivalent_1d import coordinate_from_radius
from mdr_core.errors import InputError
from mdr_core.extrema import largest_with
from mdr_core.inversion import invert
from mdr_core.materials import Layer, Material
from mdr_core.normal import CONTROLS, NormalContact
from mdr_core.normal import solve as solve_half_space
from mdr_core.profiles import FlatPunch, Profile
from mdr_core.quadrature import composite_rule
from mdr_core.typing import Array, Indices

LARGEST: Final = 10.0
"""Largest contact radius over the thickness."""
# w at which 1 - L is below the rounding error, and points of Gauss's rule on each of its pieces, one
# more for each a/h, which resolve cos(2 w a/h).
_WAVES, _POINTS = 22.0, 32
# Least number of polynomials, and ln(1/EPS)/2: K is analytic up to 2h from the real axis.
_LEAST, _DIGITS = 16, 18.4
# Distance from the contact over the thickness at which its displacement is below rounding error: it
# decays at least as exp(-1.5 r/h).
_FAR: Final = 30.0
# Contact radius over the thickness below which the layer changes a contact by a few per cent.
_THICK: Final = 0.03
# Contact radius at a depth over that of a half-space, at most: 2 of a thin incompressible layer.
_DEEPER: Final = 4.0
# Rounding error of the solved equation, over its condition; 20 random cases have a quarter of it.
_ROUNDING: Final = 2e-13


class _States(NamedTuple):
    """Contacts with a layer over E*, all (m,) but the last two, (n, m)."""

    depth: Array
    force: Array
    stiffness: Array
    energy: Array
    edge: Array
    """q1(a)."""
    edge_growth: Array
    """a dq1(a)/da."""
    depth_slope: Array
    """dd/da at the contact edge."""
    condition: Array
    """Amplification of rounding errors."""
    correction: Array
    """Chebyshev coefficients of the foundation load over E* beyond a half-space's, over
    2 (x/a)^2 - 1."""
    loads: Array
    """Parts of int_0^a q dx/E* at the zeros of T_2n(x/a) [length^2]."""


def softening(layer: Layer, w: Array) -> Array:
    """Return 1 - L(w), by which the layer's response to a wave differs from a half-space's [1]."""
    if layer.base == "frictionless":
        return (1 + 2 * w - np.exp(-2 * w)) / (np.sinh(2 * w) + 2 * w)
    if layer.poissons_ratio is None:
        raise InputError(("material", "poissons_ratio"), "is needed for a layer on a bonded base")
    kappa = 3 - 4 * layer.poissons_ratio
    both = 1 + kappa**2 + 4 * w * w
    return (2 * kappa * np.exp(-2 * w) + both + 4 * w) / (2 * kappa * np.cosh(2 * w) + both)


def _waves(layer: Layer, reach: float) -> tuple[Array, Array]:
    """Wave numbers times h, and weights of (2/pi) s [1 - L]; for places up to `reach` times h."""
    shares, weights = composite_rule(_POINTS, 2 + ceil(reach))
    w = _WAVES * shares
    return w, 2 / pi * layer.share * _WAVES * weights * softening(layer, w)


def _states(profile: Profile, layer: Layer, coordinate: Array) -> _States:
    """Contacts at contact coordinates (m,)."""
    part = profile.contact_radius(coordinate) / layer.thickness
    # Contacts with about as many polynomials together, in blocks of bounded size.
    size = 2 ** np.ceil(np.log2(np.maximum(part, 1.0)))
    found: list[tuple[Indices, _States]] = []
    for most in np.unique(size):
        index = np.flatnonzero(size == most)
        count = max(ceil(_DIGITS / np.arcsinh(2 / min(most, LARGEST))) + 4, _LEAST)
        for block in in_blocks(index.size, count * count):
            own = index[block]
            found.append((own, _block(profile, layer, coordinate[own], count, most)))
    if len(found) == 1:
        return found[0][1]
    modes = max((len(states.correction) for _, states in found), default=0)
    sizes = [(part.size,)] * (len(_States._fields) - 2) + [(modes, part.size)] * 2
    whole = _States(*map(np.zeros, sizes))
    for own, states in found:
        for every, each in zip(whole, states, strict=True):
            every[: len(each) if every.ndim > 1 else None][..., own] = each
    return whole


def _block(
    profile: Profile, layer: Layer, coordinate: Array, count: int, largest: float
) -> _States:
    """Contacts with so many polynomials, for contact radii up to `largest` times h."""
    a, modes = profile.contact_radius(coordinate), np.arange(count)
    part = a / layer.thickness
    angle = _angles(count)
    # From values at x = a cos(angle) to coefficients of T_2k(x/a).
    to_modes = 2 / count * np.cos(np.multiply.outer(2 * modes, angle))
    to_modes[0] /= 2
    whole, rise = 1 / (1 - 4 * modes**2) @ to_modes, 4 * modes**2 @ to_modes
    w, strength = _waves(layer, largest)
    places = np.append(np.cos(angle), 1.0)
    waves = np.cos(part[:, None, None] * np.multiply.outer(places, w))
    kernel = part[:, None, None] * (waves * strength) @ waves.swapaxes(1, 2)
    inside, edge = kernel[:, :-1, :-1] * whole, kernel[:, -1, :-1] * whole
    unit = np.eye(count)
    ends = np.stack([np.ones_like(edge), kernel[:, :-1, -1]], axis=2)
    punch, moved = np.moveaxis(np.linalg.solve(unit - inside, ends), 2, 0)
    q1 = 1 + _dot(edge, punch)
    stiffness = 2 * a * (punch @ whole)
    growth = punch @ rise + q1 * (kernel[:, -1, -1] + _dot(edge, moved))
    condition = stiffness / where(a > 0, 2 * a, 1.0) + 0 * part
    if profile.has_no_partial_slip:
        depth = profile.depth(coordinate)
        force, correction = depth * stiffness, depth[:, None] * (punch - 1)
        weights = depth[:, None] * whole
        energy, slope = depth * force / 2, full(0.0, depth)
    else:
        start = full(1.0, a) * profile.first_radius
        rates = profile.annulus_integrals(start, a - start, *_odd_polynomials(count + 1)).T
        rates = rates / np.arange(1, 2 * count + 2, 2)
        moments = np.concatenate([rates[:, :1], (rates[:, 1:-1] - rates[:, :-2]) / 2], axis=1)
        weights = moments @ to_modes
        depth, force = profile.depth(coordinate), profile.reduced_force(coordinate)
        source = _dot(kernel[:, :, :-1], weights[:, None, :])
        relative = inside - edge[:, None, :]
        correction = np.linalg.solve(unit - relative, (source[:, :-1] - source[:, -1:])[..., None])
        correction = correction[..., 0]
        sinking = source[:, -1] + _dot(edge, correction)
        added = a * (correction @ whole)
        energy = profile.reduced_energy(coordinate) + a * _dot(weights, correction)
        energy = energy - sinking * (force / 2 + added)
        left = depth - sinking
        condition = condition * where(left > 0, depth / where(left > 0, left, 1.0), 1.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = (profile.depth_slope(coordinate) - correction @ rise / a) / q1
        depth, force = depth - sinking, force + 2 * added
    return _States(
        *(depth, force, stiffness, energy, q1, growth, slope, condition),
        to_modes @ correction.T,
        (a[:, None] * (weights + whole * correction)).T,
    )


def _angles(count: int) -> Array:
    """Angles of the positive zeros cos(angle) of T_2n."""
    return pi * (2 * np.arange(count) + 1) / (4 * count)


def _dot(left: Array, right: Array) -> Array:
    return np.asarray((left * right).sum(axis=-1))


def _odd_polynomials(count: int) -> list[Kernel]:
    """Chebyshev's polynomials T_1, T_3, ... of x/a, root = sqrt(a^2 - x^2), called in this order.

    T_(k+2) = 2 T_2 T_k - T_(k-2) takes a fifth of the time of cosines.
    """
    last: list[Array] = []

    def first(x: Array, root: Array) -> Array:
        t = x / np.hypot(x, root)
        last[:] = 4 * t * t - 2, t, t
        return t

    def following(_x: Array, _root: Array) -> Array:
        twice, before, value = last
        last[1:] = value, twice * value - before
        return last[2]

    return [first] + [following] * (count - 1)


@dataclass(frozen=True, repr=False, kw_only=True)
class LayerContact(NormalContact):
    """Profile pressed into an elastic layer on a rigid base, under any number of loads."""

    layer: Layer
    unusable: ClassVar[str] = f"a layer {materials.UNUSABLE}"

    @cached_property
    def half_space(self) -> NormalContact:
        """Contact of a half-space with the same contact coordinate."""
        known = self.profile, self.e_star, self.coordinate, "contact_radius", self.material
        vars(contact := NormalContact(*known))["contact_radius"] = self.contact_radius
        return contact

    @cached_property
    def states(self) -> _States:
        """Results over E*, of flattened loads."""
        return _states(self.profile, self.layer, np.ravel(self.coordinate))

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
        if self.profile.has_no_partial_slip:
            return self.half_space.maximum_pressure
        part = largest_with(self.profile, self.coordinate, self.loaded, self.correction)
        return where(self.loaded, self.e_star * part, 0.0)

    def correction(self, load: Indices, radius: Array) -> Array:
        """Pressure over E* beyond that of the half-space, each under the load of an index [1].

        With the foundation load y(x) beyond that of the half-space over E*,
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
        jump = found.sum(axis=0) if self.profile.has_no_partial_slip else 0.0
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

        (2/pi) int_0^a q(t)/E* [1/sqrt(r^2 - t^2) - int_0^oo s (1 - L) cos(w t/h) J_0(w r/h) dw/h] dt.
        """
        a, h = float(np.ravel(self.contact_radius)[load]), self.layer.thickness
        shares, weights = composite_rule(_POINTS)
        angle = np.arcsin(a / radius) * shares[:, None]
        smooth = self.load_correction(np.array([load]), radius * np.sin(angle))
        whole = half_space + 2 / pi * np.arcsin(a / radius) * (weights @ smooth)
        only = _states(self.profile, self.layer, np.ravel(self.coordinate)[[load]])
        reach = a / h + _FAR
        w, strength = _waves(self.layer, reach)
        places = a / h * np.cos(_angles(len(only.loads)))
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
        return full(0.0, self.coordinate) + (self.control != "contact_radius") * self.error_estimates


class Curve(adhesion.Curve):
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
        return _largest(self.profile, self.layer)

    def pressed(self, *known: Any) -> NormalContact:
        """Return a contact without adhesion; `known` are the arguments of `NormalContact`."""
        return LayerContact(*known, layer=self.layer)

    def correction(self, contact: adhesion.AdhesiveContact, load: Indices, r: Array) -> Array:
        """Pressure over E* beyond that of a half-space at radii, each under the load of an index."""
        radii, retraction = map(np.ravel, (contact.contact_radius, contact.retraction))
        parts = contact.reference, self.pressed(FlatPunch(radii), 1.0, retraction)
        whole, punch = (part.correction(load, r) for part in parts)
        return np.asarray(whole - punch)

    @cached_property
    def _node_states(self) -> _States:
        return _states(self.profile, self.layer, self._nodes)

    def _states(self, coordinate: Array) -> tuple[_States, tuple[int, ...]]:
        if coordinate is vars(self).get("_nodes"):
            return self._node_states, coordinate.shape
        return _states(self.profile, self.layer, np.ravel(coordinate)), np.shape(coordinate)

    def stiffness(self, coordinate: Array) -> Array:
        """dF_N/dd over E* at constant contact radius [length]."""
        states, shape = self._states(coordinate)
        return states.stiffness.reshape(shape)[()]

    def retraction(self, coordinate: Array) -> Array:
        """Delta_l = c sqrt(a)/q1(a) [length]."""
        states, shape = self._states(coordinate)
        return super().retraction(coordinate) / states.edge.reshape(shape)[()]

    def load(self, name: str, coordinate: Array) -> Array:
        """Depth or F_N/E*."""
        states, shape = self._states(coordinate)
        retraction = super().retraction(np.ravel(coordinate)) / states.edge
        if name == "indentation_depth":
            return np.asarray(states.depth - retraction).reshape(shape)[()]
        return np.asarray(states.force - states.stiffness * retraction).reshape(shape)[()]

    def excess(self, share: float, coordinate: Array) -> Array:
        """Slope of the load in a, over c/sqrt(a) and, of a force, the punch's stiffness [1]."""
        states, shape = self._states(coordinate)
        a = self.profile.contact_radius(np.ravel(coordinate))
        with np.errstate(all="ignore"):
            excess = states.depth_slope * np.sqrt(a) / self.c - 1 / (2 * states.edge)
            excess = excess + states.edge_growth / states.edge**2
            if share > 1:
                excess = excess - 2 * a * states.edge / states.stiffness
        return excess.reshape(shape)[()]


def _largest(profile: Profile, layer: Layer) -> float:
    """Contact coordinate of the largest contact."""
    return float(profile.coordinate_from_radius(np.minimum(profile.domain, LARGEST * layer.thickness)))


def solve(
    profile: Profile,
    material: Material,
    *,
    indentation_depth: ArrayLike | None = None,
    normal_force: ArrayLike | None = None,
    contact_radius: ArrayLike | None = None,
    work_of_adhesion: float | None = None,
    range_of_adhesion: float = 0.0,
) -> LayerContact | adhesion.AdhesiveContact:
    """Return the contact with an elastic layer under a prescribed depth, force or contact radius.

    Parameters
    ----------
    profile : any kind, with single numbers as parameters.
    material : material with a `layer`, as from `from_bodies`.
    indentation_depth, normal_force, contact_radius : see `normal.solve`.
    work_of_adhesion, range_of_adhesion : see `adhesion.solve`; without adhesion by default.

    Raises
    ------
    InputError : a contact radius above 10 times the thickness, a bonded layer without Poisson's
        ratio, or what `normal.solve` and `adhesion.solve` reject.

    Examples
    --------
    A gel of the thickness 4 um on glass is 2.5 times as stiff as a half-space at this depth.

    >>> from mdr_core.materials import from_bodies, Body, RIGID
    >>> from mdr_core.profiles import Paraboloid
    >>> gel = from_bodies([RIGID, Body(2e3, 0.5)], layer=Layer(4e-6, "bonded"))
    >>> contact = solve(Paraboloid(5e-6), gel, indentation_depth=1e-6)
    >>> [float(f"{value:.6g}") for value in (contact.contact_radius, contact.normal_force)]
    [2.82794e-06, 1.90928e-08]
    """
    validation.require_type("profile", profile, Profile, "a profile such as Paraboloid(0.01)")
    validation.require_single_profile(profile.swept)
    validation.require_type("material", material, Material, "a Material with a layer")
    layer, e_star = material.layer, material.e_star
    if layer is None:
        raise InputError(("material", "layer"), "is needed")
    validation.require_single_positive(("material", "e_star"), e_star)
    loads = dict(zip(CONTROLS, (indentation_depth, normal_force, contact_radius), strict=True))
    softening(layer, np.ones(1))
    if work_of_adhesion is not None:
        validation.require_single_positive(("material", "work_of_adhesion"), work_of_adhesion)
        c = sqrt(2 * pi) * sqrt(work_of_adhesion) / sqrt(e_star)
        curve = Curve(profile, c, layer)
        return adhesion.on_curve(curve, e_star, material, loads, range_of_adhesion)
    # Checks the loads as well.
    name, load = validation.only_one(("load",), loads)
    coordinate = _coordinate(profile, layer, name, load / e_star if name == CONTROLS[1] else load)
    contact = LayerContact(profile, e_star, coordinate, name, material, layer=layer)
    vars(contact)[name] = load
    return contact


def _coordinate(profile: Profile, layer: Layer, name: str, load: Array) -> Array:
    """Contact coordinate under loads, forces over E*."""
    validation.require_not_negative(("load", name), load)
    validation.require_finite(("load", name), load)
    of_force, reach = name == "normal_force", LARGEST * layer.thickness
    end, start = np.inf, load
    if name == "contact_radius":
        start = coordinate_from_radius(profile, load)
        beyond = np.asarray(load > reach)
    elif profile.has_no_partial_slip:
        start = load / _states(profile, layer, np.ones(1)).stiffness[0] if of_force else load
        beyond = np.asarray(profile.contact_radius(start) > reach)
    else:
        end, most = _largest(profile, layer), (profile.largest_loads or (np.inf, np.inf))[of_force]
        start = solve_half_space(profile, 1.0, **{name: np.minimum(load, most)}).coordinate
        beyond = np.asarray(start < 0)
        if np.max(start) * _DEEPER > end:
            last = _states(profile, layer, np.atleast_1d(end))
            beyond = np.asarray(load > (last.force if of_force else last.depth)[0])
    if beyond.any():
        detail = (
            f"leads to a contact radius beyond {min(reach, float(profile.domain)):.6g}, where the "
            f"profile ends or the contact exceeds {LARGEST:g} times the thickness: reduce the "
            "load, or use finite elements"
        )
        raise InputError(("load", name, *validation.first_index(beyond)), detail, beyond)
    if end == np.inf:
        return start

    def sloped(s: Array) -> tuple[Array, Array]:
        states = _states(profile, layer, np.ravel(s))
        value, slope = states.depth, states.depth_slope
        if of_force:
            value, slope = states.force, states.stiffness * slope
        shape = np.shape(s)
        return value.reshape(shape)[()], (np.ravel(s) * slope / value).reshape(shape)[()]

    start = np.minimum(where(start > 0, start, end), end)
    return invert(sloped, load, start, full(0.0, start), full(end, start), "layer")
