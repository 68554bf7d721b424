"""``mdr``: each command is a module, loaded when it is asked for and not before."""

import argparse
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import version
from typing import Any, Final, Protocol, cast

# As a shell shows a program that was ended by the signal SIGINT or SIGPIPE.
_INTERRUPTED: Final = 130
_NOBODY_READS: Final = 141
_WRONG_INPUT: Final = 2


class Module(Protocol):
    """What a module of a command holds."""

    def declare(self, parser: argparse.ArgumentParser) -> None:
        """Say what the command takes."""

    def run(self, arguments: argparse.Namespace) -> int:
        """Do what it says and return the exit status."""


@dataclass(frozen=True)
class Command:
    """A command: what it does in a few words, and the module that does it."""

    summary: str
    module: str
    extra: str | None = None
    """The optional part of the installation that it needs."""


COMMANDS: Final = {
    "normal": Command("answer a contact without friction", "mdr_command.ask"),
    "tangential": Command("answer a contact with friction", "mdr_command.ask"),
    "history": Command("follow loads that come and go", "mdr_command.ask"),
    "stress": Command("answer stresses and displacements over the radius", "mdr_command.ask"),
    "wear": Command("answer the limit of fretting wear", "mdr_command.ask"),
    "evolution": Command("follow fretting wear over the cycles", "mdr_command.ask"),
    "sweep": Command("answer every scene of a table or a grid", "mdr_sweep.command", "sweep"),
    "serve": Command("start the HTTP service", "mdr_command.serve"),
    "openapi": Command("print the description of the HTTP service", "mdr_command.openapi"),
}


def main(given: Sequence[str] | None = None) -> int:
    """Do what the command line says and return the exit status."""
    try:
        return _run(sys.argv[1:] if given is None else given)
    except KeyboardInterrupt:
        return _INTERRUPTED
    except BrokenPipeError:
        # What is still to be flushed goes nowhere, silently.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _NOBODY_READS


def _run(given: Sequence[str]) -> int:
    name = given[0] if given else ""
    try:
        module = _loaded(COMMANDS[name]) if name in COMMANDS else None
    except ModuleNotFoundError as error:
        extra = COMMANDS[name].extra
        if extra is None:
            raise
        sys.stderr.write(f"mdr {name} needs {error.name}: install mdr[{extra}]\n")
        return _WRONG_INPUT
    arguments = _parser(name, module).parse_args(given)
    return module.run(arguments) if module else _WRONG_INPUT


def _loaded(command: Command) -> Module:
    return cast("Module", import_module(command.module))


def _parser(chosen: str, module: Module | None) -> argparse.ArgumentParser:
    """Return the parser of all commands, of which only the chosen one knows what it takes."""
    parser = argparse.ArgumentParser(prog="mdr", description=_ABOUT)
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")
    commands = parser.add_subparsers(required=True, metavar="command", title="commands")
    for name, command in COMMANDS.items():
        own = commands.add_parser(name, help=command.summary, description=command.summary)
        own.set_defaults(command=name)
        if module and name == chosen:
            module.declare(own)
    return parser


class _Version(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_others: Any) -> None:
        sys.stdout.write(f"mdr {version('mdr')}\n")
        parser.exit()


_ABOUT: Final = (
    "Contact mechanics of axisymmetric bodies by the method of dimensionality reduction."
)


if __name__ == "__main__":
    sys.exit(main())
