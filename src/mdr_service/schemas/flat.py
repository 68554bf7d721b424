"""Requests as flat fields with dotted names such as ``load.normal_force``.

Members of a list are named by their index, as in ``profile.terms.0.exponent``.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from mdr_core.errors import InputError

Schema = Mapping[str, Any]


def leaves(
    root: Schema, node: Schema | None = None, name: str = ""
) -> Iterator[tuple[str, Schema]]:
    """Yield the dotted name and schema of each number, string, or array of numbers or strings.

    `root` is the JSON schema of the request, and `node` the part to walk, with its name.
    """
    node = root if node is None else node
    if "$ref" in node:
        node = root["$defs"][node["$ref"].rpartition("/")[2]]
    for branch in node.get("oneOf", ()):
        # A number or a list of numbers has one entry.
        described = {"description": node.get("description", "")} | branch
        yield from leaves(root, described, name)
    for member, child in node.get("properties", {}).items():
        yield from leaves(root, child, f"{name}.{member}" if name else member)
    is_pair = "minItems" in node and node["minItems"] == node.get("maxItems")
    if node.get("type") == "array" and (
        is_pair or node["items"].get("type") not in {"number", "string"}
    ):
        # `#` stands for any index.
        described = {"description": node.get("description", "")} | node["items"]
        yield from leaves(root, described, f"{name}.#")
    elif node.get("type") in {"array", "number", "integer", "string"}:
        yield name, node


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

    Raises InputError if a name is a part of another one, or the indices of a list have a gap.
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


def _with_lists(path: tuple[str, ...], part: Any) -> Any:
    if not isinstance(part, dict):
        return part
    inner = {name: _with_lists((*path, name), value) for name, value in part.items()}
    if not inner or not all(name.isdecimal() for name in inner):
        return inner
    if set(inner) != {str(index) for index in range(len(inner))}:
        raise InputError(path, "the indices of a list start at 0 and have no gaps")
    return [inner[str(index)] for index in range(len(inner))]
