"""Media type of a response, by ``format`` or the header ``Accept``, and size of a picture."""

import re
from collections.abc import Sequence
from typing import Final, Literal

from mdr_service import problems
from mdr_service.serializers import FORMATS, PICTURES

Format = Literal["json", "csv", "npz", "txt", "svg", "png", "pdf"]
FORMAT: Final = "Format of the response; overrides `Accept`"
SIZE: Final = "Width x height of a picture in millimetres, 30 to 400 each, such as `90x60`"
_SIZE: Final = re.compile(r"(\d{2,3})x(\d{2,3})", re.ASCII)
_SMALLEST, _LARGEST = 30, 400
_WEIGHT: Final = re.compile(r"(?:0(?:\.\d{0,3})?|1(?:\.0{0,3})?)", re.ASCII)


def media_type(name: str | None, accept: str, offered: Sequence[str] = tuple(FORMATS)) -> str:
    """Return the media type of a format; without its name, the header ``Accept`` selects one.

    Of equals it selects the first of the offered formats. Raises ServiceError if none is accepted.
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


def picture_size(text: str, media_type: str) -> tuple[int, int]:
    """Return width and height of a picture [mm]; raise ServiceError if there is none."""
    found = _SIZE.fullmatch(text)
    size = (int(found[1]), int(found[2])) if found else (0, 0)
    if media_type in PICTURES and min(size) >= _SMALLEST and max(size) <= _LARGEST:
        return size
    possible = f"must be {SIZE[0].lower()}{SIZE[1:].replace('`', '')}"
    detail = possible if media_type in PICTURES else "is valid for pictures only: svg, png and pdf"
    raise problems.invalid([("/size", detail)])


def _range(text: str) -> tuple[str, float]:
    """Return a media range and its weight; an invalid weight counts as 1."""
    media_range, *parameters = (part.strip() for part in text.split(";"))
    for parameter in parameters:
        name, _, value = parameter.partition("=")
        if name.strip() == "q" and _WEIGHT.fullmatch(value.strip()):
            return media_range, float(value)
    return media_range, 1.0


def _preference(media_type: str, ranges: dict[str, float]) -> float:
    """Return the weight of a media type, that of the most specific range (RFC 9110, 12.5.1)."""
    main_type = media_type.partition("/")[0]
    for media_range in (media_type, f"{main_type}/*", "*/*"):
        if media_range in ranges:
            return ranges[media_range]
    return 0.0
