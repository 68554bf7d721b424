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
from mdr_core.lazy import cached_property
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Indices

NORMAL: Final = ("indentation_depth", "normal_force")
TANGENTIAL: Final = ("tangential_displacement", "tangential_force")
# A force on the brink of sliding may exceed it by its rounding.
_ROUNDING: Final = 4e-16


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
    last: Indices | None
    """Index of the step that ends at each sample; none given where every step ends at one."""

    def samples(self, part: slice) -> tuple[slice, Indices | slice]:
        """Samples that a block of steps ends at, and at which of its steps."""
        if self.last is None:
            return part, slice(None)
        samples = slice(*np.searchsorted(self.last, [part.start, part.stop]))
        return samples, self.last[samples] - part.start


def steps(path: Path, profile: Profile, e_star: float, scale: float, pieces: int) -> Steps:
    """Return the steps of a path, curved stretches in so many pieces.

    `scale` divides the tangential quantity: mu E*/G* for displacements, mu E* for forces.

    Raises
    ------
    InputError : a tangential force that no equilibrium carries, at or before a point.
    """
    divided = path.normal if path.normal_name == "indentation_depth" else path.normal / e_star
    last: Indices | None
    curved = path.curved
    if curved.any():
        normal, tangential, goes_on, last = _bent(path, profile, divided, curved, pieces)
    else:
        normal, tangential, goes_on = divided, path.tangential, path.goes_on
        last = None
    level = _levels(path, profile, normal)
    shift = tangential / scale
    if path.by_force:
        shift = _carried(path, level, shift, last)
    return Steps(level, shift, goes_on, last)


def _bent(
    path: Path, profile: Profile, divided: Array, curved: Flags, pieces: int
) -> tuple[Array, Array, Flags, Indices]:
    """Normal and tangential quantity, what goes on and the last steps, with curved stretches."""
    counts = np.where(curved, pieces, 1)
    normal, tangential = np.repeat(divided, counts), np.repeat(path.tangential, counts)
    inner = np.repeat(curved, counts)
    goes_on = np.repeat(path.goes_on, counts) & ~inner
    # What follows a chord begins a line of its own.
    goes_on[1:] &= ~inner[:-1]
    shares = _shares(path, profile, divided, curved, pieces)
    for values, samples in ((normal, divided), (tangential, path.tangential)):
        start = np.append(0.0, samples[:-1])[curved]
        ends = samples[curved]
        between = start[:, None] + (ends - start)[:, None] * shares
        between[:, -1] = ends
        values[inner] = between.ravel()
    return normal, tangential, goes_on, np.cumsum(counts) - 1


def _find(path: Path, profile: Profile, normal: Array) -> Array:
    """Contact coordinate; zero load's in a gap."""
    load = np.maximum(normal, 0.0)
    if path.normal_name == "indentation_depth":
        return coordinate_from_depth(profile, load)
    return coordinate_from_force(profile, load)


def _shares(path: Path, profile: Profile, divided: Array, curved: Flags, pieces: int) -> Array:
    """Shares of each curved stretch at which the contact coordinate has gone even steps."""
    start, end = np.append(0.0, divided[:-1])[curved], divided[curved]
    ends = _find(path, profile, np.stack([start, end]))
    t = np.arange(1, pieces + 1) / pieces
    s = ends[0][:, None] + (ends[1] - ends[0])[:, None] * t
    by_depth = path.normal_name == "indentation_depth"
    values = profile.depth(s) if by_depth else profile.reduced_force(s)
    return np.asarray(np.clip((values - start[:, None]) / (end - start)[:, None], 0.0, 1.0))


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
