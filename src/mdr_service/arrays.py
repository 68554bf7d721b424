"""Answers as arrays of NumPy, one file per name in an archive that ``numpy.load`` opens."""

import io
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

MEDIA_TYPE: Final = "application/x-npz"


def write(document: Mapping[str, Any]) -> bytes:
    """Return the archive of a document, with one array per name; infinities are infinite.

    Words are arrays of text, and the warnings one of pairs with the fields `code` and `message`:
    all of it is read with ``allow_pickle=False``. The same document makes the same bytes.
    """
    archive = io.BytesIO()
    arrays = {name: _array(name, values) for name, values in document.items()}
    np.savez(archive, allow_pickle=False, **arrays)
    return archive.getvalue()


def _array(name: str, values: Any) -> NDArray[Any]:
    return _warnings(values) if name == "warnings" else np.asarray(values)


def _warnings(values: Sequence[Mapping[str, str]]) -> NDArray[Any]:
    # No text at all would be a type of no width, which not all readers know.
    widths = {
        name: max((len(each[name]) for each in values), default=1) for name in ("code", "message")
    }
    pairs = [tuple(each[name] for name in widths) for each in values]
    return np.array(pairs, dtype=[(name, f"U{width}") for name, width in widths.items()])
