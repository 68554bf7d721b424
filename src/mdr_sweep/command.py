"""``mdr sweep``: the answers to every scene of a table or a grid, in a table."""

import argparse
import json
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Any, Final

from distributed import Client

from mdr_sweep import engine
from mdr_sweep.errors import SweepError, UsageError
from mdr_sweep.grid import Axis, Grid, axis, is_axis
from mdr_sweep.plan import Plan, plan
from mdr_sweep.progress import progress
from mdr_sweep.requests import clash, flat
from mdr_sweep.study import ANSWERS, LARGEST, Study, versions
from mdr_sweep.tables import SUFFIXES, Source, Table, joined, write
from mdr_sweep.work import Work

_FAILED: Final = 1
_WRONG: Final = 2
_KIND: Final = "profile.kind"


def declare(parser: argparse.ArgumentParser) -> None:
    """Take what to sweep over, what to ask, and where to put the answers."""
    add = parser.add_argument
    add("query", choices=sorted(ANSWERS), help="what is asked of every scene")
    add("--table", type=Path, help="scenes, one a row: .parquet or .csv, columns like load.radius")
    add("--template", type=Path, help="constants of all scenes: a request in JSON")
    add(
        "--grid",
        action="append",
        default=[],
        metavar="FIELD=START:STOP:N[:log]",
        help="an axis of a grid of scenes; the last one runs fastest",
    )
    add("--answers", default="", help="which answers, separated by commas (all)")
    add("--keep", default="", help="columns of the table that are copied and not read")
    add("--out", type=Path, required=True, help="the result: .parquet or .csv")
    add("--overwrite", action="store_true", help="replace a result that is there")
    add("--restart", action="store_true", help="forget what another sweep has left")
    add("--scheduler", metavar="ADDRESS", help="a Dask scheduler, like tcp://host:8786")
    add("--workers", type=int, default=_cores(), help="processes on this machine (%(default)s)")
    add("--chunk", type=int, help="scenes in a chunk (by what they cost)")
    add("--plan", action="store_true", help="print what it would cost, and compute nothing")


def run(arguments: argparse.Namespace) -> int:
    """Sweep, or go on where an earlier run was ended."""
    try:
        return _run(arguments)
    except UsageError as error:
        return _say(error, _WRONG)
    except SweepError as error:
        return _say(error, _FAILED)
    except OSError as error:
        return _say(f"{error}; what is done is kept: run the same again to go on", _FAILED)


def _say(what: object, status: int) -> int:
    sys.stderr.write(f"mdr sweep: {what}\n")
    return status


def _run(arguments: argparse.Namespace) -> int:
    study, source = _asked(arguments)
    _check_target(arguments)
    estimate = _estimate(arguments, study, source)
    if arguments.plan:
        sys.stdout.write("".join(f"{line}\n" for line in estimate.lines))
        return 0
    with _client(arguments) as client:
        sweep(client, study, source, estimate, Work(arguments.out), restart=arguments.restart)
    return 0


def sweep(
    client: Client, study: Study, source: Source, cut: Plan, work: Work, *, restart: bool = False
) -> None:
    """Answer every scene of the source, but for those that are answered, and write the result."""
    manifest = {
        "query": study.query,
        "constants": study.constants,
        "answers": study.answers,
        "kept": study.kept,
        "versions": study.versions,
        "input": source.identity,
        "scenes": source.rows,
        "chunk": cut.chunk,
        "form": work.target.suffix,
    }
    with work.opened(manifest, restart=restart) as done:
        before = min(len(done) * cut.chunk, source.rows)
        with progress(sys.stderr, source.rows, before) as told:
            batches = source.batches(cut.chunk, done)
            for index, batch, answers in engine.answered(client, study, batches):
                work.put(index, joined(batch, answers, study.kept))
                told.done(batch.num_rows)
        rows = work.chunks(cut.chunks)
        first = next(rows)
        with work.result() as path:
            write(path, work.target, first.schema, chain([first], rows))


def _asked(arguments: argparse.Namespace) -> tuple[Study, Source]:
    """Return what is asked, and of which scenes."""
    constants = _template(arguments.template)
    axes = {name: axis(name, text) for name, text in constants.items() if is_axis(text)}
    constants = {name: value for name, value in constants.items() if name not in axes}
    axes |= dict(_axis(text) for text in arguments.grid)
    kept = _names(arguments.keep)
    if bool(axes) == bool(arguments.table):
        raise UsageError("either --table, or axes by --grid or in the template, are needed")
    source: Source = Grid(axes) if axes else Table(arguments.table)
    names = source.schema.names
    strange = set(kept) - set(names)
    if strange:
        raise UsageError(f"--keep: there is no column {min(strange)}")
    if twice := set(names) & {*_known(arguments.query), "warning", "error"}:
        raise UsageError(f"an input cannot be called {min(twice)}: that is an answer")
    if source.rows == 0:
        raise UsageError("there are no scenes")
    fields = {*constants, *names} - set(kept)
    if inside := clash(fields):
        raise UsageError(f"{inside} is a field and a part of the request at once")
    constants = {name: value for name, value in constants.items() if name not in names}
    answers = _answers(arguments.query, _names(arguments.answers))
    return Study(arguments.query, constants, answers, kept, versions()), source


def _answers(query: str, wanted: Sequence[str]) -> tuple[str, ...]:
    known = _known(query)
    strange = set(wanted) - set(known)
    if strange:
        told = ", ".join(known)
        raise UsageError(f"--answers: there is no {min(strange)}; {query} answers {told}")
    return tuple(name for name in known if name in (wanted or ANSWERS[query]))


def _known(query: str) -> tuple[str, ...]:
    return (*ANSWERS[query], *LARGEST[query])


def _template(path: Path | None) -> dict[str, Any]:
    if path is None:
        return {}
    try:
        request = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise UsageError(f"{path} cannot be read: {error}") from None
    if not isinstance(request, Mapping):
        raise UsageError(f"{path} holds no request")
    return flat(request)


def _axis(text: str) -> tuple[str, Axis]:
    name, sign, values = text.partition("=")
    if not sign:
        raise UsageError(f"--grid: {text!r} is no FIELD=START:STOP:N")
    return name, axis(name, values)


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(",") if name.strip())


def _check_target(arguments: argparse.Namespace) -> None:
    target: Path = arguments.out
    if target.suffix not in SUFFIXES:
        raise UsageError(f"--out: {target} ends in neither of {', '.join(SUFFIXES)}")
    begun = Work(target).folder.exists()
    if target.exists() and not (arguments.overwrite or begun or arguments.plan):
        raise UsageError(f"{target} is there already: --overwrite replaces it")


def _estimate(arguments: argparse.Namespace, study: Study, source: Source) -> Plan:
    kinds = source.kinds(_KIND) or [str(study.constants.get(_KIND))]
    columns = len(source.schema.names) + len(study.answers)
    found = plan(study, kinds, source.rows, columns, max(arguments.workers, 1))
    if arguments.chunk is None:
        return found
    if arguments.chunk < 1:
        raise UsageError("--chunk: at least one scene is needed")
    return replace(found, chunk=arguments.chunk)


@contextmanager
def _client(arguments: argparse.Namespace) -> Iterator[Client]:
    with (
        engine.remote(arguments.scheduler)
        if arguments.scheduler
        else engine.local(max(arguments.workers, 1))
    ) as client:
        yield client


def _cores() -> int:
    return len(os.sched_getaffinity(0))
