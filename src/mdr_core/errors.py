"""Exceptions, grouped by the action required of the caller."""

from dataclasses import dataclass
from typing import Any, Final, Literal

Remedy = Literal[
    "smaller_load",
    "rounded_tip",
    "longer_table",
    "adhesion",
    "boundary_elements",
    "finite_elements",
    "elastic_plastic",
    "wear_evolution",
    "conforming_contact",
]
"""Remedy named by a warning."""


# Members of a request that hold arguments of the core's functions.
_GROUPS: Final = frozenset(
    {"profile", "material", "load", "tangential", "torsion", "history", "oscillation"}
)


def _sentence(path: tuple[str | int, ...], detail: str) -> str:
    """Return the detail after the name of the argument."""
    names = path[1:] if len(path) > 1 and path[0] in _GROUPS else path
    parts = (f"[{name}]" if isinstance(name, int) else f".{name}" for name in names)
    argument = "".join(parts).removeprefix(".")
    return f"{argument}: {detail}" if argument else detail


class MDRError(Exception):
    """Base class of all exceptions that the core raises deliberately."""


class InputError(MDRError, ValueError):
    """Invalid input: the value at `path` has no result in this model.

    Its text names the argument, such as ``normal_force[3]``.

    Parameters
    ----------
    path : location of the value in the request, for example ``("load", "normal_force", 3)``;
        indices count from zero.
    detail : reason and remedy.
    cases : True for the cases of a sweep that are rejected for the same reason; None if unknown.
    """

    def __init__(self, path: tuple[str | int, ...], detail: str, cases: Any = None) -> None:
        super().__init__(_sentence(path, detail))
        self.path = path
        self.detail = detail
        self.cases = cases


class AccuracyError(MDRError):
    """The required accuracy cannot be reached for this input. Its text names the argument.

    Parameters
    ----------
    detail : reason and remedy.
    path : location in the request of the value to change.
    """

    def __init__(self, detail: str, path: tuple[str | int, ...]) -> None:
        super().__init__(_sentence(path, detail))
        self.path = path
        self.detail = detail


class DefectError(MDRError):
    """Internal error: an invariant of the core is violated, which no input should cause."""


@dataclass(frozen=True)
class Notice:
    """Warning that accompanies a result: a stable code and a sentence."""

    code: str
    message: str
    value: float | None = None
    """Largest value of the quantity that raised the warning, over all cases; None if there is no
    such quantity."""
    limit: float | None = None
    """Limit that `value` exceeds."""
    instead: Remedy | None = None
    """Remedy; None where there is none."""
