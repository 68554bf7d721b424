"""Requests about fields over the radius."""

from typing import Annotated, Any, Final, Literal, TypeVar

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from mdr_service.schemas.contacts import Friction, HoldsWithin, Load, Query, Tangential
from mdr_service.schemas.load_paths import History, LoadPath
from mdr_service.schemas.quantities import ABSENT, Many, Size, one_of
from mdr_service.settings import SETTINGS

_Name = TypeVar("_Name", bound=str)
FieldName = Literal[
    "pressure",
    "shear_stress",
    "slip",
    "normal_displacement",
    "foundation_load",
    "foundation_shear",
]
SHEAR_FIELDS: Final = frozenset({"shear_stress", "slip", "foundation_shear"})


class FieldQuery(Query):
    """Query of fields at given radii, or at radii that the service chooses."""

    radius: Many[Size] = ABSENT
    """Radii r of the fields, in any order. `error_estimate` does not apply at radii within four
    units in the last place of a contact radius or slip front, where a stress varies like a square
    root [length]"""
    points: Annotated[int, Field(ge=2, le=SETTINGS.max_length)] = ABSENT
    """Number of radii that the service chooses in place of a list, from 0 to beyond the contact or
    the worn annulus, clustered at the singular radii [1]"""
    quantities: list[Any]

    @property
    def radii(self) -> int:
        """Number of radii, also if `radius` and `points` are both given or both absent."""
        return len(self.radius or ()) + (self.points or 0)

    @property
    def numbers(self) -> int:
        return self.loads * self.radii * len(self.quantities)


def _once_each(names: list[_Name]) -> list[_Name]:
    if len(set(names)) < len(names):
        raise PydanticCustomError("not_unique", "each quantity can be requested once")
    return names


OnceEach = Annotated[
    list[_Name],
    Field(min_length=1, json_schema_extra={"uniqueItems": True}),
    AfterValidator(_once_each),
]
"""Type of a list of names without repetition."""


class LoadedQuery(Query):
    """Query of a contact under loads, with or without friction, or at the end of a load path."""

    load: Load = ABSENT
    """Exactly one control of the normal load."""
    friction_coefficient: Friction = ABSENT
    tangential: Tangential = ABSENT
    """Exactly one control, with `friction_coefficient`."""
    history: History = ABSENT
    """In place of `load` and `tangential`: load path, at whose end the fields are computed. With
    `friction_coefficient`."""

    @property
    def path(self) -> LoadPath | None:
        return self.history


NEEDED: Final = {
    "tangential": ["load", "friction_coefficient"],
    "history": ["friction_coefficient"],
}
"""Members of a `LoadedQuery` that require other members, in the form of `dependentRequired`."""


_STRESS: Final[dict[str, Any]] = {
    "allOf": [one_of("radius", "points"), one_of("load", "history")],
    "dependentRequired": NEEDED,
}


class StressQuery(LoadedQuery, FieldQuery, json_schema_extra=_STRESS):
    """Fields of a contact over the radius, with or without friction."""

    by_parameters = "Fields over the radius"

    holds_within: HoldsWithin = ABSENT
    quantities: OnceEach[FieldName]
    """Fields to compute, each once; shear_stress, slip and foundation_shear need `tangential` or
    `history`"""
