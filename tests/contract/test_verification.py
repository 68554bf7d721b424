"""The service meets the error limit of every published case, and the table lists each."""

import csv
from pathlib import Path

import pytest
from verification.run import Row, results

from tests.conftest import Client

pytestmark = pytest.mark.long

TABLE = Path(__file__).parents[2] / "docs" / "verification.csv"


@pytest.fixture(scope="module")
def rows(client: Client) -> list[Row]:
    return results(client)


def test_every_case_is_within_its_error_limit(rows: list[Row]) -> None:
    missed = {row.case.case: row.deviation for row in rows if not row.met}
    assert not missed


def test_table_lists_every_case(rows: list[Row]) -> None:
    with TABLE.open(encoding="utf-8", newline="") as file:
        listed = {(line["equation"], line["case"]) for line in csv.DictReader(file)}
    assert {(row.case.equation, row.case.case) for row in rows} <= listed
    assert len(rows) >= 150
    assert len({row.case.source for row in rows}) >= 10
