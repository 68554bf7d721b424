"""``mdr``: commands in modules that are imported on demand."""

import argparse
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Final, Protocol, cast

from mdr_command.exit_status import ExitStatus


class Module(Protocol):
    """Module of a command."""

    def declare(self, parser: argparse.ArgumentParser) -> None:
        """Declare the arguments of the command."""

    def run(self, arguments: argparse.Namespace) -> int:
        """Run the command and return the exit status."""


@dataclass(frozen=True)
class Command:
    """Command with its summary and its module."""

    summary: str
    module: str
    example: str = ""
    """Command line that the help shows."""


_STEEL: Final = "--kind paraboloid --radius 0.01 --e-star 1.15e11"
_SHEARED: Final = f"{_STEEL} --g-star 9.5e10 --friction-coefficient 0.3"
COMMANDS: Final = {
    "normal": Command(
        "solve a frictionless normal contact",
        "mdr_command.query",
        f"mdr normal {_STEEL} --normal-force 10",
    ),
    "tangential": Command(
        "solve a contact with friction",
        "mdr_command.query",
        f"mdr tangential {_SHEARED} --normal-force 10 --tangential-force 2",
    ),
    "history": Command(
        "solve a load history", "mdr_command.query", "mdr history request.json -o history.json"
    ),
    "stress": Command(
        "compute stresses and displacements over the radius",
        "mdr_command.query",
        f"mdr stress {_STEEL} --normal-force 10 --quantities pressure --points 50 --format csv",
    ),
    "subsurface": Command(
        "compute stresses beneath the surface and yield",
        "mdr_command.query",
        "mdr subsurface request.json --format npz -o stresses.npz",
    ),
    "wear": Command(
        "compute the limiting state of fretting wear",
        "mdr_command.query",
        f"mdr wear {_SHEARED} --normal-force 10 --tangential-force 2",
    ),
    "evolution": Command(
        "integrate fretting wear over the cycles",
        "mdr_command.query",
        "mdr evolution - < request.json > evolution.json",
    ),
    "sweep": Command(
        "run a parameter study over a table or a grid",
        "mdr_sweep.command",
        "mdr sweep normal --template ball.json --grid load.normal_force=1:100:1000:log --out a.csv",
    ),
    "profiles": Command("list the kinds of profile", "mdr_command.profiles", "mdr profiles"),
    "serve": Command(
        "start the HTTP service", "mdr_command.serve", "mdr serve --host 127.0.0.1 --port 8000"
    ),
    "openapi": Command(
        "print the OpenAPI document of the HTTP service",
        "mdr_command.openapi",
        "mdr openapi > openapi.json",
    ),
    "completion": Command(
        "print a script that completes commands in a shell",
        "mdr_command.completion",
        "mdr completion bash > ~/.local/share/bash-completion/completions/mdr",
    ),
}


# In place of a command: the arguments of all of them.
_ALL: Final = "*"


def main(given: Sequence[str] | None = None) -> int:
    """Run a command line and return the exit status."""
    try:
        return _run(sys.argv[1:] if given is None else given)
    except KeyboardInterrupt:
        return ExitStatus.INTERRUPTED
    except BrokenPipeError:
        # Python would try once more to write the rest on exit, and print a traceback.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ExitStatus.PIPE_CLOSED


def _run(given: Sequence[str]) -> int:
    name = given[0] if given else ""
    try:
        module = _loaded(COMMANDS[name]) if name in COMMANDS else None
    except ModuleNotFoundError as error:
        if str(error.name).startswith("mdr_"):
            raise
        remedy = "run `pip install '.[service]'` in the checkout"
        sys.stderr.write(f"mdr {name}: {error.name} is missing; {remedy}\n")
        return ExitStatus.NOT_INSTALLED
    arguments = _parser(name, module).parse_args(given)
    return module.run(arguments) if module else ExitStatus.INVALID_INPUT


def _loaded(command: Command) -> Module:
    return cast("Module", import_module(command.module))


def _parser(chosen: str, module: Module | None) -> argparse.ArgumentParser:
    """Return the parser of all commands, with the arguments of the chosen one."""
    parser = argparse.ArgumentParser(prog="mdr", description=_ABOUT)
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")
    commands = parser.add_subparsers(required=True, metavar="command", title="commands")
    for name, command in COMMANDS.items():
        own = commands.add_parser(
            name,
            help=command.summary,
            description=command.summary,
            epilog=f"example:\n  {command.example}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        own.set_defaults(command=name)
        if module and name == chosen:
            module.declare(own)
        elif chosen == _ALL:
            _loaded(command).declare(own)
    return parser


def complete_parser() -> argparse.ArgumentParser:
    """Return the parser of all commands with all their arguments."""
    return _parser(_ALL, None)


class _Version(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_others: Any) -> None:
        # Imported here, because the core takes a third of a second that no other option needs.
        sys.stdout.write(f"mdr {import_module('mdr_core').__version__}\n")
        parser.exit()


_ABOUT: Final = (
    "Contact mechanics of axisymmetric bodies by the method of dimensionality reduction."
)


if __name__ == "__main__":
    sys.exit(main())
