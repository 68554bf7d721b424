"""Plain text: the cells of the table without its heading, so that one number is a number alone."""

from collections.abc import Mapping
from typing import Any, Final

from mdr_service.serializers import csv

MEDIA_TYPE: Final = "text/plain"


def write(result: Mapping[str, Any]) -> bytes:
    """Return one line per row, its cells separated by commas, without a line end after the last."""
    _, *rows, _ = csv.write(result).split(b"\r\n")
    return b"\n".join(rows)
