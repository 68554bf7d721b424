"""Core against bare NumPy expressions and SciPy, one process per measurement.

`python core_ratios.py NAME STATE` prints the rows of one measurement as JSON. Each runs in a
process of its own, because earlier allocations decide whether an array's memory is at hand:

- "fresh pages": the C library's defaults. Large temporaries return to the system on every call and
  cause page faults at the next, for both sides.
- "kept memory": the environment makes the C library keep freed memory (`KEPT` below).
"""

from __future__ import annotations

import dataclasses
import itertools
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

# Set before NumPy is loaded: BLAS threads would compete for the cores.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import measure
import mpmath
import numpy as np
from scipy.integrate import quad_vec
from substitutions import Slope, both_roots_removed, one_root_removed

from mdr_core import fields, tangential
from mdr_core.normal import NormalContact, solve
from mdr_core.profiles import Paraboloid, Power, PowerTerm, Profile, RoundedPunch, Series, Tabulated

FRESH, KEPT = "fresh pages", "kept memory"
_KEEP = {"MALLOC_MMAP_THRESHOLD_": str(1 << 30), "MALLOC_TRIM_THRESHOLD_": str(1 << 30)}

Array = np.ndarray
Form = Callable[[Slope, Array, float, float], Callable[[float], Array]]


def paraboloid_pressure(state: str) -> list[measure.Row]:
    """p(r) of the closed form at 1e5 radii."""
    R, e_star = 0.01, 1.1e11
    contact = solve(Paraboloid(R), e_star, normal_force=10.0)
    a = float(contact.contact_radius)
    r = np.linspace(0.0, a, 100_000, endpoint=False)

    def mdr() -> Array:
        return fields.pressure(contact, r)

    def bare() -> Array:
        return 2 * e_star / (np.pi * R) * np.sqrt(a * a - r * r)

    difference = float(np.max(np.abs(mdr() / bare() - 1)[: r.size // 2]))
    rounds = measure.interleaved(mdr, bare, 2.0)
    detail = f"both agree to {difference:.0e} for r < a/2"
    return [
        measure.row("p(r), paraboloid, 1e5 radii / bare NumPy", state, rounds, "<= 1.3", detail)
    ]


def punch_pressure(state: str) -> list[measure.Row]:
    """p(r) of the rounded punch with b/a = 0.95 at 1000 radii, to 1e-12."""
    a, b, R, e_star = 1e-3, 0.95e-3, 0.02, 1.1e11
    r = np.linspace(0.0, a, 1000, endpoint=False)
    contact = solve(RoundedPunch(b, R), e_star, contact_radius=a)

    def mdr() -> Array:
        return fields.pressure(contact, r)

    def hertz() -> Array:
        return 2 * e_star / (np.pi * R) * np.sqrt(a * a - r * r)

    checked = [0, 300, 700, 949, 950, 951, 990, 999]
    truth = [_punch_truth(float(r[i]), a, b, R, e_star) for i in checked]

    def error(p: Array) -> float:
        pairs = zip(checked, truth, strict=True)
        return max(float(abs(mpmath.mpf(float(p[i])) / exact - 1)) for i, exact in pairs)

    found = [
        measure.row(
            "p(r), rounded punch b/a = 0.95, 1000 radii / bare Hertz",
            state,
            measure.interleaved(mdr, hertz, 2.0),
            "<= 200",
            f"true error {error(mdr()):.1e} at {len(checked)} radii",
        )
    ]
    for substitution, (form, target) in _SUBSTITUTIONS.items():

        def scipy(epsrel: float, form: Form = form) -> Array:
            integrand = form(_punch_slope(b), r, a, b)
            integral, _ = quad_vec(integrand, 0.0, 1.0, epsabs=0.0, epsrel=epsrel, norm="max")
            return e_star / (np.pi * R) * integral

        # SciPy's tolerance is the loosest one that meets the error limit of MDR.
        tolerances = (1e-9, 1e-10, 1e-11, 1e-12, 1e-13)
        epsrel = next(one for one in tolerances if error(scipy(one)) <= 1e-12)
        found.append(
            measure.row(
                f"scipy quad_vec, {substitution} / the same p(r)",
                state,
                measure.interleaved(lambda run=scipy, tol=epsrel: run(tol), mdr, 2.0),
                target,
                f"true error {error(scipy(epsrel)):.1e} at epsrel {epsrel:.0e}",
            )
        )
    return found


_SUBSTITUTIONS: dict[str, tuple[Form, str]] = {
    "t^2 = x^2 - r^2": (one_root_removed, ">= 50"),
    "x - max(r, b) ~ u^2": (both_roots_removed, ">= 5"),
}


def _punch_slope(b: float) -> Slope:
    """R g'(x), of x and x - b."""

    def slope(x: Array, above: Array) -> Array:
        root = np.sqrt(above * (x + b))
        return 2 * root - b * np.arctan(root / b)

    return slope


def _punch_truth(
    r: float, a: float, b: float, R: float, e_star: float, c: float = 0.0
) -> mpmath.mpf:
    """(E*/(pi R)) int (2 sqrt(x^2 - b^2) - b arccos(b/x))/sqrt(x^2 - r^2) dx from max(r, b, c) to
    a, with 30 digits.
    """
    with mpmath.workdps(40):
        point, edge, flat = mpmath.mpf(r), mpmath.mpf(a), mpmath.mpf(b)
        low = max(point, flat, mpmath.mpf(c))
        length, gap = edge - low, low - point

        def integrand(v: mpmath.mpf) -> mpmath.mpf:
            step = length * v * v
            x = low + step
            root = mpmath.sqrt((low - flat + step) * (x + flat))
            numerator = 2 * root - flat * mpmath.atan(root / flat)
            return numerator * 2 * v * length / mpmath.sqrt((gap + step) * (x + point))

        # Distance of the other root, at r or at b, from the end.
        other = mpmath.sqrt(abs(point - flat) / length)
        value, error = mpmath.quad(integrand, sorted({0, min(other, 1), 1}), error=True)
        if error > 1e-25 * length:
            raise ArithmeticError(f"the reference at r = {r} has not converged: {error}")
        return mpmath.mpf(e_star) * value / (mpmath.pi * mpmath.mpf(R))


def table_pressure(state: str) -> list[measure.Row]:
    """p(r) of a table of 200 points at 1000 radii, known or from its points."""
    radii, a = np.linspace(0.0, 0.6, 200), 0.5
    heights, r = radii**2 / (1 + np.sqrt(1 - radii**2)), np.linspace(0.0, a, 1000, endpoint=False)
    known, numbers = solve(Tabulated(radii, heights), 1.0, contact_radius=a), itertools.count(1)

    def mdr() -> Array:
        return fields.pressure(known, r)

    def from_points() -> Array:
        # No two tables are the same, so that nothing is kept of an earlier one.
        profile = Tabulated(radii, heights * (1 + next(numbers) * 1e-9))
        return fields.pressure(solve(profile, 1.0, contact_radius=a), r)

    def hertz() -> Array:
        return 2 / np.pi * np.sqrt(a * a - r * r)

    name = "p(r), table of 200 points, 1000 radii / bare Hertz"
    return [
        measure.row(name, state, measure.interleaved(mdr, hertz, 2.0), "<= 500"),
        measure.row(
            f"{name}, from its points",
            state,
            measure.interleaved(from_points, hertz, 2.0),
            "<= 8000",
        ),
    ]


def hertz_sweep(state: str) -> list[measure.Row]:
    """A million Hertz contacts in one call."""
    random = np.random.default_rng(5)
    R, e_star, force = (
        10 ** random.uniform(low, high, 1_000_000) for low, high in ((-3, 0), (9, 12), (-3, 3))
    )

    def contact() -> NormalContact:
        return solve(Paraboloid(R), e_star, normal_force=force)

    def mdr_two() -> tuple[Array, ...]:
        one = contact()
        return one.contact_radius, one.indentation_depth

    def mdr_four() -> tuple[Array, ...]:
        one = contact()
        return (
            one.contact_radius,
            one.indentation_depth,
            one.mean_pressure,
            one.normal_stiffness,
        )

    def bare_two() -> tuple[Array, ...]:
        a = np.cbrt(0.75 * R * force / e_star)
        return a, a * a / R

    def bare_four() -> tuple[Array, ...]:
        a = np.cbrt(0.75 * R * force / e_star)
        return a, a * a / R, force / (np.pi * a * a), 2 * e_star * a

    pairs = zip(mdr_four(), bare_four(), strict=True)
    difference = max(float(np.abs(mine / other - 1).max()) for mine, other in pairs)
    detail = f"both agree to {difference:.0e}"
    return [
        measure.row(
            "1e6 Hertz contacts: a, d, mean pressure, stiffness / bare NumPy",
            state,
            measure.interleaved(mdr_four, bare_four, 3.0),
            "<= 1.5",
            detail,
        ),
        measure.row(
            "1e6 Hertz contacts: a, d only / bare NumPy",
            state,
            measure.interleaved(mdr_two, bare_two, 2.0),
            "<= 1.5",
        ),
    ]


def punch_traction(state: str) -> list[measure.Row]:
    """tau(r) of the rounded punch with b/a = 0.95 and c half-way, at 1000 radii, to 1e-12."""
    a, b, e_star, g_star = 1e-3, 0.95e-3, 1.1e11, 0.9e11
    r = np.linspace(0.0, a, 1000, endpoint=False)
    contact = solve(RoundedPunch(b, 0.02), e_star, contact_radius=a)
    friction, c = 0.3, (a + b) / 2
    tangential_contact = tangential.solve(contact, g_star, friction, stick_radius=c)

    def mdr() -> Array:
        return fields.shear_stress(tangential_contact, r)

    def hertz() -> Array:
        return 2 * e_star / (np.pi * 0.02) * np.sqrt(a * a - r * r)

    tau, checked = mdr(), [0, 300, 700, 949, 950, 951, 974, 975, 976, 990, 999]
    truth = {i: friction * _punch_truth(float(r[i]), a, b, 0.02, e_star, c) for i in checked}
    error = max(float(abs(mpmath.mpf(float(tau[i])) / truth[i] - 1)) for i in checked)
    rounds = measure.interleaved(mdr, hertz, 2.0)
    name = "tau(r), rounded punch b/a = 0.95, 1000 radii / bare Hertz"
    detail = f"true error {error:.1e} at {len(checked)} radii"
    return [measure.row(name, state, rounds, "<= 220", detail)]


def mindlin_sweep(state: str) -> list[measure.Row]:
    """A million Cattaneo-Mindlin contacts in one call."""
    random = np.random.default_rng(5)
    R, e_star, force = (
        10 ** random.uniform(low, high, 1_000_000) for low, high in ((-3, 0), (9, 12), (-3, 3))
    )
    friction, g_star = 0.3, 1e11
    push = friction * force * random.uniform(0.01, 0.99, force.size)

    def mdr() -> tuple[Array, ...]:
        contact = solve(Paraboloid(R), e_star, normal_force=force)
        one = tangential.solve(contact, g_star, friction, tangential_force=push)
        return contact.contact_radius, one.stick_radius, one.tangential_displacement

    def bare() -> tuple[Array, ...]:
        a = np.cbrt(0.75 * R * force / e_star)
        c = a * np.cbrt(1 - push / (friction * force))
        return a, c, friction * e_star / g_star * (a * a - c * c) / R

    pairs = zip(mdr(), bare(), strict=True)
    difference = max(float(np.abs(mine / other - 1).max()) for mine, other in pairs)
    return [
        measure.row(
            "1e6 Mindlin contacts: a, c, displacement / bare NumPy",
            state,
            measure.interleaved(mdr, bare, 3.0),
            "<= 1.7",
            f"both agree to {difference:.0e}",
        )
    ]


def power_and_series(state: str) -> list[measure.Row]:
    """Every quantity of one load with friction, under a power and under a sum of two."""
    power = Power(0.5, 3.3)
    series = Series((PowerTerm(0.5, 2.0), PowerTerm(0.1, 4.0)))

    def query(profile: Profile) -> dict[str, Any]:
        contact = solve(profile, 1.0, normal_force=0.01)
        return tangential.solve(contact, 0.9, 0.3, tangential_force=0.002).computed()

    rounds = measure.interleaved(lambda: query(power), lambda: query(series), 2.0)
    return [measure.row("one load with friction, power / series", state, rounds, "<= 1")]


MEASUREMENTS = {
    run.__name__: run
    for run in (
        paraboloid_pressure,
        punch_pressure,
        table_pressure,
        hertz_sweep,
        punch_traction,
        mindlin_sweep,
        power_and_series,
    )
}


def rows() -> list[measure.Row]:
    """All measurements in both allocator states, those of the gate in one."""
    states, found = {FRESH: {}, KEPT: _KEEP}, []
    if measure.GATE:
        del states[FRESH]
    for name in MEASUREMENTS:
        for state, extra in states.items():
            command = [sys.executable, str(Path(__file__)), name, state, *sys.argv[1:]]
            kept = {key: value for key, value in os.environ.items() if key not in _KEEP}
            answer = subprocess.run(
                command, env=kept | extra, check=True, capture_output=True, text=True
            )
            found += [measure.Row(**fields_) for fields_ in json.loads(answer.stdout)]
    return found


if __name__ == "__main__":
    print(json.dumps([dataclasses.asdict(one) for one in MEASUREMENTS[sys.argv[1]](sys.argv[2])]))
