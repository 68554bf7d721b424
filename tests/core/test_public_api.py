"""Public names exist, results are readable, and stepping by states continues a path."""

import inspect
import pydoc
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mdr_core as mdr
from mdr_core.history import advance, unloaded
from mdr_core.results import Results

ROOT = Path(__file__).parents[2]
BALL, PAIR = mdr.Paraboloid(0.01), mdr.from_bodies([mdr.Body(210e9, 0.3)] * 2)
G_STAR = PAIR.g_star or 0.0
CONTACT = mdr.normal.solve(BALL, PAIR.e_star, normal_force=10.0)
FRICTION = (BALL, PAIR.e_star, G_STAR, 0.3)

RESULTS: list[Results] = [
    CONTACT,
    mdr.normal.solve(mdr.Cone(0.1), 1.0, indentation_depth=[1.0, 2.0]),
    mdr.tangential.solve(CONTACT, G_STAR, 0.3, tangential_force=[1.0, 2.0]),
    mdr.history.solve(*FRICTION, normal_force=10.0, tangential_force=[0.0, 2.0, 0.0]),
    mdr.history.cycles(*FRICTION, normal_force=10.0, tangential_force=2.0),
    unloaded(*FRICTION),
    advance(unloaded(*FRICTION), 1e-6, 1e-7),
    mdr.wear.limit.solve(CONTACT, G_STAR, 0.3, tangential_force=2.0),
]


def test_every_public_name_exists() -> None:
    assert all(hasattr(mdr, name) for name in mdr.__all__)
    assert {cls.__name__ for cls in mdr.KINDS.values()} <= set(mdr.__all__)


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: type(result).__name__)
def test_str_shows_every_result_on_a_line(result: Results) -> None:
    title, *lines = repr(result).splitlines()
    assert title == f"{type(result).__name__}:"
    assert [line.split(":")[0].strip() for line in lines] == list(result.to_dict())


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: type(result).__name__)
def test_dictionary_holds_the_attributes(result: Results) -> None:
    values = result.to_dict()
    for name in result.quantities:
        np.testing.assert_array_equal(values[name], getattr(result, name))
    assert all(not isinstance(value, np.ndarray) or value.ndim for value in values.values())


def test_dictionary_lists_the_warnings() -> None:
    codes = [notice["code"] for notice in RESULTS[1].to_dict()["warnings"]]
    assert "singular" in codes


def test_str_of_many_loads_is_short() -> None:
    contact = mdr.normal.solve(BALL, PAIR.e_star, normal_force=np.linspace(1.0, 10.0, 1000))
    assert max(map(len, repr(contact).splitlines())) < 100


@pytest.mark.long
def test_impact_conserves_energy_and_rebounds_as_measured() -> None:
    path = ROOT / "examples" / "bouncing_sphere.py"
    done = subprocess.run([sys.executable, path], check=True, capture_output=True, text=True)
    lines = done.stdout.splitlines()
    gallery = (ROOT / "docs" / "gallery.md").read_text("utf-8")
    # The last column is rounding error.
    assert all(line.rpartition(" ")[0].rstrip() in gallery for line in lines[1:])
    rows = [list(map(float, line.split())) for line in lines[1:]]
    assert [row[0] for row in rows] == [4.2, 9.8, 20.2, 30.4, 39.5]
    for _, measured, computed, energy_error in rows:
        # Scatter of single measurements.
        assert computed == pytest.approx(measured, abs=0.04)
        assert energy_error < 1e-13


def test_every_exported_object_has_a_readable_form() -> None:
    for value in (BALL, PAIR, mdr.Body(1.0, 0.3), mdr.PowerTerm(1.0, 2.0), mdr.Notice("a", "b")):
        assert repr(value).startswith(f"{type(value).__name__}(")


def test_material_stands_for_its_moduli() -> None:
    wear = {"wear_coefficient": 1e-14, "cycles": [0.0], "resolution": 8, "tangential_force": 2.0}
    forces = {"normal_force": 10.0, "tangential_force": 2.0}
    for solve in (
        lambda e, _g: mdr.normal.solve(BALL, e, normal_force=10.0),
        lambda _e, g: mdr.tangential.solve(CONTACT, g, 0.3, tangential_force=2.0),
        lambda e, g: mdr.history.solve(BALL, e, g, 0.3, **forces),
        lambda e, g: mdr.history.cycles(BALL, e, g, 0.3, **forces),
        lambda e, g: unloaded(BALL, e, g, 0.3),
        lambda _e, g: mdr.wear.limit.solve(CONTACT, g, 0.3, tangential_force=2.0),
        lambda _e, g: mdr.wear.evolution.solve(CONTACT, g, 0.3, **wear),
    ):
        by_material, by_numbers = solve(PAIR, PAIR), solve(PAIR.e_star, PAIR.g_star)
        # The estimate of the model's error depends on the bodies.
        found, expected = (
            [line for line in repr(each).splitlines() if "model_error" not in line]
            for each in (by_material, by_numbers)
        )
        assert found == expected


def test_warnings_are_those_of_the_given_bodies() -> None:
    """A power r^2 has 0.63 |beta| t + t^2 > 0.01 with one elastic body alone."""

    def codes(material: mdr.Material | float) -> list[str]:
        g_star = material if isinstance(material, mdr.Material) else PAIR
        contact = mdr.normal.solve(mdr.Power(0.5, 2.0), material, indentation_depth=0.06**2)
        partial = mdr.tangential.solve(contact, g_star, 0.3, tangential_displacement=0.0)
        worn = mdr.wear.limit.solve(contact, g_star, 0.3, tangential_force=0.0)
        found = {notice.code for result in (contact, partial, worn) for notice in result.warnings}
        return sorted(found - {"no_wear"})

    assert codes(PAIR) == []
    assert codes(PAIR.e_star) == ["half_space"]
    one_elastic = mdr.from_bodies([mdr.Body(210e9, 0.3), mdr.RIGID])
    assert codes(one_elastic) == ["elastic_similarity", "half_space"]


def test_fields_of_the_pressure_take_a_contact_with_friction() -> None:
    partial = mdr.tangential.solve(CONTACT, PAIR, 0.3, tangential_force=2.0)
    for field in (mdr.fields.pressure, mdr.fields.normal_displacement, mdr.fields.foundation_load):
        np.testing.assert_array_equal(field(partial, [1e-5]), field(CONTACT, [1e-5]))


def documented() -> list[tuple[str, Callable[..., Any]]]:
    """Functions of the reference page that take more than one argument."""
    page = (ROOT / "docs" / "reference.md").read_text("utf-8")
    named = {name: pydoc.locate(name) for name in re.findall(r"^::: (\S+)", page, re.MULTILINE)}
    return [
        (name, entry)
        for name, entry in named.items()
        if inspect.isfunction(entry) and len(inspect.signature(entry).parameters) > 1
    ]


def test_reference_lists_functions() -> None:
    assert len(documented()) > 18


@pytest.mark.parametrize(("name", "function"), documented())
def test_documented_function_describes_each_parameter(
    name: str, function: Callable[..., Any]
) -> None:
    text = inspect.getdoc(function) or ""
    section = text.partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    described = re.findall(r"^([a-z_][a-z_, ]*) : ", section, re.MULTILINE)
    names = {one.strip() for group in described for one in group.split(",")}
    assert names == set(inspect.signature(function).parameters), name
