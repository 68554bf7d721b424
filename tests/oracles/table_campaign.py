"""Tables of known bodies against the truth: `python -m tests.oracles.table_campaign --tables 1000`.

A table is read three ways: from depth to force, from force to depth, and from contact radius to
depth. Errors are relative to the body's values, at contact radii whose depth is at least 5 % of the
table's height. An error above 5 % is *silent* if neither the warning `smoothed` nor an estimate of
at least half the error (`data_error`) tells of it. Refusals of tables that show a single disc are
failures; those of a ledge beyond the body are not.

`--solver module:function` takes another implementation of `answers`.
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
import traceback
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from mdr_core import normal
from mdr_core.errors import InputError
from mdr_core.profiles import Tabulated
from tests.oracles.bodies import KINKED, SHARP
from tests.oracles.instrument_tables import InstrumentTable, drawn, noisy

if TYPE_CHECKING:
    from collections.abc import Iterable

    Array = np.ndarray

#: A relative error that must not pass without a word.
SILENT = 0.05
#: Median errors of depth and force that a noise of the heights may leave, and the coverage wanted.
NOISE = {0.001: 0.003, 0.01: 0.02}
COVERAGE = 0.9
#: Seconds for a table of so many points.
BUILD = {200: 0.03, 2000: 0.3}


def say(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


@dataclass
class Answers:
    """What an implementation returns for loads on one table, with its estimates."""

    depth_by_radius: Array
    force_by_depth: Array
    depth_by_force: Array
    estimates: dict[str, Array] = field(default_factory=dict)
    """Of each of the above [1]; of the missing ones zero."""
    codes: frozenset[str] = frozenset()


def answers(table: InstrumentTable, radius: Array, depth: Array, force: Array) -> Answers:
    """Solve the loads on a table by the library."""
    options = {} if table.uncertainty is None else {"uncertainty": table.uncertainty}
    profile = Tabulated(table.r, table.f, breaks=table.breaks, **options)
    solved = {
        "depth_by_radius": normal.solve(profile, 1.0, contact_radius=radius),
        "force_by_depth": normal.solve(profile, 1.0, indentation_depth=depth),
        "depth_by_force": normal.solve(profile, 1.0, normal_force=force),
    }
    codes = {notice.code for contact in solved.values() for notice in contact.warnings}
    return Answers(
        solved["depth_by_radius"].indentation_depth,
        solved["force_by_depth"].normal_force,
        solved["depth_by_force"].indentation_depth,
        {name: data_error(contact) for name, contact in solved.items()},
        frozenset(codes),
    )


def data_error(contact: Any) -> Array:
    """Estimate of the relative error that the table's points leave in depth and force."""
    estimate = getattr(contact, "data_error", None)
    return np.zeros(np.shape(contact.contact_radius)) if estimate is None else np.asarray(estimate)


@dataclass
class Class:
    """Statistics of one class of tables."""

    tables: int = 0
    refused: int = 0
    failed: int = 0
    warned: int = 0
    silent: int = 0
    covered: list[bool] = field(default_factory=list)
    errors: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    worst: tuple[float, str] = (0.0, "")

    def row(self, name: str) -> str:
        middle = [np.median(self.errors[each]) if self.errors[each] else 0 for each in READINGS]
        most = [max(self.errors[each], default=0.0) for each in READINGS]
        cover = np.mean(self.covered) if self.covered else 1.0
        cells = "".join(f"{m:9.1e}{w:9.1e}" for m, w in zip(middle, most, strict=True))
        return (
            f"{name:30}{self.tables:7}{self.refused:8}{self.failed:7}{self.warned:7}"
            f"{self.silent:7}{cover:9.0%}{cells}"
        )


READINGS = ("depth_by_radius", "force_by_depth", "depth_by_force")
HEAD = (
    f"{'class':30}{'tables':>7}{'refused':>8}{'failed':>7}{'warned':>7}{'silent':>7}{'covered':>9}"
    + "".join(f"{name:>18}" for name in ("d(a) median, max", "F(d)", "d(F)"))
)


def judge(table: InstrumentTable, solver: Any, classes: Iterable[Class]) -> str:
    """Solve one table, count it, and return what is wrong with it."""
    radius = table.radii()
    depth = [table.depth(a) for a in radius]
    force = [table.force(a) for a in radius]
    classes = list(classes)
    for each in classes:
        each.tables += 1
    try:
        found = solver(table, np.array(radius), np.array(depth), np.array(force))
    except InputError as error:
        for each in classes:
            each.refused += 1
        return f"refused: {error}" if table.single_disc else ""
    except Exception:  # noqa: BLE001 - whatever it is, it is counted and printed
        for each in classes:
            each.failed += 1
        return "".join(traceback.format_exc().splitlines(keepends=True)[-5:])
    truth = {"depth_by_radius": depth, "force_by_depth": force, "depth_by_force": depth}
    worst, silent = 0.0, 0.0
    for name in READINGS:
        errors = np.abs(getattr(found, name) / np.array(truth[name]) - 1)
        errors = np.where(np.isnan(errors), np.inf, errors)
        estimate = found.estimates.get(name, np.zeros_like(errors))
        told = (estimate >= errors / 2) | ("smoothed" in found.codes)
        worst = max(worst, float(errors.max()))
        silent = max(silent, float(np.where(told, 0.0, errors).max()))
        for each in classes:
            each.errors[name].extend(errors.tolist())
            each.covered.extend((errors <= np.maximum(estimate, 1e-9)).tolist())
    for each in classes:
        each.warned += "smoothed" in found.codes
        each.silent += silent > SILENT
        each.worst = max(each.worst, (worst, table.name))
    return f"silent error {silent:.1%}" if silent > SILENT else ""


def campaign(tables: int, first: int, solver: Any) -> bool:
    """Judge random tables; return True if none is refused, silently wrong or an exception."""
    classes: dict[str, Class] = defaultdict(Class)
    wrong: dict[str, list[str]] = defaultdict(list)
    for seed in range(first, first + tables):
        table = drawn(seed)
        names = ["all", table.kind]
        for habit in ("undeclared kink", "declared breaks", "near radii", "repeated radii",
                      "both sides", "first radius above 0"):  # fmt: skip
            names += [f"· {habit}"] if habit in table.name.split(", ") else []
        sharp, kinked = (table.body in each.values() for each in (SHARP, KINKED))
        names.append(f"· {'sharp' if sharp else 'kinked' if kinked else 'smooth'} bodies")
        verdict = judge(table, solver, [classes[name] for name in names])
        if verdict:
            wrong[verdict].append(f"seed {seed}: {table.name}")
    for verdict, names in wrong.items():
        # An exception and the first tables that raise it; the others can be found by their seeds.
        say("\n".join([*names[:3], *([f"and {len(names) - 3} more"] if names[3:] else [])]))
        say(f"    {verdict.strip()}")
    say(HEAD)
    for name in sorted(classes, key=lambda n: (n != "all", n.startswith("·"), n)):
        say(classes[name].row(name))
    for name in sorted(classes):
        say(f"worst of {name:30} {classes[name].worst[0]:9.2e}  {classes[name].worst[1]}")
    return not wrong


def noise_study(seeds: int, solver: Any) -> bool:
    """Print errors and coverage of noisy tables; return True if they meet `NOISE`."""
    good = True
    say(f"\n{'noisy tables':32}{'d(a) median':>12}{'F(d) median':>12}{'90 %':>9}{'covered':>9}")
    total: dict[float, list[bool]] = defaultdict(list)
    for noise, bound in NOISE.items():
        for name in ("sphere", "cone", "rounded punch"):
            for count in (100, 200, 500, 1000, 2000):
                errors: dict[str, list[float]] = {"depth_by_radius": [], "force_by_depth": []}
                covered: list[bool] = []
                faults: Counter[str] = Counter()
                for seed in range(seeds):
                    table = noisy(name, count, noise, seed)
                    a = np.array([0.7 * table.end])
                    depth, force = table.depth(float(a[0])), table.force(float(a[0]))
                    try:
                        found = solver(table, a, np.array([depth]), np.array([force]))
                    except Exception as error:  # noqa: BLE001 - counted and printed
                        faults[f"{type(error).__name__}: {str(error)[:60]}"] += 1
                        continue
                    for reading, true in (("depth_by_radius", depth), ("force_by_depth", force)):
                        error = abs(float(getattr(found, reading)[0]) / true - 1)
                        errors[reading].append(error)
                        estimate = found.estimates.get(reading)
                        covered.append(estimate is not None and error <= float(estimate[0]))
                middle = [float(np.median(one)) if one else np.inf for one in errors.values()]
                most = float(np.quantile(errors["force_by_depth"] or [np.inf], 0.9))
                share = float(np.mean(covered)) if covered else 0.0
                total[noise] += covered
                failed = max(middle) > bound or bool(faults)
                good &= not failed
                say(
                    f"{f'{name}, {count} points, {noise:.1%}':32}"
                    f"{middle[0]:12.2e}{middle[1]:12.2e}{most:9.1e}{share:9.0%}"
                    f"{'  ABOVE' if failed else ''} {dict(faults) or ''}"
                )
        share = float(np.mean(total[noise])) if total[noise] else 0.0
        good &= share >= COVERAGE
        say(f"coverage at {noise:.1%} noise: {share:.1%} (wanted {COVERAGE:.0%})")
    return good


def times(solver: Any) -> bool:
    """Print the time of a new table and its first loads; return True within `BUILD`."""
    good = True
    for count, bound in BUILD.items():
        for noise in (0.0, 0.001, 0.01):
            taken = []
            for seed in range(7):
                table = noisy("sphere", count, noise, seed)
                started = time.perf_counter()
                a = 0.7 * table.end
                solver(table, np.array([a]), np.array([0.1]), np.array([0.1]))
                taken.append(time.perf_counter() - started)
            middle = float(np.median(taken))
            good &= middle <= bound
            most = f"{1e3 * middle:7.1f} ms, bound {1e3 * bound:g}"
            say(f"{count:5} points, noise {noise:5.1%}: {most}")
    return good


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tables", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--seeds", type=int, default=20, help="of each noisy table; 200 for all")
    parser.add_argument("--solver", default="tests.oracles.table_campaign:answers")
    parser.add_argument("--only", choices=("tables", "noise", "times"))
    given = parser.parse_args()
    module, _, name = given.solver.partition(":")
    solver = getattr(importlib.import_module(module), name)
    good = True
    if given.only in {None, "tables"}:
        good &= campaign(given.tables, given.first, solver)
    if given.only in {None, "noise"}:
        good &= noise_study(given.seeds, solver)
    if given.only in {None, "times"}:
        good &= times(solver)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
