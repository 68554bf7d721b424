"""The equivalent one-dimensional problem: where the springs touch, and what they carry."""

from collections.abc import Callable
from typing import Final

import numpy as np

from mdr_core.checks import first_index
from mdr_core.errors import DefectError, InputError
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags

Function = Callable[[Array], Array]

_STEPS: Final = 200
# Newton's step at which the next error is below rounding: it converges quadratically.
_LAST_STEP: Final = 1e-10
# The same for steps without a slope, which come nearer only by a factor.
_BLIND_STEP: Final = 1e-14
# So near to its goal, in log, a function is no longer on the other side of a near jump.
_NEAR: Final = 1e-3
# Where a bracket this narrow, relative to its place, holds no further double.
_ADJACENT: Final = 2.0**-51
_STRIDE: Final = 16.0
_LEAP: Final = 30.0
_LARGEST: Final = 1e307


def coordinate_from_depth(profile: Profile, indentation_depth: Array) -> Array:
    """Return the contact coordinate at which g(a) equals the depth.

    Source: mdr-5, Eqs. (5.7), (5.59); notes, §1.

    Raises
    ------
    InputError : the profile ends before this depth is reached.
    """
    closed = profile.coordinate_from_depth(indentation_depth)
    if closed is not None:
        return closed
    name = "indentation_depth"
    return _inverse(profile, profile.depth, profile.depth_slope, indentation_depth, name)


def coordinate_from_force(profile: Profile, reduced_force: Array) -> Array:
    """Return the contact coordinate at which F_N/E* has the given value [length^2].

    Source: mdr-5, Eqs. (5.14), (5.61); notes, §1: dF_N/da = 2 E* a g'(a).

    Raises
    ------
    InputError : the profile ends before this force is reached.
    """
    closed = profile.coordinate_from_reduced_force(reduced_force)
    if closed is not None:
        return closed
    slope = force_slope(profile)
    return _inverse(profile, profile.reduced_force, slope, reduced_force, "normal_force")


def force_slope(profile: Profile) -> Function:
    """Return d(F_N/E*)/ds = 2 a d'(s) as a function of the contact coordinate s.

    Source: notes, §1.
    """
    return lambda s: 2 * profile.contact_radius(s) * profile.depth_slope(s)


def coordinate_from_radius(profile: Profile, contact_radius: Array) -> Array:
    """Return the contact coordinate of a given contact radius.

    Raises
    ------
    InputError : the radius lies beyond the profile's end, or the profile fixes it itself.
    """
    return profile.coordinate_from_radius(_within(profile, contact_radius, "contact_radius"))


def _within(profile: Profile, contact_radius: Array, name: str) -> Array:
    """The radius, refused where it passes the profile's end."""
    if not np.all(np.isinf(profile.domain)):
        _refuse(contact_radius > profile.domain, profile, name)
    return contact_radius


def _refuse(outside: Flags, profile: Profile, name: str) -> None:
    if outside.any():
        domain = np.broadcast_to(profile.domain, outside.shape)[outside][0]
        raise InputError(
            ("load", name, *first_index(outside)),
            f"the contact would reach past radius {domain}, where the profile ends "
            "or ceases to be admissible",
            outside,
        )


def _inverse(
    profile: Profile, function: Function, slope: Function, target: Array, name: str
) -> Array:
    """Solve function(s) = target for a contact coordinate s, from the profile's own scale."""
    end, shape = profile.last_coordinate, np.broadcast_shapes(target.shape, np.shape(profile.scale))
    if end is not None:
        _refuse(np.asarray(target > function(np.asarray(end))), profile, name)
    low = np.full(shape, profile.first_coordinate)
    high = np.full(shape, np.inf if end is None else end)
    start = np.minimum(np.broadcast_to(profile.scale, shape), high)

    def log_slope(s: Array, value: Array) -> Array:
        return s * slope(s) / value

    return invert(function, log_slope, target, start, low, high, profile.kind)


def invert(
    function: Function,
    log_slope: Callable[[Array, Array], Array],
    target: Array,
    start: Array,
    low: Array,
    high: Array,
    name: str,
) -> Array:
    """Solve function(s) = target >= 0 for an increasing function, relatively accurate.

    Newton's method in log(s) and log(function), which all profiles make nearly straight;
    `log_slope(s, function(s))` is its derivative there. [low, high] brackets the root, the signs
    seen narrow it, and a step that leaves it is replaced by its middle. Where the target is
    zero the answer is `low`; where the function leaves the range of doubles it is NaN.
    """
    positive = target > 0
    goal = np.where(positive, target, 1.0)
    s, nothing = start, low
    done, settling = ~positive, np.zeros_like(positive)
    for _ in range(_STEPS):
        with np.errstate(divide="ignore", invalid="ignore", over="ignore", under="ignore"):
            value = function(s)
            miss = np.log(goal / value)
            slope = log_slope(s, value)
            # A slope that leaves the range of doubles says nothing but the direction.
            known = (slope > 0) & (slope < np.inf)
            step = np.where(known, miss / slope, miss)
            # Where the slope all but vanishes the step says no more than the direction.
            proposed = s * np.exp(np.clip(step, -_LEAP, _LEAP))
        low = np.where(value < goal, s, low)
        high = np.where(value > goal, s, high)
        # A short step alone may only say that the function all but jumps here.
        short = np.abs(step) <= np.where(known, _LAST_STEP, _BLIND_STEP)
        short &= np.abs(miss) <= _NEAR
        # Where the root leaves the range of doubles, infinity or zero say so to the caller.
        last = short | ~((s > 1 / _LARGEST) & (s < _LARGEST))
        usable = ((proposed > low) & (proposed < high)) | last
        moved = proposed if usable.all() else np.where(usable, proposed, _middle(low, high))
        moved = np.where(moved < _LARGEST, np.where(moved > 1 / _LARGEST, moved, 0.0), np.inf)
        # What is done stays: no root of a sweep depends on how long the others take.
        s = np.where(done, s, moved)
        # One step more than the criterion asks: at a kink the last slope may be the other side's.
        done = done | settling
        if done.all():
            break
        settling = last | (high - low <= np.where(high < np.inf, _ADJACENT * high, 0.0))
    root = np.where(positive, np.maximum(s, nothing), nothing)
    if done.all():
        return root
    if known[~done].any():
        raise DefectError(f"the inverse of a {name} did not converge")
    # Value or slope left the range of doubles on the way: no number answers that.
    return np.where(done, root, np.nan)


def _middle(low: Array, high: Array) -> Array:
    """Geometric middle of the bracket, or a stride where it is still open."""
    with np.errstate(invalid="ignore"):
        middle = np.sqrt(low) * np.sqrt(high)
    return np.where(low == 0, high / _STRIDE, np.where(np.isinf(high), low * _STRIDE, middle))
