"""Fields of requests by dotted names such as ``load.normal_force``."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import inf
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from mdr_service.queries import QUERIES
from mdr_service.schemas.flat import leaves

# Members of a list are named by their index; `#` stands for any of them.
_INDEX: Final = re.compile(r"(?<=\.)(0|[1-9][0-9]*)(?=\.|$)")
# Fields over the radius, which no sweep computes.
_OVER_RADIUS: Final = frozenset({"radius", "points", "quantities"})


@dataclass(frozen=True)
class Field:
    """Type of a field (``number``, ``string``, ``array`` of numbers), and bounds of a number."""

    type: str
    low: float
    high: float
    smallest: float
    """Smallest magnitude besides 0."""

    def accepts(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return True for the values within the bounds, False for NaN."""
        is_significant = (np.abs(values) >= self.smallest) | (values == 0)
        return np.asarray(is_significant & (values >= self.low) & (values <= self.high))


@cache
def fields(query: str) -> Mapping[str, Field]:
    """Return the fields of a request model, as its JSON schema describes them."""
    found: dict[str, Field] = {}
    for name, leaf in leaves(QUERIES[query].model.model_json_schema()):
        # A load takes a number or a list; a case of a sweep has one number.
        if name in _OVER_RADIUS or (name in found and leaf["type"] == "array"):
            continue
        low, high = leaf.get("minimum", -inf), leaf.get("maximum", inf)
        smallest = leaf.get("x-smallest-magnitude", 0.0)
        found[name] = Field(leaf["type"], low, high, smallest)
    return found


def generic(name: str) -> str:
    """Return a dotted name with `#` in place of indices, as `fields` holds it."""
    return _INDEX.sub("#", name)


def flat(part: Any, path: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the fields of a request by their dotted names; a list of numbers is one field."""
    if isinstance(part, list) and any(isinstance(item, Mapping | str) for item in part):
        part = {str(index): item for index, item in enumerate(part)}
    if not isinstance(part, Mapping) or (path and not part):
        return {".".join(path): part}
    inner = (flat(value, (*path, name)) for name, value in part.items())
    return dict(item for fields in inner for item in fields.items())
