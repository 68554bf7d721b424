"""Bounds of inputs and of results, cheap enough for a sweep over millions of cases."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from decimal import Decimal
from math import inf
from numbers import Real
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.doubles import LARGEST
from mdr_core.elementwise import some
from mdr_core.errors import InputError
from mdr_core.typing import Array, Flags

# Sentences about values, which the service uses as well.
BODIES: Final = 'exactly two bodies are needed, of which one can be "rigid"'
FINITE: Final = "must be finite"
POSITIVE: Final = "must be positive"
_NEGATIVE: Final = {
    "indentation_depth": ": it counts from first contact, give 0 before it",
    "normal_force": ": compression is positive",
    "normal_velocity": ": approach is positive",
}
# Arrays of more values exceed the memory of most machines.
_LARGEST_COUNT: Final = 10**9
TIGHTEST, LOOSEST = 1e-13, 1e-3
"""Bounds of `rtol`: rounding errors of sums, and an error visible in a plot."""
LEAST_CHANGE, MOST_CHANGE = 1e-4, 0.1
"""Bounds of `holds_within`: from the largest on, its limits, of first order, are off by a third."""
UNRESOLVED: Final = 0.25
"""Relative error above which a result is rejected."""


def require_type(name: str, value: object, types: Any, needed: str) -> None:
    """Raise InputError unless a value is of one of the types.

    Parameters
    ----------
    name : name of the argument.
    value : the argument; it is also rejected if it has an attribute `unusable` with a reason.
    types : a type, or several.
    needed : description of these types in the message.
    """
    if reason := getattr(value, "unusable", ""):
        raise InputError((name,), reason)
    if not isinstance(value, types):
        raise InputError((name,), f"must be {needed}, not {type(value).__name__}")


def as_numbers(path: tuple[str | int, ...], values: float | ArrayLike) -> Array:
    """Return numbers as an array or a single double, or raise InputError at the path."""
    numbers: Any = None
    if isinstance(values, float):
        numbers = np.float64(values)
    else:
        masked = np.ma.getmaskarray(values) if isinstance(values, np.ma.MaskedArray) else None
        if masked is not None and masked.any():
            # Conversion to an array would expose the number under the mask.
            detail = "is masked: leave it out, or give a number"
            raise InputError((*path, *first_index(masked)), detail)
        with suppress(TypeError, ValueError, OverflowError):
            array = np.asarray(values)
            # NumPy would convert text and dates as well, and flags between numbers of a list.
            plain = array.dtype.kind in "fiu" and (
                not isinstance(values, (list, tuple)) or {float, int}.issuperset(map(type, values))
            )
            if plain or (array.dtype.kind in "fiuO" and not _odd(values)):
                numbers = array.astype(float, copy=False)
    if numbers is None:
        odd = _odd(values)
        # The only numbers that are not converted are integers beyond double precision.
        detail = f"must be a number or an array of numbers, not {odd}" if odd else FINITE
        raise InputError(path, detail)
    return numbers[()]


def _odd(values: Any) -> str:
    """Return the type of the first value that is not a number, empty if there is none."""
    with suppress(ValueError):
        for value in np.array(values, dtype=object).flat:
            if isinstance(value, bool) or not isinstance(value, Real | Decimal):
                return type(value).__name__
        return ""
    return type(values).__name__


def extremes(values: float | ArrayLike) -> tuple[float, float]:
    """Return the smallest and the largest value: NaN if one is NaN or there is none."""
    if isinstance(values, (int, float)):
        # A single number needs no reduction; NumPy's doubles are floats as well.
        return float(values), float(values)
    array = np.asarray(values, dtype=float)
    if array.size == 0:
        return float("nan"), float("nan")
    return float(array.min()), float(array.max())


def first_index(bad: Flags) -> tuple[int, ...]:
    """Return the index of the first true element, empty where `bad` has no dimension."""
    return (int(np.flatnonzero(bad)[0]),) if bad.ndim else ()


def reject(path: tuple[str | int, ...], given: Array, bad: Flags, detail: str) -> None:
    """Raise InputError at the first of the given numbers that is bad.

    Parameters
    ----------
    path, given : the argument and its numbers.
    bad, detail : True for numbers that are bad, and the reason.
    """
    if some(bad):
        raise InputError((*path, *(first_index(bad) if given.ndim else ())), detail, bad)


def only_one(
    path: tuple[str | int, ...], given: Mapping[str, ArrayLike | None]
) -> tuple[str, Array]:
    """Return the name and the values of the only quantity that is given.

    Raises InputError at the path for none or several of them, or without values.
    """
    named = [(name, values) for name, values in given.items() if values is not None]
    if len(named) != 1:
        raise InputError(path, f"exactly one of {', '.join(given)} is needed")
    name, given_values = named[0]
    values = as_numbers((*path, name), given_values)
    if not values.size:
        raise InputError((*path, name), "at least one value is needed")
    return name, values


def single(path: tuple[str | int, ...], value: ArrayLike) -> float:
    """Return a single number as a double, or raise InputError at the path."""
    numbers = as_numbers(path, value)
    if numbers.ndim:
        raise InputError(path, "must be a single number")
    return float(numbers)


def as_positive(path: tuple[str | int, ...], value: Any) -> Any:
    """Return positive and finite numbers, a list as an array, or raise InputError at the path.

    NumPy's other numbers become doubles: products of them would overflow or have fewer digits.
    """
    numbers = value if isinstance(value, float) else as_numbers(path, value)
    low, high = extremes(numbers)
    if not (low > 0 and high < inf):
        raise InputError(path, POSITIVE if low <= 0 else FINITE)
    return value if isinstance(value, float | int) else numbers


def require_single_positive(path: tuple[str | int, ...], value: float) -> None:
    """Raise InputError at the path unless the value is one number, positive and finite."""
    as_positive(path, single(path, value))


def require_whole(path: tuple[str | int, ...], value: object) -> None:
    """Raise InputError at the path unless the value is a whole number."""
    if (
        isinstance(value, bool)
        or not isinstance(value, int | np.integer)
        or not -_LARGEST_COUNT <= value <= _LARGEST_COUNT
    ):
        raise InputError(path, f"must be a whole number, at most {_LARGEST_COUNT:.0e}")


def not_negative(name: str) -> str:
    """Return the sentence about a negative value of a field."""
    return f"must not be negative{_NEGATIVE.get(name, '')}"


def require_not_negative(path: tuple[str | int, ...], values: Array) -> None:
    """Raise InputError at the first of the values that is negative or not finite."""
    reject(path, values, values < 0, not_negative(str(path[-1])))
    require_finite(path, values)


def require_finite(path: tuple[str | int, ...], values: Array) -> None:
    """Raise InputError at the first of the values that is not finite."""
    reject(path, values, ~np.isfinite(values), FINITE)


def require_list(path: tuple[str | int, ...], values: Array) -> None:
    """Raise InputError for values in rows and columns."""
    if values.ndim != 1:
        shape = " x ".join(map(str, values.shape)) or "one number"
        raise InputError(path, f"must be a list of numbers, not {shape}")


def as_curve(places: str, **given: ArrayLike) -> tuple[Array, Array]:
    """Return the two named lists of a measured curve as arrays of equal length.

    Raises InputError for numbers that are not finite, for values in rows and columns, and for lists
    of different lengths; `places` is the word for the first list in the message.
    """
    first, second = (np.atleast_1d(as_numbers((name,), given[name])) for name in given)
    for name, values in zip(given, (first, second), strict=True):
        require_list((name,), values)
        require_finite((name,), values)
    if first.shape != second.shape:
        detail = f"has {second.size} values for {first.size} {places}"
        raise InputError(([*given][1],), detail)
    return first, second


def common_shape(
    path: tuple[str | int, ...], given: Array, others: str, *values: Any
) -> tuple[int, ...]:
    """Return the shape to which loads and other values broadcast, or raise InputError at the path.

    `others` is the word for the other values.
    """
    shapes = [given.shape, *(getattr(value, "shape", ()) for value in values)]
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        own, *known = [" x ".join(map(str, shape)) for shape in shapes]
        listed = " and ".join(filter(None, known))
        detail = f"the number of values, {own or 1}, does not agree with {others}, {listed}"
        raise InputError(path, f"{detail}: give one, or as many") from None


def require_representable(path: tuple[str | int, ...], used: Flags, *results: Array) -> None:
    """Raise InputError at the first load whose results are not representable as doubles.

    `path` leads to the load; `used` marks the loads that are not zero, for which the results must
    be positive.
    """
    bad = np.zeros(used.shape, dtype=bool)
    for values in results:
        bad |= used & ~((values > 1 / LARGEST) & (values < LARGEST))
    detail = (
        "the contact under this load leaves the range of double precision: change the load, or the "
        "units"
    )
    reject(path, bad, bad, detail)


def require_inside(
    path: tuple[str, ...], outside: Flags, profile: Any, cause: str = "load"
) -> None:
    """Raise InputError at the first load under which the contact would exceed the profile.

    Parameters
    ----------
    path : place of the loads in the input.
    outside : true for the loads that are too large.
    profile : the profile, or a limit with a `domain` and the words for its `end`.
    cause : word for the loads in the message.
    """
    if some(outside):
        end = np.broadcast_to(profile.domain, outside.shape)[outside].flat[0]
        reason, remedy = profile.end
        detail = f"the contact would extend beyond radius {end:.12g}, {reason}: reduce the {cause}"
        raise InputError((*path, *first_index(outside)), f"{detail}, or {remedy}", outside)


def require_poissons_ratio(path: tuple[str | int, ...], value: float) -> None:
    """Raise InputError at the path unless -1 < nu <= 1/2."""
    if not -1 < single(path, value) <= 0.5:
        raise InputError(path, "must be greater than -1 and at most 0.5")


def require_tolerance(rtol: float, tightest: float = TIGHTEST) -> None:
    """Raise InputError unless `rtol` is between the tightest accuracy and 1e-3."""
    if not tightest <= single(("rtol",), rtol) <= LOOSEST:
        raise InputError(("rtol",), f"must lie from {tightest} to {LOOSEST}")


def require_single_profile(swept: Sequence[str]) -> None:
    """Raise InputError if parameters of a profile are arrays over the cases of a sweep."""
    if swept:
        raise InputError(("profile", swept[0]), "must be a single number: solve each case alone")


def checked_radii(radius: ArrayLike, end: float = inf) -> Array:
    """Return the radii as an array (m,).

    Raises InputError if there is none, or one that is negative, not finite or beyond the end.
    """
    r = np.atleast_1d(as_numbers(("radius",), radius))
    if not r.size:
        raise InputError(("radius",), "at least one radius is needed")
    require_not_negative(("radius",), r)
    if end < inf and r.max() > end:
        detail = f"the profile ends at radius {end:.12g}"
        raise InputError(("radius", *first_index(r > end)), detail)
    return r
