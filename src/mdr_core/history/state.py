"""What a contact remembers: the anchors of its springs, and one straight step on from there."""

from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from mdr_core.checks import require_positive
from mdr_core.errors import InputError
from mdr_core.foundation import coordinate_from_depth
from mdr_core.history import memory
from mdr_core.history.branches import Branches
from mdr_core.history.memory import Chain
from mdr_core.lazy import cached_property
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# Slopes of neighbouring chords differ by less, those of different branches by more.
_CHORD: Final = 0.02


class Pieces(NamedTuple):
    """The polyline of anchors as it is, piece by piece from the axis outwards."""

    coordinate: Array
    """Contact coordinates of the breakpoints, shape (n + 1,)."""
    width: Array
    """Widths of the pieces in the contact coordinate, with their digits, shape (n,)."""
    slope: Array
    """Slope of the anchors in w, of an arc its mean, from -1 to 1."""
    load: Array
    """q_x/(mu E*) at the breakpoints [length], shape (n + 1,)."""
    rate: Array
    """On an arc the slope is rate 2 x, or rate/(2 x) where `by_force`; zero on straight pieces."""
    by_force: bool


@dataclass(frozen=True)
class State:
    """A contact after any history, as the polyline of its springs' anchors.

    A spring is named by the depth w at which it touches. Its anchor U - q_x/(mu E*), with
    U = G* u_x/(mu E*), stays while it sticks. The polyline of (w, anchor) is all there is to
    know, for every profile. Source: notes, §10.
    """

    profile: Profile
    e_star: float
    g_star: float
    friction_coefficient: float
    chain: Chain
    chords: bool = False
    """Chords stand for arcs in `chain`: not every vertex is a front."""
    curved: Pieces | None = None
    """The polyline at the end of a curved way, if some of it is arcs."""

    @property
    def compliance(self) -> float:
        """mu E*/G* [1]: turns anchors into displacements."""
        return self.friction_coefficient * self.e_star / self.g_star

    @property
    def indentation_depth(self) -> float:
        """d [length]; negative in a gap."""
        return self.chain.point[0]

    @property
    def tangential_displacement(self) -> float:
        """u_x [length]."""
        return self.compliance * self.chain.point[1]

    @cached_property
    def _branches(self) -> Branches:
        return Branches(self.profile, memory.as_tree(self.chain), by_force=False)

    @property
    def touches(self) -> bool:
        """Some spring is in contact."""
        return len(self.chain.forward) > 1

    @cached_property
    def depth(self) -> Array:
        """Depths w of the breakpoints, from 0 to d [length]; empty in a gap."""
        if not self.touches:
            return _kept(np.zeros(0))
        return _kept(np.append(self._branches.depth[:-1], self.indentation_depth))

    @cached_property
    def load(self) -> Array:
        """q_x of the springs at the breakpoints [force/length]; linear in w between them."""
        if not self.touches:
            return _kept(np.zeros(0))
        above = np.cumsum((self._branches.tree.slope * self._branches.tree.span)[:0:-1])
        return _kept(self.friction_coefficient * self.e_star * np.append(above[::-1], 0.0))

    @cached_property
    def slope(self) -> Array:
        """Slope of the anchors in w on each piece from the axis outwards, from -1 to 1."""
        return _kept(self._branches.tree.slope[1:])

    @cached_property
    def coordinate(self) -> Array:
        """Contact coordinates of the breakpoints."""
        return _kept(self._branches.coordinate if self.touches else np.zeros(0))

    @cached_property
    def width(self) -> Array:
        """Widths of the pieces in the contact coordinate, with the digits of their steps."""
        return _kept(self._branches.width[1:])

    @cached_property
    def pieces(self) -> Pieces:
        """The polyline with its arcs; empty in a gap."""
        if self.curved is not None:
            return self.curved
        load = self.load / (self.friction_coefficient * self.e_star)
        straight = _kept(np.zeros(self.slope.shape))
        return Pieces(self.coordinate, self.width, self.slope, load, straight, by_force=False)

    @property
    def contact_radius(self) -> float:
        """a [length]."""
        return float(self.profile.contact_radius(self.coordinate[-1])) if self.touches else 0.0

    @property
    def slip_fronts(self) -> Array:
        """Radii inside the contact where the branch of q_x changes, ascending [length]."""
        if self.profile.slips_at_once:
            return np.zeros(0)
        if self.curved is not None:
            return self.profile.contact_radius(self.curved.coordinate[1:-1])
        fronts = self.profile.contact_radius(self.coordinate[1:-1])
        return fronts[np.abs(np.diff(self.slope)) > _CHORD] if self.chords else fronts

    @property
    def tangential_force(self) -> float:
        """F_x = mu E* sum k (I_i - I_i-1) [force]. Source: notes, §10."""
        shear = float(self._branches.shear[-1]) if self.touches else 0.0
        return self.friction_coefficient * self.e_star * shear


def _kept(values: Array) -> Array:
    """The array, closed to changes: what is remembered stays."""
    values.flags.writeable = False
    return values


def unloaded(profile: Profile, e_star: float, g_star: float, friction_coefficient: float) -> State:
    """Return the state of bodies that have not touched yet, at zero depth and displacement.

    Raises
    ------
    InputError : a modulus or a friction coefficient that is not positive and finite.
    """
    for path, value in (
        (("material", "e_star"), e_star),
        (("material", "g_star"), g_star),
        (("friction_coefficient",), friction_coefficient),
    ):
        require_positive(path, value)
    return State(profile, e_star, g_star, friction_coefficient, memory.gap(0.0, 0.0))


def advance(state: State, indentation_depth: float, tangential_displacement: float) -> State:
    """Return the state after one straight step in depth and displacement, exactly.

    Springs that stick keep their anchors, springs that touch on the way take the displacement of
    that moment, springs that would carry more than mu q slip. A depth <= 0 ends the contact; its
    return finds no memory. Of a state at the end of arcs, chords are walked on from: see
    `History.state_error_estimate`.

    Source: mdr-5, Eqs. (5.4)-(5.9); notes, §10.

    Raises
    ------
    InputError : numbers that are not finite, or a depth past the profile's end.

    Examples
    --------
    Eq. (5.15): half of the displacement at full slip, on a cone, is F_x = 3/4 mu F_N.

    >>> from mdr_core.profiles import Cone
    >>> state = advance(unloaded(Cone(0.1), 1.0, 1.0, 0.5), 2.0, 0.0)
    >>> state = advance(state, 2.0, 0.5)
    >>> normal_force = (2.0 / 0.1) ** 2 * 0.1 * 2 / np.pi
    >>> round(state.tangential_force / (0.5 * normal_force), 12)
    0.75
    """
    depth, shift = np.array([indentation_depth]), np.array([tangential_displacement])
    if not (np.isfinite(depth[0]) and np.isfinite(shift[0])):
        raise InputError(("history",), "must be finite")
    coordinate_from_depth(state.profile, np.maximum(depth, 0.0))
    tree = memory.walk(state.chain, depth, shift / state.compliance, np.zeros(1, dtype=bool))
    return replace(state, chain=tree.end, curved=None)
