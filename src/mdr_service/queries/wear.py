"""Queries about fretting wear."""

from typing import Any, Final, get_args

import numpy as np

from mdr_core import normal as normal_contact
from mdr_core.errors import InputError
from mdr_core.typing import Array, Flags
from mdr_core.wear import evolution as wear_evolution
from mdr_core.wear import limit as wear_limit
from mdr_core.wear.evolution import WearEvolution
from mdr_core.wear.limit import LimitingWear
from mdr_service.queries.contacts import (
    Result,
    Wear,
    body,
    by_load,
    checked,
    control,
    friction,
    members,
    notices,
    paired,
    response_metadata,
    singular,
    solve_normal,
)
from mdr_service.queries.fields import require_few_numbers
from mdr_service.schemas.answers import EvolutionAnswer, WearAnswer
from mdr_service.schemas.wear import EvolutionField, EvolutionQuery, WearField, WearQuery

_WEAR: Final = members(WearAnswer, ("radius", *get_args(WearField)))
_EVOLUTION: Final = members(
    EvolutionAnswer, ("radius", "field_error_estimate", *get_args(EvolutionField))
)
# A set would order the warnings by chance, and differently in each process.
_PROFILES: Final = ("initial_profile", "limiting_profile", "profile")
# Infinite under unbounded wear.
_UNBOUNDED: Final = frozenset(
    {"wear_radius", "indentation_depth", "worn_volume", "limiting_profile", "worn_depth"}
)


def solve_wear(query: WearQuery) -> LimitingWear:
    """Return the limiting state of fretting wear of a query."""
    _require_radii(query)
    amplitude = paired("oscillation", query.oscillation, query.load)
    try:
        return wear_limit.solve(solve_normal(query), **friction(query), **amplitude)
    except InputError as error:
        raise _in_request(error) from None


def wear_result(query: WearQuery, limit: LimitingWear) -> Result:
    """Return the limiting state of fretting wear."""
    values = by_load(limit, _WEAR, query.loads)
    return _result(query, limit, values, np.ravel(limit.stick_zone.unbounded))


def solve_evolution(query: EvolutionQuery) -> WearEvolution:
    """Return fretting wear over the cycles of a query."""
    _require_radii(query)
    try:
        return wear_evolution.solve(
            # The tolerance is that of the integration over the cycles.
            normal_contact.solve(**body(query), **control(query.load)),
            **friction(query),
            **control(query.oscillation),
            wear_coefficient=query.wear_coefficient,
            cycles=np.array(query.cycles, dtype=float),
            resolution=query.resolution,
            rtol=query.rtol,
        )
    except InputError as error:
        raise _in_request(error) from None


def evolution_result(query: EvolutionQuery, worn: WearEvolution) -> Result:
    """Return fretting wear at the listed numbers of cycles."""
    values = by_load(worn, _EVOLUTION, query.loads)
    result = _result(query, worn, values, np.zeros(query.loads, dtype=bool))
    if "radius" in result:
        estimate = worn.field_error_estimate(result["radius"], query.quantities)
        result["field_error_estimate"] = estimate
    return result


def _result(
    query: WearQuery | EvolutionQuery, worn: Wear, values: Result, unbounded: Flags
) -> Result:
    """Return the result of a wear query, with its fields if it has radii."""
    radius = worn.grid(query.points) if query.points else np.array(query.radius or ())
    warnings, error = notices(query, worn), worn.error_estimate
    infinite: dict[str, Any] = {"pressure": True}
    if worn.normal.profile.has_no_partial_slip:
        infinite |= dict.fromkeys(_PROFILES, True)
    if radius.size:
        surface: Result = {name: _surface(worn, name, radius, query) for name in query.quantities}
        bounded = {
            name: field if name == "initial_profile" else field[~unbounded]
            for name, field in surface.items()
        }
        warnings += singular(radius, bounded, infinite)
        if isinstance(worn, LimitingWear):
            error += worn.field_error_estimate(radius, query.quantities)
        values |= {"radius": radius} | surface
    for name in _UNBOUNDED & values.keys():
        flags = unbounded[:, None] if np.ndim(values[name]) > 1 else unbounded
        infinite[name] = flags | infinite.get(name, False)
    return checked(query, values, infinite) | response_metadata(
        query, worn, worn.method, error, warnings
    )


def _surface(worn: Wear, name: str, radius: Array, query: WearQuery | EvolutionQuery) -> Array:
    """Return one field of a worn contact, by load if it depends on the load."""
    shape = (radius.size,) if name == "initial_profile" else (query.loads, radius.size)
    return np.ascontiguousarray(getattr(worn, name)(radius).reshape(shape))


def _require_radii(query: WearQuery | EvolutionQuery) -> None:
    """Raise InputError unless radii are given once at most, and where fields need them."""
    if query.radius and query.points:
        raise InputError(("points",), "at most one of radius, points is needed")
    if "quantities" in query.model_fields_set and not query.radii:
        raise InputError(("radius",), "quantities over the radius need radius or points")
    require_few_numbers(query)


def _in_request(error: InputError) -> InputError:
    """Return the error with the path of the request, which calls the amplitude `oscillation`."""
    first, *rest = error.path
    return InputError(("oscillation", *rest), error.detail) if first == "tangential" else error
