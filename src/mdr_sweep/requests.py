"""Requests written flat: a dotted name for each of their fields, ``load.normal_force``."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

# Fields that are words; all others are numbers, or lists of them.
_WORDS: Final = frozenset({"profile.kind", "profile.interpolation"})
_BODIES: Final = ("material", "bodies")


def flat(request: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields of a request by their dotted names.

    What is in a list of parts (bodies, terms) is named by its index; a list of numbers is one
    field.
    """
    return dict(_leaves("", request))


def nested(fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return the request of some fields: the inverse of `flat`."""
    root: dict[str, Any] = {}
    for name, value in fields.items():
        *path, last = name.split(".")
        place = root
        for step in path:
            place = place.setdefault(step, {})
        place[last] = value
    return {name: _with_lists(part) for name, part in root.items()}


def is_word(name: str) -> bool:
    """Whether a field is a word: a kind, the way of interpolation, or a body that is rigid."""
    *path, last = name.split(".")
    return name in _WORDS or (tuple(path) == _BODIES and last.isdecimal())


def clash(names: Iterable[str]) -> str | None:
    """Return a name that is a part of another one, if there is any."""
    ordered = sorted(names)
    parts = {name.rpartition(".")[0] for name in ordered}
    while parts - {""}:
        for name in ordered:
            if name in parts:
                return name
        parts = {part.rpartition(".")[0] for part in parts}
    return None


def _leaves(prefix: str, part: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(part, Mapping) and (part or not prefix):
        for name, value in part.items():
            yield from _leaves(f"{prefix}.{name}" if prefix else str(name), value)
    elif isinstance(part, list) and any(isinstance(item, Mapping | str) for item in part):
        for index, item in enumerate(part):
            yield from _leaves(f"{prefix}.{index}", item)
    else:
        yield prefix, part


def _with_lists(part: Any) -> Any:
    if not isinstance(part, dict):
        return part
    if part and all(name.isdecimal() for name in part):
        return [_with_lists(part[name]) for name in sorted(part, key=int)]
    return {name: _with_lists(value) for name, value in part.items()}
