"""Numbers of a request: strict, finite, bounded, each with its dimension."""

import re
from typing import Annotated, Any, Final, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from mdr_service.settings import SETTINGS

SMALLEST: Final = 1e-50
"""Smallest magnitude of a number that is not 0: any unit system fits."""
LARGEST: Final = 1e50
"""Largest magnitude of a number."""


class Strict(BaseModel):
    """Part of a request; values are not converted, and unknown fields are rejected."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    def has(self, name: str) -> bool:
        """Return True if a field is given."""
        return name in self.model_fields_set


def positive(
    dimension: str, meaning: str, *, low: float = SMALLEST, high: float = LARGEST, **field: Any
) -> Any:
    """Return the field of a positive number.

    Parameters
    ----------
    dimension : dimension of the number, for example ``length``.
    meaning : description of the number.
    low, high : bounds, both included.
    field : other arguments of `pydantic.Field`.
    """
    return quantity(dimension, meaning, ge=low, le=high, **field)


def quantity(dimension: str, meaning: str, **field: Any) -> Any:
    """Return a field whose description ends with its dimension."""
    return Field(
        description=f"{meaning} [{dimension}]",
        json_schema_extra={"x-dimension": dimension},
        **field,
    )


def optional(dimension: str, meaning: str, **field: Any) -> Any:
    """Return the field of a number that can be left out, such as one of several controls."""
    return quantity(dimension, meaning, default=None, **field)


def heading(description: str) -> str:
    """Return the label of a quantity: its description up to a punctuation mark or a bracket."""
    return re.split(r"[,;:]| ?\[", description)[0].replace("(r)", "")


# Only the first invalid element is reported: a list may have a hundred thousand.
MANY: Final[dict[str, Any]] = {
    "min_length": 1,
    "max_length": SETTINGS.max_length,
    "fail_fast": True,
}
"""Arguments of the field of a list."""


def places(meaning: str) -> Any:
    """Return the optional field of a list of radii, coordinates or depths."""
    return optional("length", meaning, **MANY)


def poissons_ratio(meaning: str, **field: Any) -> Any:
    """Return the field of a Poisson's ratio."""
    return quantity("1", meaning, gt=-1, le=0.5, **field)


def left_out(description: str) -> Any:
    """Return a field that is optional, but not null."""
    return Field(default=None, description=description)


def one_of(*names: str) -> dict[str, Any]:
    """Return the schema that requires exactly one of the fields."""
    return {"oneOf": [{"required": [name]} for name in names]}


def _not_tiny(value: float) -> float:
    if -SMALLEST < value < SMALLEST and value != 0:
        raise PydanticCustomError("tiny", f"must be 0 or at least {SMALLEST} in magnitude")
    return value


_NotTiny = AfterValidator(_not_tiny)
_KEYWORD: Final = {"x-smallest-magnitude": SMALLEST}
Size = Annotated[float, Field(ge=0, le=LARGEST, json_schema_extra=_KEYWORD), _NotTiny]
Signed = Annotated[float, Field(ge=-LARGEST, le=LARGEST, json_schema_extra=_KEYWORD), _NotTiny]

BRANCHES: Final = frozenset({"<number>", "<list>", "<rigid>", "<body>", "<moduli>", "<bodies>"})
"""Branches of unions, which pydantic inserts into the location of an error."""

_Number = TypeVar("_Number")
_OneOrMany = Annotated[
    Annotated[_Number, Tag("<number>")] | Annotated[list[_Number], Field(**MANY), Tag("<list>")],
    # The discriminator restricts errors to the branch to which the value belongs.
    Discriminator(lambda value: "<list>" if isinstance(value, list) else "<number>"),
]
ScalarOrArray = _OneOrMany[Size]
SignedScalarOrArray = _OneOrMany[Signed]
