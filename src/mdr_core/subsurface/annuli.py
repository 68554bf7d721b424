"""Annuli of the contact on which the tangential load of the foundation has one formula."""

from math import inf, prod
from typing import Any, NamedTuple, TypeAlias, TypeVar

import numpy as np

from mdr_core.broadcasting import with_parameters
from mdr_core.history import ContactState, LoadHistory
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array

Contact: TypeAlias = NormalContact | TangentialContact | ContactState
_Loaded = TypeVar("_Loaded", bound=Contact)


class Annuli(NamedTuple):
    """Annuli by their outer radii, ascending, on which -dq_x/dq is k = slope; shape (n,) each."""

    radius: Array
    """[length]; the last is the contact radius."""
    width: Array
    """Without cancellation [length]."""
    slope: Array
    """[1]; zero on an arc."""
    rate: Array
    """On an arc k is rate 2x, or rate/(2x) where `inverse`; zero elsewhere."""
    inverse: bool = False

    @property
    def sheared(self) -> bool:
        """True if there is a tangential load."""
        return bool(self.slope.any() or self.rate.any())

    @property
    def slips_from(self) -> float:
        """Least radius at which q_x has a slope [length]; infinite if it has none."""
        inner = np.append(0.0, self.radius[:-1])
        return float(inner[(self.slope != 0) | (self.rate != 0)].min(initial=inf))


def annuli_of(contact: Contact) -> Annuli:
    """Return the annuli of a contact under a single load, of a history between its slip fronts."""
    if isinstance(contact, ContactState):
        if not contact.in_contact:
            return Annuli(*np.zeros((4, 1)))
        if contact.profile.has_no_partial_slip:
            # All springs carry the same load.
            share = contact.load[0] / (contact.e_star * contact.indentation_depth)
            return Annuli(*np.array([[contact.contact_radius], [0.0], [share], [0.0]]))
        segments, friction = contact.segments, contact.friction_coefficient
        slope = np.where(segments.rate == 0, segments.slope, 0.0)
        width = contact.profile.radius_width(segments.coordinate[1:], segments.width)
        radius = contact.profile.contact_radius(segments.coordinate[1:])
        return Annuli(radius, width, friction * slope, friction * segments.rate, segments.inverse)
    normal, k, stick, slip = normal_of(contact), 0.0, 0.0, 0.0
    a = float(normal.contact_radius)
    if isinstance(contact, TangentialContact):
        k = float(contact.sign * contact.friction_coefficient)
        if not contact.full_slip:
            stick, slip = float(contact.stick_radius), float(contact.slip_width)
            # A flat punch that sticks carries q_x in proportion to q; its width is that part.
            k *= float(contact.width) if normal.profile.has_no_partial_slip else float(slip > 0)
    if slip == 0:
        return Annuli(*np.array([[a], [a], [k], [0.0]]))
    return Annuli(*np.array([[stick, a], [stick, slip], [0.0, k], [0.0, 0.0]]))


def shape_of(contact: Contact) -> tuple[int, ...]:
    """Return the shape of the loads."""
    if isinstance(contact, ContactState):
        return ()
    return (contact.width if isinstance(contact, TangentialContact) else contact.coordinate).shape


def normal_of(contact: Contact | LoadHistory) -> NormalContact:
    """Return the normal contact, under all loads of a history."""
    if isinstance(contact, LoadHistory):
        return contact.contact
    if isinstance(contact, ContactState):
        first = contact.profile.first_coordinate
        coordinate = contact.coordinate[-1] if contact.in_contact else first
        return NormalContact(contact.profile, contact.e_star, np.asarray(coordinate))
    return contact.normal if isinstance(contact, TangentialContact) else contact


def single(contact: _Loaded, index: int, shape: tuple[int, ...]) -> _Loaded:
    """Return the contact under one of its loads, by the number among loads of the given shape."""

    def chosen(value: Any) -> Any:
        if isinstance(value, NormalContact):
            return single(value, index, shape)
        if isinstance(value, Profile):
            swept = {name: float(chosen(value.parameters[name])) for name in value.swept}
            return with_parameters(value, swept)
        if isinstance(value, np.ndarray):
            return np.asarray(np.broadcast_to(value, shape).flat[index])
        return value

    # With the results that are known, because a prescribed radius is more accurate than its
    # coordinate.
    part = object.__new__(type(contact))
    vars(part).update({name: chosen(value) for name, value in vars(contact).items()})
    return part


def single_loads(contact: Contact) -> list[Contact]:
    """Return the contact under each load."""
    shape = shape_of(contact)
    return [single(contact, index, shape) for index in range(prod(shape))] if shape else [contact]


def slips_from(contact: TangentialContact | LoadHistory) -> Array:
    """Return the least radius with slip under each load [length]; infinite without slip."""
    if isinstance(contact, LoadHistory):
        return np.where(contact.regime == "full_slip", 0.0, inf)
    slips = contact.full_slip | (contact.width > 0)
    return np.where(slips, contact.stick_radius, inf)
