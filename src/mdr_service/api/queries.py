"""Endpoints of the queries, by POST and by URL parameters."""

from collections.abc import Callable
from typing import Annotated, Any, Final

from fastapi import APIRouter, Body, Query
from fastapi.types import DecoratedCallable

from mdr_service.api.documentation import GET_FAILURES, POST_FAILURES, RESULT
from mdr_service.api.query_route import QueryRoute
from mdr_service.content_negotiation import ResponseParameters
from mdr_service.query_parameters import PARAMETERS
from mdr_service.schemas.batch import BatchAnswer, BatchQuery
from mdr_service.schemas.contacts import NormalQuery, TangentialQuery
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.schemas.fields import StressQuery
from mdr_service.schemas.fits import FitQuery
from mdr_service.schemas.impacts import ImpactQuery
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery

router = APIRouter(route_class=QueryRoute, responses=POST_FAILURES)
_Form = Annotated[ResponseParameters, Query()]


def _examples(name: str) -> Any:
    return Body(openapi_examples=EXAMPLES[name])


def _described(name: str, tag: str, summary: str) -> dict[str, Any]:
    """Return the arguments that declare an endpoint of a query."""
    path, _, answer = SCHEMAS[name]
    texts = {"tags": [tag], "summary": summary}
    return {"path": path, **texts, "response_model": answer, "responses": RESULT}


def _post(name: str, tag: str, summary: str) -> Callable[[DecoratedCallable], DecoratedCallable]:
    return router.post(operation_id=name, **_described(name, tag, summary))


# Declarations for OpenAPI: `QueryRoute` handles the requests.


@_post("normal", "contact", "Normal contact under a depth, a force or a contact radius")
async def normal(query: Annotated[NormalQuery, _examples("normal")], form: _Form) -> None:
    """Compute the frictionless contact of a profile with an elastic half-space.

    Every list of the response has one entry per load. `method` names the most expensive method
    used, `error_estimate` is an upper bound on the relative error of every number.
    """


@_post(
    "fit",
    "contact",
    "Modulus, contact point, offset and adhesion from a measured curve of force over depth",
)
async def fit(query: Annotated[FitQuery, _examples("fit")], form: _Form) -> None:
    """Fit F = E* F̂(d − d₀) + F₀ to a measured curve by least squares.

    The standard errors hold for independent errors of the forces of equal size. A warning `misfit`
    tells that the residuals are not such noise: then the shape or the model is wrong.
    `error_estimate` is the numerical error of the parameters.
    """


@_post(
    "tangential",
    "contact",
    "Partial slip under a tangential force or displacement, or a stick radius",
)
async def tangential(
    query: Annotated[TangentialQuery, _examples("tangential")], form: _Form
) -> None:
    """Compute a contact with friction, loaded normally first and then tangentially once.

    Every list of the response has one entry per pair of loads. A tangential force beyond µ F_N has
    no equilibrium and is rejected; a displacement beyond full slip has the regime `full_slip`.
    """


@_post("history", "contact", "Load history: an arbitrary load path or identical cycles")
async def history(query: Annotated[HistoryQuery, _examples("history")], form: _Form) -> None:
    """Follow a load path from first contact, and return samples along it.

    Between two samples both loads vary linearly: the displacement with the depth, or the tangential
    force with the normal force. Every such path is solved exactly. Where a depth changes with a
    tangential force, or a normal force with a displacement, more `samples_per_step` follow the
    curve on which these vary linearly. A negative depth is a separation, which erases the slip
    memory. A tangential force beyond µ F_N, at a point or between points, has no equilibrium and is
    rejected.

    `error_estimate` is relative to the largest value on the path. It does not include
    `slip_fronts`. `energy_per_cycle` and `secant_stiffness` belong to
    `cycles`.
    """


@_post("impact", "contact", "Oblique impact: rebound, duration and loss of energy by friction")
async def impact(query: Annotated[ImpactQuery, _examples("impact")], form: _Form) -> None:
    """Compute the rebound of bodies that hit each other with normal and tangential velocities.

    The normal motion is elastic, and the tangential force follows from the slip memory of the
    whole contact. Masses are those of the contact point: m and 2/7 m for a solid sphere. Every
    list of the response has one entry per impact. Samples are doubled until `error_estimate` is
    below `rtol`; it is an estimate, relative to the larger tangential velocity, before or after the
    impact, and its energy.
    """


@_post("stress", "contact", "Surface stresses, slip and displacement over the radius")
async def stress(query: Annotated[StressQuery, _examples("stress")], form: _Form) -> None:
    """Compute the fields named in `quantities`, and nothing else, by load and radius.

    `error_estimate` bounds the error of each field relative to its largest value. A rounding error
    of a requested radius near a, c or a break is not included.
    """


@_post(
    "subsurface",
    "contact",
    "Stresses beneath the surface of either body, their peaks and the onset of yield",
)
async def subsurface(
    query: Annotated[SubsurfaceQuery, _examples("subsurface")], form: _Form
) -> None:
    """Compute the stresses named in `quantities` by load, depth z and x, in the plane of one y.

    `error_estimate` is relative to the largest stress of the response. With a `yield_strength` of
    the material, and without `history`, the response holds the normal force at the onset of yield,
    at the same ratio of tangential to normal force. The tangential force acts on body 1 along x,
    its reaction on body 2.
    """


@_post("wear", "wear", "Limiting state of fretting wear under a small oscillation")
async def wear(query: Annotated[WearQuery, _examples("wear")], form: _Form) -> None:
    """Compute the limiting profile: the annulus outside the stick zone wears until it is unloaded.

    The given controls are held constant. With a constant depth and displacement amplitude, and with
    constant forces, the limiting state is unique and does not depend on the wear law. With a
    constant normal force and displacement amplitude it depends on the path: the response is the
    approximation of Popov and Heß (2015), Eq. (5.90), with a warning `path_dependent`;
    `/v1/wear/evolution` computes the path itself.

    In full slip, wear is unbounded under a constant force (`endless_wear`), and ends in separation
    at a constant depth (`contact_lost`). Without slip there is no wear (`no_wear`).
    """


@_post(
    "evolution",
    "wear",
    "Fretting wear over the cycles: profile and pressure up to the limiting state",
)
async def evolution(query: Annotated[EvolutionQuery, _examples("evolution")], form: _Form) -> None:
    """Integrate the wear law dh/dN = K µ p S over the cycles.

    h is the worn depth at a radius, and S the sliding distance of a cycle there. The given controls
    are held constant. A query takes about a second, more with the `resolution` and the numbers of
    cycles. A warning `limit_reached` reports after how many cycles wear stops.

    With a displacement amplitude in full slip, such as a ball in a reciprocating test, the whole
    contact wears: without bound under a constant force (`endless_wear`), at a constant depth until
    contact is lost (`contact_lost`).
    """


@router.post(
    "/v1/batch",
    operation_id="batch",
    tags=["batch"],
    summary="Queries of any kind, each with its own answer or problem",
    response_model=BatchAnswer,
)
async def batch(query: Annotated[BatchQuery, _examples("batch")], form: _Form) -> None:
    """Compute each query as at its own endpoint, in the given order.

    The status is 200 if the list itself is valid. Each entry has its own `status`, with the
    `answer` or the `problem`, whose pointers are into its own `request`.
    """


_get_router: Final = APIRouter(route_class=QueryRoute, responses=GET_FAILURES)


def _declare_get(name: str, tag: str, title: str, model: Any) -> None:
    """Declare the endpoint of a query by URL parameters, whose model is made from the request."""
    texts = tag, f"{title} by parameters, for spreadsheets and browsers"

    @_get_router.get(operation_id=f"get_{name}", **_described(name, *texts))
    async def get(parameters: Annotated[model, Query()]) -> None:
        """Return the response of `POST` for numbers and at most one range.

        A range `..._from`, `..._to` and `n` stands for a list of `n` numbers.
        """


for _name, _tag, _title in (
    ("normal", "contact", "Normal contact"),
    ("tangential", "contact", "Partial slip"),
    ("history", "contact", "Cycles of the tangential load"),
    ("stress", "contact", "Fields over the radius"),
    ("wear", "wear", "Limiting state of fretting wear"),
):
    _declare_get(_name, _tag, _title, PARAMETERS[_name])
router.routes += _get_router.routes
