"""Cache of resolved tables, for repeated queries about one table."""

from collections import OrderedDict
from typing import Final

import numpy as np

from mdr_core.profiles import Tabulated
from mdr_service.schemas.profiles import TabulatedProfile
from mdr_service.settings import SETTINGS


class TableCache:
    """Resolved tables by their points, up to `max_bytes`.

    The least recently used table is dropped first. Resolving a table of 200 points takes several
    times as long as the contact itself.
    """

    def __init__(self, max_bytes: int) -> None:
        self._max_bytes = max_bytes
        self._tables: OrderedDict[tuple[str | bytes, ...], Tabulated] = OrderedDict()
        self.size = 0
        """Memory of the tables [bytes]."""

    def resolved(self, model: TabulatedProfile) -> Tabulated:
        """Return the profile through the points of a table."""
        points = [np.array(each, dtype=float) for each in (model.r, model.f, model.breaks)]
        key = (model.interpolation, *(each.tobytes() for each in points))
        if key in self._tables:
            self._tables.move_to_end(key)
            return self._tables[key]
        r, f, breaks = points
        table = Tabulated(r, f, model.interpolation, tuple(breaks.tolist()))
        if table.nbytes <= self._max_bytes:
            self._tables[key] = table
            self.size += table.nbytes
        while self.size > self._max_bytes:
            self.size -= self._tables.popitem(last=False)[1].nbytes
        return table


TABLES: Final = TableCache(SETTINGS.table_cache_bytes)
