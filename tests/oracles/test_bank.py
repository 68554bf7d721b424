"""Every bank is complete, has its source, and equals what its generator computes."""

from __future__ import annotations

import random
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from mpmath import mp, mpf

from tests.core.comparison import INPUT, LARGEST_ALLOWANCE
from tests.oracles import bank
from tests.oracles.generate import pressure_at, pressure_state
from tests.oracles.reference import CONTROLS, OUTPUTS, state
from tests.oracles.shapes import BANKED

if TYPE_CHECKING:
    from collections.abc import Iterator

SOURCES = Path(__file__).parents[2] / "docs" / "sources.md"
STORED = mpf(10) ** -29


def everything() -> list[bank.Record]:
    return [record for name in bank.NAMES for record in bank.load(name)]


def test_ids_are_unique() -> None:
    ids = [record["id"] for record in everything()]
    assert len(ids) == len(set(ids))


def test_every_equation_is_among_the_sources() -> None:
    assert SOURCES.is_file(), f"{SOURCES} must list the equations that the bank claims"
    known = set(re.findall(r"\(\d+\.\d+\)", SOURCES.read_text(encoding="utf-8")))
    claimed = {record["equation"] for record in everything()}
    assert claimed <= known, f"missing from docs/sources.md: {sorted(claimed - known)}"


def test_every_kind_is_covered_by_every_control() -> None:
    covered = {(r["profile"]["kind"], r["control"]) for r in bank.load("normal")}
    expected = {(kind, control) for kind in BANKED for control in CONTROLS}
    # The radius of a flat punch is a parameter and cannot be prescribed.
    assert covered == expected - {("flat_punch", "contact_radius")}


def test_every_kind_has_pressures_and_equivalent_profiles() -> None:
    for name in ("pressure", "profile"):
        assert {r["profile"]["kind"] for r in bank.load(name)} == set(BANKED)


ILL_CONDITIONED = {
    "tangential": 482,
    "wear_limit": 107,
    "slip_fields": 3,
    "pressure": 1,
    "profile": 5,
}
"""Numbers of stored results, per bank, that the rounding of the inputs alone may change by more
than 1e-3. Their bounds include no more than that, apart from slip next to a stick radius and from
tangential contacts whose normal force is computed."""


def conditions(record: Any, key: str = "") -> Iterator[float]:
    """Yield the condition numbers of a record, at any depth."""
    if isinstance(record, dict):
        for name, value in record.items():
            yield from conditions(value, key if key.startswith("condition") else name)
    elif isinstance(record, list):
        for value in record:
            yield from conditions(value, key)
    elif key.startswith("condition") and record is not None:
        yield record


def test_ill_conditioned_results_are_counted() -> None:
    result = {
        name: sum(
            INPUT * condition > LARGEST_ALLOWANCE
            for record in bank.load(name)
            for condition in conditions(record)
        )
        for name in bank.NAMES
    }
    assert {name: count for name, count in result.items() if count} == ILL_CONDITIONED


def sample(name: str, count: int) -> list[bank.Record]:
    return random.Random(f"{name} of the bank").sample(bank.load(name), count)


@pytest.mark.parametrize("record", sample("normal", 12), ids=lambda record: str(record["id"]))
def test_stored_results_equal_the_reference(record: bank.Record) -> None:
    answer = state(record["profile"], record["control"], record["load"], record["e_star"])
    with mp.workdps(40):
        for name in OUTPUTS:
            assert mp.almosteq(mpf(record["expected"][name]), answer.values[name], STORED)


@pytest.mark.parametrize("record", sample("pressure", 6), ids=lambda record: str(record["id"]))
def test_stored_pressures_equal_the_reference(record: bank.Record) -> None:
    given = pressure_state(record["profile"], record["control"], record["load"], record["e_star"])
    chosen = random.Random(record["id"]).randrange(len(record["radius"]))
    value = pressure_at(given, record["radius"][chosen]) * mpf(record["e_star"])
    stored = mpf(record["expected"][chosen])
    with mp.workdps(40):
        assert value == stored or mp.almosteq(stored, value, STORED)
