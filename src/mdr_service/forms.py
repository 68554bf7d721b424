"""Which form of an answer is asked for: by its name, or by the header ``Accept``."""

import re
from collections.abc import Sequence
from typing import Final

from mdr_service import arrays, pictures, problems, table, wire

FORMATS: Final = {
    "json": wire.MEDIA_TYPE,
    "csv": table.MEDIA_TYPE,
    "npz": arrays.MEDIA_TYPE,
    "svg": pictures.MEDIA_TYPE,
}
_NAMES: Final = {media_type: name for name, media_type in FORMATS.items()}
_WEIGHT: Final = re.compile(r"(?:0(?:\.\d{0,3})?|1(?:\.0{0,3})?)", re.ASCII)


def names(offered: Sequence[str]) -> list[str]:
    """Return what the offered media types are called in ``?format=``."""
    return [_NAMES[media_type] for media_type in offered]


def named(name: str, offered: Sequence[str]) -> str:
    """Return the media type that is called `name`, if it is offered."""
    media_type = FORMATS.get(name, "")
    if media_type not in offered:
        raise _refused(offered)
    return media_type


def accepted(accept: str, offered: Sequence[str]) -> str:
    """Return the media type that a header prefers; the earlier where it does not care."""
    accept = accept.strip() or "*/*"
    if accept in {"*/*", offered[0]}:
        return offered[0]
    ranges = dict(map(_range, accept.lower().split(",")))
    best = max(offered, key=lambda media_type: _preference(media_type, ranges))
    if _preference(best, ranges) <= 0:
        raise _refused(offered)
    return best


def _refused(offered: Sequence[str]) -> problems.ServiceError:
    forms = ", ".join(f"{_NAMES[media_type]} ({media_type})" for media_type in offered)
    return problems.ServiceError(problems.NOT_ACCEPTABLE, f"the answer can be {forms}")


def _range(text: str) -> tuple[str, float]:
    """Return a range of media types and its weight; a weight that is none counts as 1."""
    media_range, *parameters = (part.strip() for part in text.split(";"))
    for parameter in parameters:
        name, _, value = parameter.partition("=")
        if name.strip() == "q" and _WEIGHT.fullmatch(value.strip()):
            return media_range, float(value)
    return media_range, 1.0


def _preference(media_type: str, ranges: dict[str, float]) -> float:
    """Return the weight of a media type: that of the closest range (RFC 9110, 12.5.1)."""
    main_type = media_type.partition("/")[0]
    for media_range in (media_type, f"{main_type}/*", "*/*"):
        if media_range in ranges:
            return ranges[media_range]
    return 0.0
