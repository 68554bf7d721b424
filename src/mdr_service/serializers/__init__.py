"""Response formats: each writes a complete result, or draws it, and computes nothing."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from mdr_service.serializers import csv, json, npz, picture

FORMATS: Final[Mapping[str, str]] = {
    "json": json.MEDIA_TYPE,
    "csv": csv.MEDIA_TYPE,
    "npz": npz.MEDIA_TYPE,
    "txt": csv.PLAIN_TEXT,
    **picture.MEDIA_TYPES,
}
"""Media types by the name of the format."""
PICTURES: Final = frozenset(picture.MEDIA_TYPES.values())
"""Media types of pictures."""
WRITE: Final[Mapping[str, Callable[..., bytes]]] = {
    **{module.MEDIA_TYPE: module.write for module in (json, csv, npz)},
    csv.PLAIN_TEXT: csv.write_cells,
    **{each: partial(picture.write, name=name) for name, each in picture.MEDIA_TYPES.items()},
}
"""Functions by the media type that they write; pictures take the query and an appearance too."""
