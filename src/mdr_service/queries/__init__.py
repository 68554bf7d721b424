"""The queries: request model -> arguments -> core -> complete plain result.

Everything that a response holds is computed and checked here: serializers only format it.
"""

from collections.abc import Callable, Mapping
from typing import Any, Final, NamedTuple

from mdr_service.queries.contacts import (
    normal_result,
    solve_normal,
    solve_tangential,
    tangential_result,
)
from mdr_service.queries.fields import solve_stress, stress_result
from mdr_service.queries.load_paths import history_result, solve_history
from mdr_service.queries.subsurface import solve_subsurface, subsurface_result
from mdr_service.queries.wear import evolution_result, solve_evolution, solve_wear, wear_result
from mdr_service.results import Result
from mdr_service.schemas.contacts import NormalQuery, Query, TangentialQuery
from mdr_service.schemas.fields import StressQuery
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery


class QueryType(NamedTuple):
    """Request model of a query, its solver, and the plain result of what it solves."""

    model: type[Query]
    solve: Callable[..., Any]
    result: Callable[[Any, Any], Result]


QUERIES: Final[Mapping[str, QueryType]] = {
    "normal": QueryType(NormalQuery, solve_normal, normal_result),
    "tangential": QueryType(TangentialQuery, solve_tangential, tangential_result),
    "history": QueryType(HistoryQuery, solve_history, history_result),
    "stress": QueryType(StressQuery, solve_stress, stress_result),
    "subsurface": QueryType(SubsurfaceQuery, solve_subsurface, subsurface_result),
    "wear": QueryType(WearQuery, solve_wear, wear_result),
    "evolution": QueryType(EvolutionQuery, solve_evolution, evolution_result),
}
