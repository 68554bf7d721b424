"""The annulus c <= x <= a over which a stress kernel is integrated."""

from typing import Any, NamedTuple

import numpy as np

from mdr_core.typing import Array, Flags, Indices, Parameter


class InnerEnd(NamedTuple):
    """Inner end c of an annulus, as a width and as a radius."""

    width: Array
    """Difference of the coordinates of a and c, free of cancellation."""
    radius: Array
    """c [length], so that c - r is exact next to it."""
    coordinate: Array | None = None
    """c in the coordinate, where points are given in it as well; None if they are radii."""


class Annulus(NamedTuple):
    """Ends of the annulus c <= x <= a, each in the forms that are free of cancellation.

    The coordinate is the contact coordinate of a profile, the radius, or, beyond a break b,
    sqrt(x^2 - b^2), as the function that takes the annulus states. The ends are single numbers, or
    arrays of shape (1,) or (m,), with m the number of points.
    """

    outer: Array
    """Coordinate of a."""
    inner: InnerEnd | None = None
    """None for c = 0, the whole contact."""
    outer_radius: Array | None = None
    """a [length] if the radius is prescribed, so that a - r is exact; None if it is not."""

    def at(self, chosen: Flags | Indices) -> "Annulus":
        """Return the annuli of the chosen points."""

        def pick(part: Any) -> Any:
            return part if part is None or part.size == 1 else part[chosen]

        inner = None if self.inner is None else InnerEnd(*map(pick, self.inner))
        return Annulus(pick(self.outer), inner, pick(self.outer_radius))


def inverse_hypot(x: Array, b: Parameter) -> Array:
    """Return sqrt(x^2 - b^2), zero for x < b, accurate next to b.

    >>> inverse_hypot(np.array([0.5, 5.0]), 3.0).tolist()
    [0.0, 4.0]
    """
    return np.sqrt(np.maximum(x - b, 0.0) * (x + b))


def root_step(annulus: Annulus, r: Array) -> Array:
    """Return sqrt(a^2 - r^2) - sqrt(c^2 - r^2), the second term for r < c only [length]."""
    a, inner, _ = annulus
    root_a = np.sqrt((a - r) * (a + r))
    if inner is None:
        return root_a
    width, c, _ = inner
    root_c = inverse_hypot(c, r)
    return np.where(c > r, width * (a + c) / (root_a + root_c), root_a)


def log_ratio(annulus: Annulus, r: Array) -> Array:
    """Return arccosh(a/r) - arccosh(c/r) [1], also at r = 0."""
    a, inner, _ = annulus
    if inner is None:
        low, root_low, step = r, np.zeros(1), (a - r) + np.sqrt((a - r) * (a + r))
    else:
        low = np.maximum(r, inner.radius)
        root_low = np.sqrt((low - r) * (low + r))
        step = np.minimum(a - r, inner.width) + root_step(annulus, r)
    with np.errstate(divide="ignore"):
        return np.log1p(step / (low + root_low))
