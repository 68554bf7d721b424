"""``mdr``: commands in modules that are imported on demand."""

import argparse
import os
import sys
from collections.abc import Container, Sequence
from importlib import import_module
from importlib.metadata import version
from io import TextIOWrapper
from pathlib import Path
from typing import Final, NamedTuple

from mdr_command import ExitStatus


class Command(NamedTuple):
    """A command: its summary, and its module with `run` and, if it has arguments, `declare`."""

    summary: str
    example: str = ""
    """Arguments of the command line that the help shows."""
    module: str = "mdr_command.query"


_STEEL: Final = "--kind paraboloid --radius 0.01 --e-star 1.15e11 --normal-force 10"
_RUBBED: Final = f"{_STEEL} --g-star 9.5e10 --friction-coefficient 0.3 --tangential-force 2"
_TWIST: Final = "--shear-modulus 4e10 --friction-coefficient 0.3 --rotation 1e-4"
_STUDY: Final = "--template ball.json --grid load.normal_force=1:100:1000:log --out a.csv"
COMMANDS: Final = {
    "normal": Command("solve a frictionless normal contact", _STEEL),
    "fit": Command(
        "fit modulus and contact point to a curve",
        "curve.csv --kind paraboloid --radius 5e-6 --segment loading",
    ),
    "tangential": Command("solve a contact with friction", _RUBBED),
    "history": Command("solve a load history", "request.json -o history.json"),
    "tangential_fit": Command("fit shear modulus and friction to a loop", "request.json"),
    "impact": Command("solve oblique impacts", "request.json --format csv"),
    "torsion": Command("solve a contact twisted about its axis", f"{_STEEL} {_TWIST}"),
    "stress": Command(
        "compute stresses and displacements over the radius",
        f"{_STEEL} --quantities pressure --points 50 --format csv",
    ),
    "subsurface": Command(
        "compute stresses beneath the surface and yield",
        "request.json --format npz -o stresses.npz",
    ),
    "wear": Command("compute the limiting state of fretting wear", _RUBBED),
    "evolution": Command(
        "integrate fretting wear over the cycles", "- < request.json > evolution.json"
    ),
    "sweep": Command(
        "run a parameter study over a table or a grid", f"normal {_STUDY}", "mdr_sweep.command"
    ),
    "profiles": Command("list the kinds of profile", module="mdr_command.profiles"),
    "serve": Command("start the HTTP service", "--host 127.0.0.1 --port 8000", "mdr_command.serve"),
    "openapi": Command(
        "print the OpenAPI document of the HTTP service", "> openapi.json", "mdr_command.openapi"
    ),
    "completion": Command(
        "print a script that completes commands in a shell",
        "bash > ~/.local/share/bash-completion/completions/mdr",
        "mdr_command.completion",
    ),
}


def main(given: Sequence[str] | None = None) -> int:
    """Run a command line and return the exit status."""
    _open_streams()
    if isinstance(sys.stdout, TextIOWrapper):
        # UTF-8 lets every terminal show the formulas and symbols of the texts.
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        status = _run(sys.argv[1:] if given is None else given)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return ExitStatus.INTERRUPTED
    except OSError as error:
        # On exit Python would write the rest once more, fail, and print a traceback.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):
            return ExitStatus.PIPE_CLOSED
        sys.stderr.write(f"mdr: {error}\n")
        return ExitStatus.OUTPUT_FAILED
    return status


def _open_streams() -> None:
    """Open the standard streams that the caller closed, on the null device.

    Otherwise the next file or socket would receive what is written to standard output.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            access = os.O_WRONLY if name == "stderr" else os.O_RDONLY
            setattr(sys, name, os.fdopen(os.open(os.devnull, access), mode))


def _run(given: Sequence[str]) -> int:
    name = next((each for each in given if each in COMMANDS), "")
    try:
        parser = parser_of({name})
    except ModuleNotFoundError as error:
        if str(error.name).startswith("mdr_"):
            raise
        remedy = "run `pip install '.[service]'` in the checkout"
        sys.stderr.write(f"mdr {name}: {error.name} is missing; {remedy}\n")
        return ExitStatus.NOT_INSTALLED
    arguments, unknown = parser.parse_known_args(given)
    if unknown:
        said = f"there is no {' '.join(unknown)}; see mdr {name} --help, with an example:"
        sys.stderr.write(f"mdr {name}: {said} mdr {name} {COMMANDS[name].example}\n")
        return ExitStatus.INVALID_INPUT
    status: int = arguments.run(arguments)
    return status


def parser_of(loaded: Container[str]) -> argparse.ArgumentParser:
    """Return the parser of all commands, with the arguments of those that are `loaded`."""
    about = "Contact mechanics of axisymmetric bodies by the method of dimensionality reduction."
    parser = argparse.ArgumentParser(prog="mdr", description=about)
    # The version of the core is read without importing it, which takes a third of a second.
    shown = f"mdr {version('mdr-contact')}"
    if not any(Path(__file__).parents[1].glob("mdr_core/history/slip_kernel.*.so")):
        shown += " (without its compiled module: load histories take about 100 times longer)"
    parser.add_argument("--version", action="version", version=shown, help="print it and exit")
    commands = parser.add_subparsers(required=True, metavar="command", title="commands")
    for name, command in COMMANDS.items():
        own = commands.add_parser(
            name,
            help=command.summary,
            description=command.summary,
            epilog=f"example:\n  mdr {name} {command.example}".rstrip(),
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        if name in loaded:
            module = import_module(command.module)
            own.set_defaults(command=name, run=module.run)
            if hasattr(module, "declare"):
                module.declare(own)
    return parser


if __name__ == "__main__":
    sys.exit(main())
