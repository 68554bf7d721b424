"""Modules of the explorer that need no browser."""

import json
import math
import re
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from tests.contract.forged_addresses import OFFERED, forged
from tests.contract.javascript import evaluated

TABLES = Path(__file__).parents[1] / "data" / "tables"
EXPECTED = json.loads((TABLES / "expected.json").read_text("utf-8"))


def test_forged_addresses_yield_offered_words_and_finite_numbers() -> None:
    addresses = list(forged(20_000, seed=2))
    parts = [urlsplit(address) for address in addresses]
    calls = [[f"?{part.query}", f"#{part.fragment}"] for part in parts]
    results = evaluated("inputs.js", "module.fromAddress(...call)", calls)
    number = r"-?\d+(\.\d+)?(e-?\d+)?"
    path = re.compile(rf"{number},{number}(;{number},{number})*")
    for address, result in zip(addresses, results, strict=True):
        assert "error" not in result, address
        table = result["inputs"].pop("table")
        assert path.fullmatch(result["inputs"].pop("path")), address
        assert len(table["r"]) == len(table["f"])
        for value in [*table["r"], *table["f"], *result["inputs"].values()]:
            known = value in OFFERED if isinstance(value, str) else math.isfinite(value)
            assert known, (address, value)
    assert any(result["unread"] for result in results)


def read(files: list[str]) -> dict[str, Any]:
    """Return the table of each file as the explorer reads it, or the error."""
    expression = "module.readTable(module.decoded(Uint8Array.from(call)))"
    calls = [[*(TABLES / file).read_bytes()] for file in files]
    return dict(zip(files, evaluated("table_reader.js", expression, calls), strict=True))


def test_tables_of_instruments_are_read() -> None:
    units = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9}
    for file, table in read(list(EXPECTED["read"])).items():
        expected = EXPECTED["points"] | EXPECTED["read"][file]
        assert table.get("units") == expected["units"], (file, table)
        for name, unit in zip("rf", table["units"], strict=True):
            metres = [float(f"{value * units[unit or 'm']:.15g}") for value in table[name]]
            assert metres == expected[name], file


def test_tables_that_cannot_be_read_are_refused_with_the_line() -> None:
    refused = EXPECTED["refused"]
    assert {file: table.get("error") for file, table in read(list(refused)).items()} == refused
