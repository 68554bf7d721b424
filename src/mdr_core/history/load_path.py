"""Load path: from the given points to the load points of the slip memory.

It starts from the unloaded bodies, or from the end of another path, whose state JSON can hold. A
load step is straight where displacements, or forces, are prescribed in both directions. If one of
each pair is prescribed and both change, it is nonlinear in either plane: see `nonlinear_steps`.
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
from mdr_core.history.slip_memory import LoadPoints, Polyline
from mdr_core.history.step_results import REGIMES
from mdr_core.interval_moments import IntervalMoments, interval_moments
from mdr_core.typing import Array, Flags, Indices
from mdr_core.validation import require_finite, require_not_negative

# Numbers of an arc.
_ARC: Final = 3
SETS: Final = 3
"""Sets of chords from which the results of nonlinear load steps are extrapolated."""
# Attributes that define a table, which has no parameters.
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
    polylines: Sequence[Sequence[Sequence[float]]]
    """Polyline of the slip memory, or those on each set of chords of nonlinear load steps.

    They have the vertices below the load point, from the axis: the sums normal + anchor and normal
    - anchor, and where the segment above is part of an arc its rate, and the conjugate and the
    tangential coordinate of its end.
    """

    @classmethod
    def parsed(cls, given: Mapping[str, Any], contact: str) -> Self:
        """Return the state of a `contact` from its members; raise InputError if it is of none."""
        if set(given) != set(cls._fields):
            detail = f"must have the members of a final_state: {', '.join(cls._fields)}"
            raise InputError(("initial_state",), detail)
        if given["regime"] not in REGIMES:
            detail = f"must be one of {', '.join(REGIMES)}"
            raise InputError(("initial_state", "regime"), detail)
        if given["contact"] != contact:
            detail = "belongs to another profile, material, friction coefficient or control"
            raise InputError(("initial_state", "contact"), f"{detail}: repeat those of the state")
        if len(given["polylines"]) not in {1, SETS}:
            raise InputError(("initial_state", "polylines"), f"must be one polyline, or {SETS}")
        return cls(**given)

    def restored(self, normal: float, tangential: float) -> tuple[tuple[Polyline, ...], Array]:
        """Return the polylines up to the load point, and the arcs, shape (3, m).

        The load steps of the segments are the indices of their arcs, from the end.

        Raises InputError if a polyline is impossible, because friction limits its slope.
        """
        place = "initial_state", "polylines"
        empty = {not line for line in self.polylines} | {self.regime == "no_contact"}
        if empty != {normal <= 0}:
            raise InputError(place, "must be empty, and the regime no_contact, only in separation")
        if normal <= 0:
            lines = [slip_memory.separated(normal, tangential)] * len(self.polylines)
            return tuple(lines), np.zeros((_ARC, 0))
        columns, none = NORMAL + _ARC, [0.0] * _ARC
        rows = [np.array([(*row, *none)[:columns] for row in line]) for line in self.polylines]
        arcs, labels = np.unique(np.concatenate(rows)[:, NORMAL:], axis=0, return_inverse=True)
        label, found = iter((labels.ravel() - len(arcs)).tolist()), []
        for index, vertices in enumerate(rows):
            sums, steps = vertices[:, :NORMAL], [next(label) for _ in vertices]
            line = slip_memory.through(sums, steps, normal, tangential)
            growth = np.diff(line.vertices[:, :NORMAL], axis=0)
            # By rounding a sum may decrease along a polyline.
            good = (growth.min(axis=1) >= -ROUNDING * normal) & (growth.max(axis=1) > 0)
            good[0] &= line.vertices[0, NORMAL] == 0
            if not good.all():
                detail = "exceeds the next vertex in a sum, or is the first one and not on the axis"
                raise InputError((*place, index, int(np.argmin(good))), detail)
            found.append(line)
        return tuple(found), arcs.T


UNLOADED: Final = SavedState("", 0.0, 0.0, 0.0, "no_contact", ([],))
"""State of bodies before first contact."""


@dataclass(frozen=True)
class SampledPath:
    """Samples of a load history, in the quantities that are prescribed."""

    start: ContactState
    """The unloaded contact."""
    normal_name: str
    tangential_name: str
    normal_loads: Array
    """Depth or normal force at the start and at each sample, shape (n + 1,)."""
    tangential_loads: Array
    """Displacement or tangential force at the start and at each sample, shape (n + 1,)."""
    per_step: int
    """Samples on each load step, the last of which is its given point."""
    begin: SavedState
    """State at the start."""

    @property
    def normal(self) -> Array:
        """Depth or normal force at each sample, shape (n,)."""
        return self.normal_loads[1:]

    @property
    def tangential(self) -> Array:
        """Displacement or tangential force at each sample, shape (n,)."""
        return self.tangential_loads[1:]

    @cached_property
    def step(self) -> Indices:
        """Load step of each sample: the index of the given point that it ends at."""
        return np.repeat(np.arange(self.normal.size // self.per_step), self.per_step)

    @property
    def continues(self) -> Flags:
        """Samples on the same load step as the one before."""
        flags = np.ones((self.normal.size // self.per_step, self.per_step), dtype=bool)
        flags[:, 0] = False
        return flags.ravel()

    @property
    def over_forces(self) -> bool:
        """Normal coordinates are reduced forces: the tangential force is prescribed."""
        return self.tangential_name == "tangential_force"

    @property
    def depth_prescribed(self) -> bool:
        """The depth is prescribed, not the normal force."""
        return self.normal_name == "indentation_depth"

    @property
    def moments(self) -> IntervalMoments:
        """Moments over intervals of the normal coordinate."""
        return interval_moments(self.start.profile, over_forces=self.over_forces)

    @property
    def nonlinear(self) -> Flags:
        """Samples whose step is straight neither over depths nor over forces."""
        if self.over_forces != self.depth_prescribed:
            return np.zeros(self.normal.shape, dtype=bool)
        first, second = (np.diff(each) != 0 for each in (self.normal_loads, self.tangential_loads))
        return np.asarray(first & second)

    @cached_property
    def prescribed(self) -> Array:
        """Depth [length] or reduced force F_N/E* [length^2] at the start and at each sample."""
        loads = self.normal_loads
        return loads if self.depth_prescribed else loads / self.start.e_star

    @cached_property
    def contact_coordinate(self) -> Array:
        """Contact coordinate at the start and at each sample, that of zero load in separation."""
        # Equal loads get equal coordinates: the last bit may depend on an element's position.
        load, index = np.unique(np.maximum(self.prescribed, 0.0), return_inverse=True)
        of_force = not self.depth_prescribed
        found = self.start.profile.coordinate_from_load(load, of_force=of_force)
        return np.asarray(found[index])

    @property
    def _normal_coordinate(self) -> Array:
        """Normal coordinate at the start and at each sample, <= 0 in separation."""
        prescribed = self.prescribed
        if self.depth_prescribed != self.over_forces:
            return prescribed
        s, index = np.unique(self.contact_coordinate, return_inverse=True)
        return np.where(prescribed > 0, self.moments.normal(s)[index], np.minimum(prescribed, 0.0))

    @property
    def load_points(self) -> LoadPoints:
        """One straight step to each sample, in normal coordinates and reduced tangential loads."""
        normal, tangential = self.coordinates[:, 1:]
        return LoadPoints(normal, tangential, self.continues, self.step)

    @cached_property
    def at_start(self) -> tuple[tuple[Polyline, ...], Array]:
        """Polylines at the start, and arcs that their segments are part of, see `SavedState`."""
        return self.begin.restored(*self.coordinates[:, 0].tolist())

    @cached_property
    def coordinates(self) -> Array:
        """Normal and tangential coordinate at the start and at each sample, shape (2, n + 1).

        Raises InputError for a tangential force above mu F_N at a sample.
        """
        scale = self.start.friction_coefficient * self.start.e_star
        scale /= 1.0 if self.over_forces else self.start.g_star
        normal, tangential = self._normal_coordinate, self.tangential_loads / scale
        if self.over_forces:
            tangential = self.within_friction(normal, tangential, np.append(-1, self.step))
        else:
            tangential = _at_limit(normal, tangential)
        return np.array([normal, tangential])

    def within_friction(self, normal: Array, tangential: Array, step: Indices) -> Array:
        """Return tangential forces that do not exceed friction.

        Parameters
        ----------
        normal, tangential : reduced forces F_N/E* and F_x/(mu E*) [length^2], shape (n,).
        step : load step of each, -1 at the start.

        Raises
        ------
        InputError : a tangential force above mu F_N, by the index of its load step.
        """
        limit = np.maximum(normal, 0.0)
        beyond = np.flatnonzero(np.abs(tangential) > limit * (1 + ROUNDING))
        if beyond.size:
            at = int(step[beyond[0]])
            place = "history", "tangential", self.tangential_name, at
            raise InputError(
                place if at >= 0 else ("initial_state", "tangential"),
                "no equilibrium: between the point before and this one the force exceeds "
                "friction_coefficient x normal_force; reduce it, or prescribe "
                "tangential_displacement",
            )
        return _at_limit(limit, tangential)


def build(
    start: ContactState,
    normal: tuple[str, Array],
    tangential: tuple[str, Array],
    samples_per_step: int,
    begin: SavedState = UNLOADED,
) -> SampledPath:
    """Return the samples on the straight steps between the given points.

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
    if samples_per_step < 1:
        raise InputError(("history", "samples_per_step"), "must be at least 1")
    normal_points = _checked("normal", *normal)
    tangential_points = _checked("tangential", *tangential)
    sizes = normal_points.size, tangential_points.size
    if sizes[0] != sizes[1] and 1 not in sizes:
        raise InputError(
            ("history", "tangential", tangential[0]),
            f"{sizes[1]} values do not match {sizes[0]} values of {normal[0]}: give one or as many",
        )
    points = np.broadcast_arrays(normal_points, tangential_points)
    first, second = (
        _along(np.append(before, each), samples_per_step)
        for before, each in zip((begin.normal, begin.tangential), points, strict=True)
    )
    return SampledPath(start, normal[0], tangential[0], first, second, samples_per_step, begin)


def _at_limit(limit: Array, tangential: Array) -> Array:
    """Return tangential loads, those at the limit but for rounding errors exactly there."""
    near = np.abs(np.abs(tangential) - limit) <= ROUNDING * limit
    return np.where(near, np.copysign(limit, tangential), tangential)


def _along(points: Array, count: int) -> Array:
    """The first point, and samples that divide the steps to the following ones evenly."""
    if count == 1:
        return points
    start, stop = points[:-1, None], points[1:, None]
    share = np.arange(1, count + 1)
    # Two forces in proportion remain so up to rounding, even where they approach zero.
    samples = start * ((count - share) / count) + stop * (share / count)
    return np.append(points[0], np.where(start == stop, stop, samples))


def _checked(axis: str, name: str, value: Array) -> Array:
    """Points of one load, checked to be finite and one-dimensional."""
    points = np.atleast_1d(value)
    if points.ndim != 1 or points.size == 0:
        raise InputError(("history", axis, name), "must be a list of at least one number")
    require = require_not_negative if name == "normal_force" else require_finite
    require(("history", axis, name), points)
    return points


def saved(line: Polyline, arcs: Array | None) -> list[list[float]]:
    """Return the vertices of a polyline below the load point, as `SavedState` has them."""
    rows = line.vertices[:-1, :NORMAL].tolist()
    if arcs is None:
        return rows
    above = arcs[:, line.load_step[1:]].T.tolist()
    return [row + arc if arc[0] else row for row, arc in zip(rows, above, strict=True)]


def digest(start: ContactState, *controls: str) -> str:
    """Return a digest of an unloaded contact and the names of the prescribed loads."""
    profile = start.profile
    names = profile.parameters or _TABLE
    own = {name: np.asarray(getattr(profile, name)).tolist() for name in names}
    numbers = map(float, (start.e_star, start.g_star, start.friction_coefficient))
    text = repr((profile.kind, own, (*numbers, *controls)))
    return sha256(text.encode()).hexdigest()[:16]
