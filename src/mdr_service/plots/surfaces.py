"""Fields and worn profiles over the radius, and a map of the stress beneath the surface."""

from collections.abc import Iterable, Mapping, Sequence
from math import inf
from typing import Any, Final, TypeVar

import numpy as np

from mdr_core import fields, subsurface
from mdr_core.history import LoadHistory
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.wear.evolution import WearEvolution
from mdr_core.wear.limit import LimitingWear
from mdr_service.plots.plot import (
    LABELS,
    MAX_CURVES,
    NOTHING,
    POINTS,
    VISIBLE,
    Curve,
    Map,
    Mark,
    Panel,
    Plot,
    subset_note,
    symbol,
)
from mdr_service.queries.fields import at_end, field, solve_stress
from mdr_service.queries.subsurface import body_of
from mdr_service.queries.wear import solve_wear
from mdr_service.results import Contact, Result, Wear
from mdr_service.schemas.fields import StressQuery
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery

_Query = TypeVar("_Query", StressQuery, WearQuery)

# A stress is cut above what it exceeds on 3 % of the axis only, if its peak is twice as high.
_USUAL, _PEAK, _HEADROOM = 0.97, 2.0, 1.15
_CUT: Final = frozenset({"pressure", "shear_stress"})
_REQUESTED: Final = "requested radii"
# Points of the map along z, and its extent in contact radii.
_DOWN, _EXTENT = 81, 1.5


def stress(query: StressQuery, source: Contact, result: Result) -> Plot:
    """Return each requested field over the radius, with the breaks b, the edges a and c marked."""
    shown = source if query.loads <= MAX_CURVES else solve_stress(_first_loads(query))
    contact, partial = end = at_end(shown)
    edges, fronts = np.ravel(contact.contact_radius), _slip_fronts(shown)
    breaks = [float(b) for b in contact.profile.breaks]
    grid = fields.grid(partial or contact, POINTS + edges.size + fronts.size + len(breaks))
    requested = result["radius"]
    window = requested.min(), requested.max()
    if np.ptp(requested) == 0:
        window = 0.0, max(grid[-1], requested[0])
    radius = np.unique([*np.clip(grid, *window), *_evenly(*window)])
    loads = min(query.loads, MAX_CURVES)
    dense = {
        name: np.broadcast_to(field(name, end, radius, VISIBLE), (loads, radius.size))
        for name in query.quantities
    }
    panels = _panels(radius, dense, _load_names(query), result, range(loads))
    marks = [Mark(b, "b") for b in breaks[:MAX_CURVES]] + _edge_marks(edges, "a")
    if query.has("history"):
        marks += [Mark(front, "c") for front in fronts.tolist() if fronts.size <= MAX_CURVES]
    else:
        marks += _edge_marks(fronts, "c")
    note = subset_note(loads, query.loads, "loads")
    return Plot(LABELS["radius"], panels, marks, _ends(radius), _REQUESTED, note)


def subsurface_map(query: SubsurfaceQuery, source: Contact, result: Result) -> Map:
    """Return the von Mises stress of the first load in the plane of the request."""
    contact, partial = at_end(source)
    a = float(np.ravel(contact.contact_radius)[0])
    end = _EXTENT * a or 1.0
    x, z = np.linspace(-end, end, 2 * _DOWN - 1), np.linspace(0.0, end, _DOWN)
    tensor = subsurface.stress(partial or contact, x, query.y, z[:, None], **body_of(query))
    first = tensor.von_mises.reshape(-1, z.size, x.size)[0]
    stick = None
    if isinstance(source, TangentialContact):
        stick = float(np.ravel(source.stick_radius)[0])
    down, across = np.unravel_index(np.argmax(first), first.shape)
    peak = float(x[across]), float(z[down])
    if "largest" in result and query.y == 0:
        found = result["largest"]["von_mises"]
        peak = float(found["x"][0]), float(found["z"][0])
    note = subset_note(1, query.loads, "loads")
    return Map(x, z, first, "von Mises stress", a, stick, peak, note)


def wear(query: WearQuery, limit: LimitingWear, result: Result) -> Plot:
    """Return the initial and the limiting profile over the radius, and other requested fields."""
    shown = limit if query.loads <= MAX_CURVES else solve_wear(_first_loads(query))
    loads = min(query.loads, MAX_CURVES)
    ends = np.ravel(shown.wear_radius)
    names = [
        (name or "limiting") + ("" if np.isfinite(end) else ": unbounded")
        for name, end in zip(_load_names(query), ends, strict=True)
    ]
    drawn = ["limiting_profile", *(name for name in ("worn_depth", "pressure") if name in result)]
    marks = _edge_marks(np.ravel(shown.stick_radius), "c") + _edge_marks(ends, "ã")
    marks.sort(key=lambda mark: mark.curve or 0)
    note = subset_note(loads, query.loads, "loads")
    return _worn(shown, drawn, names, range(loads), result, marks, note)


def evolution(_query: EvolutionQuery, worn: WearEvolution, result: Result) -> Plot:
    """Return profile and pressure over the radius at some of the numbers of cycles."""
    size = worn.cycles.size
    shown = np.unique(np.linspace(0, size - 1, min(size, MAX_CURVES)).round().astype(int))
    names = [f"N = {worn.cycles[index]:.4g}" for index in shown]
    drawn = ["profile", "pressure", *(["worn_depth"] if "worn_depth" in result else [])]
    marks = [Mark(float(worn.stick_radius[-1]), "c"), Mark(float(worn.contact_radius[-1]), "a")]
    note = subset_note(shown.size, size, "numbers of cycles")
    return _worn(worn, drawn, names, shown, result, marks, note)


def _worn(
    worn: Wear,
    drawn: Iterable[str],
    labels: Sequence[str],
    rows: Iterable[int],
    result: Result,
    marks: Sequence[Mark],
    note: str,
) -> Plot:
    """Return the `drawn` fields over all requested radii, the first with the initial profile."""
    grid = worn.grid(POINTS + 3 * len(labels) + len(worn.normal.profile.breaks))
    last = max(grid[-1], *result.get("radius", NOTHING), 0.0)
    radius = np.unique([*grid, *_evenly(0.0, float(last))])
    dense = {name: np.atleast_2d(getattr(worn, name)(radius)) for name in drawn}
    panels = _panels(radius, dense, labels, result, rows)
    initial = Curve(radius, worn.normal.profile.f(radius), "initial", style="--")
    panels[0].curves.append(initial)
    return Plot(LABELS["radius"], panels, marks, _ends(radius), _REQUESTED, note)


def _panels(
    radius: Array,
    dense: Mapping[Any, Array],
    labels: Sequence[str],
    result: Result,
    rows: Iterable[int],
) -> list[Panel]:
    """Return a panel for each of the dense fields, with a curve for each of the labelled rows.

    The requested values of the same field in `result` are points on it.
    """
    order = np.argsort(result.get("radius", NOTHING))
    panels = []
    for name, values in dense.items():
        curves = []
        for row, label in zip(rows, labels, strict=True):
            points = (result["radius"][order], result[name][row][order]) if name in result else ()
            curves.append(Curve(radius, values[row], label, *points))
        panels.append(Panel(LABELS[name], curves, _limits(curves) if name in _CUT else None))
    return panels


def _limits(curves: list[Curve]) -> tuple[float, float]:
    """Return y limits that show the usual values of fields with narrow or infinite peaks."""
    ends = []
    for sign in (1, -1):
        sizes = [np.where(np.isfinite(curve.y), sign * curve.y, 0.0).clip(0.0) for curve in curves]
        even = [np.interp(_evenly(*_ends(c.x)), c.x, y) for c, y in zip(curves, sizes, strict=True)]
        usual = float(max(np.quantile(y, _USUAL) for y in even))
        peak = float(max(y.max() for y in sizes))
        ends.append(_HEADROOM * usual if peak > _PEAK * usual > 0 else peak)
    margin = 0.05 * sum(ends) or 1.0
    return -ends[1] - margin * (ends[1] > 0), ends[0] + margin * (ends[0] > 0 or ends[1] == 0)


def _evenly(start: float, stop: float) -> Array:
    return np.linspace(start, stop, POINTS)


def _ends(radius: Array) -> tuple[float, float]:
    return float(radius[0]), float(radius[-1])


def _first_loads(query: _Query) -> _Query:
    """Return the query with its first loads only."""
    shorter = {
        name: choice.model_copy(update={choice.control: choice.value[:MAX_CURVES]})
        for name, choice in query.controls.items()
        if isinstance(choice.value, list)
    }
    return query.model_copy(update=shorter)


def _load_names(query: StressQuery | WearQuery) -> list[str]:
    """Return the labels of the loads: the controls that differ between them."""
    listed = {
        each.control: each.value
        for each in query.controls.values()
        if isinstance(each.value, list) and len(each.value) > 1
    }
    return [
        ", ".join(f"{symbol(name)} = {values[index]:.4g}" for name, values in listed.items())
        for index in range(min(query.loads, MAX_CURVES))
    ]


def _slip_fronts(source: Contact) -> Array:
    if isinstance(source, LoadHistory):
        return source.slip_fronts
    return np.ravel(source.stick_radius) if isinstance(source, TangentialContact) else NOTHING


def _edge_marks(radii: Array, symbol: str) -> list[Mark]:
    """Return a mark for each load, in the colour of its curve if there are several.

    Zones that do not exist or are unbounded have no mark.
    """
    several = radii.size > 1
    return [
        Mark(radius, symbol, index if several else None)
        for index, radius in enumerate(radii.tolist())
        if 0 < radius < inf
    ]
