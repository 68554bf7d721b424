"""Values up to which a simpler model is enough, from closed forms of F_N.

With the tolerance t adhesion changes the contact radius to a' = a (1 + t) at w = E* l^2/(2 pi a'),
2 E* a' l = F_N(a') - F_N(a), and slip the tangential compliance, to first order in t, at F_x/mu =
F_N(a) - F_N(a (1 - 2t)). E* = 1.
"""

from collections.abc import Iterator
from typing import Any, Final

from mpmath import mpf, pi
from tests.oracles.shapes import shape_of

from verification.case import Case

TOLERANCE: Final = 0.01


def cases() -> Iterator[Case]:
    """Thresholds of adhesion and of slip."""
    t = mpf(TOLERANCE)
    scenes: tuple[tuple[dict[str, Any], float], ...] = (
        ({"kind": "paraboloid", "radius": 1.0}, 0.125),
        ({"kind": "sphere", "radius": 1.0}, 0.5),
        ({"kind": "cone", "slope": 0.125}, 0.125),
        ({"kind": "rounded_cone", "slope": 0.125, "tip_radius": 0.5}, 0.125),
        ({"kind": "power", "coefficient": 1.0, "exponent": 4.0}, 0.25),
        ({"kind": "rounded_punch", "flat_radius": 0.1, "rounding_radius": 1.0}, 0.125),
    )
    for profile, radius in scenes:
        shape, a = shape_of(profile), mpf(radius)
        request = {
            "profile": profile,
            "material": {"e_star": 1.0},
            "load": {"contact_radius": radius},
            "holds_within": TOLERANCE,
        }
        wide = a * (1 + t)
        work = ((shape.force(wide) - shape.force(a)) / (2 * wide)) ** 2 / (2 * pi * wide)
        slip = shape.force(a) - shape.force(a * (1 - 2 * t))
        for place, (name, value) in enumerate((("adhesion", work), ("slip", slip))):
            case = f"{profile['kind']}, a = {radius}, t = {TOLERANCE}: limit of {name}"
            yield Case(
                *("first-order", "closed form", case, "/v1/normal", request),
                *(("holds_while", place, "below", 0), value, 1e-11),
            )
