"""The sweep without the rest of the command line: ``python -m mdr_sweep``."""

import argparse
import sys
from typing import Final

from mdr_sweep import command

# As a shell shows a program that was ended by SIGINT.
_INTERRUPTED: Final = 130


def main() -> int:
    """Do what the command line says and return the exit status."""
    parser = argparse.ArgumentParser(prog="mdr sweep", description=command.__doc__)
    command.declare(parser)
    try:
        return command.run(parser.parse_args())
    except KeyboardInterrupt:
        return _INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
