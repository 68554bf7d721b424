"""NPZ: one NumPy array per member of a result, in an archive for ``numpy.load``."""

import io
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

MEDIA_TYPE: Final = "application/x-npz"


def write(result: Mapping[str, Any]) -> bytes:
    """Return the archive of a result; equal results give identical bytes.

    Infinities stay infinite, strings are arrays of text, and the warnings an array with the fields
    `code` and `message`. The archive opens with ``allow_pickle=False``.
    """
    archive = io.BytesIO()
    arrays = {
        name: _warnings(values) if name == "warnings" else np.asarray(values)
        for name, values in _flat(result)
    }
    np.savez(archive, allow_pickle=False, **arrays)
    return archive.getvalue()


def _flat(result: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the members of a result, those of nested objects with the names joined by dots."""
    for name, value in result.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value


def _warnings(warnings: Sequence[Mapping[str, str]]) -> NDArray[Any]:
    # At least one character wide: not every reader accepts text of width 0.
    widths = {
        name: max((len(each[name]) for each in warnings), default=1) for name in ("code", "message")
    }
    pairs = [tuple(each[name] for name in widths) for each in warnings]
    return np.array(pairs, dtype=[(name, f"U{width}") for name, width in widths.items()])
