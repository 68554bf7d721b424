"""The queries: endpoint, models and functions of each, from the request to its complete result.

These functions compute and check all values of a response; serializers only format them.
"""

from collections.abc import Callable, Mapping
from typing import Any, Final, NamedTuple

from mdr_service.queries.contacts import (
    contact_result,
    plain_result,
    solve_normal,
    solve_tangential,
)
from mdr_service.queries.fields import solve_stress, stress_result
from mdr_service.queries.fits import solve_fit, solve_loop
from mdr_service.queries.impacts import solve_impact
from mdr_service.queries.load_paths import history_result, solve_history
from mdr_service.queries.subsurface import solve_subsurface, subsurface_result
from mdr_service.queries.torsion import solve_torsion, torsion_result
from mdr_service.queries.wear import evolution_result, solve_evolution, solve_wear, wear_result
from mdr_service.schemas import answers
from mdr_service.schemas.contacts import NormalQuery, Query, TangentialQuery
from mdr_service.schemas.fields import StressQuery
from mdr_service.schemas.fits import FitQuery, LoopQuery
from mdr_service.schemas.impacts import ImpactQuery
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.schemas.torsion import TorsionQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery


class QueryType(NamedTuple):
    """A query: its endpoint, its models, and the functions that compute its result."""

    path: str
    summary: str
    """Title of the endpoint `POST`."""
    request: type[Query]
    response: type[answers.SolvedAnswer]
    solve: Callable[[Any], Any]
    """Function whose docstring is the description of the endpoint in OpenAPI."""
    result: Callable[[Any, Any], dict[str, Any]]
    """Function of the request and its solution; the members in their order, lists as arrays."""


QUERIES: Final[Mapping[str, QueryType]] = {
    "normal": QueryType(
        "/v1/normal",
        "Normal contact under a depth, a force or a contact radius",
        NormalQuery,
        answers.NormalAnswer,
        solve_normal,
        contact_result,
    ),
    "fit": QueryType(
        "/v1/normal/fit",
        "Modulus, contact point, offset and adhesion from a measured curve of force over depth",
        FitQuery,
        answers.FitAnswer,
        solve_fit,
        plain_result,
    ),
    "tangential": QueryType(
        "/v1/tangential",
        "Partial slip under a tangential force or displacement, or a stick radius",
        TangentialQuery,
        answers.TangentialAnswer,
        solve_tangential,
        contact_result,
    ),
    "history": QueryType(
        "/v1/tangential/history",
        "Load history: an arbitrary load path or identical cycles",
        HistoryQuery,
        answers.HistoryAnswer,
        solve_history,
        history_result,
    ),
    "tangential_fit": QueryType(
        "/v1/tangential/fit",
        "Shear modulus, friction and compliance of the rig from a measured loop",
        LoopQuery,
        answers.LoopAnswer,
        solve_loop,
        plain_result,
    ),
    "impact": QueryType(
        "/v1/tangential/impact",
        "Oblique impact: rebound, duration and loss of energy by friction",
        ImpactQuery,
        answers.ImpactAnswer,
        solve_impact,
        plain_result,
    ),
    "torsion": QueryType(
        "/v1/torsion",
        "Twist about the axis: torque, rotation and slip",
        TorsionQuery,
        answers.TorsionAnswer,
        solve_torsion,
        torsion_result,
    ),
    "stress": QueryType(
        "/v1/stress",
        "Surface stresses, slip and displacement over the radius",
        StressQuery,
        answers.StressAnswer,
        solve_stress,
        stress_result,
    ),
    "subsurface": QueryType(
        "/v1/subsurface",
        "Stresses beneath the surface of either body, their peaks and the onset of yield",
        SubsurfaceQuery,
        answers.SubsurfaceAnswer,
        solve_subsurface,
        subsurface_result,
    ),
    "wear": QueryType(
        "/v1/wear",
        "Limiting state of fretting wear under a small oscillation",
        WearQuery,
        answers.WearAnswer,
        solve_wear,
        wear_result,
    ),
    "evolution": QueryType(
        "/v1/wear/evolution",
        "Fretting wear over the cycles: profile and pressure up to the limiting state",
        EvolutionQuery,
        answers.EvolutionAnswer,
        solve_evolution,
        evolution_result,
    ),
}
"""The queries by their names in a batch, on the command line and as operations of OpenAPI."""
