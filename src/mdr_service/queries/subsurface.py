"""Queries about stresses beneath the surface."""

from typing import Any, Final

import numpy as np

from mdr_core import subsurface
from mdr_core.adhesion import AdhesiveContact
from mdr_core.errors import InputError, Notice
from mdr_core.history import LoadHistory
from mdr_core.typing import Array, Flags
from mdr_service.queries.contacts import Contact, Result, response
from mdr_service.queries.fields import at_end, require_few_numbers, require_loads, solve_loaded
from mdr_service.schemas.contacts import Bodies
from mdr_service.schemas.subsurface import SubsurfaceQuery

# A grid that the service chooses extends to this multiple of the largest contact radius.
_BEYOND: Final = 1.5
# Number of components whose errors add up in an invariant.
_OF_INVARIANTS: Final = 4.0
# Relative accuracy of the largest stresses, and of the normal force at the onset of yield.
_OF_SEARCH: Final = 1e-4
_CRITERIA: Final = {"tresca": "maximum_shear", "von_mises": "von_mises"}


def solve_subsurface(query: SubsurfaceQuery) -> Contact:
    """Compute the stresses named in `quantities` by load, depth z and x, in the plane of one y.

    `error_estimate` is relative to the largest stress of the response. With a `yield_strength` of
    the material, and without `history`, the response holds the normal force at the onset of yield,
    at the same ratio of tangential to normal force. The tangential force acts on body 1 along x,
    its reaction on body 2.
    """
    require_loads(query)
    for name in ("x", "z"):
        if query.has(name) == query.has("points"):
            reason = "cannot be combined with points" if query.has(name) else "is required"
            raise InputError((name,), f"{reason}: give x and z, or points")
    require_few_numbers(query, "x")
    body_of(query)
    if query.largest and query.material.has("work_of_adhesion"):
        raise InputError(("largest",), AdhesiveContact.unusable)
    return solve_loaded(query)


def subsurface_result(query: SubsurfaceQuery, source: Contact) -> Result:
    """Return the requested stresses by load, depth and x, and the other requested members."""
    contact, partial = at_end(source)
    loaded, body = partial or contact, body_of(query)
    if query.has("x"):
        x, z = np.array(query.x), np.array(query.z)
    else:
        # In separation the points lie on the axis: any other extent would depend on the units.
        end = _BEYOND * float(np.max(contact.contact_radius))
        x, z = np.linspace(-end, end, query.points) + 0.0, np.linspace(0.0, end, query.points)
    place = x, query.y, z[:, None]
    tensor = subsurface.stress(loaded, *place, **body)
    shape = query.loads, z.size, x.size
    values: Result = {name: _by_name(tensor, name).reshape(shape) for name in query.quantities}
    infinite: Flags = np.isinf(tensor.zz).reshape(shape)
    places = dict.fromkeys(values, infinite)
    own = source.error_estimate if isinstance(source, LoadHistory) else 0.0
    error = _OF_INVARIANTS * (own + subsurface.error_estimate(loaded, *place))
    if query.largest:
        peaks = {name: subsurface.largest(loaded, name, **body) for name in subsurface.MEASURES}
        values["largest"] = {
            name: dict(zip(peak._fields, map(np.ravel, peak), strict=True))
            for name, peak in peaks.items()
        }
        infinite = np.append(infinite, [np.isinf(peak.value) for peak in peaks.values()])
    if query.material.has("yield_strength") and not isinstance(source, LoadHistory):
        strength = query.material.yield_strength
        values["yield_onset_force"] = {
            criterion: np.ravel(subsurface.yield_onset_force(source, strength, measure, **body))
            for criterion, measure in _CRITERIA.items()
        }
    if {"largest", "yield_onset_force"} & values.keys():
        values["search_error_estimate"] = _OF_SEARCH
    message = "stresses are infinite on the surface, where the pressure is"
    method = "closed_form" if contact.profile.is_flat_punch else "quadrature"
    return response(
        query,
        source,
        {"x": x, "z": z} | values,
        infinite=places,
        method=method,
        error=error,
        warnings=[Notice("singular", message)] if infinite.any() else [],
    )


def body_of(query: SubsurfaceQuery) -> dict[str, Any]:
    """Return the requested body and its Poisson's ratio, as arguments of the core.

    Raises InputError if the body is rigid or its Poisson's ratio is not given.
    """
    material = query.material
    known = material.bodies[query.body - 1] if isinstance(material, Bodies) else material
    if isinstance(known, str):
        raise InputError(("body",), "is rigid: request the stresses of the other body")
    if not known.has("poissons_ratio"):
        detail = "is needed for stresses in a body: give it, or bodies"
        raise InputError(("material", "poissons_ratio"), detail)
    return {"poissons_ratio": known.poissons_ratio, "body": query.body}


def _by_name(tensor: subsurface.StressTensor, name: str) -> Array:
    """Return a stress by the name of its quantity [pressure]."""
    if name.startswith("principal_"):
        return np.asarray(tensor.principal[..., 3 - int(name[-1])])
    return np.asarray(getattr(tensor, name.removeprefix("stress_")))
