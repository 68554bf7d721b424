"""Queries about fields over the radius."""

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from mdr_core import fields
from mdr_core import normal as normal_contact
from mdr_core.errors import InputError
from mdr_core.history import ContactState
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags
from mdr_core.validation import TIGHTEST
from mdr_service.queries.contacts import (
    Contact,
    Result,
    holds_while,
    require_one_of,
    response,
    singular,
    solve_normal,
    solve_tangential,
)
from mdr_service.queries.load_paths import require_few_samples, solve_path
from mdr_service.schemas.fields import SHEAR_FIELDS, FieldQuery, LoadedQuery, StressQuery
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.settings import SETTINGS

# These fields have a closed form if the equivalent profile has one.
_FOUNDATION: Final = frozenset({"foundation_load", "foundation_shear"})


def solve_stress(query: StressQuery) -> Contact:
    """Compute the fields named in `quantities` by load and radius.

    `error_estimate` bounds the error of each field relative to its largest value. A rounding error
    of a requested radius near a, c or a break is not included.
    """
    _require_consistent(query)
    return solve_loaded(query)


def require_loads(query: LoadedQuery) -> None:
    """Raise InputError unless the loads, or the load history, of a query suit its friction."""
    require_one_of(query, "load", "history")
    by_path = query.has("history")
    if by_path and query.has("tangential"):
        raise InputError(("tangential",), "must be absent: history contains the tangential load")
    if query.has("friction_coefficient") != (by_path or query.has("tangential")):
        names = ["friction_coefficient", "tangential"]
        given, missing = names if query.has("friction_coefficient") else names[::-1]
        raise InputError((missing,), f"is needed with {'history' if by_path else given}")
    require_few_samples(query)


def solve_loaded(query: LoadedQuery) -> Contact:
    """Return the contact under the loads of a query, or its load history."""
    if query.has("history"):
        return solve_path(query)
    return solve_tangential(query) if query.has("tangential") else solve_normal(query)


def stress_result(query: StressQuery, source: Contact) -> Result:
    """Return the requested fields by load and radius."""
    contact, partial = at_end(source)
    radius = np.array(query.radius or fields.grid(partial or contact, query.points))
    values = over_radii(
        query,
        radius,
        lambda name: getattr(fields, name)(partial if name in SHEAR_FIELDS else contact, radius),
    )
    at_singular = may_be_infinite(contact, radius)
    infinite: dict[str, Flags] = dict.fromkeys(("pressure", "shear_stress"), at_singular)
    method = _method(contact, query.quantities)
    # The errors of the edges and of the integrals add up.
    integrated = 0.0 if method == "closed_form" else TIGHTEST
    at_edges = max(
        fields.edge_error(contact if name == "pressure" else partial or contact, name, radius)
        for name in query.quantities
    )
    warnings = singular(radius, values, infinite)
    if (known := contact.pressure_data_error) is not None:
        values["pressure_data_error"] = np.full(query.loads, known)
        infinite["pressure_data_error"] = np.isinf(values["pressure_data_error"])
    return response(
        query,
        source,
        {"radius": radius} | values | holds_while(query, source),
        infinite=infinite,
        method=method,
        error=max(fields.own_error(source), integrated) + at_edges,
        warnings=warnings,
    )


def may_be_infinite(contact: NormalContact, radius: Array) -> Flags:
    """Return True for the radii (m,) at which a stress of a contact may be infinite."""
    radii = map(float, contact.profile.infinite_pressure_radii)
    return np.isin(radius, [0.0, *radii, *np.ravel(contact.contact_radius)])


def over_radii(query: FieldQuery, radius: Array, field: Callable[[str], Array]) -> Result:
    """Return each requested field [load][radius], which `field` computes by its name."""
    shape = query.loads, radius.size
    return {name: np.broadcast_to(field(name), shape).copy() for name in query.quantities}


def at_end(source: Contact) -> tuple[NormalContact, TangentialContact | ContactState | None]:
    """Return the normal contact of the fields, and the tangential contact or state, if any."""
    if isinstance(source, TangentialContact):
        return source.normal, source
    if isinstance(source, NormalContact):
        return source, None
    depth = max(float(source.indentation_depth[-1]), 0.0)
    start = source.path.start
    end = normal_contact.solve(start.profile, start.e_star, indentation_depth=depth)
    return end, source.state


def require_few_numbers(query: FieldQuery | SubsurfaceQuery, axis: str = "radius") -> None:
    """Raise InputError if the response would contain too many numbers along its axis."""
    most = SETTINGS.max_numbers
    if query.numbers > most:
        detail = f"the response would hold {query.numbers} numbers, and must not exceed {most}"
        raise InputError(("points" if query.points else axis,), detail)


def require_radii(query: FieldQuery) -> None:
    """Raise InputError if radii are given twice, or are missing although fields need them."""
    if query.radius and query.points:
        raise InputError(("points",), "at most one of radius, points is needed")
    if "quantities" in query.model_fields_set and not query.radii:
        raise InputError(("radius",), "quantities over the radius need radius or points")
    require_few_numbers(query)


def _require_consistent(query: StressQuery) -> None:
    """Raise InputError if fields that are valid separately contradict each other."""
    require_loads(query)
    with_friction = query.has("tangential") or query.has("history")
    for index, name in enumerate(query.quantities):
        if name in SHEAR_FIELDS and not with_friction:
            detail = f"{name} needs friction: give friction_coefficient and tangential, or history"
            raise InputError(("quantities", index), detail)
    require_one_of(query, "radius", "points")
    require_few_numbers(query)


def _method(contact: NormalContact, names: list[Any]) -> str:
    """Return the most expensive method of the fields."""
    on_layer = contact.material.layer is not None
    closed = _FOUNDATION.union(contact.profile.closed_forms)
    return contact.method if on_layer or closed.issuperset(names) else "quadrature"
