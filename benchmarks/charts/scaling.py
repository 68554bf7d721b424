"""Time against problem size, and memory for a million radii.

`make chart-scaling`. The exponent is fitted to sizes from 1e3 on. For radii and loads it must be at
most 1.05, and the memory for a million radii at most 64 MiB beyond the result; otherwise the exit
status is 1. Python's allocations are measured by tracemalloc, and the whole process by its peak
resident memory in a fresh process.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tracemalloc
from math import log10
from pathlib import Path
from typing import TYPE_CHECKING

import history_ratio as paths
import numpy as np
from drawing import BLUE, BROWN, GREEN, MDR_COLOR, VIOLET, panels, save, table
from machine import footer
from measure import medians

from mdr_core import fields, history, normal, tangential
from mdr_core.errors import AccuracyError
from mdr_core.profiles import Paraboloid, Profile, RoundedPunch, Tabulated

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from mdr_core.normal import NormalContact

Array = np.ndarray
Runs = dict[int, "Callable[[], object]"]
SECONDS, FROM, MAX_POWER = 6.0, 1000, 1.05
HEADER = ("time against", "of", "size", "seconds", "seconds / size", "exponent from 1e3 on")
#: Curves with a limit on the exponent.
BOUND = ("radii", "loads")
MILLION, MEBIBYTES = 1_000_000, 64.0
PUNCH, TABLE = RoundedPunch(0.5, 1.0), 200


def sizes(low: int, high: int) -> list[int]:
    """Three sizes per decade."""
    count = round(3 * log10(high / low)) + 1
    return [round(one) for one in np.geomspace(low, high, count)]


def sampled(points: int) -> Profile:
    """A sphere of radius 2 as a table of this many points."""
    r = np.linspace(0.0, 1.25, points)
    return Tabulated(r, r * r / (2 + np.sqrt((2 - r) * (2 + r))))


def contact(profile: Profile) -> NormalContact:
    """Contact of radius 1."""
    return normal.solve(profile, 1.0, contact_radius=1.0)


def over_radii(profile: Profile, high: int) -> Runs:
    one = contact(profile)
    radii = {n: np.linspace(0.0, 1.0, n, endpoint=False) for n in sizes(1, high)}
    return {n: lambda r=r: fields.pressure(one, r) for n, r in radii.items()}


def over_loads(profile: Profile, high: int) -> Runs:
    def run(force: Array) -> object:
        one = normal.solve(profile, 1.0, normal_force=force)
        push = tangential.solve(one, 0.8, 0.3, tangential_force=0.1 * force)
        return push.stick_radius, push.tangential_displacement

    forces = {n: np.linspace(0.1, 0.6, n) for n in sizes(1, high)}
    return {n: lambda f=f: run(f) for n, f in forces.items()}


def over_breakpoints(high: int) -> Runs:
    """Decreasing amplitudes: every turning point is part of the slip memory."""

    def run(turns: int) -> object:
        amplitude = (
            0.8
            * paths.FULL_SLIP
            * (1 - np.arange(turns) / (turns + 1))
            * (-1.0) ** np.arange(turns)
        )
        return history.solve(
            Paraboloid(paths.R),
            paths.E_STAR,
            paths.G_STAR,
            paths.MU,
            indentation_depth=np.full(turns, paths.DEPTH),
            tangential_displacement=amplitude,
        ).tangential_force

    return {n: lambda n=n: run(n) for n in sizes(10, high)}


def over_cycles(high: int) -> Runs:
    def run(count: int) -> object:
        return history.cycles(
            Paraboloid(paths.R),
            paths.E_STAR,
            paths.G_STAR,
            paths.MU,
            indentation_depth=paths.DEPTH,
            tangential_displacement=0.5 * paths.FULL_SLIP,
            count=count,
        ).energy_per_cycle

    return {n: lambda n=n: run(n) for n in sizes(1, high)}


def over_table(high: int) -> Runs:
    """Includes the fit of the points, and the pressure at 1000 radii."""
    r = (np.arange(1000) + 0.5) / 1000

    def run(points: int) -> Array:
        return fields.pressure(contact(sampled(points)), r)

    def answered(points: int) -> bool:
        try:
            run(points)
        except AccuracyError:
            print(f"a table of {points} points is rejected")
            return False
        return True

    return {n: lambda n=n: run(n) for n in sizes(10, high) if answered(n)}


def lines() -> Iterator[tuple[str, str, Runs]]:
    yield "radii", "p(r), paraboloid", over_radii(Paraboloid(1.0), MILLION)
    yield "radii", "p(r), punch", over_radii(PUNCH, MILLION)
    yield "radii", "p(r), table", over_radii(sampled(TABLE), 100_000)
    yield "loads", "c, paraboloid", over_loads(Paraboloid(1.0), MILLION)
    yield "loads", "c, punch", over_loads(PUNCH, 100_000)
    yield "breakpoints", "turning points", over_breakpoints(100_000)
    yield "cycles", "cycles", over_cycles(100_000)
    yield "table points", "new table, p(r)", over_table(100_000)


def exponent(points: dict[int, float]) -> float:
    """Slope of log(seconds) over log(size) from 1e3 on."""
    n, t = np.log([(n, t) for n, t in points.items() if n >= FROM]).T
    return float(np.polyfit(n, t, 1)[0])


def memory(name: str) -> dict[str, float]:
    """Memory for a million radii beyond the result, in this process [MiB]."""
    profile = {"paraboloid": Paraboloid(1.0), "rounded punch": PUNCH}.get(name) or sampled(TABLE)
    r = np.linspace(0.0, 1.0, MILLION, endpoint=False)
    one = contact(profile)
    fields.pressure(one, r[:: MILLION // 1000])
    # Reset the kernel's record of the peak.
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    before = resident("VmRSS")
    answer = fields.pressure(one, r)
    highest = resident("VmHWM") - before
    tracemalloc.start()
    fields.pressure(one, r)
    traced = tracemalloc.get_traced_memory()[1] / 2**20
    size = answer.nbytes / 2**20
    return {"tracemalloc": traced - size, "resident": highest - size}


def resident(name: str) -> float:
    """Current or peak resident memory of this process [MiB]."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(float(line.split()[1]) / 1024 for line in lines if line.startswith(name))


def main() -> int:
    rows, measured = [], {}
    for against, of, runs in lines():
        seconds = medians(runs, SECONDS)
        power = exponent(seconds)
        measured[against, of] = seconds, power
        rows += [(against, of, n, t, t / n, power) for n, t in seconds.items()]
    table(HEADER, rows, "scaling")
    peaks = {}
    for name in ("paraboloid", "rounded punch", f"table of {TABLE}"):
        command = [sys.executable, str(Path(__file__)), name]
        answer = subprocess.run(command, check=True, capture_output=True, text=True)
        peaks[name] = json.loads(answer.stdout)
    header = ("pressure at 1e6 radii, MiB beyond the result", "tracemalloc", "resident")
    table(header, [(name, *peak.values()) for name, peak in peaks.items()], "memory")
    draw(measured)
    high = [f"{key}: {power:.3f}" for key, (_, power) in measured.items() if power > MAX_POWER]
    bad = [one for one in high if one.startswith(tuple(f"('{name}'" for name in BOUND))]
    bad += [name for name, peak in peaks.items() if max(peak.values()) > MEBIBYTES]
    print("limits exceeded:", bad or "nothing")
    return bool(bad)


def draw(measured: dict[tuple[str, str], tuple[dict[int, float], float]]) -> None:
    """Draw time against size: radii and loads on the left, the others on the right."""
    figure, axes = panels(1, 2, 3.2)
    colors = (MDR_COLOR, BLUE, GREEN, BROWN, VIOLET)
    for ax, is_bound in zip(axes, (True, False), strict=True):
        mine = {key: one for key, one in measured.items() if (key[0] in BOUND) == is_bound}
        for (key, (seconds, _power)), color in zip(mine.items(), colors, strict=False):
            label = key[1]
            ax.loglog(list(seconds), list(seconds.values()), "o-", color=color, label=label)
        ax.set_ylabel("CPU time [s]" if is_bound else "")
    axes[0].set_xlabel("number of radii (p) or loads (c)")
    axes[1].set_xlabel("number of turning points, cycles, or points of the table")
    save(figure, "scaling", footer(), axes)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(memory(sys.argv[1])))
    else:
        sys.exit(main())
