"""The annulus c <= x <= a over which a stress kernel is integrated."""

from typing import Any, NamedTuple

import numpy as np

from mdr_core.elementwise import some
from mdr_core.typing import Array, Flags, Indices, Parameter


class Annulus(NamedTuple):
    """Ends of the annulus c <= x <= a, free of cancellation.

    The coordinate is the contact coordinate of a profile, the radius, or, beyond a break b,
    sqrt(x^2 - b^2), as the function that takes the annulus states. The ends are single numbers, or
    arrays of shape (1,) or (m,), with m the number of points.
    """

    outer: Array
    """Coordinate of a."""
    width: Array
    """Difference of the coordinates of a and c."""
    inner: Array
    """c [length], so that c - r is exact next to it; zero for the whole contact."""
    edge: Array | None = None
    """a [length] where it is exact, so that a - r is; None where the coordinate is."""

    coordinate: Array | None = None
    """Coordinate of c, which has more digits next to a break; None if it is to follow from c."""

    def at(self, chosen: Flags | Indices) -> "Annulus":
        """Return the annuli of the chosen points."""
        parts: Any = self
        return Annulus(*(part if np.size(part) == 1 else part[chosen] for part in parts))


def whole(outer: Array, edge: Array | None = None) -> Annulus:
    """Return the annulus that is the whole contact; parameters: see `Annulus`."""
    return Annulus(outer, outer, 0 * outer, edge)


def inverse_hypot(x: Array, b: Parameter) -> Array:
    """Return sqrt(x^2 - b^2), zero for x < b, accurate next to b.

    >>> inverse_hypot(np.array([0.5, 5.0]), 3.0).tolist()
    [0.0, 4.0]
    """
    return np.sqrt(np.maximum(x - b, 0.0) * (x + b))


def root_step(annulus: Annulus, r: Array) -> Array:
    """Return sqrt(a^2 - r^2) - sqrt(c^2 - r^2), the second term for r < c only [length]."""
    a, width, c, *_ = annulus
    root_a = np.sqrt((a - r) * (a + r))
    within = c > r
    if not some(within):
        return root_a
    return np.where(within, width * (a + c) / (root_a + inverse_hypot(c, r)), root_a)


def log_ratio(annulus: Annulus, r: Array) -> Array:
    """Return arccosh(a/r) - arccosh(c/r) [1], also at r = 0."""
    a, width, c, *_ = annulus
    low = np.maximum(r, c)
    step = np.minimum(a - r, width) + root_step(annulus, r)
    with np.errstate(divide="ignore"):
        return np.log1p(step / (low + inverse_hypot(low, r)))
