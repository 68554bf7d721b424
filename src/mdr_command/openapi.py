"""``mdr openapi``: OpenAPI document of the service."""

import argparse
import json
import sys

from mdr_service.app import create_app


def run(_arguments: argparse.Namespace) -> int:
    """Print the document, indented so that versions can be compared by line."""
    json.dump(create_app().openapi(), sys.stdout, indent=2, ensure_ascii=False)
    sys.stdout.write("\n")
    return 0
