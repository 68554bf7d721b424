"""Normal contacts obey the laws of energy, order, inversion and units."""

from __future__ import annotations

import itertools
from math import pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial.legendre import leggauss

from mdr_core import fields
from mdr_core.normal import NormalContact, solve
from mdr_core.profiles import TruncatedParaboloid
from tests.core.comparison import profile_from

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

E_STAR = 3.7
LOADS = ("indentation_depth", "normal_force", "contact_radius")
#: Fields with the dimension of a length; slopes and exponents are dimensionless.
LENGTHS = frozenset(
    {"radius", "height", "flat_radius", "rounding_radius", "tip_radius", "cap_radius"}
)

length = st.floats(0.3, 3.0)
slope = st.floats(0.05, 1.5)
coefficient = st.floats(0.05, 2.0)
exponent = st.floats(0.3, 9.0)
term = st.fixed_dictionaries({"coefficient": coefficient, "exponent": exponent})
terms = st.lists(term, min_size=2, max_size=4)

PROFILES: dict[str, dict[str, Any]] = {
    "cone": {"slope": slope},
    "paraboloid": {"radius": length},
    "sphere": {"radius": length},
    "ellipsoid": {"radius": length, "height": length},
    "power": {"coefficient": coefficient, "exponent": exponent},
    "series": {"terms": terms},
    "rounded_punch": {"flat_radius": length, "rounding_radius": length},
    "truncated_cone": {"flat_radius": length, "slope": slope},
    "truncated_paraboloid": {"flat_radius": length, "radius": length},
    "rounded_cone": {"slope": slope, "tip_radius": length},
    "spherical_tip_cone": {"slope": slope, "tip_radius": length},
    "hyperboloid": {"slope": slope, "tip_radius": length},
    "capped_paraboloid": {
        "cap_radius": length,
        "tip_radius": st.floats(2.0, 5.0),
        "radius": st.floats(0.3, 2.0),
    },
}


def break_radius(fields_: dict[str, Any]) -> float:
    """Radius where the profile's slope or curvature jumps; 0 if there is none."""
    kind = fields_["kind"]
    if kind == "rounded_cone":
        return float(fields_["slope"] * fields_["tip_radius"])
    if kind == "spherical_tip_cone":
        return float(fields_["tip_radius"] * fields_["slope"] / sqrt(1 + fields_["slope"] ** 2))
    return float(fields_.get("flat_radius", fields_.get("cap_radius", 0.0)))


def edge(fields_: dict[str, Any], ratio: float) -> float:
    """A contact radius: inside a sphere, beyond a flat, otherwise on either side of the break."""
    if fields_["kind"] in {"sphere", "ellipsoid"}:
        return float(fields_["radius"] * 0.95 * ratio / 3)
    if fields_["kind"] in {"rounded_punch", "truncated_cone", "truncated_paraboloid"}:
        return break_radius(fields_) * (1 + ratio)
    return (break_radius(fields_) or 1.0) * ratio


@st.composite
def cases(draw: st.DrawFn) -> tuple[dict[str, Any], float]:
    kind = draw(st.sampled_from(sorted(PROFILES)))
    chosen = {"kind": kind, **draw(st.fixed_dictionaries(PROFILES[kind]))}
    return chosen, edge(chosen, draw(st.floats(0.05, 3.0)))


repeatable = settings(derandomize=True, deadline=None, max_examples=70)


def at_radius(fields_: dict[str, Any], radius: float) -> NormalContact:
    return solve(profile_from(fields_), E_STAR, contact_radius=radius)


def graded(low: float, high: float) -> tuple[Array, Array]:
    """Nodes and weights that cluster at both ends, where integrands have roots and logarithms."""
    nodes, weights = leggauss(120)
    u, w = (nodes + 1) / 2, weights / 2
    for _ in range(2):
        w = w * 30 * u**2 * (1 - u) ** 2
        u = u**3 * (10 - 15 * u + 6 * u**2)
    # Strictly inside, since the value at the end can be infinite.
    inside = np.clip(low + (high - low) * u, np.nextafter(low, high), np.nextafter(high, low))
    return inside, (high - low) * w


def integral(fn: Callable[[Array], Array], knots: list[float]) -> float:
    total = 0.0
    for low, high in itertools.pairwise(knots):
        x, w = graded(low, high)
        total += float(w @ fn(x))
    return total


@repeatable
@given(cases())
def test_stiffness_is_the_derivative_of_the_force(case: tuple[dict[str, Any], float]) -> None:
    fields_, radius = case
    depth = float(at_radius(fields_, radius).indentation_depth)
    profile = profile_from(fields_)

    def stiffness(d: Array) -> Array:
        return solve(profile, E_STAR, indentation_depth=d).normal_stiffness

    ends = solve(profile, E_STAR, indentation_depth=[depth, 1.3 * depth]).normal_force
    knots = [depth, 1.3 * depth]
    b = break_radius(fields_)
    at_break = float(profile.g(np.array([b]))[0]) if b > 0 else 0.0
    if depth < at_break < 1.3 * depth:
        knots.insert(1, at_break)
    # The error is that of the rule: beyond a break, a(d) starts like a square root.
    assert ends[1] - ends[0] == pytest.approx(integral(stiffness, knots), rel=1e-5, abs=0)


@repeatable
@given(cases())
def test_energy_is_the_work_of_the_force(case: tuple[dict[str, Any], float]) -> None:
    fields_, radius = case
    contact = at_radius(fields_, radius)
    profile = profile_from(fields_)

    def force(d: Array) -> Array:
        return solve(profile, E_STAR, indentation_depth=d).normal_force

    knots = [0.0, float(contact.indentation_depth)]
    b = break_radius(fields_)
    if 0 < b < radius:
        knots.insert(1, float(profile.g(np.array([b]))[0]))
    work = integral(force, sorted(set(knots)))
    assert float(contact.elastic_energy) == pytest.approx(work, rel=1e-10, abs=0)


@repeatable
@given(cases())
def test_pressure_integrates_to_the_force(case: tuple[dict[str, Any], float]) -> None:
    fields_, radius = case
    contact = at_radius(fields_, radius)

    def ring(r: Array) -> Array:
        return 2 * pi * r * fields.pressure(contact, r)

    b = break_radius(fields_)
    knots = [0.0, b, radius] if 0 < b < radius else [0.0, radius]
    assert integral(ring, knots) == pytest.approx(float(contact.normal_force), rel=1e-8, abs=0)


def rescaled(fields_: dict[str, Any], unit: float) -> dict[str, Any]:
    """The same body in a unit of length 1/`unit` times the old one."""
    out = dict(fields_)
    for name in LENGTHS & out.keys():
        out[name] = out[name] * unit
    if "exponent" in out:
        out["coefficient"] = out["coefficient"] * unit ** (1 - out["exponent"])
    if "terms" in out:
        out["terms"] = [rescaled(one, unit) for one in out["terms"]]
    return out


@repeatable
@given(cases(), st.floats(-9.0, 3.0), st.floats(-6.0, 6.0))
def test_results_scale_with_units(
    case: tuple[dict[str, Any], float], length_power: float, modulus_power: float
) -> None:
    fields_, radius = case
    unit, modulus = 10.0**length_power, 10.0**modulus_power
    old = at_radius(fields_, radius)
    force = float(old.normal_force) * modulus * unit**2
    new = solve(profile_from(rescaled(fields_, unit)), E_STAR * modulus, normal_force=force)
    # The power's coefficient takes a high power of the unit; its rounding error sets the limit.
    assert float(new.contact_radius) == pytest.approx(radius * unit, rel=1e-12, abs=0)
    depth = float(old.indentation_depth) * unit
    assert float(new.indentation_depth) == pytest.approx(depth, rel=1e-12, abs=0)
    energy = float(old.elastic_energy) * unit**3 * modulus
    assert float(new.elastic_energy) == pytest.approx(energy, rel=1e-11, abs=0)


@pytest.mark.parametrize("unit", [1e-50, 1e-45, 1e45, 1e50])
def test_energy_of_a_truncated_paraboloid_in_any_unit_of_length(unit: float) -> None:
    """The powers of lengths do not leave the range of doubles."""
    old, new = (
        solve(TruncatedParaboloid(0.5 * size, size), E_STAR, indentation_depth=0.3 * size)
        for size in (1.0, unit)
    )
    expected = float(old.elastic_energy)
    assert float(new.elastic_energy) / unit**3 == pytest.approx(expected, rel=1e-13, abs=0)
