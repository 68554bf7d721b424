"""The queries: request model -> arguments -> core -> complete plain result.

Everything that a response holds is computed and checked here: serializers only format it.
"""

from collections.abc import Callable, Mapping
from typing import Any, Final, NamedTuple

from mdr_service.queries.contacts import (
    Result,
    normal_result,
    solve_normal,
    solve_tangential,
    tangential_result,
)
from mdr_service.queries.fields import solve_stress, stress_result
from mdr_service.queries.fits import fit_result, solve_fit
from mdr_service.queries.impacts import impact_result, solve_impact
from mdr_service.queries.load_paths import history_result, solve_history
from mdr_service.queries.subsurface import solve_subsurface, subsurface_result
from mdr_service.queries.wear import evolution_result, solve_evolution, solve_wear, wear_result


class QueryType(NamedTuple):
    """Solver of a query, and the plain result of what it solves."""

    solve: Callable[..., Any]
    result: Callable[[Any, Any], Result]


QUERIES: Final[Mapping[str, QueryType]] = {
    "normal": QueryType(solve_normal, normal_result),
    "tangential": QueryType(solve_tangential, tangential_result),
    "history": QueryType(solve_history, history_result),
    "fit": QueryType(solve_fit, fit_result),
    "impact": QueryType(solve_impact, impact_result),
    "stress": QueryType(solve_stress, stress_result),
    "subsurface": QueryType(solve_subsurface, subsurface_result),
    "wear": QueryType(solve_wear, wear_result),
    "evolution": QueryType(solve_evolution, evolution_result),
}
