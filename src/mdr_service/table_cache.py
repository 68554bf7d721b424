"""Cache of resolved tables, for repeated queries about one table."""

from collections import OrderedDict
from hashlib import blake2b
from typing import Final, NamedTuple

import numpy as np

from mdr_core.profiles import Tabulated
from mdr_service.schemas.profiles import TabulatedProfile
from mdr_service.settings import SETTINGS


class Lookups(NamedTuple):
    """Lookups since the last report, and the size of the cache [bytes]."""

    hits: int = 0
    misses: int = 0
    size: int = 0


class TableCache:
    """Resolved tables by the digest of their points, up to `max_bytes`.

    The least recently used table is dropped first. Resolving a table of 200 points takes several
    times as long as the contact itself.
    """

    def __init__(self, max_bytes: int) -> None:
        self._max_bytes = max_bytes
        self._tables: OrderedDict[bytes, Tabulated] = OrderedDict()
        self._size = self._hits = self._misses = 0

    def resolved(self, model: TabulatedProfile) -> Tabulated:
        """Return the profile through the points of a table."""
        points = [np.array(each, dtype=float) for each in (model.r, model.f, model.breaks)]
        key = blake2b(repr((model.interpolation, *(each.size for each in points))).encode())
        for each in points:
            key.update(each.tobytes())
        digest = key.digest()
        if digest in self._tables:
            self._hits += 1
            self._tables.move_to_end(digest)
            return self._tables[digest]
        self._misses += 1
        r, f, breaks = points
        table = Tabulated(r, f, model.interpolation, tuple(breaks.tolist()))
        if table.nbytes <= self._max_bytes:
            self._tables[digest] = table
            self._size += table.nbytes
        while self._size > self._max_bytes:
            self._size -= self._tables.popitem(last=False)[1].nbytes
        return table

    def report(self) -> Lookups:
        """Return the lookups since the last report."""
        found = Lookups(self._hits, self._misses, self._size)
        self._hits = self._misses = 0
        return found


TABLES: Final = TableCache(SETTINGS.table_cache_bytes)
