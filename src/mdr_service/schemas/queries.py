"""The requests: what is pressed by what, how hard, and how exactly it is to be known."""

from itertools import permutations
from typing import Annotated, Any, Final, Literal, Self

from pydantic import AfterValidator, Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from mdr_service.schemas.profiles import Profile, Tabulated
from mdr_service.schemas.quantities import (
    ScalarOrArray,
    SignedScalarOrArray,
    Size,
    Strict,
    drop_null_defaults,
    positive,
    quantity,
)
from mdr_service.settings import SETTINGS


class Body(Strict):
    """One elastic body."""

    youngs_modulus: float = positive("pressure", "Young's modulus E")
    poissons_ratio: float = quantity("1", "Poisson's ratio ν", gt=-1, le=0.5)


def _word_or_body(value: object) -> str:
    return "word" if isinstance(value, str) else "body"


BodyOrRigid = Annotated[
    Annotated[Literal["rigid"], Tag("word")] | Annotated[Body, Tag("body")],
    Discriminator(_word_or_body),
]


class Elastic(Strict):
    """What every way to describe a material may say."""

    # May be left out, but not null; hence a plain float with a default that is none.
    yield_strength: float = positive(
        "pressure", "Yield strength Y; with it a warning says where Tresca's is met", default=None
    )


class Bodies(Elastic):
    """The material by its two bodies, one of which may be rigid."""

    bodies: list[BodyOrRigid] = quantity(
        "list", "The two bodies; at most one may be the word rigid", min_length=2, max_length=2
    )


class Moduli(Elastic):
    """The material by the effective moduli of the contact."""

    e_star: float = positive("pressure", "Effective modulus E* = 1/Σ(1 − νᵢ²)/Eᵢ")
    g_star: float = positive(
        "pressure", "Effective shear modulus G*, needed only with friction", default=None
    )


def _bodies_or_moduli(value: object) -> str:
    return "bodies" if isinstance(value, dict) and "bodies" in value else "moduli"


Material = Annotated[
    Annotated[Moduli, Tag("moduli")] | Annotated[Bodies, Tag("bodies")],
    Discriminator(_bodies_or_moduli),
    Field(description="The elastic constants: effective moduli, or two bodies."),
]


def _describe_choice(schema: dict[str, Any]) -> None:
    drop_null_defaults(schema)
    schema["oneOf"] = [{"required": [name]} for name in schema["properties"]]


class Choice(Strict, json_schema_extra=_describe_choice):
    """Fields of which exactly one is given."""

    @model_validator(mode="after")
    def _exactly_one(self) -> Self:
        if len(self.model_fields_set) != 1:
            names = ", ".join(type(self).model_fields)
            raise PydanticCustomError("one_control", f"exactly one of {names} is needed")
        return self

    @property
    def control(self) -> str:
        """The name of the one that is given."""
        (name,) = self.model_fields_set
        return name

    @property
    def value(self) -> float | list[float]:
        """The one that is given."""
        given: float | list[float] = getattr(self, self.control)
        return given

    @property
    def count(self) -> int:
        """How many values are given."""
        return len(self.value) if isinstance(self.value, list) else 1

    def place(self, index: int) -> tuple[str | int, ...]:
        """Return the path from here to one of the values."""
        return (self.control, index) if isinstance(self.value, list) else (self.control,)


class Load(Choice):
    """Exactly one control, a number or a list of them, each 0 or from 1e-90 to 1e30."""

    # A control that is left out is none; one that is given is never null.
    indentation_depth: ScalarOrArray = quantity("length", "Depth d of indentation", default=None)
    normal_force: ScalarOrArray = quantity("force", "Normal force F_N", default=None)
    contact_radius: ScalarOrArray = quantity("length", "Radius a of the contact", default=None)


class Tangential(Choice):
    """Exactly one control, a number or a list: one for all normal loads, or as many as they."""

    tangential_force: SignedScalarOrArray = quantity(
        "force", "Tangential force F_x, |F_x| ≤ µ F_N, of either sign", default=None
    )
    tangential_displacement: SignedScalarOrArray = quantity(
        "length", "Tangential displacement u_x of the bodies, of either sign", default=None
    )
    stick_radius: ScalarOrArray = quantity(
        "length", "Radius c of the stick zone, at most a, and not inside a flat", default=None
    )


class NormalQuery(Strict):
    """A profile pressed into an elastic half-space without friction."""

    profile: Profile
    material: Material
    load: Load = Field(description="Exactly one control: depth, force or contact radius.")
    rtol: float = quantity(
        "1", "Relative accuracy that is needed", default=1e-10, ge=1e-13, le=1e-3
    )

    @property
    def size(self) -> int:
        """How many numbers it is about."""
        table = len(self.profile.r) if isinstance(self.profile, Tabulated) else 0
        return table + self.loads

    @property
    def loads(self) -> int:
        """How many loads it is about."""
        return self.load.count

    def place(self, index: int) -> tuple[str | int, ...]:
        """Return the path to one of the loads."""
        return ("load", *self.load.place(index))


def _friction_coefficient(**field: Any) -> Any:
    return positive("1", "Coefficient of friction µ", low=1e-15, high=1e6, **field)


class TangentialQuery(NormalQuery):
    """A contact with friction, pressed first and then loaded tangentially."""

    friction_coefficient: float = _friction_coefficient()
    tangential: Tangential = Field(
        description="Exactly one control: force, displacement or radius of the stick zone."
    )

    @property
    def loads(self) -> int:
        """How many pairs of normal and tangential load it is about."""
        return max(self.load.count, self.tangential.count)


FieldName = Literal[
    "pressure",
    "shear_stress",
    "slip",
    "normal_displacement",
    "foundation_load",
    "foundation_shear",
]


# The fields that friction brings.
SHEAR_FIELDS: Final = frozenset({"shear_stress", "slip", "foundation_shear"})


def _left_out(description: str) -> Any:
    """Return a field that may be left out, but not be null."""
    return Field(default=None, description=description)


def _describe_stress(schema: dict[str, Any]) -> None:
    drop_null_defaults(schema)
    schema["oneOf"] = [{"required": ["radius"]}, {"required": ["points"]}]
    together = ("friction_coefficient", "tangential")
    schema["dependentRequired"] = {one: [other] for one, other in permutations(together)}


def _once_each(names: list[FieldName]) -> list[FieldName]:
    if len(set(names)) < len(names):
        raise PydanticCustomError("not_unique", "each quantity can be asked for once")
    return names


class StressQuery(NormalQuery, json_schema_extra=_describe_stress):
    """The fields of a contact over the radius, with friction or without."""

    friction_coefficient: float = _friction_coefficient(default=None)
    tangential: Tangential = _left_out("Exactly one control, with `friction_coefficient`.")
    radius: list[Size] = quantity(
        "length",
        "Radii r at which the fields are answered, in any order",
        default=None,
        min_length=1,
        max_length=SETTINGS.max_radii,
        fail_fast=True,
    )
    points: int = quantity(
        "1",
        "How many radii to choose, from 0 to 1.5 a, close together where the fields change fast",
        default=None,
        ge=2,
        le=SETTINGS.max_radii,
    )
    quantities: Annotated[list[FieldName], AfterValidator(_once_each)] = Field(
        description=(
            "The fields to answer, each once; shear_stress, slip and foundation_shear need "
            "`tangential`"
        ),
        min_length=1,
        json_schema_extra={"uniqueItems": True},
    )

    @property
    def loads(self) -> int:
        """How many loads, or pairs of loads, it is about."""
        return max(self.load.count, self.tangential.count if self.has_friction else 1)

    @property
    def has_friction(self) -> bool:
        """Whether there is a tangential load."""
        return "tangential" in self.model_fields_set

    @property
    def radii(self) -> int:
        """How many radii it is about, also where both or neither way to say so was taken."""
        return len(self.radius or ()) + (self.points or 0)

    @property
    def size(self) -> int:
        return super().size + self.loads * self.radii


# After these fields (or their items) pydantic names the branch of a union in the location of an
# error; the branch is no part of the request.
UNION_FIELDS = frozenset({"profile", "material", *Load.model_fields, *Tangential.model_fields})
UNION_ITEMS = frozenset({"bodies"})
