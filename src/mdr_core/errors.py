"""What can go wrong, sorted by what the caller should do about it."""

from dataclasses import dataclass


class MDRError(Exception):
    """Any failure that the core reports on purpose."""


class InputError(MDRError, ValueError):
    """Ask for something else: the value at `path` has no answer in this model.

    `path` names the value as the request does, for example
    ``("load", "normal_force", 3)``; indices count from zero.
    """

    def __init__(self, path: tuple[str | int, ...], detail: str) -> None:
        super().__init__(f"{'.'.join(map(str, path))}: {detail}")
        self.path = path
        self.detail = detail


class AccuracyError(MDRError):
    """Loosen: the tolerance asked for cannot be reached with this input."""


class DefectError(MDRError):
    """Our defect: an invariant of the core broke; no input should cause it."""


@dataclass(frozen=True)
class Notice:
    """A warning that travels with an answer: a stable code and a sentence."""

    code: str
    message: str
