"""Response formats: each writes a complete result and computes nothing."""

from collections.abc import Mapping
from typing import Any, Final

from mdr_service.serializers import csv, json, npz, svg

SERIALIZERS: Final[Mapping[str, Any]] = {"json": json, "csv": csv, "npz": npz, "svg": svg}
"""Modules with `MEDIA_TYPE` and `write`, by the name of the format."""
FORMATS: Final[Mapping[str, str]] = {
    name: module.MEDIA_TYPE for name, module in SERIALIZERS.items()
}
"""Media types by the name of the format."""
