"""Queries about fretting wear."""

from typing import Any, Final

import numpy as np

from mdr_core import normal as normal_contact
from mdr_core.errors import Notice
from mdr_core.typing import Array, Flags
from mdr_core.wear import evolution as wear_evolution
from mdr_core.wear import limit as wear_limit
from mdr_core.wear.evolution import WearEvolution
from mdr_core.wear.limit import LimitingWear
from mdr_service.queries.contacts import (
    Result,
    body,
    by_load,
    control,
    friction,
    pointing,
    response,
    singular,
    solve_normal,
)
from mdr_service.queries.fields import require_radii
from mdr_service.schemas.wear import EvolutionQuery, WearQuery

Wear = LimitingWear | WearEvolution
# A tuple, because the order of a set, and thus of the warnings, differs between processes.
_PROFILES: Final = ("initial_profile", "limiting_profile", "profile")
# The request calls the amplitude `oscillation`.
_IN_REQUEST: Final = {"tangential": ("oscillation",)}
# Quantities that are infinite under unbounded wear.
_UNBOUNDED: Final = frozenset(
    {"wear_radius", "indentation_depth", "worn_volume", "limiting_profile", "worn_depth"}
)


def solve_wear(query: WearQuery) -> LimitingWear:
    """Compute the limiting profile: the annulus outside the stick zone wears until it is unloaded.

    The given controls are held constant. With a constant depth and displacement amplitude, and with
    constant forces, the limiting state is unique and does not depend on the wear law. With a
    constant normal force and displacement amplitude it depends on the path: the response is the
    approximation of Popov and Heß (2015), Eq. (5.90), with a warning `path_dependent`;
    `/v1/wear/evolution` computes the path itself.

    In full slip, wear is unbounded under a constant force (`endless_wear`), and ends in separation
    at a constant depth (`contact_lost`). Without slip there is no wear (`no_wear`).
    """
    require_radii(query)
    amplitude = control(query.oscillation)
    with pointing(_IN_REQUEST):
        return wear_limit.solve(solve_normal(query), **friction(query), **amplitude)


def wear_result(query: WearQuery, limit: LimitingWear) -> Result:
    """Return the limiting state of fretting wear."""
    return _result(query, limit, np.ravel(limit.stick_zone.unbounded))


def solve_evolution(query: EvolutionQuery) -> WearEvolution:
    """Integrate the wear law dh/dN = K µ p S over the cycles.

    h is the worn depth at a radius, and S the sliding distance of a cycle there. The given controls
    are held constant. A query takes about a second, more with the `resolution` and the numbers of
    cycles. A warning `limit_reached` reports after how many cycles wear stops.

    With a displacement amplitude in full slip, such as a ball in a reciprocating test, the whole
    contact wears: without bound under a constant force (`endless_wear`), at a constant depth until
    contact is lost (`contact_lost`).
    """
    require_radii(query)
    with pointing(_IN_REQUEST):
        return wear_evolution.solve(
            normal_contact.solve(**body(query), **control(query.load)),
            **friction(query),
            **control(query.oscillation),
            **query.model_dump(include={"wear_coefficient", "cycles", "resolution", "rtol"}),
        )


def evolution_result(query: EvolutionQuery, worn: WearEvolution) -> Result:
    """Return fretting wear at the listed numbers of cycles."""
    result = _result(query, worn, np.zeros(query.loads, dtype=bool))
    if "radius" in result:
        estimate = worn.field_error_estimate(result["radius"], query.quantities)
        result["field_error_estimate"] = estimate
    return result


def _result(query: WearQuery | EvolutionQuery, worn: Wear, unbounded: Flags) -> Result:
    """Return the result of a wear query, with its fields if it has radii."""
    values = by_load(worn, query.loads)
    radius = worn.grid(query.points) if query.points else np.array(query.radius or ())
    warnings, error = list[Notice](), None
    infinite: dict[str, Any] = {"pressure": True}
    if worn.normal.profile.is_flat_punch:
        infinite |= dict.fromkeys(_PROFILES, True)
    if radius.size:
        surface: Result = {name: _surface(worn, name, radius, query) for name in query.quantities}
        bounded = {
            name: field if name == "initial_profile" else field[~unbounded]
            for name, field in surface.items()
        }
        warnings += singular(radius, bounded, infinite)
        if isinstance(worn, LimitingWear):
            error = worn.error_estimate + worn.field_error_estimate(radius, query.quantities)
        values |= {"radius": radius} | surface
    for name in _UNBOUNDED & values.keys():
        flags = unbounded[:, None] if np.ndim(values[name]) > 1 else unbounded
        infinite[name] = flags | infinite.get(name, False)
    return response(query, worn, values, infinite=infinite, error=error, warnings=warnings)


def _surface(worn: Wear, name: str, radius: Array, query: WearQuery | EvolutionQuery) -> Array:
    """Return one field of a worn contact, by load if it depends on the load."""
    shape = (radius.size,) if name == "initial_profile" else (query.loads, radius.size)
    return np.ascontiguousarray(getattr(worn, name)(radius).reshape(shape))
