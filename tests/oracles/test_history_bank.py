"""The bank of histories checks itself: ids, sources, coverage, and a sample computed again."""

from __future__ import annotations

import random
import re

import pytest
from mpmath import mp, mpf

from tests.oracles import history_bank
from tests.oracles import history_generate as generate
from tests.oracles import slip_reference as slip
from tests.oracles.history_reference import history
from tests.oracles.shapes import KINDS
from tests.oracles.slip_reference import Material
from tests.oracles.test_bank import SOURCES, STORED

EVERY_KIND = {*KINDS, "tabulated"}


def everything() -> list[history_bank.Record]:
    return [record for name in history_bank.NAMES for record in history_bank.load(name)]


def material(record: history_bank.Record) -> Material:
    return Material(record["e_star"], record["g_star"], record["friction_coefficient"])


def sample(name: str, count: int, longest: int = 99) -> list[history_bank.Record]:
    fitting = [r for r in history_bank.load(name) if len(r.get("indentation_depth", ())) < longest]
    return random.Random(f"{name} of histories").sample(fitting, count)


def same(stored: str, value: mpf) -> bool:
    return bool(value == mpf(stored) or mp.almosteq(mpf(stored), value, STORED))


def test_ids_are_unique() -> None:
    ids = [record["id"] for record in everything()]
    assert len(ids) == len(set(ids))


def test_every_equation_is_among_the_sources() -> None:
    known = set(re.findall(r"\(\d+\.\d+\)", SOURCES.read_text(encoding="utf-8")))
    claimed = {record["equation"] for record in everything()}
    assert claimed <= known, f"missing from docs/sources.md: {sorted(claimed - known)}"


@pytest.mark.parametrize("name", history_bank.NAMES)
def test_every_kind_is_covered(name: str) -> None:
    assert {record["profile"]["kind"] for record in history_bank.load(name)} == EVERY_KIND


def test_every_kind_cycles_by_both_controls() -> None:
    covered = {(r["profile"]["kind"], r["tangential_control"]) for r in history_bank.load("cycles")}
    controls = ("tangential_force", "tangential_displacement")
    assert covered == {(kind, control) for kind in EVERY_KIND for control in controls}


def test_every_scale_and_a_lost_contact_are_covered() -> None:
    scales = {record["tags"]["scale"] for record in everything()}
    assert scales >= {"nm-TPa", "um-GPa", "mm-MPa", "m-GPa", "km-kPa"}
    lost = [record for record in history_bank.load("paths") if _is_lost(record)]
    assert len(lost) >= 12


def _is_lost(record: history_bank.Record) -> bool:
    """Whether the contact is lost and found again."""
    depths = record["indentation_depth"]
    gone = [index for index, depth in enumerate(depths) if depth <= 0]
    return bool(gone) and max(depths[: gone[0]], default=0) > 0 and max(depths[gone[0] :]) > 0


def test_nothing_is_won_from_friction() -> None:
    for record in history_bank.load("paths"):
        lost = [mpf(value) for value in record["expected"]["dissipated_energy"]]
        assert lost == sorted(lost), record["id"]
        expected = record["expected"]
        with mp.workdps(40):
            mu = mpf(record["friction_coefficient"])
            # Both forces are rounded to the stored digits.
            for force, normal in zip(
                expected["tangential_force"], expected["normal_force"], strict=True
            ):
                assert abs(mpf(force)) <= mu * mpf(normal) * (1 + 10 * STORED), record["id"]


@pytest.mark.parametrize("record", sample("cycles", 6), ids=lambda record: str(record["id"]))
def test_stored_cycles_are_those_of_the_closed_form(record: history_bank.Record) -> None:
    with mp.workdps(slip.WORK_DIGITS):
        at = slip.setting(record["profile"], record["control"], record["load"], material(record))
        index = random.Random(record["id"]).randrange(len(record["given"]))
        amplitude = mpf(record["given"][index])
        lost, stiffness = generate.loop(at, record["tangential_control"], amplitude)
        assert same(record["expected"]["energy_per_cycle"][index], lost)
        assert same(record["expected"]["secant_stiffness"][index], stiffness)


@pytest.mark.parametrize("record", sample("paths", 3, 20), ids=lambda record: str(record["id"]))
def test_stored_paths_are_those_of_single_springs(record: history_bank.Record) -> None:
    path = zip(record["indentation_depth"], record["tangential_displacement"], strict=True)
    found = history(record["profile"], list(path), material(record))
    with mp.workdps(slip.WORK_DIGITS):
        for name, row in record["expected"].items():
            assert all(
                same(stored, getattr(one, name)) for stored, one in zip(row, found, strict=True)
            ), name
