"""Errors of pydantic in the style of the core: the fault, and its remedy.

Pydantic's own sentences repeat the value sent, name the tags of its unions and the types of
Python, and print the bound 1e50 with all its zeros.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Final, get_args, get_origin

from pydantic import BaseModel
from pydantic_core import ErrorDetails

from mdr_core.validation import BODIES, FINITE, POSITIVE, not_negative
from mdr_service.batch import BatchItem, BatchQuery
from mdr_service.queries import QUERIES
from mdr_service.schemas.contacts import Choice
from mdr_service.schemas.profiles import MODELS, OF_NUMBERS
from mdr_service.schemas.quantities import BRANCHES

Path = tuple[str | int, ...]
_Model = type[BaseModel]

NUMBER: Final = "must be a number such as 0.01 or 1.1e11"
NOT_NUMBERS: Final = "series and tables need a request in JSON"
_KINDS: Final = ", ".join(MODELS)
_NUMBERS: Final = ", ".join(OF_NUMBERS)
_BODY: Final = 'an object of youngs_modulus and poissons_ratio, or "rigid"'
_BODIES: Final = f"bodies (two, each {_BODY})"
_PROFILE: Final = f"an object of kind, one of {_KINDS}, and its fields"
_PLAIN: Final = "it is not JSON in plain UTF-8 (no compression, no byte order mark)"
# Sentences by the type of the error, or by its type and field; names in braces are members of its
# context.
_SENTENCES: Final[Mapping[str | tuple[str, str], str]] = {
    "bool_type": "must be true or false, without quotes",
    "dict_type": "must be an object",
    "finite_number": FINITE,
    "float_type": f"{NUMBER}, without quotes or a unit",
    "greater_than": "must be greater than {gt:.15g}",
    "int_from_float": "must be a whole number",
    "int_type": "must be a whole number",
    "less_than": "must be less than {lt:.15g}",
    "less_than_equal": "must be at most {le:.15g}",
    "list_type": "must be a list in square brackets",
    "literal_error": "must be {expected}",
    "string_pattern_mismatch": "must be the numbers of two columns, from 1, such as 2,3",
    "string_type": "must be a text in double quotes",
    "too_long": "at most {max_length} values are allowed",
    "union_tag_invalid": f"there is no such kind; there are {_KINDS}",
    "union_tag_not_found": f"is required, one of {_KINDS}",
    ("dict_type", "profile"): f"must be {_PROFILE}",
    ("model_attributes_type", "profile"): f"must be {_PROFILE}",
    ("literal_error", "bodies"): f"must be {_BODY}",
    ("model_type", "bodies"): f"must be {_BODY}",
    ("literal_error", "kind"): f"must be {_NUMBERS}; {NOT_NUMBERS}",
    ("missing", "e_star"): f"is required, or {_BODIES}",
    ("missing", "kind"): f"is required, one of {_NUMBERS}",
    ("missing", "profile"): f"is required, {_PROFILE}",
    ("too_long", "bodies"): BODIES,
    ("too_short", "bodies"): BODIES,
}
REQUESTS: Final[Mapping[str, _Model]] = {
    kind.request.__name__: kind.request for kind in QUERIES.values()
} | {"BatchItem": BatchItem, "BatchQuery": BatchQuery}
"""Models of requests by their name, which is the title of a ValidationError."""


def path(error: ErrorDetails) -> Path:
    """Return the path into the request, which is the location without the branches of unions."""
    location = error["loc"]
    # An unknown member keeps the client's spelling, in a branch of a union too.
    known = len(location) - (error["type"] == "extra_forbidden")
    steps = [step for at, step in enumerate(location) if at >= known or step not in BRANCHES]
    if steps[:1] == ["profile"]:
        # The branch of a profile in the union is its kind.
        del steps[1:2]
    if error["type"].startswith("union_tag"):
        steps.append("kind")
    return tuple(steps)


def _field(place: Path) -> str:
    """Return the name of the field at a place, or of the list of which the place is an item."""
    return next((step for step in reversed(place) if isinstance(step, str)), "")


def of_json(message: str) -> str:
    """Return the reason why a text is not JSON, and the remedy, from the message of pydantic."""
    reason = message.removeprefix("Invalid JSON: ")
    remedies = {
        "key must be": "put names in double quotes",
        "EOF": "it is empty or cut off",
        "expected value at line 1 column 1": _PLAIN,
        "expected value": "write numbers as 0.5 or 1.1e11, and texts in double quotes",
        "invalid unicode": _PLAIN,
    }
    # Column 1 is not the start of column 118.
    found = (text for start, text in remedies.items() if f"{reason} ".startswith(f"{start} "))
    remedy = next((f"; {text}" for text in found), "")
    return f"not valid JSON: {reason}{remedy}"


def sentence(error: ErrorDetails, model: _Model | None) -> str:
    """Return the fault of a request of the model, and its remedy.

    Parameters
    ----------
    error : error of pydantic, whose location starts in the request.
    model : model of the request; its members are listed if one is unknown.
    """
    kind, place = error["type"], path(error)
    if found := _SENTENCES.get((kind, _field(place))) or _SENTENCES.get(kind):
        # Words are quoted in the context.
        return found.format(**error.get("ctx", {})).replace("'", "")
    write = _WRITERS.get(kind)
    return write(error, place, model) if write else error["msg"]


def _unknown(error: ErrorDetails, place: Path, model: _Model | None) -> str:
    models = _models(error, place[:-1], model)
    others = [each for each in models if place[-1] not in each.model_fields]
    if len(others) < len(models):
        # The member belongs to another branch of the union.
        fields = [field for each in others for field in each.model_fields.items()]
        rivals = [name for name, field in fields if field.is_required()]
        return f"cannot be combined with {', '.join(rivals)}"
    refused: Mapping[object, str] = getattr(model, "refused", {})
    if place[-1] in refused:
        return refused[place[-1]]
    names = _members(models)
    # The ends of a range, `_from` and `_to`, are described by the parameter itself.
    listed = ", ".join(name for name in names if not name.endswith(("_from", "_to")))
    return f"there is no such member; there are {listed}"


def _missing(error: ErrorDetails, place: Path, model: _Model | None) -> str:
    described = _described(_models(error, place, model))
    fields = [each.model_fields.get(_field(place)) for each in _models(error, place[:-1], model)]
    if any(field and get_origin(field.annotation) is list for field in fields):
        described = described.replace("an object", "a list of objects", 1)
    words = [part for part in _at(error, place, model) if isinstance(part, str)]
    listed = f", {described}" if described else f"; it can be {', '.join(words)}" if words else ""
    return f"is required{listed}"


def _no_object(error: ErrorDetails, place: Path, model: _Model | None) -> str:
    return f"must be {_described(_models(error, place, model)) or 'an object'}"


def _at_least(error: ErrorDetails, place: Path, _model: _Model | None) -> str:
    least = error["ctx"]["ge"]
    if 0 < least < 1:
        return f"{POSITIVE}, at least {least:g}"
    return f"must be at least {least:.15g}" if least else not_negative(_field(place))


def _too_short(error: ErrorDetails, _place: Path, _model: _Model | None) -> str:
    least = error["ctx"]["min_length"]
    return f"at least {'one value is' if least == 1 else f'{least} values are'} needed"


_Writer = Callable[[ErrorDetails, Path, _Model | None], str]
_WRITERS: Final[Mapping[str, _Writer]] = {
    "extra_forbidden": _unknown,
    "greater_than_equal": _at_least,
    "missing": _missing,
    "model_type": _no_object,
    "too_short": _too_short,
}


def _models(error: ErrorDetails, place: Path, model: _Model | None) -> list[_Model]:
    """Return the models of the object at a place; a union has several."""
    return [part for part in _at(error, place, model) if isinstance(part, type(BaseModel))]


def _at(error: ErrorDetails, place: Path, model: _Model | None) -> list[Any]:
    """Return the types of the value at a place, or of the items of a list, and permitted words."""
    found: list[Any] = [model]
    for step in place:
        if step == "profile":
            # The location names the kind of the profile next.
            found = [MODELS[str(tag)] for tag in error["loc"] if tag in MODELS][:1]
        elif isinstance(step, str):
            members = [getattr(owner, "model_fields", {}).get(step) for owner in found]
            found = [part for field in members if field for part in _parts(field.annotation)]
    return found


def _parts(annotation: Any) -> Iterator[Any]:
    inner = get_args(annotation)
    if not inner:
        yield annotation
    for part in inner:
        yield from _parts(part)


def _members(models: Sequence[_Model]) -> list[str]:
    """Return the names of the members, required ones first."""
    fields = {name: field for model in models for name, field in model.model_fields.items()}
    names = sorted(fields, key=lambda name: not fields[name].is_required())
    return [_BODIES if name == "bodies" else name for name in names]


def _described(models: Sequence[_Model]) -> str:
    """Return a description of the members of an object; empty for other values."""
    names = _members(models)
    if len(models) == 1 and issubclass(models[0], Choice):
        controls = [name for name in names if name not in models[0].accompanying]
        return f"an object of exactly one of {', '.join(controls)}"
    return f"an object of {', '.join(names)}" if names else ""
