"""What a sweep is told on the command line, and what it reads and writes."""

import csv
import datetime as dt
import io
import json
import subprocess
import sys
from argparse import ArgumentParser
from decimal import Decimal
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pv
import pyarrow.parquet as pq
import pytest

from mdr_sweep import chunk, command
from mdr_sweep.errors import UsageError
from mdr_sweep.grid import Axis, axis
from mdr_sweep.plan import plan
from mdr_sweep.progress import Lines
from mdr_sweep.requests import flat, nested
from mdr_sweep.study import ANSWERS, Study
from mdr_sweep.tables import Table, regrouped
from mdr_sweep.work import Work
from tests.sweep import running
from tests.sweep.scenes import scenes, swept, table

BALL = {
    "profile": {"kind": "paraboloid", "radius": 0.01},
    "material": {
        "bodies": [{"youngs_modulus": 210e9, "poissons_ratio": 0.3}, "rigid"],
    },
    "load": {"normal_force": "1:10:4"},
}


def told(*options: str) -> int:
    parser = ArgumentParser()
    command.declare(parser)
    return command.run(parser.parse_args(options))


def test_a_request_is_written_flat_and_back() -> None:
    fields = flat(BALL)
    assert fields["material.bodies.0.poissons_ratio"] == 0.3
    assert fields["material.bodies.1"] == "rigid"
    assert nested(fields) == BALL
    listed = {"profile": {"kind": "tabulated", "r": [0.0, 1.0], "f": [0.0, 1.0]}}
    assert nested(flat(listed)) == listed


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
def test_an_axis_has_both_its_ends(text: str, values: list[float]) -> None:
    found = axis("load.normal_force", text).values
    assert found == pytest.approx(values, rel=1e-15)
    assert [found[0], found[-1]] == [values[0], values[-1]]


@pytest.mark.parametrize(
    "text", ["1:10", "1:10:0", "1:10:x", "0:10:5:log", "1:inf:5", "1:2:1", "1:2:3:cubic", "a:2:3"]
)
def test_what_is_no_axis_is_refused(text: str) -> None:
    with pytest.raises(UsageError):
        axis("load.normal_force", text)


def test_a_grid_is_the_table_of_its_scenes(tmp_path: Path) -> None:
    (tmp_path / "ball.json").write_text(json.dumps(BALL))
    grid = ("--grid", "profile.radius=1e-3:1e-1:3:log")
    options = ("normal", "--template", "ball.json", *grid, "--workers", "1", "--chunk", "5")
    status, said = running.swept(tmp_path, *options, "--out", "answers.parquet")
    assert status == 0, said
    found = pq.read_table(tmp_path / "answers.parquet")
    force = Axis(1.0, 10.0, 4).values.repeat(3)
    radius = np.tile(Axis(1e-3, 1e-1, 3, logarithmic=True).values, 4)
    assert found["load.normal_force"].to_pylist() == force.tolist()
    assert found["profile.radius"].to_pylist() == radius.tolist()
    constants = {k: v for k, v in flat(BALL).items() if not k.startswith("load.")}
    rows = [
        {**constants, "profile.radius": R, "load.normal_force": F}
        for R, F in zip(radius.tolist(), force.tolist(), strict=True)
    ]
    expected = swept("normal", rows)
    assert found.select([*ANSWERS["normal"], "warning", "error"]).to_pylist() == expected


def test_text_in_and_text_out_is_the_same(tmp_path: Path) -> None:
    rows = scenes("cone", "tangential", 30) + scenes("sphere", "tangential", 30)
    rows[7]["profile.slope"] = None
    given = pa.Table.from_batches([table(rows)])
    label = pa.array([f"no. {i}" for i in range(60)])
    pv.write_csv(given.append_column("label", label), tmp_path / "scenes.csv")
    text = (tmp_path / "scenes.csv").read_text().splitlines()
    column = text[0].split(",").index('"material.e_star"')
    cells = text[3].split(",")
    cells[column] = "stiff"
    text[3] = ",".join(cells)
    (tmp_path / "scenes.csv").write_text("\n".join(text) + "\n")
    for row in rows:
        row["material.e_star"] = repr(row["material.e_star"])
    rows[2]["material.e_star"] = "stiff"

    options = ("tangential", "--table", "scenes.csv", "--keep", "label", "--workers", "1")
    status, said = running.swept(tmp_path, *options, "--out", "answers.csv")
    assert status == 0, said
    with (tmp_path / "answers.csv").open(newline="") as file:
        found = list(csv.DictReader(file))
    for i, (row, expected) in enumerate(zip(found, swept("tangential", rows), strict=True)):
        assert row["label"] == f"no. {i}"
        for name, value in expected.items():
            if isinstance(value, float):
                assert float(row[name]) == value, name
            else:
                assert row[name] == (value or ""), name
    assert found[2]["material.e_star"] == ""
    assert found[2]["error"].startswith("/material/e_star ")


def test_a_plan_computes_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ball.json").write_text(json.dumps(BALL))
    grid = ("--grid", "profile.radius=1e-3:1:1000000:log")
    assert told("normal", "--template", "ball.json", *grid, "--out", "a.csv", "--plan") == 0
    said = capsys.readouterr().out
    assert "4,000,000" in said
    assert "MiB" in said
    assert [path.name for path in tmp_path.iterdir()] == ["ball.json"]


def test_dearer_scenes_come_in_smaller_chunks() -> None:
    sizes = [
        plan(Study(query, {}, ANSWERS[query]), [kind], 10**6, 20, 2).chunk
        for query, kind in (
            ("tangential", "paraboloid"),
            ("tangential", "rounded_punch"),
            ("wear", "paraboloid"),
            ("wear", "capped_paraboloid"),
        )
    ]
    assert sizes == sorted(sizes, reverse=True)
    assert len(set(sizes)) == len(sizes)


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (("--out", "a.parquet"), "either --table"),
        (("--grid", "load.normal_force=1:2:3", "--out", "a.xlsx"), "a.xlsx"),
        (("--grid", "load.normal_force", "--out", "a.csv"), "START:STOP:N"),
        (("--grid", "load=1:2:3", "--template", "t.json", "--out", "a.csv"), "at once"),
        (("--grid", "load.normal_force=1:2:3", "--answers", "colour", "--out", "a.csv"), "colour"),
        (("--grid", "load.normal_force=1:2:3", "--keep", "id", "--out", "a.csv"), "no column id"),
        (("--table", "none.parquet", "--out", "a.csv"), "cannot be read"),
        (("--grid", "load.normal_force=1:2:3", "--out", "there.csv"), "--overwrite"),
        (("--grid", "load.normal_force=1:2:3", "--chunk", "0", "--out", "a.csv"), "--chunk"),
    ],
)
def test_what_makes_no_sense_is_said_at_once(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    options: tuple[str, ...],
    complaint: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("t.json").write_text('{"load": {"indentation_depth": 1e-6}}')
    Path("there.csv").touch()
    assert told("normal", *options) == 2
    assert complaint in capsys.readouterr().err


def test_the_work_of_another_sweep_is_not_taken_for_ones_own(tmp_path: Path) -> None:
    work = Work(tmp_path / "answers.parquet")
    batch = pa.record_batch({"x": [1.0]})
    with work.opened({"chunk": 1}, restart=False) as done:
        assert done == set()
        work.put(3, batch)
        with pytest.raises(UsageError, match="another process"), work.opened({}, restart=False):
            pass
    (work.folder / "000000004.arrow.unfinished").touch()
    with work.opened({"chunk": 1}, restart=False) as done:
        assert done == {3}
    assert not list(work.folder.glob("*.unfinished"))
    with (
        pytest.raises(UsageError, match="--restart"),
        work.opened({"chunk": 2}, restart=False),
    ):
        pass
    with work.opened({"chunk": 2}, restart=True) as done:
        assert done == set()
        work.put(5, batch)
    (work.folder / "manifest.json").unlink()
    with work.opened({"chunk": 2}, restart=False) as done:
        assert done == set()


def test_what_is_no_number_in_a_table_is_told_by_its_row() -> None:
    day = dt.date(1882, 1, 1)
    rows = [{"profile.kind": "cone", "profile.slope": slope} for slope in (0.1, 0.2)]
    for column, valid in (
        (pa.array([day, day]), False),
        (pa.array([True, False]), False),
        (pa.array([[1.0], []]), False),
        (pa.array([Decimal("1e9"), Decimal("2e9")]), True),
        (pa.array([1, 2], pa.int64()), True),
    ):
        batch = table(rows).append_column("material.e_star", column)
        batch = batch.append_column("load.normal_force", pa.array([1.0, 2.0]))
        study = Study("normal", {}, ("contact_radius",))
        for row in chunk.answer(study, batch).to_pylist():
            assert (row["error"] is None) == valid
            assert valid or row["error"].startswith("/material/e_star")


def test_batches_of_any_size_hold_the_same_rows(tmp_path: Path) -> None:
    values = np.arange(1000.0)
    pq.write_table(pa.table({"x": values}), tmp_path / "t.parquet", row_group_size=77)
    for size in (1, 64, 1000, 4096):
        found = list(Table(tmp_path / "t.parquet").batches(size, {1}))
        assert [index for index, _ in found] == [i for i in range(-(-1000 // size)) if i != 1]
        assert all(batch.num_rows <= size for _, batch in found)
    whole = pa.Table.from_batches(regrouped(pa.table({"x": values}).to_batches(7), 300))
    assert whole["x"].to_pylist() == values.tolist()


def test_progress_is_told_in_lines_where_there_is_no_terminal() -> None:
    stream = io.StringIO()
    with Lines(stream, 2000, 500) as progress:
        progress.done(1000)
    assert stream.getvalue().startswith("1,500 of 2,000 scenes, ")
    assert " s left" in stream.getvalue()


def test_neither_core_nor_service_loads_what_sweeps_need() -> None:
    code = (
        "import sys, mdr_service.app, mdr_command.__main__;"
        "sys.exit(bool({'dask', 'distributed', 'pyarrow', 'tqdm'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
