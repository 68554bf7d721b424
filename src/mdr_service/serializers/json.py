"""JSON: numbers with all their digits, infinities as null."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import orjson

MEDIA_TYPE: Final = "application/json"


def write(result: Mapping[str, Any]) -> bytes:
    """Return the text of a result."""
    return orjson.dumps(result, default=np.ndarray.tolist, option=orjson.OPT_SERIALIZE_NUMPY)
