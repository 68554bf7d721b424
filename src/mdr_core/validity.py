"""Limits of validity of the model: findings with stable codes.

The codes are `table_end`, `smoothed`, `tip`, `half_space`, `thin_body`, `large_strain`,
`layer_strain`, `plastic`, `elastic_similarity` and `impossible_moduli`; `singular` and `accuracy`
come with the results, and `yield` from `mdr_core.subsurface`.

Source: notes, §8.
"""

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from importlib.resources import files
from typing import Any, ClassVar, Final, NamedTuple, Protocol

import numpy as np

from mdr_core import half_space
from mdr_core.elementwise import full, number, quotient, some
from mdr_core.errors import Notice, Remedy
from mdr_core.half_space import ASSUMED_RATIO, LoadedContact
from mdr_core.materials import Layer
from mdr_core.profiles import Profile, Tabulated
from mdr_core.results import Results
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import extremes

_SOURCES: Final[Mapping[str, Sequence[str]]] = json.loads(
    files("mdr_core").joinpath("sources.json").read_text("utf-8")
)
MODEL_ERRORS: Final = ("model_error", "model_error_radius", "model_error_pressure")
"""Estimates of the error of the model; the last two exist for round bodies or a thickness."""
ACCURACY: Final = 1e-9
"""Error estimate above which results carry the warning `accuracy`: results next to a limit of their
method have this accuracy (manual, Speed and accuracy)."""
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
    # Pressure of Hertz, 3/2 of the mean, of round bodies over E*: about the largest strain.
    "large_strain": 0.1,
    # Depth over the thickness of a layer, the size of its strain.
    "layer_strain": 0.1,
    # |beta|, by which normal and tangential contact are coupled.
    "elastic_similarity": 0.05,
}
# Margin for rounding: a cone of slope 0.1 on incompressible bodies has an error of one per cent.
_ROOM: Final = 1 + 1e-9
# Relative change, due to transverse slip, of forces at a given displacement and of displacements
# under forces up to 0.998 of full slip, over (nu/(4 - 2 nu))^2. Source: notes, §8.
_TRANSVERSE: Final = 0.2
# Maximum number of radii in a warning, so that it stays one sentence.
_LISTED: Final = 5
# Poisson's ratio of incompressible bodies.
_INCOMPRESSIBLE: Final = 0.5
# E*/G* of isotropic bodies with Poisson's ratios from -1 to 1/2.
_MODULI: Final = (0.75, 1.5)


class Finding(NamedTuple):
    """A limit of validity, and the cases that exceed it."""

    code: str
    where: Flags
    message: Callable[[Any], str]
    """Sentence about the largest size, such as `format` of a text with braces for it."""
    value: Parameter | None = None
    """Size in each case; see `Notice`."""
    limit: float | None = None
    instead: Remedy | None = None


def _above_limit(
    code: str, size: Array, message: Callable[[float], str], instead: Remedy | None = None
) -> Finding:
    """Return the finding of the cases whose size is above the limit of a code."""
    limit = _LIMITS[code]
    return Finding(code, size > _ROOM * limit, message, size, limit, instead)


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

    about: ClassVar[tuple[str, ...]] = (
        *("method", "sources", "error_estimate"),
        *(*MODEL_ERRORS, "warnings"),
    )

    @property
    def sources(self: SolvedContact) -> tuple[str, ...]:
        """Keys of the manual's list of sources, with equations, on which the results rest."""
        normal = self.solved.normal
        layer = () if normal.material.layer is None else ("layer",)
        return sources_of(type(self).__name__, *layer, normal.profile.kind)

    @property
    def slips_from(self) -> Parameter:
        """Smallest radius with slip in each case [length]; infinite without."""
        return np.inf

    @property
    def solved(self: SolvedContact) -> SolvedContact:
        """Contact on which the validity depends."""
        return self

    @cached_property
    def warnings(self: SolvedContact) -> tuple[Notice, ...]:
        """Warnings; where the bodies are unknown, for Poisson's ratio 0.3 on a rigid body."""
        return (*notices(findings(self.solved)), *self.warnings_without_bodies)

    @property
    def warnings_without_bodies(self: Any) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        return tuple(notices([*self.normal.findings, inaccurate(self.error_estimate)]))

    @cached_property
    def model_error(self: SolvedContact) -> Array:
        """Estimated relative error of the model in each case [1]; see `validity.model_error`."""
        return model_error(self.solved)

    @cached_property
    def model_error_radius(self: SolvedContact) -> Array | None:
        """Estimated error of the contact radius under a force [1]; see `_under_a_force`."""
        normal = self.solved.normal
        return _under_a_force(normal, normal.half_space_errors.radius)

    @cached_property
    def model_error_pressure(self: SolvedContact) -> Array | None:
        """Estimated error of the pressure under a force [1]; see `_under_a_force`."""
        normal = self.solved.normal
        return _under_a_force(normal, normal.half_space_errors.pressure)


class ResultsOverLoads(ContactResults):
    """Results of a contact under each of many loads, with an `error_estimates` over them."""

    @property
    def error_estimate(self: Any) -> float:
        """Largest of `error_estimates` [1]."""
        return extremes(self.error_estimates)[1]


def _under_a_force(contact: LoadedContact, error: Array | None) -> Array | None:
    """Add the error due to a body's thickness to that due to the size of round bodies, up to 1.

    None where there is neither, and under a flat punch, whose radius is given.
    """
    thickness = contact.material.body_thickness
    if thickness is not None and not contact.profile.is_flat_punch:
        base = half_space.thickness_at_a_force(contact, thickness)
        error = base if error is None else error + base
    return None if error is None else np.minimum(error, 1.0)


def sources_of(*names: str) -> tuple[str, ...]:
    """Return the sources of results, kinds of profile and quantities with these names."""
    return tuple(dict.fromkeys(source for name in names for source in _SOURCES.get(name, ())))


def notices(findings: Iterable[Finding]) -> list[Notice]:
    """Return a warning for each finding that holds in some case."""
    found = []
    for code, where, message, value, limit, instead in findings:
        if some(where):
            size = None if value is None else extremes(value)[1]
            found.append(Notice(code, message(size), size, limit, instead))
    return found


def model_error(contact: SolvedContact) -> Array:
    """Return the relative error of depth, force and displacements due to the model [1].

    Estimate, not a bound, for each load; 1 stands for 100 % and more. It includes the half-space
    (`half_space`, `thin_body`), and with friction the neglected coupling and the transverse slip.
    A flat punch that sticks to a half-space has artanh(beta)/beta - 1, about beta^2/3, more force;
    transverse slip, of relative size nu/(4 - 2 nu), acts to second order. Local stresses
    may differ by beta, and displacements under a force next to full slip by more.

    Source: hay; spence; notes, §8.
    """
    material, errors = contact.normal.material, contact.normal.half_space_errors
    _, layer = half_space.layer(contact.normal)
    # Both thickness and radius give the finite size of a ball.
    is_socket = any(map(half_space.is_concave, contact.normal.profile.body_radii or ()))
    counted = 0.0 if is_socket else errors.parts[0]
    error = errors.force + np.maximum(layer - counted, 0.0)
    if contact.g_star is not None:
        beta = material.dundurs_beta or 0.0
        ratio = half_space.largest_ratio(material)
        error = error + beta**2 / 3 + _TRANSVERSE * (ratio / (4 - 2 * ratio)) ** 2
    return np.minimum(error, 1.0)


def findings(contact: SolvedContact) -> list[Finding]:
    """Return the findings that depend on the bodies in contact, without `yield`.

    Poisson's ratio 0.3 is assumed where they are unknown.

    Parameters
    ----------
    contact : contact with or without friction, or load history; for wear the one before wear.
    """
    found = of_normal_contact(contact.normal, contact.slips_from)
    if contact.g_star is not None:
        beta = contact.normal.material.dundurs_beta
        found.append(of_moduli(contact.normal.e_star, contact.g_star, beta))
    return found


def inaccurate(error: Parameter, limit: float = ACCURACY) -> Finding:
    """Return `accuracy`: error estimates above a limit."""
    text = f"error_estimate is {{:.2g}}, above {limit:g}: results have fewer digits here"
    return Finding("accuracy", np.asarray(error) > limit, text.format, error, limit)


def table_end(contact: LoadedContact) -> Finding:
    """Return `table_end`: contacts that come near the last radius of a table."""
    part = contact.contact_radius / contact.profile.domain
    text = (
        "the contact reaches {:.3f} of the table's last radius: extend the table beyond the "
        "contact edge"
    )
    return _above_limit("table_end", part, text.format, "longer_table")


def smoothed(contact: LoadedContact, profile: Tabulated) -> Finding:
    """Return `smoothed`: depths that are not large against a table's deviation from its points."""
    depth = profile.g(contact.contact_radius)
    if profile.meets_points:
        return Finding("smoothed", depth < 0, str)
    rms, (largest, radius) = profile.fit.rms, profile.fit.largest
    part = quotient(largest, depth)

    def message(part: float) -> str:
        return (
            f"no smooth admissible profile meets the points: it deviates by {largest:.2g} at "
            f"radius {radius:.3g}, and by {rms:.2g} in the root mean square. The largest deviation "
            f"is {100 * part:.2g} % of the depth: see data_error. The point at radius "
            f"{profile.fit.deciding:.3g} decides most"
        )

    return _above_limit("smoothed", part, message)


def tip(contact: LoadedContact, profile: Tabulated) -> Finding:
    """Return `tip`: tables whose points do not distinguish a sharp tip from a smooth one."""
    rival = profile.fit.rival
    other = "smooth" if profile.tip_pressure > 0 else "sharp, with infinite pressure on the axis"
    text = (
        f"the tip is {other}, with a probability of {_per_cent(rival)}: pressures near the axis "
        "are open; add points there"
    )
    return _above_limit("tip", full(rival, contact.contact_radius), text.format)


def of_normal_contact(contact: LoadedContact, slips_from: Parameter) -> list[Finding]:
    """Return `half_space`, `thin_body`, `large_strain` and `plastic`.

    `half_space`: the estimated error of the half-space approximation exceeds one per cent. It is
    of first order in a/R due to the finite size of round bodies, and in the slope due to the
    neglected radial displacement, and of second order due to the geometry; the side wall of an
    elastic punch and the radial displacement of a layer add to it. `thin_body`: the contact radius
    exceeds a tenth of the given thickness of the body.
    `large_strain`: the pressure of round bodies exceeds a tenth of E*. `plastic`: the deviatoric
    stress is infinite somewhere, which no material can bear.

    `slips_from` is the least radius with slip in each case [length].

    Source: hay; notes, §8.
    """
    material = contact.material
    errors, radii = contact.half_space_errors, contact.profile.body_radii
    in_socket = any(map(half_space.is_concave, radii or ()))
    instead: Remedy = "conforming_contact" if in_socket else "finite_elements"
    model = "a model of conforming contact" if in_socket else "finite elements"
    approximation = (
        "half-space approximation" if material.layer is None else "model of a flat layer"
    )

    def message(total: float) -> str:
        steepest = extremes(errors.steepness)[1]
        is_assumed = material.dundurs_beta is None
        assumed = f" (Poisson's ratio {ASSUMED_RATIO} assumed)" if is_assumed else ""
        flat = radii is not None and np.all(np.isinf(radii[1]))
        second = " of the first body; the second counts as flat" if flat else ""
        causes = (
            (f"the finite size of the bodies, a/R = {steepest:.2g}{second}", "reduce the load"),
            ("the neglected radial displacement", "reduce the slope at the contact edge"),
            (f"the slope {steepest:.2g} at the contact edge", "reduce the slope there"),
            ("the side wall of the elastic punch", "take a far stiffer punch as rigid"),
        )
        sizes = [extremes(part)[1] for part in errors.parts]
        cause, remedy = causes[sizes.index(max(sizes))]
        return (
            f"the {approximation} has an estimated error of {_per_cent(total)}{assumed}, "
            f"mainly from {cause}; {remedy}, or use {model}"
        )

    profile = contact.profile
    tip_is_open = isinstance(profile, Tabulated) and profile.fit.rival > _LIMITS["tip"]

    def yields(radius: Parameter) -> Flags | bool:
        # A tip of a table that may be smooth as well proves nothing.
        if tip_is_open and radius == 0:
            return False
        return infinite_deviator(profile, radius, material.poissons_ratios, slips_from)

    found = [_above_limit("half_space", errors.force, message, instead)]
    if material.body_thickness is not None:
        found.append(_thin_body(contact))
    if radii is not None:
        found.append(_large_strain(contact))
    text = (
        "the elastic pressure is infinite at radius {}: a real material yields there under any "
        "load; round the tip or edge"
    )
    return [*found, infinite_pressure(contact, "plastic", text, yields, "rounded_tip")]


def _thin_body(contact: LoadedContact) -> Finding:
    part, error = half_space.layer(contact)
    text = (
        "the contact radius is {:.3g} times the thickness: the body is stiffer than a half-space "
        f"by {_per_cent(extremes(error)[1])}; use a smaller load, or finite elements"
    )
    return _above_limit("thin_body", part, text.format, "finite_elements")


def _large_strain(contact: LoadedContact) -> Finding:
    part = 1.5 * contact.mean_pressure / contact.e_star
    text = (
        "the pressure of Hertz reaches {:.2g} E*: linear elasticity ends, as strains are large; "
        "use a smaller load, or finite elements with finite strains"
    )
    return _above_limit("large_strain", part, text.format, "finite_elements")


def layer_strain(depth: Array, layer: Layer) -> Finding:
    """Return `layer_strain`: depths that are not small against the thickness of the layer."""
    text = (
        "the depth is {:.2g} times the thickness of the layer, which strains it beyond linear "
        "elasticity: use a smaller load, or finite elements"
    )
    part = np.abs(depth) / layer.thickness
    return _above_limit("layer_strain", part, text.format, "finite_elements")


def of_moduli(e_star: Parameter, g_star: Parameter, beta: float | None) -> Finding:
    """Return `elastic_similarity`, or `impossible_moduli`, of contacts with friction.

    `elastic_similarity`: without Eq. (5.3) normal and tangential contact are coupled.
    `impossible_moduli`: no pair of isotropic bodies has this ratio of E* and G*.

    Source: mdr-5, Eq. (5.3); notes, §8.
    """
    ratio = number(1.0) * e_star / g_star
    impossible = (_ROOM * ratio < _MODULI[0]) | (ratio > _ROOM * _MODULI[1])
    if beta is not None and not some(impossible):
        text = (
            f"the bodies are not elastically similar (Dundurs' beta = {beta:.3g}): the model "
            "neglects the coupling of normal and tangential contact, a relative error of this "
            "order in stresses, and of a third of its square in forces and displacements"
        )
        size = number(abs(beta))
        return _above_limit("elastic_similarity", size, text.format, "boundary_elements")
    text = (
        "e_star/g_star = {:.4g} is impossible for isotropic bodies: it lies between 0.75 and 1.5, "
        "and above 1 unless a Poisson's ratio is negative; correct the moduli, or give the bodies"
    )
    value = float(np.extract(impossible, ratio)[:1].sum())
    return Finding("impossible_moduli", impossible, text.format, value, _MODULI[value > 1])


def infinite_pressure(
    contact: LoadedContact,
    code: str,
    text: str,
    counts: Callable[[Parameter], Flags | bool] = lambda _radius: True,
    instead: Remedy | None = None,
) -> Finding:
    """Return the finding of loads under which the pressure is infinite at a radius that counts.

    Parameters
    ----------
    contact : contact with or without friction.
    code, text : of the warning; braces in the text stand for the radii.
    counts : True in the cases in which a radius counts, all by default.
    instead : see `Notice`.
    """
    infinite, radii = contact.contact_radius < 0, []
    for b in contact.profile.infinite_pressure_radii:
        here = contact.loaded & (b <= contact.contact_radius) & counts(b)
        infinite = infinite | here
        if some(here):
            radii.append(extremes(b)[0])
    text = text.format(listed([f"{b:.12g}" for b in radii]))
    return Finding(code, infinite, text.format, instead=instead)


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
    if profile.is_flat_punch or not poissons_ratios or min(poissons_ratios) < _INCOMPRESSIBLE:
        return number(1.0) > 0
    return np.isinf(profile.tip_pressure) | (radius >= slips_from)


def listed(names: Sequence[str]) -> str:
    """Return ascending radii as text; many as the first, the last and their number."""
    many = len(names) > _LISTED
    return f"{names[0]} to {names[-1]} ({len(names)} radii)" if many else ", ".join(names)


def _per_cent(part: float) -> str:
    return f"{100 * part:.2g} %" if part < 1 else "over 100 %"
