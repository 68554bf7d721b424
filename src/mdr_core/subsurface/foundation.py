"""Slopes of the foundation's loads q and q_x over annuli, from which the stresses follow."""

from collections.abc import Iterator
from math import inf
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np

from mdr_core.abel.displacement import Branch
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
    if isinstance(contact, ContactState):
        yield _of_state(contact, rtol, nearest)
        return
    normal = contact.normal if isinstance(contact, TangentialContact) else contact
    profile = normal.profile
    columns: list[Any] = [normal.e_star, normal.contact_radius, normal.coordinate]
    if isinstance(contact, TangentialContact):
        columns += [contact.sign * contact.friction_coefficient, contact.full_slip]
        columns += [contact.stick_radius, contact.slip_width, contact.width]
    shape = shape_of(contact)
    rows = zip(*(np.broadcast_to(part, shape).ravel().tolist() for part in columns), strict=True)
    for e_star, a, coordinate, *friction in rows:
        build = _Builder(profile, rtol, _NEAREST * a if nearest is None else nearest)
        whole = build.span(a, coordinate)
        pressed = build.block(whole, coordinate)
        edges, sheared, slips_from = [a], [], inf
        if friction and pressed is not None:
            scale, full, c, width, share = friction
            if full:
                sheared, slips_from = [(scale, pressed)], 0.0
            elif profile.slips_at_once:
                # Of a flat punch, which sticks completely, the width is the part of its depth.
                sheared = [(scale * share, pressed)] if share else []
            elif share:
                block = build.block(whole._replace(c=c, width=width))
                sheared = [] if block is None else [(scale, block)]
                edges, slips_from = [c, a], c
        yield Foundation(profile, e_star / np.pi, edges, pressed, sheared, slips_from, rtol)


def _of_state(state: ContactState, rtol: float, nearest: float | None) -> Foundation:
    """The loads at the end of a load history, an annulus between neighbouring slip fronts each."""
    profile, segments, friction = state.profile, state.segments, state.friction_coefficient
    modulus, a = state.e_star / np.pi, state.contact_radius
    if not state.in_contact:
        return Foundation(profile, modulus, [0.0], None, [], inf, rtol)
    build = _Builder(profile, rtol, _NEAREST * a if nearest is None else nearest)
    radii, places = (
        part.tolist() for part in (profile.contact_radius(segments.coordinate), segments.coordinate)
    )
    depth, parts, slips_from = state.indentation_depth, [], inf
    pressed = build.block(build.span(a, places[-1]), depth)
    if profile.slips_at_once:
        # All springs carry the same load.
        parts = [(float(state.load[0]) / (state.e_star * depth), pressed)]
    else:
        widths = profile.radius_width(segments.coordinate[1:], segments.width)
        for i in np.flatnonzero(segments.slope * (segments.rate == 0)):
            span = build.span(radii[i + 1], places[i + 1])
            if i:
                span = span._replace(c=radii[i], width=float(widths[i]))
            parts.append((friction * float(segments.slope[i]), build.block(span)))
            slips_from = min(slips_from, span.c)
        for arc in arcs(state):
            span = Span(arc.high, arc.low, arc.width, None)
            smooth = [Smooth(each, min(each.base, each.behind)) for each in arc.branches(rtol)]
            parts.append((friction, blocks(smooth, span, rtol, build.nearest)))
            slips_from = min(slips_from, span.c)
    sheared = [(scale, block) for scale, block in parts if block is not None]
    edges = [*state.slip_fronts.tolist(), a]
    return Foundation(profile, modulus, edges, pressed, sheared, slips_from, rtol)


class _Builder(NamedTuple):
    profile: Profile
    rtol: float
    nearest: float

    def span(self, a: float, coordinate: float) -> Span:
        """Return the span from the axis to a radius."""
        blunt = float(self.profile.contact_radius(np.asarray(self.profile.first_coordinate))) > 0
        return Span(a, 0.0, a, coordinate if blunt and not self.profile.slips_at_once else None)

    def block(self, span: Span, depth: float = 0.0) -> Block | None:
        """Return the blocks of g' over an annulus, or of a flat punch's step at its edge."""
        if self.profile.slips_at_once:
            return step_block(span.a, depth)
        panels = self.profile.panels(self.rtol)
        branches = self.profile.branches if panels is None else panels.branches
        smooth = [Smooth(branch, self._near(branch)) for branch in branches]
        return blocks(smooth, span, self.rtol, self.nearest)

    def _near(self, branch: Branch) -> float:
        """Distance in s over which g' changes next to s = 0."""
        profile = self.profile
        if branch.base > 0:
            return min(branch.base, branch.behind)
        if branch.stop < inf or branch.pole < inf or isinstance(profile, Cone | Paraboloid):
            return inf
        return float(np.asarray(profile.scale)) if isinstance(profile, Hyperboloid) else 0.0
