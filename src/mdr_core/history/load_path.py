"""Load path: from the given points to the load points of the slip memory.

A path starts from the unloaded bodies, or from the end of another path, whose state can be stored
as JSON.

Both loads vary linearly between two samples, in the pair to which the tangential control belongs:
a displacement with the depth, a tangential force with the normal force. If the normal control
belongs to the other pair, it is converted at the samples.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from typing import Any, Final, NamedTuple, Self

import numpy as np

from mdr_core.doubles import ROUNDING
from mdr_core.errors import InputError
from mdr_core.history import slip_memory
from mdr_core.history.contact_state import ContactState
from mdr_core.history.slip_layout import NORMAL
from mdr_core.history.slip_memory import Polylines
from mdr_core.history.tractions import REGIMES
from mdr_core.interval_moments import IntervalMoments, interval_moments
from mdr_core.typing import Array, Flags, Indices
from mdr_core.validation import (
    common_shape,
    require_finite,
    require_not_negative,
    require_whole,
)

# Attributes that define a table in place of parameters.
_TABLE: Final = ("r", "values", "breaks", "uncertainty")


class SavedState(NamedTuple):
    """State between two load steps."""

    contact: str
    """Digest of the profile, the moduli, the friction coefficient and the controls."""
    normal: float
    """Prescribed depth or normal force."""
    tangential: float
    """Prescribed displacement or tangential force."""
    dissipated_energy: float
    """Energy dissipated by friction since the bodies were unloaded."""
    regime: str
    """Slip regime."""
    polyline: Sequence[Sequence[float]]
    """Sums normal + anchor and normal - anchor of the vertices below the load point, from the axis.

    The sums are empty in separation.
    """

    @classmethod
    def parsed(cls, given: Mapping[str, Any], contact: str) -> Self:
        """Return the state of a `contact` from its members; raise InputError if they do not fit."""
        members: object = given
        if not isinstance(members, Mapping) or set(members) != set(cls._fields):
            detail = f"must have the members of a final_state: {', '.join(cls._fields)}"
            raise InputError(("initial_state",), detail)
        if given["regime"] not in REGIMES:
            detail = f"must be one of {', '.join(REGIMES)}"
            raise InputError(("initial_state", "regime"), detail)
        if given["contact"] != contact:
            detail = "belongs to another profile, material, friction coefficient or control"
            raise InputError(("initial_state", "contact"), f"{detail}: repeat all four")
        return cls(**given)

    def restored(self, load_point: Array) -> Polylines:
        """Return the polyline up to the load point.

        Raises InputError if the polyline is impossible, because friction limits its slope.
        """
        place, normal = ("initial_state", "polyline"), float(load_point[0])
        if {not self.polyline, self.regime == "no_contact"} != {normal <= 0}:
            raise InputError(place, "must be empty, and the regime no_contact, only in separation")
        if normal <= 0:
            return slip_memory.separated(load_point[:, None])
        line = slip_memory.through(np.array(self.polyline), load_point)
        growth = np.diff(line.vertices[:, :NORMAL], axis=0)
        # Rounding errors may let a sum decrease along a polyline.
        good = (growth.min(axis=1) >= -ROUNDING * normal) & (growth.max(axis=1) > 0)
        good[0] &= line.vertices[0, NORMAL] == 0
        if not good.all():
            detail = "exceeds the next vertex in a sum, or is the first one and not on the axis"
            raise InputError((*place, int(np.argmin(good))), detail)
        return line


UNLOADED: Final = SavedState("", 0.0, 0.0, 0.0, "no_contact", ())
"""State of bodies before first contact."""


@dataclass(frozen=True)
class SampledPath:
    """Points and samples of a load history, in the quantities that are prescribed.

    In arrays of two rows the first is the normal load, the second the tangential load.
    """

    start: ContactState
    """The unloaded contact."""
    controls: tuple[str, str]
    """Names of the prescribed loads."""
    points: Array
    """Loads at the start and at each point, shape (2, m + 1)."""
    per_step: int = 1
    """Samples on each load step, the last of which is its point; n = m per_step in total."""
    begin: SavedState = UNLOADED
    """State at the start."""

    @cached_property
    def even_samples(self) -> Array:
        """Loads at the start and at samples that divide each step evenly, shape (2, n + 1)."""
        count, start, stop = self.per_step, self.points[:, :-1, None], self.points[:, 1:, None]
        if count == 1:
            return self.points
        share = np.arange(1, count + 1)
        # Within rounding error, proportional forces stay proportional, even close to zero.
        samples = start * ((count - share) / count) + stop * (share / count)
        samples = np.where(start == stop, stop, samples).reshape(2, -1)
        return np.hstack([self.points[:, :1], samples])

    @cached_property
    def loads(self) -> Array:
        """Loads at the start and at each sample, evenly spaced in the normal load, (2, n + 1).

        Raises InputError at `load` for a normal load that has no contact.
        """
        loads, count = self.even_samples, self.per_step
        if self.starts_straight and loads[0, count] > 0:
            normal = self._normal_coordinate(loads[0, 1 : count + 1])
            loads = loads.copy()
            loads[1, 1 : count + 1] = loads[1, count] * (normal / normal[-1])
        return loads

    @cached_property
    def step(self) -> Indices:
        """Load step of each sample: the index of the given point that it ends at."""
        return np.repeat(np.arange(self.points.shape[1] - 1), self.per_step)

    @property
    def over_forces(self) -> bool:
        """True if normal coordinates are reduced forces: the tangential force is prescribed."""
        return self.controls[1] == "tangential_force"

    @property
    def depth_prescribed(self) -> bool:
        """True if the depth is prescribed, false for the normal force."""
        return self.controls[0] == "indentation_depth"

    @property
    def mixed(self) -> bool:
        """True if the controls are of different pairs, so that the normal control is converted."""
        return self.over_forces == self.depth_prescribed

    @property
    def starts_straight(self) -> bool:
        """The samples of the first step lie on the straight line from zero load to its point."""
        return self.mixed and self.per_step > 1 and self.begin is UNLOADED

    @property
    def continues(self) -> Flags:
        """True for samples that continue the straight line to the sample before, shape (n,)."""
        flags = np.ones((self.points.shape[1] - 1, self.per_step), dtype=bool)
        flags[:, 0] = False
        if self.mixed:
            straight = (np.diff(self.points) == 0).any(axis=0)
            straight[0] |= self.starts_straight
            flags &= straight[:, None]
        return flags.ravel()

    @property
    def moments(self) -> IntervalMoments:
        """Moments over intervals of the normal coordinate."""
        return interval_moments(self.start.profile, over_forces=self.over_forces)

    def _normal_coordinate(self, loads: Array) -> Array:
        """Return the depths or reduced forces of normal loads, <= 0 in separation."""
        if not self.depth_prescribed:
            loads = loads / self.start.e_star
        if not self.mixed:
            return loads
        # Equal loads get equal coordinates; otherwise the last bit may depend on an element's
        # position.
        load, index = np.unique(np.maximum(loads, 0.0), return_inverse=True)
        of_force = not self.depth_prescribed
        s = self.start.profile.coordinate_from_load(load, of_force=of_force)
        given = interval_moments(self.start.profile, over_forces=of_force)
        return np.where(loads > 0, given.conjugate(load, s)[index], np.minimum(loads, 0.0))

    @cached_property
    def coordinates(self) -> Array:
        """Normal and tangential coordinate at the start and at each sample, shape (2, n + 1).

        Raises InputError for a tangential force without equilibrium.
        """
        scale = self.start.friction_coefficient * self.start.e_star
        scale /= 1.0 if self.over_forces else self.start.g_star
        normal, tangential = self._normal_coordinate(self.loads[0]), self.loads[1] / scale
        limit = np.maximum(normal, 0.0) if self.over_forces else normal
        if self.over_forces:
            self._require_equilibrium(limit, tangential)
        # A tangential load that differs from the limit by rounding errors alone is set to the
        # limit.
        near = np.abs(np.abs(tangential) - limit) <= ROUNDING * limit
        return np.array([normal, np.where(near, np.copysign(limit, tangential), tangential)])

    def _require_equilibrium(self, limit: Array, tangential: Array) -> None:
        """Raise InputError for a tangential force above friction or on separated bodies.

        Parameters
        ----------
        limit, tangential : reduced forces F_N/E* and F_x/(mu E*) at the start and at each sample
            [length^2], shape (n + 1,).
        """
        depth, force = self.points
        place = "history", "tangential", self.controls[1]
        apart = np.minimum(depth[:-1], depth[1:]) < 0
        at_gap = apart & ((force[:-1] != 0) | (force[1:] != 0))
        if at_gap.any():
            detail = (
                "no equilibrium: a tangential force acts where the bodies touch or separate; add a "
                "point in contact without the force, or prescribe tangential_displacement"
            )
            raise InputError((*place, int(np.argmax(at_gap))), detail)
        beyond = np.flatnonzero(np.abs(tangential) > limit * (1 + ROUNDING))
        if beyond.size:
            detail = (
                "no equilibrium: between the point before and this one the force exceeds "
                "friction_coefficient x normal_force; reduce it, change the two loads in turn, or "
                "prescribe tangential_displacement"
            )
            at_start, at = ("initial_state", "tangential"), int(self.step[beyond[0] - 1])
            raise InputError((*place, at) if beyond[0] else at_start, detail)


def build(
    start: ContactState,
    normal: tuple[str, Array],
    tangential: tuple[str, Array],
    samples_per_step: int,
    begin: SavedState = UNLOADED,
) -> SampledPath:
    """Return the load path through the given points.

    Parameters
    ----------
    start : the unloaded contact.
    normal, tangential : name and points, shape (n,) or, for one of the two, a single value.
    samples_per_step : evenly spaced samples on each step, >= 1.
    begin : state from which the first step starts.

    Raises
    ------
    InputError : lengths that differ and are not 1, no points, numbers that are not finite, a
        negative normal force, or less than one sample per step.
    """
    require_whole(("history", "samples_per_step"), samples_per_step)
    if samples_per_step < 1:
        raise InputError(("history", "samples_per_step"), "must be at least 1")
    normal_points = _checked("normal", *normal)
    tangential_points = _checked("tangential", *tangential)
    place = "history", "tangential", tangential[0]
    common_shape(place, tangential_points, normal[0], normal_points)
    loads = np.array(np.broadcast_arrays(normal_points, tangential_points))
    points = np.column_stack([(begin.normal, begin.tangential), loads])
    return SampledPath(start, (normal[0], tangential[0]), points, samples_per_step, begin)


def _checked(axis: str, name: str, value: Array) -> Array:
    """Points of one load, checked to be finite and one-dimensional."""
    points = np.atleast_1d(value)
    if points.ndim != 1 or points.size == 0:
        raise InputError(("history", axis, name), "must be a list of at least one number")
    require = require_not_negative if name == "normal_force" else require_finite
    require(("history", axis, name), points)
    return points


def digest(start: ContactState, *controls: str) -> str:
    """Return a digest of an unloaded contact and the names of the prescribed loads."""
    profile = start.profile
    names = profile.parameters or _TABLE
    own = {name: np.asarray(getattr(profile, name)).tolist() for name in names}
    numbers = map(float, (start.e_star, start.g_star, start.friction_coefficient))
    text = repr((profile.kind, own, (*numbers, *controls)))
    return sha256(text.encode()).hexdigest()[:16]
