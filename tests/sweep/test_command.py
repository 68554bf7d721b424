"""`mdr sweep` reads valid arguments and input, and writes the output that they describe."""

import csv
import datetime as dt
import json
import subprocess
import sys
from argparse import ArgumentParser
from decimal import Decimal
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as pv
import pyarrow.parquet as pq
import pytest

from mdr_core.errors import InputError
from mdr_service.schemas.flat import flat, nested
from mdr_sweep import command, resources, vectorized
from mdr_sweep.checkpoint import Checkpoint
from mdr_sweep.request_columns import field
from mdr_sweep.spec import QUANTITIES, Spec, UsageError
from mdr_sweep.sweep import summary
from mdr_sweep.tables import Grid, Table, axis, regrouped
from tests.core.comparison import stored
from tests.sweep.cases import random_cases, swept, table

BALL: dict[str, Any] = {
    "profile": {"kind": "paraboloid", "radius": 0.01},
    "material": {
        "bodies": [{"youngs_modulus": 210e9, "poissons_ratio": 0.3}, "rigid"],
    },
    "load": {"normal_force": "1:10:4"},
}
HERTZ = {
    "profile.kind": "paraboloid",
    "profile.radius": 0.01,
    "material.e_star": 1e11,
    "load.normal_force": 1.0,
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("ball.json").write_text(json.dumps(BALL))
    return tmp_path


def run(*options: str) -> int:
    parser = ArgumentParser()
    command.declare(parser)
    return command.run(parser.parse_args(options))


def write(path: str, columns: dict[str, Any]) -> None:
    pq.write_table(pa.table(columns), path)


def test_nested_inverts_flat() -> None:
    fields = flat(BALL)
    assert fields["material.bodies.0.poissons_ratio"] == 0.3
    assert fields["material.bodies.1"] == "rigid"
    assert nested(fields) == BALL
    listed = {"profile": {"kind": "tabulated", "r": [0.0, 1.0, 2.0], "f": [0.0, 1.0, 4.0]}}
    assert nested(flat(listed)) == listed


@pytest.mark.parametrize(
    ("names", "path"),
    [
        (["profile.terms.100000000.exponent"], ("profile", "terms")),
        (["profile.terms.0.exponent", "profile.terms.2.exponent"], ("profile", "terms")),
        (["profile.terms.00.exponent"], ("profile", "terms")),
        (["load", "load.normal_force"], ("load", "normal_force")),
        (["load.normal_force", "load"], ("load",)),
    ],
)
def test_names_that_make_no_request_are_rejected(names: list[str], path: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as error:
        nested(dict.fromkeys(names, 1.0))
    assert error.value.path == path


def test_fields_have_the_types_of_the_request_models() -> None:
    names = {
        "profile.kind": "string",
        "profile.r": "array",
        "profile.terms.12.exponent": "number",
        "material.bodies.1": "string",
        "material.bodies.0.youngs_modulus": "number",
        "load.normal_force": "number",
    }
    result = {name: field("tangential", name) for name in names}
    assert {name: each and each["type"] for name, each in result.items()} == names
    unknown = ("profile.colour", "profile.terms.x.exponent", "profile.terms.01.exponent", "load")
    assert not [
        name
        for name in (*unknown, "load.friction_coefficient")
        if field("tangential", name) is not None
    ]
    assert not [name for name in ("radius", "points", "quantities") if field("wear", name)]


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("1:10:4", [1.0, 4.0, 7.0, 10.0]),
        ("1:10:4:lin", [1.0, 4.0, 7.0, 10.0]),
        ("1e-3:1:4:log", [1e-3, 1e-2, 1e-1, 1.0]),
        ("-1:1:3", [-1.0, 0.0, 1.0]),
        ("5:5:1", [5.0]),
    ],
)
def test_axis_includes_both_ends(text: str, values: list[float]) -> None:
    result = axis("load.normal_force", text)
    assert result == pytest.approx(values, rel=1e-15, abs=0)
    assert [result[0], result[-1]] == [values[0], values[-1]]


@pytest.mark.parametrize(
    "text",
    [
        *("1:10", "1:10:0", "1:10:x", "0:10:5:log", "1:inf:5", "1:2:1", "1:2:3:cubic", "a:2:3"),
        *("1:2:3:log:log", "1:2:3:"),
    ],
)
def test_invalid_axis_is_rejected(text: str) -> None:
    with pytest.raises(UsageError, match="load"):
        axis("load.normal_force", text)


def test_grid_equals_the_table_of_its_cases(folder: Path) -> None:
    grid = ("--grid", "profile.radius=1e-3:1e-1:3:log")
    options = ("normal", "--template", "ball.json", *grid, "--chunk", "5")
    assert run(*options, "--out", "result.parquet") == 0
    result = pq.read_table(folder / "result.parquet")
    force = axis("", "1:10:4").repeat(3)
    radius = np.tile(axis("", "1e-3:1e-1:3:log"), 4)
    assert result["load.normal_force"].to_pylist() == force.tolist()
    assert result["profile.radius"].to_pylist() == radius.tolist()
    constants = {k: v for k, v in flat(BALL).items() if not k.startswith("load.")}
    rows = [
        {**constants, "profile.radius": R, "load.normal_force": F}
        for R, F in zip(radius.tolist(), force.tolist(), strict=True)
    ]
    expected = swept("normal", rows)
    assert result.select([*QUANTITIES["normal"], "warning", "error"]).to_pylist() == expected


def test_csv_gives_the_same_numbers_as_parquet_and_keeps_unreadable_text(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = random_cases("cone", "tangential", 30) + random_cases("sphere", "tangential", 30)
    rows[7]["profile.slope"] = None
    given = pa.Table.from_batches([table(rows)])
    label = pa.array([f"no. {i}" for i in range(60)])
    pv.write_csv(given.append_column("label", label), "cases.csv")
    text = Path("cases.csv").read_text().splitlines()
    column = text[0].split(",").index('"material.e_star"')
    for row, cell in ((2, "stiff"), (4, "[1e9]"), (5, "1_000"), (6, " 1e9 ")):
        cells = text[row + 1].split(",")
        cells[column] = cell
        text[row + 1] = ",".join(cells)
        rows[row]["material.e_star"] = cell
    Path("cases.csv").write_text("\n".join(text) + "\n")
    for row in rows:
        row["material.e_star"] = str(row["material.e_star"])

    options = ("tangential", "--table", "cases.csv", "--keep", "label")
    assert run(*options, "--out", "result.csv") == 0
    with Path("result.csv").open(newline="") as file:
        result = list(csv.DictReader(file))
    for i, (row, expected) in enumerate(zip(result, swept("tangential", rows), strict=True)):
        assert row["label"] == f"no. {i}"
        for name, value in expected.items():
            if isinstance(value, float):
                assert float(row[name]) == value, name
            else:
                assert row[name] == (value or ""), name
    for row in (2, 4, 5):
        assert result[row]["material.e_star"] == ""
        assert result[row]["error"].startswith("/material/e_star ")
        assert result[row]["error"].endswith(f"; read '{rows[row]['material.e_star']}'")
    # All of them have one reason.
    assert "  3  /material/e_star " in capsys.readouterr().err
    assert float(result[6]["material.e_star"]) == 1e9


@pytest.mark.long
@pytest.mark.usefixtures("folder")
def test_result_is_independent_of_chunks_and_processes() -> None:
    write(
        "cases.parquet",
        pa.Table.from_batches(
            [table(random_cases("rounded_punch", "tangential", 120))]
        ).to_pydict(),
    )
    for number, options in enumerate((["--chunk", "7"], ["--chunk", "50", "--workers", "2"], [])):
        out = f"result{number}.parquet"
        assert run("tangential", "--table", "cases.parquet", "--out", out, *options) == 0
    first, *others = (Path(f"result{number}.parquet").read_bytes() for number in range(3))
    assert others == [first, first]


def test_plan_estimates_without_computing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    grid = ("--grid", "profile.radius=1e-3:1:1000000:log")
    assert run("normal", "--template", "ball.json", *grid, "--out", "a.csv", "--plan") == 0
    text = capsys.readouterr().out
    assert "4,000,000" in text
    assert "MiB" in text
    assert [path.name for path in folder.iterdir()] == ["ball.json"]
    spec = Spec("wear", {}, QUANTITIES["wear"])
    write(
        "cases.parquet",
        table(random_cases("cone", "wear", 20)).to_pydict(),
    )
    alone, two = (resources.estimate(spec, Table(Path("cases.parquet")), n) for n in (1, 2))
    assert (alone.processes, two.processes) == (1, 2)
    # Twenty cases take a fraction of a second, so the estimate is dominated by the start of the
    # workers.
    assert alone.seconds < resources.START_SECONDS < two.seconds
    assert resources.estimate(spec, Table(Path("cases.parquet")), None).processes == 1


def test_expensive_cases_have_small_chunks() -> None:
    constants = {name: value for name, value in HERTZ.items() if name != "load.normal_force"}
    wear = {"material.g_star": 8e10, "friction_coefficient": 0.3}
    wear |= {"oscillation.tangential_displacement": 1e-8}
    grid = Grid({"load.normal_force": "1:10:100000"})
    cheap = resources.estimate(Spec("normal", constants, QUANTITIES["normal"]), grid, None)
    expensive = resources.estimate(Spec("wear", constants | wear, QUANTITIES["wear"]), grid, None)
    assert cheap.chunk > 10 * expensive.chunk
    assert expensive.seconds > 10 * cheap.seconds


@pytest.mark.parametrize(("options", "message"), stored("wrong_sweeps"))
@pytest.mark.usefixtures("folder")
def test_invalid_sweep_is_rejected_at_once(
    capsys: pytest.CaptureFixture[str], options: tuple[str, ...], message: str
) -> None:
    Path("unknown.json").write_text('{"load": {"pressure": 1}, "friction_coefficient": 0.3}')
    Path("list.json").write_text('{"load": {"normal_force": [1, 2]}}')
    Path("there.csv").touch()
    Path("latin.csv").write_text("load.normal_force\ncaf\xe9\n", "latin-1")
    Path("twice.csv").write_text("load.normal_force,load.normal_force\n1,2\n")
    pq.write_table(pa.table([[1.0], [2.0]], ["load.normal_force"] * 2), "twice.parquet")
    Path("folder.csv").mkdir()
    write("unknown.parquet", {"name": ["a"], "load.farce": [1.0], "load.normal_force": [1.0]})
    write("result.parquet", {"contact_radius": [1.0]})
    write("gap.parquet", {"profile.terms.100000000.exponent": [2.0]})
    write("list.parquet", {"load.normal_force": [[1.0]]})
    write("day.parquet", {"load.normal_force": [dt.date(1882, 1, 1)]})
    write("flag.parquet", {"load.normal_force": [True]})
    assert run("normal", *options) == 2
    assert message in capsys.readouterr().err
    assert not Path("a.csv").exists()
    assert not list(Path().glob("*.work"))


def test_empty_cells_of_a_term_below_another_are_an_error_of_their_case() -> None:
    constants = {"profile.kind": "series", "material.e_star": 1e11, "load.normal_force": 1.0}
    columns: dict[str, list[float | None]] = {
        "profile.terms.0.coefficient": [None, 1.0],
        "profile.terms.0.exponent": [None, 2.0],
        "profile.terms.1.coefficient": [1.0, None],
        "profile.terms.1.exponent": [2.0, None],
    }
    spec = Spec("normal", constants, ("contact_radius",))
    gap, whole = vectorized.solve(spec, pa.record_batch(columns)).to_pylist()
    assert gap["contact_radius"] is None
    assert gap["error"].startswith("/profile/terms the indices of a list start at 0")
    assert whole["error"] is None


@pytest.mark.parametrize(
    "column",
    [
        pa.array([Decimal("1e11"), Decimal("2e11")]),
        pa.array([10**11, 2 * 10**11], pa.int64()),
        pa.array(["1e11", "2e11"]).dictionary_encode(),
        pa.array(["1e11", "2e11"], pa.large_string()),
    ],
)
def test_numbers_of_every_column_type_are_read(column: "pa.Array[Any]") -> None:
    constants = {name: value for name, value in HERTZ.items() if name != "material.e_star"}
    spec = Spec("normal", constants, ("contact_radius",))
    result = vectorized.solve(spec, pa.record_batch({"material.e_star": column})).to_pylist()
    rows = [HERTZ | {"material.e_star": e_star} for e_star in (1e11, 2e11)]
    expected = [row["contact_radius"] for row in swept("normal", rows)]
    assert [row["contact_radius"] for row in result] == expected
    assert None not in expected


@pytest.mark.usefixtures("folder")
def test_summary_counts_failed_cases_by_reason(capsys: pytest.CaptureFixture[str]) -> None:
    force = [1.0] * 6 + [-1.0, -2.0, None, 5.0]
    radius = [0.01] * 9 + [-3.0]
    columns = {"load.normal_force": force, "profile.radius": radius, "profile.kind": ["paraboloid"]}
    write("cases.parquet", columns | {"profile.kind": ["paraboloid"] * 10})
    Path("t.json").write_text('{"material": {"e_star": 1e11}}')
    options = ("normal", "--table", "cases.parquet", "--template", "t.json", "--chunk", "4")
    assert run(*options, "--out", "a.csv") == 0
    summary = capsys.readouterr().err.splitlines()[-4:]
    assert summary[0] == "10 cases: 6 solved, 4 failed"
    assert summary[1].split()[:2] == ["2", "/load/normal_force"]
    assert summary[1].endswith("(first in row 7)")
    assert {line.split()[1] for line in summary[2:]} == {"/load", "/profile/radius"}

    columns = {"profile.radius": [-1.0, -2.0], "profile.kind": ["paraboloid"] * 2}
    write("wrong.parquet", columns | {"load.normal_force": [1.0, 2.0]})
    options = ("normal", "--table", "wrong.parquet", "--template", "t.json")
    assert run(*options, "--out", "b.csv") == 3
    assert "2 cases: 0 solved, 2 failed" in capsys.readouterr().err
    assert Path("b.csv").read_text().count("/profile/radius") == 2


def test_summary_merges_and_limits_the_reasons() -> None:
    errors = [
        f"/load/{letter} above {i}.5e{i}" for letter in "abcdefghijklmnopqrstuv" for i in range(3)
    ]
    failed, lines = summary([pa.record_batch({"error": [*errors, None]})])
    assert failed == 66
    assert lines[0] == "67 cases: 1 solved, 66 failed"
    assert lines[1].split()[0] == "3"
    assert len(lines) == 22
    assert lines[-1] == "and 2 more reasons; see the column error"


def test_symbolic_link_is_followed(folder: Path) -> None:
    (folder / "elsewhere").mkdir()
    target = folder / "elsewhere" / "data"
    (folder / "result.parquet").symlink_to(target)
    options = ("normal", "--template", "ball.json", "--out", "result.parquet")
    assert run(*options) == 0
    assert (folder / "result.parquet").is_symlink()
    first = target.read_bytes()
    assert first[:4] == b"PAR1"
    target.write_text("old")
    assert run(*options) == 2
    assert target.read_text() == "old"
    assert run(*options, "--overwrite") == 0
    assert (folder / "result.parquet").is_symlink()
    assert target.read_bytes() == first
    assert [path.name for path in (folder / "elsewhere").iterdir()] == ["data"]


@pytest.mark.usefixtures("folder")
def test_parquet_metadata_records_the_provenance() -> None:
    assert run("normal", "--template", "ball.json", "--out", "a.parquet") == 0
    metadata = pq.read_metadata("a.parquet").metadata
    result = json.loads(metadata[b"mdr"])
    assert result["query"] == "normal"
    assert result["constants"] == {k: v for k, v in flat(BALL).items() if not k.startswith("load")}
    assert result["input"] == {"load.normal_force": "1:10:4"}
    assert result["versions"].keys() == {"mdr", "numpy", "scipy", "pyarrow"}
    assert "consistent system" in result["units"]


def test_checkpoint_of_another_sweep_is_rejected(tmp_path: Path) -> None:
    checkpoint = Checkpoint(tmp_path / "result.parquet")
    batch = pa.record_batch({"x": [1.0]})
    with checkpoint.opened({"chunk": 1}, restart=False) as done:
        assert done == set()
        checkpoint.put(3, batch)
        with (
            pytest.raises(UsageError, match="another process"),
            checkpoint.opened({}, restart=False),
        ):
            pass
    (checkpoint.folder / "000000000004.arrow.unfinished").touch()
    assert checkpoint.manifest == {"chunk": 1}
    with checkpoint.opened({"chunk": 1}, restart=False) as done:
        assert done == {3}
    assert not list(checkpoint.folder.glob("*.unfinished"))
    with (
        pytest.raises(UsageError, match="--restart"),
        checkpoint.opened({"chunk": 2}, restart=False),
    ):
        pass
    with checkpoint.opened({"chunk": 2}, restart=True) as done:
        assert done == set()
        checkpoint.put(5, batch)
    (checkpoint.folder / "manifest.json").unlink()
    with checkpoint.opened({"chunk": 2}, restart=False) as done:
        assert done == set()


def test_rows_are_independent_of_the_batch_size(tmp_path: Path) -> None:
    values = np.arange(1000.0)
    pq.write_table(pa.table({"x": values}), tmp_path / "t.parquet", row_group_size=77)
    source = Table(tmp_path / "t.parquet")
    for size in (1, 64, 1000, 4096):
        count = -(-1000 // size)
        parts = [batch["x"].to_pylist() for batch in source.batches(size, range(count))]
        assert max(map(len, parts)) <= size
        assert [*chain.from_iterable(parts)] == values.tolist()
        assert [batch["x"].to_pylist() for batch in source.batches(size, {count - 1})] == parts[-1:]
    whole = pa.Table.from_batches(regrouped(pa.table({"x": values}).to_batches(7), 300))
    assert whole["x"].to_pylist() == values.tolist()


@pytest.mark.long
def test_service_and_command_line_import_neither_matplotlib_nor_sweep_packages() -> None:
    code = (
        "import sys, mdr_service.app, mdr_command.__main__; mdr_service.app.create_app();"
        "names = {'matplotlib', 'dask', 'distributed', 'pyarrow', 'tqdm'};"
        "sys.exit(bool(names & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


WITHOUT = """
import sys
for name in ("dask", "distributed", "pyarrow", "tqdm"):
    sys.modules[name] = None
from mdr_command.__main__ import main
sys.exit(main(sys.argv[1:]))
"""


def without_packages(*options: str) -> "subprocess.CompletedProcess[str]":
    command = [sys.executable, "-c", WITHOUT, "sweep", *options]
    return subprocess.run(command, check=False, capture_output=True, text=True)


@pytest.mark.long
def test_help_needs_no_sweep_packages() -> None:
    done = without_packages("--help")
    assert done.returncode == 0
    assert "--template" in done.stdout
    assert "mdr[" not in done.stdout


@pytest.mark.long
def test_missing_package_is_reported_with_the_install_command() -> None:
    done = without_packages("normal", "--grid", "load.normal_force=1:2:3", "--out", "a.csv")
    assert done.returncode == 1
    assert "`pip install '.[sweep]'` in the checkout" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.long
def test_local_sweep_does_not_import_dask() -> None:
    code = (
        "import sys, mdr_sweep.sweep, mdr_sweep.scheduler;"
        "sys.exit(bool({'dask', 'distributed'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
