"""Limits of validity of the model: findings with stable codes.

The codes are `table_end`, `smoothed`, `tip`, `half_space`, `thin_body`, `layer_strain`, `plastic`,
`elastic_similarity` and `impossible_moduli`; `singular` and `accuracy` come with the results, and
`yield` from `mdr_core.subsurface`.

Source: notes, §8.
"""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from math import pi, sqrt
from typing import Final, NamedTuple, Protocol

import numpy as np

from mdr_core.elementwise import every, full, number, some, where
from mdr_core.errors import Notice, Remedy
from mdr_core.materials import Layer, Material
from mdr_core.profiles import Profile, Sphere, Tabulated
from mdr_core.results import Results
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import extremes

# Sizes above which each limit is reported; judgements.
_LIMITS: Final = {
    # Contact radius over the last radius of a table.
    "table_end": 0.95,
    # Deviation of a table's profile from its points over the depth.
    "smoothed": 1e-3,
    # Probability of a sharp tip where a table's profile is smooth, or the reverse.
    "tip": 0.025,
    # Relative error of the half-space approximation.
    "half_space": 0.01,
    # Contact radius over the thickness of a body.
    "thin_body": 0.1,
    # Depth over the thickness of a layer, the size of its strain.
    "layer_strain": 0.1,
    # |beta|, by which normal and tangential contact are coupled.
    "elastic_similarity": 0.05,
}
# Room for rounding: a cone of slope 0.1 on incompressible bodies has an error of one per cent.
_ROOM: Final = 1 + 1e-9
# Relative error by the neglected radial displacement, over |beta| and the slope of a cone. Source:
# hay, by F/F_Sneddon to first order; a paraboloid has three quarters.
_RADIAL: Final = 0.63
# Poisson's ratio of most metals, assumed where the bodies are unknown, and Dundurs' beta with it.
ASSUMED_RATIO: Final = 0.3
_ASSUMED_BETA: Final = (1 - 2 * ASSUMED_RATIO) / (2 * (1 - ASSUMED_RATIO))
# Compliance that a half-space lacks, over its own 0.46/(E b): that of a cylinder of radius b and
# length 6 b is L/(pi E b^2).
_WALL: Final = 3.0
# Error of the force on a bonded incompressible layer over the slope at the edge and (a/h)^2, its
# levelling off with (a/h)^2, and the power of nu/(1 - nu) by which it falls with compressibility:
# -0.003, -0.083 and -0.88 at a/h 0.1, 0.5 and 2 for nu = 1/2, and -0.12 at 2 for nu = 0.3.
# Source: manual, Contact with a layer, finite elements.
_SQUEEZED, _LEVELS, _COMPRESSIBLE = 0.32, 0.114, 2.5
# Relative change of forces at a given displacement by transverse slip, and of displacements under
# forces up to 0.998 of full slip, over (nu/(4 - 2 nu))^2. Source: notes, §8.
_TRANSVERSE: Final = 0.2
# Radii that a warning lists, so that it stays one sentence.
_LISTED: Final = 5
# Poisson's ratio of incompressible bodies.
_INCOMPRESSIBLE: Final = 0.5
# E*/G* of isotropic bodies with Poisson's ratios from -1 to 1/2.
_MODULI: Final = (0.75, 1.5)


class Finding(NamedTuple):
    """A limit of validity, and the cases that exceed it."""

    code: str
    where: Flags
    message: Callable[[], str]
    value: Parameter | None = None
    """Size in each case; see `Notice`."""
    limit: float | None = None
    instead: Remedy | None = None


def _above_limit(
    code: str, size: Array, message: Callable[[], str], instead: Remedy | None = None
) -> Finding:
    """Return the finding of the cases whose size is above the limit of a code."""
    limit = _LIMITS[code]
    return Finding(code, size > _ROOM * limit, message, size, limit, instead)


class LoadedContact(Protocol):
    """Attributes of a normal contact on which its validity depends."""

    @property
    def profile(self) -> Profile: ...
    @property
    def e_star(self) -> Parameter: ...
    @property
    def contact_radius(self) -> Array: ...
    @property
    def loaded(self) -> Flags: ...
    @property
    def material(self) -> Material | None: ...


class SolvedContact(Protocol):
    """A contact with or without friction, on whose bodies its validity depends."""

    @property
    def normal(self) -> LoadedContact: ...
    @property
    def g_star(self) -> Parameter | None: ...
    @property
    def slips_from(self) -> Parameter: ...
    @property
    def solved(self) -> "SolvedContact": ...
    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]: ...


class ContactResults(Results):
    """Results of a contact, with its warnings."""

    @property
    def slips_from(self) -> Parameter:
        """Least radius with slip in each case [length]; infinite without."""
        return np.inf

    @property
    def solved(self: SolvedContact) -> SolvedContact:
        """Contact on which the validity depends."""
        return self

    @cached_property
    def warnings(self: SolvedContact) -> tuple[Notice, ...]:
        """Warnings; where the bodies are unknown, for Poisson's ratio 0.3 on a rigid body."""
        found = findings(self.solved, self.solved.normal.material)
        return (*notices(found), *self.warnings_without_bodies)

    @cached_property
    def model_error(self: SolvedContact) -> Array:
        """Estimated relative error of the model in each case [1]; see `validity.model_error`."""
        return model_error(self.solved, self.solved.normal.material)


def notices(findings: Iterable[Finding]) -> list[Notice]:
    """Return a warning for each finding that holds in some case."""
    return [
        Notice(code, message(), None if value is None else extremes(value)[1], limit, instead)
        for code, where, message, value, limit, instead in findings
        if some(where)
    ]


def model_error(contact: SolvedContact, material: Material | None) -> Array:
    """Return the estimated relative error of depth, force and displacements by the model [1].

    An estimate, not a bound, of each load, where 1 stands for 100 % and more: of the half-space
    (`half_space`, `thin_body`), and with friction of the neglected coupling and of the transverse
    slip. A flat punch that sticks to a half-space has artanh(beta)/beta - 1, about beta^2/3, more
    force; slip across the load, of the relative size nu/(4 - 2 nu), acts to second order. Local
    stresses may differ by beta, and displacements under a force next to full slip by more.

    Source: hay; spence; notes, §8.

    Parameters: see `findings`.
    """
    *_, error = _half_space(contact.normal, material)
    error = error + _layer(contact.normal, material)[1]
    if material is not None and material.layer is not None:
        error = error + _on_layer(contact.normal, material.layer)
    if contact.g_star is not None:
        beta = 0.0 if material is None else material.dundurs_beta or 0.0
        ratio = _largest_ratio(material)
        error = error + beta**2 / 3 + _TRANSVERSE * (ratio / (4 - 2 * ratio)) ** 2
    return np.minimum(error, 1.0)


def findings(contact: SolvedContact, material: Material | None) -> list[Finding]:
    """Return the findings that depend on the bodies in contact, without `yield`.

    Poisson's ratio 0.3 is assumed where they are unknown.

    Parameters
    ----------
    contact : contact with or without friction, or load history; for wear the one before wear.
    material : effective moduli, as from `from_bodies`; None where they are unknown.
    """
    found = of_normal_contact(contact.normal, material, contact.slips_from)
    if contact.g_star is not None:
        beta = None if material is None else material.dundurs_beta
        found.append(of_moduli(contact.normal.e_star, contact.g_star, beta))
    return found


def table_end(contact: LoadedContact) -> Finding:
    """Return `table_end`: contacts that come near the last radius of a table."""
    part = contact.contact_radius / contact.profile.domain

    def message() -> str:
        return (
            f"the contact reaches {extremes(part)[1]:.3f} of the table's last radius: "
            "extend the table beyond the contact edge"
        )

    return _above_limit("table_end", part, message, "longer_table")


def smoothed(contact: LoadedContact, profile: Tabulated) -> Finding:
    """Return `smoothed`: depths that are not large against a table's deviation from its points."""
    depth = profile.g(contact.contact_radius)
    if profile.meets_points:
        return Finding("smoothed", depth < 0, lambda: "")
    rms, (largest, radius) = profile.fit.rms, profile.fit.largest
    part = where(depth > 0, largest / where(depth > 0, depth, 1.0), 0.0)

    def message() -> str:
        return (
            f"no smooth admissible profile meets the points: it deviates by {largest:.2g} at "
            f"radius {radius:.3g}, and by {rms:.2g} in the root mean square. The largest deviation "
            f"is {100 * extremes(part)[1]:.2g} % of the depth: see data_error. The point at radius "
            f"{profile.fit.deciding:.3g} decides most"
        )

    return _above_limit("smoothed", part, message)


def tip(contact: LoadedContact, profile: Tabulated) -> Finding:
    """Return `tip`: tables whose points do not tell a sharp tip from a smooth one."""
    rival = profile.fit.rival
    other = "smooth" if profile.tip_pressure > 0 else "sharp, with infinite pressure on the axis"

    def message() -> str:
        return (
            f"the tip is {other}, with a probability of {_per_cent(rival)}: pressures near the "
            "axis are open; add points there"
        )

    return _above_limit("tip", full(rival, contact.contact_radius), message)


def of_normal_contact(
    contact: LoadedContact, material: Material | None = None, slips_from: Parameter = np.inf
) -> list[Finding]:
    """Return `half_space`, `thin_body` and `plastic`.

    `half_space`: the estimated error of the half-space approximation exceeds one per cent. It is
    of first order in the slope by the neglected radial displacement, and of second order by the
    geometry; the side wall of an elastic punch adds to it. `thin_body`: the contact radius exceeds
    a tenth of the thickness of the body, or of a ball. `plastic`: the deviatoric stress is infinite
    somewhere, which no material can bear.

    `slips_from` is the least radius with slip in each case [length].

    Source: hay; notes, §8.
    """
    radial, slope, wall, error = _half_space(contact, material)
    is_known = material is not None and material.dundurs_beta is not None

    def message() -> str:
        steepest, total, flank = (extremes(each)[1] for each in (slope, error, wall))
        assumed = "" if is_known else f" (Poisson's ratio {ASSUMED_RATIO} assumed)"
        parts = {
            "the neglected radial displacement": radial * steepest,
            f"the slope {steepest:.2g} at the contact edge": steepest * steepest,
            "the side wall of the elastic punch": flank,
        }
        cause = max(parts, key=lambda cause: parts[cause])
        by_wall = parts[cause] == flank
        remedy = "take a far stiffer punch as rigid" if by_wall else "reduce the slope there"
        return (
            f"the half-space approximation has an estimated error of {_per_cent(total)}{assumed}, "
            f"mainly from {cause}; {remedy}, or use finite elements"
        )

    ratios = () if material is None else material.poissons_ratios
    profile = contact.profile
    tip_is_open = isinstance(profile, Tabulated) and profile.fit.rival > _LIMITS["tip"]

    def yields(radius: Parameter) -> Flags | bool:
        # A tip of a table that may be smooth as well proves nothing.
        if tip_is_open and radius == 0:
            return False
        return infinite_deviator(contact.profile, radius, ratios, slips_from)

    def places() -> str:
        return (
            f"the elastic pressure is infinite at radius {_infinite_radii(contact, yields)}: "
            "a real material yields there under any load; round the tip or edge"
        )

    steep = _above_limit("half_space", error, message, "finite_elements")
    plastic = Finding("plastic", _infinite(contact, yields), places, instead="rounded_tip")
    return [steep, _thin_body(contact, material), plastic]


def _thin_body(contact: LoadedContact, material: Material | None) -> Finding:
    part, error = _layer(contact, material)
    is_given = material is not None and material.body_thickness is not None
    over = "thickness" if is_given else "diameter of the ball, over its share in the compliance"

    def message() -> str:
        return (
            f"the contact radius is {extremes(part)[1]:.3g} times the {over}: the body is stiffer "
            f"than a half-space by {_per_cent(extremes(error)[1])}; use a smaller load, or finite "
            "elements"
        )

    return _above_limit("thin_body", part, message, "finite_elements")


def _layer(contact: LoadedContact, material: Material | None) -> tuple[Array, Array]:
    """a/h of a body of thickness h, bonded to a rigid base, and its relative error by the base [1].

    The base reduces the depth by alpha F_N/(pi E* h), to first order in a/h, with the source's
    approximation of alpha(nu). The force increases by x + x^2, x = (2/pi) alpha a/h, to the second.

    Source: dimitriadis; notes, §8.
    """
    part = contact.contact_radius / _thickness(contact.profile, material)
    x = _base(material) * part
    return part, x + x * x


def _base(material: Material | None) -> float:
    """x over a/h. Source: dimitriadis; see `_layer`."""
    nu = _largest_ratio(material)
    return 2 / pi * (1.2876 - 1.4678 * nu + 1.3442 * nu**2) / (1 - nu)


def stiffening(tolerance: float, material: Material | None) -> float:
    """Return a/h at which the base increases the force at a given depth by a tolerance [1]."""
    return (sqrt(1 + 4 * tolerance) - 1) / (2 * _base(material))


def _on_layer(contact: LoadedContact, layer: Layer) -> Array:
    """Relative error of the force on a layer by the neglected radial displacement [1].

    Over the slope at the edge it is 0.3 (a/h)^2 on thin bonded incompressible layers, and far less
    on compressible ones. Source: manual, Contact with a layer, finite elements.
    """
    part = contact.contact_radius / layer.thickness
    nu = ASSUMED_RATIO if layer.poissons_ratio is None else max(layer.poissons_ratio, 0.0)
    bent = _SQUEEZED * part**2 / (1 + _LEVELS * part**2)
    return np.asarray(bent * (nu / (1 - nu)) ** _COMPRESSIBLE * _edge_slope(contact))


def layer_strain(depth: Array, layer: Layer) -> Finding:
    """Return `layer_strain`: depths that are not small against the thickness of the layer."""
    part = np.abs(depth) / layer.thickness

    def message() -> str:
        return (
            f"the depth is {extremes(part)[1]:.2g} times the thickness of the layer, which strains "
            "it beyond linear elasticity: use a smaller load, or finite elements"
        )

    return _above_limit("layer_strain", part, message, "finite_elements")


def _thickness(profile: Profile, material: Material | None) -> Parameter:
    """As given; of a ball 2R, where the other body is rigid, and more by its share if it is not."""
    if material is not None and material.body_thickness is not None:
        return material.body_thickness
    share = None if material is None else material.profile_share
    if not isinstance(profile, Sphere) or share == 0:
        return np.inf
    return 2 * profile.radius / (share or 1.0)


def _largest_ratio(material: Material | None) -> float:
    """Poisson's ratio, the larger one of two bodies, assumed where they are unknown [1]."""
    return max(() if material is None else material.poissons_ratios, default=ASSUMED_RATIO)


def _half_space(
    contact: LoadedContact, material: Material | None
) -> tuple[float, Array, Parameter, Array]:
    """Radial error over the slope, slope at the edge, error by a punch's side wall, and the sum."""
    beta = None if material is None else material.dundurs_beta
    radial = _RADIAL * abs(_ASSUMED_BETA if beta is None else beta)
    wall = _wall_error(contact, None if material is None else material.profile_share)
    slope = _edge_slope(contact)
    return radial, slope, wall, slope * (radial + slope) + wall


def of_moduli(e_star: Parameter, g_star: Parameter, beta: float | None) -> Finding:
    """Return `elastic_similarity`, or `impossible_moduli`, of contacts with friction.

    `elastic_similarity`: without Eq. (5.3) normal and tangential contact are coupled.
    `impossible_moduli`: no pair of isotropic bodies has this ratio of E* and G*.

    Source: mdr-5, Eq. (5.3); notes, §8.
    """
    ratio = number(1.0) * e_star / g_star
    impossible = (_ROOM * ratio < _MODULI[0]) | (ratio > _ROOM * _MODULI[1])
    if beta is not None and not some(impossible):
        message = (
            f"the bodies are not elastically similar (Dundurs' beta = {beta:.3g}): the model "
            "neglects the coupling of normal and tangential contact, a relative error of this "
            "order in stresses, and of a third of its square in forces and displacements"
        )
        size = number(abs(beta))
        return _above_limit("elastic_similarity", size, lambda: message, "boundary_elements")

    def unphysical() -> str:
        return (
            f"e_star/g_star = {np.extract(impossible, ratio)[0]:.4g} is impossible for isotropic "
            "bodies: it lies between 0.75 and 1.5, and above 1 unless a Poisson's ratio is "
            "negative; correct the moduli, or give the bodies"
        )

    value = float(np.extract(impossible, ratio)[:1].sum())
    return Finding("impossible_moduli", impossible, unphysical, value, _MODULI[value > 1])


def infinite_maximum(contact: LoadedContact) -> Finding:
    """Return `singular`: loads under which the pressure is infinite somewhere."""

    def message() -> str:
        return f"maximum_pressure is infinite, at radius {_infinite_radii(contact, _always)}"

    return Finding("singular", _infinite(contact, _always), message)


def _always(_radius: Parameter) -> bool:
    return True


def infinite_deviator(
    profile: Profile,
    radius: Parameter,
    poissons_ratios: tuple[float, ...],
    slips_from: Parameter = np.inf,
) -> Flags:
    """Return whether the deviatoric stress is infinite at a radius of infinite pressure.

    In incompressible bodies a logarithmic singularity, at the tip of a cone or at a slope
    discontinuity, is hydrostatic unless slip reaches it.

    Parameters
    ----------
    profile : the profile.
    radius : a radius of infinite pressure [length].
    poissons_ratios : of the elastic bodies [1].
    slips_from : least radius with slip [length]; infinite without.
    """
    if profile.has_no_partial_slip or not poissons_ratios or min(poissons_ratios) < _INCOMPRESSIBLE:
        return number(1.0) > 0
    return np.isinf(profile.tip_pressure) | (radius >= slips_from)


def _infinite(contact: LoadedContact, counts: Callable[[Parameter], Flags | bool]) -> Flags:
    """Return whether the pressure is infinite at a radius that counts."""
    found = contact.contact_radius < 0
    for b in contact.profile.infinite_pressure_radii:
        found = found | (contact.loaded & (b <= contact.contact_radius) & counts(b))
        if every(found):
            break
    return found


def _infinite_radii(contact: LoadedContact, counts: Callable[[Parameter], Flags | bool]) -> str:
    """Radii of infinite pressure in the largest contact that count in some case, as text."""
    largest = extremes(contact.contact_radius)[1]
    radii = contact.profile.infinite_pressure_radii
    least = (extremes(b)[0] for b in radii if some(counts(b)))
    return listed([f"{b:.12g}" for b in least if b <= largest])


def listed(names: Sequence[str]) -> str:
    """Return ascending radii as text, of many the first, the last and their number."""
    many = len(names) > _LISTED
    return f"{names[0]} to {names[-1]} ({len(names)} radii)" if many else ", ".join(names)


def _edge_slope(contact: LoadedContact) -> Array:
    """f'(a) of loaded contacts, else zero [1]."""
    a, loaded = contact.contact_radius, contact.loaded
    if contact.profile.has_no_partial_slip or not some(loaded):
        return full(0.0, a)
    # The slope at the tip, where nothing is loaded, may be infinite.
    inside = a if every(loaded) else np.where(loaded, a, np.max(a))
    return where(loaded, contact.profile.df(inside), 0.0)


def _wall_error(contact: LoadedContact, share: float | None) -> Parameter:
    """Estimated error by the side wall of an elastic body with a flat end, which carries no stress.

    The flank beyond the contact edge counts as far as it is steeper than at the edge, up to the
    slope 1, and the body by its `share` in the compliance. [1]
    """
    profile, a = contact.profile, contact.contact_radius
    if not share or not some(contact.loaded & (profile.first_radius > 0)):
        return 0.0
    reach = np.minimum(2 * a, profile.domain)
    flank = (profile.f(reach) - profile.f(a)) / a
    steeper = np.minimum(np.square(flank), 1.0) - np.square(_edge_slope(contact))
    return where(contact.loaded, _WALL * share * np.maximum(steeper, 0.0), 0.0)


def _per_cent(part: float) -> str:
    return f"{100 * part:.2g} %" if part < 1 else "over 100 %"
