"""Queries about oblique impacts."""

from typing import Final

from mdr_core import impact
from mdr_core.impact import Impact
from mdr_service.queries.contacts import (
    Result,
    body,
    by_load,
    checked,
    friction,
    members,
    notices,
    response_metadata,
)
from mdr_service.schemas.answers import ImpactAnswer
from mdr_service.schemas.impacts import ImpactQuery

_QUANTITIES: Final = members(ImpactAnswer)
_MOTION: Final = {"normal_mass", "tangential_mass", "normal_velocity", "tangential_velocity"}


def solve_impact(query: ImpactQuery) -> Impact:
    """Return the impacts of a query."""
    motion = query.model_dump(include=_MOTION)
    return impact.solve(**body(query), **friction(query), **motion, rtol=query.rtol)


def impact_result(query: ImpactQuery, source: Impact) -> Result:
    """Return velocities, durations and energies of impacts."""
    values = checked(query, by_load(source, _QUANTITIES, query.loads))
    about = source.method, source.error_estimate, notices(query, source)
    return values | response_metadata(query, source, *about)
