"""The parameters that a query may be asked by in an address, taken from the request models."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from mdr_service.schemas.loads import HeldLoad, Load, Oscillation, Tangential
from mdr_service.schemas.profiles import MODELS
from mdr_service.schemas.quantities import Strict
from mdr_service.schemas.queries import Body, Moduli, NormalQuery, StressQuery, TangentialQuery
from mdr_service.schemas.wear import WearQuery

_NUMBER: Final = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_WHOLE: Final = re.compile(r"\d{1,9}", re.ASCII)

Path = tuple[str, ...]
Schema = Mapping[str, Any]


class RefusedError(ValueError):
    """A parameter, by its name, and what is wrong with it."""

    def __init__(self, name: str, detail: str) -> None:
        super().__init__(name, detail)
        self.name = name
        self.detail = detail


@dataclass(frozen=True)
class Parameter:
    """One parameter: what it is called, and the place in the request that it stands for."""

    name: str
    path: Path
    schema: Schema
    read: Callable[[str, str], object]
    """Takes the name and the text, and raises `RefusedError`."""
    ranges: bool = False
    """Whether `name`_from and `name`_to may stand for a list."""

    @property
    def ends(self) -> tuple[str, str]:
        """The names of the ends of its range."""
        return f"{self.name}_from", f"{self.name}_to"


@dataclass(frozen=True)
class Known:
    """All parameters that one query may be asked by."""

    by_name: Mapping[str, Parameter]
    groups: tuple[str, ...]
    """Parts of the request that are there even if no parameter is about them."""


def number(name: str, text: str) -> float:
    """Return the number that a text writes, in the digits and the point of any JSON."""
    if not _NUMBER.fullmatch(text):
        raise RefusedError(name, "must be a number, like 0.01 or 1.1e11")
    value = float(text)
    if value in {float("inf"), float("-inf")}:
        raise RefusedError(name, "is out of the range of double precision")
    return value


def whole(name: str, text: str) -> int:
    """Return the whole number that a text writes."""
    if not _WHOLE.fullmatch(text):
        raise RefusedError(name, "must be a whole number of at most nine digits")
    return int(text)


def _one(name: str, text: str) -> list[float]:
    return [number(name, text)]


def _words(_name: str, text: str) -> list[str]:
    return text.split(",")


def _kind(name: str, text: str) -> str:
    if text not in _KINDS:
        raise RefusedError(
            name, f"must be one of {', '.join(_KINDS)}; POST takes the others as well"
        )
    return text


_KINDS: Final[Mapping[str, type[Strict]]] = {
    model.model_json_schema()["properties"]["kind"]["const"]: model
    for model in MODELS
    if all(
        field.annotation is float for name, field in model.model_fields.items() if name != "kind"
    )
}


def _profile() -> Iterator[Parameter]:
    schema = {"type": "string", "enum": list(_KINDS), "description": "The kind of profile"}
    yield Parameter("kind", ("profile", "kind"), schema, _kind)
    found: dict[str, dict[str, Any]] = {}
    for kind, model in _KINDS.items():
        for name, field in _properties(model).items():
            if name != "kind":
                known = found.setdefault(name, field | {"description": ""})
                more = f"{kind}: {field['description']}"
                known["description"] = "; ".join(filter(None, (known["description"], more)))
    for name, field in found.items():
        yield Parameter(name, ("profile", name), field, number)


def _material() -> Iterator[Parameter]:
    for name, field in _properties(Moduli).items():
        yield Parameter(name, ("material", name), field, number)
    for index, which in enumerate(("first", "second")):
        for name, field in _properties(Body).items():
            said, dimension = field["description"].rsplit(" ", 1)
            meaning = f"{said} of the {which} body; one left out is rigid {dimension}"
            yield Parameter(
                f"{name}_{index + 1}",
                ("material", "bodies", str(index), name),
                field | {"description": meaning},
                number,
            )


def _choice(group: str, model: type[Strict]) -> Iterator[Parameter]:
    for name, field in _properties(model).items():
        yield Parameter(name, (group, name), field, number, ranges=True)


def _plain(model: type[Strict], *names: str) -> Iterator[Parameter]:
    for name in names:
        field = _properties(model)[name]
        yield Parameter(name, (name,), field, whole if name == "points" else number)


def _places(model: type[Strict]) -> Iterator[Parameter]:
    meaning = "Radius r at which the fields are answered (`radius` is the profile's) [length]"
    schema = _properties(model)["radius"]["items"] | {"description": meaning}
    yield Parameter("r", ("radius",), schema, _one, ranges=True)
    yield from _plain(model, "points")
    asked = _properties(model)["quantities"]
    name = f"({'|'.join(asked['items']['enum'])})"
    listed = {
        "type": "string",
        "pattern": f"^{name}(,{name})*$",
        "description": f"{asked['description']}; separated by commas",
    }
    yield Parameter("quantities", ("quantities",), listed, _words)


def _properties(model: type[Strict]) -> dict[str, dict[str, Any]]:
    """Return the schemas of the fields; of a number or a list, that of the number."""
    found = {}
    for name, field in model.model_json_schema()["properties"].items():
        single: dict[str, Any] = next(
            (each for each in field.get("oneOf", ()) if "items" not in each), {}
        )
        found[name] = {
            key: value
            for key, value in (field | single).items()
            if key not in {"oneOf", "dimension", "title"} and not (key == "default" and not value)
        }
    return found


def _known(groups: Sequence[str], *parameters: Iterator[Parameter]) -> Known:
    return Known(
        {parameter.name: parameter for part in parameters for parameter in part},
        ("profile", "material", *groups),
    )


KNOWN: Final = {
    "normal": _known(
        ("load",), _profile(), _material(), _choice("load", Load), _plain(NormalQuery, "rtol")
    ),
    "tangential": _known(
        ("load", "tangential"),
        _profile(),
        _material(),
        _choice("load", Load),
        _choice("tangential", Tangential),
        _plain(TangentialQuery, "friction_coefficient", "rtol"),
    ),
    "stress": _known(
        ("load",),
        _profile(),
        _material(),
        _choice("load", Load),
        _choice("tangential", Tangential),
        _places(StressQuery),
        _plain(StressQuery, "friction_coefficient", "rtol"),
    ),
    "wear": _known(
        ("load", "oscillation"),
        _profile(),
        _material(),
        _choice("load", HeldLoad),
        _choice("oscillation", Oscillation),
        _places(WearQuery),
        _plain(WearQuery, "friction_coefficient", "rtol"),
    ),
}
