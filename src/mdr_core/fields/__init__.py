"""Fields over the radius, of a contact under one load or at the end of a history."""

from numpy.typing import ArrayLike

from mdr_core.fields import contact as _contact
from mdr_core.fields import remembered
from mdr_core.fields.contact import foundation_load, normal_displacement, pressure
from mdr_core.fields.largest import largest_pressure, largest_shear_stress
from mdr_core.fields.rows import graded
from mdr_core.history import State
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array


def shear_stress(
    contact: TangentialContact | State, radius: ArrayLike, *, rtol: float = 1e-10
) -> Array:
    """Return the shear stress over the radius; see `contact` and `remembered`."""
    if isinstance(contact, State):
        return remembered.shear_stress(contact, radius, rtol=rtol)
    return _contact.shear_stress(contact, radius, rtol=rtol)


def slip(contact: TangentialContact | State, radius: ArrayLike, *, rtol: float = 1e-10) -> Array:
    """Return the slip over the radius; see `contact` and `remembered`."""
    if isinstance(contact, State):
        return remembered.slip(contact, radius, rtol=rtol)
    return _contact.slip(contact, radius, rtol=rtol)


def foundation_shear(contact: TangentialContact | State, radius: ArrayLike) -> Array:
    """Return the foundation's tangential load over the radius; see `contact` and `remembered`."""
    if isinstance(contact, State):
        return remembered.foundation_shear(contact, radius)
    return _contact.foundation_shear(contact, radius)


def grid(contact: NormalContact | TangentialContact | State, points: int) -> Array:
    """Return radii that crowd towards where the fields are singular; see `contact`."""
    if isinstance(contact, State):
        return remembered.grid(contact, points)
    return _contact.grid(contact, points)


__all__ = [
    "foundation_load",
    "foundation_shear",
    "graded",
    "grid",
    "largest_pressure",
    "largest_shear_stress",
    "normal_displacement",
    "pressure",
    "shear_stress",
    "slip",
]
