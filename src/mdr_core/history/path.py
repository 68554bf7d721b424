"""The way of the load: from the points that are given to the steps that are walked.

A step is exact where it is straight in depth and displacement, or in normal and tangential force.
If one quantity of each pair is controlled and both change, the way is curved in either plane, and
it is followed by shorter steps, even in the contact coordinate, in which all curves are smooth.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.errors import InputError
from mdr_core.foundation import coordinate_from_depth, coordinate_from_force
from mdr_core.history.arcs import Plane
from mdr_core.history.vertices import Points
from mdr_core.lazy import cached_property
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Indices

NORMAL: Final = ("indentation_depth", "normal_force")
TANGENTIAL: Final = ("tangential_displacement", "tangential_force")
# A force on the brink of sliding may exceed it by its rounding.
_ROUNDING: Final = 4e-16
# Parts of what is smaller have no digits.
_LEAST: Final = 1e-290


@dataclass(frozen=True)
class Path:
    """The samples of a history, in the quantities that are controlled."""

    normal_name: str
    tangential_name: str
    normal: Array
    """Depth or normal force at each sample."""
    tangential: Array
    """Displacement or tangential force at each sample."""
    per_step: int

    @cached_property
    def step(self) -> Indices:
        """Leg to which each sample belongs: that towards the given point of this index."""
        return np.repeat(np.arange(self.normal.size // self.per_step), self.per_step)

    @property
    def goes_on(self) -> Flags:
        """Samples on the same leg as the one before."""
        on = np.ones((self.normal.size // self.per_step, self.per_step), dtype=bool)
        on[:, 0] = False
        return on.ravel()

    @property
    def by_force(self) -> bool:
        """Levels are forces: the tangential force is controlled."""
        return self.tangential_name == "tangential_force"

    @property
    def curved(self) -> Flags:
        """Samples towards which the way is straight in neither plane."""
        if self.by_force == (self.normal_name == "normal_force"):
            return np.zeros(self.normal.shape, dtype=bool)
        return _moves(self.normal) & _moves(self.tangential)


def _moves(values: Array) -> Flags:
    """Where a sample differs from the one before, the first from zero."""
    return np.asarray(np.diff(values, prepend=0.0) != 0)


def build(
    normal: tuple[str, ArrayLike], tangential: tuple[str, ArrayLike], samples_per_step: int
) -> Path:
    """Return the samples on the straight legs between the given points, from the unloaded state.

    Raises
    ------
    InputError : lengths that differ and are not 1, no points, numbers that are not finite, or
        less than one sample a step.
    """
    if samples_per_step < 1:
        raise InputError(("history", "samples_per_step"), "must be at least 1")
    pressed, pushed = _checked("normal", *normal), _checked("tangential", *tangential)
    if pressed.size != pushed.size and 1 not in {pressed.size, pushed.size}:
        raise InputError(
            ("history", "tangential", tangential[0]),
            f"{pushed.size} values do not go with {pressed.size} of {normal[0]}",
        )
    first, second = np.broadcast_arrays(pressed, pushed)
    share = np.arange(1, samples_per_step + 1) / samples_per_step
    samples = _along(first, share), _along(second, share)
    return Path(normal[0], tangential[0], *samples, samples_per_step)


def _along(points: Array, share: Array) -> Array:
    if share.size == 1:
        return points.copy()
    start = np.append(0.0, points[:-1])
    samples = start[:, None] + (points - start)[:, None] * share
    # The last sample of a leg is its point, to the last digit.
    samples[:, -1] = points
    return np.asarray(samples.ravel())


def _checked(axis: str, name: str, value: ArrayLike) -> Array:
    points = np.atleast_1d(np.asarray(value, dtype=float))
    if points.ndim != 1 or points.size == 0:
        raise InputError(("history", axis, name), "at least one point is needed, in one row")
    if not np.isfinite(points).all() or (name == "normal_force" and points.min() < 0):
        bad = ~np.isfinite(points) | ((points < 0) & (name == "normal_force"))
        sign = " and not negative" if name == "normal_force" else ""
        raise InputError(
            ("history", axis, name, int(np.flatnonzero(bad)[0])), f"must be finite{sign}"
        )
    return points


@dataclass(frozen=True)
class Steps:
    """What is walked: levels and shifts."""

    level: Array
    shift: Array
    goes_on: Flags
    """Steps on the straight line of the one before."""


def steps(path: Path, profile: Profile, e_star: float, scale: float) -> Steps:
    """Return the steps of a path that is straight: one to each sample.

    `scale` divides the tangential quantity: mu E*/G* for displacements, mu E* for forces.

    Raises
    ------
    InputError : a tangential force that no equilibrium carries, at or before a point; a tangential
        load that leaves the range of doubles over its scale.
    """
    level = _levels(path, profile, _divided(path, e_star))
    shift = _shift(path, scale)
    if path.by_force:
        shift = _carried(path, level, shift, None)
    return Steps(level, shift, path.goes_on)


def points(path: Path, profile: Profile, e_star: float, scale: float) -> tuple[Points, Indices]:
    """Return the load points of a path with curved legs, and which of them are the samples.

    Further points are where a leg becomes as steep as the cone: between any two both sums of the
    load point only grow, or only fall. Arguments and errors as of `steps`.
    """
    plane, other = Plane(profile, path.by_force), _divided(path, e_star)
    shift = _shift(path, scale)
    s, rate = _find(path, profile, other), _rates(path, other, shift)
    before = np.append(profile.first_coordinate, s[:-1])
    turn = plane.radius_on_the_cone(rate)
    ends = np.sort(np.stack([before, s]), axis=0)
    low, high = profile.contact_radius(ends)
    turns = np.flatnonzero((low < turn) & (turn < high))
    at = profile.coordinate_from_radius(turn[turns])
    inside = (ends[0][turns] < at) & (at < ends[1][turns])
    turns, at = turns[inside], at[inside]
    met = plane.other(at)
    begun = np.append(0.0, other[:-1])[turns], np.append(0.0, shift[:-1])[turns]
    last = np.arange(s.size) + np.searchsorted(turns, np.arange(s.size), side="right")
    s, other = np.insert(s, turns, at), np.insert(other, turns, met)
    shift = np.insert(shift, turns, begun[1] + rate[turns] * (met - begun[0]))
    level = np.where(other > 0, plane.level(s), np.minimum(other, 0.0))
    goes_on = np.insert(path.goes_on, turns, path.goes_on[turns])
    goes_on[last[turns]] = True
    if path.by_force:
        shift = _carried(path, level, shift, last)
    rate = np.insert(rate, turns, rate[turns])
    way = np.sign(np.diff(s, prepend=profile.first_coordinate))
    return Points(s, level, other, shift, rate, way, goes_on), last


def _shift(path: Path, scale: float) -> Array:
    """The tangential quantity at each sample, over its scale."""
    with np.errstate(over="ignore", under="ignore"):
        shift = path.tangential / scale
        size = np.abs(shift[path.per_step - 1 :: path.per_step])
    given = path.tangential[path.per_step - 1 :: path.per_step]
    bad = (given != 0) & ~((size >= _LEAST) & (size <= 1 / _LEAST))
    if bad.any():
        raise InputError(
            ("history", "tangential", path.tangential_name, int(np.flatnonzero(bad)[0])),
            "leaves the range of double precision, over friction_coefficient and modulus",
        )
    return np.asarray(shift)


def _divided(path: Path, e_star: float) -> Array:
    by_depth = path.normal_name == "indentation_depth"
    return path.normal if by_depth else path.normal / e_star


def _rates(path: Path, other: Array, shift: Array) -> Array:
    """d(shift)/d(other) on the leg of each sample; zero where only the shift moves."""
    rise, moved = (
        np.diff(values[path.per_step - 1 :: path.per_step], prepend=0.0)
        for values in (other, shift)
    )
    rate = np.where(rise == 0, 0.0, moved / np.where(rise == 0, 1.0, rise))
    return np.repeat(rate, path.per_step)


def _find(path: Path, profile: Profile, normal: Array) -> Array:
    """Contact coordinate; zero load's in a gap."""
    load = np.maximum(normal, 0.0)
    if path.normal_name == "indentation_depth":
        return coordinate_from_depth(profile, load)
    return coordinate_from_force(profile, load)


def _levels(path: Path, profile: Profile, normal: Array) -> Array:
    by_depth = path.normal_name == "indentation_depth"
    if by_depth != path.by_force:
        return normal
    s = _find(path, profile, normal)
    if by_depth:
        return np.where(normal > 0, profile.reduced_force(s), np.minimum(normal, 0.0))
    return profile.depth(s)


def _carried(path: Path, level: Array, shift: Array, last: Indices | None) -> Array:
    """The shifts, refused where they exceed what friction carries."""
    limit = np.maximum(level, 0.0)
    beyond = np.abs(shift) > limit * (1 + _ROUNDING)
    if beyond.any():
        first = int(np.flatnonzero(beyond)[0])
        sample = first if last is None else int(np.searchsorted(last, first))
        raise InputError(
            ("history", "tangential", path.tangential_name, int(path.step[sample])),
            "no equilibrium: on the way to this point the force exceeds "
            "friction_coefficient x normal_force",
        )
    return np.clip(shift, -limit, limit)
