"""Options, files and the list of profiles of `mdr` give the query that the JSON gives."""

import json
import math
import shlex
from pathlib import Path

import numpy as np
import pytest

from mdr_command import __main__ as command
from mdr_command.__main__ import COMMANDS, main
from mdr_core.profiles import KINDS
from tests.core.comparison import stored

Capture = pytest.CaptureFixture[str]
OPTIONS = ["--kind", "paraboloid", "--radius", "0.01", "--e-star", "1.15e11"]
REQUEST = {
    "profile": {"kind": "paraboloid", "radius": 0.01},
    "material": {"e_star": 1.15e11},
    "load": {"normal_force": 10.0},
}


@pytest.mark.parametrize(("force", "written"), [(10.0, "10"), ([10.0, 20.0, 50.0], "10,20,50")])
def test_options_give_the_bytes_of_the_request(
    force: float | list[float], written: str, tmp_path: Path
) -> None:
    file, by_file, by_options = (tmp_path / name for name in ("request.json", "a", "b"))
    file.write_text(json.dumps(REQUEST | {"load": {"normal_force": force}}), "utf-8")
    assert main(["normal", str(file), "-o", str(by_file)]) == 0
    assert main(["normal", *OPTIONS, "--normal-force", written, "-o", str(by_options)]) == 0
    assert by_file.read_bytes() == by_options.read_bytes()


FORCES = [0.0, 0.0, 1.0, 2.8, 5.2, 8.0, 11.2]
FIT = {
    "profile": {"kind": "paraboloid", "radius": 5e-6},
    "indentation_depth": [round(-1e-8 + 1e-8 * i, 12) for i in range(7)],
    "normal_force": [round(1e-6 * force, 12) for force in FORCES],
    "fit": ["e_star", "contact_point"],
    "segment": "loading",
    "poissons_ratio": 0.4,
}
FIT_OPTIONS = ["--kind", "paraboloid", "--radius", "5e-6", "--fit", "e_star,contact_point"]


@pytest.mark.parametrize(
    ("heading", "units"),
    [("depth [nm];load [µN]\n", []), ("d;F\n", ["--curve-units", "nm,uN"])],
    ids=["units of the headings", "units of the option"],
)
def test_a_curve_in_a_file_gives_the_bytes_of_the_request(
    tmp_path: Path, heading: str, units: list[str]
) -> None:
    file, curve, by_file, by_options = (tmp_path / name for name in ("a.json", "b.csv", "c", "d"))
    file.write_text(json.dumps(FIT), "utf-8")
    rows = "".join(f"{10 * i - 10};{force}\n" for i, force in enumerate(FORCES))
    curve.write_text(heading + rows, "utf-8")
    assert main(["fit", str(file), "-o", str(by_file)]) == 0
    sample = ["--segment", "loading", "--poissons-ratio", "0.4"]
    given = ["fit", str(curve), *FIT_OPTIONS, *sample, *units, "-o", str(by_options)]
    assert main(given) == 0
    assert by_file.read_bytes() == by_options.read_bytes()


@pytest.mark.parametrize(
    ("text", "given", "message"),
    [
        ("d;F\n0;0\n1;1\n2;3\n3;5\n", [], "--curve-units: is required: no heading names"),
        (
            "d;F\n0;0\n1;1\n2;3\n",
            ["--curve-units", "nm"],
            "--curve-units: gives the units of depth",
        ),
        ("d [nm];F [N]\n0;0\nx;1\n2;3\n", [], "Line 3"),
        ("d [nm];F [N]\n0;0\n1;1\n2;3\n", ["--fit", "contact_point"], "--e-star: is needed"),
    ],
)
def test_errors_name_the_curve_or_the_option(
    text: str, given: list[str], message: str, tmp_path: Path, capsys: Capture
) -> None:
    curve = tmp_path / "curve.csv"
    curve.write_text(text, "utf-8")
    assert main(["fit", str(curve), *FIT_OPTIONS[:4], *given]) == 2
    assert message in capsys.readouterr().err


def test_names_of_units_in_a_picture_are_the_units_option(tmp_path: Path, capsys: Capture) -> None:
    curve = tmp_path / "curve.csv"
    curve.write_text("d [nm];F [N]\n0;0\n1;1\n2;3\n", "utf-8")
    given = ["fit", str(curve), *FIT_OPTIONS[:4], "--format", "svg", "--units", "mm"]
    assert main(given) == 2
    assert capsys.readouterr().err.startswith("mdr fit: --units: must be three names")


def test_drift_rate_option_uses_times_of_file(tmp_path: Path) -> None:
    curve, result = tmp_path / "curve.csv", tmp_path / "fit.json"
    rows = "".join(f"{i / 60:.9f};{11 * i - 10};{force}\n" for i, force in enumerate(FORCES))
    curve.write_text("t [min];d [nm];F [µN]\n" + rows, "utf-8")
    options = [*FIT_OPTIONS, "--drift-rate", "1e-9", "--drift-rate-error", "1e-11"]
    assert main(["fit", str(curve), *options, "-o", str(result)]) == 0
    document = json.loads(result.read_text("utf-8"))
    assert document["drift_rate"] == [1e-9]
    assert document["indentation_depth"] == pytest.approx(FIT["indentation_depth"], abs=1e-15)


def test_segments_named_in_the_file_have_priority_over_the_depths(
    tmp_path: Path, capsys: Capture
) -> None:
    curve, result = tmp_path / "curve.csv", tmp_path / "fit.json"
    # In the pause before it withdraws, the depth falls with noise.
    kinds = [*["extend"] * 7, *["pause"] * 3, *["retract"] * 6]
    depths = [*range(-10, 60, 10), 50, 49, 49, *range(40, -20, -10)]
    forces = [*FORCES, 11.0, 10.9, 10.8, *FORCES[5::-1]]
    rows = "".join(f"{a};{d};{f}\n" for a, d, f in zip(kinds, depths, forces, strict=True))
    curve.write_text("Segment;d [nm];F [µN]\n" + rows, "utf-8")
    command = ["fit", str(curve), *FIT_OPTIONS, "-o", str(result), "--segment"]
    assert main([*command, "unloading"]) == 0
    fitted = json.loads(result.read_text("utf-8"))["indentation_depth"]
    expected = [1e-9 * depth for depth in depths[10:]]
    assert fitted == pytest.approx(expected, rel=1e-12, abs=0)
    assert main([*command, "upward"]) == 2
    assert "--segment: must be one of the segments in the file" in capsys.readouterr().err


def test_fit_of_a_separation_reverses_and_reports_its_sign(tmp_path: Path, capsys: Capture) -> None:
    curve, result = tmp_path / "curve.csv", tmp_path / "fit.json"
    rows = "".join(f"{10 - 10 * i};{force}\n" for i, force in enumerate(FORCES))
    curve.write_text("Tip-Sample Separation [nm];Vertical Deflection [µN]\n" + rows, "utf-8")
    assert main(["fit", str(curve), *FIT_OPTIONS, "-o", str(result)]) == 0
    fitted = json.loads(result.read_text("utf-8"))["indentation_depth"]
    expected = [1e-8 * (i - 1) for i in range(len(FORCES))]
    assert fitted == pytest.approx(expected, rel=1e-12, abs=0)
    assert "the separations in the file with their sign reversed" in capsys.readouterr().err


def test_error_of_a_named_segment_counts_the_points_of_the_file(
    tmp_path: Path, capsys: Capture
) -> None:
    curve, table = tmp_path / "curve.csv", tmp_path / "tip.csv"
    rows = [*[f"extend;{d};{d}" for d in range(5)], *[f"retract;{d};{d}" for d in (4, 9, 2, 0)]]
    curve.write_text("\n".join(["Segment;d [nm];F [µN]", *rows]), "utf-8")
    table.write_text(
        "\n".join(["r [nm];f [nm]", *[f"{r};{r * r / 100}" for r in range(9)]]), "utf-8"
    )
    options = ["--table", str(table), "--fit", "force_offset", "--e-star", "1e9"]
    assert main(["fit", str(curve), *options, "--segment", "unloading"]) == 2
    assert capsys.readouterr().err.startswith(f"mdr fit: {curve}: 6: lies beyond the end")


def test_fit_by_options_computes_with_a_layer(tmp_path: Path) -> None:
    curve, result = tmp_path / "curve.csv", tmp_path / "fit.json"
    rows = "".join(f"{10 * i - 10};{force}\n" for i, force in enumerate(FORCES))
    curve.write_text("d [nm];F [µN]\n" + rows, "utf-8")
    layer = ["--layer-thickness", "1e-6", "--layer-base", "bonded", "--poissons-ratio", "0.5"]
    assert main(["fit", str(curve), *FIT_OPTIONS, *layer, "-o", str(result)]) == 0
    given = {"thickness": 1e-6, "base": "bonded"}
    query = tmp_path / "query.json"
    query.write_text(json.dumps(FIT | {"layer": given, "poissons_ratio": 0.5}), "utf-8")
    direct = tmp_path / "direct.json"
    assert main(["fit", str(query), "-o", str(direct)]) == 0
    fitted, expected = (json.loads(each.read_text("utf-8")) for each in (result, direct))
    assert fitted["e_star"] == pytest.approx(expected["e_star"], rel=1e-9, abs=0)


def test_a_fit_by_options_needs_its_curve(capsys: Capture) -> None:
    assert main(["fit", *FIT_OPTIONS]) == 2
    assert "needs the file of its curve" in capsys.readouterr().err


def test_the_suffix_of_the_file_gives_the_format(tmp_path: Path) -> None:
    by_suffix, by_option = tmp_path / "a.csv", tmp_path / "b.out"
    query = ["normal", *OPTIONS, "--normal-force", "10"]
    assert main([*query, "-o", str(by_suffix)]) == 0
    assert main([*query, "--format", "csv", "-o", str(by_option)]) == 0
    assert by_suffix.read_bytes() == by_option.read_bytes()
    assert by_suffix.read_text("utf-8").startswith("indentation_depth,")


@pytest.mark.parametrize(
    ("given", "option"),
    [
        (["--normal-force", "-1"], "--normal-force"),
        (["--normal-force", "-1e-3"], "--normal-force"),
        (["--normal-force", "-.5E+2"], "--normal-force"),
        (["--normal-force", "ten"], "--normal-force"),
        (["--normal-force", "1", "--slope", "1"], "--slope"),
        (["--normal-force", "1", "--normal-force", "2"], "--normal-force"),
        (["--normal-force", "1", "--layer-thickness", "1"], "--layer-base"),
        (["--normal-force", "1", "--layer-base", "glued"], "--layer-base"),
        ([], "--indentation-depth"),
    ],
)
def test_errors_name_the_option(given: list[str], option: str, capsys: Capture) -> None:
    assert main(["normal", *OPTIONS, *given]) == 2
    assert capsys.readouterr().err.startswith(f"mdr normal: {option}: ")


def test_a_response_that_cannot_be_written_is_named(tmp_path: Path, capsys: Capture) -> None:
    target = str(tmp_path / "missing" / "a.json")
    assert main(["normal", *OPTIONS, "--normal-force", "1", "-o", target]) == 4
    assert capsys.readouterr().err == f"mdr normal: {target}: No such file or directory\n"


def test_profiles_lists_every_kind(capsys: Capture) -> None:
    assert main(["profiles"]) == 0
    _, *rows = capsys.readouterr().out.splitlines()
    assert {row.split()[0] for row in rows} == set(KINDS)


@pytest.mark.parametrize("shell", ["bash", "zsh", "tcsh"])
def test_completion_knows_commands_and_options(shell: str, capsys: Capture) -> None:
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert all(name in script for name in COMMANDS)
    assert "friction-coefficient" in script


@pytest.mark.parametrize("name", COMMANDS)
def test_every_help_shows_an_example(name: str, capsys: Capture) -> None:
    with pytest.raises(SystemExit):
        main([name, "--help"])
    shown = f"mdr {name} {COMMANDS[name].example}".rstrip()
    assert f"example:\n  {shown}" in capsys.readouterr().out


@pytest.mark.parametrize(
    "given",
    [
        [name, *shlex.split(one.example)]
        for name, one in COMMANDS.items()
        if "--kind" in one.example
    ],
)
def test_examples_of_options_run(
    given: list[str], tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("curve.csv").write_text("depth [nm],load [µN]\n0,0\n10,1\n20,2.8\n30,5.2\n", "utf-8")
    assert command.main(given) == 0
    assert capsys.readouterr().out


TABLES = Path(__file__).parents[1] / "data" / "tables"
LOAD = ["--e-star", "1.15e11", "--normal-force", "0.5"]


def test_a_table_in_any_unit_is_the_profile_in_metres(tmp_path: Path) -> None:
    request, by_file, by_table = (tmp_path / name for name in ("request.json", "a", "b"))
    points = json.loads((TABLES / "expected.json").read_text("utf-8"))["points"]
    profile = {"kind": "tabulated", **points}
    body = {"profile": profile, "material": {"e_star": 1.15e11}, "load": {"normal_force": 0.5}}
    request.write_text(json.dumps(body), "utf-8")
    assert main(["normal", str(request), "-o", str(by_file)]) == 0
    for file, units in {"tabs.txt": [], "plain.txt": ["--length-unit", "m"]}.items():
        options = ["--table", str(TABLES / file), *units, *LOAD]
        assert main(["normal", *options, "-o", str(by_table)]) == 0
        assert by_table.read_bytes() == by_file.read_bytes()


def test_an_area_function_is_a_profile_in_metres(capsys: Capture) -> None:
    # A = C0 h^2 is a cone, with F = (2/pi) E* d^2 sqrt(C0/pi).
    options = ["--area-coefficients", "24.5", "--largest-height", "300", "--length-unit", "nm"]
    assert main(["normal", *options, "--e-star", "7e10", "--indentation-depth", "1e-7"]) == 0
    force = 2 / math.pi * 7e10 * 1e-14 * math.sqrt(24.5 / math.pi)
    answer = json.loads(capsys.readouterr().out)
    assert answer["normal_force"] == pytest.approx([force], rel=1e-9, abs=0)


@pytest.mark.parametrize(("given", "message"), stored("wrong_options"))
def test_errors_name_the_table_or_the_option(
    given: list[str], message: str, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(TABLES)
    assert main(["normal", *given, *LOAD]) == 2
    assert message in capsys.readouterr().err


def test_an_endless_table_is_refused(capsys: Capture) -> None:
    assert main(["normal", "--table", "/dev/zero", *LOAD]) == 2
    assert "longer than 4000000 bytes" in capsys.readouterr().err


def test_table_of_too_many_points_is_thinned_without_a_change_of_the_fit(
    tmp_path: Path, capsys: Capture
) -> None:
    # A ball of radius 10 mm: F_N = (4/3) E* R^(1/2) d^(3/2).
    file, r = tmp_path / "ball.csv", np.linspace(0, 1e-3, 2600)
    rows = "".join(f"{x:.17g};{x * x / 0.02:.17g}\n" for x in r.tolist())
    file.write_text("r [m];f [m]\n" + rows, "utf-8")
    given = ["--e-star", "1e11", "--normal-force", "100", "--format", "json"]
    assert main(["normal", "--table", str(file), *given]) == 0
    captured = capsys.readouterr()
    assert "2600 points, of which 2000 are used" in captured.err
    (depth,) = json.loads(captured.out)["indentation_depth"]
    expected = (100 / (4 / 3 * 1e11 * 0.1)) ** (2 / 3)
    assert depth == pytest.approx(expected, rel=1e-9, abs=0)
