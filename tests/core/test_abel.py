"""The singular integrals by themselves: kernel minimum, and the generic route on every kind."""

from __future__ import annotations

from math import lgamma
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from mdr_core import abel
from mdr_core.errors import AccuracyError
from tests.core.comparison import DERIVED_BREAK, INPUT, profile_from, relative_error
from tests.core.generic_route import RTOL, GenericRoute
from tests.oracles import bank

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

BOUND = 1e-12
END = 1.5
#: Radii from the axis to just inside the end, and the end of the panels.
INSIDE = np.array([0.0, 1e-9, 1e-3, 0.4, 0.9, 1.2, END * (1 - 1e-9)])
X = np.append(INSIDE, END)
B = 0.7
repeatable = settings(derandomize=True, deadline=None, max_examples=60)


def line(r: Array) -> Array:
    """F = r: the paraboloid of unit radius."""
    return 1.0 * r


def kinked(r: Array) -> Array:
    """F of a truncated cone of unit slope and flat B."""
    return np.where(r < B, 0.0, 1.0)


def forward(slope: Callable[[Array], Array], breaks: tuple[float, ...], x: Array) -> Array:
    return abel.forward(abel.resolve(slope, END, breaks), x)


def forward_moment(slope: Callable[[Array], Array], breaks: tuple[float, ...], x: Array) -> Array:
    return abel.forward_moment(abel.resolve(slope, END, breaks), x)


def forward_slope(slope: Callable[[Array], Array], breaks: tuple[float, ...], x: Array) -> Array:
    return GenericRoute(slope, END, breaks).regular(x, np.zeros_like(x))


def stress(slope: Callable[[Array], Array], breaks: tuple[float, ...], r: Array) -> Array:
    return GenericRoute(slope, END, breaks).stress.kernel(np.asarray(END), r, RTOL)


def back(g: Callable[[Array], Array], breaks: tuple[float, ...], r: Array) -> Array:
    return abel.back(g, r, breaks)[0]


TRANSFORMS = {
    "forward": forward,
    "forward_moment": forward_moment,
    "forward_slope": forward_slope,
    "stress": stress,
    "back": back,
}
#: F = r to the paraboloid's g, N, g' and pi p/E*; g = x to its f.
SMOOTH: dict[str, Callable[[Array], Array]] = {
    "forward": lambda x: x**2,
    "forward_moment": lambda x: 4 / 3 * x**3,
    "forward_slope": lambda x: 2 * x,
    "stress": lambda r: 2 * np.sqrt((END - r) * (END + r)),
    "back": lambda r: 2 / np.pi * r,
}


def places(name: str) -> Array:
    """The kernel ends before the contact's edge, the others on the panels' end."""
    return INSIDE if name == "stress" else X


@pytest.mark.parametrize("name", TRANSFORMS)
def test_one_exact_pair_from_end_to_end(name: str) -> None:
    x = places(name)
    found = TRANSFORMS[name](line, (), x)
    assert found.shape == x.shape
    assert np.allclose(found, SMOOTH[name](x), rtol=1e-13, atol=0)


def test_one_exact_pair_with_a_jump() -> None:
    """The truncated cone: its slope begins with a jump, and g with a root."""
    x = np.array([0.0, 0.3, B, B * (1 + 1e-12), B * (1 + 1e-6), 0.8, END])
    s = np.sqrt(np.maximum(x - B, 0) * (x + B))
    angle = np.arctan(s / B)
    assert np.allclose(forward(kinked, (B,), x), x * angle, rtol=1e-13, atol=0)
    force = x**2 * angle + B * s
    assert np.allclose(forward_moment(kinked, (B,), x), force, rtol=1e-13, atol=0)
    beyond = x > B
    slope = angle[beyond] + B / s[beyond]
    assert np.allclose(forward_slope(kinked, (B,), x)[beyond], slope, rtol=1e-13, atol=0)


@pytest.mark.parametrize("name", TRANSFORMS)
def test_zero_to_zero_and_nothing_to_nothing(name: str) -> None:
    assert not TRANSFORMS[name](np.zeros_like, (B,), places(name)).any()
    assert TRANSFORMS[name](line, (), np.empty(0)).shape == (0,)


@pytest.mark.parametrize("name", TRANSFORMS)
def test_the_input_is_left_alone(name: str) -> None:
    x = places(name).copy()
    # Writing into it would raise.
    x.flags.writeable = False
    TRANSFORMS[name](kinked if name != "back" else line, (B,), x)


@pytest.mark.parametrize("name", TRANSFORMS)
@settings(repeatable, max_examples=20)
@given(st.floats(0.01, 3.0), st.floats(0.01, 3.0), st.sampled_from([2, 3, 4, 7]))
def test_linear(name: str, first: float, second: float, exponent: int) -> None:
    x, transform = places(name)[1:], TRANSFORMS[name]

    def steep(r: Array) -> Array:
        return r**exponent

    def both(r: Array) -> Array:
        return first * r + second * steep(r)

    parts = first * transform(line, (), x) + second * transform(steep, (), x)
    assert np.allclose(transform(both, (), x), parts, rtol=1e-11, atol=0)


def one_sided(
    weight: Callable[[Array, Array], Array], r: Array, a: float, *, odd: bool = False
) -> Array:
    upper = np.full(r.shape, np.sqrt((a - B) * (a + B)))
    edge = np.full(r.shape, a)
    return abel.one_sided(lambda x, s, _: weight(x, s), B, r, upper, edge=edge, odd=odd, rtol=RTOL)


# r = B itself is another rule; there and about it the two must meet.
AROUND = np.array([0.0, 1e-9, 0.3, B * (1 - 1e-9), B, B * (1 + 1e-9), 0.9, END * (1 - 1e-9)])


def test_one_sided_even_weight() -> None:
    """F = x: sqrt(a^2 - r^2) - sqrt(b^2 - r^2)."""
    kept = AROUND.copy()
    found = one_sided(lambda _, s: s, AROUND, END)
    low = np.sqrt(np.maximum(B - AROUND, 0) * (B + AROUND))
    exact = np.sqrt((END - AROUND) * (END + AROUND)) - low
    assert found.shape == AROUND.shape
    assert np.allclose(found, exact, rtol=1e-13, atol=0)
    assert np.array_equal(AROUND, kept)


def test_one_sided_pole() -> None:
    """F = x/s: arcsinh(s_a/k) below the break, arccosh(s_a/k) above, k^2 = |r^2 - b^2|."""
    found = one_sided(lambda x, _: np.ones_like(x), AROUND, END, odd=True)
    k = np.sqrt(np.abs(AROUND - B) * (AROUND + B))
    top = np.sqrt((END - B) * (END + B))
    leg = np.sqrt((END - AROUND) * (END + AROUND))
    with np.errstate(divide="ignore"):
        below, above = np.arcsinh(top / k), np.arcsinh(leg / k)
    exact = np.where(AROUND < B, below, above)
    assert np.isinf(found[AROUND == B]).all()
    assert np.allclose(found, exact, rtol=1e-13, atol=0)


def test_one_sided_annulus_is_a_difference() -> None:
    """Jaeger's superposition, where the difference keeps its digits."""
    c, r = 1.0, AROUND[AROUND < 1.0]
    upper, lower = (np.full(r.shape, np.sqrt(e * e - B * B)) for e in (END, c))

    def weight(x: Array, s: Array, _: NDArray[np.intp]) -> Array:
        return (2 * s - B * np.arctan(s / B)) * s / x

    annulus = abel.one_sided(weight, B, r, upper, width=upper - lower, odd=True, rtol=RTOL)
    whole = abel.one_sided(weight, B, r, upper, odd=True, rtol=RTOL)
    inner = abel.one_sided(weight, B, r, lower, odd=True, rtol=RTOL)
    assert np.allclose(annulus, whole - inner, rtol=1e-12, atol=0)


@repeatable
@given(st.floats(0.05, 0.95), st.sampled_from([(), (B,)]))
def test_stress_annulus_is_a_difference(ratio: float, breaks: tuple[float, ...]) -> None:
    """G is the same to both limits, so that only the limits differ."""
    route = GenericRoute(kinked if breaks else line, END, breaks)
    c = END * ratio
    r = np.array([0.0, 1e-3, 0.3, 0.9]) * c
    width = np.full(r.shape, END - c)
    annulus = route.stress.kernel(np.asarray(END), r, RTOL, width)
    whole = route.stress.kernel(np.asarray(END), r, RTOL)
    inner = route.stress.kernel(np.asarray(c), r, RTOL)
    assert np.allclose(annulus, whole - inner, rtol=1e-12, atol=1e-14 * whole.max())


def exact_displacement(r: Array, a: float) -> Array:
    """Of the paraboloid outside the contact: (2/pi) int_0^a (a^2 - x^2)/sqrt(r^2 - x^2) dx."""
    angle, leg = np.arcsin(a / r), np.sqrt((r - a) * (r + a))
    return 2 / np.pi * ((a * a - r * r / 2) * angle + a * leg / 2)


def test_surface_displacement() -> None:
    a, r = 0.8, np.array([0.8, 0.8 * (1 + 1e-9), 1.0, 3.0])
    found, bound = abel.back(lambda x: (a - x) * (a + x), r, (), upper=a)
    assert bound <= 1e-12
    assert np.allclose(found, exact_displacement(r, a), rtol=1e-12, atol=0)


def back_cases() -> list[dict[str, Any]]:
    """All but the flat, whose g is infinite."""
    return [case for case in bank.load("profile") if case["profile"]["kind"] != "flat_punch"]


def errors_of_back(case: dict[str, Any], rtol: float) -> tuple[Array, Array, float]:
    """Radii, errors beyond what the input's rounding explains, and the bound returned.

    Just beyond a flat, g is known by its x alone, and has itself lost its digits.
    """
    profile = profile_from(case["profile"])
    b = max(map(float, profile.breaks), default=0.0)
    r = np.array(case["x"])
    resolved = (r <= b) | (r >= b * (1 + 1e-5))
    breaks = tuple(map(float, profile.breaks))
    found, bound = abel.back(profile.g, r[resolved], breaks, rtol=rtol)
    expected = [value for value, kept in zip(case["f"], resolved, strict=True) if kept]
    errors = [relative_error(float(v), e) for v, e in zip(found, expected, strict=True)]
    derived = case["profile"]["kind"] in DERIVED_BREAK
    allowed = INPUT * np.array(case["condition_f"])[resolved] if derived else 0.0
    return r[resolved], np.maximum(np.array(errors) - allowed - 2e-14, 0.0), bound


@pytest.mark.parametrize("rtol", [1e-4, 1e-8, 1e-12])
@pytest.mark.parametrize("case", back_cases(), ids=lambda case: str(case["id"]))
def test_back_returns_the_shape(case: dict[str, Any], rtol: float) -> None:
    """From the closed form's g to the stored f, as exactly as asked for."""
    _, errors, _ = errors_of_back(case, rtol)
    assert errors.max() <= rtol


@pytest.mark.parametrize("rtol", [1e-4, 1e-8, 1e-12])
@pytest.mark.parametrize("case", back_cases(), ids=lambda case: str(case["id"]))
def test_back_never_understates_its_error(case: dict[str, Any], rtol: float) -> None:
    radii, errors, bound = errors_of_back(case, rtol)
    assert errors.max() <= bound, radii[np.argmax(errors)]


def generic(case: dict[str, Any], upper: float) -> GenericRoute:
    profile = profile_from(case["profile"])
    return GenericRoute(profile.df, upper, tuple(float(b) for b in profile.breaks))


def with_radius(name: str) -> list[dict[str, Any]]:
    """Cases whose contact radius is given, exactly; a flat's f' is not finite."""
    return [
        case
        for case in bank.load(name)
        if case["control"] == "contact_radius" and case["profile"]["kind"] != "flat_punch"
    ]


@pytest.mark.parametrize(
    "case",
    with_radius("normal"),
    ids=lambda case: str(case["id"]),
)
def test_generic_depth_and_force(case: dict[str, Any]) -> None:
    a = case["load"]
    route = generic(case, a)
    expected, edge = case["expected"], np.array([a])
    depth, force = float(route.g(edge)[0]), float(route.force(edge)[0]) * case["e_star"]
    for name, value in (("indentation_depth", depth), ("normal_force", force)):
        # Just beyond a break computed from parameters, the distance from it is uncertain.
        derived = case["profile"]["kind"] in DERIVED_BREAK
        allowed = INPUT * case["condition"][name] if derived else 0.0
        assert relative_error(value, expected[name]) <= BOUND + allowed, name


@pytest.mark.parametrize(
    "case",
    with_radius("pressure"),
    ids=lambda case: str(case["id"]),
)
def test_generic_inverse(case: dict[str, Any]) -> None:
    """a(d) by a bracketed root of the generic g, from the closed form's depth."""
    profile, a = profile_from(case["profile"]), case["load"]
    upper = a * (1 + 1e-3) if a * (1 + 1e-3) < np.min(profile.domain) else a
    route = generic(case, upper)
    coordinate = profile.coordinate_from_radius(np.array(a))
    depth = float(profile.depth(coordinate))

    def excess(x: float) -> float:
        return float(route.g(np.array([x]))[0]) - depth

    low = max((b for b in map(float, profile.breaks) if b < a), default=0.0)
    root = a if excess(upper) <= 0 else brentq(excess, low, upper, xtol=1e-300, rtol=1e-15)
    # d log(a)/d log(d), for the rounding of the depth.
    condition = depth / (a * float(profile.dg(np.array([a]))[0]))
    assert root == pytest.approx(a, rel=BOUND + INPUT * condition)


@pytest.mark.parametrize(
    "case",
    with_radius("pressure"),
    ids=lambda case: str(case["id"]),
)
def test_generic_pressure(case: dict[str, Any]) -> None:
    route = generic(case, case["load"])
    found = route.pressure(np.array(case["radius"])) * case["e_star"]
    derived = case["profile"]["kind"] in DERIVED_BREAK
    failures = []
    for index, (radius, expected) in enumerate(zip(case["radius"], case["expected"], strict=True)):
        error = relative_error(float(found[index]), expected)
        condition = (case["condition_radius"][index] or 0.0) if derived else 0.0
        bound = BOUND + INPUT * condition
        if error > bound:
            failures.append(f"r = {radius!r}: {error:.2e} > {bound:.2e}")
    assert not failures, failures


UNDECLARED = {
    "rounded punch": {"kind": "rounded_punch", "flat_radius": 0.95, "rounding_radius": 2.0},
    "truncated cone": {"kind": "truncated_cone", "flat_radius": 0.6, "slope": 0.3},
    "rounded cone": {"kind": "rounded_cone", "slope": 0.4, "tip_radius": 1.5},
    "capped": {
        "kind": "capped_paraboloid",
        "cap_radius": 0.6,
        "tip_radius": 3.0,
        "radius": 1.1,
    },
}


@pytest.mark.parametrize("name", UNDECLARED)
def test_undeclared_breaks_are_found(name: str) -> None:
    profile = profile_from(UNDECLARED[name])
    route = GenericRoute(profile.df, 1.0)
    b = float(profile.breaks[0])
    # Nearer to the break g itself is still small there: the bound is relative to g(a).
    x = np.array([0.1, b * (1 - 1e-6), b * (1 + 1e-6), b * (1 + 1e-3), 0.99, 1.0])
    exact = profile.g(x)
    assert np.abs(route.g(x) - exact).max() <= BOUND * exact.max()
    force = profile.reduced_force(profile.coordinate_from_radius(np.array([1.0])))
    assert route.force(np.array([1.0])) == pytest.approx(force, rel=BOUND)
    (found,) = abel.find_breaks(profile.df, 1.0)
    # A kink is felt as far as the function changes by its rounding: the root of eps.
    assert found == pytest.approx(b, rel=3e-8)


#: A kink of f' at a place that is off by d costs a part of p that goes with a power of d.
REACHED = {"rounded punch": 3e-12, "rounded cone": 1e-12}


@pytest.mark.parametrize("name", REACHED)
def test_pressure_of_an_undeclared_kink(name: str) -> None:
    profile = profile_from(UNDECLARED[name])
    breaks = tuple(abel.find_breaks(profile.df, 1.0))
    b = float(profile.breaks[0])
    r = np.array([0.0, 0.1, 0.9 * b, b * (1 - 1e-3), b * (1 + 1e-3), b * 1.02, 1 - 1e-9])
    found = GenericRoute(profile.df, 1.0, breaks).pressure(r)
    ones = np.ones_like(r)
    exact = profile.pressure_kernel(profile.coordinate_from_radius(ones), r, RTOL, edge=ones)
    assert np.abs(found / exact - 1).max() <= REACHED[name]


@pytest.mark.parametrize("name", UNDECLARED)
def test_pressure_across_an_undeclared_break(name: str) -> None:
    """Nobody declared it: a jump is found, and of a kink the error says how bad the panels are."""
    profile = profile_from(UNDECLARED[name])
    route = GenericRoute(profile.df, 1.0)
    b = float(profile.breaks[0])
    r = np.array([0.0, 0.1, 0.9 * b, b * (1 - 1e-3), b * (1 + 1e-3), 1 - 1e-9])
    ones = np.ones_like(r)
    exact = profile.pressure_kernel(profile.coordinate_from_radius(ones), r, RTOL, edge=ones)
    bound = max(route.slope.error, route.stress.error)
    assert np.abs(route.pressure(r) / exact - 1).max() <= bound + BOUND


@pytest.mark.parametrize("size", [1e-2, 1e-6, 1e-11])
def test_noise_is_refused(size: float) -> None:
    random = np.random.default_rng(3)
    with pytest.raises(AccuracyError):
        abel.resolve(lambda r: r + size * random.standard_normal(r.shape), 1.0)


@repeatable
@given(st.floats(0.3, 9.0), st.floats(1e-9, 1e9))
def test_panels_never_understate_their_error(exponent: float, upper: float) -> None:
    """A power at the axis is the hardest that a smooth body can offer."""
    panels = abel.resolve(lambda r: r**exponent, upper)
    x = upper * np.array([1e-6, 1e-3, 0.1, 0.7, 1.0])
    found = abel.forward(panels, x)
    # int_0^(pi/2) sin^n: Wallis.
    exact = x ** (exponent + 1) * wallis(exponent)
    assert np.abs(found / exact - 1).max() <= panels.error + 1e-13


def wallis(n: float) -> float:
    """int_0^(pi/2) sin^n = sqrt(pi)/2 Gamma((n + 1)/2)/Gamma(n/2 + 1)."""
    return float(np.sqrt(np.pi) / 2 * np.exp(lgamma((n + 1) / 2) - lgamma(n / 2 + 1)))
