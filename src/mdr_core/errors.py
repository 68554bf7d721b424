"""What can go wrong, sorted by what the caller should do about it."""

from dataclasses import dataclass
from typing import Any


class MDRError(Exception):
    """Any failure that the core reports on purpose."""


class InputError(MDRError, ValueError):
    """Ask for something else: the value at `path` has no answer in this model.

    `path` names the value as the request does, for example
    ``("load", "normal_force", 3)``; indices count from zero. `scenes` flags, over the scenes of
    a sweep, all that are refused for the same reason, where that is known.
    """

    def __init__(self, path: tuple[str | int, ...], detail: str, scenes: Any = None) -> None:
        super().__init__(f"{'.'.join(map(str, path))}: {detail}")
        self.path = path
        self.detail = detail
        self.scenes = scenes


class AccuracyError(MDRError):
    """Loosen: the tolerance asked for cannot be reached with this input.

    `path` names what to change, as the request does: the tolerance, if nothing else.
    """

    def __init__(self, detail: str, path: tuple[str | int, ...] = ("rtol",)) -> None:
        super().__init__(detail)
        self.path = path


class DefectError(MDRError):
    """Our defect: an invariant of the core broke; no input should cause it."""


@dataclass(frozen=True)
class Notice:
    """A warning that travels with an answer: a stable code and a sentence."""

    code: str
    message: str
