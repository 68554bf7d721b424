"""Progress bar of a long computation on a terminal."""

from types import TracebackType
from typing import Final, Self, TextIO

# Fits in a line of 80 characters, together with the percentage.
_WIDTH: Final = 40
_CLEAR_LINE: Final = "\r\x1b[K"


class ProgressBar:
    """Progress bar, erased on exit.

    Parameters
    ----------
    stream : the terminal.
    total : expected amount of work, which the computation can fall short of, but not exceed.
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
        self.stream.write(_CLEAR_LINE)
        self.stream.flush()

    def __call__(self, more: int) -> None:
        """Add to the amount of work that is done."""
        self.done += more
        percent = min(99, 100 * self.done // self.total)
        if percent > self.shown:
            self.shown = percent
            full = _WIDTH * percent // 100
            bar = "#" * full + "." * (_WIDTH - full)
            self.stream.write(f"{_CLEAR_LINE}[{bar}] about {percent} %")
            self.stream.flush()
