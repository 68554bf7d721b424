"""Cases of the bank: families of shapes, contact regimes and scales of units."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

Profile = dict[str, Any]

#: Length unit and modulus of each scale, as doubles.
SCALES: dict[str, tuple[float, float]] = {
    "nm-TPa": (1e-9, 1.1e12),
    "um-GPa": (1e-6, 2.1e11),
    "mm-MPa": (1e-3, 3.3e6),
    "m-GPa": (1.0, 7e10),
    "km-kPa": (1e3, 1.7e3),
}


@dataclass(frozen=True)
class Family:
    """A shape in units of a length, and contact radii in units of its characteristic length.

    `regimes` are ratios a/`unit(profile)`; the first is used at every scale, the others in turn.
    For the flat punch they are depths over the radius.
    """

    name: str
    equation: str
    make: Callable[[float], Profile]
    unit: Callable[[Profile], float]
    regimes: tuple[tuple[str, float], ...]
    pressure: tuple[str, ...] = ()
    break_radius: Callable[[Profile], float] = lambda profile: 0.0


def _by(*ratios: float) -> tuple[tuple[str, float], ...]:
    return tuple((f"{ratio:g}", ratio) for ratio in ratios)


#: a/b just beyond the break, and far beyond it (b/a = 0.95, 0.5, 1e-3, 1e-6).
BEYOND = (
    ("b/a=0.5", 2.0),
    ("b(1+1e-9)", 1 + 1e-9),
    ("b(1+1e-6)", 1 + 1e-6),
    ("b(1+1e-3)", 1 + 1e-3),
    ("b/a=0.95", 1 / 0.95),
    ("b/a=1e-3", 1e3),
    ("b/a=1e-6", 1e6),
)
#: `BEYOND` and contacts inside the break.
AROUND = (
    *BEYOND,
    ("1e-9b", 1e-9),
    ("1e-3b", 1e-3),
    ("0.5b", 0.5),
    ("b(1-1e-9)", 1 - 1e-9),
    ("b(1-1e-3)", 1 - 1e-3),
)
SPHERE = _by(0.5, 1e-9, 1e-3, 0.1, 0.3, 0.9, 0.999, 1 - 1e-6)
PRESSURE_BEYOND = ("b/a=0.5", "b(1+1e-6)", "b/a=0.95", "b/a=1e-3")
PRESSURE_AROUND = ("b/a=0.5", "b(1+1e-3)", "b/a=0.95", "b/a=1e-3", "0.5b")


def _field(name: str) -> Callable[[Profile], float]:
    return lambda profile: float(profile[name])


def _power(exponent: float, coefficient: float, length: float) -> Profile:
    scaled = coefficient * length ** (1 - exponent)
    return {"kind": "power", "coefficient": scaled, "exponent": exponent}


def _power_family(exponent: float) -> Family:
    def make(length: float) -> Profile:
        return _power(exponent, 0.7, length)

    def unit(profile: Profile) -> float:
        # Inverts `make`: the profile's length follows only from coefficient and exponent together.
        if exponent == 1:
            return 1.0
        return float((profile["coefficient"] / 0.7) ** (1 / (1 - exponent)))

    regimes = _by(0.5, 1e-9, 1e-3, 1.9) if exponent < 10 else _by(0.5, 1e-3, 0.1, 1.9)
    return Family(f"power{exponent:g}", "(5.30)", make, unit, regimes, ("0.5", "1.9"))


def _series(*terms: tuple[float, float]) -> Callable[[float], Profile]:
    def make(length: float) -> Profile:
        scaled = [
            {"coefficient": c * length ** (1 - n) if n != 1 else c, "exponent": n} for c, n in terms
        ]
        return {"kind": "series", "terms": scaled}

    return make


def _series_family(name: str, *terms: tuple[float, float]) -> Family:
    smooth = next((c, n) for c, n in terms if n != 1)

    def unit(profile: Profile) -> float:
        given = next(t for t in profile["terms"] if t["exponent"] != 1)
        return float((given["coefficient"] / smooth[0]) ** (1 / (1 - smooth[1])))

    regimes = _by(0.5, 1e-9, 1e-3, 1.9)
    return Family(f"series-{name}", "(5.30)", _series(*terms), unit, regimes, ("0.5", "1.9"))


def _cone(slope: float) -> Family:
    return Family(
        f"cone{slope:g}",
        "(5.48)",
        lambda length: {"kind": "cone", "slope": slope},
        lambda profile: 1.0,
        _by(0.5, 1e-9, 1e-3, 10.0),
        ("0.5",),
    )


def _spherical_tip(slope: float) -> Family:
    return Family(
        f"spherical-tip-cone{slope:g}",
        "(5.74)",
        lambda length: {"kind": "spherical_tip_cone", "slope": slope, "tip_radius": 2.3 * length},
        lambda p: float(p["tip_radius"] * slope / (1 + slope**2) ** 0.5),
        AROUND,
        PRESSURE_AROUND if slope in (0.1, 3) else ("b/a=0.5",),
        lambda p: float(p["tip_radius"] * slope / (1 + slope**2) ** 0.5),
    )


def _rounded_cone(slope: float) -> Family:
    return Family(
        f"rounded-cone{slope:g}",
        "(5.74)",
        lambda length: {"kind": "rounded_cone", "slope": slope, "tip_radius": 1.7 * length},
        lambda p: float(p["tip_radius"] * slope),
        AROUND,
        PRESSURE_AROUND if slope == 0.3 else (),
        lambda p: float(p["tip_radius"] * slope),
    )


def _hyperboloid(slope: float) -> Family:
    return Family(
        f"hyperboloid{slope:g}",
        "(5.74)",
        lambda length: {"kind": "hyperboloid", "slope": slope, "tip_radius": 1.3 * length},
        lambda p: float(p["tip_radius"] * slope),
        _by(1.0, 1e-9, 1e-6, 1e-3, 0.1, 10.0, 1e3, 1e6),
        ("1", "0.001", "1000") if slope == 0.4 else (),
    )


def _capped(name: str, inner: float, outer: float) -> Family:
    return Family(
        f"capped-paraboloid-{name}",
        "(5.74)",
        lambda length: {
            "kind": "capped_paraboloid",
            "cap_radius": 0.6 * length,
            "tip_radius": inner * length,
            "radius": outer * length,
        },
        _field("cap_radius"),
        AROUND,
        PRESSURE_AROUND,
        _field("cap_radius"),
    )


def _blunt(name: str, equation: str, kind: str, *, field: str, value: float, power: int) -> Family:
    return Family(
        name,
        equation,
        lambda length: {
            "kind": kind,
            "flat_radius": 0.8 * length,
            field: value * length**power,
        },
        _field("flat_radius"),
        BEYOND,
        PRESSURE_BEYOND,
        _field("flat_radius"),
    )


FAMILIES: tuple[Family, ...] = (
    Family(
        "flat-punch",
        "(5.1)",
        lambda length: {"kind": "flat_punch", "radius": 0.9 * length},
        _field("radius"),
        _by(1e-3, 1e-9, 0.3),
        ("0.001",),
    ),
    Family(
        "hertz",
        "(5.14)",
        lambda length: {"kind": "paraboloid", "radius": 1.3 * length},
        _field("radius"),
        _by(0.3, 1e-9, 1e-3, 2.0),
        ("0.3", "1e-09"),
    ),
    *(_cone(slope) for slope in (0.3, 1e-3, 3.0)),
    Family(
        "sphere",
        "(5.74)",
        lambda length: {"kind": "sphere", "radius": 1.3 * length},
        _field("radius"),
        SPHERE,
        ("0.5", "0.001", "0.999"),
    ),
    Family(
        "ellipsoid-flat",
        "(5.74)",
        lambda length: {"kind": "ellipsoid", "radius": 1.3 * length, "height": 0.2 * length},
        _field("radius"),
        SPHERE,
        ("0.5", "0.9"),
    ),
    Family(
        "ellipsoid-tall",
        "(5.74)",
        lambda length: {"kind": "ellipsoid", "radius": 0.7 * length, "height": 3.1 * length},
        _field("radius"),
        SPHERE,
    ),
    *(_power_family(n) for n in (0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 7.3, 20.0, 50.0, 60.0)),
    _series_family("2", (0.4, 2.0), (0.3, 4.0)),
    _series_family("real", (0.2, 1.0), (0.5, 1.7), (0.3, 3.2)),
    _series_family("4", (0.1, 0.5), (0.2, 1.0), (0.5, 2.0), (0.05, 6.5)),
    # Convex for every r in spite of the negative coefficient.
    _series_family("negative", (1.0, 2.0), (-0.1, 3.0), (0.1, 4.0)),
    _blunt("rounded-punch", "(5.61)", "rounded_punch", field="rounding_radius", value=2.7, power=1),
    _blunt("truncated-cone", "(5.74)", "truncated_cone", field="slope", value=0.35, power=0),
    _blunt(
        "truncated-paraboloid", "(5.74)", "truncated_paraboloid", field="radius", value=1.9, power=1
    ),
    *(_rounded_cone(slope) for slope in (0.3, 0.01)),
    *(_spherical_tip(slope) for slope in (0.1, 1e-3, 1.0, 3.0)),
    *(_hyperboloid(slope) for slope in (0.4, 0.01, 2.0)),
    _capped("blunted", 3.0, 1.1),
    _capped("worn", 40.0, 1.1),
    _capped("same", 1.1, 1.1),
    # The crossover of two terms, or of cap and flank, lies at an irrelevant radius.
    replace(_capped("nearly-same", 1.1, 1.0957), pressure=()),
    replace(_series_family("close", (1.0, 0.65625), (0.125, 0.66015625)), pressure=()),
)


def cases() -> Iterator[tuple[Family, str, float, str]]:
    """Return every family's first regime at every scale, the others at one scale each in turn."""
    names = list(SCALES)
    turn = 0
    for family in FAMILIES:
        for number, (regime, ratio) in enumerate(family.regimes):
            if number == 0:
                for scale in names:
                    yield family, regime, ratio, scale
            else:
                yield family, regime, ratio, names[turn % len(names)]
                turn += 1


#: Extreme ratios of parameters and loads, found by a random search for the least accuracy: name,
#: equation, profile, E*, control and load.
EXTREMES: list[tuple[str, str, Profile, float, str, float]] = json.loads(
    (Path(__file__).parents[1] / "data" / "extreme_contacts.json").read_text("utf-8")
)
