"""``mdr normal``, ``mdr wear`` and so on: responses of the service, without a server."""

import argparse
import logging
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from mdr_command import flags
from mdr_command.exit_status import ExitStatus
from mdr_core.errors import InputError
from mdr_service import content_negotiation, problems
from mdr_service.dispatch import parse, respond
from mdr_service.problems import ServiceError
from mdr_service.query_parameters import Parameters
from mdr_service.schemas.contacts import Query
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.serializers import FORMATS, json

_STATUS: Final = {
    problems.INTERNAL: ExitStatus.INTERNAL_ERROR,
    problems.ACCURACY: ExitStatus.ACCURACY_NOT_REACHABLE,
}
_STANDARD_INPUT: Final = "-"

_logger: Final = logging.getLogger(__name__)


def declare(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments: the request, and the format of the response."""
    parser.add_argument(
        "file",
        nargs="?",
        help="request in JSON, as the service accepts it; - for standard input (default)",
    )
    parser.add_argument(
        "--format",
        metavar="|".join(FORMATS),
        help="format of the response (default: by the suffix of FILE, else json)",
    )
    parser.add_argument("--size", metavar="WxH", help=content_negotiation.SIZE)
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FILE",
        help="file for the response (default: standard output)",
    )
    flags.declare(parser, parser.get_default("command"))
    parser.description = (
        f"{parser.description}\n\nA problem document goes to standard error, with the exit status "
        f"{ExitStatus.INVALID_INPUT},\nor {ExitStatus.ACCURACY_NOT_REACHABLE} if rtol cannot "
        "be reached."
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the response and return the exit status."""
    try:
        content = _content(arguments)
    except OSError as error:
        return _fail(f"{arguments.file}: {error.strerror}", ExitStatus.INVALID_INPUT)
    except problems.FAILURES as error:
        return _report(problems.to_problem(error))
    except Exception:
        _logger.exception("internal error")
        return _report(problems.INTERNAL_ERROR)
    try:
        _write(content, arguments.output)
    except BrokenPipeError:
        raise
    except OSError as error:
        if arguments.output:
            return _fail(f"{arguments.output}: {error.strerror}", ExitStatus.OUTPUT_FAILED)
        # Python would try once more to write the rest on exit, and print a traceback.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _fail(f"standard output: {error.strerror}", ExitStatus.OUTPUT_FAILED)
    return ExitStatus.OK


def _content(arguments: argparse.Namespace) -> bytes:
    """Return the response to the request, which a file or options give."""
    parameters = flags.parameters(arguments)
    suffix = arguments.output.suffix[1:] if arguments.output else ""
    format_ = arguments.format or (suffix if suffix in FORMATS else "json")
    if parameters is None:
        query = parse(SCHEMAS[arguments.command].model, _read(arguments.file or _STANDARD_INPUT))
        return _respond(arguments, query, (), format_)
    if arguments.file:
        raise InputError(("file",), "does not go with options: give one of them")
    return _by_parameters(arguments, parameters, format_)


def _read(file: str) -> bytes:
    if file != _STANDARD_INPUT:
        return Path(file).read_bytes()
    if sys.stdin.isatty():
        sys.stderr.write("mdr: reading the request from the terminal; end it with Ctrl-D\n")
    return sys.stdin.buffer.read()


def _respond(
    arguments: argparse.Namespace, query: Query, members: Sequence[str], format_: str
) -> bytes:
    media_type = content_negotiation.media_type(format_, "*/*")
    given = arguments.size
    size = None if given is None else content_negotiation.picture_size(given, media_type)
    return respond(arguments.command, query, media_type, members, size)


def _by_parameters(arguments: argparse.Namespace, parameters: Parameters, format_: str) -> bytes:
    """Return the response to a request by options; its problems point at the options."""
    query = parameters.query()
    try:
        return _respond(arguments, query, parameters.members, format_)
    except problems.FAILURES as error:
        raise parameters.pointed(problems.to_problem(error)) from None


def _write(content: bytes, file: Path | None) -> None:
    if file:
        file.write_bytes(content)
        return
    sys.stdout.buffer.write(content)
    if sys.stdout.isatty() and not content.endswith(b"\n"):
        sys.stdout.buffer.write(b"\n")
    sys.stdout.flush()


def _report(error: ServiceError) -> int:
    sys.stderr.write(json.write(problems.document(error)).decode() + "\n")
    return _STATUS.get(error.type, ExitStatus.INVALID_INPUT)


def _fail(detail: str, status: int) -> int:
    sys.stderr.write(f"mdr: {detail}\n")
    return status
