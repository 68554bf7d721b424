"""Media type of a response, by ``format`` or the header ``Accept``, and appearance of a picture."""

import re
from collections.abc import Collection
from typing import Final, Literal

from pydantic import BaseModel, ConfigDict, Field, SkipValidation

from mdr_service import problems
from mdr_service.serializers import FORMATS, PICTURES
from mdr_service.serializers.panels import Units
from mdr_service.serializers.picture import Appearance

Format = Literal["json", "csv", "npz", "txt", "svg", "png", "pdf"]
SIZE: Final = "Width x height of a picture in millimetres, 50 to 400 each, such as `90x60`"
UNITS: Final = (
    "Units of length, force and pressure that the labels of a picture name, such as `mm,N,MPa`: "
    "nothing is converted"
)


class ResponseParameters(BaseModel):
    """Parameters of a URL that determine the format of the response."""

    model_config = ConfigDict(extra="forbid")

    # An unknown format is not acceptable (406) rather than invalid.
    format: SkipValidation[Format | None] = Field(
        default=None, description="Format of the response; overrides `Accept`"
    )
    size: str | None = Field(default=None, description=SIZE)
    units: str | None = Field(default=None, description=UNITS)


_SIZE: Final = re.compile(r"(\d{2,3})x(\d{2,3})", re.ASCII)
_SMALLEST, _LARGEST = 50, 400
# These characters exist in every font, and none of them starts a formula in Matplotlib.
_UNIT: Final = re.compile(r"[A-Za-z0-9µμ°²³·/*^. -]{1,12}")
_THREE_NAMES: Final = (
    "must be three names, of length, force and pressure, such as mm,N,MPa: of at most 12 letters, "
    "digits and characters µ ° ² ³ · / * ^ . -"
)
_WEIGHT: Final = re.compile(r"(?:0(?:\.\d{0,3})?|1(?:\.0{0,3})?)", re.ASCII)


def media_type(name: str | None, accept: str, offered: Collection[str]) -> str:
    """Return the media type of a named format; without a name the header ``Accept`` selects it.

    Among formats of equal weight the header selects the first that is offered. Raises ServiceError
    if none is accepted.
    """
    types = [FORMATS[each] for each in offered]
    if name is not None:
        types = [FORMATS[name]] if name in offered else []
        accept = "*/*"
    ranges = dict(map(_range, (accept.strip() or "*/*").lower().split(",")))
    best = max(types, key=lambda each: _preference(each, ranges), default=None)
    if best is None or _preference(best, ranges) <= 0:
        formats = ", ".join(f"{each} ({FORMATS[each]})" for each in offered)
        raise problems.ServiceError(problems.NOT_ACCEPTABLE, f"available formats: {formats}")
    return best


def appearance(media_type: str, size: str | None, units: str | None) -> Appearance:
    """Return the appearance of a picture; raise ServiceError if it is invalid."""
    found = _SIZE.fullmatch(size or "")
    sides = (int(found[1]), int(found[2])) if found else (0, 0)
    names = [name.strip() for name in (units or "").split(",")]
    wrong = {}
    if size is not None and not _SMALLEST <= min(sides) <= max(sides) <= _LARGEST:
        wrong["/size"] = f"must be {SIZE[0].lower()}{SIZE[1:].replace('`', '')}"
    if units is not None and not (len(names) == 3 and all(map(_UNIT.fullmatch, names))):
        wrong["/units"] = _THREE_NAMES
    if media_type not in PICTURES:
        given = {"/size": size, "/units": units}.items()
        only = "is valid for pictures only: svg, png and pdf"
        wrong = {pointer: only for pointer, text in given if text is not None}
    if wrong:
        raise problems.invalid(list(wrong.items()))
    return Appearance(sides if size else None, Units(*names) if units else None)


def _range(text: str) -> tuple[str, float]:
    """Return a media range and its weight; an invalid weight counts as 1."""
    media_range, *parameters = (part.strip() for part in text.split(";"))
    for parameter in parameters:
        name, _, value = parameter.partition("=")
        if name.strip() == "q" and _WEIGHT.fullmatch(value.strip()):
            return media_range, float(value)
    return media_range, 1.0


def _preference(media_type: str, ranges: dict[str, float]) -> float:
    """Return the weight of the most specific range for a media type (RFC 9110, 12.5.1)."""
    main_type = media_type.partition("/")[0]
    for media_range in (media_type, f"{main_type}/*", "*/*"):
        if media_range in ranges:
            return ranges[media_range]
    return 0.0
