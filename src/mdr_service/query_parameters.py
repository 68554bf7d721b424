"""Queries by parameters: numbers, lists and at most one range of them, and names.

Each parameter corresponds to a field of the request, and is described by the schema of that field.
The request is then validated as usual; an error in a field is reported for its parameter.
"""

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import Annotated, Any, ClassVar, Final, Literal

import numpy as np
from pydantic import BeforeValidator, Field, WithJsonSchema, create_model
from pydantic_core import PydanticCustomError

from mdr_core.errors import InputError
from mdr_core.validation import FINITE
from mdr_service import problems
from mdr_service.content_negotiation import ResponseParameters
from mdr_service.queries import QUERIES
from mdr_service.schemas import contacts
from mdr_service.schemas.flat import leaves, nested
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.profiles import OF_NUMBERS
from mdr_service.sentences import NUMBER
from mdr_service.settings import SETTINGS

# A number is written as in JSON, or with a leading plus, as in spreadsheets.
_NUMBER: Final = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
# A number with a decimal comma, or with commas between thousands.
_ONE_NUMBER: Final = re.compile(r"[+-]?(?:[\d.]*,\d+|\d{1,3}(?:,\d{3})+(?:\.\d*)?)", re.ASCII)
_SEVERAL: Final = "; give several as a list such as 1.0,2.0, or as a range by _from, _to and n"
_WHOLE: Final = re.compile(r"\d{1,9}", re.ASCII)
_SPACINGS: Final[Mapping[str, Any]] = {"linear": np.linspace, "log": np.geomspace}


def _number(text: str, advice: str = "") -> float:
    # The framework reads a plus sign in a URL as a space.
    if not _NUMBER.fullmatch(text := text.replace(" ", "+")):
        raise PydanticCustomError("number", f"{NUMBER}, without a unit or a decimal comma{advice}")
    if np.isinf(value := float(text)):
        raise PydanticCustomError("number", FINITE)
    return value


def _load(text: str) -> float | list[float]:
    """Return a number, or the numbers of a list if its commas cannot belong to one number."""
    if "," not in text or _ONE_NUMBER.fullmatch(text):
        return _number(text, _SEVERAL)
    return [_number(each.strip(), _SEVERAL) for each in text.split(",")]


def _whole(text: str) -> int:
    if not _WHOLE.fullmatch(text):
        raise PydanticCustomError("whole", "must be a whole number of at most nine digits")
    return int(text)


# A schema that admits null keeps Swagger UI, which rejects exponents, from checking the text.
_Number = Annotated[float, BeforeValidator(_number)] | None
# Type and schema of a parameter that can be a list, or a range.
_Load = Annotated[Any, BeforeValidator(_load), WithJsonSchema({"type": "number"})] | None
_Whole = Annotated[int, BeforeValidator(_whole)] | None
_Length = Annotated[int, Field(ge=2, le=SETTINGS.max_length), BeforeValidator(_whole)] | None
NUMBERS: Final = (_Number, _Load, _Whole, _Length)
"""Types of the parameters that are numbers; others are words."""
# Types of parameters by the JSON type of the field.
_TYPES: Final[Mapping[str, Any]] = {"number": _Number, "integer": _Whole}
# Parameters that are words.
_WORDS: Final = frozenset({"kind", "base", "held", "segment", "drift", "quantities", "fit"})
# Groups whose name is a prefix of their parameters.
_LAYERS: Final = frozenset({"material.layer", "layer"})
_OF_BODIES: Final = frozenset({"material.bodies.#", "profile.radii"})
_LOADS: Final = frozenset(contacts.LOADS)
_RENAMED: Final = {"cycles.normal.amplitude": "normal_amplitude", "radius": "r"}
_TEXTS: Final = {
    "profile.kind": "Kind of profile; POST takes series and tables as well",
    "fit": "Parameters to fit, separated by commas; by default e_star and contact_point",
    "radius": "Radius r of the fields; `radius` belongs to the profile [length]",
}
_BODIES: Final = (
    "youngs_modulus_1 and poissons_ratio_1, and the same of body 2, which is rigid without them"
)
_CYCLES: Final = frozenset({"cycles", "cycles.normal", "cycles.tangential"})


class Parameters(ResponseParameters):
    """Parameters of a URL that form a request."""

    model: ClassVar[type[contacts.Query]]
    """Model of the request."""
    fields: ClassVar[Mapping[str, str]]
    """Field of the request by parameter; a parameter gives the field, or an end of its range."""

    n: _Length = Field(
        default=None, description="Number of values in a range, including both ends [1]"
    )
    scale: Literal["linear", "log"] | None = Field(
        default=None, description="Spacing of a range, linear by default"
    )
    answers: str | None = Field(
        default=None, description="Members of the response, separated by commas; by default all"
    )

    @property
    def members(self) -> list[str]:
        """Members of the response to return; all if there are none."""
        return self.answers.split(",") if self.answers else []

    def query(self, members: Mapping[str, Any] | None = None) -> contacts.Query:
        """Return the request; raise InputError or ValidationError, see `pointing`.

        Parameters
        ----------
        members : members of the request that replace those given by parameters.
        """
        given = self.model_dump(exclude_unset=True, exclude=set(Parameters.model_fields))
        self._join_range(given)
        values = {self.fields[name]: value for name, value in given.items()}
        bodies = {f"material.bodies.{index}" for index in "01"}
        named = {body for body in bodies if any(field.startswith(body) for field in values)}
        if named:
            values |= dict.fromkeys(bodies - named, "rigid")
        elif self.model.model_fields["material"].is_required() and "material.e_star" not in values:
            raise InputError(("material", "e_star"), f"is required, or {_BODIES}")
        if isinstance(values.get("radius"), float):
            values["radius"] = [values["radius"]]
        for name in {"quantities", "fit"} & values.keys():
            values[name] = values[name].split(",")
        return self.model.model_validate(nested(values) | dict(members or {}))

    @contextmanager
    def pointing(self) -> Iterator[None]:
        """Convert failures inside the context to problems that point at parameters."""
        try:
            yield
        except problems.FAILURES as error:
            found = problems.to_problem(error)
            errors = [self._error(*each) for each in found.errors]
            # Equality is tested, because a compute process returns an equal but different object.
            if found.type == problems.INVALID_REQUEST:
                raise problems.invalid(errors) from None
            raise replace(found, errors=errors) from None

    def _join_range(self, given: dict[str, Any]) -> None:
        """Replace the ends of a range by its values."""
        ends = [name for name in given if name.endswith(("_from", "_to"))]
        if not ends:
            for name in self.model_fields_set & {"n", "scale"}:
                raise InputError((name,), "is valid only with a range")
            return
        name = ends[0].rpartition("_")[0]
        start, stop = f"{name}_from", f"{name}_to"
        if name in given:
            raise InputError((name,), f"cannot be combined with {start} and {stop}")
        for end in ends:
            if end not in {start, stop}:
                raise InputError((end,), "only one range can be given; POST takes any lists")
            if self.scale == "log" and given[end] <= 0:
                raise InputError((end,), "must be greater than 0 on a logarithmic scale")
        for part in (start, stop, "n"):
            if part not in self.model_fields_set:
                raise InputError((part,), "is required for a range")
        # If the ends are out of bounds, the spacing can overflow; validation then rejects them.
        with np.errstate(all="ignore"):
            spaced = _SPACINGS[self.scale or "linear"](given.pop(start), given.pop(stop), self.n)
        given[name] = spaced.tolist()

    def _error(self, pointer: str, detail: str) -> problems.Error:
        place = pointer[1:].replace("/", ".")
        name = self._parameter(place)
        if place in self.fields.values():
            # The field has another name as a parameter: `r` for the radius of fields.
            detail = re.sub(rf"\b{place.rpartition('.')[2]}\b", name, detail)
        # Parameters are not in objects.
        detail = detail.replace("an object of exactly one of", "exactly one of")
        return problems.pointer([name]), re.sub(r"\bbodies\b", _BODIES, detail)

    def _parameter(self, place: str) -> str:
        """Return the parameter that corresponds to a place in the request.

        For a group of fields it is the first parameter given or, if none is given, the first that
        exists; for a range, the end at fault. Parameters of the response keep their names.
        """
        inside = [
            name
            for name, field in self.fields.items()
            if f"{place}.".startswith(f"{field}.") or f"{field}.".startswith(f"{place}.")
        ]
        given = [name for name in inside if name in self.model_fields_set]
        index = place.rpartition(".")[2]
        after_first = index.isdecimal() and index != "0"
        at_end = after_first and given[:1] and given[0].endswith("_from")
        if at_end:
            return given[1]
        # E* is the only constant of the material that is required.
        return next(iter(given or sorted(inside, key=lambda name: name != "e_star")), place)


def _described(model: type[contacts.Query]) -> Iterator[tuple[str, str, Any, str]]:
    """Yield the name, field of the request, type and description of each parameter."""
    # Cycles are the only load paths that consist of numbers.
    loads = _CYCLES if model is HistoryQuery else _LOADS
    groups = {"", "profile", "material", *_LAYERS, *_OF_BODIES, *loads}
    # Members of groups come before the members that all queries share. The last of one name counts,
    # so that the options of a layer describe the layer of a fit, not the layer of its material.
    for field, leaf in sorted(
        leaves(model.model_json_schema()),
        key=lambda each: "." not in each[0] or each[0].startswith("layer."),
    ):
        group, _, name = field.rpartition(".")
        text: str = _TEXTS.get(field) or leaf.get("description", "")
        dimension = text[text.rfind("[") :]
        if name == "quantities":
            text = f"Fields, separated by commas: {', '.join(leaf['items']['enum'])}"
        type_ = _word(name, leaf) if name in _WORDS else _TYPES.get(leaf["type"])
        if field == "radius" or group in loads & _LOADS:
            name = _RENAMED.get(field, name)
            yield name, field, _Load, text
            for end, which in (("from", "First"), ("to", "Last")):
                meaning = f"{which} of `n` values of `{name}` {dimension}"
                yield f"{name}_{end}", field, _Number, meaning
        elif group in _OF_BODIES and type_:
            name = name.replace("#", "radius")
            for body in (1, 2):
                own = field.replace("#", str(body - 1))
                yield f"{name}_{body}", own, type_, f"Body {body}: {text}"
        elif group in groups and type_:
            if group == "profile" and name != "kind":
                text = f"`{name}` of the profile, see GET /v1/profiles {dimension}"
            name = f"layer_{name}" if group in _LAYERS else _RENAMED.get(field, name)
            yield name, field, type_, text


def _word(name: str, leaf: Mapping[str, Any]) -> Any:
    """Return the type of a parameter that is a word, or a list of words."""
    if name == "kind":
        return Literal[OF_NUMBERS]
    words = leaf.get("enum") or [leaf["const"]] if leaf["type"] == "string" else ()
    return Literal[tuple(words)] | None if words else str | None


def parameters_of(model: type[contacts.Query]) -> type[Parameters]:
    """Return the model of the parameters that form a request."""
    described = list(_described(model))
    definitions: dict[str, Any] = {
        name: (type_, Field(default=... if name == "kind" else None, description=text))
        for name, _, type_, text in described
    }
    title = model.__name__.replace("Query", "Parameters")
    made = create_model(title, __base__=Parameters, **definitions)
    made.model, made.fields = model, {name: field for name, field, *_ in described}
    return made


PARAMETERS: Final = {
    name: parameters_of(kind.request)
    for name, kind in QUERIES.items()
    if kind.request.by_parameters
}
"""Parameters of the queries that consist of numbers, by query."""
