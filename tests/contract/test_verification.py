"""Published cases: the service meets the error limit of each, and the page lists them all."""

from pathlib import Path

import pytest
from verification.run import Row, results

from tests.conftest import Client

pytestmark = pytest.mark.long

PAGE = Path(__file__).parents[2] / "docs" / "verification.md"


@pytest.fixture(scope="module")
def rows(client: Client) -> list[Row]:
    return results(client)


def test_every_case_is_within_its_error_limit(rows: list[Row]) -> None:
    missed = {row.case.case: row.deviation for row in rows if not row.met}
    assert not missed


def test_page_lists_every_case(rows: list[Row]) -> None:
    text = PAGE.read_text("utf-8")
    assert all(f"| {row.case.equation} | {row.case.case} |" in text for row in rows)
    assert len(rows) >= 150
    assert len({row.case.source for row in rows}) >= 10
