"""Requests to the core's dataclasses and results to documents; the one place that knows both."""

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from mdr_core import materials, profiles
from mdr_core.errors import DefectError, InputError, Notice
from mdr_core.normal import NormalContact
from mdr_service.schemas.answers import Catalogue, ProfileField, ProfileKind
from mdr_service.schemas.profiles import MODELS, Series, Tabulated
from mdr_service.schemas.profiles import Profile as ProfileModel
from mdr_service.schemas.quantities import SMALLEST_LOAD, Strict
from mdr_service.schemas.queries import Bodies, Load, Material, NormalQuery

Array = NDArray[np.float64]
# One number or one per load, as they are written: a list, or an array where it is long.
Numbers = list[float] | Array
_Arguments = Callable[[Any], dict[str, Any]]

_NORMAL_ANSWERS: Final = (
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "mean_pressure",
    "normal_stiffness",
    "elastic_energy",
)
# The only answers with a true infinity, which the core announces by a notice.
_MAY_BE_INFINITE: Final = frozenset({"mean_pressure"})


def normal_arguments(query: NormalQuery) -> dict[str, Any]:
    """Return the arguments of `mdr_core.normal.solve`.

    The warnings of the material are left out: they speak of the coupling with tangential load,
    and a contact without friction has none.
    """
    return {
        "profile": profile(query.profile),
        "e_star": material(query.material).e_star,
        "rtol": query.rtol,
        **controls(query.load),
    }


def normal_answer(query: NormalQuery, contact: NormalContact) -> dict[str, Any]:
    """Return the document of a normal contact."""
    warnings = contact.warnings
    answers: dict[str, Any] = {name: _numbers(getattr(contact, name)) for name in _NORMAL_ANSWERS}
    if not all(map(_all_finite, answers.values())):
        announced = any(notice.code == "singular" for notice in warnings)
        _check_non_finite(answers, query.load, _MAY_BE_INFINITE if announced else frozenset())
    answers["method"] = contact.method
    answers["error_estimate"] = contact.error_estimate
    answers["warnings"] = [_notice(notice) for notice in warnings]
    return answers


def profile(model: ProfileModel) -> profiles.Profile:
    """Return the core's profile; names and meanings are the same on both sides."""
    build = profiles.KINDS[model.kind]
    arguments: _Arguments = _SPECIAL_ARGUMENTS.get(type(model), _fields)
    return build(**arguments(model))


def material(model: Material) -> materials.Material:
    """Return the effective moduli."""
    if isinstance(model, Bodies):
        return materials.from_bodies(
            [
                materials.RIGID
                if body == materials.RIGID
                else materials.Body(body.youngs_modulus, body.poissons_ratio)
                for body in model.bodies
            ]
        )
    return materials.Material(model.e_star, model.g_star)


def controls(load: Load) -> dict[str, float | Array]:
    """Return the one control that was given, by its name."""
    (control,) = load.model_fields_set
    value = getattr(load, control)
    if not isinstance(value, list):
        return {control: _with_digits(value, load, 0)}
    loads = np.array(value, dtype=float)
    smallest = int(np.argmin(np.where(loads > 0, loads, np.inf)))
    _with_digits(loads[smallest], load, smallest)
    return {control: loads}


def catalogue() -> Catalogue:
    """Return every kind of profile with its formula, its fields and its closed forms."""
    return Catalogue(
        profiles=[
            ProfileKind(
                kind=kind,
                formula=known.formula,
                fields=_profile_fields(model),
                closed_forms=list(known.closed_forms),
            )
            for (kind, known), model in zip(profiles.KINDS.items(), MODELS, strict=True)
        ]
    )


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


def _with_digits(value: float, load: Load, index: int) -> float:
    if 0 < value < SMALLEST_LOAD:
        raise InputError(_path_to(load, index), f"must be 0 or at least {SMALLEST_LOAD}")
    return value


def _notice(notice: Notice) -> dict[str, str]:
    return {"code": notice.code, "message": notice.message}


def _numbers(values: Array) -> Numbers:
    """Return the values as the JSON writer takes them: one-dimensional and contiguous.

    A list is written faster than an array where there is only one number.
    """
    return [values.item()] if values.size == 1 else np.ascontiguousarray(values)


def _all_finite(numbers: Numbers) -> bool:
    if isinstance(numbers, list):
        return isfinite(numbers[0])
    return bool(np.isfinite(numbers).all())


def _check_non_finite(
    answers: Mapping[str, Numbers], load: Load, may_be_infinite: frozenset[str]
) -> None:
    """Let announced infinities pass, to be written as null, and raise for anything else.

    An overflow comes first: what is computed from it may well be no number.
    """
    for name in answers.keys() - may_be_infinite:
        overflow = np.flatnonzero(np.isinf(answers[name]))
        if overflow.size:
            detail = f"{name} leaves the range of double precision here"
            raise InputError(_path_to(load, int(overflow[0])), detail)
    for name, numbers in answers.items():
        if np.isnan(numbers).any():
            raise DefectError(f"{name} is not a number")


def _path_to(load: Load, index: int) -> tuple[str | int, ...]:
    """Return the path to one load of the request."""
    (control,) = load.model_fields_set
    if isinstance(getattr(load, control), list):
        return ("load", control, index)
    return ("load", control)


def _profile_fields(model: type[Strict]) -> list[ProfileField]:
    return [
        ProfileField(
            name=name,
            dimension=_dimension(field.json_schema_extra),
            description=str(field.description).rpartition(" [")[0],
            required=field.is_required(),
        )
        for name, field in model.model_fields.items()
        if name != "kind"
    ]


def _dimension(extra: object) -> str:
    if not isinstance(extra, Mapping):
        raise DefectError("a field without a dimension")
    return str(extra["dimension"])
