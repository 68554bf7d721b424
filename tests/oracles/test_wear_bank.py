"""The bank of wear limits is complete and equals what its generator computes."""

from __future__ import annotations

import random

import pytest
from mpmath import mp, mpf

from tests.oracles import bank
from tests.oracles import wear_reference as reference
from tests.oracles.shapes import BANKED
from tests.oracles.slip_reference import Material
from tests.oracles.test_bank import STORED
from tests.oracles.wear_generate import PAIRS

SAMPLE = random.Random("wear limits").sample(bank.load("wear_limit"), 6)


def test_every_equation_of_a_limit_is_covered() -> None:
    claimed = {record["equation"] for record in bank.load("wear_limit")}
    limits = {"(5.80)", "(5.82)", "(5.83)", "(5.85)", "(5.87)", "(5.88)", "(5.90)"}
    assert claimed == limits


def test_every_kind_is_covered_by_every_pair() -> None:
    records = bank.load("wear_limit")
    covered = {(r["profile"]["kind"], r["control"], r["amplitude"]) for r in records}
    kinds = set(BANKED) - {"flat_punch"}
    assert covered == {(kind, *pair) for kind in kinds for pair in PAIRS}


def test_stick_radii_from_a_thousandth_to_a_millionth_short_of_the_contact() -> None:
    ratios = [
        float(c) / float(r)
        for record in bank.load("wear_limit")
        for c, r in zip(
            record["expected"]["stick_radius"], record["expected"]["wear_radius"], strict=True
        )
    ]
    assert min(ratios) < 1e-3
    assert 1 - 2e-6 < max(ratios) < 1
    assert {record["tags"]["scale"] for record in bank.load("wear_limit")} >= {"nm-TPa", "km-kPa"}


@pytest.mark.long
@pytest.mark.parametrize("record", SAMPLE, ids=lambda record: str(record["id"]))
def test_stored_results_equal_the_reference(record: bank.Record) -> None:
    index = random.Random(record["id"]).randrange(len(record["given"]))
    material = Material(record["e_star"], record["g_star"], record["friction_coefficient"])
    load, given = record["load"], record["given"][index]
    query = record["profile"], record["control"], load, material, record["amplitude"], given
    limit = reference.solve(*query)
    with mp.workdps(40):
        for name, value in reference.answers(limit).items():
            assert mp.almosteq(mpf(record["expected"][name][index]), value, STORED), name
        for fields in record["fields"]:
            if fields["index"] == index:
                place = len(fields["radius"]) // 2
                value = reference.field(limit, "limiting_profile", mpf(fields["radius"][place]))
                stored = mpf(fields["expected"]["limiting_profile"][place])
                assert mp.almosteq(stored, value, STORED)
