"""The explorer computes, names and links as the service does."""

import json
import math
import re
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest

from tests.conftest import Client
from tests.contract.forged_addresses import OFFERED, forged
from tests.contract.javascript import EXPLORER, evaluated
from tests.contract.page_quantities import quantities

TABLES = Path(__file__).parents[1] / "data" / "tables"


# Inputs that may be empty.
OPTIONAL = ["uncertainty", "thickness", "mass", "density", "yield1", "yield2", "rig", "from", "to"]


def test_forged_addresses_yield_offered_words_and_finite_numbers() -> None:
    addresses = list(forged(20_000, seed=2))
    parts = [urlsplit(address) for address in addresses]
    calls = [[f"?{part.query}", f"#{part.fragment}"] for part in parts]
    results = evaluated("inputs.js", "module.fromAddress(...call)", calls)
    number = r"-?\d+(\.\d+)?(e-?\d+)?"
    numbers = re.compile(rf"({number}(,{number})*)?")
    path = re.compile(rf"{number},{number}(;{number},{number})*")
    for address, result in zip(addresses, results, strict=True):
        assert "error" not in result, address
        table, curve = (result["inputs"].pop(name) for name in ("table", "curve"))
        assert path.fullmatch(result["inputs"].pop("path")), address
        for name in ("breaks", "loads", "rows", "drift"):
            assert numbers.fullmatch(result["inputs"].pop(name, "")), address
        for optional in (
            "uncertainty",
            "thickness",
            "mass",
            "density",
            "yield1",
            "yield2",
            "rig",
            "from",
            "to",
        ):
            given = result["inputs"].pop(optional, "")
            assert given == "" or math.isfinite(given), address
        held = [*result["inputs"].values()]
        for columns in (table, curve):
            assert len(columns["r"]) == len(columns["f"])
            held += [*columns["r"], *columns["f"], *columns["units"]]
        for value in held:
            known = value in OFFERED if isinstance(value, str) else math.isfinite(value)
            assert known, (address, value)
    assert any(result["unread"] for result in results)


def test_load_of_another_control_is_that_of_the_result_or_a_number_of_its_unit() -> None:
    calls = [
        [{"load": load}, "control", "indentation_depth", known]
        for load, known in ((20, {"indentation_depth": 3e-6}), (20, {}), (0, {}))
    ]
    results = evaluated("inputs.js", "module.withChoice(...call)", calls)
    assert [result["load"] for result in results] == [3e-6, 2e-6, 0]


def test_labels_are_those_of_the_openapi_document(client: Client) -> None:
    document = client.get("/openapi.json").json()
    assert (EXPLORER / "quantities.js").read_text("utf-8") == quantities(document)


PAGE = {"ul": "mm", "ud": "µm", "uf": "N", "up": "MPa", "um": "GPa"}


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("5", "force", 5.0),
        ("5 kN", "force", 5e3),
        ("0,3", "1", 0.3),
        ("2/7", "1", 2 / 7),
        ("1,5 µm", "length", 1.5e-6),
        ("1.5 um", "length", 1.5e-6),
        ("10", "length", 1e-2),
        ("276 N/mm²", "pressure", 2.76e8),
        ("4 g", "kg", 4e-3),
        ("50 mJ/m²", "N/m", 0.05),
        ("−2e-3", "force", -2e-3),
        # Neither a thousand nor one, no length, and nothing.
        ("1,000", "force", None),
        ("5 kN", "length", None),
        ("5 foo", "1", None),
        ("", "force", None),
        ("1e60", "force", None),
    ],
)
def test_numbers_are_read_as_people_write_them(
    text: str, dimension: str, value: float | None
) -> None:
    (result,) = evaluated("units.js", "module.read(...call)", [[text, dimension, PAGE]])
    assert result == (None if value is None else pytest.approx(value, rel=1e-14, abs=0))


@pytest.mark.parametrize(
    ("value", "dimension", "shown"),
    [
        (236.34, "energy", "236.34 J"),
        (1.0969e-4, "s", "109.69 µs"),
        (1.6e4, "modulus", "16 kPa"),
        (1e-4, "length", "0.1 mm"),
        (1e-7, "length", "100 nm"),
        (2e9, "pressure", "2000 MPa"),
        (None, "pressure", "∞ MPa"),
        (0, "energy", "0 J"),
    ],
)
def test_numbers_are_shown_in_units_of_their_size(
    value: float | None, dimension: str, shown: str
) -> None:
    result = evaluated("units.js", "module.quantity(...call)", [[value, dimension, PAGE]])
    assert result == [shown]


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (1.0697e7, 1.23e4, "10.697 ± 0.012 MPa"),
        (2.1e11, 4e9, "210.0 ± 4.0 GPa"),
        (5e9, 3e11, "5 ± 300 GPa"),
        (200.0, 3.0, "200.0 ± 3.0 Pa"),
    ],
)
def test_digits_follow_the_standard_error(value: float, error: float, shown: str) -> None:
    call = [value, error, "modulus", PAGE]
    (result,) = evaluated("units.js", "module.uncertain(...call)", [call])
    assert result == shown


STEEL = {"youngs_modulus": 2.1e11, "poissons_ratio": 0.3}
SCAN = np.linspace(0, 6e-4, 25)
# Query, body, and its error or last warning in the units of the page.
MESSAGES: list[tuple[str, dict[str, Any], str]] = json.loads(
    (TABLES.parent / "page_messages.json").read_text("utf-8")
)


def message(client: Client, query: str, body: dict[str, Any]) -> str:
    material = {"bodies": [STEEL, STEEL]} | ({"yield_strength": 1e9} if "points" in body else {})
    material |= body.get("material", {})
    response = client.post(f"/v1/{query}", body | {"material": material}).json()
    found = response.get("errors") or response["warnings"]
    return str(found[-1].get("detail") or found[-1]["message"])


def test_messages_are_in_the_units_and_words_of_the_page(client: Client) -> None:
    messages = [message(client, query, body) for query, body, _ in MESSAGES]
    page = {"ul": "mm", "ud": "µm", "uf": "kN", "oscillation": "tangential_force"}
    labels = {"flat_radius": "Radius b of the flat"}
    calls = [[text, page, labels] for text in messages]
    results = evaluated("messages.js", "module.inWords(...call)", calls)
    assert results == [expected for _, _, expected in MESSAGES]


def test_deviations_of_a_table_are_heights(client: Client) -> None:
    flat = np.maximum(0, np.abs(SCAN - 3e-4) - 1e-4) ** 0.9
    table = {"kind": "tabulated", "r": (SCAN - 3e-4).tolist(), "f": flat.tolist()}
    text = message(client, "normal", {"profile": table, "load": {"contact_radius": 2e-4}})
    page = {"ul": "mm", "ud": "nm", "uf": "N", "oscillation": "tangential_force"}
    (shown,) = evaluated("messages.js", "module.inWords(...call)", [[text, page, {}]])
    assert re.search(r"deviates by \S+ nm at radius \S+ mm, and by \S+ nm in the root", shown)
    assert "see “Error due to the points of a table”" in shown
