"""Fields over the radius, of a contact or at the end of a load history."""

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.fields import contact as _contact
from mdr_core.fields import history_end as _history_end
from mdr_core.fields import radii as _radii
from mdr_core.fields.contact import foundation_load, normal_displacement, pressure
from mdr_core.fields.radii import graded
from mdr_core.history import ContactState
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array


def shear_stress(
    contact: TangentialContact | ContactState, radius: ArrayLike, *, rtol: float = 1e-10
) -> Array:
    """Return the shear stress over the radius; see `contact` and `history_end`."""
    if isinstance(contact, ContactState):
        return _history_end.shear_stress(contact, radius, rtol=rtol)
    return _contact.shear_stress(contact, radius, rtol=rtol)


def slip(
    contact: TangentialContact | ContactState, radius: ArrayLike, *, rtol: float = 1e-10
) -> Array:
    """Return the slip over the radius; see `contact` and `history_end`."""
    if isinstance(contact, ContactState):
        return _history_end.slip(contact, radius, rtol=rtol)
    return _contact.slip(contact, radius, rtol=rtol)


def foundation_shear(contact: TangentialContact | ContactState, radius: ArrayLike) -> Array:
    """Return the foundation's tangential load over the radius; see `contact` and `history_end`."""
    if isinstance(contact, ContactState):
        return _history_end.foundation_shear(contact, radius)
    return _contact.foundation_shear(contact, radius)


def grid(contact: NormalContact | TangentialContact | ContactState, points: int) -> Array:
    """Return radii that cluster at the singularities of the fields; see `contact`."""
    if isinstance(contact, ContactState):
        return _history_end.grid(contact, points)
    return _contact.grid(contact, points)


def edges(contact: NormalContact | TangentialContact | ContactState) -> _radii.Edges:
    """Return the contact radii and slip fronts, with their rounding errors."""
    if isinstance(contact, ContactState):
        return _history_end.edges(contact)
    return _contact.edges(contact)


def edge_error(
    contact: NormalContact | TangentialContact | ContactState, name: str, radius: ArrayLike
) -> float:
    """Return the error of a field by that of the edges, relative to its largest value [1].

    Edges are the contact radius and the slip fronts if they follow from a load. Radii within four
    units in the last place of an edge are excluded, because the relative error at a root is
    unbounded.

    Parameters
    ----------
    contact : contact, or end of a load history.
    name : `pressure`, `shear_stress`, `slip` or `foundation_shear`; other fields have no edge.
    radius : radii of the field [length], shape (m,).
    """
    if name not in ("pressure", "shear_stress", "slip", "foundation_shear"):
        return 0.0
    stress = name in ("pressure", "shear_stress")
    radius = np.atleast_1d(np.asarray(radius, dtype=float))
    return _radii.edge_error(edges(contact), radius, root=stress)


__all__ = [
    "edge_error",
    "edges",
    "foundation_load",
    "foundation_shear",
    "graded",
    "grid",
    "normal_displacement",
    "pressure",
    "shear_stress",
    "slip",
]
