"""``mdr normal``, ``mdr wear`` and so on: the answers of the service, without a server."""

import argparse
import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from mdr_command.progress import Bar
from mdr_core.wear import evolution
from mdr_service import forms, problems, wire
from mdr_service.problems import ServiceError
from mdr_service.questions import QUESTIONS, Answer, answer
from mdr_service.schemas.queries import Query
from mdr_service.schemas.wear import EvolutionQuery

_DEFECT: Final = 1
_WRONG_INPUT: Final = 2
_NOT_SO_EXACT: Final = 3
_STATUS: Final = {problems.INTERNAL: _DEFECT, problems.ACCURACY: _NOT_SO_EXACT}

_logger: Final = logging.getLogger(__name__)


def declare(parser: argparse.ArgumentParser) -> None:
    """Take the request, and the form of its answer."""
    parser.add_argument(
        "file",
        nargs="?",
        help="the request in JSON, as the service takes it; standard input if none",
    )
    parser.add_argument(
        "--format", default="json", metavar="|".join(forms.FORMATS), help="of the answer (json)"
    )
    parser.epilog = (
        f"What fails is told on standard error by the problem document of the service, with the "
        f"exit status {_WRONG_INPUT}, or {_NOT_SO_EXACT} if rtol cannot be reached."
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the answer to standard output."""
    try:
        text = Path(arguments.file).read_bytes() if arguments.file else sys.stdin.buffer.read()
    except OSError as error:
        sys.stderr.write(f"mdr: {arguments.file}: {error.strerror}\n")
        return _WRONG_INPUT
    try:
        found = _answer(arguments.command, text, arguments.format)
    except problems.FAILURES as error:
        return _failed(problems.told(error))
    except Exception:
        _logger.exception("a defect")
        return _failed(problems.DEFECT)
    sys.stdout.buffer.write(found.content)
    if sys.stdout.isatty() and not found.content.endswith(b"\n"):
        sys.stdout.buffer.write(b"\n")
    sys.stdout.flush()
    return 0


def _answer(name: str, text: bytes, form: str) -> Answer:
    question = QUESTIONS[name]
    media_type = forms.named(form, question.media_types)
    query = wire.read(question.model, text)
    with _watched(query) as progress:
        return answer(name, query, media_type, **progress)


@contextmanager
def _watched(query: Query) -> Iterator[dict[str, Bar]]:
    """Show a bar where somebody looks and the answer takes long."""
    if not (isinstance(query, EvolutionQuery) and sys.stderr.isatty()):
        yield {}
        return
    with Bar(sys.stderr, evolution.evaluations(query.resolution, query.loads, query.radii)) as bar:
        yield {"progress": bar}


def _failed(error: ServiceError) -> int:
    sys.stderr.write(wire.write(problems.document(error)).decode() + "\n")
    return _STATUS.get(error.kind, _WRONG_INPUT)
