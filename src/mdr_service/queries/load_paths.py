"""Queries about load histories."""

from typing import Any, Final

import numpy as np

from mdr_core import history as load_history
from mdr_core.errors import InputError
from mdr_core.history import LoadCycles, LoadHistory
from mdr_service.queries.contacts import (
    Result,
    body,
    checked,
    control,
    friction,
    members,
    notices,
    require_one_of,
    response_metadata,
)
from mdr_service.schemas.answers import HistoryAnswer
from mdr_service.schemas.fields import LoadedQuery
from mdr_service.schemas.load_paths import Cycles, HistoryQuery, LoadPath
from mdr_service.settings import SETTINGS

_CYCLES: Final = ("energy_per_cycle", "secant_stiffness")
_HISTORY: Final = members(HistoryAnswer, (*_CYCLES, "final_state"))


def solve_history(query: HistoryQuery) -> LoadHistory:
    """Return the load history of a query, given by its points or as cycles."""
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
            rtol=query.rtol,
        )
    except InputError as error:
        first, *rest = error.path
        if first != "history":
            raise
        if len(rest) == 3:
            # The core numbers points, not members.
            rest = [*given.place(str(rest[0]), int(rest[2]))]
        raise InputError((name, *rest), error.detail) from None


def history_result(query: HistoryQuery, history: LoadHistory) -> Result:
    """Return forces, displacements and energies at the samples of a load history."""
    names = (*_HISTORY, *_CYCLES) if isinstance(history, LoadCycles) else _HISTORY
    values = {name: np.asarray(getattr(history, name)) for name in names}
    state = {"final_state": history.final_state} if query.return_state else {}
    about = response_metadata(
        query, history, history.method, history.error_estimate, notices(query, history)
    )
    return checked(query, values) | state | about


def require_few_samples(query: HistoryQuery | LoadedQuery) -> None:
    """Raise InputError if the load path of a query has too many samples."""
    path = query.path
    if path and path.samples > SETTINGS.max_length:
        name = "cycles" if query.has("cycles") else "history"
        place = ("samples_per_step",) if (path.samples_per_step or 1) > 1 else ()
        detail = f"the number of samples must not exceed {SETTINGS.max_length}"
        raise InputError((name, *place), detail)
