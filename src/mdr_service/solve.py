"""Queries solved: their arguments converted, then the core's public functions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from mdr_core import fields, validity
from mdr_core import history as loading
from mdr_core import normal as normal_contact
from mdr_core import tangential as tangential_contact
from mdr_core.errors import InputError, Notice
from mdr_core.history import Cycles, History, State
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_service import convert, worn
from mdr_service.convert import Array
from mdr_service.schemas import loads
from mdr_service.schemas.queries import (
    HistoryQuery,
    NormalQuery,
    Query,
    StressQuery,
    TangentialQuery,
)
from mdr_service.worn import Wear

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
# Of all curves of a history, and how exact they look.
_MOST_STEPS: Final = 2_000
_VISIBLE: Final = 1e-4
# Closed form wherever the equivalent profile is: they take no tolerance.
_FOUNDATION: Final = frozenset({"foundation_load", "foundation_shear"})

Result = NormalContact | TangentialContact | History


@dataclass(frozen=True)
class Followed:
    """A history, and its cycles where it was told by them."""

    history: History
    cycles: Cycles | None = None


@dataclass(frozen=True)
class Stress:
    """The fields of a contact, by load and radius."""

    result: Result
    """What was solved for them."""
    contact: NormalContact
    radius: Array
    fields: Mapping[str, Array]
    varied: Mapping[str, Array]
    """What was given for each load on its own, by name."""

    @property
    def method(self) -> str:
        """The dearest route that was taken."""
        closed = _FOUNDATION.union(self.contact.profile.closed_forms)
        if isinstance(self.result, History) and self.result.state.curved:
            # Over arcs there is nothing but integrals.
            closed -= _SHEAR_FIELDS.keys()
        return self.contact.method if closed.issuperset(self.fields) else "quadrature"

    @property
    def error_estimate(self) -> float:
        """Bound on the error of each field, relative to its largest value."""
        known = self.result.error_estimate
        return known if self.method == "closed_form" else max(known, self.contact.rtol)

    @property
    def fronts(self) -> Array:
        """Radii at which slip and stick meet, by load and front."""
        if isinstance(self.result, History):
            return self.result.slip_fronts[None, :]
        if isinstance(self.result, TangentialContact):
            return np.reshape(self.result.stick_radius, (-1, 1))
        return np.zeros((1, 0))

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


def history(query: HistoryQuery) -> Followed:
    """Return the history that is asked for, by its points or by cycles."""
    convert.require_one_way(query)
    if not query.has_cycles:
        return Followed(_history(query))
    arguments = convert.cycles_arguments(query)
    try:
        cycles = loading.cycles(**arguments)
    except InputError as error:
        raise _pointed(error, "cycles", query.cycles) from None
    return Followed(cycles.history, cycles)


def stress(query: StressQuery) -> Stress:
    """Return the fields that are asked for, and nothing else."""
    convert.require_consistent(query)
    result = _solved(query)
    contact, pushed = _parts(result)
    if query.radius:
        radius = np.array(query.radius)
    else:
        radius = fields.grid(pushed or contact, query.points)
    shape = (query.loads, radius.size)
    found: dict[str, Array] = {}
    for name in query.quantities:
        tolerance = {} if name in _FOUNDATION else {"rtol": query.rtol}
        if name in _NORMAL_FIELDS:
            field = _NORMAL_FIELDS[name](contact, radius, **tolerance)
        else:
            field = _SHEAR_FIELDS[name](pushed, radius, **tolerance)
        found[name] = np.ascontiguousarray(np.broadcast_to(field, shape))
    varied = {each.control: np.array(each.value) for each in query.controls if each.count > 1}
    return Stress(result, contact, radius, found, varied)


def notices(query: Query, result: Result | Wear) -> list[Notice]:
    """Return what is to be said of a result, of its material, and of yield if that is asked.

    What the material says is about the coupling with a tangential load: without one there is
    nothing to say.
    """
    found = [*result.warnings]
    pressed: NormalContact
    friction: dict[str, Any] = {}
    if isinstance(result, NormalContact):
        pressed = result
    elif isinstance(result, History):
        pressed = result.contact
        friction = {
            "friction_coefficient": result.start.friction_coefficient,
            "full_slip": result.regime == "full_slip",
        }
    else:
        sideways = result if isinstance(result, TangentialContact) else worn.sideways(result)
        pressed = sideways.normal
        friction = {
            "friction_coefficient": sideways.friction_coefficient,
            "full_slip": sideways.full_slip,
        }
    if friction:
        found += convert.material(query.material).warnings
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


def smooth(history: History) -> History:
    """Return the same history with as many samples as its curves need to look smooth."""
    way = history.path
    ends = slice(way.per_step - 1, None, way.per_step)
    normal_load, tangential_load = way.normal[ends], way.tangential[ends]
    samples = -(-_MOST_STEPS // normal_load.size)
    if samples <= way.per_step:
        return history
    start = history.start
    controls: dict[str, Any] = {way.normal_name: normal_load, way.tangential_name: tangential_load}
    return loading.solve(
        start.profile,
        start.e_star,
        start.g_star,
        start.friction_coefficient,
        **controls,
        samples_per_step=min(samples, _STEPS),
        rtol=max(history.rtol, _VISIBLE),
    )


def _solved(query: StressQuery) -> Result:
    if query.has_history:
        return _history(query)
    return tangential(query) if query.has_friction else normal(query)


def _parts(result: Result) -> tuple[NormalContact, TangentialContact | State | None]:
    """Return what the fields are of: the normal contact, and what the friction left there."""
    if isinstance(result, TangentialContact):
        return result.normal, result
    if isinstance(result, NormalContact):
        return result, None
    depth = max(float(result.indentation_depth[-1]), 0.0)
    end = normal_contact.solve(
        result.start.profile, result.start.e_star, indentation_depth=depth, rtol=result.rtol
    )
    return end, result.state


def _history(query: HistoryQuery | StressQuery) -> History:
    arguments = convert.history_arguments(query)
    try:
        return loading.solve(**arguments)
    except InputError as error:
        raise _pointed(error, "history", query.history) from None


def _pointed(error: InputError, name: str, way: loads.History | loads.Cycles) -> InputError:
    """Return the failure with the path of the request: the core sees points in either case."""
    where, *path = error.path
    if where != "history":
        return error
    if len(path) == 3:
        path = [*way.place(str(path[0]), int(path[2]))]
    return InputError((name, *path), error.detail)
