"""Tables of the bank, the bodies they sample, and their contacts."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

Profile = dict[str, Any]


@dataclass(frozen=True)
class TableCase:
    """A table; `truth` is the smooth body it samples, if the table is fine enough."""

    name: str
    profile: Profile
    radii: tuple[float, ...]
    truth: Profile | None = None


def _table(
    shape: Callable[[float], float],
    r: list[float],
    interpolation: str = "cubic",
    breaks: tuple[float, ...] = (),
) -> Profile:
    return {
        "kind": "tabulated",
        "r": r,
        "f": [shape(x) for x in r],
        "interpolation": interpolation,
        "breaks": list(breaks),
    }


def uniform(end: float, count: int, start: float = 0.0) -> list[float]:
    """`count` points from `start` to `end`, both included."""
    return [start + (end - start) * i / (count - 1) for i in range(count - 1)] + [end]


def _sphere(r: float) -> float:
    return r * r / (1 + sqrt(1 - r * r))


def _rounded(r: float) -> float:
    return (r - 0.6) ** 2 / 4 if r > 0.6 else 0.0


def _truncated(r: float) -> float:
    return 0.3 * (r - 0.5) if r > 0.5 else 0.0


def table_contacts() -> Iterator[TableCase]:
    """All tables, of unit size: scales are covered elsewhere."""
    sphere = {"kind": "sphere", "radius": 1.0}
    yield TableCase("sphere200", _table(_sphere, uniform(0.6, 200)), (0.5, 0.02, 0.001), sphere)
    yield TableCase("power1.5", _table(lambda r: r**1.5, uniform(1.0, 60)), (0.8, 0.1))
    rounded = [0.0, 0.3, *uniform(1.2, 60, 0.6)]
    punch = {"kind": "rounded_punch", "flat_radius": 0.6, "rounding_radius": 2.0}
    yield TableCase("rounded-punch", _table(_rounded, rounded, "cubic", (0.6,)), (0.9, 0.65), punch)
    truncated = [0.0, 0.5, 0.7, 1.0, 1.4]
    cone = {"kind": "truncated_cone", "flat_radius": 0.5, "slope": 0.3}
    yield TableCase(
        "truncated-cone", _table(_truncated, truncated, "cubic", (0.5,)), (0.55, 1.2), cone
    )
    graded = [0.9 * (i / 49) ** 2 for i in range(50)]
    yield TableCase("graded", _table(_sphere, graded), (0.7, 0.1))
    yield TableCase("pchip", _table(_sphere, uniform(0.6, 40), "pchip"), (0.5, 0.1))
    yield TableCase("linear", _table(_sphere, uniform(0.6, 40), "linear"), (0.5, 0.1))
    yield TableCase("two-points", _table(lambda r: 0.2 * r, [0.0, 1.0]), (0.5, 0.9))
