"""Slopes of the foundation's loads q and q_x over annuli, from which the stresses follow."""

from collections.abc import Iterator
from math import inf
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np

from mdr_core.abel.displacement import Branch
from mdr_core.fields.arc import Arc
from mdr_core.fields.history_end import arcs
from mdr_core.history import ContactState, LoadHistory
from mdr_core.normal import NormalContact
from mdr_core.profiles import Cone, Hyperboloid, Paraboloid, Profile
from mdr_core.subsurface.moments import Block, Smooth, Span, blocks, step_block
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array

# Least distance from the origin at which a search needs all digits, over the contact radius.
_NEAREST: Final = 1e-7

Contact: TypeAlias = NormalContact | TangentialContact | ContactState
# Slope of -q_x/E* in parts of g' on an annulus, None for the whole contact, or times the factor of
# an arc.
_Part: TypeAlias = tuple[float, Span | Arc | None]


class Foundation(NamedTuple):
    """Loads of the foundation in one case, resolved to a tolerance."""

    profile: Profile
    modulus: float
    """E*/pi [pressure]."""
    edges: list[float]
    """Slip fronts and contact radius, ascending [length]."""
    pressed: Block | None
    """Of the slope g' of -q/E*; None without a load."""
    sheared: list[tuple[float, Block]]
    """Parts of the slope of -q_x/E*: a factor, and the block of a slope."""
    slips_from: float
    """Least radius at which q_x has a slope [length]; infinite if it has none."""
    rtol: float


def shape_of(contact: Contact) -> tuple[int, ...]:
    """Return the shape of the loads."""
    if isinstance(contact, ContactState):
        return ()
    return (contact.width if isinstance(contact, TangentialContact) else contact.coordinate).shape


def normal_of(contact: Contact) -> NormalContact:
    """Return the normal contact."""
    if isinstance(contact, ContactState):
        coordinate = contact.coordinate[-1] if contact.in_contact else 0.0
        return NormalContact(contact.profile, contact.e_star, np.asarray(coordinate))
    return contact.normal if isinstance(contact, TangentialContact) else contact


def slips_from(contact: TangentialContact | LoadHistory) -> Array:
    """Return the least radius with slip under each load [length]; infinite without slip."""
    if isinstance(contact, LoadHistory):
        return np.where(contact.regime == "full_slip", 0.0, inf)
    slips = contact.full_slip | (contact.width > 0)
    return np.where(slips, contact.stick_radius, inf)


def foundations(
    contact: Contact, rtol: float, nearest: float | None = None
) -> Iterator[Foundation]:
    """Yield the loads of the foundation of each case.

    Parameters
    ----------
    contact : a contact under any loads, or the state at the end of a load history.
    rtol : accuracy of the stresses, relative to the largest.
    nearest : least distance of the points from the origin [length]; None for a search.
    """
    for profile, e_star, whole, depth, parts in _cases(contact):
        smooth = [Smooth(branch, _near(profile, branch)) for branch in profile.branches]
        given = rtol, _NEAREST * whole.a if nearest is None else nearest
        if profile.slips_at_once:
            pressed = step_block(whole.a, depth) if depth > 0 else None
        else:
            pressed = blocks(smooth, whole, *given)
        edges, sheared = {whole.a}, []
        for factor, part in parts:
            block, span = pressed, whole
            if isinstance(part, Arc):
                span = Span(part.high, part.low, part.width)
                own = [Smooth(each, min(each.base, each.behind)) for each in part.branches]
                block = blocks(own, span, *given)
            elif part is not None:
                block, span = blocks(smooth, part, *given), part
            edges |= {span.c, span.a}
            if block is not None:
                sheared.append((factor, block))
        first = min(edges) if sheared else inf
        radii = sorted(edges - {0.0}) or [0.0]
        yield Foundation(profile, e_star / np.pi, radii, pressed, sheared, first, rtol)


def _cases(contact: Contact) -> Iterator[tuple[Profile, float, Span, float, list[_Part]]]:
    """Profile, E*, span and coordinate of the contact, and parts of q_x in each case."""
    if isinstance(contact, ContactState):
        yield _end(contact)
        return
    normal = normal_of(contact)
    columns: list[Any] = [normal.e_star, normal.contact_radius, normal.coordinate]
    if isinstance(contact, TangentialContact):
        columns += [contact.sign * contact.friction_coefficient, contact.full_slip]
        columns += [contact.stick_radius, contact.slip_width, contact.width]
    shape = shape_of(contact)
    rows = zip(*(np.broadcast_to(part, shape).ravel().tolist() for part in columns), strict=True)
    for e_star, a, coordinate, *friction in rows:
        whole = _span(normal.profile, a, coordinate)
        parts: list[_Part] = []
        if friction:
            factor, full, c, width, share = friction
            if full:
                parts = [(factor, None)]
            elif share > 0 and normal.profile.slips_at_once:
                # Of a flat punch, which sticks completely, the width is the part of its depth.
                parts = [(factor * share, None)]
            elif share > 0:
                parts = [(factor, whole._replace(c=c, width=width))]
        yield normal.profile, e_star, whole, coordinate, parts


def _end(state: ContactState) -> tuple[Profile, float, Span, float, list[_Part]]:
    """The case at the end of a load history: an annulus between neighbouring slip fronts each."""
    profile, segments, friction = state.profile, state.segments, state.friction_coefficient
    if not state.in_contact:
        return profile, state.e_star, Span(0.0, 0.0, 0.0), 0.0, []
    radii = profile.contact_radius(segments.coordinate).tolist()
    places, depth = segments.coordinate.tolist(), state.indentation_depth
    whole = _span(profile, state.contact_radius, places[-1])
    if profile.slips_at_once:
        # All springs carry the same load.
        return profile, state.e_star, whole, depth, [(state.load[0] / (state.e_star * depth), None)]
    widths = profile.radius_width(segments.coordinate[1:], segments.width)
    parts: list[_Part] = [(friction, arc) for arc in arcs(state)]
    for i in np.flatnonzero(segments.slope * (segments.rate == 0)):
        span = _span(profile, radii[i + 1], places[i + 1])
        if i:
            span = span._replace(c=radii[i], width=float(widths[i]))
        parts.append((friction * float(segments.slope[i]), span))
    return profile, state.e_star, whole, depth, parts


def _span(profile: Profile, a: float, coordinate: float) -> Span:
    flat = float(profile.contact_radius(np.asarray(profile.first_coordinate)))
    return Span(a, 0.0, a, 0.0 if profile.slips_at_once else flat, coordinate)


def _near(profile: Profile, branch: Branch) -> float:
    """Distance in s over which g' changes next to s = 0."""
    if branch.base > 0:
        return min(branch.base, branch.behind)
    if branch.stop < inf or branch.pole < inf or isinstance(profile, Cone | Paraboloid):
        return inf
    return float(np.asarray(profile.scale)) if isinstance(profile, Hyperboloid) else 0.0
