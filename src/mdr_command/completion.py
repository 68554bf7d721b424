"""``mdr completion``: completion of the command line in a shell."""

import argparse
import sys
from importlib import import_module

import shtab

from mdr_command import ExitStatus


def declare(parser: argparse.ArgumentParser) -> None:
    """Declare the shell."""
    shells = "bash", "zsh", "tcsh"
    parser.add_argument("shell", choices=shells, help="shell for which to print the script")


def run(arguments: argparse.Namespace) -> int:
    """Print the script and return the exit status."""
    command = import_module("mdr_command.__main__")
    parser = command.parser_of(command.COMMANDS)
    sys.stdout.write(shtab.complete(parser, arguments.shell) + "\n")
    return ExitStatus.OK
