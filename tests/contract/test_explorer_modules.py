"""Modules of the explorer that need no browser."""

import math
import re
from urllib.parse import urlsplit

from tests.contract.forged_addresses import OFFERED, forged
from tests.contract.javascript import evaluated


def test_forged_addresses_yield_offered_words_and_finite_numbers() -> None:
    addresses = list(forged(20_000, seed=2))
    parts = [urlsplit(address) for address in addresses]
    calls = [[f"?{part.query}", f"#{part.fragment}"] for part in parts]
    results = evaluated("inputs.js", "fromAddress", calls)
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
