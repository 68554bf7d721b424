"""Queries about contacts: profile, material and load -> contact of the core -> result."""

from functools import lru_cache
from typing import Any, Final

import numpy as np

from mdr_core import adhesion, profiles
from mdr_core import normal as normal_contact
from mdr_core import tangential as tangential_contact
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_service.results import Result, by_load, checked, members, notices, response_metadata
from mdr_service.schemas.answers import TangentialAnswer
from mdr_service.schemas.contacts import Choice, NormalQuery, Query, TangentialQuery
from mdr_service.schemas.fields import LoadedQuery
from mdr_service.schemas.profiles import Profile
from mdr_service.schemas.wear import WearQuery

Arguments = dict[str, Any]
ADHESION: Final = {"work_of_adhesion", "range_of_adhesion"}
"""Members of the material that make a contact adhesive."""

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
