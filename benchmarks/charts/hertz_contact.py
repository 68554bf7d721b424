"""Hertz contact, error against time: MDR and two grid solvers. `make chart-hertz_contact`.

All methods compute the pressure of a paraboloid under a prescribed force. The grid solvers use n x
n pixels of a square of width 2.2 a with free boundaries. At the contact edge a pixel's pressure
averages a square-root singularity, so the error is evaluated everywhere and for r < 0.9 a, relative
to the largest pressure.
"""

from __future__ import annotations

from time import thread_time
from typing import TYPE_CHECKING

import numpy as np
import tamaas
from ContactMechanics import FreeFFTElasticHalfSpace
from ContactMechanics.Systems import NonSmoothContactSystem
from drawing import BLUE, GREEN, MDR_COLOR, panels, save, sufficient, table
from machine import footer
from SurfaceTopography import Topography

from mdr_core import fields, normal
from mdr_core.profiles import Paraboloid

if TYPE_CHECKING:
    from collections.abc import Callable

Array = np.ndarray
#: R = a = E* = 1.
WIDTH, FORCE, HIGHEST = 2.2, 4.0 / 3.0, 2 / np.pi
PIXELS, TOLERANCE = (64, 128, 256, 512), 1e-8
#: Samples are taken up to this total time, and at most this many.
PATIENCE, SAMPLES = 6.0, 5
HEADER = ("method", "resolution", "seconds", "largest error", "largest error for r < 0.9 a")


def pixels(count: int) -> Array:
    """Radii of the pixel centres."""
    x = (np.arange(count) + 0.5) * (WIDTH / count) - WIDTH / 2
    return np.hypot(*np.meshgrid(x, x, indexing="ij"))


def by_tamaas(count: int) -> Callable[[], Array]:
    """Polonsky and Keer's conjugate gradients with a padded transform."""
    radius = pixels(count)

    def run() -> Array:
        kind = tamaas.model_type.basic_2d
        model = tamaas.ModelFactory.createModel(kind, [WIDTH] * 2, [count] * 2)
        model.E, model.nu = 1.0, 0.0
        tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
        solver = tamaas.PolonskyKeerRey(model, -(radius**2) / 2, TOLERANCE)
        solver.setIntegralOperator("dcfft")
        solver.solve(FORCE / WIDTH**2)
        return np.array(model.traction)

    return run


def by_contact_mechanics(count: int) -> Callable[[], Array]:
    """The same algorithm in ContactMechanics."""
    surface = Topography(-(pixels(count) ** 2) / 2, (WIDTH, WIDTH))

    def run() -> Array:
        half_space = FreeFFTElasticHalfSpace((count, count), 1.0, (WIDTH, WIDTH))
        system = NonSmoothContactSystem(half_space, surface)
        answer = system.minimize_proxy(external_force=FORCE, pentol=TOLERANCE)
        return np.array(answer.jac)[:count, :count] * (count / WIDTH) ** 2

    return run


def by_mdr(count: int) -> Callable[[], Array]:
    """Includes solving for the force, at as many radii as there are pixels."""
    radius = np.ravel(pixels(count))

    def run() -> Array:
        contact = normal.solve(Paraboloid(1.0), 1.0, normal_force=FORCE)
        return fields.pressure(contact, radius).reshape(count, count)

    return run


METHODS = {"Tamaas": by_tamaas, "ContactMechanics": by_contact_mechanics, "MDR": by_mdr}


def errors(count: int, answer: Array) -> tuple[float, float]:
    """Largest error everywhere and for r < 0.9 a, relative to the largest pressure."""
    radius = pixels(count)
    error = np.abs(answer / HIGHEST - np.sqrt(np.maximum(1 - radius**2, 0.0)))
    return float(error.max()), float(error[radius < 0.9].max())


def main() -> None:
    tamaas.set_log_level(tamaas.LogLevel.error)
    rows = []
    for count in PIXELS:
        runs = {name: make(count) for name, make in METHODS.items()}
        times: dict[str, list[float]] = {name: [] for name in runs}
        answers = {}
        for _ in range(SAMPLES):
            for name, run in runs.items():
                if sum(times[name]) < PATIENCE:
                    start = thread_time()
                    answers[name] = run()
                    times[name].append(thread_time() - start)
        rows += [
            (name, f"{count}²", float(np.median(times[name])), *errors(count, answers[name]))
            for name in runs
        ]
    table(HEADER, rows, "hertz_contact")
    draw(rows)


def draw(rows: list[tuple[str, str, float, float, float]]) -> None:
    figure, (ax,) = panels(1, 1, 3.2)
    for name, color in zip(METHODS, (BLUE, GREEN, MDR_COLOR), strict=True):
        seconds, largest, inside = np.array([row[2:] for row in rows if row[0] == name]).T
        ax.loglog(seconds, inside, "o-", color=color, label=f"{name}, r < 0.9 a")
        ax.loglog(seconds, largest, "o--", color=color, alpha=0.4, label=f"{name}, everywhere")
    ax.set(xlabel="CPU time [s]", ylabel="largest error / largest pressure", ylim=(1e-20, 10))
    ax.set_xlim(1e-4, 100)
    sufficient(ax)
    save(figure, "hertz_contact", footer("tamaas", "ContactMechanics"), [ax])


if __name__ == "__main__":
    main()
