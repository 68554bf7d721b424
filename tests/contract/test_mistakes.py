"""Errors of a newcomer on the command line or in Python name the remedy.

The expectations were written first: they are the words that a reader needs to continue.
"""

import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mdr_core as mdr
from mdr_command.__main__ import main
from tests.conftest import Client

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
BALL = {"kind": "paraboloid", "radius": 0.01}
MODULI = {"e_star": 115e9, "g_star": 95e9}
FORCE = {"normal_force": 10}
FRICTION = {"friction_coefficient": 0.3, "tangential": {"tangential_force": 1}}
# Words of the tools behind the service, which mean nothing to its users.
JARGON = re.compile(
    r"Input should|validation|pydantic|discriminator|\btag\b|NoneType|ndarray|loc\b"
)

NORMAL = {"profile": BALL, "material": MODULI, "load": FORCE}
OPTIONS = "--kind paraboloid --radius 0.01 --e-star 1e11"
BY_COMMAND: dict[str, tuple[str, list[str]]] = {
    "radius in a unit": (
        "normal --kind paraboloid --radius 10mm --e-star 1e11 --normal-force 1",
        ["--radius", "0.01", "unit"],
    ),
    "no modulus": (
        "normal --kind paraboloid --radius 0.01 --normal-force 1",
        ["--e-star", "--youngs-modulus-1", "--poissons-ratio-1"],
    ),
    "no load": (f"normal {OPTIONS}", ["--normal-force", "--indentation-depth", "exactly one"]),
    "a wrong option": (f"normal {OPTIONS} --force 1", ["--force", "mdr normal --help"]),
    "a spreadsheet": (f"normal {OPTIONS} --normal-force 1 -o x.xlsx", ["xlsx", ".csv", "--format"]),
    "a table as the request": ("normal table.csv", ["table.csv", "JSON", "--table", "--help"]),
    "a table as a kind": (
        "normal --kind tabulated --e-star 1 --normal-force 1",
        ["--kind", "--table", "paraboloid"],
    ),
    "a table beneath the surface": ("subsurface table.csv", ["table.csv", "JSON object"]),
    "a request that is not there": ("normal request.json", ["request.json", "No such file"]),
    "a wrong request": ("normal wrong.json", ["wrong.json", "load", "normal_force"]),
    "a request and options": (f"normal wrong.json {OPTIONS}", ["file", "options", "not both"]),
    "no fields": (f"stress {OPTIONS} --normal-force 1 --points 9", ["--quantities", "pressure"]),
    "no friction": (
        f"tangential {OPTIONS} --normal-force 1 --tangential-force 0.1",
        ["--friction-coefficient", "required"],
    ),
}


@pytest.mark.parametrize("mistake", BY_COMMAND)
def test_command_line_names_the_remedy_in_a_line(
    mistake: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("table.csv").write_text("r,f\n0,0\n1,1\n", "utf-8")
    Path("wrong.json").write_text(json.dumps(NORMAL | {"load": {"force": 1}}), "utf-8")
    line, said = BY_COMMAND[mistake]
    assert main(line.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"mdr {line.split()[0]}: ")
    assert err.count("\n") == 1
    assert not err.rstrip().endswith("}")
    assert all(part in err for part in said), err
    assert not JARGON.search(err), err


BODY = mdr.Body(210e9, 0.3)
PAIR = mdr.from_bodies([BODY, BODY])
PRESSED = mdr.normal.solve(mdr.Paraboloid(0.01), PAIR, normal_force=10.0)
HISTORY: Any = mdr.history.solve(
    mdr.Paraboloid(0.01), PAIR, PAIR, 0.3, normal_force=10.0, tangential_force=[0.0, 1.0]
)
STATE = mdr.history.unloaded(mdr.Paraboloid(1), PAIR, PAIR, 0.3)


def impact(**changed: Any) -> mdr.impact.Impact:
    motion = dict.fromkeys(("normal_mass", "normal_velocity", "tangential_velocity"), 1.0)
    motion |= {"tangential_mass": 0.3, **changed}
    return mdr.impact.solve(mdr.Paraboloid(1), PAIR, PAIR, 0.3, **motion)


IN_PYTHON: dict[str, tuple[Callable[[], Any], list[str]]] = {
    "a rubber of 0.6": (lambda: mdr.Body(210e9, 0.6), ["poissons_ratio", "at most 0.5"]),
    "constants swapped": (lambda: mdr.Body(0.3, 210e9), ["poissons_ratio", "at most 0.5"]),
    "one body": (lambda: mdr.from_bodies([BODY]), ["exactly two bodies"]),
    "a body by name": (lambda: mdr.from_bodies([BODY, "steel"]), ["Body", '"rigid"']),
    "radius 0": (lambda: mdr.Paraboloid(0), ["radius", "must be positive"]),
    "radius in a unit": (lambda: mdr.Paraboloid("10 mm"), ["radius", "number"]),
    "one body as the material": (
        lambda: mdr.normal.solve(mdr.Paraboloid(1), BODY, normal_force=1),
        ["e_star", "both bodies", "from_bodies"],
    ),
    "swapped arguments": (
        lambda: mdr.normal.solve(PAIR, mdr.Paraboloid(1), normal_force=1),
        ["profile", "Paraboloid(0.01)", "not Material"],
    ),
    "a class as the profile": (
        lambda: mdr.normal.solve(mdr.Paraboloid, PAIR, normal_force=1),
        ["profile", "Paraboloid(0.01)"],
    ),
    "no load": (
        lambda: mdr.normal.solve(mdr.Paraboloid(1), PAIR),
        ["load", "exactly one of", "normal_force"],
    ),
    "a load in a unit": (
        lambda: mdr.normal.solve(mdr.Paraboloid(1), PAIR, normal_force="10 N"),
        ["normal_force", "number", "not str"],
    ),
    "depths before contact": (
        lambda: mdr.normal.solve(mdr.Paraboloid(1), PAIR, indentation_depth=[-1e-6, 1e-6]),
        ["indentation_depth[0]", "first contact", "give 0"],
    ),
    "friction on a profile": (
        lambda: mdr.tangential.solve(mdr.Paraboloid(1), PAIR, 0.3, tangential_force=1),
        ["contact", "normal.solve", "not Paraboloid"],
    ),
    "friction without a shear modulus": (
        lambda: mdr.tangential.solve(PRESSED, mdr.Material(1e11), 0.3, tangential_force=1),
        ["g_star", "needed with friction", "bodies"],
    ),
    "pressure of a profile": (
        lambda: mdr.fields.pressure(mdr.Paraboloid(1), [0.0]),
        ["contact", "normal.solve", "not Paraboloid"],
    ),
    "shear stress without friction": (
        lambda: mdr.fields.shear_stress(PRESSED, [0.0]),
        ["contact", "tangential.solve", "not NormalContact"],
    ),
    "shear stress of a history": (
        lambda: mdr.fields.shear_stress(HISTORY, [0.0]),
        ["the state of a load history", "not LoadHistory"],
    ),
    "a step from a profile": (
        lambda: mdr.history.advance(mdr.Paraboloid(1), 1e-6, 0.0),
        ["state", "history.unloaded"],
    ),
    "a step of several depths": (
        lambda: mdr.history.advance(STATE, [1e-6, 2e-6], 0.0),
        ["indentation_depth: must be a single number"],
    ),
    "a list of states": (
        lambda: mdr.history.advance_many([STATE, STATE], 1e-6, 0.0),
        ["states", "from advance_many", "not list"],
    ),
    "a step to no number": (
        lambda: mdr.history.advance(STATE, 1e-6, math.nan),
        ["tangential_displacement: must be finite"],
    ),
    "several coefficients of friction": (
        lambda: mdr.history.unloaded(mdr.Paraboloid(1), PAIR, PAIR, [0.2, 0.3]),
        ["friction_coefficient: must be a single number"],
    ),
    "no velocities": (
        lambda: impact(normal_velocity=[]),
        ["normal_velocity: at least one value is needed"],
    ),
    "velocities of two shapes": (
        lambda: impact(normal_velocity=np.ones((1, 2)), tangential_velocity=np.ones((2, 3))),
        ["tangential_velocity", "2 x 3", "1 x 2"],
    ),
    "several masses": (
        lambda: impact(normal_mass=[1.0, 2.0]),
        ["normal_mass: must be a single number"],
    ),
    "Poisson's ratio as text": (
        lambda: mdr.Body(210e9, "0.3"),
        ["poissons_ratio", "number", "not str"],
    ),
    "an accuracy as text": (
        lambda: impact(rtol="1e-3"),
        ["rtol", "number", "not str"],
    ),
    "a yield criterion by another name": (
        lambda: mdr.subsurface.yield_onset_force(PRESSED, 1e9, "mises", poissons_ratio=0.3),
        ["measure", "von_mises", "maximum_shear"],
    ),
    "a curve as columns": (
        lambda: mdr.fit.solve(
            mdr.Paraboloid(1), indentation_depth=np.ones((3, 1)), normal_force=np.ones((3, 1))
        ),
        ["indentation_depth: must be a list of numbers", "3 x 1"],
    ),
    "a table as columns": (
        lambda: mdr.Tabulated(np.ones((3, 1)), np.ones((3, 1))),
        ["r: must be a list of numbers", "3 x 1"],
    ),
    "pairs as terms": (
        lambda: mdr.Series([(1.0, 2.0)]),
        ["terms[0]", "PowerTerm(coefficient, exponent)"],
    ),
}


@pytest.mark.parametrize("mistake", IN_PYTHON)
def test_exception_names_the_remedy(mistake: str) -> None:
    call, said = IN_PYTHON[mistake]
    with pytest.raises(mdr.InputError) as raised:
        call()
    message = str(raised.value)
    assert all(part in message for part in said), message
    assert not JARGON.search(message), message


@pytest.mark.parametrize(
    ("profile", "load"),
    [
        (BALL | {"radius": -1}, FORCE),
        (BALL, {"normal_force": -1}),
        (BALL, {"indentation_depth": [0, -1]}),
        (BALL, {}),
        ({"kind": "sphere", "radius": 1}, {"contact_radius": 1}),
    ],
)
def test_sentences_of_http_and_python_are_the_same(
    client: Client, profile: dict[str, Any], load: dict[str, Any]
) -> None:
    def solve() -> Any:
        return mdr.normal.solve(mdr.KINDS[profile["kind"]](float(profile["radius"])), 115e9, **load)

    problem = client.post("/v1/normal", NORMAL | {"profile": profile, "load": load}).json()
    with pytest.raises(mdr.InputError) as raised:
        solve()
    # The service adds the bound of all numbers.
    place, _, detail = problem["detail"].removesuffix(", at least 1e-50").partition(": ")
    assert place == ".".join(map(str, raised.value.path))
    assert detail == raised.value.detail
    assert problem["errors"][0]["detail"].startswith(raised.value.detail)
