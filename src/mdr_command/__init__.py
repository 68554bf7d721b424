"""Command line ``mdr``: queries without a server, parameter studies, and the server."""

from enum import IntEnum


class ExitStatus(IntEnum):
    """Exit status of a command; docs/command_line.md lists them."""

    OK = 0
    INTERNAL_ERROR = 1
    INVALID_INPUT = 2
    """The status with which argparse reports invalid arguments."""
    ACCURACY_NOT_REACHABLE = 3
    OUTPUT_FAILED = 4
    NOT_INSTALLED = 5
    """The packages of the command are missing."""
    INTERRUPTED = 130
    """The status with which shells report programs terminated by SIGINT."""
    PIPE_CLOSED = 141
    """The status with which shells report programs terminated by SIGPIPE."""
