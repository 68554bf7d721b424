"""Requests to the arguments of the core; the one place that knows the models of both."""

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from mdr_core import materials, profiles
from mdr_core.errors import InputError
from mdr_service.schemas.loads import Choice, Cycles, History
from mdr_service.schemas.profiles import Profile as ProfileModel
from mdr_service.schemas.profiles import Series, Tabulated
from mdr_service.schemas.quantities import SMALLEST_LOAD, Strict
from mdr_service.schemas.queries import (
    SHEAR_FIELDS,
    Bodies,
    Body,
    BodyOrRigid,
    HistoryQuery,
    Material,
    NormalQuery,
    Query,
    StressQuery,
    TangentialQuery,
)
from mdr_service.schemas.wear import EvolutionQuery, WearQuery
from mdr_service.settings import SETTINGS

Array = NDArray[np.float64]
_Arguments = Callable[[Any], dict[str, Any]]
_Place = tuple[str | int, ...]
_Constants = tuple[float, float] | None
"""Of a body, none where it is rigid."""


def normal_arguments(query: NormalQuery | WearQuery) -> dict[str, Any]:
    """Return the arguments of `mdr_core.normal.solve`."""
    return _pressed(query) | {"rtol": query.rtol} | _controls(("load",), query.load)


def tangential_arguments(query: TangentialQuery | StressQuery) -> dict[str, Any]:
    """Return the arguments of `mdr_core.tangential.solve`, besides the normal contact."""
    return _rubbed(query) | _as_many("tangential", query.tangential, query.load)


def wear_arguments(query: WearQuery) -> dict[str, Any]:
    """Return the arguments of `mdr_core.wear.limit.solve`, besides the normal contact."""
    _require_places(query)
    return _rubbed(query) | _as_many("oscillation", query.oscillation, query.load)


def evolution_arguments(query: EvolutionQuery) -> dict[str, Any]:
    """Return the arguments of `mdr_core.wear.evolution.solve`, besides the normal contact."""
    _require_places(query)
    return _rubbed(query) | {
        "wear_coefficient": query.wear_coefficient,
        "cycles": np.array(query.cycles, dtype=float),
        "resolution": query.resolution,
        "rtol": query.rtol,
        query.oscillation.control: query.oscillation.value,
    }


def held_arguments(query: EvolutionQuery) -> dict[str, Any]:
    """Return the arguments of `mdr_core.normal.solve`; its tolerance is another one."""
    return _pressed(query) | _controls(("load",), query.load)


def history_arguments(query: HistoryQuery | StressQuery) -> dict[str, Any]:
    """Return the arguments of `mdr_core.history.solve`."""
    given = query.history
    _require_few("history", given)
    return _remembered(query) | {
        "samples_per_step": given.samples_per_step,
        **_controls(("history", "normal"), given.normal),
        given.tangential.control: np.array(given.tangential.value, dtype=float),
    }


def cycles_arguments(query: HistoryQuery) -> dict[str, Any]:
    """Return the arguments of `mdr_core.history.cycles`."""
    given = query.cycles
    _require_few("cycles", given)
    _require_digits(("cycles", "normal", "amplitude"), given.normal.amplitude)
    return _remembered(query) | {
        "samples_per_step": given.samples_per_step,
        "count": given.count,
        "normal_amplitude": given.normal.amplitude,
        **_controls(("cycles", "normal"), given.normal),
        given.tangential.control: given.tangential.value,
    }


def require_one_way(query: HistoryQuery) -> None:
    """Raise InputError unless there is either a history or cycles."""
    ways = {"history", "cycles"} & query.model_fields_set
    if len(ways) != 1:
        raise InputError(
            (min(ways, default="history"),), "exactly one of history, cycles is needed"
        )


def require_consistent(query: StressQuery) -> None:
    """Raise InputError where fields that are fine alone do not fit together."""
    given = query.model_fields_set
    if ("load" in given) == ("history" in given):
        raise InputError(
            ("history" if "history" in given else "load",), "exactly one of load, history is needed"
        )
    if query.has_history and "tangential" in given:
        raise InputError(("tangential",), "is part of history where there is one")
    if ("friction_coefficient" in given) != query.has_friction:
        missing = "tangential" if "friction_coefficient" in given else "friction_coefficient"
        raise InputError((missing,), "friction_coefficient goes with tangential or history")
    for index, name in enumerate(query.quantities):
        if name in SHEAR_FIELDS and not query.has_friction:
            raise InputError(("quantities", index), f"{name} needs tangential or history")
    if ("radius" in given) == ("points" in given):
        place = "points" if "points" in given else "radius"
        raise InputError((place,), "exactly one of radius, points is needed")
    _require_few_numbers(query)


def profile(model: ProfileModel) -> profiles.Profile:
    """Return the core's profile; names and meanings are the same on both sides."""
    build = profiles.KINDS[model.kind]
    arguments: _Arguments = _SPECIAL_ARGUMENTS.get(type(model), _fields)
    return build(**arguments(model))


def material(model: Material) -> materials.Material:
    """Return the effective moduli."""
    if isinstance(model, Bodies):
        first, second = map(_constants, model.bodies)
        return _of_bodies(first, second)
    return materials.Material(model.e_star, model.g_star)


def _constants(body: BodyOrRigid) -> _Constants:
    return (body.youngs_modulus, body.poissons_ratio) if isinstance(body, Body) else None


@lru_cache(maxsize=256)
def _of_bodies(*constants: _Constants) -> materials.Material:
    # Whoever asks a lot asks about the same bodies, and often twice in one request.
    return materials.from_bodies(
        [materials.Body(*each) if each else materials.RIGID for each in constants]
    )


def poissons_ratios(model: Material) -> list[float]:
    """Return those of the bodies that are not rigid, none where the bodies are unknown."""
    if not isinstance(model, Bodies):
        return []
    return [body.poissons_ratio for body in model.bodies if isinstance(body, Body)]


def _fields(model: Strict) -> dict[str, Any]:
    return {name: value for name, value in vars(model).items() if name != "kind"}


def _series_arguments(model: Series) -> dict[str, Any]:
    return {"terms": tuple(profiles.PowerTerm(**_fields(term)) for term in model.terms)}


def _tabulated_arguments(model: Tabulated) -> dict[str, Any]:
    return {
        "r": np.array(model.r),
        "f": np.array(model.f),
        "interpolation": model.interpolation,
        "breaks": tuple(model.breaks),
    }


_SPECIAL_ARGUMENTS: Final[Mapping[type[Strict], _Arguments]] = {
    Series: _series_arguments,
    Tabulated: _tabulated_arguments,
}


def _shear_modulus(query: Query) -> float:
    g_star = material(query.material).g_star
    if g_star is None:
        raise InputError(("material", "g_star"), "is needed where there is friction")
    return g_star


def _pressed(query: Query) -> dict[str, Any]:
    return {"profile": profile(query.profile), "e_star": material(query.material).e_star}


def _rubbed(
    query: TangentialQuery | HistoryQuery | StressQuery | WearQuery | EvolutionQuery,
) -> dict[str, Any]:
    return {
        "g_star": _shear_modulus(query),
        "friction_coefficient": query.friction_coefficient,
    }


def _as_many(name: str, given: Choice, load: Choice) -> dict[str, Any]:
    """Return the tangential control, of which there is to be one, or one for each load."""
    if given.count > 1 and load.count not in {1, given.count}:
        detail = f"{given.count} values for {load.count} loads: one or as many are needed"
        raise InputError((name, given.control), detail)
    return {given.control: np.array(given.value, dtype=float)}


def _remembered(query: HistoryQuery | StressQuery) -> dict[str, Any]:
    """Return what any way of the loads takes."""
    return _pressed(query) | _rubbed(query) | {"rtol": query.rtol}


def _require_places(query: WearQuery | EvolutionQuery) -> None:
    """Raise InputError unless there are radii, in one of two ways, where fields are asked for."""
    given = query.model_fields_set
    if {"radius", "points"} <= given:
        raise InputError(("points",), "at most one of radius, points is needed")
    if "quantities" in given and not query.radii:
        raise InputError(("radius",), "quantities over the radius need radius or points")
    _require_few_numbers(query)


def _require_few_numbers(query: StressQuery | WearQuery | EvolutionQuery) -> None:
    if query.loads * query.radii > SETTINGS.max_numbers:
        place = "points" if "points" in query.model_fields_set else "radius"
        what = "cycles" if isinstance(query, EvolutionQuery) else "loads"
        detail = f"at most {SETTINGS.max_numbers} {what} times radii are answered at once"
        raise InputError((place,), detail)


def _require_few(name: str, way: History | Cycles) -> None:
    if way.samples > SETTINGS.max_samples:
        place = ("samples_per_step",) if way.samples_per_step > 1 else ()
        detail = f"at most {SETTINGS.max_samples} samples are answered at once"
        raise InputError((name, *place), detail)


def _controls(path: _Place, given: Choice) -> dict[str, float | Array]:
    """Return the one control of a normal load that was given, by its name."""
    value = given.value
    if not isinstance(value, list):
        _require_digits((*path, given.control), value)
        return {given.control: value}
    loads = np.array(value, dtype=float)
    sizes = np.abs(loads)
    smallest = int(np.argmin(np.where(sizes > 0, sizes, np.inf)))
    _require_digits((*path, given.control, smallest), loads[smallest])
    return {given.control: loads}


def _require_digits(path: _Place, value: float) -> None:
    if 0 < abs(value) < SMALLEST_LOAD:
        raise InputError(path, f"must be 0 or at least {SMALLEST_LOAD}")
