"""``mdr profiles``: the kinds of profile, with their formulas and fields."""

import argparse
import sys

from mdr_command import ExitStatus
from mdr_core.profiles import KINDS
from mdr_service.schemas.profiles import MODELS


def run(_arguments: argparse.Namespace) -> int:
    """Print a table of the kinds and return the exit status."""
    rows = [("kind", "fields", "f(r)")]
    for kind, model in MODELS.items():
        fields = ", ".join(name for name in model.model_fields if name != "kind")
        rows.append((kind, fields, KINDS[kind].formula))
    widths = [max(len(row[column]) for row in rows) for column in (0, 1)]
    for kind, fields, formula in rows:
        sys.stdout.write(f"{kind:{widths[0]}}  {fields:{widths[1]}}  {formula}\n")
    return ExitStatus.OK
