"""Partial slip of a paraboloid, error against time: MDR and Tamaas. `make chart-partial_slip`.

The frictional solvers of Tamaas use a different model: the domain is periodic, nu = 1/2, and the
pressure bounds the magnitude of the shear stress vector, which therefore has a transverse component
that Cattaneo and Mindlin neglect. The difference is therefore not only numerical error. The charts
compare the component along the load, for r < 0.9 a, relative to mu times the largest pressure.
"""

from __future__ import annotations

from time import thread_time
from typing import TYPE_CHECKING

import numpy as np
import tamaas
from drawing import BLUE, BROWN, GREEN, MDR_COLOR, panels, save, table
from machine import footer

from mdr_core import fields, normal, tangential
from mdr_core.profiles import Paraboloid

if TYPE_CHECKING:
    from collections.abc import Callable

Array = np.ndarray
#: R = a = E* = 1; a square domain of width 4 a; half of the limiting force.
WIDTH, FORCE, FRICTION, POISSON = 4.0, 4.0 / 3.0, 0.3, 0.5
TANGENTIAL_FORCE = 0.5 * FRICTION * FORCE
STICK = 0.5 ** (1 / 3)
HIGHEST = FRICTION * 2 / np.pi
#: Kato's iteration runs for a fixed number of steps, since its tolerance is not reached in
#: reasonable time.
RUNS = {
    "Tamaas, Polonsky-Keer with friction": (tamaas.PolonskyKeerTan, (32, 64, 128), 3000),
    "Tamaas, Kato": (tamaas.Kato, (32, 64), 1000),
    "Tamaas, Condat": (tamaas.Condat, (32, 64), 1000),
}
PATIENCE, SAMPLES = 4.0, 3
HEADER = ("method", "resolution", "seconds", "largest error", "rms error")


def pixels(count: int) -> Array:
    """Radii of the pixel centres."""
    x = (np.arange(count) + 0.5) * (WIDTH / count) - WIDTH / 2
    return np.hypot(*np.meshgrid(x, x, indexing="ij"))


def by_tamaas(solver: type, count: int, steps: int) -> Callable[[], Array]:
    """Shear stress along the load at the pixels."""
    surface = -(pixels(count) ** 2) / 2

    def run() -> Array:
        kind = tamaas.model_type.surface_2d
        model = tamaas.ModelFactory.createModel(kind, [WIDTH] * 2, [count] * 2)
        model.nu, model.E = POISSON, 1 - POISSON**2
        one = solver(model, surface, 1e-8, FRICTION)
        one.max_iter = steps
        one.solve([TANGENTIAL_FORCE / WIDTH**2, 0.0, FORCE / WIDTH**2])
        return np.abs(np.array(model.traction)[..., 0])

    return run


def by_mdr(count: int) -> Callable[[], Array]:
    """Includes solving for both forces, at as many radii as there are pixels."""
    radius = np.ravel(pixels(count))

    def run() -> Array:
        contact = normal.solve(Paraboloid(1.0), 1.0, normal_force=FORCE)
        pushed = tangential.solve(contact, 2 / 3, FRICTION, tangential_force=TANGENTIAL_FORCE)
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
    tamaas.set_log_level(tamaas.LogLevel.error)
    runs = {
        (name, count): by_tamaas(solver, count, steps)
        for name, (solver, counts, steps) in RUNS.items()
        for count in counts
    }
    runs |= {("MDR", count): by_mdr(count) for count in (32, 64, 128, 256, 512)}
    times: dict[tuple[str, int], list[float]] = {key: [] for key in runs}
    answers = {}
    for _ in range(SAMPLES):
        for key, run in runs.items():
            if sum(times[key]) < PATIENCE:
                start = thread_time()
                answers[key] = run()
                times[key].append(thread_time() - start)
    rows = [
        (name, f"{count}²", float(np.median(times[name, count])), *errors(count, answer))
        for (name, count), answer in answers.items()
    ]
    table(HEADER, rows, "partial_slip")
    figure, (ax,) = panels(1, 1, 3.0)
    colors = (BLUE, GREEN, BROWN, MDR_COLOR)
    for name, color in zip((*RUNS, "MDR"), colors, strict=True):
        seconds, largest, _rms = np.array([row[2:] for row in rows if row[0] == name]).T
        ax.loglog(seconds, largest, "o-", color=color, label=name)
    label = r"largest error of $\tau/(\mu p_0)$ for r < 0.9 a"
    ax.set(xlabel="CPU time [s]", ylabel=label, ylim=(1e-17, 10))
    save(figure, "partial_slip", footer("tamaas"), [ax])


if __name__ == "__main__":
    main()
