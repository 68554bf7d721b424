"""``mdr openapi``: OpenAPI document of the service."""

import argparse
import json
import sys

from mdr_command import ExitStatus
from mdr_service.app import create_app


def run(_arguments: argparse.Namespace) -> int:
    """Print the document, indented so that versions can be compared by line."""
    text = json.dumps(create_app().openapi(), indent=2, ensure_ascii=False)
    # JSON is written as UTF-8 on every terminal.
    sys.stdout.buffer.write(f"{text}\n".encode())
    return ExitStatus.OK
