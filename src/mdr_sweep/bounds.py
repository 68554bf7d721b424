"""Which numbers a field takes, read from the models that the service checks requests by."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from math import inf
from typing import Any, Final

import numpy as np

from mdr_service.questions import QUESTIONS
from mdr_service.schemas.quantities import SMALLEST_LOAD
from mdr_sweep.columns import Flags, Values

Schema = Mapping[str, Any]
_TAKEN: Final = frozenset({"minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"})


@dataclass(frozen=True)
class Bounds:
    """An interval of doubles; of loads those next to zero are left out."""

    low: float = -inf
    high: float = inf
    above: float = -inf
    below: float = inf
    gap: float = 0.0
    """Values nearer to zero than this, but not zero, are none."""

    def hold(self, values: Values) -> Flags:
        """Return which of the values lie inside; what is not finite does not."""
        inside = (values >= self.low) & (values <= self.high) & np.isfinite(values)
        inside &= (values > self.above) & (values < self.below)
        if self.gap:
            inside &= (np.abs(values) >= self.gap) | (values == 0)
        return inside


@cache
def bounds(query: str, kind: str, name: str) -> Bounds | None:
    """Return what the field of that dotted name takes; None where there is no such number.

    `kind` is that of the profile.
    """
    root = QUESTIONS[query].model.model_json_schema()
    found = next(_numbers(root, root, tuple(name.split(".")), kind), None)
    if found is None:
        return None
    return Bounds(
        found.get("minimum", -inf),
        found.get("maximum", inf),
        found.get("exclusiveMinimum", -inf),
        found.get("exclusiveMaximum", inf),
        SMALLEST_LOAD if name.startswith("load.") else 0.0,
    )


def _numbers(root: Schema, node: Schema, path: tuple[str, ...], kind: str) -> Iterator[Schema]:
    """Yield the schemas of numbers at the end of a path, over all branches of unions."""
    if "$ref" in node:
        node = root["$defs"][node["$ref"].rpartition("/")[2]]
    if not path and node.get("type") == "number":
        yield node
    branches = [*node.get("oneOf", ()), *node.get("anyOf", ()), *node.get("allOf", ())]
    mapping = node.get("discriminator", {}).get("mapping")
    if mapping:
        branches = [{"$ref": mapping[kind]}] if kind in mapping else []
    for branch in branches:
        if "$ref" in branch or not branch.keys().isdisjoint({"type", "properties", "items"}):
            yield from _numbers(root, branch, path, kind)
    if path and path[0] in node.get("properties", {}):
        yield from _numbers(root, node["properties"][path[0]], path[1:], kind)
    elif path and path[0].isdecimal() and "items" in node:
        yield from _numbers(root, node["items"], path[1:], kind)
