"""Expected computing time of a query, from its sizes alone.

It decides whether a query runs at once, on the event loop, or in a compute process, where the
deadline is the guarantee. A query of usual size takes at most four times as long, and an evolution
with little wear far less; a query that is expected to take longer than four times the deadline is
rejected.
"""

from math import log2
from typing import Final

from mdr_service import problems
from mdr_service.problems import ServiceError
from mdr_service.queries.contacts import is_new_table
from mdr_service.schemas.batch import BatchQuery
from mdr_service.schemas.contacts import NormalQuery, Query, TangentialQuery
from mdr_service.schemas.fields import FieldQuery, LoadedQuery, StressQuery
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.profiles import Profile
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery
from mdr_service.serializers import PICTURES
from mdr_service.settings import SETTINGS

AT_ONCE_SECONDS: Final = 5e-4
"""Computation on the event loop at any load; a round trip to a compute process takes as long."""
# The same with no other request in progress; beside others, the processes use more cores.
_AT_ONCE_ALONE: Final = 2e-3
# All times are those of one core of a server of 2023 [s].
# Time of a query about a single load of a cone; beneath the surface, under each load.
_START: Final[dict[type[Query], float]] = {
    NormalQuery: 1e-4,
    TangentialQuery: 2e-4,
    StressQuery: 1e-4,
    HistoryQuery: 5e-4,
    WearQuery: 6e-4,
    EvolutionQuery: 0.12,
    SubsurfaceQuery: 1e-3,
}
# Time to list the errors of an invalid query.
_INVALID: Final = 5e-5
# Time to resolve a table. A single query leaves it to a compute process, and has the rest at once.
_RESOLVE: Final = 2e-2
# Additional time of many loads, for which arrays take the place of single numbers.
_ARRAYS: Final = 2e-4
# Time per load without and with friction or per sample, per load with wear, per entry of `cycles`.
_LOAD, _FRICTION, _WEAR, _CYCLE = 1.5e-7, 8e-7, 2e-6, 1e-3
# Time of the energies per sample.
_SAMPLE: Final = 3e-6
# Time of the search for the largest pressure off the axis, per load.
_SEARCH: Final = 2e-5
# Time per field and load, and per value of it at a radius.
_FIELD, _VALUE = 3e-5, 1.5e-7
# Time to draw a picture.
_PICTURE: Final = 0.3
# Time per nonlinear load step, and per node of an evolution beyond the fewest.
_NONLINEAR_STEP, _NODE = 2.5e-3, 7.5e-3
# Factors by which times grow for profiles without closed inverses, per term of a series, and for
# tables. Times of integrals grow with the fourth root.
_IMPLICIT, _TERM, _TABLE = 6.0, 2.0, 12.0
_EXPLICIT: Final = frozenset({"flat_punch", "cone", "paraboloid", "power"})
# Profiles whose largest pressure may have to be searched off the axis.
_SEARCHED_PROFILES: Final = frozenset({"series", "spherical_tip_cone"})
# Time per point beneath the surface.
_POINT: Final = 4e-6
# Number of points of a search for the peak, and of such searches for the onset of yield.
_SEARCHED, _ONSETS = 2000, 10
# Profiles whose peak is a multiple of the mean pressure: without friction, it is known.
_SIMILAR: Final = frozenset({"cone", "paraboloid", "power"})
# Well beyond the deadline, since few queries take less than a quarter of the expected time.
_LONGEST: Final = 4.0 * SETTINGS.budget_seconds


def seconds(query: Query | BatchQuery) -> float:
    """Return the expected time of a query or a batch."""
    if isinstance(query, BatchQuery):
        times = [
            seconds(item.query) + _RESOLVE * is_new_table(item.query.profile)
            if isinstance(item.query, Query)
            else _INVALID
            for item in query.queries
        ]
        # A query that is rejected alone takes no time.
        return sum(time for time in times if time <= _LONGEST)
    if isinstance(query, SubsurfaceQuery) and not query.path:
        return _START[SubsurfaceQuery] * query.loads + _beneath(query)
    scale, path, loads = _complexity(query.profile), query.path, query.loads
    # Times that grow with the factor of the profile, and with its fourth root. A table is resolved
    # once for many queries.
    evaluated, integrated = 0.0, _START[HistoryQuery if path else type(query)]
    if query.numbers and isinstance(query, FieldQuery):
        fields = loads * len(query.quantities) * (_FIELD + _VALUE * query.radii)
        if "normal_displacement" in query.quantities:
            evaluated += fields
        else:
            integrated += fields
    if path:
        evaluated += _FRICTION * path.samples
        integrated += _SAMPLE * path.samples + (
            _NONLINEAR_STEP * path.steps if path.nonlinear else 0.0
        )
    elif isinstance(query, (NormalQuery, LoadedQuery)):
        with_friction = query.has("friction_coefficient")
        evaluated += (_FRICTION if with_friction else _LOAD) * loads
        evaluated += _ARRAYS if loads > 1 else 0.0
        if isinstance(query, NormalQuery) and query.profile.kind in _SEARCHED_PROFILES:
            integrated += _SEARCH * loads
    elif isinstance(query, EvolutionQuery):
        integrated += _NODE * query.resolution + _CYCLE * loads
    else:
        evaluated += _WEAR * loads
    root: float = scale**0.25
    return scale * evaluated + root * integrated + _beneath(query)


def _beneath(query: Query) -> float:
    """Return the expected time of stresses beneath the surface, and of searches among them."""
    with_friction = query.has("friction_coefficient")
    with_yield = query.material.has("yield_strength")
    points, searches = 0, 0.0
    if with_yield and (with_friction or query.profile.kind not in _SIMILAR):
        # The warning `yield` bisects the loads.
        searches += 1 + log2(max(query.loads, 1))
    if isinstance(query, SubsurfaceQuery):
        points = query.loads * query.positions
        searches += 2 * query.loads * query.largest
        if with_yield and not query.has("history"):
            # Loads in one ratio of the forces share the onset.
            searches += _ONSETS * (query.loads if with_friction else 1)
    # The traction has two segments with friction, and more at the end of a load path.
    segments = (2 if with_friction else 1) * (3 if query.has("history") else 1)
    return _POINT * segments * (points + _SEARCHED * searches)


def require_feasible(query: Query | BatchQuery, media_type: str) -> float:
    """Return the expected time of a response; raise ServiceError if it far exceeds the limit."""
    expected = seconds(query) + (_PICTURE if media_type in PICTURES else 0.0)
    limit = SETTINGS.budget_seconds
    if expected > _LONGEST:
        part = limit / expected
        detail = f"estimated time of {expected:.2g} s far exceeds the limit of {limit:.2g} s"
        fits = [
            (f"/{name}", f"{detail}; about {max(int(part * count), 1)} would fit")
            for name, count in _sizes(query).items()
        ]
        raise ServiceError(problems.TOO_COSTLY, detail, fits)
    return expected


def is_short(expected: float, requests: int) -> bool:
    """Return True if a query runs on the event loop, for which all `requests` in progress wait."""
    return expected <= max(AT_ONCE_SECONDS, _AT_ONCE_ALONE / max(requests, 1))


def _complexity(profile: Profile) -> float:
    if profile.kind in _EXPLICIT:
        return 1.0
    if profile.kind == "series":
        return _IMPLICIT + _TERM * len(profile.terms)
    return _TABLE if profile.kind == "tabulated" else _IMPLICIT


def _sizes(query: Query | BatchQuery) -> dict[str, int]:
    """Return the sizes that can be reduced, by the member of the request."""
    if isinstance(query, BatchQuery):
        return {"queries": len(query.queries)}
    if query.path:
        found = {"history" if query.has("history") else "cycles": query.path.samples}
    else:
        found = {"cycles" if isinstance(query, EvolutionQuery) else "load": query.loads}
    if isinstance(query, SubsurfaceQuery):
        found["points" if query.points else "x"] = query.points or len(query.x or ())
    if isinstance(query, FieldQuery) and query.radii:
        found["points" if query.points else "radius"] = query.radii
    return {name: count for name, count in found.items() if count > 1}
