"""The banks of histories are complete and equal what their generator computes."""

from __future__ import annotations

import random

import pytest
from mpmath import mp, mpf

from tests.oracles import bank
from tests.oracles import history_generate as generate
from tests.oracles import slip_reference as slip
from tests.oracles.history_reference import history
from tests.oracles.shapes import BANKED
from tests.oracles.slip_reference import Material
from tests.oracles.test_bank import STORED

NAMES = ("history_cycles", "history_inphase", "history_paths")
EVERY_KIND = set(BANKED)


def everything() -> list[bank.Record]:
    return [record for name in NAMES for record in bank.load(name)]


def material(record: bank.Record) -> Material:
    return Material(record["e_star"], record["g_star"], record["friction_coefficient"])


def sample(name: str, count: int, longest: int = 99) -> list[bank.Record]:
    fitting = [r for r in bank.load(name) if len(r.get("indentation_depth", ())) < longest]
    return random.Random(f"{name} of histories").sample(fitting, count)


def same(stored: str, value: mpf) -> bool:
    return bool(value == mpf(stored) or mp.almosteq(mpf(stored), value, STORED))


@pytest.mark.parametrize("name", NAMES)
def test_every_kind_is_covered(name: str) -> None:
    assert {record["profile"]["kind"] for record in bank.load(name)} == EVERY_KIND


def test_every_kind_cycles_by_both_controls() -> None:
    covered = {(r["profile"]["kind"], r["tangential_control"]) for r in bank.load("history_cycles")}
    controls = ("tangential_force", "tangential_displacement")
    assert covered == {(kind, control) for kind in EVERY_KIND for control in controls}


def test_every_scale_and_a_separation_are_covered() -> None:
    scales = {record["tags"]["scale"] for record in everything()}
    assert scales >= {"nm-TPa", "um-GPa", "mm-MPa", "m-GPa", "km-kPa"}
    lost = [record for record in bank.load("history_paths") if _separates_and_touches_again(record)]
    assert len(lost) >= 11


def _separates_and_touches_again(record: bank.Record) -> bool:
    """True if the bodies separate and touch again."""
    depths = record["indentation_depth"]
    gone = [index for index, depth in enumerate(depths) if depth <= 0]
    return bool(gone) and max(depths[: gone[0]], default=0) > 0 and max(depths[gone[0] :]) > 0


@pytest.mark.parametrize(
    "record", sample("history_cycles", 6), ids=lambda record: str(record["id"])
)
def test_stored_cycles_equal_the_closed_form(record: bank.Record) -> None:
    with mp.workdps(slip.WORK_DIGITS):
        at = slip.setting(record["profile"], record["control"], record["load"], material(record))
        index = random.Random(record["id"]).randrange(len(record["given"]))
        amplitude = mpf(record["given"][index])
        dissipated, stiffness = generate.loop(at, record["tangential_control"], amplitude)
        assert same(record["expected"]["energy_per_cycle"][index], dissipated)
        assert same(record["expected"]["secant_stiffness"][index], stiffness)


@pytest.mark.long
@pytest.mark.parametrize(
    "record", sample("history_paths", 3, 20), ids=lambda record: str(record["id"])
)
def test_stored_paths_equal_single_springs(record: bank.Record) -> None:
    path = zip(record["indentation_depth"], record["tangential_displacement"], strict=True)
    result = history(record["profile"], list(path), material(record))
    with mp.workdps(slip.WORK_DIGITS):
        for name, row in record["expected"].items():
            assert all(
                same(stored, getattr(one, name)) for stored, one in zip(row, result, strict=True)
            ), name
