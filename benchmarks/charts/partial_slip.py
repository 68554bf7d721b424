"""Partial slip of a paraboloid, error against time: MDR and ASPHER. `make chart-partial_slip`.

ASPHER solves for the tractions of a half-space on a grid, under Coulomb's law for their vector. For
nu = 0 the tangential displacement is that of the traction along the load alone, so that Cattaneo
and Mindlin's solution is exact. Errors are those for r < 0.9 a, relative to mu times the largest
pressure; the largest one lies at the stick edge, where the traction has a kink.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import aspher
import numpy as np
from drawing import BLUE, MDR_COLOR, panels, save, sufficient, table
from machine import footer
from measure import medians

from mdr_core import fields, normal, tangential
from mdr_core.profiles import Paraboloid

if TYPE_CHECKING:
    from collections.abc import Callable

Array = np.ndarray
#: R = a = E* = G* = 1; a square domain of width 2.2 a; half of the limiting force.
WIDTH, FORCE, FRICTION = 2.2, 4.0 / 3.0, 0.3
TANGENTIAL_FORCE = 0.5 * FRICTION * FORCE
STICK = 0.5 ** (1 / 3)
HIGHEST = FRICTION * 2 / np.pi
COUNTS = {"ASPHER": (32, 64, 128, 256), "MDR": (32, 64, 128, 256, 512)}
SECONDS = 20.0
HEADER = ("method", "resolution", "seconds", "largest error", "rms error")


def pixels(count: int) -> Array:
    """Radii of the pixel centres."""
    x = (np.arange(count) + 0.5) * (WIDTH / count) - WIDTH / 2
    return np.hypot(*np.meshgrid(x, x, indexing="ij"))


def by_aspher(count: int) -> Callable[[], Array]:
    """Shear stress along the load at the pixels."""
    gap = np.ravel(pixels(count) ** 2 / 2)

    def run() -> Array:
        law = aspher.CoulombFriction(FRICTION)
        solver = aspher.FrictionSolver(count, WIDTH, E_star=1.0, nu=0.0, model=law)
        solver.set_gap(gap)
        pressed = solver.step(p_bar=FORCE / WIDTH**2)
        pushed = solver.step(q_bar=(TANGENTIAL_FORCE / WIDTH**2, 0.0))
        assert pressed.converged
        assert pushed.converged
        return np.abs(np.reshape(pushed.qx, (count, count)))

    return run


def by_mdr(count: int) -> Callable[[], Array]:
    """Includes solving for both forces, at as many radii as there are pixels."""
    radius = np.ravel(pixels(count))

    def run() -> Array:
        contact = normal.solve(Paraboloid(1.0), 1.0, normal_force=FORCE)
        pushed = tangential.solve(contact, 1.0, FRICTION, tangential_force=TANGENTIAL_FORCE)
        return fields.shear_stress(pushed, radius).reshape(count, count)

    return run


def errors(count: int, answer: Array) -> tuple[float, float]:
    """Maximum and root-mean-square deviation from Eq. (5.38) inside 0.9 a."""
    r = pixels(count)
    inside = r < 0.9
    outer, inner = (np.sqrt(np.maximum(end**2 - r**2, 0.0)) for end in (1.0, STICK))
    error = np.abs(answer / HIGHEST - (outer - inner))[inside]
    return float(error.max()), float(np.sqrt(np.mean(error**2)))


def main() -> None:
    codes = {"ASPHER": by_aspher, "MDR": by_mdr}
    runs = {(name, count): codes[name](count) for name in codes for count in COUNTS[name]}
    seconds = medians(runs, SECONDS)
    rows = [(name, f"{n}²", seconds[name, n], *errors(n, run())) for (name, n), run in runs.items()]
    table(HEADER, rows, "partial_slip")
    draw(rows)


def draw(rows: list[tuple[str, str, float, float, float]]) -> None:
    figure, (ax,) = panels(1, 1, 3.0)
    for name, color in (("ASPHER", BLUE), ("MDR", MDR_COLOR)):
        time, _largest, rms = np.array([row[2:] for row in rows if row[0] == name]).T
        ax.loglog(time, rms, "o-", color=color, label=name)
    label = "rms error of τ/(µp₀) for r < 0.9 a"
    ax.set(xlabel="CPU time [s]", ylabel=label, ylim=(1e-20, 1))
    ax.set_xlim(1e-5, 100)
    sufficient(ax)
    save(figure, "partial_slip", footer("aspher"), [ax])


if __name__ == "__main__":
    main()
