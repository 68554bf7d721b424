"""Queries solved: their arguments converted, then the core's public functions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from mdr_core import fields, validity
from mdr_core import normal as normal_contact
from mdr_core import tangential as tangential_contact
from mdr_core.errors import Notice
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_service import convert
from mdr_service.convert import Array
from mdr_service.schemas.queries import NormalQuery, StressQuery, TangentialQuery

# Of the normal contact, and of the one with friction.
_NORMAL_FIELDS: Final[Mapping[str, Callable[..., Array]]] = {
    "pressure": fields.pressure,
    "normal_displacement": fields.normal_displacement,
    "foundation_load": fields.foundation_load,
}
_SHEAR_FIELDS: Final[Mapping[str, Callable[..., Array]]] = {
    "shear_stress": fields.shear_stress,
    "slip": fields.slip,
    "foundation_shear": fields.foundation_shear,
}
# Points of a curve that looks smooth.
_STEPS: Final = 200
# Closed form wherever the equivalent profile is: they take no tolerance.
_FOUNDATION: Final = frozenset({"foundation_load", "foundation_shear"})


@dataclass(frozen=True)
class Stress:
    """The fields of a contact, by load and radius."""

    contact: NormalContact
    sheared: TangentialContact | None
    radius: Array
    fields: Mapping[str, Array]
    varied: Mapping[str, Array]
    """What was given for each load on its own, by name."""

    @property
    def method(self) -> str:
        """The dearest route that was taken."""
        closed = _FOUNDATION.union(self.contact.profile.closed_forms)
        return self.contact.method if closed.issuperset(self.fields) else "quadrature"

    @property
    def error_estimate(self) -> float:
        """Bound on the error of each field, relative to its largest value."""
        result = self.sheared or self.contact
        if self.method == "closed_form":
            return result.error_estimate
        return max(result.error_estimate, self.contact.rtol)

    @property
    def singular_radii(self) -> Array:
        """Where a stress may truly be infinite: the tip, a flat's edge, kinks."""
        edges = np.ravel(self.contact.contact_radius)
        return np.array([0.0, *map(float, self.contact.profile.breaks), *edges])


def normal(query: NormalQuery) -> NormalContact:
    """Return the normal contact that is asked for."""
    return normal_contact.solve(**convert.normal_arguments(query))


def tangential(query: TangentialQuery | StressQuery) -> TangentialContact:
    """Return the contact with friction that is asked for."""
    return tangential_contact.solve(normal(query), **convert.tangential_arguments(query))


def stress(query: StressQuery) -> Stress:
    """Return the fields that are asked for, and nothing else."""
    convert.require_consistent(query)
    sheared = tangential(query) if query.has_friction else None
    contact = sheared.normal if sheared else normal(query)
    if query.radius:
        radius = np.array(query.radius)
    else:
        radius = fields.grid(sheared or contact, query.points)
    shape = (query.loads, radius.size)
    found: dict[str, Array] = {}
    for name in query.quantities:
        tolerance = {} if name in _FOUNDATION else {"rtol": query.rtol}
        if name in _NORMAL_FIELDS:
            field = _NORMAL_FIELDS[name](contact, radius, **tolerance)
        else:
            field = _SHEAR_FIELDS[name](sheared, radius, **tolerance)
        found[name] = np.ascontiguousarray(np.broadcast_to(field, shape))
    given = [query.load, query.tangential] if sheared else [query.load]
    varied = {each.control: np.array(each.value) for each in given if each.count > 1}
    return Stress(contact, sheared, radius, found, varied)


def notices(query: NormalQuery, contact: NormalContact | TangentialContact) -> list[Notice]:
    """Return what is to be said of a contact, of its material, and of yield if that is asked.

    What the material says is about the coupling with a tangential load: without one there is
    nothing to say.
    """
    found = [*contact.warnings]
    pressed: NormalContact
    friction: dict[str, Any] = {}
    if isinstance(contact, TangentialContact):
        found += convert.material(query.material).warnings
        pressed = contact.normal
        friction = {
            "friction_coefficient": contact.friction_coefficient,
            "full_slip": contact.full_slip,
        }
    else:
        pressed = contact
    if "yield_strength" in query.material.model_fields_set:
        found += validity.yield_notices(
            pressed.profile,
            pressed.e_star,
            pressed.contact_radius,
            query.material.yield_strength,
            poissons_ratios=convert.poissons_ratios(query.material),
            **friction,
        )
    return found


def travel_to_full_slip(contact: TangentialContact) -> TangentialContact:
    """Return the way of the first normal load from rest to full slip."""
    first = replace(contact.normal, coordinate=np.ravel(contact.normal.coordinate)[:1])
    constants = (contact.g_star, contact.friction_coefficient)
    # The force where all slips, to the last digit: beyond it there is no equilibrium.
    (limit,) = tangential_contact.solve(first, *constants, tangential_force=0.0).limiting_force
    # The last part of the way takes little force.
    shares = 1 - np.linspace(1.0, 0.0, _STEPS) ** 3
    return tangential_contact.solve(first, *constants, tangential_force=limit * shares)
