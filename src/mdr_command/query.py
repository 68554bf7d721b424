"""``mdr normal``, ``mdr wear`` and so on: responses of the service, without a server.

The request is a file or, if it consists of numbers, options such as ``--radius 0.01``: the query
parameters of the service, with hyphens in place of underscores.
"""

import argparse
import logging
import re
import sys
from pathlib import Path
from typing import Final

from pydantic.fields import FieldInfo

from mdr_command import ExitStatus
from mdr_core.errors import InputError
from mdr_service import content_negotiation, problems
from mdr_service.dispatch import respond
from mdr_service.problems import ServiceError
from mdr_service.query_parameters import PARAMETERS
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.serializers import FORMATS, json

_STATUS: Final = {
    problems.INTERNAL: ExitStatus.INTERNAL_ERROR,
    problems.ACCURACY: ExitStatus.ACCURACY_NOT_REACHABLE,
}
_STANDARD_INPUT: Final = "-"
# Options that are not numbers.
_TEXTS: Final = frozenset({"kind", "scale", "answers", "quantities"})

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
    if fields := _options(parser.get_default("command")):
        group = parser.add_argument_group("request by options, in place of a file")
        # By default -1e-3 counts as an option; argparse has no public way to change that.
        parser._negative_number_matcher = re.compile(r"-\.?\d")  # noqa: SLF001
        for name, field in fields.items():
            group.add_argument(
                f"--{name.replace('_', '-')}",
                default=argparse.SUPPRESS,
                metavar="TEXT" if name in _TEXTS else "NUMBER",
                help=(field.description or "").replace("%", "%%"),
            )
    parser.description = (
        f"{parser.description}\n\nA problem document goes to standard error, with the exit status "
        f"{ExitStatus.INVALID_INPUT},\nor {ExitStatus.ACCURACY_NOT_REACHABLE} if the accuracy "
        "cannot be reached."
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
    except OSError as error:
        if not arguments.output:
            raise
        return _fail(f"{arguments.output}: {error.strerror}", ExitStatus.OUTPUT_FAILED)
    return ExitStatus.OK


def _content(arguments: argparse.Namespace) -> bytes:
    """Return the response to the request, which a file or options give."""
    name, size = arguments.command, arguments.size
    suffix = arguments.output.suffix[1:] if arguments.output else ""
    format_ = arguments.format or (suffix if suffix in FORMATS else "json")
    media_type = content_negotiation.media_type(format_, "*/*")
    size = None if size is None else content_negotiation.picture_size(size, media_type)
    given = {each: vars(arguments)[each] for each in _options(name) if each in arguments}
    if not given:
        query = SCHEMAS[name].model.model_validate_json(_read(arguments.file or _STANDARD_INPUT))
        return respond(name, query, media_type, size=size)
    if arguments.file:
        raise InputError(("file",), "cannot be combined with options: give one of them")
    parameters = PARAMETERS[name].model_validate(given)
    with parameters.pointing():
        return respond(name, parameters.query(), media_type, parameters.members, size)


def _options(command: str) -> dict[str, FieldInfo]:
    """Return the parameters that are options; every command has options for a picture."""
    fields = PARAMETERS[command].model_fields if command in PARAMETERS else {}
    return {name: field for name, field in fields.items() if name not in {"format", "size"}}


def _read(file: str) -> bytes:
    if file != _STANDARD_INPUT:
        return Path(file).read_bytes()
    if sys.stdin.isatty():
        sys.stderr.write("mdr: reading the request from the terminal; end it with Ctrl-D\n")
    return sys.stdin.buffer.read()


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
