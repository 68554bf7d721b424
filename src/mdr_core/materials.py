"""Effective moduli of a contact from the elastic constants of two bodies."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, Literal, get_args

from mdr_core.errors import InputError
from mdr_core.validation import BODIES, as_positive, require_poissons_ratio

RIGID: Final = "rigid"
Base = Literal["bonded", "frictionless"]
"""Condition of a layer at its base: it sticks to it, or slides on it without friction."""
Held = Literal["contacts", "stem", "free", "block"]
"""Support of a round body: between two contacts, on a stem or by its equator, as a free body whose
depth counts against its centre, or as a bump of a block."""
UNUSABLE: Final = (
    "is computed with in normal and adhesive contact, its surface fields and fits alone: with "
    "friction, twist, wear, impact, or stresses beneath the surface the equations of a half-space "
    "do not hold; give body_thickness for a check in place of the layer, or use finite elements"
)
"""Reason why a layer is rejected."""


@dataclass(frozen=True)
class Body:
    """One elastic body: `youngs_modulus` [pressure] > 0, -1 < `poissons_ratio` <= 1/2 [1].

    `held` describes how a round body is held, on which `model_error` depends.
    """

    youngs_modulus: float
    poissons_ratio: float
    held: Held = "contacts"

    def __post_init__(self) -> None:
        if self.held not in get_args(Held):
            raise InputError(("held",), f"must be one of {', '.join(get_args(Held))}")
        vars(self)["youngs_modulus"] = as_positive(("youngs_modulus",), self.youngs_modulus)
        require_poissons_ratio(("poissons_ratio",), self.poissons_ratio)
        vars(self)["poissons_ratio"] = float(self.poissons_ratio)

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)) [pressure]."""
        return self.youngs_modulus / (2 * (1 + self.poissons_ratio))


@dataclass(frozen=True)
class Layer:
    """Elastic layer of constant thickness on a rigid base."""

    thickness: float
    """h [length]."""
    base: Base = "bonded"
    """`bonded`, or `frictionless`: the layer slides on its base, but does not lift off."""
    poissons_ratio: float | None = None
    """nu of the layer [1], needed on a bonded base; `from_bodies` takes it from the body."""
    share: float = 1.0
    """Share of the layer's material in the compliance 1/E* [1], which `from_bodies` computes."""

    def __post_init__(self) -> None:
        place = ("material", "layer")
        if self.base not in get_args(Base):
            raise InputError((*place, "base"), 'must be "bonded" or "frictionless"')
        vars(self)["thickness"] = as_positive((*place, "thickness"), self.thickness)
        if self.poissons_ratio is not None:
            require_poissons_ratio((*place, "poissons_ratio"), self.poissons_ratio)


@dataclass(frozen=True)
class Material:
    """Elastic constants of two bodies in contact, or only the effective moduli."""

    e_star: float
    """E* [pressure]."""
    g_star: float | None = None
    """G* [pressure], None where it is not given."""
    dundurs_beta: float | None = None
    """Dundurs' beta [1], None where the bodies are unknown."""
    poissons_ratios: tuple[float, ...] = ()
    """Poisson's ratios of the elastic bodies [1], empty where they are unknown."""
    profile_share: float | None = None
    """Share in 1/E* of the first body, which has the profile [1]; None where it is unknown."""
    body_thickness: float | None = None
    """Thickness of the more compliant body on a rigid base [length]; None where it is not given."""
    shear_modulus: float | None = None
    """G of a twist, 1/G = 1/G1 + 1/G2 [pressure]; None where it is not given."""
    held: tuple[Held, Held] = ("contacts", "contacts")
    """Supports of the bodies, if they are round."""
    layer: Layer | None = None
    """Layer with which `layer.solve` computes; E* is that of half-spaces of the same materials."""

    def __post_init__(self) -> None:
        if self.layer is not None and self.body_thickness is not None:
            detail = "and body_thickness, a check alone, exclude each other: give one of them"
            raise InputError(("material", "layer"), detail)
        for name in ("e_star", "g_star", "body_thickness", "shear_modulus"):
            if (value := getattr(self, name)) is not None:
                vars(self)[name] = as_positive(("material", name), value)


UNKNOWN: Final = Material(1.0)
"""Bodies of which nothing is known; the contact, and not this material, has their E*."""
_NEEDED: Final = {
    "e_star": "is needed: give it, or bodies",
    "g_star": "is needed with friction: give it, or bodies",
    "shear_modulus": "is needed for a twist, 1/G = 1/G1 + 1/G2: give it, or bodies",
}


def modulus(name: str, given: Any) -> Any:
    """Return the positive modulus of a material by its name [pressure], or the number or array.

    Parameters
    ----------
    name : `e_star`, `g_star`, or `shear_modulus`, the G of a twist, which G* does not determine.
    given : a material, a number, an array, or None.

    Raises
    ------
    InputError : no modulus, one that is not positive and finite, or a layer, with which only
        `layer.solve` computes.
    """
    if isinstance(given, Body):
        detail = "depends on both bodies: combine them by from_bodies([body, other])"
        raise InputError(("material", name), detail)
    if isinstance(given, Material):
        if name == "e_star" and given.layer is not None:
            raise InputError(("material", "layer"), UNUSABLE)
        given = getattr(given, name)
    if given is None:
        raise InputError(("material", name), _NEEDED[name])
    return as_positive(("material", name), given)


def from_bodies(
    bodies: Sequence[Body | Literal["rigid"]],
    *,
    body_thickness: float | None = None,
    layer: Layer | None = None,
) -> Material:
    """Return the effective moduli and Dundurs' beta of two bodies in contact.

    1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 and 1/G* = (2 - nu1)/(4 G1) + (2 - nu2)/(4 G2), and
    1/G = 1/G1 + 1/G2 of a twist; a rigid body's terms are dropped. Dundurs'
    beta = (m1 - m2) / (2 [(1 - nu1)/G1 + (1 - nu2)/G2]), m = (1 - 2 nu)/G, is zero exactly
    where the bodies are elastically similar, Eq. (5.3).

    Source: mdr-5, Eqs. (5.2), (5.3); dundurs.

    Parameters
    ----------
    bodies : two of `Body` or "rigid", at least one of them elastic; the first has the profile.
    body_thickness : thickness of the more compliant body, bonded to a rigid base [length]. The
        contact is still computed with half-spaces; `model_error` and `thin_body` count it.
        A ball has its own size as well; the larger error of the two counts.
    layer : thickness and base of the more compliant body, the second one of two equal bodies.

    Raises
    ------
    InputError : not two bodies, or both rigid.

    Examples
    --------
    >>> steel = Body(210e9, 0.3)
    >>> round(from_bodies([steel, RIGID]).e_star / 1e9, 3)
    230.769
    """
    given: object = bodies
    if not isinstance(given, Sequence) or len(given) != 2:
        raise InputError(("material", "bodies"), BODIES)
    for i, body in enumerate(bodies):
        # A comparison with an array would be an array.
        if not isinstance(body, Body) and str(body) != RIGID:
            raise InputError(("material", "bodies", i), 'must be a Body or "rigid"')
    parts = [body for body in bodies if isinstance(body, Body)]
    if not parts:
        raise InputError(("material", "bodies"), "at least one body must be elastic")
    first, second = map(_compliances, bodies)
    normal, shear, twist, _, total = map(sum, zip(first, second, strict=True))
    moduli = 1 / normal, 1 / shear, (first[3] - second[3]) / (2 * total)
    ratios = tuple(body.poissons_ratio for body in parts)
    if layer is not None:
        # If both bodies are equal, the second one is the layer.
        largest, nu = (second[0], ratios[-1]) if second[0] >= first[0] else (first[0], ratios[0])
        if layer.poissons_ratio not in {None, nu}:
            detail = "differs from Poisson's ratio of the more compliant body: leave it out"
            raise InputError(("material", "layer", "poissons_ratio"), detail)
        layer = replace(layer, poissons_ratio=nu, share=largest / normal)
    held = tuple(body.held if isinstance(body, Body) else "contacts" for body in bodies)
    share = first[0] / normal
    return Material(*moduli, ratios, share, body_thickness, 1 / twist, (held[0], held[1]), layer)


def _compliances(body: Body | Literal["rigid"]) -> tuple[float, ...]:
    """Terms of a body in 1/E*, 1/G* and 1/G of a twist, Dundurs' m, and (1 - nu)/G [1/pressure]."""
    if not isinstance(body, Body):
        return (0.0,) * 5
    nu, shear = body.poissons_ratio, body.shear_modulus
    # The factors of 1 - nu^2 are free of cancellation as nu -> -1.
    normal = (1 - nu) * (1 + nu) / body.youngs_modulus
    return normal, (2 - nu) / (4 * shear), 1 / shear, (1 - 2 * nu) / shear, (1 - nu) / shear
