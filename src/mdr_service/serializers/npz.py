"""NPZ: one NumPy array per member of a result, in an archive for ``numpy.load``."""

import io
from collections.abc import Iterator, Mapping, Sequence
from math import nan
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

MEDIA_TYPE: Final = "application/x-npz"


def write(result: Mapping[str, Any]) -> bytes:
    """Return the archive of a result; equal results give identical bytes.

    Infinities stay infinite, strings are arrays of text, and the warnings an array with their
    members as fields, NaN or empty text for null. The archive opens with ``allow_pickle=False``.
    """
    archive = io.BytesIO()
    arrays = {
        name: _warnings(values) if name == "warnings" else np.asarray(values)
        for name, values in _flat(result)
    }
    np.savez(archive, allow_pickle=False, **arrays)
    return archive.getvalue()


def _flat(result: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the members of a result; names of members of nested objects are joined by dots."""
    for name, value in result.items():
        if name in {"final_state", "holds_while"}:
            # The lists of these members differ in length; only JSON holds them.
            continue
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value


def _warnings(warnings: Sequence[Mapping[str, Any]]) -> NDArray[Any]:
    # At least one character wide: not every reader accepts text of width 0.
    types = {
        name: "U" + str(max([1, *(len(each[name] or "") for each in warnings)]))
        for name in ("code", "message", "instead")
    } | {"value": "f8", "limit": "f8"}
    empty = {"instead": "", "value": nan, "limit": nan}
    rows = [
        tuple(empty[name] if each[name] is None else each[name] for name in types)
        for each in warnings
    ]
    return np.array(rows, dtype=list(types.items()))
