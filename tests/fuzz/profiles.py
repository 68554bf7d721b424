"""Random profiles of all kinds, and tables like measured ones, in SI."""

from collections.abc import Callable
from math import log1p, sqrt, tanh
from random import Random
from typing import Any, Final, NamedTuple

Height = Callable[[float], float]
"""Height of a profile above its lowest point at a radius."""


class Case(NamedTuple):
    """A profile in SI, its height function, and suitable contact radii."""

    profile: dict[str, Any]
    height: Height
    radius: float


def spread(random: Random, low: float, high: float) -> float:
    """Return a number between the bounds, uniform on a logarithmic scale."""
    return float(low * (high / low) ** random.random())


def profile(random: Random, kind: str | None = None) -> Case:
    """Return a profile of any kind, between 1 µm and 1 m in size."""
    kind = kind or random.choice((*_KINDS, "tabulated", "tabulated"))
    size = spread(random, 1e-6, 1.0) if random.random() < 0.2 else spread(random, 1e-3, 0.1)
    return (_tabulated if kind == "tabulated" else _analytical)(random, kind, size)


_KINDS: Final = (
    *("flat_punch", "cone", "paraboloid", "sphere", "ellipsoid", "power", "series"),
    *("rounded_punch", "truncated_cone", "truncated_paraboloid", "rounded_cone"),
    *("spherical_tip_cone", "hyperboloid", "capped_paraboloid", "two_spheres"),
)


def _analytical(random: Random, kind: str, size: float) -> Case:
    R, t = size, spread(random, 3e-3, 1.0)
    b = R * spread(random, 1e-3, 1.0)
    # From a light contact to the limit of the half-space approximation.
    a = R * spread(random, 1e-3, 0.5)
    near_flat = b * (1 + spread(random, 1e-4, 3.0))
    near_tip = R * t * spread(random, 0.05, 20.0)
    named: dict[str, tuple[dict[str, Any], Height, float]] = {
        "flat_punch": ({"radius": R}, lambda r: 0.0, R),
        "cone": ({"slope": t}, lambda r: t * r, a),
        "paraboloid": ({"radius": R}, lambda r: r * r / (2 * R), a),
        "sphere": ({"radius": R}, lambda r: R - sqrt(max(R * R - r * r, 0.0)), a),
        "ellipsoid": (
            {"radius": R, "height": b},
            lambda r: b - b * sqrt(max(1 - (r / R) ** 2, 0.0)),
            a,
        ),
        "rounded_punch": (
            {"flat_radius": b, "rounding_radius": R},
            lambda r: max(r - b, 0.0) ** 2 / (2 * R),
            near_flat,
        ),
        "truncated_cone": (
            {"flat_radius": b, "slope": t},
            lambda r: t * max(r - b, 0.0),
            near_flat,
        ),
        "truncated_paraboloid": (
            {"flat_radius": b, "radius": R},
            lambda r: max(r * r - b * b, 0.0) / (2 * R),
            near_flat,
        ),
        "rounded_cone": (
            {"slope": t, "tip_radius": R},
            lambda r: r * r / (2 * R) if r < R * t else t * r - R * t * t / 2,
            near_tip,
        ),
        "spherical_tip_cone": (
            {"slope": t, "tip_radius": R},
            lambda r: _spherical_tip(r, t, R),
            near_tip,
        ),
        "hyperboloid": (
            {"slope": t, "tip_radius": R},
            lambda r: R * t * t * (sqrt(1 + (r / (R * t)) ** 2) - 1),
            near_tip,
        ),
    }
    if kind == "two_spheres":
        other = random.choice(
            (R, R * spread(random, 1.0, 1e3), -R * (1 + spread(random, 1e-3, 1.0)))
        )
        radii = [R, other]

        def gap(r: float) -> float:
            sides = (abs(each) - sqrt(max(each * each - r * r, 0.0)) for each in radii)
            return sum(side if each > 0 else -side for side, each in zip(sides, radii, strict=True))

        return Case({"kind": kind, "radii": radii}, gap, a)
    if kind in named:
        fields, height, radius = named[kind]
        return Case({"kind": kind, **fields}, height, radius)
    if kind == "capped_paraboloid":
        tip = R * spread(random, 1.0, 100.0)
        return Case(
            {"kind": kind, "cap_radius": b, "tip_radius": tip, "radius": R},
            lambda r: r * r / (2 * tip) + max(r * r - b * b, 0.0) * (1 / R - 1 / tip) / 2,
            near_flat,
        )
    count = 1 if kind == "power" else random.randint(1, 5)
    terms = []
    for _ in range(count):
        exponent = random.choice((1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, spread(random, 0.3, 12.0)))
        height_at_a = a * spread(random, 1e-4, 0.3)
        terms.append({"coefficient": height_at_a * a**-exponent, "exponent": exponent})
    if count > 1 and random.random() < 0.2:
        # Fitted series have small terms of opposite sign and nearly equal exponents.
        terms[-1]["coefficient"] *= -0.1
        terms[0]["exponent"] = terms[-1]["exponent"] * (1 + random.choice((0.0, 1e-6, 0.1)))

    def series(r: float) -> float:
        return float(sum(each["coefficient"] * r ** each["exponent"] for each in terms))

    given = terms[0] if kind == "power" else {"terms": terms}
    return Case({"kind": kind, **given}, series, a)


def _spherical_tip(r: float, t: float, R: float) -> float:
    tangent = R * t / sqrt(1 + t * t)
    if r < tangent:
        return R - sqrt(R * R - r * r)
    return R - sqrt(R * R - tangent * tangent) + t * (r - tangent)


def _tabulated(random: Random, _kind: str, size: float) -> Case:
    """Return a table of a smooth, flat, kinked or noisy shape, measured or calculated."""
    L = size * spread(random, 0.01, 1.0)
    h = L * spread(random, 1e-4, 0.3)
    flat = random.uniform(0.1, 0.7)
    shapes: tuple[Height, ...] = (
        lambda s: s * s,
        lambda s: s,
        lambda s: s**1.5,
        lambda s: s**2.5,
        lambda s: sqrt(1 + s * s) - 1,
        lambda s: log1p(s * s),
        lambda s: tanh(s) ** 2,
        lambda s: 1 - sqrt(1 - 0.9 * s * s),
        lambda s: max(s - flat, 0.0) ** 2,
        lambda s: max(s - flat, 0.0),
        lambda s: 0.3 * s + max(s - flat, 0.0),
        lambda s: 0.1 * s * s + max(s * s - flat * flat, 0.0),
    )
    shape = random.choice(shapes)
    count = random.choice((random.randint(3, 9), random.randint(10, 60), random.randint(60, 300)))
    if random.random() < 0.05:
        count = random.randint(300, 1000)
    spacing = random.choice((1.0, 1.0, 2.0, 0.7))
    places = [(i / (count - 1)) ** spacing for i in range(count)]
    if random.random() < 0.3:
        places = sorted({0.0, 1.0, *(random.random() for _ in range(count))})
    if random.random() < 0.3:
        places = sorted({*places, flat})
    heights = [shape(s) for s in places]
    noise = spread(random, 1e-6, 1e-2) * heights[-1] if random.random() < 0.3 else 0.0
    heights = [y + random.gauss(0, noise) for y in heights]
    r, f = [L * s for s in places], [h * y for y in heights]
    if random.random() < 0.4:
        # Instruments print a fixed number of digits.
        digits = random.randint(4, 8)
        r, f = ([float(f"{value:.{digits}g}") for value in each] for each in (r, f))
    table: dict[str, Any] = {"kind": "tabulated", "r": r, "f": f}
    if noise > 0 and random.random() < 0.3:
        table["uncertainty"] = h * noise
    if random.random() < 0.3:
        table["breaks"] = [L * flat]
    if random.random() < 0.2:
        # Both sides of the axis, in any order.
        order = random.sample(range(len(r)), len(r))
        table["r"] = [random.choice((-1, 1)) * r[i] for i in order]
        table["f"] = [f[i] for i in order]
    return Case(table, lambda radius: h * shape(radius / L), r[-1] * spread(random, 0.05, 0.9))
