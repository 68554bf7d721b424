"""``mdr sweep``: a parameter study over the cases of a table or a grid."""

import argparse
import sys
from importlib import import_module
from pathlib import Path
from typing import Final

from mdr_sweep.spec import QUANTITIES, SweepError, SweepStatus, UsageError

_RESUME: Final = "completed chunks are kept; rerun the command to resume"


def declare(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    add = parser.add_argument
    add("query", choices=sorted(QUANTITIES), help="query to solve for every case")
    add(
        "--table",
        type=Path,
        help="cases, one per row: .parquet or .csv, columns like profile.radius",
    )
    add("--template", type=Path, help="request in JSON with the fields that all cases share")
    add(
        "--grid",
        action="append",
        default=[],
        metavar="FIELD=START:STOP:N[:log]",
        help="axis of a grid of cases; the last axis varies fastest",
    )
    add(
        "--answers",
        default="",
        help="quantities to compute, separated by commas (all but maxima, errors of model or "
        "data, and pull-off)",
    )
    add("--keep", default="", help="columns of the table to copy, separated by commas")
    add("--out", type=Path, required=True, help="result: .parquet or .csv")
    add("--overwrite", action="store_true", help="replace an existing result")
    add("--restart", action="store_true", help="discard the checkpoint of an earlier sweep")
    add("--scheduler", metavar="ADDRESS", help="Dask scheduler, for example tcp://host:8786")
    add("--workers", type=int, help="number of processes (all cores if that saves time)")
    add("--chunk", type=int, help="cases in a chunk (as many as take about two seconds)")
    add("--plan", action="store_true", help="print estimated time and disk use, then exit")


def run(arguments: argparse.Namespace) -> int:
    """Run or resume a sweep and return the exit status."""
    try:
        status: int = import_module("mdr_sweep.sweep").run(arguments)
    except ModuleNotFoundError as error:
        remedy = "run `pip install '.[sweep]'` in the checkout"
        return _exit(f"{error.name} is missing; {remedy}", SweepStatus.ENDED_EARLY)
    except UsageError as error:
        return _exit(error, SweepStatus.INVALID_INPUT)
    except (KeyboardInterrupt, Exception) as error:
        if _is_interrupt(error):
            return _exit(f"interrupted; {_RESUME}", SweepStatus.INTERRUPTED)
        if isinstance(error, SweepError | OSError):
            return _exit(f"{error}; {_RESUME}", SweepStatus.ENDED_EARLY)
        raise
    return status


def _is_interrupt(error: BaseException | None) -> bool:
    """Return True for an interrupt, or for an error while workers are closed after an interrupt."""
    while error and not isinstance(error, KeyboardInterrupt):
        error = error.__context__
    return error is not None


def _exit(message: object, status: int) -> int:
    sys.stderr.write(f"mdr sweep: {message}\n")
    return status
