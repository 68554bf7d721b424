"""What an answer costs, in seconds, known before any work is done.

The work on a query is counted by `sizes`, and each count has a rate, measured on one machine for
every kind of profile (``rates.json``, written by `make rates`). The sum is what the answer takes
there; how much slower this machine is, `compute` finds out when it starts.
"""

from collections.abc import Iterator, Mapping
from importlib.resources import files
from typing import Any, Final

import orjson

from mdr_service import problems, sizes
from mdr_service.problems import Error, ServiceError
from mdr_service.schemas.queries import Query
from mdr_service.sizes import Sizes

_MEASURED: Final[dict[str, Any]] = orjson.loads(
    files("mdr_service").joinpath("rates.json").read_bytes()
)
REFERENCE_SECONDS: Final[float] = _MEASURED["reference_seconds"]
"""What the machine of the rates takes for `REFERENCE`."""
REFERENCE: Final[Mapping[str, Any]] = {
    "profile": {"kind": "sphere", "radius": 1.0},
    "material": {"e_star": 1.0, "g_star": 0.8},
    "load": {"indentation_depth": 0.01},
    "friction_coefficient": 0.3,
    "tangential": {"tangential_force": 1e-4},
}
"""A tangential contact that takes about a millisecond, of every kind of work some."""
RATES: Final[Mapping[str, Mapping[str, float]]] = _MEASURED["rates"]
"""Seconds per count, by kind of profile, and under `WRITING` for all of them."""
WRITING: Final = "writing"
PER_LENGTH: Final = "length * "
"""Before a rate per point of a table, or per term of a series."""


def seconds(question: str, query: Query, media_type: str) -> float:
    """Return what the answer takes on the machine of the rates."""
    return estimated(sizes.of(question, query, media_type))


def estimated(found: Sizes) -> float:
    """Return what an answer of these sizes takes on the machine of the rates."""
    rates = RATES[found.profile]
    total = 0.0
    for name, count in sizes.counts(found):
        rate = rates[name]
        if found.length:
            rate += rates[PER_LENGTH + name] * found.length
        total += rate * count
    writing = RATES[WRITING]
    for name, count in sizes.written(found):
        total += writing[name] * count
    return total


def too_costly(
    question: str, query: Query, media_type: str, most: float, slowness: float = 1.0
) -> ServiceError:
    """Return the refusal of what takes more than `most` seconds, with the numbers that would fit.

    The seconds are those of the machine of the rates, and this one is slower by a factor.
    """
    found = sizes.of(question, query, media_type)
    fits = list(_fits(query, found, most))
    return beyond(estimated(found) * slowness, most * slowness, fits)


def beyond(taken: float, most: float, fits: list[Error]) -> ServiceError:
    """Return the refusal of what would take so many seconds on this machine."""
    detail = f"it takes about {taken:.2g} s, and at most {most:.2g} s are given to one request"
    named = ", or ".join(fit for _, fit in fits)
    return ServiceError(problems.TOO_COSTLY, f"{detail}; {named}" if named else detail, fits)


# What may be given less of, the field of the sizes, and where in the request it may be.
_KNOBS: Final = (
    ("numbers of cycles", "loads", ("cycles",)),
    ("loads", "loads", ("load",)),
    ("samples", "samples", ("history", "cycles")),
    ("radii", "radii", ("radius", "points")),
    ("nodes", "nodes", ("resolution", "profile")),
    ("terms or points", "length", ("profile",)),
)


# What is counted besides, and becomes less alike.
_PARTS: Final = {"samples": ("curved", "forced"), "loads": ("inverted",)}


def _fits(query: Query, found: Sizes, most: float) -> Iterator[Error]:
    """Yield what would fit, and where it would be given; of one field the first that is there."""
    done = set()
    for what, field, places in _KNOBS:
        place = next((name for name in places if name in query.model_fields_set), None)
        if place and field not in done and (number := _largest(found, field, most)):
            done.add(field)
            yield f"/{place}", f"{number} {what} would fit"


def _largest(found: Sizes, field: str, most: float) -> int:
    """Return the largest number that fits in place of one, 0 if none does."""
    low, high = 0, int(getattr(found, field))
    while high - low > 1:
        middle = (low + high) // 2
        tried: dict[str, Any] = {field: middle}
        for part in _PARTS.get(field, ()):
            tried[part] = getattr(found, part) * middle // getattr(found, field)
        low, high = (middle, high) if estimated(found._replace(**tried)) <= most else (low, middle)
    return low
