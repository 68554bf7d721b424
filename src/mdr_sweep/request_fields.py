"""Fields of requests by dotted names such as ``load.normal_force``."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from math import inf
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from mdr_core.errors import InputError
from mdr_service.queries import QUERIES

Schema = Mapping[str, Any]
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
    root = QUERIES[query].model.model_json_schema()
    found: dict[str, Field] = {}
    for name, leaf in _leaves(root, root, ()):
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


def gaps(names: Iterable[str]) -> set[str]:
    """Return the members of lists without a predecessor, like ``terms.2`` without ``terms.1``."""
    members = {name[: index.end()] for name in names for index in _INDEX.finditer(name)}
    split = (member.rpartition(".") for member in members)
    following = {f"{of}.{int(index) + 1}" for of, _, index in split}
    return {member for member in members - following if not member.endswith(".0")}


def flat(part: Any, path: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the fields of a request by their dotted names; a list of numbers is one field."""
    if isinstance(part, list) and any(isinstance(item, Mapping | str) for item in part):
        part = {str(index): item for index, item in enumerate(part)}
    if not isinstance(part, Mapping) or (path and not part):
        return {".".join(path): part}
    inner = (flat(value, (*path, name)) for name, value in part.items())
    return dict(item for fields in inner for item in fields.items())


def nested(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the request with the given fields, the inverse of `flat`.

    Raises
    ------
    InputError : a name is a part of another one, or the indices of a list have a gap.
    """
    root: dict[str, Any] = {}
    for name, value in values.items():
        *path, last = name.split(".")
        place: Any = root
        for step in path:
            place = place.setdefault(step, {}) if isinstance(place, dict) else None
        if not isinstance(place, dict) or last in place:
            raise InputError((*path, last), "is given in two ways")
        place[last] = value
    return {name: _with_lists((name,), part) for name, part in root.items()}


def _leaves(root: Schema, node: Schema, path: tuple[str, ...]) -> Iterator[tuple[str, Schema]]:
    """Yield the numbers, strings and arrays of numbers in a JSON schema, with their names."""
    if "$ref" in node:
        node = root["$defs"][node["$ref"].rpartition("/")[2]]
    for branch in node.get("oneOf", ()):
        yield from _leaves(root, branch, path)
    for name, child in node.get("properties", {}).items():
        yield from _leaves(root, child, (*path, name))
    if node.get("type") == "array" and node["items"].get("type") != "number":
        yield from _leaves(root, node["items"], (*path, "#"))
    elif node.get("type") in {"array", "number", "string"}:
        yield ".".join(path), node


def _with_lists(path: tuple[str, ...], part: Any) -> Any:
    if not isinstance(part, dict):
        return part
    inner = {name: _with_lists((*path, name), value) for name, value in part.items()}
    if not all(name.isdecimal() for name in inner):
        return inner
    indices = list(map(str, range(len(inner))))
    if set(inner) != set(indices):
        raise InputError(path, "the indices of a list start at 0 and have no gaps")
    return [inner[index] for index in indices]
