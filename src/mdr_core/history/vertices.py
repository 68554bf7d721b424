"""Load points, the vertices of a polyline of arcs, and what slipped: the words of `bent`.

Both sums of a vertex are kept as unevaluated sums (high, low) of two doubles.
"""

from dataclasses import dataclass, field
from math import nan
from typing import Final

from mdr_core.typing import Array, Flags

FORWARD: Final = 0
BACKWARD: Final = 1
# level + shift and level - shift.
SIGNS: Final = (1.0, -1.0)

Sum = tuple[float, float]


@dataclass(frozen=True)
class Points:
    """The load points: ends of all steps."""

    coordinate: Array
    level: Array
    other: Array
    shift: Array
    rate: Array
    """d(shift)/d(other) on the step to each; zero where only the shift moves."""
    way: Array
    """How the contact coordinate moves on the step: 1, -1, or 0."""
    goes_on: Flags
    """Steps on the leg of the one before."""


@dataclass(frozen=True)
class Vertex:
    """A vertex of the polyline, and the piece below it."""

    sums: tuple[Sum, Sum]
    growth: tuple[float, float]
    """Of both sums over the piece below; one on the axis."""
    coordinate: float
    """NaN where it is not known."""
    number: int = -1
    rate: float = nan
    """Of the arc below; NaN on a face of the cone."""

    @property
    def level(self) -> float:
        """Half of both sums."""
        (a, b), (c, d) = self.sums
        return max((a + c) + (b + d), 0.0) / 2


@dataclass
class Slips:
    """What slipped, row by row: pieces that the front ran over, and slides of everything."""

    step: list[int] = field(default_factory=list)
    row: list[tuple[float, ...]] = field(default_factory=list)
    """Sign of the sum that slips; how far it is below the start as the front enters and leaves, and
    at the end of the step; of the front's piece its rate, and coordinate and level of both
    ends. Without a piece: a slide."""

    def note(
        self,
        step: int,
        own: int,
        over: tuple[float, float],
        fall: float,
        ends: tuple[Vertex, Vertex] | None,
    ) -> None:
        """Write a row, if anything slips; `ends` are the upper and the lower one of the piece."""
        if not over[1] > over[0]:
            return
        piece = (nan,) * 5
        if ends is not None:
            upper, lower = ends
            piece = upper.rate, upper.coordinate, upper.level, lower.coordinate, lower.level
        self.step.append(step)
        self.row.append((SIGNS[own], *over, fall, *piece))


def excess(a: Sum, b: Sum) -> float:
    """What one sum exceeds another by."""
    return (a[0] - b[0]) + (a[1] - b[1])


def sum_of(a: float, b: float) -> Sum:
    """a + b and its rounding error, exactly (Knuth's two-sum)."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def moved_by(start: Sum, to: Sum, away: Sum) -> Sum:
    """start + (to - away), with the digits of a difference that is small against both."""
    total, first = sum_of(start[0], to[0])
    total, second = sum_of(total, -away[0])
    return total, first + second + start[1] + to[1] - away[1]


def growth_over(upper: Vertex, lower: Vertex) -> tuple[float, float]:
    """What both sums of a vertex exceed those of another by."""
    return (
        excess(upper.sums[FORWARD], lower.sums[FORWARD]),
        excess(upper.sums[BACKWARD], lower.sums[BACKWARD]),
    )
