"""How far a long answer has come, for people at a terminal."""

from types import TracebackType
from typing import Final, Self, TextIO

_WIDTH: Final = 40
_CLEARED: Final = "\r\x1b[K"


class Bar:
    """A bar that grows with what is done, and leaves nothing behind.

    How much there will be is known about: it may end sooner, and does not end later.
    """

    def __init__(self, stream: TextIO, total: int) -> None:
        self.stream = stream
        self.total = total
        self.done = 0
        self.shown = -1

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        self.stream.write(_CLEARED)
        self.stream.flush()

    def __call__(self, more: int) -> None:
        """Take note of what has been done since the last time."""
        self.done += more
        percent = min(99, 100 * self.done // self.total)
        if percent > self.shown:
            self.shown = percent
            full = _WIDTH * percent // 100
            self.stream.write(f"{_CLEARED}[{'#' * full}{'.' * (_WIDTH - full)}] about {percent} %")
            self.stream.flush()
