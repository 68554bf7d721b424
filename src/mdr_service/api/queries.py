"""Endpoints of the queries."""

from functools import partial
from typing import Annotated

from fastapi import APIRouter, Body, Query
from starlette.responses import Response

from mdr_service.api.documentation import BATCH_RESPONSES, GET_RESPONSES, POST_RESPONSES
from mdr_service.api.parameters import (
    NormalParameters,
    StressParameters,
    TangentialParameters,
    WearParameters,
)
from mdr_service.api.query_route import QueryRoute, Respond, RespondToBatch
from mdr_service.schemas import examples
from mdr_service.schemas.answers import (
    EvolutionAnswer,
    HistoryAnswer,
    NormalAnswer,
    StressAnswer,
    SubsurfaceAnswer,
    TangentialAnswer,
    WearAnswer,
)
from mdr_service.schemas.batch import BatchAnswer, BatchQuery
from mdr_service.schemas.contacts import NormalQuery, TangentialQuery
from mdr_service.schemas.fields import StressQuery
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery

router = APIRouter(route_class=QueryRoute)
_post = partial(router.post, responses=POST_RESPONSES)
_get = partial(router.get, responses=GET_RESPONSES)


@_post(
    "/v1/normal",
    operation_id="normal",
    tags=["contact"],
    summary="Normal contact under a depth, a force or a contact radius",
    response_model=NormalAnswer,
)
async def post_normal(
    query: Annotated[NormalQuery, Body(openapi_examples=examples.NORMAL_EXAMPLES)],
    respond: Respond,
) -> Response:
    """Compute the frictionless contact of a profile with an elastic half-space.

    Every list of the response has one entry per load. `method` names the most expensive method
    used, `error_estimate` is an upper bound on the relative error of every number.
    """
    return await respond("normal", query)


@_get(
    "/v1/normal",
    operation_id="get_normal",
    tags=["contact"],
    summary="Normal contact by parameters, for spreadsheets and browsers",
    response_model=NormalAnswer,
)
async def get_normal(
    parameters: Annotated[NormalParameters, Query()], respond: Respond
) -> Response:
    """Compute the same as `POST` from numbers and at most one range.

    A range `..._from`, `..._to` and `n` stands for a list of `n` numbers.
    """
    return await respond("normal", parameters.query())


@_post(
    "/v1/tangential",
    operation_id="tangential",
    tags=["contact"],
    summary="Partial slip under a tangential force or displacement, or a stick radius",
    response_model=TangentialAnswer,
)
async def post_tangential(
    query: Annotated[TangentialQuery, Body(openapi_examples=examples.TANGENTIAL_EXAMPLES)],
    respond: Respond,
) -> Response:
    """Compute a contact with friction, loaded normally first and then tangentially once.

    Every list of the response has one entry per pair of loads. A tangential force beyond µ F_N has
    no equilibrium and is rejected; a displacement beyond full slip has the regime `full_slip`.
    """
    return await respond("tangential", query)


@_get(
    "/v1/tangential",
    operation_id="get_tangential",
    tags=["contact"],
    summary="Partial slip by parameters, for spreadsheets and browsers",
    response_model=TangentialAnswer,
)
async def get_tangential(
    parameters: Annotated[TangentialParameters, Query()], respond: Respond
) -> Response:
    """Compute the same as `POST` from numbers and at most one range."""
    return await respond("tangential", parameters.query())


@_post(
    "/v1/tangential/history",
    operation_id="history",
    tags=["contact"],
    summary="Load history: an arbitrary load path or identical cycles",
    response_model=HistoryAnswer,
)
async def post_history(
    query: Annotated[HistoryQuery, Body(openapi_examples=examples.HISTORY_EXAMPLES)],
    respond: Respond,
) -> Response:
    """Follow a load path from first contact, and return samples along it.

    The controls vary linearly from point to point. Paths of depths and displacements, and of
    normal and tangential forces, are solved exactly. A depth with a tangential force, or a normal
    force with a displacement, is integrated to `rtol` where both change. A negative depth is a
    separation, which erases the slip memory. A tangential force beyond µ F_N, at a point or between
    points, has no equilibrium and is rejected.

    `error_estimate` is relative to the largest value on the path. A warning `accuracy` says where
    `slip_fronts` is less accurate. `energy_per_cycle` and `secant_stiffness` belong to `cycles`.
    """
    return await respond("history", query)


@_post(
    "/v1/stress",
    operation_id="stress",
    tags=["contact"],
    summary="Surface stresses, slip and displacement over the radius",
    response_model=StressAnswer,
)
async def post_stress(
    query: Annotated[StressQuery, Body(openapi_examples=examples.STRESS_EXAMPLES)],
    respond: Respond,
) -> Response:
    """Compute the fields named in `quantities`, and nothing else, by load and radius.

    `error_estimate` bounds the error of each field relative to its largest value. A rounding error
    of a requested radius near a, c or a break is not included.
    """
    return await respond("stress", query)


@_get(
    "/v1/stress",
    operation_id="get_stress",
    tags=["contact"],
    summary="Fields over the radius by parameters, for spreadsheets and browsers",
    response_model=StressAnswer,
)
async def get_stress(
    parameters: Annotated[StressParameters, Query()], respond: Respond
) -> Response:
    """Compute the same as `POST` from numbers and at most one range."""
    return await respond("stress", parameters.query())


@_post(
    "/v1/subsurface",
    operation_id="subsurface",
    tags=["contact"],
    summary="Stresses beneath the surface of either body, their peaks and the onset of yield",
    response_model=SubsurfaceAnswer,
)
async def post_subsurface(
    query: Annotated[SubsurfaceQuery, Body(openapi_examples=examples.SUBSURFACE_EXAMPLES)],
    respond: Respond,
) -> Response:
    """Compute the stresses named in `quantities` by load, depth z and x, in the plane of one y.

    `error_estimate` is relative to the largest stress of the response. With a `yield_strength` of
    the material the response holds the normal force at the onset of yield, at the same ratio of
    tangential to normal force. The tangential force acts on body 1, which passes it on to body 2.
    """
    return await respond("subsurface", query)


@_post(
    "/v1/wear",
    operation_id="wear",
    tags=["wear"],
    summary="Limiting state of fretting wear under a small oscillation",
    response_model=WearAnswer,
)
async def post_wear(
    query: Annotated[WearQuery, Body(openapi_examples=examples.WEAR_EXAMPLES)], respond: Respond
) -> Response:
    """Compute the limiting profile: the annulus outside the stick zone wears until it is unloaded.

    The given controls are held constant. With a constant depth and displacement amplitude, and with
    constant forces, the limiting state is unique, whatever the law of wear. With a constant normal
    force and displacement amplitude it depends on the path: the response is Eq. (5.90) with a
    warning `path_dependent`; `/v1/wear/evolution` computes the path itself.

    In full slip, wear is unbounded under a constant force (`endless_wear`), and ends in separation
    at a constant depth (`contact_lost`). Without slip there is no wear (`no_wear`).
    """
    return await respond("wear", query)


@_get(
    "/v1/wear",
    operation_id="get_wear",
    tags=["wear"],
    summary="Limiting state of fretting wear by parameters, for spreadsheets and browsers",
    response_model=WearAnswer,
)
async def get_wear(parameters: Annotated[WearParameters, Query()], respond: Respond) -> Response:
    """Compute the same as `POST` from numbers and at most one range."""
    return await respond("wear", parameters.query())


@_post(
    "/v1/wear/evolution",
    operation_id="evolution",
    tags=["wear"],
    summary="Fretting wear over the cycles: profile and pressure up to the limiting state",
    response_model=EvolutionAnswer,
)
async def post_evolution(
    query: Annotated[EvolutionQuery, Body(openapi_examples=examples.EVOLUTION_EXAMPLES)],
    respond: Respond,
) -> Response:
    """Integrate wear over the cycles: dV/dN = K W at each radius, W the friction work of a cycle.

    The given controls are held constant. A query takes about a second, more with the `resolution`
    and the numbers of cycles. A warning `limit_reached` says after how many cycles wear stops.
    """
    return await respond("evolution", query)


@router.post(
    "/v1/batch",
    operation_id="batch",
    tags=["batch"],
    summary="Queries of any kind, each with its own answer or problem",
    response_model=BatchAnswer,
    responses=BATCH_RESPONSES,
)
async def post_batch(
    query: Annotated[BatchQuery, Body(openapi_examples=examples.BATCH_EXAMPLES)],
    respond: RespondToBatch,
) -> Response:
    """Compute each query as at its own endpoint, in the given order.

    The status is 200 if the list itself is valid. Each entry has its own `status`, with the
    `answer` or the `problem`, whose pointers are into its own `request`.
    """
    return await respond("batch", query)
