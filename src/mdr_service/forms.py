"""The forms of an answer, of which the request chooses one by its header ``Accept``."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

from fastapi import Request
from starlette.responses import Response

from mdr_service import problems

_WEIGHT: Final = re.compile(r"(?:0(?:\.\d{0,3})?|1(?:\.0{0,3})?)", re.ASCII)


@dataclass(frozen=True)
class Form:
    """One form of an answer: its media type and what writes it.

    `effort` is what the writing costs, in numbers that could be answered in that time.
    """

    media_type: str
    write: Callable[[dict[str, Any], Any], Response]
    effort: int = 0


def chosen(request: Request, offered: Sequence[Form]) -> Form:
    """Return the form that the request prefers; the earlier offer where it does not care."""
    accept = request.headers.get("accept", "*/*").strip() or "*/*"
    if accept in {"*/*", offered[0].media_type}:
        return offered[0]
    ranges = dict(map(_range, accept.lower().split(",")))
    best = max(offered, key=lambda form: _preference(form.media_type, ranges))
    if _preference(best.media_type, ranges) <= 0:
        media_types = ", ".join(form.media_type for form in offered)
        raise problems.ServiceError(problems.NOT_ACCEPTABLE, f"the answer can be {media_types}")
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
