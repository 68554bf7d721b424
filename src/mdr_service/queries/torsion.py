"""Queries about a twist of the contact about its axis."""

import numpy as np

from mdr_core import fields
from mdr_core import torsion as torsion_contact
from mdr_core.torsion import TorsionalContact
from mdr_core.validation import TIGHTEST
from mdr_service.queries.contacts import (
    Result,
    contact_values,
    control,
    friction,
    response,
    singular,
    solve_normal,
)
from mdr_service.queries.fields import may_be_infinite, over_radii, require_radii
from mdr_service.schemas.torsion import TorsionQuery


def solve_torsion(query: TorsionQuery) -> TorsionalContact:
    """Compute a contact with friction, loaded normally first and then twisted about its axis once.

    The solution is exact for every profile under a constant normal load. Every list of the response
    has one entry per pair of loads. The torque stays below µ F_N times `torsion_arm`, which no
    rotation reaches; a larger torque has no equilibrium and is rejected. A twist cannot be combined
    with a tangential load or adhesion, for which it is not exact.
    """
    require_radii(query)
    arguments = friction(query)
    arguments["shear_modulus"] = arguments.pop("g_star")
    return torsion_contact.solve(solve_normal(query), **arguments, **control(query.torsion))


def torsion_result(query: TorsionQuery, source: TorsionalContact) -> Result:
    """Return the quantities of a twisted contact, with its fields if the query has radii."""
    values, infinite = contact_values(query, source)
    radius = np.array(query.radius or (fields.grid(source, query.points) if query.points else ()))
    if not radius.size:
        return response(query, source, values, infinite=infinite)
    contact = source.normal
    field = {
        "pressure": lambda: fields.pressure(contact, radius),
        "shear_stress": lambda: fields.torsional_stress(source, radius),
    }
    surface = over_radii(query, radius, lambda name: field[name]())
    possible: Result = dict.fromkeys(query.quantities, may_be_infinite(contact, radius))
    at_edges = max(fields.edge_error(source, name, radius) for name in query.quantities)
    return response(
        query,
        source,
        values | {"radius": radius} | surface,
        infinite=infinite | possible,
        error=max(source.error_estimate, TIGHTEST) + at_edges,
        warnings=singular(radius, surface, possible),
    )
