"""The requests about fretting wear: the shape it tends to, and the way there over the cycles."""

from typing import Annotated, Any, Final, Literal

from pydantic import AfterValidator, Field

from mdr_service.schemas.loads import HeldLoad, HeldPoint, Oscillation, TangentialSwing
from mdr_service.schemas.quantities import Size, drop_null_defaults, positive, quantity
from mdr_service.schemas.queries import (
    Query,
    chosen_places,
    friction,
    once_each,
    places,
)
from mdr_service.settings import SETTINGS

WearField = Literal["initial_profile", "limiting_profile", "worn_depth", "pressure"]
EvolutionField = Literal["profile", "worn_depth", "pressure"]

_MOST_CYCLES: Final = 1e12


def _describe(schema: dict[str, Any]) -> None:
    drop_null_defaults(schema)
    either = [{"required": [name]} for name in ("radius", "points")]
    schema["not"] = {"required": ["radius", "points"]}
    schema["dependentSchemas"] = {"quantities": {"anyOf": either}}


def _quantities(default: list[str]) -> Any:
    return Field(
        default=default,
        description="What to answer over the radius, each once; with `radius` or `points`",
        min_length=1,
        json_schema_extra={"uniqueItems": True},
    )


class _Wearing(Query, json_schema_extra=_describe):
    friction_coefficient: float = friction()
    radius: list[Size] = places()
    points: int = chosen_places("from 0 to beyond what wears, close together at its edges")

    @property
    def radii(self) -> int:
        """How many radii it is about, also where both ways to say so were taken."""
        return len(self.radius or ()) + (self.points or 0)


class WearQuery(_Wearing):
    """A contact that wears under a small tangential oscillation, to the end."""

    load: HeldLoad = Field(description="Exactly one control, which is held: depth or normal force.")
    oscillation: Oscillation = Field(
        description="Exactly one amplitude, which is held: displacement or tangential force."
    )
    quantities: Annotated[list[WearField], AfterValidator(once_each)] = _quantities(
        ["initial_profile", "limiting_profile"]
    )

    @property
    def loads(self) -> int:
        """How many pairs of load and amplitude it is about."""
        return max(self.load.count, self.oscillation.count)

    def place(self, index: int) -> tuple[str | int, ...]:
        """Return the path to one of the loads."""
        return ("load", *self.load.place(index))


class EvolutionQuery(_Wearing):
    """A contact that wears under a small tangential oscillation, over the cycles."""

    load: HeldPoint = Field(
        description="Exactly one control, which is held: depth or normal force."
    )
    oscillation: TangentialSwing = Field(
        description="Exactly one amplitude, which is held: displacement or, where the normal force "
        "is held, tangential force; less than where all slips."
    )
    wear_coefficient: float = positive("1/pressure", "Worn volume K per dissipated energy")
    cycles: list[Annotated[float, Field(ge=0, le=_MOST_CYCLES)]] = quantity(
        "1",
        "Numbers of cycles at which to answer, ascending, up to 1e12",
        min_length=1,
        max_length=SETTINGS.max_cycles,
        fail_fast=True,
    )
    resolution: int = quantity(
        "1",
        "Nodes over the worn rim; twice as many take four times as long",
        default=24,
        ge=8,
        le=96,
    )
    rtol: float = quantity(
        "1",
        "Tolerance of the integration over the cycles; for digits the resolution counts as well",
        default=1e-6,
        ge=1e-10,
        le=1e-3,
    )
    quantities: Annotated[list[EvolutionField], AfterValidator(once_each)] = _quantities(
        ["profile", "pressure"]
    )

    @property
    def loads(self) -> int:
        """How many numbers of cycles it is about."""
        return len(self.cycles)

    def place(self, _index: int) -> tuple[str | int, ...]:
        """Return the path to the load."""
        return ("load", self.load.control)
