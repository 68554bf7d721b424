"""Parts of requests and responses, and types of their numbers: strict, finite, bounded.

Fields are described by their docstrings, which end with the dimension of a quantity in brackets.
"""

import re
from typing import Annotated, Any, Final, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Discriminator, Field, Tag
from pydantic import GetJsonSchemaHandler as Handler
from pydantic_core import CoreSchema, PydanticCustomError

from mdr_service.settings import SETTINGS

SMALLEST: Final = 1e-50
"""Smallest magnitude of a number that is not 0: any unit system fits."""
LARGEST: Final = 1e50
"""Largest magnitude of a number."""
ABSENT: Final[Any] = None
"""Default of a field that can be left out, such as one of several controls, but is not null."""


class Strict(BaseModel):
    """Part of a request or response; values are not converted, and unknown fields are rejected."""

    model_config = ConfigDict(
        strict=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True
    )

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: Handler) -> dict[str, Any]:
        """Return the JSON schema, with the dimensions of quantities as `x-dimension`.

        The descriptions state the defaults, because client generators would make members that have
        a default required.
        """
        reference = handler(core)
        schema = handler.resolve_ref_schema(reference)
        for member in schema.get("properties", {}).values():
            meaning, dimension = described(member.get("description"))
            default = member.pop("default", None)
            if default is not None:
                shown = ", ".join(default) or "none" if isinstance(default, list) else default
                meaning = f"{meaning.removesuffix('.')}; default {shown}"
            if meaning:
                member["description"] = f"{meaning} [{dimension}]" if dimension else meaning
            if dimension:
                member["x-dimension"] = dimension
        return reference

    def has(self, name: str) -> bool:
        """Return True if a field is given."""
        return name in self.model_fields_set


def described(text: str | None) -> tuple[str, str]:
    """Return the meaning and the dimension of a field, empty without one, by its description."""
    line = " ".join((text or "").split())
    meaning, _, dimension = line.rpartition(" [") if line.endswith("]") else (line, "", "")
    return meaning, dimension.removesuffix("]")


def heading(description: str) -> str:
    """Return the label of a quantity: its description up to a punctuation mark or a bracket."""
    return re.split(r"[,;:]| ?\[", description)[0].replace("(r)", "")


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
Positive = Annotated[float, Field(ge=SMALLEST, le=LARGEST)]
PoissonsRatio = Annotated[float, Field(gt=-1, le=0.5)]

BRANCHES: Final = frozenset({"<number>", "<list>", "<rigid>", "<body>", "<moduli>", "<bodies>"})
"""Branches of unions, which pydantic inserts into the location of an error."""

_Number = TypeVar("_Number")
# Only the first invalid element is reported: a list may have a hundred thousand.
Many = Annotated[list[_Number], Field(min_length=1, max_length=SETTINGS.max_length, fail_fast=True)]
_OneOrMany = Annotated[
    Annotated[_Number, Tag("<number>")] | Annotated[Many[_Number], Tag("<list>")],
    # The discriminator restricts errors to the branch to which the value belongs.
    Discriminator(lambda value: "<list>" if isinstance(value, list) else "<number>"),
]
ScalarOrArray = _OneOrMany[Size]
SignedScalarOrArray = _OneOrMany[Signed]
