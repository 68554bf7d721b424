"""``mdr openapi``: the description of the service, as ``GET /openapi.json`` answers it."""

import argparse
import json
import sys

from mdr_service.app import create_app


def declare(_parser: argparse.ArgumentParser) -> None:
    """Take nothing."""


def run(_arguments: argparse.Namespace) -> int:
    """Print the document, laid out to be compared line by line."""
    json.dump(create_app().state.openapi, sys.stdout, indent=2, ensure_ascii=False)
    sys.stdout.write("\n")
    return 0
