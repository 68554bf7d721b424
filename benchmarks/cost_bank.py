"""Measure what queries cost, fit the rates to that, and hold the rates to other queries.

    python benchmarks/cost_bank.py          # the ratios of estimate and measurement, by question
    python benchmarks/cost_bank.py --write  # measures the rates, and writes them

Processor time of one thread is measured: what else the machine does is not in it. The bank that
the rates are fitted to and the one that they are held to have no query in common.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import argparse
import json
import random
from collections import defaultdict
from functools import partial
from pathlib import Path
from time import thread_time
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import nnls

import mdr_service
from mdr_core.errors import AccuracyError, DefectError, InputError
from mdr_service import arrays, cost, pictures, problems, questions, sizes, solve, table, wire

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from mdr_service.schemas.queries import Query

RATES = Path(mdr_service.__file__).with_name("rates.json")
MATERIAL = {"e_star": 1.0, "g_star": 0.8}
PLAIN: dict[str, dict[str, float]] = {
    "flat_punch": {"radius": 1.0},
    "cone": {"slope": 0.1},
    "paraboloid": {"radius": 10.0},
    "sphere": {"radius": 10.0},
    "ellipsoid": {"radius": 10.0, "height": 8.0},
    "power": {},
    "rounded_punch": {"flat_radius": 0.3, "rounding_radius": 5.0},
    "truncated_cone": {"flat_radius": 0.3, "slope": 0.1},
    "truncated_paraboloid": {"flat_radius": 0.3, "radius": 10.0},
    "rounded_cone": {"slope": 0.1, "tip_radius": 3.0},
    "spherical_tip_cone": {"slope": 0.1, "tip_radius": 3.0},
    "hyperboloid": {"slope": 0.1, "tip_radius": 3.0},
    "capped_paraboloid": {"cap_radius": 0.3, "tip_radius": 20.0, "radius": 10.0},
}
# Of powers: sharp and gentle, and steep ones.
EXPONENTS = ((0.3, 2.0), (2.0, 6.0), (2.0, 6.0), (6.0, 100.0))
LONG_ONES = ("series", "tabulated")
KINDS = (*PLAIN, *LONG_ONES)
FIELDS = ("pressure", "shear_stress", "slip", "normal_displacement", "foundation_load")
FIELDS = (*FIELDS, "foundation_shear")
SHEAR = frozenset({"shear_stress", "slip", "foundation_shear"})
STYLES = ("small", "near", "again", "random")
# What takes this long is not measured twice.
LONG = 0.3
# Of each question and kind of profile.
FITTED, HELD = 28, 8

Case = tuple[str, dict[str, Any], str]


def profile(kind: str, rng: random.Random) -> dict[str, Any]:
    if kind == "series":
        count = round(10 ** rng.uniform(0, 1.7))
        powers = [{"coefficient": 0.05, "exponent": 2.0}]
        powers += [
            {"coefficient": 1e-3 / count, "exponent": rng.uniform(*rng.choice(EXPONENTS))}
            for _ in range(count - 1)
        ]
        return {"kind": kind, "terms": powers}
    if kind == "tabulated":
        r = np.linspace(0.0, 3.0, round(10 ** rng.uniform(0.9, 3.2)))
        way = rng.choice(["cubic", "pchip", "linear"])
        return {"kind": kind, "r": r.tolist(), "f": (r * r / 20).tolist(), "interpolation": way}
    if kind == "power":
        return {"kind": kind, "coefficient": 0.05, "exponent": rng.uniform(*rng.choice(EXPONENTS))}
    return {"kind": kind, **PLAIN[kind]}


def several(low: float, high: float, count: int) -> float | list[float]:
    return high if count == 1 else np.linspace(low, high, count).tolist()


def many(rng: random.Random, most: float) -> int:
    """One, or a number of any order."""
    return 1 if rng.random() < 0.25 else round(10 ** rng.uniform(0, most))


def normal_load(rng: random.Random, count: int, *, radius: bool = True) -> dict[str, Any]:
    controls = [("indentation_depth", 0.03, 0.05), ("normal_force", 0.02, 0.03)]
    if radius:
        controls.append(("contact_radius", 0.6, 0.9))
    name, low, high = rng.choice(controls)
    return {name: several(low, high, count)}


def tangential_load(rng: random.Random, count: int) -> dict[str, Any]:
    name, high = rng.choice([("tangential_force", 1e-3), ("tangential_displacement", 1e-3)])
    return {name: several(high / 30, high, count)}


def base(kind: str, rng: random.Random) -> dict[str, Any]:
    return {
        "profile": profile(kind, rng),
        "material": MATERIAL,
        "rtol": 10 ** -rng.choice([4, 6, 8, 10, 10, 10, 12]),
    }


def normal(kind: str, rng: random.Random) -> dict[str, Any]:
    load = normal_load(rng, many(rng, 4.3), radius=kind != "flat_punch")
    return base(kind, rng) | {"load": load}


def tangential(kind: str, rng: random.Random) -> dict[str, Any]:
    count = many(rng, 3.7)
    load = normal_load(rng, 1 if rng.random() < 0.5 else count, radius=kind != "flat_punch")
    return base(kind, rng) | {
        "load": load,
        "friction_coefficient": 0.3,
        "tangential": tangential_load(rng, count),
    }


def way(rng: random.Random, most: float) -> dict[str, Any]:
    curved = rng.random() < 0.4
    count = many(rng, 1.5 if curved else most)
    by_force = rng.random() < 0.5
    pressed = [rng.uniform(0.02, 0.03) if by_force else 0.04 + 0.002 * rng.random()]
    pressed *= count
    if curved:
        pressed = [each * rng.uniform(1, 1.02) for each in pressed]
    pushed = [1e-4 * rng.uniform(-1, 1) for _ in range(count)]
    sideways = "tangential_force" if by_force != curved else "tangential_displacement"
    return {
        "normal": {"normal_force" if by_force else "indentation_depth": pressed},
        "tangential": {sideways: pushed},
        "samples_per_step": rng.choice([1, 1, 3]),
    }


def history(kind: str, rng: random.Random) -> dict[str, Any]:
    return base(kind, rng) | {"friction_coefficient": 0.3, "history": way(rng, 4)}


def curved(kind: str, rng: random.Random) -> dict[str, Any]:
    """A way of mixed control: small loops, nearly sliding ones, the same again, or at random."""
    query = base(kind, rng) | {"friction_coefficient": 0.3}
    if kind == "flat_punch":
        return query | {"history": way(rng, 2)}
    legs, style = rng.choice([1, 2, 3, 5, 10, 20, 50, 200]), rng.choice(STYLES)
    share = {"small": 1e-3, "near": 0.95, "again": 0.6, "random": 0.5}[style]
    spread = {"small": 3e-5, "again": 0.008}.get(style, 0.01)
    depth = [0.03 - spread * rng.random() for _ in range(legs)]
    push = [share * rng.uniform(-1, 1) for _ in range(legs)]
    if style == "again":
        depth = [0.03 - spread * (number % 2) for number in range(legs)]
        push = [share * (-1) ** number for number in range(legs)]
    model = questions.QUESTIONS["normal"].model.model_validate(
        {"profile": query["profile"], "material": MATERIAL, "load": {"indentation_depth": depth}}
    )
    force = np.asarray(solve.normal(model).normal_force)
    if rng.random() < 0.5:
        shift = 0.3 * np.array(push) * depth / MATERIAL["g_star"]
        loads = {"normal_force": force.tolist()}, {"tangential_displacement": shift.tolist()}
    else:
        # A straight way over depths lags behind the force: it keeps away from sliding.
        least = np.minimum(force, np.append(force[0], force[:-1]))
        pushed = np.append(0.0, 0.18 * np.array(push) * least)
        depth = [depth[0], *depth]
        loads = {"indentation_depth": depth}, {"tangential_force": pushed.tolist()}
    samples = rng.choice([1, 1, 1, 4])
    return query | {
        "history": {"normal": loads[0], "tangential": loads[1], "samples_per_step": samples}
    }


def stress(kind: str, rng: random.Random) -> dict[str, Any]:
    asked = rng.sample(FIELDS, rng.choice([1, 1, 2, 3]))
    query = base(kind, rng) | {"quantities": asked, "points": max(2, many(rng, 3.5))}
    rubbed = not SHEAR.isdisjoint(asked)
    if rubbed:
        query["friction_coefficient"] = 0.3
    if rubbed and rng.random() < 0.2:
        return query | {"history": way(rng, 2)}
    loads = 1 if rng.random() < 0.6 else many(rng, 2)
    query["load"] = normal_load(rng, loads, radius=kind != "flat_punch")
    if rubbed:
        query["tangential"] = tangential_load(rng, 1)
    return query


def alone(field: str, kind: str, rng: random.Random) -> dict[str, Any]:
    """One field at many radii, where nothing else is felt."""
    loads = many(rng, 1)
    query = base(kind, rng) | {"quantities": [field], "points": round(10 ** rng.uniform(2.5, 4))}
    query["load"] = normal_load(rng, loads, radius=kind != "flat_punch")
    if field not in SHEAR:
        return query
    return query | {"friction_coefficient": 0.3, "tangential": tangential_load(rng, 1)}


def left(kind: str, rng: random.Random) -> dict[str, Any]:
    """Fields of what a way leaves, of all kinds of ways."""
    if rng.random() < 0.7:
        query = curved(kind, rng)
    else:
        query = base(kind, rng) | {"friction_coefficient": 0.3, "history": way(rng, 2)}
    asked = rng.sample(sorted(SHEAR), rng.choice([1, 1, 2, 3]))
    # Of few radii nothing is learnt: the way is dearer than they are.
    radii = np.linspace(0.0, 0.9, round(10 ** rng.uniform(1.5, 3.5)))
    return query | {"quantities": asked, "radius": radii.tolist()}


def wear(kind: str, rng: random.Random) -> dict[str, Any]:
    loads = many(rng, 3)
    query = base(kind, rng) | {
        "friction_coefficient": 0.3,
        "load": normal_load(rng, loads, radius=False),
        "oscillation": tangential_load(rng, 1),
    }
    if rng.random() < 0.3:
        return query
    asked = rng.sample(["initial_profile", "limiting_profile", "worn_depth", "pressure"], 2)
    radii = max(2, min(many(rng, 3.5), 300_000 // loads))
    return query | {"points": radii, "quantities": asked}


def evolution(kind: str, rng: random.Random) -> dict[str, Any]:
    held, swing = rng.choice(
        [
            ("indentation_depth", "tangential_displacement"),
            ("normal_force", "tangential_force"),
            ("normal_force", "tangential_displacement"),
        ]
    )
    count = many(rng, 2)
    query = base(kind, rng) | {
        "rtol": 10 ** -rng.choice([4, 6, 6, 6, 8, 10]),
        "friction_coefficient": 0.3,
        "load": {held: 0.04 if held == "indentation_depth" else 0.02},
        "oscillation": {swing: 5e-4},
        "wear_coefficient": 1e-3,
        "cycles": np.geomspace(1e-2, 1e9, count).tolist() if count > 1 else [1e9],
        "resolution": rng.choice([8, 16, 24, 24, 32, 48, 96]),
    }
    if rng.random() < 0.5:
        query["points"] = max(2, many(rng, 3))
    return query


ASKED = {
    "normal": normal,
    "tangential": tangential,
    "history": history,
    "stress": stress,
    "wear": wear,
    "evolution": evolution,
}
# Of the same question as another, but with a bank of its own.
ALSO = {("history", "curved"): curved, ("stress", "left"): left} | {
    ("stress", field): partial(alone, field) for field in FIELDS
}


def cases(kind: str, seed: str, count: int) -> Iterator[Case]:
    named = {(question, question): query for question, query in ASKED.items()} | ALSO
    for (question, name), query in named.items():
        few = count // 4 if name in FIELDS else count
        for number in range(few):
            rng = random.Random(f"{seed} {name} {kind} {number}")
            yield question, query(kind, rng), wire.MEDIA_TYPE


def forms(seed: str) -> Iterator[Case]:
    """Everything that is written, of the profile that takes least."""
    for media_type in (wire.MEDIA_TYPE, table.MEDIA_TYPE, arrays.MEDIA_TYPE, pictures.MEDIA_TYPE):
        for question, query in ASKED.items():
            if media_type not in questions.QUESTIONS[question].media_types:
                continue
            for number in range(4):
                rng = random.Random(f"{seed} {media_type} {question} {number}")
                yield question, query("paraboloid", rng), media_type


def measured(question: str, query: Query, media_type: str) -> float | None:
    """Return the seconds that the answer takes at best, or None if it is refused."""
    best = LONG * 1e9
    for number in range(5):
        start = thread_time()
        try:
            questions.answer(question, query, media_type)
        except (InputError, AccuracyError, problems.ServiceError):
            return None
        best = min(best, thread_time() - start)
        if best > LONG or best * number > LONG:
            break
    return best


def timed(found: Iterator[Case]) -> list[tuple[sizes.Sizes, float, str]]:
    rows = []
    for question, given, media_type in found:
        query = questions.QUESTIONS[question].model.model_validate(given)
        try:
            taken = measured(question, query, media_type)
        except DefectError as error:
            print(f"! {error}: {question} {json.dumps(given)[:600]}", flush=True)
            continue
        if taken is not None:
            rows.append((sizes.of(question, query, media_type), taken, json.dumps(given)[:600]))
    return rows


def fit(rows: list[tuple[sizes.Sizes, float, str]], writing: dict[str, float]) -> dict[str, float]:
    """Return the rates that are relatively nearest to what was measured, none below zero."""
    counted = []
    for found, _, _ in rows:
        counts: dict[str, float] = defaultdict(float)
        for name, count in sizes.counts(found):
            counts[name] += count
            if found.length:
                counts[cost.PER_LENGTH + name] += count * found.length
        if not writing:
            counts.update(sizes.written(found))
        counted.append(counts)
    names = sorted({name for counts in counted for name in counts})
    taken = np.array(
        [max(seconds - _written(found, writing), 0.2 * seconds) for found, seconds, _ in rows]
    )
    matrix = np.array([[counts.get(name, 0.0) for name in names] for counts in counted])
    weight = 1 / taken
    for _ in range(8):
        found, _ = nnls(matrix * weight[:, None], taken * weight, maxiter=10_000)
        # Relative to the geometric mean of both: too little is as bad as too much.
        guessed = matrix @ found
        weight = 1 / np.sqrt(taken * np.maximum(guessed, 1e-3 * taken))
    return {name: float(f"{rate:.3g}") for name, rate in zip(names, found, strict=True)}


def _written(found: sizes.Sizes, writing: dict[str, float]) -> float:
    return sum(writing.get(name, 0.0) * count for name, count in sizes.written(found))


def measure_rates(kinds: Sequence[str]) -> None:
    """Measure the rates of some kinds of profile, and write them beside those of the others."""
    known = json.loads(RATES.read_text("utf-8"))
    found = known["rates"]
    if set(kinds) == set(KINDS):
        known["reference_seconds"] = reference()
        rows = [*timed(forms("fit")), *timed(cases("paraboloid", "fit", FITTED))]
        everything = fit(rows, {})
        names = {name for sized, _, _ in rows for name, _ in sizes.written(sized)}
        found[cost.WRITING] = {name: everything[name] for name in sorted(names)}
    for kind in kinds:
        found[kind] = fit(timed(cases(kind, "fit", FITTED)), found[cost.WRITING])
        # What no query of this kind was answered for costs what it costs the dearest of the others.
        others = [found[other] for other in KINDS if other in found]
        for name in sorted({name for other in others for name in other} - set(found[kind])):
            if kind in LONG_ONES or not name.startswith(cost.PER_LENGTH):
                found[kind][name] = max(other.get(name, 0.0) for other in others)
        RATES.write_text(json.dumps(known, indent=1) + "\n", "utf-8")
        print(f"{kind}: {len(found[kind])} rates", flush=True)


def reference() -> float:
    query = questions.QUESTIONS["tangential"].model.model_validate(cost.REFERENCE)
    return min(measured("tangential", query, wire.MEDIA_TYPE) or 1.0 for _ in range(20))


def hold(kinds: Sequence[str]) -> None:
    """Print how far the estimates are off, for queries that the rates were not fitted to."""
    ratios: dict[str, list[tuple[float, str, str]]] = defaultdict(list)
    everything = timed(forms("hold"))
    for kind in kinds:
        everything += timed(cases(kind, "hold", HELD))
    for found, taken, text in everything:
        name = found.question if found.form == "json" else f"{found.question}, {found.form}"
        if found.samples and found.question == "stress":
            name += " of an end"
        if found.curved:
            name += ", curved"
        ratios[name].append((cost.estimated(found) / taken, f"{taken:.2g} s", text))
    print(f"{'question':24}{'queries':>8}{'lowest':>9}{'median':>9}{'highest':>9}  within 4")
    for name, row in ratios.items():
        values = sorted(each[0] for each in row)
        within = sum(0.25 <= value <= 4 for value in values)
        print(
            f"{name:24}{len(row):8}{values[0]:9.2f}{values[len(row) // 2]:9.2f}{values[-1]:9.2f}"
            f"  {within}/{len(row)}"
        )
    far = sorted(
        (each for row in ratios.values() for each in row if not 0.25 <= each[0] <= 4),
        key=lambda each: each[0],
    )
    for ratio, taken, text in far:
        print(f"  {ratio:.2f} of {taken}: {text[:300]}")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true", help="measure the rates and write them")
    parser.add_argument("kinds", nargs="*", default=KINDS, help="of profiles; all if none is named")
    arguments = parser.parse_args()
    if arguments.write:
        measure_rates(arguments.kinds)
    else:
        hold(arguments.kinds)


if __name__ == "__main__":
    main()
