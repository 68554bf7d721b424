"""The banks of partial slip are complete and equal what their generator computes."""

from __future__ import annotations

import random

import pytest
from mpmath import mp, mpf

from tests.oracles import bank
from tests.oracles import slip_reference as reference
from tests.oracles.shapes import BANKED
from tests.oracles.slip_reference import CONTROLS, Material
from tests.oracles.test_bank import STORED


def everything() -> list[bank.Record]:
    return [record for name in ("tangential", "slip_fields") for record in bank.load(name)]


def test_every_kind_is_covered_by_every_control() -> None:
    covered = {(r["profile"]["kind"], r["tangential_control"]) for r in everything()}
    expected = {(kind, control) for kind in BANKED for control in CONTROLS}
    # A flat punch has a single stick radius, independent of the force.
    assert covered == expected - {("flat_punch", "stick_radius")}


def test_every_regime_and_direction_is_covered() -> None:
    records = bank.load("tangential")
    result = {regime for record in records for regime in record["regime"]}
    assert result == {"stick", "partial_slip", "full_slip"}
    signs = {value > 0 for record in records for value in record["given"]}
    assert signs == {True, False}
    assert {r["tags"]["scale"] for r in records} >= {"nm-TPa", "km-kPa"}


def test_every_kind_has_its_fields() -> None:
    kinds = {record["profile"]["kind"] for record in bank.load("slip_fields")}
    assert kinds == set(BANKED)


def sample(name: str, count: int) -> list[bank.Record]:
    eligible = [r for r in bank.load(name) if r["profile"]["kind"] != "flat_punch"]
    return random.Random(f"{name} of the bank").sample(eligible, count)


def setting(record: bank.Record) -> reference.Setting:
    material = Material(record["e_star"], record["g_star"], record["friction_coefficient"])
    return reference.setting(record["profile"], record["control"], record["load"], material)


@pytest.mark.parametrize("record", sample("tangential", 12), ids=lambda record: str(record["id"]))
def test_stored_results_equal_the_reference(record: bank.Record) -> None:
    at = setting(record)
    partial = [i for i, regime in enumerate(record["regime"]) if regime == "partial_slip"]
    energy = "dissipated_energy" in record["expected"]
    for index in random.Random(record["id"]).sample(partial, 2):
        control, given = record["tangential_control"], record["given"][index]
        answer = reference.solve(at, control, given, energy=energy)
        with mp.workdps(40):
            for name, row in record["expected"].items():
                assert mp.almosteq(mpf(row[index]), answer.values[name], STORED), name


@pytest.mark.parametrize("record", sample("slip_fields", 6), ids=lambda record: str(record["id"]))
def test_stored_fields_equal_the_reference(record: bank.Record) -> None:
    at = setting(record)
    answer = reference.solve(at, record["tangential_control"], record["given"], energy=False)
    index = random.Random(record["id"]).randrange(len(record["radius"]))
    with mp.workdps(reference.WORK_DIGITS):
        r, sign = mpf(record["radius"][index]), 1 if record["given"] > 0 else -1
        result = {
            "shear_stress": sign * at.mu * reference.traction(at, answer.c, r),
            "slip": sign * reference.slip(at, answer.c, r),
            "normal_displacement": reference.displacement(at, r),
        }
        for name, value in result.items():
            stored = mpf(record["expected"][name][index])
            assert value == stored or mp.almosteq(stored, value, STORED), name
