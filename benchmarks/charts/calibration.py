"""Calibration chart: true error over stated error, for every query whose error is stated.

`make chart-calibration`. References are the banks and oracles of the tests (mpmath), closed forms
of curves and loops, and finer solutions of impacts and of wear. A query is one case: its error and
its estimate are the largest over its results. Errors below half a unit in the last place are not
resolved by the references, and count as zero.
"""

from __future__ import annotations

import random
import sys
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import random_queries as drawn
from drawing import GREY, MDR_COLOR, panels, save, table
from machine import footer
from mpmath import mpf
from tests.core import test_fields_bank, test_impact, test_torsion
from tests.core.comparison import EPS, contact_of, profile_from, relative_error
from tests.core.random_cases import PROFILE_GENERATORS
from tests.core.test_history_bank import material
from tests.core.test_subsurface_bank import profile_from as body_from
from tests.core.test_wear_limit_bank import solved as limiting_wear
from tests.oracles import bank
from tests.oracles.torsion_reference import Twist
from tests.stability import fine_wear
from tests.stability.test_error_estimates import BANKS, largest_error

from mdr_core import fields, history, normal, subsurface, tangential
from mdr_core.wear import evolution

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

Pair = tuple[float, float]
#: Twists and impacts that are drawn at random.
TWISTS, IMPACTS = 1000, 500
HEADER = ("query", "cases", "median", "largest of 95 %", "largest", "cases above 1")
LOWEST = 1e-6


def of_bank(name: str) -> Callable[[], Iterator[Pair]]:
    def pairs() -> Iterator[Pair]:
        for case in BANKS[name]():
            yield case.error, case.estimate

    return pairs


def loads_of_wear() -> Iterator[Pair]:
    """Each load of a case of the bank is a query."""
    for case in bank.load("wear_limit"):
        for index, given in enumerate(case["given"]):
            found = limiting_wear(case, [given])
            expected = {name: [row[index]] for name, row in case["expected"].items()}
            yield largest_error(found, expected), found.error_estimate


def loads_of_cycles() -> Iterator[Pair]:
    """Each amplitude of a case of the bank is a query."""
    for case in bank.load("history_cycles"):
        for index, given in enumerate(case["given"]):
            loads = {case["control"]: case["load"], case["tangential_control"]: given}
            found = history.cycles(*material(case), **loads, count=2)
            error = max(
                relative_error(float(getattr(found, name)[1]), row[index])
                for name, row in case["expected"].items()
            )
            yield error, found.error_estimate


def of_field(source: Any, name: str, radius: Any, expected: Any) -> Pair | None:
    """Largest error of a field over its largest value, and what a response states."""
    value, truth = np.ravel(getattr(fields, name)(source, radius)), np.array(expected, dtype=float)
    finite = np.isfinite(truth)
    largest = np.abs(truth[finite]).max(initial=0.0)
    if largest == 0:
        return None
    error = max(
        relative_error(float(v), e) * abs(float(e)) / largest
        for v, e, known in zip(value, expected, finite, strict=True)
        if known and float(e) != 0
    )
    edge = fields.edge_error(source, name, radius)
    return error, max(fields.own_error(source), 1e-13) + edge


def surface() -> Iterator[Pair]:
    for case in bank.load("pressure"):
        if pair := of_field(contact_of(case), "pressure", case["radius"], case["expected"]):
            yield pair
    for case in bank.load("slip_fields"):
        contact = test_fields_bank.solved(case)
        for name in test_fields_bank.FIELDS:
            source = contact.normal if name in test_fields_bank.OF_NORMAL else contact
            if pair := of_field(source, name, case["radius"], case["expected"][name]):
                yield pair


def beneath() -> Iterator[Pair]:
    for case in bank.load("subsurface"):
        pressed = normal.solve(
            body_from(case["profile"]), 1.0, contact_radius=case["contact_radius"]
        )
        stuck = {"stick_radius": case["stick_radius"]}
        contact = tangential.solve(pressed, 0.9, case["friction_coefficient"], **stuck)
        nu, largest = case["poissons_ratio"], np.abs(np.array(case["expected"], dtype=float)).max()
        for point, expected in zip(case["points"], case["expected"], strict=True):
            tensor = subsurface.stress(contact, *point, poissons_ratio=nu, body=2)
            error = np.abs(np.ravel(tensor) - np.array(expected, dtype=float)).max() / largest
            yield float(error), subsurface.error_estimate(contact, *map(np.array, point))


def twists() -> Iterator[Pair]:
    draw = random.Random(1)
    for _ in range(TWISTS):
        kind = draw.choice(list(PROFILE_GENERATORS))
        given = {"kind": kind, **PROFILE_GENERATORS[kind](draw)}
        profile, c = profile_from(given), draw.uniform(0.02, 0.999)
        if profile.first_radius >= 1:
            continue
        twist = test_torsion.twisted(profile, stick_radius=c)
        exact, found = Twist(given, mpf(1)), test_torsion.reduced(twist)
        truth = exact.rotation(mpf(c)), exact.moment(mpf(c))
        yield (
            max(abs(float(v / t - 1)) for v, t in zip(found[:2], truth, strict=True)),
            twist.error_estimate,
        )


def impacts() -> Iterator[Pair]:
    rng = np.random.default_rng(2)
    kinds = ("paraboloid", "cone", "truncated_paraboloid", "capped_paraboloid")
    for index in range(IMPACTS):
        profile = test_impact.KINDS[kinds[index % 4]]
        v = test_impact.speed(profile) * rng.uniform(0.3, 1.0)
        w = test_impact.MU * v * rng.uniform(0.05, 6.0)
        exact = test_impact.solved(profile, v, w, rtol=1e-6)
        for rtol in (1e-3, 1e-4):
            hit = test_impact.solved(profile, v, w, rtol=rtol)
            yield test_impact.error(hit, exact), hit.error_estimate


def worn() -> Iterator[Pair]:
    for kind, name in fine_wear.PAIRS:
        exact = fine_wear.stored(kind, name)
        for resolution in (10, 12, 14, 16, 20, 24, 28, 32, 48):
            result = fine_wear.worn(kind, name, resolution)
            for index in range(len(result.cycles)):
                error = max(
                    abs(getattr(result, each)[index] / exact[each][index] - 1)
                    for each in evolution.SCALARS
                )
                yield float(error), result.error_estimate


#: Banks of the tests, and random queries up to a thousand of each.
QUERIES: dict[str, Callable[[], Iterator[Pair]]] = {
    "normal": of_bank("normal"),
    "tangential": lambda: chain(of_bank("tangential")(), drawn.pushed(560)),
    "history, paths": lambda: chain(of_bank("paths")(), drawn.paths(1100)),
    "history, cycles": lambda: chain(loads_of_cycles(), drawn.cycles(920)),
    "impact": impacts,
    "torsion": twists,
    "layer": lambda: drawn.layers(1000),
    "fit": lambda: drawn.curves(1000),
    "fit of a loop": lambda: drawn.loops(1000),
    "stress": lambda: chain(surface(), drawn.stresses(320)),
    "subsurface": lambda: chain(beneath(), drawn.points_beneath(660)),
    "wear": lambda: chain(loads_of_wear(), drawn.worn(580)),
    "wear over cycles": worn,
}
#: Errors of each query, with its stated errors: half an hour for all, kept for a drawing in pieces.
KEPT = Path("build/calibration")


def errors_of(name: str) -> np.ndarray:
    """Return true and stated errors, computed unless they are kept."""
    file = KEPT / f"{name}.npy"
    if not file.exists():
        KEPT.mkdir(parents=True, exist_ok=True)
        np.save(file, np.array(list(QUERIES[name]())))
    return np.load(file)


def main() -> None:
    figure, (axis,) = panels(1, 1, 3.4)
    rows: list[tuple[object, ...]] = []
    for place, name in enumerate(QUERIES):
        cases = errors_of(name)
        error = np.where(cases[:, 0] < EPS / 2, 0.0, cases[:, 0])
        ratios = np.sort(error / cases[:, 1])
        middle, most, largest = np.quantile(ratios, [0.5, 0.95, 1.0])
        rows.append((name, len(ratios), *(f"{x:.3g}" for x in (middle, most, largest))))
        rows[-1] += (int((ratios > 1).sum()),)
        shown = np.clip(ratios, LOWEST, None)
        spread = place + 0.6 * (np.random.default_rng(0).random(len(shown)) - 0.5)
        axis.plot(shown, spread, ".", color=GREY, markersize=1.5, alpha=0.4, rasterized=True)
        axis.plot(np.clip([middle, most], LOWEST, None), [place, place], "-", color=MDR_COLOR, lw=3)
        axis.plot([max(largest, LOWEST)], [place], "|", color=MDR_COLOR, markersize=12)
    axis.axvline(1.0, color="black", lw=1)
    axis.set_xscale("log")
    axis.set_yticks(range(len(QUERIES)), [f"{row[0]} ({row[1]})" for row in rows])
    axis.invert_yaxis()
    axis.set_xlabel("true error over stated error")
    axis.set_title(
        "Points: queries; bar: median to 95 %; tick: largest. Beyond 1 an estimate understates"
    )
    save(figure, "calibration", footer(), [])
    table(HEADER, rows, "calibration")


if __name__ == "__main__":
    # Names of queries compute these alone.
    for query in sys.argv[1:]:
        errors_of(query)
    if not sys.argv[1:]:
        main()
