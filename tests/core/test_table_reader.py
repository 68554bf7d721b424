"""Tables as instruments write them, in `tests/data/tables`, are read with their units."""

import json
from pathlib import Path

import pytest

from mdr_core import InputError, Tabulated, read_table

TABLES = Path(__file__).parents[1] / "data" / "tables"
EXPECTED = json.loads((TABLES / "expected.json").read_text("utf-8"))


@pytest.mark.parametrize("file", EXPECTED["read"])
def test_tables_of_instruments_are_read(file: str) -> None:
    expected = EXPECTED["points"] | EXPECTED["read"][file]
    named = None not in expected["units"]
    table = read_table(TABLES / file, None if named else "m")
    assert table.r.tolist() == expected["r"]
    assert table.f.tolist() == expected["f"]
    millimetres = read_table(TABLES / file, None if named else "m", to="mm")
    assert millimetres.r.tolist() == [float(f"{1e3 * r:.15g}") for r in expected["r"]]


@pytest.mark.parametrize("file", EXPECTED["refused"])
def test_tables_that_cannot_be_read_are_refused_with_the_line(file: str) -> None:
    with pytest.raises(InputError) as refused:
        read_table(TABLES / file, "m")
    assert refused.value.detail == EXPECTED["refused"][file]


@pytest.mark.parametrize(
    ("file", "unit", "detail"),
    [
        ("plain.txt", None, "is required: no heading names the unit of r"),
        ("plain.txt", "inch", "inch is none of m, mm, µm, nm"),
        ("decimal_comma.csv", "mm", "is µm in the heading of f, and not mm"),
    ],
)
def test_unit_is_needed_once(file: str, unit: str | None, detail: str) -> None:
    with pytest.raises(InputError) as refused:
        read_table(TABLES / file, unit)
    assert refused.value.path == ("length_unit",)
    assert refused.value.detail == detail


def test_units_of_radii_and_heights_may_differ() -> None:
    table = read_table(TABLES / "plain.txt", ("mm", "µm"))
    assert table.r.tolist() == [0, 5e-8, 1e-7, 1.5e-7]
    assert table.f.tolist() == [0, 1.25e-13, 5e-13, 1.125e-12]


def test_table_is_a_profile() -> None:
    # A ball of radius 10 mm.
    profile = Tabulated(*read_table(TABLES / "tabs.txt"))
    assert float(profile.f(1e-4)) == pytest.approx(5e-7, rel=1e-3, abs=0)
