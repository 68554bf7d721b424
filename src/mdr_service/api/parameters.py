"""Queries as parameters of a URL: numbers, one range, and names separated by commas.

Each parameter stands for a member of the request, whose model describes it. The request is then
validated like any other; what is wrong with it is reported for the parameter.
"""

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal, TypeAlias

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, create_model
from pydantic_core import PydanticCustomError

from mdr_service.problems import INVALID_REQUEST, ServiceError, pointer
from mdr_service.schemas.contacts import (
    BodyMaterial,
    Load,
    Moduli,
    NormalQuery,
    Query,
    Tangential,
    TangentialQuery,
)
from mdr_service.schemas.fields import StressQuery
from mdr_service.schemas.profiles import MODELS
from mdr_service.schemas.quantities import Strict, quantity
from mdr_service.schemas.wear import HeldLoad, Oscillation, WearQuery
from mdr_service.settings import SETTINGS

Path = tuple[str, ...]
Definition = tuple[Path, Any, Any]
"""Path in the request, type and field of a parameter."""

# JSON numbers, and a leading plus, which spreadsheets write.
_NUMBER: Final = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_WHOLE: Final = re.compile(r"\d{1,9}", re.ASCII)
_SPACINGS: Final[Mapping[str, Any]] = {"linear": np.linspace, "log": np.geomspace}
_KINDS: Final[Mapping[str, type[Strict]]] = {
    model.model_json_schema()["properties"]["kind"]["const"]: model
    for model in MODELS
    if all(
        field.annotation is float for name, field in model.model_fields.items() if name != "kind"
    )
}


def _number(text: str) -> float:
    if not _NUMBER.fullmatch(text):
        raise PydanticCustomError("number", "must be a number, like 0.01 or 1.1e11")
    if np.isinf(value := float(text)):
        raise PydanticCustomError("number", "is out of the range of double precision")
    return value


def _whole(text: str) -> int:
    if not _WHOLE.fullmatch(text):
        raise PydanticCustomError("whole", "must be a whole number of at most nine digits")
    return int(text)


# A schema that admits null keeps Swagger UI from checking the text, since it takes no exponents.
_Number = Annotated[float, BeforeValidator(_number)] | None
_Whole = Annotated[int, BeforeValidator(_whole)] | None


class Parameters(BaseModel):
    """Parameters of a URL that stand for a request."""

    model_config = ConfigDict(extra="forbid")
    paths: ClassVar[Mapping[str, Path]]
    """Path in the request that each parameter stands for."""
    model: ClassVar[type[Query]]
    """Model of the request."""

    n: _Whole = quantity("1", "Number of values in a range, including both ends", default=None)
    scale: Literal["linear", "log"] | None = Field(
        default=None, description="Spacing of a range, linear by default"
    )

    def query(self) -> Query:
        """Return the request.

        Raises
        ------
        ServiceError : parameters that contradict each other, with a pointer to each.
        ValidationError : the request that they stand for is not valid.
        """
        given = self.model_dump(exclude_unset=True, exclude={"n", "scale"})
        ranged = [name for name in self.paths if given.keys() & {*_ends(name)}]
        if errors := list(self._contradictions(ranged, given)):
            pointers = [(pointer([name]), detail) for name, detail in errors]
            raise ServiceError(INVALID_REQUEST, "some parameters are invalid", pointers)
        for name in ranged:
            start, stop = (given.pop(end) for end in _ends(name))
            # Between ends out of bounds numbers can overflow; the ends are then rejected.
            with np.errstate(all="ignore"):
                given[name] = _SPACINGS[self.scale or "linear"](start, stop, self.n).tolist()
        return self.model.model_validate(self._nested(given))

    def pointed(self, error: ServiceError) -> ServiceError:
        """Return the failure of the request with pointers to the parameters."""
        errors = [
            (pointer([self._parameter(tuple(place.split("/")[1:]))]), detail)
            for place, detail in error.errors
        ]
        return ServiceError(error.type, error.detail, errors, error.retry_after)

    def _contradictions(
        self, ranged: list[str], given: Mapping[str, Any]
    ) -> Iterator[tuple[str, str]]:
        for name in ranged:
            start, stop = _ends(name)
            if name in given:
                yield name, f"does not go with {start} and {stop}"
            for part in (start, stop, "n"):
                if part not in self.model_fields_set:
                    yield part, "is needed for a range"
            most = SETTINGS.max_radii if name == "r" else SETTINGS.max_loads
            if self.n is not None and not 2 <= self.n <= most:
                yield "n", f"must be from 2 to {most}"
            for end in (start, stop):
                if self.scale == "log" and given.get(end, 1.0) <= 0:
                    yield end, "must be greater than 0 on a logarithmic scale"
        for name in ranged[1:]:
            end = next(end for end in _ends(name) if end in given)
            yield end, "only one range can be given; POST takes any lists"
        if not ranged:
            alone = self.model_fields_set & {"n", "scale"}
            yield from ((name, "goes with a range") for name in sorted(alone))

    def _nested(self, given: Mapping[str, Any]) -> dict[str, Any]:
        groups = {path[0] for path in self.paths.values()} & {"load", "oscillation"}
        request: dict[str, Any] = {name: {} for name in ("profile", "material", *groups)}
        for name, value in given.items():
            *parts, last = self.paths[name]
            member = request
            for part in parts:
                member = member.setdefault(part, {})
            member[last] = value
        material = request["material"]
        if "bodies" in material:
            material["bodies"] = [material["bodies"].get(index, "rigid") for index in "01"]
        if isinstance(request.get("radius"), float):
            request["radius"] = [request["radius"]]
        if "quantities" in request:
            request["quantities"] = request["quantities"].split(",")
        return request

    def _parameter(self, place: Path) -> str:
        """Return the parameter that stands for a place in the request.

        For a group it is the first one that is given, or could be; in a range the end at fault.
        """
        fields = type(self).model_fields
        for name, path in self.paths.items():
            start, stop = _ends(name)
            # Contradictions are reported for the parameters already.
            if place[:1] in {(start,), (stop,)} or (place == (name,) and start in fields):
                return place[0]
            inside = place[len(path) :]
            if place == path + inside:
                if start not in self.model_fields_set:
                    return name
                return start if inside in {(), ("0",)} else stop
        if place in {("n",), ("scale",)}:
            return place[0]
        within = [name for name, path in self.paths.items() if place == path[: len(place)]]
        given = [name for name in within if name in self.model_fields_set]
        return (given or within)[0] if place and within else ""


def _ends(name: str) -> tuple[str, str]:
    return f"{name}_from", f"{name}_to"


def _optional(model: type[Strict], name: str, meaning: str = "") -> Any:
    """Return an optional parameter with the description, or the dimension, of a field."""
    description = str(model.model_fields[name].description)
    if meaning:
        description = f"{meaning} [{description.rpartition('[')[2]}"
    return Field(default=None, description=description)


def _numbers(model: type[Strict], group: str) -> dict[str, Definition]:
    return {name: ((group, name), _Number, _optional(model, name)) for name in model.model_fields}


def _ranges(model: type[Strict], group: str) -> dict[str, Definition]:
    """Return numbers and the ends of their ranges, whose paths are those of the numbers."""
    found = _numbers(model, group)
    for name in model.model_fields:
        for end, which in zip(_ends(name), ("First", "Last"), strict=True):
            field = _optional(model, name, f"{which} of `n` values of `{name}`")
            found[end] = ((group, name), _Number, field)
    return found


def _contact() -> dict[str, Definition]:
    """Return the parameters of the profile and the material."""
    kinds = Literal[tuple(_KINDS)]  # type: ignore[valid-type]  # made at import
    kind = Field(description="Kind of profile; POST takes series and tables as well")
    found: dict[str, Definition] = {"kind": (("profile", "kind"), kinds, kind)}
    for model in _KINDS.values():
        for name in (name for name in model.model_fields if name not in found):
            field = _optional(model, name, f"`{name}` of the profile, see GET /v1/profiles")
            found[name] = (("profile", name), _Number, field)
    found |= _numbers(Moduli, "material")
    for index in ("0", "1"):
        for name in BodyMaterial.model_fields:
            meaning = f"`{name}` of body {int(index) + 1}, rigid if absent"
            path = ("material", "bodies", index, name)
            found[f"{name}_{int(index) + 1}"] = (
                path,
                _Number,
                _optional(BodyMaterial, name, meaning),
            )
    return found


def _fields(model: type[Strict]) -> dict[str, Definition]:
    """Return the parameters of fields over the radius."""
    meaning = "Radius r of the fields; `radius` is that of the profile"
    names = ", ".join(model.model_json_schema()["properties"]["quantities"]["items"]["enum"])
    quantities = Field(default=None, description=f"Fields, separated by commas: {names}")
    return {
        "r": (("radius",), _Number, _optional(model, "radius", meaning)),
        "r_from": (("radius",), _Number, _optional(model, "radius", "First of `n` radii r")),
        "r_to": (("radius",), _Number, _optional(model, "radius", "Last of `n` radii r")),
        "points": (("points",), _Whole, _optional(model, "points")),
        "quantities": (("quantities",), str | None, quantities),
    }


def _made(model: type[Query], definitions: Mapping[str, Definition], *names: str) -> Any:
    """Return the parameters of a request, besides `definitions` its plain members `names`."""
    all_ = dict(definitions)
    all_ |= {name: ((name,), _Number, _optional(model, name)) for name in names}
    fields: dict[str, Any] = {key: (type_, field) for key, (_, type_, field) in all_.items()}
    made = create_model(
        model.__name__.replace("Query", "Parameters"), __base__=Parameters, **fields
    )
    ends = {end for key in all_ for end in _ends(key)}
    made.paths = {key: path for key, (path, _, _) in all_.items() if key not in ends}
    made.model = model
    return made


if TYPE_CHECKING:
    NormalParameters: TypeAlias = Parameters
    TangentialParameters: TypeAlias = Parameters
    StressParameters: TypeAlias = Parameters
    WearParameters: TypeAlias = Parameters
else:
    _LOADED = _contact() | _ranges(Load, "load")
    _SHEARED = _LOADED | _ranges(Tangential, "tangential")
    _WORN = _contact() | _ranges(HeldLoad, "load") | _ranges(Oscillation, "oscillation")
    _FRICTION = ("friction_coefficient", "rtol")
    NormalParameters = _made(NormalQuery, _LOADED, "rtol")
    TangentialParameters = _made(TangentialQuery, _SHEARED, *_FRICTION)
    StressParameters = _made(StressQuery, _SHEARED | _fields(StressQuery), *_FRICTION)
    WearParameters = _made(WearQuery, _WORN | _fields(WearQuery), *_FRICTION)
