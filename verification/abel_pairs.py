"""Pressures under measured profiles: Abel pairs of the literature, as tables with convergence.

The foundation's load q(x) is the Abel transform of the pressure p(r), so that a published pair
(p, q) gives g(x) = (q(0) - q(x))/E*, f(r) = (2/pi) int_0^(pi/2) g(r sin t) dt, and the pressure
that the service must return for a table of f.
"""

from collections.abc import Callable, Iterator
from math import asin, exp, log, pi, sqrt
from typing import Final, NamedTuple

import numpy as np
from scipy.integrate import quad

from verification.case import Case, at

# E* = 1, a = 1. The pressures are this fraction of the published functions.
SCALE: Final = 0.01
RADII: Final = (0.1, 0.4, 0.6, 0.8)


class Pair(NamedTuple):
    """Abel pair on 0 <= r <= 1: function, transform, and radii of slope discontinuities."""

    source: str
    equation: str
    function: Callable[[float], float]
    transform: Callable[[float], float]
    breaks: tuple[float, ...]
    bounds: dict[int, float]
    """Bound on the pressure, relative to its largest value, by the number of table points."""


def _root(n: float, x: float) -> float:
    return sqrt(max(n * n - x * x, 0.0))


def _birkebak_11(x: float) -> float:
    a = _root(1, x)
    return a * (1 - 2.5 * x * x) + (1.5 * x**4 * log((1 + a) / x) if x else 0.0)


def _birkebak_12(x: float) -> float:
    a, half = _root(1, x), _root(0.5, x)
    outer = 4 / 3 * a * (1 + 2 * x * x)
    if x >= 0.5:
        return outer - 4 * x * x * log((1 + a) / x)
    inner = 2 / 3 * half * (1 + 8 * x * x)
    return outer - inner - 4 * x * x * log((1 + a) / (0.5 + half))


def _buie_7(x: float) -> float:
    rest = 1 - x * x
    return sqrt(pi / rest) / 1.1 * exp(1.21 * (1 - 1 / rest)) if rest > 0 else 0.0


# The pressure of this pair jumps to zero at the edge, where the slope of the load is infinite. Its
# integral over the last interval h of a table, which no table resolves, is of order sqrt(h).
_JUMP: Final = {points: (points - 1) ** -0.5 for points in (25, 50, 200)}

PAIRS: Final = (
    Pair(
        "cremers",
        "(11)",
        lambda r: 1 - 3 * r * r + 2 * r**3,
        _birkebak_11,
        (),
        {25: 1e-3, 50: 1e-4, 200: 1e-6},
    ),
    Pair(
        "cremers",
        "(12)",
        lambda r: 1 - 2 * r * r if r <= 0.5 else 2 * (1 - r) ** 2,
        _birkebak_12,
        (0.5,),
        # The curvature of this pressure jumps at 0.5, which the points do not resolve.
        {25: 1e-3, 50: 1e-4, 200: 3e-6},
    ),
    Pair(
        "buie",
        "Table 1, no. 1",
        lambda _r: 1.0,
        lambda x: 2 * _root(1, x),
        (),
        _JUMP,
    ),
    Pair(
        "buie",
        "Table 1, no. 7",
        lambda r: (1 - r * r) ** -1.5 * exp(1.21 * (1 - 1 / (1 - r * r))),
        _buie_7,
        (),
        {25: 1e-2, 50: 1e-3, 200: 1e-5},
    ),
)


def shape(pair: Pair, r: float) -> float:
    """Return f(r) by adaptive quadrature."""
    start = pair.transform(0.0)
    points = [asin(b / r) for b in pair.breaks if b < r]
    value, _ = quad(
        lambda t: start - pair.transform(r * np.sin(t)),
        0,
        pi / 2,
        points=points or None,
        epsabs=1e-14,
        epsrel=1e-13,
        limit=200,
    )
    return SCALE * 2 / pi * value


def cases() -> Iterator[Case]:
    """Yield the pressures of every pair and table."""
    for pair in PAIRS:
        largest = SCALE * max(map(pair.function, np.linspace(0, 0.99, 200)))
        for points, bound in pair.bounds.items():
            r = np.linspace(0.0, 1.0, points)
            profile = {
                "kind": "tabulated",
                "r": r.tolist(),
                "f": [0.0, *(shape(pair, one) for one in r[1:])],
            }
            request = {
                "profile": profile,
                "material": {"e_star": 1.0},
                "load": {"contact_radius": 1.0},
                "radius": list(RADII),
                "quantities": ["pressure"],
            }
            for i, one in enumerate(RADII):
                yield Case(
                    pair.source,
                    pair.equation,
                    f"table of {points} points: pressure at r = {one}",
                    "/v1/stress",
                    request,
                    at("pressure", 0, i),
                    SCALE * pair.function(one),
                    bound=bound,
                    scale=largest,
                )
