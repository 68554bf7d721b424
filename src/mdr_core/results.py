"""Readable form of results, and their conversion to a dictionary."""

from typing import Any, ClassVar

import numpy as np

# Number of digits that the readable form shows, of a result and of an error. Further digits depend
# on the processor or are insignificant. `to_dict` returns all digits.
_DIGITS, _OF_AN_ERROR = 7, 2


class Results:
    """Object whose results are attributes; `quantities` lists their names."""

    quantities: ClassVar[tuple[str, ...]] = ()
    about: ClassVar[tuple[str, ...]] = ()

    def computed(self) -> dict[str, Any]:
        """Return the quantities by name, in the types in which they are computed."""
        return {name: getattr(self, name) for name in self.quantities}

    def values(self) -> dict[str, Any]:
        """Return the quantities by name, as single numbers where they have no dimension."""
        return {name: _plain(value) for name, value in self.computed().items()}

    def to_dict(self) -> dict[str, Any]:
        """Return every result by name, with the names of the HTTP service.

        Returns
        -------
        Quantities and errors of the model as arrays over the loads, or as single numbers for a
        single load; `method`, `sources`, `error_estimate`, and `warnings` as a list of dictionaries
        with the members of `Notice`.
        """
        about = {name: _plain(getattr(self, name)) for name in self.about}
        values = self.values() | {name: value for name, value in about.items() if value is not None}
        if "warnings" in values:
            values["warnings"] = [vars(notice) for notice in values["warnings"]]
        return values

    def __repr__(self) -> str:
        """Return the class with one line for each result."""
        values = self.to_dict()
        width = max(map(len, values))
        shown = {
            name: _short(value, _OF_AN_ERROR if "error" in name else _DIGITS)
            for name, value in values.items()
        }
        lines = [f"{name:>{width}}: {text}" for name, text in shown.items()]
        return "\n".join([f"{type(self).__name__}:", *lines])


def _plain(value: Any) -> Any:
    """Return a single number or text for an array without dimension."""
    return value.item() if isinstance(value, np.ndarray | np.generic) and not value.ndim else value


def _short(value: Any, digits: int) -> str:
    if isinstance(value, float):
        return f"{value:.{digits}g}"
    if isinstance(value, np.ndarray):
        # Format a value on one line, a long array by its first and last values.
        return np.array2string(
            value,
            max_line_width=10_000,
            separator=", ",
            threshold=6,
            edgeitems=2,
            formatter={"float_kind": lambda number: _short(number, digits)},
        )
    if isinstance(value, list):
        return ", ".join(notice["code"] for notice in value) or "none"
    if isinstance(value, tuple):
        return "; ".join(value)
    return str(value)
