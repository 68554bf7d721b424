"""The annulus c <= x <= a over which a stress kernel is integrated."""

from typing import Any, NamedTuple

from mdr_core.typing import Array, Flags, Indices


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
