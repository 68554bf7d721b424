"""Estimated errors of the flat model: bodies of finite size, slopes, radial displacement, walls.

Source: hay; dimitriadis; notes, §8.
"""

from typing import Final, NamedTuple, Protocol

import numpy as np

from mdr_core.elementwise import every, full, some, where
from mdr_core.layer_response import softening
from mdr_core.materials import Layer, Material
from mdr_core.profiles import Profile
from mdr_core.quadrature import composite_rule
from mdr_core.typing import Array, Flags, Parameter

# Relative error due to the neglected radial displacement, over |beta| and the slope of a cone.
# Source: hay, F/F_Sneddon to first order; a paraboloid has three quarters.
_RADIAL: Final = 0.63
ASSUMED_RATIO: Final = 0.3
"""Poisson's ratio of most metals, assumed where the bodies are unknown, and Dundurs' beta."""
_ASSUMED_BETA: Final = (1 - 2 * ASSUMED_RATIO) / (2 * (1 - ASSUMED_RATIO))
# Coefficient of a paraboloid in terms of a/R, 3/(2 pi). Source: notes, §8.
_RADIAL_ROUND: Final = 0.477
# Compliance that a half-space lacks, over its own 0.46/(E b): a cylinder of radius b and
# length 6 b has L/(pi E b^2).
_WALL: Final = 3.0
# Increase of the force at a given depth to first order, over a/R and the share of a body in the
# compliance, by how the body is held. Source: notes, §8.
_HELD: Final = {"contacts": 0.6, "stem": 0.85, "free": 1.1, "block": 0.0}
# Coefficient of a socket in a block.
_SOCKET: Final = 0.6
# Error of the force on a bonded layer, over the slope at the edge: s y/(1 + l y) (nu/(1 - nu))^c,
# y = (a/h)^2. It fits -0.003, -0.083 and -0.88 at a/h 0.1, 0.5 and 2 for nu = 1/2, and -0.12 at
# 2 for nu = 0.3. The constants are s, l and c.
# Source: manual, Contact with a layer, finite elements.
_SQUEEZED, _LEVELS, _COMPRESSIBLE = 0.32, 0.114, 2.5

# w at which 1 - L is below the rounding error.
_WAVES: Final = 22.0


class LoadedContact(Protocol):
    """Attributes of a normal contact on which its validity depends."""

    @property
    def profile(self) -> Profile: ...
    @property
    def e_star(self) -> Parameter: ...
    @property
    def contact_radius(self) -> Array: ...
    @property
    def mean_pressure(self) -> Array: ...
    @property
    def loaded(self) -> Flags: ...
    @property
    def material(self) -> Material: ...
    @property
    def half_space_errors(self) -> "Errors": ...


class Errors(NamedTuple):
    """Estimated relative errors due to the model, a flat half-space or layer, for each load [1]."""

    parts: tuple[Array, ...]
    """Parts of the error of the force at a given depth, which exceeds the error of the depth under
    a given force. Their causes: the finite size of round bodies, the neglected radial displacement,
    the slope, and the side wall of an elastic punch."""
    steepness: Array
    """Slope at the contact edge, or largest a/R of round bodies."""
    radius: Array | None = None
    """Error of the contact radius under a given force; None where the bodies are not round."""
    pressure: Array | None = None
    """Error of the largest pressure under a given force; None where the bodies are not round."""

    @property
    def force(self) -> Array:
        """Error of the force at a given depth."""
        size, radial, slope, wall = self.parts
        return size + radial + slope + wall


def errors(contact: LoadedContact) -> Errors:
    """Return the estimated errors of a contact; Poisson's ratio 0.3 stands for unknown bodies."""
    known = contact.material.dundurs_beta
    beta = abs(_ASSUMED_BETA if known is None else known)
    if contact.profile.body_radii is not None:
        return _of_round_bodies(contact, beta)
    slope = _edge_slope(contact)
    radial = _RADIAL * beta * slope + _on_layer(contact)
    return Errors((0 * slope, radial, slope * slope, _wall_error(contact) + 0 * slope), slope)


def _of_round_bodies(contact: LoadedContact, beta: float) -> Errors:
    """Errors of two round bodies, of first order in x_i = a/|R_i|, s_i their shares in 1/E*.

    With X = sum k_i s_i x_i, the slope S = |x_1 s_2 +- x_2 s_1| of the common surface (+ in a
    socket) and m = max(x_1 s_2, x_2 s_1), the force at a given depth has the relative error
    X + X^2 + 3/(2 pi) |beta| S + 0.1 S^2, the contact radius under a given force
    0.015 sum s_i x_i + 0.1 |beta| m + 0.05 max x_i^2, and the largest pressure
    0.04 sum s_i x_i + 0.3 |beta| m + 0.4 S^2. Source: notes, §8.
    """
    bodies, radii = contact.material, contact.profile.body_radii or ()
    x1, x2 = (contact.contact_radius / np.abs(radius) for radius in radii)
    k1, k2 = (
        max(_HELD[held], _SOCKET * is_concave(radius))
        for held, radius in zip(bodies.held, radii, strict=True)
    )
    sign = 1 if any(map(is_concave, radii)) else -1
    found = []
    # Either of two unknown bodies may be the elastic one.
    for s1 in (1.0, 0.0) if bodies.profile_share is None else (bodies.profile_share,):
        s2 = 1 - s1
        size, mean = k1 * s1 * x1 + k2 * s2 * x2, s1 * x1 + s2 * x2
        largest, steepest = np.maximum(x1 * s2, x2 * s1), np.maximum(x1, x2)
        common = abs(x1 * s2 + sign * x2 * s1)
        radial = _RADIAL_ROUND * beta * common + _on_layer(contact)
        force = size + size**2, radial, 0.1 * common**2, 0.0 * size
        radius = 0.015 * mean + 0.1 * beta * largest + 0.05 * steepest**2
        pressure = 0.04 * mean + 0.3 * beta * largest + 0.4 * common**2
        found.append((*force, steepest, radius, pressure))
    *parts, steepest, radius, pressure = np.max(found, axis=0)
    return Errors(tuple(parts), steepest, radius, pressure)


def is_concave(radius: Parameter) -> bool:
    """Return True for the radius of a socket, which is a single number."""
    return isinstance(radius, float) and radius < 0


def layer(contact: LoadedContact) -> tuple[Array, Array]:
    """Return a/h of a body of thickness h, bonded to a rigid base, and its relative error [1].

    The base reduces the depth by alpha F_N/(pi E* h), to first order in a/h, with the source's
    approximation of alpha(nu), and by the share of the more compliant body. The force increases by
    x + x^2, x = (2/pi) alpha a/h, to the second.

    Source: dimitriadis; notes, §8.
    """
    thickness = contact.material.body_thickness
    if thickness is None:
        return 0 * contact.contact_radius, 0 * contact.contact_radius
    part = contact.contact_radius / thickness
    x = _base(contact.material) * part
    return part, x + x * x


def _softer_share(material: Material) -> float:
    """Share of the more compliant body in the compliance, the whole if it is unknown [1]."""
    first = material.profile_share
    return 1.0 if first is None else max(first, 1 - first)


def _base(material: Material) -> float:
    """x over a/h. Source: dimitriadis; see `layer`."""
    nu = largest_ratio(material)
    return _softer_share(material) * 2 / np.pi * (1.2876 - 1.4678 * nu + 1.3442 * nu**2) / (1 - nu)


def thickness_at_a_force(contact: LoadedContact, h: float) -> Array:
    """Relative error of radius and pressure under a force due to a rigid base at depth h [1].

    (2/3) (s/pi) (a/h)^3 int_0^oo (1 - L) w^2 dw, to first order in (a/h)^3, with the share s of the
    more compliant body. Source: manual, Contact with a layer.
    """
    base = Layer(1.0, "bonded", largest_ratio(contact.material))
    shares, weights = composite_rule(32, 2)
    w = _WAVES * shares
    moment = float(_WAVES * weights @ (softening(base, w) * w * w))
    part = contact.contact_radius / h
    return np.asarray(2 / 3 * _softer_share(contact.material) / np.pi * moment * part**3)


def stiffening(tolerance: float, material: Material) -> float:
    """Return a/h at which the base increases the force at a given depth by a tolerance [1]."""
    return float((np.sqrt(1 + 4 * tolerance) - 1) / (2 * _base(material)))


def _on_layer(contact: LoadedContact) -> Parameter:
    """Relative error of the force due to the radial displacement of a layer, 0 without one [1].

    Over the slope at the edge it is 0.3 (a/h)^2 on thin bonded incompressible layers, and far less
    on compressible ones. Source: manual, Contact with a layer, finite elements.
    """
    if (layer := contact.material.layer) is None:
        return 0.0
    part = contact.contact_radius / layer.thickness
    nu = ASSUMED_RATIO if layer.poissons_ratio is None else max(layer.poissons_ratio, 0.0)
    bent = _SQUEEZED * part**2 / (1 + _LEVELS * part**2)
    return np.asarray(bent * (nu / (1 - nu)) ** _COMPRESSIBLE * _edge_slope(contact))


def largest_ratio(material: Material) -> float:
    """Poisson's ratio, the larger one of two bodies, assumed where they are unknown [1]."""
    return max(material.poissons_ratios, default=ASSUMED_RATIO)


def _edge_slope(contact: LoadedContact) -> Array:
    """f'(a) of loaded contacts, else zero [1]."""
    a, loaded = contact.contact_radius, contact.loaded
    if contact.profile.is_flat_punch or not some(loaded):
        return full(0.0, a)
    # The slope at the tip, where nothing is loaded, may be infinite.
    inside = a if every(loaded) else np.where(loaded, a, np.max(a))
    return where(loaded, contact.profile.df(inside), 0.0)


def _wall_error(contact: LoadedContact) -> Parameter:
    """Estimated error due to the stress-free side wall of an elastic body with a flat end.

    The flank beyond the contact edge counts as far as it is steeper than at the edge, up to the
    slope 1, and the body by its share in the compliance. [1]
    """
    profile, a, share = contact.profile, contact.contact_radius, contact.material.profile_share
    if not share or not some(contact.loaded & (profile.first_radius > 0)):
        return 0.0
    reach = np.minimum(2 * a, profile.domain)
    flank = (profile.f(reach) - profile.f(a)) / a
    steeper = np.minimum(np.square(flank), 1.0) - np.square(_edge_slope(contact))
    return where(contact.loaded, _WALL * share * np.maximum(steeper, 0.0), 0.0)
