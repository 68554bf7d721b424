"""Queries about stresses beneath the surface."""

from typing import Any, Final

import numpy as np

from mdr_core import subsurface
from mdr_core.errors import InputError, Notice
from mdr_core.normal import NormalContact, not_reached
from mdr_core.subsurface import StressTensor
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags
from mdr_service.queries.contacts import solve_normal, solve_tangential
from mdr_service.results import Result, checked, notices, without_singular, written
from mdr_service.schemas.contacts import Bodies, BodyMaterial
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.settings import SETTINGS

Source = NormalContact | TangentialContact
# A grid that the service chooses extends to this multiple of the largest contact radius.
_BEYOND: Final = 1.5
# Errors of the components that add up in an invariant.
_OF_INVARIANTS: Final = 4.0
# Relative accuracy of the largest stresses, and of the normal force at the onset of yield.
_OF_SEARCH: Final = 1e-4
_CRITERIA: Final = {"tresca": "maximum_shear", "von_mises": "von_mises"}


def solve_subsurface(query: SubsurfaceQuery) -> Source:
    """Return the contact whose stresses a query requests."""
    _require_consistent(query)
    return solve_tangential(query) if query.has("tangential") else solve_normal(query)


def subsurface_result(query: SubsurfaceQuery, source: Source) -> Result:
    """Return the requested stresses by load, depth and x, and what else is requested."""
    contact = source.normal if isinstance(source, TangentialContact) else source
    x, z = _positions(query, contact)
    place = x, query.y, z[:, None]
    body: dict[str, Any] = {"poissons_ratio": poissons_ratio(query), "body": query.body}
    tensor = subsurface.stress(source, *place, **body, rtol=query.rtol)
    shape = query.loads, z.size, x.size
    values: Result = {
        name: np.ascontiguousarray(np.broadcast_to(stress_by_name(tensor, name), shape))
        for name in query.quantities
    }
    flags = np.broadcast_to(np.isinf(tensor.zz), shape)
    infinite: dict[str, Flags] = dict.fromkeys(values, flags)
    error = _OF_INVARIANTS * subsurface.error_estimate(source, *place, rtol=query.rtol)
    warnings = [
        notice
        for notice in without_singular(notices(query, source))
        # Assessed by the stresses of the whole body instead.
        if notice.code not in {"yield", "yield_unknown"}
    ]
    if np.isinf(tensor.zz).any():
        message = "stresses are infinite on the surface, where the pressure is"
        warnings.append(Notice("singular", message))
    if error > max(query.rtol, source.error_estimate):
        warnings.append(not_reached(query.rtol))
    more: Result = {}
    if query.largest:
        more["largest"] = {
            measure: _by_load(subsurface.largest(source, measure, **body)._asdict(), query.loads)
            for measure in subsurface.MEASURES
        }
    if query.material.has("yield_strength"):
        strength = query.material.yield_strength
        onset = {
            criterion: subsurface.yield_onset_force(source, strength, measure, **body)
            for criterion, measure in _CRITERIA.items()
        }
        more["yield_onset_force"] = _by_load(onset, query.loads)
        least = np.broadcast_to(np.minimum(*onset.values()), (query.loads,))
        yields = contact.loaded & (contact.normal_force >= least)
        if yields.any():
            first = float(least[yields][0])
            message = f"the normal force exceeds that at the onset of yield, {first:.4g}"
            warnings.append(Notice("yield", message))
    if more:
        more["search_error_estimate"] = _OF_SEARCH
    return (
        {"x": x, "z": z}
        | checked(query, values, infinite)
        | more
        | {
            "method": "closed_form" if contact.profile.slips_at_once else "quadrature",
            "error_estimate": error,
            "warnings": written(warnings),
        }
    )


def poissons_ratio(query: SubsurfaceQuery) -> float:
    """Return Poisson's ratio of the requested body.

    Raises
    ------
    InputError : the body is rigid, or its Poisson's ratio is not given.
    """
    material = query.material
    if isinstance(material, Bodies):
        body = material.bodies[query.body - 1]
        if not isinstance(body, BodyMaterial):
            raise InputError(("body",), "is rigid: request the stresses of the other body")
        return body.poissons_ratio
    if not material.has("poissons_ratio"):
        raise InputError(("material", "poissons_ratio"), "is needed for stresses in a body")
    return material.poissons_ratio


def stress_by_name(tensor: StressTensor, name: str) -> Array:
    """Return a stress by the name of its quantity [pressure]."""
    if name.startswith("stress_"):
        return np.asarray(getattr(tensor, name.removeprefix("stress_")))
    if name.startswith("principal_"):
        return np.asarray(tensor.principal[..., 3 - int(name[-1])])
    return np.asarray(getattr(tensor, name))


def _by_load(values: dict[str, Array], loads: int) -> dict[str, Array]:
    return {
        name: np.ascontiguousarray(np.broadcast_to(value, (loads,)))
        for name, value in values.items()
    }


def _positions(query: SubsurfaceQuery, contact: NormalContact) -> tuple[Array, Array]:
    if query.has("x"):
        return np.array(query.x), np.array(query.z)
    end = _BEYOND * float(np.max(contact.contact_radius)) or 1.0
    return np.linspace(-end, end, query.points), np.linspace(0.0, end, query.points)


def _require_consistent(query: SubsurfaceQuery) -> None:
    """Raise InputError where fields that are valid alone contradict each other."""
    if query.has("tangential") != query.has("friction_coefficient"):
        missing = "tangential" if query.has("friction_coefficient") else "friction_coefficient"
        raise InputError((missing,), "friction_coefficient goes with tangential")
    for name in ("x", "z"):
        if query.has(name) == query.has("points"):
            raise InputError((name,), "either x and z or points are needed")
    if query.numbers > SETTINGS.max_numbers:
        place = "points" if query.points else "x"
        detail = f"loads times points times quantities must not exceed {SETTINGS.max_numbers}"
        raise InputError((place,), detail)
    poissons_ratio(query)
