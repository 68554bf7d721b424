"""Fretting wear: the limiting state in `limit`, its evolution over the cycles in `evolution`."""

from mdr_core.wear import evolution, limit

__all__ = ["evolution", "limit"]
