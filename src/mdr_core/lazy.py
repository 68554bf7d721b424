"""Answers that are computed when first asked for, each thread on its own."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from functools import cached_property
else:

    class cached_property:  # noqa: N801 -- used in place of that of functools
        """A property that is computed once for each object and kept in its dictionary.

        That of `functools` holds, in Python 3.11, one lock for all objects of a class while it
        computes: a long answer would keep every short one of another thread waiting. Here two
        threads that share one object may both compute, and get the same.
        """

        def __init__(self, compute: Callable[[Any], Any]) -> None:
            self.compute = compute
            self.__doc__ = compute.__doc__

        def __set_name__(self, _owner: type, name: str) -> None:
            self.name = name

        def __get__(self, instance: Any, _owner: type | None = None) -> Any:
            if instance is None:
                return self
            # Never reached again for this object: what it holds itself comes first.
            value = vars(instance)[self.name] = self.compute(instance)
            return value


__all__ = ["cached_property"]
