"""Queries about load histories."""

from typing import Any, Final

import numpy as np

from mdr_core import history as load_history
from mdr_core.errors import InputError
from mdr_core.history import LoadCycles, LoadHistory
from mdr_service.queries.contacts import body, control, friction
from mdr_service.results import (
    Result,
    checked,
    members,
    notices,
    response_metadata,
)
from mdr_service.schemas.answers import HistoryAnswer
from mdr_service.schemas.fields import LoadedQuery
from mdr_service.schemas.load_paths import Cycles, HistoryQuery, LoadPath
from mdr_service.settings import SETTINGS

_CYCLES: Final = ("energy_per_cycle", "secant_stiffness")
_HISTORY: Final = members(HistoryAnswer, _CYCLES)


def solve_history(query: HistoryQuery) -> LoadHistory:
    """Return the load history of a query, given by its points or as cycles."""
    if query.has("history") == query.has("cycles"):
        place = "cycles" if query.has("cycles") else "history"
        raise InputError((place,), "exactly one of history, cycles is needed")
    name = "cycles" if query.has("cycles") else "history"
    require_few_samples(name, query.path)
    return solve_path(query)


def solve_path(query: HistoryQuery | LoadedQuery) -> LoadHistory:
    """Return the load history of a query with any number of samples."""
    name = "history" if query.has("history") else "cycles"
    given: LoadPath = getattr(query, name)
    solve: Any = load_history.solve
    more: dict[str, float] = {}
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
            samples_per_step=given.samples_per_step,
            rtol=query.rtol,
        )
    except InputError as error:
        raise _in_request(error, name, given) from None


def history_result(query: HistoryQuery, history: LoadHistory) -> Result:
    """Return forces, displacements and energies at the samples of a load history."""
    names = (*_HISTORY, *_CYCLES) if isinstance(history, LoadCycles) else _HISTORY
    values = {name: np.asarray(getattr(history, name)) for name in names}
    warnings = notices(query, history)
    return checked(query, values) | response_metadata(
        history.method, history.error_estimate, warnings
    )


def require_few_samples(name: str, path: LoadPath) -> None:
    """Raise InputError if a load path has too many samples."""
    if path.samples > SETTINGS.max_samples:
        place = ("samples_per_step",) if path.samples_per_step > 1 else ()
        detail = f"the number of samples must not exceed {SETTINGS.max_samples}"
        raise InputError((name, *place), detail)


def _in_request(error: InputError, name: str, path: LoadPath) -> InputError:
    """Return the error with the path of the request; the core numbers points, not members."""
    first, *rest = error.path
    if first != "history":
        return error
    if len(rest) == 3:
        rest = [*path.place(str(rest[0]), int(rest[2]))]
    return InputError((name, *rest), error.detail)
