"""Numbers as the wire knows them: strict, finite, bounded, each with its dimension."""

from typing import Annotated, Any, Final

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

from mdr_service.settings import SETTINGS

# Any unit system fits in here, and products of a few such numbers stay finite.
SMALLEST: Final = 1e-30
LARGEST: Final = 1e30
# Less load than this, but not none, leaves no digits for its squares and cubes.
SMALLEST_LOAD: Final = 1e-90


def drop_null_defaults(schema: dict[str, Any]) -> None:
    """Remove ``default: null``: a field may be left out, but null is refused."""
    for field in schema.get("properties", {}).values():
        if "default" in field and field["default"] is None:
            del field["default"]


class Strict(BaseModel):
    """A part of a request: nothing is coerced, nothing unknown is ignored."""

    model_config = ConfigDict(
        strict=True, extra="forbid", allow_inf_nan=False, json_schema_extra=drop_null_defaults
    )


def positive(
    dimension: str, meaning: str, *, low: float = SMALLEST, high: float = LARGEST, **field: Any
) -> Any:
    """Return the field of a positive number of this `dimension`."""
    return quantity(dimension, meaning, ge=low, le=high, **field)


def quantity(dimension: str, meaning: str, **field: Any) -> Any:
    """Return a field whose description ends in its dimension."""
    return Field(
        description=f"{meaning} [{dimension}]", json_schema_extra={"dimension": dimension}, **field
    )


def _scalar_or_array(value: object) -> str:
    return "array" if isinstance(value, list) else "scalar"


Size = Annotated[float, Field(ge=0, le=LARGEST)]
Signed = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]
# One bad element is told, not a hundred thousand.
_Many = Field(min_length=1, max_length=SETTINGS.max_loads, fail_fast=True)

# The discriminator keeps the errors of the branch that was not meant out of the answer.
ScalarOrArray = Annotated[
    Annotated[Size, Tag("scalar")] | Annotated[list[Size], _Many, Tag("array")],
    Discriminator(_scalar_or_array),
]
SignedScalarOrArray = Annotated[
    Annotated[Signed, Tag("scalar")] | Annotated[list[Signed], _Many, Tag("array")],
    Discriminator(_scalar_or_array),
]
