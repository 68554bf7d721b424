"""Plain results of queries: members of a response, checked for overflow, with their warnings."""

from collections.abc import Iterable, Mapping
from math import isfinite
from typing import Any

import numpy as np

from mdr_core import subsurface, validity
from mdr_core.elementwise import every
from mdr_core.errors import DefectError, InputError, Notice
from mdr_core.history import LoadHistory
from mdr_core.impact import Impact
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags
from mdr_core.wear.evolution import WearEvolution
from mdr_core.wear.limit import LimitingWear
from mdr_service.schemas.answers import SolvedAnswer
from mdr_service.schemas.contacts import NormalQuery, Query
from mdr_service.schemas.load_paths import HistoryQuery

Result = dict[str, Any]
"""The members of a JSON response in their order, with arrays for long lists."""
Wear = LimitingWear | WearEvolution
Contact = NormalContact | TangentialContact | LoadHistory


def require_one_of(query: Query, first: str, second: str) -> None:
    """Raise InputError unless exactly one of two fields is given."""
    if query.has(first) == query.has(second):
        place = second if query.has(second) else first
        raise InputError((place,), f"exactly one of {first}, {second} is needed")


def members(model: type[SolvedAnswer], without: Iterable[str] = ()) -> tuple[str, ...]:
    """Return the names of the numbers that a response holds."""
    excluded = {*SolvedAnswer.model_fields, *without}
    return tuple(name for name in model.model_fields if name not in excluded)


def by_load(source: object, names: Iterable[str], loads: int) -> Result:
    """Return attributes of `source` by name, broadcast to one entry per load."""
    if loads == 1:
        # Lists of one number take a tenth of the time of a small request less than arrays.
        return {name: [getattr(source, name).item()] for name in names}
    return {
        name: np.ascontiguousarray(np.broadcast_to(getattr(source, name), (loads,)))
        for name in names
    }


def checked(
    query: Query, values: Result, infinite: Mapping[str, bool | Flags] | None = None
) -> Result:
    """Return `values` by name if they are finite, or infinite only where `infinite` allows it.

    Raises InputError, which points at the load of the query, if a value overflows, and DefectError
    if one is NaN without an overflow.
    """
    suspect = {name: np.asarray(v) for name, v in values.items() if not _finite(v)}
    for name, array in suspect.items():
        stray = np.isinf(array) & ~np.asarray((infinite or {}).get(name, False))
        if stray.any():
            first = int(np.argwhere(stray)[0][0])
            place = ("radius", first) if name == "initial_profile" else query.place(first)
            raise InputError(place, f"{name} leaves the range of double precision here")
    for name, array in suspect.items():
        if np.isnan(array).any():
            raise DefectError(f"{name} is not a number")
    return values


def _finite(values: list[Any] | Array) -> bool:
    if isinstance(values, list):
        return isinstance(values[0], str) or isfinite(values[0])
    return values.dtype.kind != "f" or every(np.isfinite(values))


def response_metadata(
    query: Query,
    source: Contact | Wear | Impact,
    method: str,
    error: float,
    warnings: Iterable[Notice],
) -> Result:
    """Return the method, the error estimates and the warnings of a response."""
    contact = source.tangential_contact if isinstance(source, Wear) else source
    own = np.ravel(validity.model_error(contact, query.material.effective))
    count = query.path.samples if isinstance(query, HistoryQuery) else query.loads
    # Fields at the end of a history are those of its last sample.
    known = (
        own[-1:].tolist() if count == 1 else np.ascontiguousarray(np.broadcast_to(own, (count,)))
    )
    listed = [vars(notice) for notice in warnings]
    about = {"method": method, "error_estimate": error, "model_error": known}
    return about | {"warnings": listed}


def notices(query: Query, source: Contact | Impact | Wear) -> list[Notice]:
    """Return the warnings about a contact, its material and, if requested, yield."""
    contact = source.tangential_contact if isinstance(source, Wear) else source
    found = [*validity.notices(findings(query, contact)), *source.warnings_without_bodies]
    if isinstance(query, NormalQuery):
        return found
    # Other responses hold no scalar that is singular; their fields have warnings of their own.
    return [notice for notice in found if notice.code != "singular"]


def findings(query: Query, contact: Contact | Impact) -> list[validity.Finding]:
    """Return the findings on validity for the bodies of a query."""
    material = query.material.effective
    found = validity.findings(contact, material)
    if query.material.has("yield_strength"):
        ratios = material.poissons_ratios
        pressed = contact.normal if isinstance(contact, Impact) else contact
        found.append(subsurface.yield_finding(pressed, ratios, query.material.yield_strength))
    return found


def singular(
    radius: Array, values: Mapping[str, Array], possible: Mapping[str, Flags | bool]
) -> list[Notice]:
    """Return a warning for each field that is infinite at some of the `possible` radii."""
    found = []
    for name, flags in possible.items():
        if name not in values:
            continue
        at = radius[flags & np.isinf(np.atleast_2d(values[name])).any(axis=0)]
        if at.size:
            places = validity.listed([repr(r).removesuffix(".0") for r in at.tolist()])
            found.append(Notice("singular", f"{name} is infinite at radius {places}"))
    return found
