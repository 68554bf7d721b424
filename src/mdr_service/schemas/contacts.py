"""Requests about contacts under a load, and the parts that all requests share."""

from dataclasses import replace
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self

from pydantic import Discriminator, Field, Tag, WithJsonSchema, model_validator
from pydantic import GetJsonSchemaHandler as Handler
from pydantic_core import CoreSchema, PydanticCustomError

from mdr_core import materials
from mdr_core.validation import LEAST_CHANGE, MOST_CHANGE
from mdr_service.schemas.profiles import Profile
from mdr_service.schemas.quantities import (
    ABSENT,
    PoissonsRatio,
    Positive,
    ScalarOrArray,
    SignedScalarOrArray,
    Strict,
)


class Choice(Strict):
    """Fields of which exactly one is given, the control."""

    accompanying: ClassVar[frozenset[str]] = frozenset()
    """Fields that can accompany any control."""

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: Handler) -> dict[str, Any]:
        """Return the JSON schema of alternative objects, one for each control."""
        reference = super().__get_pydantic_json_schema__(core, handler)
        schema = handler.resolve_ref_schema(reference)
        fields, extra = schema.pop("properties"), schema.pop("additionalProperties")
        optional = {name: fields.pop(name) for name in sorted(cls.accompanying)}
        schema["oneOf"] = [
            {
                "title": cls.__name__ + "By" + name.title().replace("_", ""),
                "type": "object",
                "properties": {name: field, **optional},
                "required": [name],
                "additionalProperties": extra,
            }
            for name, field in fields.items()
        ]
        return reference

    @model_validator(mode="after")
    def _exactly_one(self) -> Self:
        if len(self.model_fields_set - self.accompanying) != 1:
            names = ", ".join(
                name for name in type(self).model_fields if name not in self.accompanying
            )
            raise PydanticCustomError("one_control", f"exactly one of {names} is needed")
        return self

    @cached_property
    def control(self) -> str:
        """Name of the control."""
        (name,) = self.model_fields_set - self.accompanying
        return name

    @property
    def value(self) -> float | list[float]:
        """Value or values of the control."""
        given: float | list[float] = getattr(self, self.control)
        return given

    @property
    def count(self) -> int:
        """Number of values."""
        value = self.value
        return len(value) if isinstance(value, list) else 1


class Load(Choice):
    """Normal load, with adhesion down to the pull-off: exactly one control, a number or a list."""

    indentation_depth: SignedScalarOrArray = ABSENT
    """Indentation depth d [length]"""
    normal_force: SignedScalarOrArray = ABSENT
    """Normal force F_N [force]"""
    contact_radius: ScalarOrArray = ABSENT
    """Contact radius a [length]"""
    maximum_pressure: ScalarOrArray = ABSENT
    """Largest pressure p(r); not for tables, adhesion, or profiles with a sharp tip or edge
    [pressure]"""


class Tangential(Choice):
    """Tangential load: exactly one control, one value for all normal loads or one for each."""

    tangential_force: SignedScalarOrArray = ABSENT
    """Tangential force F_x, |F_x| ≤ µ F_N [force]"""
    tangential_displacement: SignedScalarOrArray = ABSENT
    """Tangential displacement u_x of the bodies [length]"""
    stick_radius: ScalarOrArray = ABSENT
    """Stick radius c, at most a, not inside a flat [length]"""


class Torsion(Choice):
    """Twist about the axis: exactly one control, one value for all normal loads or one for each."""

    torque: SignedScalarOrArray = ABSENT
    """Torque M, |M| below µ F_N times `torsion_arm` [force*length]"""
    rotation: SignedScalarOrArray = ABSENT
    """Rotation φ of the bodies in radians [1]"""
    stick_radius: ScalarOrArray = ABSENT
    """Stick radius c, at most a [length]"""


class BodyMaterial(Strict):
    """Elastic body."""

    youngs_modulus: Positive
    """Young's modulus E [pressure]"""
    poissons_ratio: PoissonsRatio
    """Poisson's ratio ν [1]"""
    held: materials.Held = ABSENT
    """Support of a round body, on which `model_error` depends: between two `contacts` (default), on
    a `stem` or by its equator, `free`, or as a bump of a `block`. Impacts take `free`"""


# The schema is an enumeration, because client generators accept no constant in a choice.
_Rigid = Annotated[Literal["rigid"], WithJsonSchema({"type": "string", "enum": ["rigid"]})]
BodyOrRigid = Annotated[
    Annotated[_Rigid, Tag("<rigid>")] | Annotated[BodyMaterial, Tag("<body>")],
    Discriminator(lambda value: "<rigid>" if isinstance(value, str) else "<body>"),
]


def as_body(given: BodyMaterial | str) -> materials.Body | Literal["rigid"]:
    """Return a body of the core."""
    if isinstance(given, str):
        return materials.RIGID
    return materials.Body(**given.model_dump(exclude_unset=True))


class ElasticLayer(Strict):
    """Elastic layer on a rigid base: the more compliant body."""

    thickness: Positive
    """Thickness h of the layer [length]"""
    base: materials.Base
    """Condition of the layer at its base: `bonded`, or `frictionless` if it slides"""
    poissons_ratio: PoissonsRatio = ABSENT
    """Poisson's ratio ν of the layer, needed on a bonded base unless the material has it [1]"""


class OnBase(Strict):
    """Thickness of the more compliant body, or the layer that it is."""

    body_thickness: Positive = ABSENT
    """Thickness h of the more compliant body, bonded to a rigid base, for `model_error` and the
    warning `thin_body`; half-spaces remain the model of the contact [length]"""
    layer: ElasticLayer = ABSENT
    """Layer on a rigid base, with which `/v1/normal` (adhesive contacts too), the normal fields of
    `/v1/stress` and `/v1/normal/fit` compute, up to a = 10 h; E* is the modulus of half-spaces of
    the same materials"""

    @property
    def on_base(self) -> materials.Layer | None:
        """Layer of the core, None where there is none."""
        return materials.Layer(**vars(self.layer)) if self.has("layer") else None


class Elastic(OnBase):
    """Material of a contact."""

    yield_strength: Positive = ABSENT
    """Yield strength Y of the softer body, in uniaxial tension; the response carries the warning
    `yield` where Tresca's criterion is met [pressure]"""
    work_of_adhesion: Positive = ABSENT
    """Work of adhesion w, an energy per area: the contact is adhesive (JKR), without friction
    [force/length]"""
    range_of_adhesion: Positive = ABSENT
    """Distance over which the surfaces attract, for the warning `jkr_range`; with
    `work_of_adhesion` [length]"""


class Bodies(Elastic):
    """Material given by the two bodies, one of which may be rigid."""

    bodies: Annotated[list[BodyOrRigid], Field(min_length=2, max_length=2)]
    """The two bodies; at most one may be `rigid` [list]"""

    @cached_property
    def effective(self) -> materials.Material:
        """Effective moduli."""
        return materials.from_bodies(
            [as_body(each) for each in self.bodies],
            body_thickness=self.body_thickness,
            layer=self.on_base,
        )


class Moduli(Elastic):
    """Material given by the effective moduli of the contact."""

    e_star: Positive
    """Effective modulus E*, 1/E* = Σ (1 − νᵢ²)/Eᵢ [pressure]"""
    g_star: Positive = ABSENT
    """Effective shear modulus G*, 1/G* = Σ (2 − νᵢ)/(4Gᵢ); needed only with friction [pressure]"""
    shear_modulus: Positive = ABSENT
    """Shear modulus G of a twist, 1/G = 1/G₁ + 1/G₂; G₁/2 for equal bodies [pressure]"""
    poissons_ratio: PoissonsRatio = ABSENT
    """Poisson's ratio ν of the elastic body, needed for stresses beneath its surface; elsewhere
    only warnings and `model_error` depend on it, for which 0.3 is assumed [1]"""

    @cached_property
    def effective(self) -> materials.Material:
        """Effective moduli."""
        known = (self.poissons_ratio,) if self.has("poissons_ratio") else ()
        layer = self.on_base
        if layer is not None and layer.poissons_ratio is None:
            layer = replace(layer, poissons_ratio=self.poissons_ratio)
        return materials.Material(
            self.e_star,
            self.g_star,
            poissons_ratios=known,
            body_thickness=self.body_thickness,
            shear_modulus=self.shear_modulus,
            layer=layer,
        )


Material = Annotated[
    Annotated[Moduli, Tag("<moduli>")] | Annotated[Bodies, Tag("<bodies>")],
    Discriminator(
        lambda value: "<bodies>" if isinstance(value, dict) and "bodies" in value else "<moduli>"
    ),
]


# Fields of several models.
HoldsWithin = Annotated[
    float,
    Field(
        ge=LEAST_CHANGE,
        le=MOST_CHANGE,
        description="Admissible relative change of a result by each effect that the model leaves "
        "out (adhesion, slip, thickness, yield, shape); `holds_while` lists the limits [1]",
    ),
]
Friction = Annotated[float, Field(ge=1e-15, le=1e6, description="Coefficient of friction µ [1]")]

LOADS = ("load", "tangential", "torsion", "oscillation")
"""Fields of the loads, normal and tangential."""


class Axes(NamedTuple):
    """Axes of the picture of a result without radii: members of the result."""

    x: str
    y: tuple[str, ...]
    """Ordinates, each with a panel of its own."""
    curves: str = ""
    """Member of which each value has a curve of its own."""
    in_order: bool = False
    """True if the curve joins the entries in their own order."""
    is_measured: bool = False
    """True if the first ordinate is fitted to measured values, and the second holds the
    residuals."""


class Query(Strict):
    """Profile and material of every query."""

    axes: ClassVar[Axes] = Axes("indentation_depth", ("normal_force",))
    """Axes of a picture, unless the result has radii."""
    refused: ClassVar[dict[str, str]] = {}
    """Members of other queries that this one cannot have, with the reason."""
    by_parameters: ClassVar[str] = ""
    """Title of the endpoint `GET`; empty where a request does not consist of numbers."""
    is_long: ClassVar[bool] = False
    """True if every query runs in a compute process."""

    profile: Profile
    material: Material
    """Elastic constants: effective moduli, or two bodies."""

    @property
    def controls(self) -> dict[str, Choice]:
        """Given loads by the name of their field; empty for a load path."""
        fields = vars(self)
        return {name: fields[name] for name in LOADS if fields.get(name)}

    @property
    def loads(self) -> int:
        """Number of entries over the loads in the response."""
        return max([control.count for control in self.controls.values()] or [1])

    @property
    def path(self) -> Any:
        """Load path (`schemas.load_paths.LoadPath`), None without one."""
        return None

    @property
    def numbers(self) -> int:
        """Number of values over the radius, or over positions, in the response."""
        return 0


class NormalQuery(Query):
    """Profile pressed into an elastic half-space without friction."""

    by_parameters = "Normal contact"

    holds_within: HoldsWithin = ABSENT
    load: Load


class TangentialQuery(NormalQuery):
    """Contact with friction, loaded normally first and then tangentially."""

    axes = Axes("tangential_displacement", ("tangential_force",), curves="normal_force")
    by_parameters = "Partial slip"

    friction_coefficient: Friction
    tangential: Tangential
