"""Limits of validity of the model: findings with stable codes.

The codes are `table_end`, `half_space`, `plastic`, `elastic_similarity`, `impossible_moduli`,
`yield` and `yield_unknown`; `singular` and `accuracy` come with the results.

Source: notes, §8.
"""

from collections.abc import Callable, Iterable
from functools import lru_cache
from math import atan
from typing import Final, NamedTuple, Protocol

import numpy as np
from scipy.optimize import minimize_scalar

from mdr_core.errors import Notice
from mdr_core.materials import Material
from mdr_core.profiles import Cone, Paraboloid, Profile
from mdr_core.profiles.spheroids import Spheroid
from mdr_core.typing import Array, Flags, Parameter

# Relative error of the half-space approximation above which it is reported, with room for rounding:
# a cone of slope 0.1 on incompressible bodies has one per cent.
_HALF_SPACE_ERROR: Final = 0.01 * (1 + 1e-9)
# Relative error by the neglected radial displacement, over |beta| and the slope of a cone. Source:
# hay, by F/F_Sneddon to first order; a paraboloid has two thirds of it.
_RADIAL: Final = 0.63
# Poisson's ratio of most metals, assumed where the bodies are unknown, and Dundurs' beta with it.
_ASSUMED_RATIO: Final = 0.3
_ASSUMED_BETA: Final = (1 - 2 * _ASSUMED_RATIO) / (2 * (1 - _ASSUMED_RATIO))
# Poisson's ratio of incompressible bodies.
_INCOMPRESSIBLE: Final = 0.5
# Part of a table's length from which its end is near; a judgement.
_NEAR_END: Final = 0.95
# |beta| from which normal and tangential contact are noticeably coupled, by a relative error of
# order beta; a judgement.
_SIMILARITY: Final = 0.05
# E*/G* of isotropic bodies with Poisson's ratios from -1 to 1/2, with room for rounding.
_MODULI: Final = (0.75 * (1 - 1e-9), 1.5 * (1 + 1e-9))


# Codes of the findings about a normal contact that depend on Poisson's ratio.
OF_BODIES: Final = frozenset({"half_space", "plastic"})


class Finding(NamedTuple):
    """A limit of validity, and the cases that exceed it."""

    code: str
    where: Flags
    message: Callable[[], str]


class LoadedContact(Protocol):
    """Attributes of a normal contact on which its validity depends."""

    @property
    def profile(self) -> Profile: ...
    @property
    def e_star(self) -> Parameter: ...
    @property
    def contact_radius(self) -> Array: ...
    @property
    def maximum_pressure(self) -> Array: ...
    @property
    def loaded(self) -> Flags: ...


def notices(findings: Iterable[Finding]) -> list[Notice]:
    """Return a warning for each finding that holds in some case."""
    return [Notice(code, message()) for code, where, message in findings if where.any()]


def findings(
    contact: LoadedContact,
    material: Material,
    *,
    g_star: Parameter | None = None,
    tangential: Flags | None = None,
    yield_strength: float | None = None,
) -> list[Finding]:
    """Return all findings that depend on the bodies in contact.

    Parameters
    ----------
    contact : a normal contact.
    material : the bodies; Poisson's ratio 0.3 is assumed where they are unknown.
    g_star : effective shear modulus of a contact with friction [pressure].
    tangential : cases with a tangential load.
    yield_strength : of the softer body, in uniaxial tension [pressure].
    """
    found = of_normal_contact(contact, material)
    if g_star is not None:
        found += of_moduli(contact.e_star, g_star, material.dundurs_beta)
    if yield_strength is not None:
        found += of_strength(contact, material, yield_strength, tangential)
    return found


def table_end(contact: LoadedContact) -> Finding:
    """Return `table_end`: contacts that come near the last radius of a table."""
    a, end = contact.contact_radius, contact.profile.domain
    near = a > _NEAR_END * np.asarray(end if contact.profile.kind == "tabulated" else np.inf)

    def message() -> str:
        part = float(np.max(a) / np.max(end))
        return (
            f"the contact reaches {part:.3f} of the table's last radius: "
            "extend the table beyond the contact edge"
        )

    return Finding("table_end", np.asarray(near), message)


def of_normal_contact(contact: LoadedContact, material: Material | None = None) -> list[Finding]:
    """Return `half_space` and `plastic`.

    `half_space`: the estimated error of the half-space approximation exceeds one per cent. It is
    of first order in the slope by the neglected radial displacement, and of second order by the
    geometry. `plastic`: the deviatoric stress is infinite somewhere, which no material can bear.

    Source: hay; notes, §8.

    Parameters
    ----------
    contact : a normal contact.
    material : the bodies; Poisson's ratio 0.3 is assumed where they are unknown.
    """
    beta = None if material is None else material.dundurs_beta
    radial = _RADIAL * abs(_ASSUMED_BETA if beta is None else beta)
    slope = _edge_slope(contact)
    error = slope * (radial + slope)

    def size() -> str:
        steepest = float(np.max(slope))
        assumed = f" (Poisson's ratio {_ASSUMED_RATIO} assumed)" if beta is None else ""
        return (
            f"the half-space approximation has an estimated error of "
            f"{_per_cent(float(np.max(error)))}: {_per_cent(radial * steepest)} by the neglected "
            f"radial displacement{assumed}, and of order {_per_cent(steepest**2)} by the slope "
            f"{steepest:.2g} at the contact edge"
        )

    def places() -> str:
        return (
            f"the elastic pressure is infinite at radius {infinite_radii(contact)}: "
            "a real material yields there under any load"
        )

    plastic = infinite_pressure(contact, () if material is None else material.poissons_ratios)
    steep = Finding("half_space", np.asarray(error > _HALF_SPACE_ERROR), size)
    return [steep, Finding("plastic", plastic, places)]


def of_moduli(e_star: Parameter, g_star: Parameter, beta: float | None) -> list[Finding]:
    """Return `elastic_similarity` and `impossible_moduli`, of contacts with friction.

    `elastic_similarity`: without Eq. (5.3) normal and tangential contact are coupled.
    `impossible_moduli`: no pair of isotropic bodies has this ratio of E* and G*.

    Source: mdr-5, Eq. (5.3); notes, §8.

    Parameters
    ----------
    e_star, g_star : effective moduli [pressure].
    beta : Dundurs' beta [1]; None where the bodies are unknown.
    """
    if beta is not None:
        return [
            Finding(
                "elastic_similarity",
                np.asarray(abs(beta) > _SIMILARITY),
                lambda: (
                    f"the bodies are not elastically similar (Dundurs' beta = {beta:.3g}): normal "
                    "and tangential contact are coupled, which the model neglects, by a relative "
                    "error of this order"
                ),
            )
        ]
    ratio = np.asarray(e_star / np.asarray(g_star))
    impossible = np.asarray((ratio < _MODULI[0]) | (ratio > _MODULI[1]))
    return [
        Finding(
            "impossible_moduli",
            impossible,
            lambda: (
                f"e_star/g_star = {float(ratio[impossible][0]):.4g} is impossible for isotropic "
                "bodies: it lies between 0.75 and 1.5, and above 1 unless a Poisson's ratio "
                "is negative"
            ),
        )
    ]


def of_strength(
    contact: LoadedContact,
    material: Material,
    yield_strength: float,
    tangential: Flags | None = None,
) -> list[Finding]:
    """Return `yield` where Tresca's criterion is met, `yield_unknown` where it is not evaluated.

    Under a body that is round at the tip the largest shear stress lies on the axis, c(nu) p_0 with
    c = max of [3/2/(1 + s^2) - (1 + nu)(1 - s arctan(1/s))]/2 over s = z/a: 0.310 for nu = 0.3. A
    tangential load can only add to it, by an amount that is not computed. Under a cone the largest
    stress difference in an incompressible body is E* tan(theta).

    Source: johnson, Eqs. (3.45), (4.4) and section 5.2; notes, §8.

    Parameters
    ----------
    contact : a normal contact.
    material : the bodies; Poisson's ratio 0.3 is assumed where they are unknown.
    yield_strength : in uniaxial tension [pressure].
    tangential : cases with a tangential load; None for none.
    """
    profile, ratios = contact.profile, material.poissons_ratios or (_ASSUMED_RATIO,)
    plastic = infinite_pressure(contact, ratios)
    loaded = contact.loaded & ~plastic
    stress, onset = np.zeros(loaded.shape), np.inf
    if isinstance(profile, Cone):
        stress, onset = stress + contact.e_star * profile.slope, yield_strength
    elif isinstance(profile, Paraboloid | Spheroid):
        stress = contact.maximum_pressure
        onset = yield_strength / (2 * max(map(largest_shear, ratios)))
    yields = loaded & (stress >= onset)
    known = onset < np.inf
    sheared = np.asarray(False if tangential is None else tangential)
    unknown = loaded & ~yields & (sheared | (not known))

    def exceeded() -> str:
        if not yields.any():
            return "the stress is infinite: the material yields under any load"
        name = "stress difference" if isinstance(profile, Cone) else "maximum pressure"
        reached = float(np.max(stress[yields]))
        return f"the {name} {reached:.4g} exceeds the onset of yield, {onset:.4g}"

    def not_assessed() -> str:
        case = "with a tangential load" if known else f"under a {profile.kind}"
        return f"the onset of yield {case} is not assessed"

    return [
        Finding("yield", plastic | yields, exceeded),
        Finding("yield_unknown", np.asarray(unknown), not_assessed),
    ]


def infinite_pressure(contact: LoadedContact, poissons_ratios: tuple[float, ...] = ()) -> Flags:
    """Return the loads under which the pressure is infinite somewhere.

    If Poisson's ratios of bodies are given that are all incompressible, the tip of a cone does not
    count: there the infinite stress is hydrostatic.
    """
    found = np.zeros(contact.contact_radius.shape, dtype=bool)
    incompressible = bool(poissons_ratios) and min(poissons_ratios) == _INCOMPRESSIBLE
    for b in contact.profile.infinite_pressure_radii:
        reached = contact.loaded & (b <= contact.contact_radius)
        if incompressible:
            reached &= (np.asarray(b) > 0) | np.isinf(contact.profile.tip_pressure)
        found = found | reached
    return np.asarray(found)


def infinite_radii(contact: LoadedContact) -> str:
    """Return the radii of infinite pressure inside the largest contact, as text."""
    radii = (float(np.min(b)) for b in contact.profile.infinite_pressure_radii)
    largest = np.max(contact.contact_radius)
    return ", ".join(f"{b:.12g}" for b in radii if b <= largest)


@lru_cache(maxsize=64)
def largest_shear(poissons_ratio: float) -> float:
    """Return the largest shear stress on the axis under Hertz' pressure, over its peak [1].

    Source: johnson, Eq. (3.45).

    >>> round(largest_shear(0.3), 3)
    0.31
    """

    def minus_shear(s: float) -> float:
        radial = (1 + poissons_ratio) * (1 - s * atan(1 / s))
        return -(1.5 / (1 + s * s) - radial) / 2

    return -float(minimize_scalar(minus_shear, bounds=(1e-3, 2.0), method="bounded").fun)


def _edge_slope(contact: LoadedContact) -> Array:
    """f'(a) of loaded contacts, else zero [1]."""
    a, loaded = contact.contact_radius, contact.loaded
    if contact.profile.slips_at_once or not loaded.any():
        return np.zeros(a.shape)
    # The slope at the tip, where nothing is loaded, may be infinite.
    inside = a if loaded.all() else np.where(loaded, a, np.max(a))
    return np.where(loaded, contact.profile.df(inside), 0.0)


def _per_cent(part: float) -> str:
    return f"{100 * part:.2g} %" if part < 1 else "over 100 %"
