"""Response formats: each writes a complete result, or draws it, and computes nothing."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

import numpy as np
import orjson

from mdr_service.serializers import csv, npz, picture

JSON: Final = "application/json"
"""Media type of JSON."""
write_json: Final = partial(
    orjson.dumps, default=np.ndarray.tolist, option=orjson.OPT_SERIALIZE_NUMPY
)
"""JSON: numbers with all their digits, infinities as null."""
FORMATS: Final[Mapping[str, str]] = {
    "json": JSON,
    "csv": csv.MEDIA_TYPE,
    "npz": npz.MEDIA_TYPE,
    "txt": csv.PLAIN_TEXT,
    **picture.MEDIA_TYPES,
}
"""Media types by the name of the format."""
PICTURES: Final = frozenset(picture.MEDIA_TYPES.values())
"""Media types of pictures."""
WRITE: Final[Mapping[str, Callable[..., bytes]]] = {
    JSON: write_json,
    **{module.MEDIA_TYPE: module.write for module in (csv, npz)},
    csv.PLAIN_TEXT: csv.write_cells,
    **{each: partial(picture.write, name=name) for name, each in picture.MEDIA_TYPES.items()},
}
"""Functions by the media type that they write; pictures take the query and an appearance too."""
