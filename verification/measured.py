"""Measured shapes and curves: closed forms from their points, and moduli from their curves."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final, NamedTuple

from mpmath import atan, atanh, gamma, linspace, mpf, pi, sqrt

from verification.case import Case, at

# Modulus, first contact and offset of the curves.
E_STAR, FIRST, OFFSET = 2.5, 0.0625, 0.03125
POINTS: Final = 101
# Bounds of what the points of a shape, and of a curve, tell.
TABLE, FIT = 1e-12, 1e-12


class Shape(NamedTuple):
    """Shape with the closed forms of its contact at E* = 1."""

    source: str
    equation: str
    profile: dict[str, Any]
    height: Callable[[mpf], Any] | None
    """f(r), None if it is not tabulated."""
    contact: Callable[[mpf], tuple[Any, Any]]
    """Depth and force from the contact radius; of a flat punch from the depth."""


def _sphere(a: mpf) -> tuple[Any, Any]:
    return a * atanh(a), (1 + a**2) * atanh(a) - a


def _ellipsoid(a: mpf) -> tuple[Any, Any]:
    depth, force = _sphere(a / 2)
    return depth, 4 * force / 2


def _hyperboloid(a: mpf) -> tuple[Any, Any]:
    x = 1 / a
    angle = pi / 2 + atan((1 / x - x) / 2)
    return a / 2 * angle / 2, a**2 / 2 * (x + (1 - x**2) / 2 * angle)


def _power(n: int) -> Callable[[mpf], tuple[Any, Any]]:
    def contact(a: mpf) -> tuple[Any, Any]:
        depth = n * mpf(2) ** (n - 2) * gamma(mpf(n) / 2) ** 2 / gamma(n) * a**n
        return depth, 2 * mpf(n) / (n + 1) * depth * a

    return contact


SHAPES: Final[Sequence[Shape]] = (
    Shape(
        *("sneddon", "sphere", {"kind": "sphere", "radius": 1.0}),
        *(lambda r: 1 - sqrt(1 - r**2), _sphere),
    ),
    Shape(
        *("sneddon", "spheroid", {"kind": "ellipsoid", "radius": 2.0, "height": 1.0}),
        *(lambda r: 1 - sqrt(1 - r**2 / 4), _ellipsoid),
    ),
    Shape(
        *("sun", "hyperboloid", {"kind": "hyperboloid", "slope": 0.5, "tip_radius": 2.0}),
        *(lambda r: (sqrt(1 + r**2) - 1) / 2, _hyperboloid),
    ),
    Shape(
        *("galin", "power-law punch", {"kind": "power", "coefficient": 1.0, "exponent": 4.0}),
        *(lambda r: r**4, _power(4)),
    ),
    Shape("sneddon", "cone", {"kind": "cone", "slope": 1.0}, lambda r: r, _power(1)),
    Shape("hertz", "(4.22)-(4.24)", {"kind": "paraboloid", "radius": 0.5}, None, _power(2)),
    Shape(
        *("boussinesq", "rigid flat punch", {"kind": "flat_punch", "radius": 1.0}, None),
        lambda depth: (depth, 2 * depth),
    ),
)


def tables() -> Iterator[Case]:
    """Depth and force of tabulated shapes at a contact radius."""
    for shape in SHAPES:
        if shape.height is None:
            continue
        radii = [float(r) for r in linspace(0, mpf("0.8"), POINTS)]
        heights = [float(shape.height(mpf(r))) for r in radii]
        request = {
            "profile": {"kind": "tabulated", "r": radii, "f": heights},
            "material": {"e_star": 1.0},
            "load": {"contact_radius": 0.6},
        }
        values = shape.contact(mpf(0.6))
        for name, value in zip(("indentation_depth", "normal_force"), values, strict=True):
            case = f"{POINTS} points, {shape.profile['kind']}: {name}"
            place = at(name)
            yield Case(
                shape.source, shape.equation, case, "/v1/normal", request, place, value, TABLE
            )


def curves() -> Iterator[Case]:
    """Modulus, first contact and offset from force-depth curves in another coordinate."""
    for shape in SHAPES:
        states = [shape.contact(a) for a in linspace(mpf("0.01"), mpf("0.7"), POINTS)]
        before = [(mpf(-k) / 100, mpf(0)) for k in range(5, 0, -1)]
        request = {
            "profile": shape.profile,
            "indentation_depth": [float(d + FIRST) for d, _ in (*before, *states)],
            "normal_force": [float(E_STAR * f + OFFSET) for _, f in (*before, *states)],
            "fit": ["e_star", "contact_point", "force_offset"],
        }
        for name, value in zip(request["fit"], (E_STAR, FIRST, OFFSET), strict=True):
            case = f"force-depth curve, {shape.profile['kind']}: {name}"
            place = at(name)
            yield Case(
                *(shape.source, shape.equation, case, "/v1/normal/fit", request, place, value),
                bound=FIT,
            )


def cases() -> Iterator[Case]:
    """Yield all cases of this module."""
    yield from tables()
    yield from curves()
