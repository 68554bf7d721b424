"""The requests: what is pressed by what, how hard, and how exactly it is to be known."""

from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from mdr_service.schemas.profiles import Profile, Tabulated
from mdr_service.schemas.quantities import (
    ScalarOrArray,
    Strict,
    drop_null_defaults,
    positive,
    quantity,
)


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


class Bodies(Strict):
    """The material by its two bodies, one of which may be rigid."""

    bodies: list[BodyOrRigid] = quantity(
        "list", "The two bodies; at most one may be the word rigid", min_length=2, max_length=2
    )


class Moduli(Strict):
    """The material by the effective moduli of the contact."""

    e_star: float = positive("pressure", "Effective modulus E* = 1/Σ(1 − νᵢ²)/Eᵢ")
    # May be left out, but not null; hence a plain float with a default that is none.
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

_CONTROLS = ("indentation_depth", "normal_force", "contact_radius")


def _describe_load(schema: dict[str, Any]) -> None:
    drop_null_defaults(schema)
    schema["oneOf"] = [{"required": [name]} for name in _CONTROLS]


class Load(Strict, json_schema_extra=_describe_load):
    """Exactly one control, a number or a list of them, each 0 or from 1e-90 to 1e30."""

    # A control that is left out is none; one that is given is never null.
    indentation_depth: ScalarOrArray = quantity("length", "Depth d of indentation", default=None)
    normal_force: ScalarOrArray = quantity("force", "Normal force F_N", default=None)
    contact_radius: ScalarOrArray = quantity("length", "Radius a of the contact", default=None)

    @model_validator(mode="after")
    def _exactly_one(self) -> Self:
        if len(self.model_fields_set) != 1:
            raise PydanticCustomError(
                "one_control", "exactly one of " + ", ".join(_CONTROLS) + " is needed"
            )
        return self


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
        table = self.profile.r if isinstance(self.profile, Tabulated) else ()
        (control,) = self.load.model_fields_set
        loads = getattr(self.load, control)
        return len(table) + (len(loads) if isinstance(loads, list) else 1)


# After these fields (or their items) pydantic names the branch of a union in the location of an
# error; the branch is no part of the request.
UNION_FIELDS = frozenset({"profile", "material", *_CONTROLS})
UNION_ITEMS = frozenset({"bodies"})
