"""What a coarse path costs: energy of random cycles under controls of different pairs.

`python benchmarks/coarse_paths.py` prints the relative error of `energy_per_cycle` by the number of
samples per load step (half of the cycles, nine in ten, and all), which `docs/http.md` shows. The
reference has 640 samples. Cycles that dissipate less than 1 % of the product of both ranges, where
energy hardly matters, are left out.
"""

from __future__ import annotations

import sys
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from mdr_core import history, normal
from mdr_core.profiles import (
    Cone,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
    Tabulated,
    TruncatedCone,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

E_STAR, G_STAR, MU, DEPTH = 1.0, 0.85, 0.3, 0.2
SAMPLES, FINE = (1, 2, 5, 10, 20, 40), 640
CYCLES_PER_PROFILE, LEAST = 60, 1e-2
RADII = np.linspace(0.0, 1.5, 40)
PROFILES: tuple[Profile, ...] = (
    Paraboloid(1.0),
    Cone(0.3),
    Power(1.0, 4.0),
    RoundedPunch(0.5, 1.0),
    TruncatedCone(0.3, 0.4),
    Sphere(3.0),
    Tabulated(RADII, RADII**2 / 2),
)


def random_cycles(*, by_depth: bool) -> Iterator[Callable[..., history.LoadCycles]]:
    """Cycles with normal amplitudes of 5 to 95 % of the mean, up to full slip and beyond."""
    rng = np.random.default_rng(5)
    for profile in PROFILES:
        for _ in range(CYCLES_PER_PROFILE):
            depth, share = DEPTH * rng.uniform(0.3, 1.0), rng.uniform(0.05, 0.95)
            load = rng.uniform(0.05, 1.1)
            force = normal.solve(profile, E_STAR, indentation_depth=[depth, depth * (1 - share)])
            mean, least = force.normal_force
            given: dict[str, Any] = {
                "normal_force": mean,
                "normal_amplitude": share * mean,
                "tangential_displacement": load * MU * E_STAR / G_STAR * depth,
            }
            if by_depth:
                given = {
                    "indentation_depth": depth,
                    "normal_amplitude": share * depth,
                    "tangential_force": min(load, 0.98) * MU * least,
                }
            yield partial(history.cycles, profile, E_STAR, G_STAR, MU, **given, count=2)


def errors(cycles: Callable[..., history.LoadCycles]) -> list[float]:
    """Relative errors of the second cycle's energy; none if it hardly dissipates."""
    fine = cycles(samples_per_step=FINE)
    exact = float(fine.energy_per_cycle[1])
    if exact < LEAST * np.ptp(fine.tangential_force) * np.ptp(fine.tangential_displacement):
        return []
    energies = (float(cycles(samples_per_step=n).energy_per_cycle[1]) for n in SAMPLES)
    return [abs(energy / exact - 1) for energy in energies]


def main() -> None:
    for by_depth in (True, False):
        found = np.array([row for row in map(errors, random_cycles(by_depth=by_depth)) if row])
        pair = "depth, tangential force" if by_depth else "normal force, displacement"
        sys.stdout.write(f"{pair}: {len(found)} cycles\n")
        for n, column in zip(SAMPLES, found.T, strict=True):
            half, most, all_of = np.quantile(column, (0.5, 0.9, 1.0))
            sys.stdout.write(f"{n:4} {half:8.1e} {most:8.1e} {all_of:8.1e}\n")


if __name__ == "__main__":
    main()
