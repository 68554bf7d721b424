"""Which form of an answer a request chooses, by its header ``Accept``."""

import re
from collections.abc import Sequence
from typing import Final

from fastapi import Request

from mdr_service import problems

_WEIGHT: Final = re.compile(r"(?:0(?:\.\d{0,3})?|1(?:\.0{0,3})?)", re.ASCII)


def chosen(request: Request, offered: Sequence[str]) -> str:
    """Return the media type that the request prefers; the earlier where it does not care."""
    accept = request.headers.get("accept", "*/*").strip() or "*/*"
    if accept in {"*/*", offered[0]}:
        return offered[0]
    ranges = dict(map(_range, accept.lower().split(",")))
    best = max(offered, key=lambda media_type: _preference(media_type, ranges))
    if _preference(best, ranges) <= 0:
        raise problems.ServiceError(
            problems.NOT_ACCEPTABLE, f"the answer can be {', '.join(offered)}"
        )
    return best


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
