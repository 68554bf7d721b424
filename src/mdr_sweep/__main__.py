"""The sweep without the rest of the command line: ``python -m mdr_sweep``."""

import argparse
import sys

from mdr_sweep import command


def main() -> int:
    """Do what the command line says and return the exit status."""
    parser = argparse.ArgumentParser(prog="mdr sweep", description=command.__doc__)
    command.declare(parser)
    return command.run(parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
