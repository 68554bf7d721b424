"""Results to documents; what is not finite is found here, once."""

from collections.abc import Iterable, Mapping
from math import isfinite
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from mdr_core.errors import DefectError, InputError, Notice
from mdr_core.history import History
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.wear.limit import LimitingWear
from mdr_service import solve
from mdr_service.convert import Array
from mdr_service.schemas.queries import HistoryQuery, NormalQuery, StressQuery, TangentialQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery
from mdr_service.solve import Followed, Result, Stress
from mdr_service.worn import Wear, Worn

# One number or one per load, as they are written: a list, or an array where it is long.
Numbers = list[float] | Array
Indices = NDArray[np.intp]

_NORMAL_ANSWERS: Final = (
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "mean_pressure",
    "normal_stiffness",
    "elastic_energy",
)
_TANGENTIAL_ANSWERS: Final = (
    "tangential_force",
    "tangential_displacement",
    "stick_radius",
    "slip_width",
    "tangential_stiffness",
    "dissipated_energy",
)
_HISTORY_ANSWERS: Final = (
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "tangential_displacement",
    "tangential_force",
    "dissipated_energy",
    "elastic_energy",
    "tangential_energy",
)
_CYCLE_ANSWERS: Final = ("energy_per_cycle", "secant_stiffness")
_LIMIT_ANSWERS: Final = (
    "stick_radius",
    "wear_radius",
    "indentation_depth",
    "normal_force",
    "worn_volume",
)
_EVOLUTION_ANSWERS: Final = (
    "cycles",
    "worn_volume",
    "indentation_depth",
    "normal_force",
    "stick_radius",
    "contact_radius",
    "dissipated_energy",
)
# What is infinite where the wear has no end, which the core announces by a notice.
_ENDLESS: Final = frozenset(
    {"wear_radius", "indentation_depth", "worn_volume", "limiting_profile", "worn_depth"}
)
# The only answers with a true infinity, which the core announces by a notice.
_MAY_BE_INFINITE: Final = frozenset({"mean_pressure"})
_FIELDS_MAY_BE_INFINITE: Final = frozenset({"pressure", "shear_stress"})
# Radii that a warning names; the nulls show the others.
_NAMED: Final = 5


def normal(query: NormalQuery, contact: NormalContact) -> dict[str, Any]:
    """Return the document of a normal contact."""
    return _checked(query, contact) | _about(contact, solve.notices(query, contact))


def tangential(query: TangentialQuery, contact: TangentialContact) -> dict[str, Any]:
    """Return the document of a contact with friction."""
    regime = {"regime": np.broadcast_to(contact.regime, (query.loads,)).tolist()}
    return _checked(query, contact) | regime | _about(contact, solve.notices(query, contact))


def history(query: HistoryQuery, followed: Followed) -> dict[str, Any]:
    """Return the document of a history."""
    way, cycles = followed.history, followed.cycles
    step, regime = way.step.tolist(), way.regime.tolist()
    document = {"step": step} | _checked(query, way) | {"regime": regime}
    document["slip_fronts"] = _numbers(way.slip_fronts)
    if cycles:
        for name in _CYCLE_ANSWERS:
            document[name] = _numbers(getattr(cycles, name))
            if not _all_finite(document[name]):
                raise _overflow(name, ("cycles", *query.cycles.place("tangential", 0)))
    return document | _about(way, _without_singular(solve.notices(query, way)))


def stress(query: StressQuery, solved: Stress) -> dict[str, Any]:
    """Return the document of the fields that were asked for."""
    document = {"radius": solved.radius, **solved.fields}
    warnings = _without_singular(solve.notices(query, solved.result))
    singular = {
        name: np.flatnonzero(np.isinf(field).any(axis=0))
        for name, field in solved.fields.items()
        if not np.isfinite(field).all()
    }
    if singular:
        # The fields of a contact that overflows may well be no numbers.
        _checked(query, solved.result)
        _check_fields(query, solved, singular)
        warnings += [_singular(name, solved.radius[at]) for name, at in singular.items()]
    return document | _about(solved, warnings)


def wear(query: WearQuery | EvolutionQuery, solved: Worn[Any]) -> dict[str, Any]:
    """Return the document of the wear in the end, or over the cycles."""
    result: Wear = solved.result
    limits = isinstance(result, LimitingWear)
    answers = {
        name: np.broadcast_to(getattr(result, name), (query.loads,))
        for name in (_LIMIT_ANSWERS if limits else _EVOLUTION_ANSWERS)
    }
    _check_worn(query, answers, solved)
    warnings = _without_singular(solve.notices(query, result))
    for name, field in solved.fields.items():
        at = solved.may_be_infinite(name) & np.isinf(np.atleast_2d(field)).any(axis=0)
        warnings += [_singular(name, solved.radius[at])] * bool(at.any())
    document: dict[str, Any] = {name: _numbers(values) for name, values in answers.items()}
    if isinstance(result, LimitingWear):
        document["regime"] = np.broadcast_to(result.regime, (query.loads,)).tolist()
    if solved.radius.size:
        document |= {"radius": solved.radius} | dict(solved.fields)
    return document | _about(result, warnings)


def _check_worn(
    query: WearQuery | EvolutionQuery, answers: Mapping[str, Array], solved: Worn[Any]
) -> None:
    """Let true infinities pass, to be written as null, and raise for anything else."""
    result: Wear = solved.result
    endless = np.zeros(query.loads, dtype=bool)
    if isinstance(result, LimitingWear):
        endless |= np.ravel(result.stuck.endless)
    for name, values in (*answers.items(), *solved.fields.items()):
        over = np.isinf(values)
        if name in solved.fields:
            over = over & ~solved.may_be_infinite(name)
        if name == "initial_profile":
            if over.any():
                raise _overflow(name, ("radius", int(np.flatnonzero(over)[0])))
            continue
        rows = over.reshape(query.loads, -1).any(axis=1)
        stray = np.flatnonzero(rows & ~endless if name in _ENDLESS else rows)
        if stray.size:
            raise _overflow(name, query.place(int(stray[0])))
    for name, values in (*answers.items(), *solved.fields.items()):
        _require_numbers(name, values)


def _without_singular(notices: Iterable[Notice]) -> list[Notice]:
    """Leave out what is singular in the answers of a normal query, where those are not asked."""
    return [notice for notice in notices if notice.code != "singular"]


def _about(result: Result | Stress | Wear, warnings: Iterable[Notice]) -> dict[str, Any]:
    return {
        "method": result.method,
        "error_estimate": result.error_estimate,
        "warnings": [{"code": notice.code, "message": notice.message} for notice in warnings],
    }


def _numbers(values: Array) -> Numbers:
    """Return the values as the JSON writer takes them: one-dimensional and contiguous.

    A list is written faster than an array where there is only one number.
    """
    return [values.item()] if values.size == 1 else np.ascontiguousarray(values)


def _answers(result: Result) -> dict[str, Numbers]:
    """Return the numbers that an answer holds, in its order."""
    if isinstance(result, NormalContact):
        return {name: _numbers(getattr(result, name)) for name in _NORMAL_ANSWERS}
    if isinstance(result, History):
        return {name: _numbers(getattr(result, name)) for name in _HISTORY_ANSWERS}
    found = {name: getattr(result.normal, name) for name in _NORMAL_ANSWERS} | {
        name: getattr(result, name) for name in _TANGENTIAL_ANSWERS
    }
    shape = (max(value.size for value in found.values()),)
    return {name: _numbers(np.broadcast_to(value, shape)) for name, value in found.items()}


def _checked(query: NormalQuery | HistoryQuery, result: Result) -> dict[str, Any]:
    """Return the answers if they are finite, or infinite where that is announced.

    An overflow is looked for first: what is computed from it may well be no number.
    """
    answers = _answers(result)
    if all(map(_all_finite, answers.values())):
        return answers
    announced = any(notice.code == "singular" for notice in result.warnings)
    for name in answers.keys() - (_MAY_BE_INFINITE if announced else frozenset()):
        overflow = np.flatnonzero(np.isinf(answers[name]))
        if overflow.size:
            raise _overflow(name, query.place(int(overflow[0])))
    for name, numbers in answers.items():
        _require_numbers(name, np.asarray(numbers))
    return answers


def _all_finite(numbers: Numbers) -> bool:
    if isinstance(numbers, list):
        return isfinite(numbers[0])
    return bool(np.isfinite(numbers).all())


def _check_fields(query: StressQuery, solved: Stress, infinite: Mapping[str, Indices]) -> None:
    """Let true infinities pass, to be written as null, and raise for anything else."""
    for name, at in infinite.items():
        field = solved.fields[name]
        stray = ~np.isin(solved.radius[at], solved.singular_radii)
        if at.size and (name not in _FIELDS_MAY_BE_INFINITE or stray.any()):
            load = np.flatnonzero(np.isinf(field).any(axis=1))[0]
            raise _overflow(name, query.place(int(load)))
        _require_numbers(name, field)


def _overflow(name: str, place: tuple[str | int, ...]) -> InputError:
    return InputError(place, f"{name} leaves the range of double precision here")


def _require_numbers(name: str, values: Array) -> None:
    if np.isnan(values).any():
        raise DefectError(f"{name} is not a number")


def _singular(name: str, radii: Array) -> Notice:
    named = ", ".join(map(repr, radii[:_NAMED].tolist()))
    more = f" and {radii.size - _NAMED} more" if radii.size > _NAMED else ""
    return Notice("singular", f"{name} is infinite at radius {named}{more}")
