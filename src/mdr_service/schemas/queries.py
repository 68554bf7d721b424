"""The requests: what is pressed by what, how hard, and how exactly it is to be known."""

from typing import Annotated, Any, Final, Literal, TypeVar

from pydantic import AfterValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from mdr_service.schemas.loads import Choice, Cycles, History, Load, Tangential
from mdr_service.schemas.profiles import Profile
from mdr_service.schemas.quantities import (
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


class Query(Strict):
    """What every request is about."""

    profile: Profile
    material: Material
    rtol: float = quantity(
        "1", "Relative accuracy that is needed", default=1e-10, ge=1e-13, le=1e-3
    )


class NormalQuery(Query):
    """A profile pressed into an elastic half-space without friction."""

    load: Load = Field(description="Exactly one control: depth, force or contact radius.")

    @property
    def loads(self) -> int:
        """How many loads it is about."""
        return self.load.count

    def place(self, index: int) -> tuple[str | int, ...]:
        """Return the path to one of the loads."""
        return ("load", *self.load.place(index))


def friction(**field: Any) -> Any:
    """Return the field of a coefficient of friction."""
    return positive("1", "Coefficient of friction µ", low=1e-15, high=1e6, **field)


def left_out(description: str) -> Any:
    """Return a field that may be left out, but not be null."""
    return Field(default=None, description=description)


def places() -> Any:
    """Return the field of the radii at which fields are answered."""
    return quantity(
        "length",
        "Radii r at which the fields are answered, in any order",
        default=None,
        min_length=1,
        max_length=SETTINGS.max_radii,
        fail_fast=True,
    )


def chosen_places(meaning: str) -> Any:
    """Return the field of how many radii to choose, in their place."""
    return quantity(
        "1", f"How many radii to choose, {meaning}", default=None, ge=2, le=SETTINGS.max_radii
    )


class TangentialQuery(NormalQuery):
    """A contact with friction, pressed first and then loaded tangentially."""

    friction_coefficient: float = friction()
    tangential: Tangential = Field(
        description="Exactly one control: force, displacement or radius of the stick zone."
    )

    @property
    def loads(self) -> int:
        """How many pairs of normal and tangential load it is about."""
        return max(self.load.count, self.tangential.count)


def one_of(*names: str) -> dict[str, Any]:
    """Return the schema of exactly one of the fields."""
    return {"oneOf": [{"required": [name]} for name in names]}


def _describe_history(schema: dict[str, Any]) -> None:
    drop_null_defaults(schema)
    schema |= one_of("history", "cycles")


class HistoryQuery(Query, json_schema_extra=_describe_history):
    """A contact with friction under loads that come and go."""

    friction_coefficient: float = friction()
    history: History = left_out("The points that the loads go through.")
    cycles: Cycles = left_out("In place of `history`: equal cycles of the tangential load.")

    @property
    def has_cycles(self) -> bool:
        """Whether it is told by cycles."""
        return "cycles" in self.model_fields_set

    def place(self, index: int) -> tuple[str | int, ...]:
        """Return the path to what says where the normal load goes, on the way to a sample."""
        way: History | Cycles = self.cycles if self.has_cycles else self.history
        name = "cycles" if self.has_cycles else "history"
        return (name, *way.place("normal", index // way.samples_per_step))


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
_Name = TypeVar("_Name", bound=str)


def _describe_stress(schema: dict[str, Any]) -> None:
    drop_null_defaults(schema)
    schema["allOf"] = [one_of("radius", "points"), one_of("load", "history")]
    schema["dependentRequired"] = {
        "tangential": ["load", "friction_coefficient"],
        "history": ["friction_coefficient"],
    }
    schema["dependentSchemas"] = {"friction_coefficient": one_of("tangential", "history")}


def once_each(names: list[_Name]) -> list[_Name]:
    """Return the names, unless one is there twice."""
    if len(set(names)) < len(names):
        raise PydanticCustomError("not_unique", "each quantity can be asked for once")
    return names


class StressQuery(NormalQuery, json_schema_extra=_describe_stress):
    """The fields of a contact over the radius, with friction or without."""

    load: Load = left_out("Exactly one control: depth, force or contact radius.")
    friction_coefficient: float = friction(default=None)
    tangential: Tangential = left_out("Exactly one control, with `friction_coefficient`.")
    history: History = left_out(
        "In place of `load` and `tangential`: the points that the loads go through; the fields "
        "are those of its end. With `friction_coefficient`."
    )
    radius: list[Size] = places()
    points: int = chosen_places("from 0 to 1.5 a, close together where the fields change fast")
    quantities: Annotated[list[FieldName], AfterValidator(once_each)] = Field(
        description=(
            "The fields to answer, each once; shear_stress, slip and foundation_shear need "
            "`tangential` or `history`"
        ),
        min_length=1,
        json_schema_extra={"uniqueItems": True},
    )

    @property
    def loads(self) -> int:
        """How many loads, or pairs of loads, it is about; of a history its end."""
        return max((control.count for control in self.controls), default=1)

    @property
    def controls(self) -> list[Choice]:
        """The loads that are given, where there is no history."""
        named: dict[str, Choice] = {"load": self.load, "tangential": self.tangential}
        return [control for name, control in named.items() if name in self.model_fields_set]

    @property
    def has_friction(self) -> bool:
        """Whether there is a tangential load."""
        return not self.model_fields_set.isdisjoint(("tangential", "history"))

    @property
    def has_history(self) -> bool:
        """Whether the loads come and go."""
        return "history" in self.model_fields_set

    @property
    def radii(self) -> int:
        """How many radii it is about, also where both or neither way to say so was taken."""
        return len(self.radius or ()) + (self.points or 0)

    def place(self, index: int) -> tuple[str | int, ...]:
        if self.has_history:
            return ("history", *self.history.place("normal", self.history.steps - 1))
        return super().place(index)


# After these fields (or their items) pydantic names the branch of a union in the location of an
# error; the branch is no part of the request.
UNION_FIELDS = frozenset({"profile", "material", *Load.model_fields, *Tangential.model_fields})
UNION_ITEMS = frozenset({"bodies"})
