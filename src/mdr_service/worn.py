"""Queries about wear solved, like the others in `solve`."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from mdr_core import fields
from mdr_core import normal as normal_contact
from mdr_core.errors import InputError
from mdr_core.profiles import Profile
from mdr_core.tangential import TangentialContact
from mdr_core.wear import evolution as wear_evolution
from mdr_core.wear import limit as wear_limit
from mdr_core.wear.course import Progress
from mdr_core.wear.evolving import WearEvolution
from mdr_core.wear.limit import LimitingWear
from mdr_service import convert
from mdr_service.convert import Array
from mdr_service.schemas.wear import EvolutionQuery, WearQuery

# Radii at which a worn surface is answered at once: bounds the memory.
_BLOCK: Final = 2_000
# The grid goes on outside the contact up to so many times its radius.
_BEYOND: Final = 1.25

Wear = LimitingWear | WearEvolution
Flags = NDArray[np.bool_]
_SHAPES: Final = frozenset({"initial_profile", "limiting_profile", "profile"})
_Wear = TypeVar("_Wear", LimitingWear, WearEvolution)


@dataclass(frozen=True)
class Worn(Generic[_Wear]):
    """Wear, in the end or over the cycles, and what was asked for over the radius."""

    result: _Wear
    radius: Array
    """Empty where none was asked for."""
    fields: Mapping[str, Array]
    """By load or number of cycles, and radius; but for the initial profile, by radius."""

    def may_be_infinite(self, name: str) -> Flags:
        """Return at which of the radii a field may truly be infinite.

        A pressure at the tip, at kinks and at the stick edge; a shape outside a flat punch.
        """
        shape: Profile = profile(self.result)
        if name == "pressure":
            edges: Array = np.ravel(self.result.stick_radius)
            return np.isin(self.radius, np.array([0.0, *map(float, shape.breaks), *edges]))
        if name in _SHAPES and shape.slips_at_once:
            return np.asarray(
                self.radius > shape.contact_radius(np.asarray(shape.first_coordinate))
            )
        return np.zeros(self.radius.size, dtype=bool)


def limit(query: WearQuery) -> Worn[LimitingWear]:
    """Return the limit that is asked for, and of its fields nothing else."""
    arguments = convert.wear_arguments(query)
    contact = normal_contact.solve(**convert.normal_arguments(query))
    try:
        result = wear_limit.solve(contact, **arguments)
    except InputError as error:
        raise _of_oscillation(error) from None
    radius = _places(query, result.grid)
    return Worn(result, radius, _asked(query, result, radius))


def evolution(query: EvolutionQuery, progress: Progress | None = None) -> Worn[WearEvolution]:
    """Return the wear over the cycles that is asked for, and of its fields nothing else.

    `progress` is told how far it has come, as of `mdr_core.wear.evolution.solve`.
    """
    arguments = convert.evolution_arguments(query)
    contact = normal_contact.solve(**convert.held_arguments(query))
    try:
        result = wear_evolution.solve(contact, **arguments, progress=progress)
    except InputError as error:
        raise _of_oscillation(error) from None
    radius = _places(query, lambda points: grid(result, points))
    _require_inside(contact.profile, radius)
    return Worn(result, radius, _asked(query, result, radius))


def grid(worn: WearEvolution, points: int) -> Array:
    """Return radii from 0 to beyond the largest contact, crowding at the first and last edges.

    Raises InputError where these are more.
    """
    shape = profile(worn)
    edges = np.array([*worn.stick_radius[[0, -1]], *worn.contact_radius[[0, -1]]])
    last = min(_BEYOND * float(edges.max()) or 1.0, float(shape.domain))
    stops = np.unique([0.0, *map(float, shape.breaks), *edges])
    return fields.graded(np.append(stops[stops < last], last), points)


def few(worn: LimitingWear, most: int) -> LimitingWear:
    """Return the limit of the first loads only."""
    first = worn.first
    if worn.wear_radius.size <= most:
        return worn
    contact = replace(first.normal, coordinate=np.ravel(first.normal.coordinate)[:most])
    amplitude: dict[str, Any] = {
        worn.amplitude: np.ravel(getattr(first, worn.amplitude))[:most],
    }
    return wear_limit.solve(contact, first.g_star, first.friction_coefficient, **amplitude)


def limit_of(worn: WearEvolution) -> LimitingWear | None:
    """Return what the wear tends to, where that does not depend on the way and has room."""
    first = worn.scene.sideways
    by_displacement = worn.scene.control.displacement
    if worn.scene.control.force and by_displacement:
        return None
    name = "tangential_displacement" if by_displacement else "tangential_force"
    amplitude: dict[str, Any] = {name: np.abs(getattr(first, name))}
    try:
        return wear_limit.solve(first.normal, first.g_star, first.friction_coefficient, **amplitude)
    except InputError:
        return None


def profile(worn: Wear) -> Profile:
    """Return the profile before any wear."""
    return sideways(worn).normal.profile


def sideways(worn: Wear) -> TangentialContact:
    """Return the contact before any wear."""
    return worn.first if isinstance(worn, LimitingWear) else worn.scene.sideways


def _places(query: WearQuery | EvolutionQuery, grid: Callable[[int], Array]) -> Array:
    if query.points:
        return grid(query.points)
    return np.array(query.radius or (), dtype=float)


def _require_inside(shape: Profile, radius: Array) -> None:
    beyond = np.flatnonzero(radius > float(shape.domain))
    if beyond.size:
        detail = f"the profile ends at radius {float(shape.domain):.12g}"
        raise InputError(("radius", int(beyond[0])), detail)


def _asked(query: WearQuery | EvolutionQuery, result: Wear, radius: Array) -> dict[str, Array]:
    """Return what is asked for over the radius, in blocks of radii."""
    if not radius.size:
        return {}
    blocks = np.split(radius, range(_BLOCK, radius.size, _BLOCK))
    found: dict[str, Array] = {}
    for name in query.quantities:
        field: Callable[[Array], Array] = getattr(result, name)
        values = np.concatenate([field(block) for block in blocks], axis=-1)
        shape = (radius.size,) if name == "initial_profile" else (query.loads, radius.size)
        found[name] = np.ascontiguousarray(values.reshape(shape))
    return found


def _of_oscillation(error: InputError) -> InputError:
    """Return the failure with the path of the request, which has its own name for the amplitude."""
    where, *path = error.path
    return InputError(("oscillation", *path), error.detail) if where == "tangential" else error
