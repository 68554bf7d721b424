"""Run of a sweep: its specification, chunks and result."""

import json
import re
import sys
from argparse import Namespace
from collections.abc import Iterable, Mapping
from contextlib import closing
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import numpy as np
import pyarrow as pa
from tqdm import tqdm

from mdr_core.errors import InputError
from mdr_service.problems import MAX_ERRORS
from mdr_service.schemas.flat import flat, nested
from mdr_sweep import resources, scheduler, vectorized
from mdr_sweep.checkpoint import Checkpoint
from mdr_sweep.request_columns import field, fits
from mdr_sweep.spec import (
    ERROR,
    ONLY_IF_NAMED,
    QUANTITIES,
    WARNING,
    Spec,
    SweepStatus,
    UsageError,
    versions,
)
from mdr_sweep.tables import SUFFIXES, Grid, Source, Table, write

# Interval of progress reports into a log [s].
_LOG_SECONDS: Final = 30.0
_UNITS: Final = "the consistent system of the input: with m and N, pressures are in Pa"
# Texts of cells and numbers in an error message, which vary between cases; indices in a JSON
# pointer follow a slash.
_VARIES: Final = re.compile(r"""(?<!\w)(['"]).*?\1|(?<![\w/.])[-+]?[0-9][\w.+-]*""")


def run(arguments: Namespace) -> int:
    """Run or resume a sweep and return the exit status; raise SweepError if it cannot continue."""
    spec, source = specified(arguments)
    checkpoint = Checkpoint(arguments.out)
    _check_target(arguments, checkpoint)
    estimate = resources.estimate(spec, source, arguments.workers)
    if arguments.plan:
        sys.stdout.write(str(estimate))
        return SweepStatus.DONE
    known = {} if arguments.restart else checkpoint.manifest
    chunk = arguments.chunk or known.get("chunk") or estimate.chunk
    # The manifest contains everything on which the numbers of the result depend.
    identity = asdict(spec) | {"input": source.identity, "versions": versions()}
    manifest = identity | {"chunk": chunk, "format": arguments.out.suffix}
    with checkpoint.opened(manifest, restart=arguments.restart) as done:
        count = -(-source.rows // chunk)
        missing = [index for index in range(count) if index not in done]
        chunks = zip(missing, source.batches(chunk, missing), strict=True)
        if arguments.scheduler or estimate.processes > 1:
            workers = arguments.scheduler, estimate.processes
            solved = scheduler.in_workers(spec, chunks, *workers)
        else:
            solved = ((index, vectorized.solve(spec, batch)) for index, batch in chunks)
        rows = min(len(done) * chunk, source.rows)
        interval = 0.1 if sys.stderr.isatty() else _LOG_SECONDS
        bar = tqdm(total=source.rows, initial=rows, unit=" cases", mininterval=interval)
        with closing(solved), bar:
            for index, batch in solved:
                checkpoint.put(index, batch)
                bar.update(batch.num_rows)
        failed, lines = summary(checkpoint.chunks(count))
        with checkpoint.result() as path:
            write(
                path, arguments.out.suffix, checkpoint.chunks(count), identity | {"units": _UNITS}
            )
    sys.stderr.write("".join(f"{line}\n" for line in lines))
    return SweepStatus.ALL_FAILED if failed == source.rows else SweepStatus.DONE


def specified(arguments: Namespace) -> tuple[Spec, Source]:
    """Return the specification and the cases of the arguments, or raise UsageError."""
    query = arguments.query
    template = _template(arguments.template)
    axes = {name: text for name, text in template.items() if str(text).count(":") >= 2}
    axes |= dict(map(_axis, arguments.grid))
    if bool(axes) == bool(arguments.table):
        raise UsageError("give one of --table and axes (--grid, or START:STOP:N in the template)")
    if any(number is not None and number < 1 for number in (arguments.workers, arguments.chunk)):
        raise UsageError("--workers and --chunk must be at least 1")
    source = Grid(axes) if axes else Table(arguments.table)
    if source.rows == 0:
        raise UsageError("the input has no cases")
    names = source.schema.names
    constants = {name: value for name, value in template.items() if name not in names}
    kept, wanted = _names(arguments.keep), _names(arguments.answers)
    allowed = (*QUANTITIES[query], *ONLY_IF_NAMED[query])
    _reject("--keep: unknown columns", set(kept) - set(names))
    _reject(f"--answers: not in {', '.join(allowed)}:", set(wanted) - set(allowed))
    quantities = tuple(name for name in allowed if name in (wanted or QUANTITIES[query]))
    spec = Spec(query, constants, quantities, kept)
    _reject("rename columns whose names the result uses:", set(names) & {*allowed, WARNING, ERROR})
    columns = [name for name in names if name not in kept]
    unknown = {name for name in (*constants, *columns) if field(query, name) is None}
    _reject(f"unknown fields of {query} (--keep copies columns):", unknown)
    try:
        nested(dict.fromkeys((*constants, *columns)))
    except InputError as error:
        raise UsageError(f"{'.'.join(map(str, error.path))}: {error.detail}") from None
    kinds = {name: source.schema.field(name).type for name in columns}
    listed = [name for name, value in constants.items() if isinstance(value, list)]
    for name, kind in (kinds | dict.fromkeys(listed, pa.list_(pa.float64()))).items():
        own = field(query, name)
        if own and not fits(own, kind):
            raise UsageError(f"{name} holds values of type {kind}; a case has one {own['type']}")
    return spec, source


def summary(batches: Iterable[pa.RecordBatch]) -> tuple[int, list[str]]:
    """Return the number of failed cases of a result, and its summary, frequent reasons first."""
    reasons: dict[str, tuple[int, int, str]] = {}
    rows = 0
    for batch in batches:
        errors = batch.column(ERROR)
        for place in np.flatnonzero(errors.is_valid()).tolist():
            error = errors[place].as_py()
            reason = _VARIES.sub("…", error)
            count, first, text = reasons.get(reason, (0, rows + place + 1, error))
            reasons[reason] = count + 1, first, text
        rows += len(errors)
    failed = sum(count for count, _, _ in reasons.values())
    lines = [f"{rows:,} cases: {rows - failed:,} solved, {failed:,} failed"]
    for count, row, error in sorted(reasons.values(), reverse=True)[:MAX_ERRORS]:
        lines.append(f"{count:>10,}  {error} (first in row {row:,})")
    if len(reasons) > MAX_ERRORS:
        lines.append(f"and {len(reasons) - MAX_ERRORS} more reasons; see the column {ERROR}")
    return failed, lines


def _check_target(arguments: Namespace, checkpoint: Checkpoint) -> None:
    target: Path = arguments.out
    if target.suffix not in SUFFIXES or target.is_dir():
        raise UsageError(f"--out: {target} is not a file name that ends in {' or '.join(SUFFIXES)}")
    replaces = arguments.overwrite or arguments.plan or checkpoint.folder.exists()
    if target.exists() and not replaces:
        raise UsageError(f"{target} exists; use --overwrite to replace it")


def _template(path: Path | None) -> dict[str, Any]:
    try:
        request = json.loads(path.read_text("utf-8")) if path else {}
    except (OSError, ValueError) as error:
        raise UsageError(f"cannot read {path}: {error}") from None
    if not isinstance(request, Mapping):
        raise UsageError(f"{path} does not hold a JSON object")
    return flat(request)


def _axis(text: str) -> tuple[str, str]:
    name, sign, values = text.partition("=")
    if not sign:
        raise UsageError(f"--grid: {text!r} is not FIELD=START:STOP:N")
    return name, values


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(",") if name.strip())


def _reject(complaint: str, names: set[str]) -> None:
    if names:
        raise UsageError(f"{complaint} {', '.join(sorted(names))}")
