"""Generate the banks: ``python -m tests.oracles.generate``. The output is byte-reproducible."""

from __future__ import annotations

import itertools
import json
import math
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mpmath import mp, mpf

from tests.oracles.cases import EXTREMES, FAMILIES, SCALES, Family, Profile, cases
from tests.oracles.reference import (
    CLOSED_DIGITS,
    CONTROLS,
    QUAD_DIGITS,
    State,
    contact_radius,
    elasticities,
    pressure,
    state,
)
from tests.oracles.shapes import FlatPunch, Shape, shape_of

if TYPE_CHECKING:
    from collections.abc import Iterable

DATA = Path(__file__).parent / "data"
DIGITS = 30
SHORT = {"indentation_depth": "d", "normal_force": "F", "contact_radius": "a"}
#: Radii of the pressure bank as fractions of a, and relative distances from the break.
FRACTIONS = (0.0, 1e-9, 1e-3, 0.5, 1 - 1e-3, 1 - 1e-6, 1 - 1e-9)
DISTANCES = (1e-12, 1e-9, 1e-6, 1e-3)

Record = dict[str, Any]


def digits(value: mpf) -> str:
    """Format a number with `DIGITS` significant digits, or as "inf"."""
    return "inf" if mp.isinf(value) else str(mp.nstr(value, DIGITS, strip_zeros=False))


def condition(value: mpf) -> float | None:
    """Round a condition number to three digits; None if it is undefined (infinite values)."""
    return None if mp.isinf(value) or mp.isnan(value) else float(mp.nstr(abs(value), 4))


def representable(*values: float) -> bool:
    """Report whether all values are normal doubles, with a margin for products."""
    return all(1e-250 < abs(value) < 1e250 for value in values)


def _numbers(value: Any) -> Iterable[float]:
    if isinstance(value, float):
        yield value
    elif isinstance(value, dict):
        for inner in value.values():
            yield from _numbers(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from _numbers(inner)


def profile_at(family: Family, scale: str) -> Profile | None:
    """Return the family's profile at a scale, or None if a coefficient is not representable."""
    try:
        profile = family.make(SCALES[scale][0])
    except OverflowError:
        return None
    return profile if representable(*_numbers(profile)) else None


def loads(family: Family, profile: Profile, ratio: float, scale: str) -> dict[str, float]:
    """Return the prescribed double of each control, for nearly identical contacts."""
    length, e_star = SCALES[scale]
    size = family.unit(profile)
    if profile["kind"] == "cone" or (profile["kind"] == "power" and profile["exponent"] == 1):
        size = length
    radius = size * ratio
    if profile["kind"] == "flat_punch":
        return {
            "indentation_depth": radius,
            "normal_force": 2 * profile["radius"] * radius * e_star,
        }
    with mp.workdps(CLOSED_DIGITS):
        shape = shape_of(profile)
        a = mpf(radius)
        return {
            "indentation_depth": float(shape.g(a)),
            "normal_force": float(mpf(e_star) * shape.force(a)),
            "contact_radius": radius,
        }


def normal_cases() -> Iterable[Record]:
    for family, regime, ratio, scale in cases():
        profile = profile_at(family, scale)
        if profile is None:
            continue
        e_star = SCALES[scale][1]
        for control, load in loads(family, profile, ratio, scale).items():
            if not representable(load):
                continue
            answer = state(profile, control, load, e_star)
            if not representable(*(float(v) for v in answer.values.values())):
                continue
            yield {
                "id": f"{family.name}-{family.equation[1:-1]}-{regime}-{SHORT[control]}-{scale}",
                "equation": family.equation,
                "tags": {"family": family.name, "regime": regime, "scale": scale},
                **_solved(profile, e_star, control, load, answer),
            }


def extreme_cases() -> Iterable[Record]:
    for name, equation, profile, e_star, control, load in EXTREMES:
        yield {
            "id": f"{name}-{equation[1:-1]}-{SHORT[control]}",
            "equation": equation,
            "tags": {"family": name, "regime": "extreme", "scale": "any"},
            **_solved(profile, e_star, control, load, state(profile, control, load, e_star)),
        }


def _solved(profile: Profile, e_star: float, control: str, load: float, answer: State) -> Record:
    return {
        "profile": profile,
        "e_star": e_star,
        "control": control,
        "load": load,
        "expected": {name: digits(value) for name, value in answer.values.items()},
        "condition": {name: condition(value) for name, value in answer.condition.items()},
    }


def radii(family: Family, profile: Profile, a: float) -> list[float]:
    """Return radii in the contact: near the axis, near the edge and on both sides of the break."""
    inside = [a * fraction for fraction in FRACTIONS]
    b = family.break_radius(profile)
    if b > 0:
        inside.append(b)
        inside += [b * (1 + sign * distance) for sign in (-1, 1) for distance in DISTANCES]
    return sorted({r for r in inside if r < a})


def pressure_cases() -> Iterable[Record]:
    turn = 0
    names = list(SCALES)
    for family in FAMILIES:
        for regime, ratio in family.regimes:
            if regime not in family.pressure:
                continue
            # A radius is exact; a depth or a force has a condition number.
            for control in ("contact_radius", CONTROLS[turn % 2]):
                scale = names[turn % len(names)]
                turn += 1
                profile = profile_at(family, scale)
                if profile is None:
                    profile, scale = profile_at(family, "m-GPa"), "m-GPa"
                assert profile is not None, family.name
                given = loads(family, profile, ratio, scale)
                if control in given:
                    yield _pressure_record(
                        family,
                        regime,
                        scale,
                        profile=profile,
                        control=control,
                        load=given[control],
                    )


def _pressure_record(
    family: Family, regime: str, scale: str, *, profile: Profile, control: str, load: float
) -> Record:
    e_star = SCALES[scale][1]
    given = pressure_state(profile, control, load, e_star)
    points = radii(family, profile, float(given.a))
    record: Record = {
        "id": f"p-{family.name}-5.79-{regime}-{SHORT[control]}-{scale}",
        "equation": "(5.79)",
        "tags": {"family": family.name, "regime": regime, "scale": scale},
        "profile": profile,
        "e_star": e_star,
        "control": control,
        "load": load,
        "radius": points,
        "expected": [],
        "condition_radius": [],
        "condition_load": [],
        "condition_edge": [],
    }
    with mp.workdps(QUAD_DIGITS):
        for point in points:
            p = pressure_at(given, point)
            record["expected"].append(digits(p * mpf(e_star)))
            record["condition_radius"].append(condition(_rate_radius(given, mpf(point), p)))
            edge = _rate_edge(given, mpf(point), p)
            record["condition_load"].append(condition(edge / given.rate))
            record["condition_edge"].append(condition(edge))
    return record


@dataclass(frozen=True)
class PressureState:
    """State that determines the pressure of one load; `rate` is d log(load)/d log(a)."""

    shape: Shape
    a: mpf
    s: mpf | None
    depth: mpf
    rate: mpf


def pressure_state(profile: Profile, control: str, load: float, e_star: float) -> PressureState:
    with mp.workdps(CLOSED_DIGITS):
        shape, given, modulus = shape_of(profile), mpf(load), mpf(e_star)
        if isinstance(shape, FlatPunch):
            answer = state(profile, control, load, e_star)
            depth = answer.values["indentation_depth"]
            return PressureState(shape, shape.b, None, depth, mpf(1))
        reduced = given / modulus if control == "normal_force" else given
        a, s = contact_radius(shape, control, reduced)
        rate = elasticities(shape, a, s, mpf(1))[control]
        return PressureState(shape, a, s, shape.g(a, s), rate)


def pressure_at(given: PressureState, radius: mpf | float) -> mpf:
    """Return p/E* at a radius."""
    with mp.workdps(QUAD_DIGITS):
        return pressure(given.shape, mpf(radius), given.a, given.s, given.depth)


def _rate_radius(given: PressureState, r: mpf, p: mpf) -> mpf:
    """r p'(r)/p by a difference quotient with a step far below any distance in the bank."""
    if r == 0 or mp.isinf(p):
        return mpf(0) if r == 0 else mp.inf
    width = mpf(10) ** -17
    if r == given.shape.b:
        # One-sided: p has a vertical tangent here, and only the order of magnitude matters.
        return (p - pressure_at(given, r * (1 - width))) / width / p
    below, above = (pressure_at(given, r * (1 + sign * width)) for sign in (-1, 1))
    return (above - below) / (2 * width) / p


def _rate_edge(given: PressureState, r: mpf, p: mpf) -> mpf:
    """d log p/d log a, from dp/da = g'(a)/(pi sqrt(a^2 - r^2)); the punch is linear in its load."""
    if mp.isinf(p):
        return mp.inf
    if isinstance(given.shape, FlatPunch):
        return mpf(1)
    a = given.a
    return a * given.shape.dg(a, given.s) / (mp.pi * mp.sqrt((a - r) * (a + r))) / p


def profile_cases() -> Iterable[Record]:
    names = list(SCALES)
    for turn, family in enumerate(FAMILIES):
        scale = names[turn % len(names)]
        profile = profile_at(family, scale)
        if profile is None:
            profile, scale = profile_at(family, "m-GPa"), "m-GPa"
        assert profile is not None, family.name
        yield _profile_record(family, profile, scale)


def _profile_record(family: Family, profile: Profile, scale: str) -> Record:
    size = SCALES[scale][0]
    if profile["kind"] in {"sphere", "ellipsoid", "flat_punch"}:
        size = 0.9 * profile["radius"]
    b = family.break_radius(profile)
    if b > 0:
        size = b
    points = [size * ratio for ratio in (1e-9, 1e-6, 1e-3, 0.1, 0.5, 1.0)]
    if b > 0:
        points = [x for x in points if x != b]
        points += [b * (1 + sign * step) for sign in (-1, 1) for step in DISTANCES]
        points += [2 * b, 1e3 * b]
    points.sort()
    record: Record = {
        "id": f"g-{family.name}-5.74-{scale}",
        "equation": "(5.74)",
        "tags": {"family": family.name, "scale": scale},
        "profile": profile,
        "x": points,
    }
    with mp.workdps(CLOSED_DIGITS):
        shape = shape_of(profile)
        # The steepest powers are not representable near the axis.
        points[:] = [x for x in points if not 0 < shape.f(mpf(x)) < mpf("1e-250")]
        for name in ("f", "df", "g", "dg"):
            fn = getattr(shape, name)
            values = [fn(mpf(x)) for x in points]
            record[name] = [digits(value) for value in values]
            record[f"condition_{name}"] = [
                condition(x * mp.diff(fn, mpf(x)) / value) if value else 0.0
                for x, value in zip(points, values, strict=True)
            ]
    return record


def checked(record: Record | None) -> str | None:
    """Return a record as a line; a value that is not representable is a defect of the selection."""
    if record is None:
        return None
    if not all(math.isfinite(value) for value in _numbers(record)):
        raise ArithmeticError(record["id"])
    return json.dumps(record, separators=(",", ":"), allow_nan=False)


def write(name: str, lines: Iterable[str | None]) -> None:
    started = time.perf_counter()
    kept = [line for line in lines if line is not None]
    text = "[\n" + ",\n".join(kept) + "\n]\n"
    (DATA / f"{name}.json").write_text(text, encoding="utf-8")
    seconds = math.ceil(time.perf_counter() - started)
    sys.stderr.write(f"{name}: {len(kept)} records, {len(text)} bytes, {seconds} s\n")


MAKERS = {
    "profile": profile_cases,
    "normal": lambda: itertools.chain(normal_cases(), extreme_cases()),
    "pressure": pressure_cases,
}


def main(names: list[str]) -> None:
    for name in names or MAKERS:
        write(name, map(checked, MAKERS[name]()))


if __name__ == "__main__":
    main(sys.argv[1:])
