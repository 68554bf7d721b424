"""Ball on a bonded incompressible layer: MDR, and the published approximations of its force.

`make chart-layers`. Left: largest error of the force against the time of 1000 depths, for contacts
up to half the thickness and up to three times it. Right: error against sqrt(R d)/h. The reference
is the integral equation with 30 digits.
"""

from __future__ import annotations

from time import thread_time
from typing import TYPE_CHECKING

import numpy as np
from drawing import BLUE, BROWN, GREEN, MDR_COLOR, VIOLET, panels, save, table
from machine import footer
from mpmath import mp
from tests.oracles.layer_reference import DIGITS, LayerContact

from mdr_core import Layer, Material, Paraboloid, layer, normal

if TYPE_CHECKING:
    from collections.abc import Callable

Array = np.ndarray
#: Largest contact radii of both comparisons, and those of the reference, over the thickness.
THICK, THIN = 0.5, 3.0
PARTS = np.append(np.geomspace(0.05, THICK, 8), np.geomspace(THICK, THIN, 7)[1:])
COUNT = 1000
BALL, SAMPLE = Paraboloid(1.0), Layer(1.0, "bonded", 0.5)
HEADER = ("method", "largest a/h", "seconds for 1000 depths", "largest relative error")


def half_space(depth: Array) -> Array:
    """Hertz's force for R = E* = 1."""
    return normal.solve(BALL, 1.0, indentation_depth=depth).normal_force


def dimitriadis(depth: Array) -> Array:
    """E. K. Dimitriadis et al., Biophys. J. 82 (2002) 2798-2810, Eq. (12), nu = 1/2, R = h = 1."""
    x = np.sqrt(depth)
    return 4 / 3 * x**3 * (1 + x * (1.133 + x * (1.283 + x * (0.769 + x * 0.0975))))


def garcia(depth: Array) -> Array:
    """P. D. Garcia, R. Garcia, Biophys. J. 114 (2018) 2923-2932, sphere, nu = 1/2, R = h = 1."""
    x = np.sqrt(depth)
    return 4 / 3 * x**3 * (1 + x * (1.133 + x * (1.497 + x * (1.469 + x * 0.755))))


def by_mdr(depth: Array) -> Array:
    """Force by the equation of each depth."""
    return layer.solve(BALL, Material(1.0, layer=SAMPLE), indentation_depth=depth).normal_force


def by_curve(depth: Array) -> Array:
    """Force interpolated over the depth, as in fits, with the time of the interpolation."""
    return layer.DepthCurve.up_to(BALL, SAMPLE, float(depth.max()))(depth)[0]


METHODS: dict[str, tuple[Callable[[Array], Array], str]] = {
    "half-space": (half_space, BROWN),
    "Dimitriadis 2002": (dimitriadis, BLUE),
    "Garcia 2018": (garcia, GREEN),
    "MDR, as in fits": (by_curve, VIOLET),
    "MDR": (by_mdr, MDR_COLOR),
}


def references() -> tuple[Array, Array]:
    """Depths and forces for R = h = E* = 1, in which a is the part of the thickness."""
    found = []
    for part in PARTS:
        with mp.workdps(DIGITS):
            ball = {"kind": "paraboloid", "radius": float(1 / part)}
            known = LayerContact(ball, float(1 / part), "bonded", 0.5).solved
            # Lengths are in units of a there.
            found.append((known["indentation_depth"] * part, known["normal_force"] * part**2))
    depth, force = np.array(found, dtype=float).T
    return depth, force


def seconds(run: Callable[[Array], Array], depth: Array) -> float:
    """Least processor time of some runs."""
    times = []
    for _ in range(7):
        start = thread_time()
        run(depth)
        times.append(thread_time() - start)
    return min(times)


def main() -> None:
    depth, force = references()
    figure, (left, right) = panels(1, 2, 2.9)
    rows = []
    for name, (run, color) in METHODS.items():
        error = np.maximum(np.abs(run(depth) / force - 1), 1e-16)
        right.plot(np.sqrt(depth), error, "o-", color=color, label=name)
        points = []
        for most in (THICK, THIN):
            inside = most * (1 + 1e-9) >= PARTS
            time = seconds(run, np.linspace(0, depth[inside][-1], COUNT + 1)[1:])
            points.append((time, error[inside].max()))
            rows.append((name, most, *points[-1]))
        left.plot(*np.transpose(points), "-", color=color, label=name)
        for point, face in zip(points, (color, "white"), strict=True):
            left.plot(*point, "o", color=color, markerfacecolor=face)
    table(HEADER, rows, "layers")
    left.set(xscale="log", yscale="log", xlabel="seconds for 1000 depths", xlim=(3e-6, 30))
    left.set(ylabel="largest relative error of the force", ylim=(1e-16, 10))
    left.set_title("Contact radii up to 0.5 h (filled) and 3 h (open)")
    right.set(xscale="log", yscale="log", xlabel="√(R d)/h", ylim=(1e-16, 10))
    right.set_title("Relative error of the force at a depth")
    save(figure, "layers", footer(), [left, right])


if __name__ == "__main__":
    main()
