"""Queries about load histories."""

from typing import Any

import numpy as np

from mdr_core import history as load_history
from mdr_core.errors import InputError
from mdr_core.history import LoadHistory
from mdr_service.queries.contacts import Result, body, control, friction, require_one_of, response
from mdr_service.schemas.fields import LoadedQuery
from mdr_service.schemas.load_paths import Cycles, HistoryQuery, LoadPath
from mdr_service.settings import SETTINGS


def solve_history(query: HistoryQuery) -> LoadHistory:
    """Follow a load path from first contact, and return samples along it.

    Between two samples both loads vary linearly: the displacement with the depth, or the tangential
    force with the normal force. Every such path is solved exactly. Where a depth changes with a
    tangential force, or a normal force with a displacement, more `samples_per_step` follow the
    curve on which these vary linearly. A negative depth means separation, which erases the slip
    memory. A tangential force beyond µ F_N, at a point or between points, has no equilibrium and is
    rejected.

    `error_estimate` is relative to the largest value on the path. It does not include
    `slip_fronts`. `energy_per_cycle` and `secant_stiffness` belong to
    `cycles`.
    """
    require_one_of(query, "history", "cycles")
    require_few_samples(query)
    if not query.has("initial_state"):
        return solve_path(query)
    if query.has("cycles"):
        raise InputError(("initial_state",), "is valid with history only, not with cycles")
    return solve_path(query, initial_state=query.initial_state.model_dump())


def solve_path(query: HistoryQuery | LoadedQuery, **more: Any) -> LoadHistory:
    """Return the load history of a query with any number of samples."""
    name = "history" if query.has("history") else "cycles"
    given: LoadPath = getattr(query, name)
    solve: Any = load_history.solve
    if isinstance(given, Cycles):
        solve = load_history.cycles
        more = {"normal_amplitude": given.normal.amplitude, "count": given.count}
    try:
        return solve(
            **body(query),
            **friction(query),
            **control(given.normal),
            **control(given.tangential),
            **more,
            samples_per_step=given.per_step,
        )
    except InputError as error:
        first, *rest = error.path
        if first != "history":
            raise
        if len(rest) == 3:
            # The core numbers the points of the path; a shorter list holds one value for all.
            points = getattr(given, str(rest[0])).value
            rest[2:] = [min(int(rest[2]), len(points) - 1)] if isinstance(points, list) else []
        raise InputError((name, *rest), error.detail) from None


def history_result(query: HistoryQuery, history: LoadHistory) -> Result:
    """Return forces, displacements and energies at the samples of a load history."""
    values: Result = {name: np.asarray(value) for name, value in history.computed().items()}
    if query.return_state:
        values["final_state"] = history.final_state
    return response(query, history, values)


def require_few_samples(query: HistoryQuery | LoadedQuery) -> None:
    """Raise InputError if the load path of a query has too many samples."""
    path = query.path
    if path and path.samples > SETTINGS.max_length:
        name = "cycles" if query.has("cycles") else "history"
        place = ("samples_per_step",) if (path.samples_per_step or 1) > 1 else ()
        detail = f"the number of samples must not exceed {SETTINGS.max_length}"
        raise InputError((name, *place), detail)
