"""Queries about contacts, and what all queries share.

Profile, material and load become arguments of the core; its results, checked for overflow and with
their warnings, the members of a response.
"""

from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any, Final

import numpy as np

from mdr_core import adhesion, profiles, subsurface, validity
from mdr_core import normal as normal_contact
from mdr_core import tangential as tangential_contact
from mdr_core.elementwise import every
from mdr_core.errors import DefectError, InputError, Notice
from mdr_core.history import LoadHistory
from mdr_core.impact import Impact
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags
from mdr_core.wear.evolution import WearEvolution
from mdr_core.wear.limit import LimitingWear
from mdr_service.schemas.answers import SolvedAnswer, TangentialAnswer
from mdr_service.schemas.contacts import Choice, NormalQuery, Query, TangentialQuery
from mdr_service.schemas.fields import LoadedQuery
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.profiles import Profile
from mdr_service.schemas.wear import WearQuery

Arguments = dict[str, Any]
ADHESION: Final = {"work_of_adhesion", "range_of_adhesion"}
"""Members of the material that make a contact adhesive."""

Result = dict[str, Any]
"""The members of a JSON response in their order, with arrays for long lists."""
Wear = LimitingWear | WearEvolution
Contact = NormalContact | TangentialContact | LoadHistory


def members(model: type[SolvedAnswer], without: Iterable[str] = ()) -> tuple[str, ...]:
    """Return the names of the numbers that a response holds."""
    excluded = {*SolvedAnswer.model_fields, *without}
    return tuple(name for name in model.model_fields if name not in excluded)


_NORMAL: Final = NormalContact.quantities
_PARTIAL_SLIP: Final = members(TangentialAnswer, [*_NORMAL, "data_error"])


def solve_normal(query: NormalQuery | LoadedQuery | WearQuery) -> NormalContact:
    """Return the normal contact of a query, which is adhesive with a work of adhesion."""
    arguments = body(query) | control(query.load)
    given = query.material.model_dump(include=ADHESION, exclude_unset=True)
    solve: Any = adhesion.solve if given else normal_contact.solve
    contact: NormalContact = solve(**arguments, **given, rtol=query.rtol)
    return contact


def normal_result(query: NormalQuery, contact: NormalContact) -> Result:
    """Return the quantities of a frictionless normal contact."""
    return _result(query, contact, by_load(contact, contact.quantities, query.loads))


def solve_tangential(query: TangentialQuery | LoadedQuery) -> TangentialContact:
    """Return the contact with friction of a query."""
    tangential = paired("tangential", query.tangential, query.load)
    return tangential_contact.solve(solve_normal(query), **friction(query), **tangential)


def tangential_result(query: TangentialQuery, contact: TangentialContact) -> Result:
    """Return the quantities of a contact in partial slip under a tangential load."""
    loads = query.loads
    values = by_load(contact.normal, _NORMAL, loads) | by_load(contact, _PARTIAL_SLIP, loads)
    return _result(query, contact, values)


def profile(model: Profile) -> profiles.Profile:
    """Return the profile; fields have the same names in the model and in the core."""
    given: Arguments = {name: value for name, value in vars(model).items() if name != "kind"}
    if model.kind == "tabulated":
        given = {name: tuple(v) if isinstance(v, list) else v for name, v in given.items()}
    if model.kind == "series":
        given["terms"] = tuple(profiles.PowerTerm(**vars(term)) for term in model.terms)
    return _by_parameters(model.kind, **given)


# Fitting a table takes up to a hundred times as long as a contact, and a profile computes its break
# and the contact coordinate there on first use.
@lru_cache(maxsize=32)
def _by_parameters(kind: str, **given: Any) -> profiles.Profile:
    return profiles.KINDS[kind](**given)


def body(query: Query) -> Arguments:
    """Return profile and effective modulus, as arguments of the core.

    Raises InputError where adhesion meets friction or yield, or has a range and no work.
    """
    material = query.material
    if material.has("work_of_adhesion"):
        if query.has("friction_coefficient"):
            raise InputError(("material", "work_of_adhesion"), adhesion.AdhesiveContact.unusable)
        if material.has("yield_strength"):
            raise InputError(("material", "yield_strength"), adhesion.AdhesiveContact.unusable)
    elif material.has("range_of_adhesion"):
        raise InputError(("material", "work_of_adhesion"), "is needed with range_of_adhesion")
    return {"profile": profile(query.profile), "e_star": query.material.effective.e_star}


def friction(query: Any) -> Arguments:
    """Return shear modulus and coefficient of friction, as arguments of the core."""
    effective = query.material.effective
    return {"g_star": effective.g_star, "friction_coefficient": query.friction_coefficient}


def control(given: Choice) -> Arguments:
    """Return the given control by its name, as an argument of the core."""
    value = given.value
    return {given.control: np.array(value, dtype=float) if isinstance(value, list) else value}


def paired(name: str, given: Choice, load: Choice) -> Arguments:
    """Return the tangential control: one value for all normal loads, or one for each."""
    if given.count > 1 and load.count not in {1, given.count}:
        detail = f"{given.count} values for {load.count} normal loads: give one, or as many"
        raise InputError((name, given.control), detail)
    return control(given)


def _result(
    query: NormalQuery, source: NormalContact | TangentialContact, values: Result
) -> Result:
    warnings = notices(query, source)
    if source.normal.data_error is not None:
        values |= by_load(source.normal, ["data_error"], query.loads)
    singular = any(notice.code == "singular" for notice in warnings)
    names = ("mean_pressure", "maximum_pressure", "normal_stiffness")
    infinite = dict.fromkeys(names, singular)
    found = checked(query, values, infinite)
    return found | response_metadata(query, source, source.method, source.error_estimate, warnings)


def require_one_of(query: Query, first: str, second: str) -> None:
    """Raise InputError unless exactly one of two fields is given."""
    if query.has(first) == query.has(second):
        place = second if query.has(second) else first
        raise InputError((place,), f"exactly one of {first}, {second} is needed")


def by_load(source: object, names: Iterable[str], loads: int) -> Result:
    """Return attributes of `source` by name, broadcast to one entry per load."""
    return {name: np.full(loads, getattr(source, name)) for name in names}


def checked(
    query: Query, values: Result, infinite: Mapping[str, bool | Flags] | None = None
) -> Result:
    """Return `values` by name if they are finite, or infinite only where `infinite` allows it.

    Raises InputError if a value overflows, and DefectError if one is NaN without an overflow.
    """
    suspect = {name: array for name, array in values.items() if not _finite(array)}
    for name, array in suspect.items():
        stray = np.isinf(array) & ~np.asarray((infinite or {}).get(name, False))
        if stray.any():
            first = int(np.argwhere(stray)[0][0])
            detail = f"{name} leaves the range of double precision at its entry {first}"
            raise InputError(tuple(query.controls)[:1], detail)
    for name, array in suspect.items():
        if np.isnan(array).any():
            raise DefectError(f"{name} is not a number")
    return values


def _finite(values: Array) -> bool:
    return values.dtype.kind != "f" or every(np.isfinite(values))


def response_metadata(
    query: Query,
    source: Contact | Wear | Impact,
    method: str,
    error: float,
    warnings: Iterable[Notice],
) -> Result:
    """Return the method, the error estimates and the warnings of a response.

    Parameters
    ----------
    query : the request, with the bodies and the required accuracy.
    source : the solution.
    method : name of the method.
    error : error estimate of all numbers of the response, its fields included.
    warnings : those to be reported.
    """
    contact = source.tangential_contact if isinstance(source, Wear) else source
    own = np.ravel(validity.model_error(contact, query.material.effective))
    count = query.path.samples if isinstance(query, HistoryQuery) else query.loads
    # Fields at the end of a history are those of its last sample.
    known = own[-1:] if count == 1 else np.full(count, own)
    # The source warns of its own error, not of the error of fields.
    given = [*warnings]
    found = [notice for notice in given if notice.code != "accuracy"]
    if error > query.rtol and (found != given or source.error_estimate <= query.rtol):
        found.append(normal_contact.not_reached(query.rtol, error))
    listed = [vars(notice) for notice in found]
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
