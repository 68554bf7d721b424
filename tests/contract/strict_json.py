"""Standard JSON: without NaN, Infinity or repeated names."""

import json


def loads(text: bytes) -> object:
    return json.loads(text, parse_constant=_reject, object_pairs_hook=_unique)


def _reject(constant: str) -> float:
    raise ValueError(f"{constant} is not JSON")


def _unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
    result = dict(pairs)
    if len(result) != len(pairs):
        raise ValueError("repeated name")
    return result
