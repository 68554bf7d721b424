"""How far a sweep is: a bar on a terminal, else a line now and then."""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING, Final, Protocol, TextIO

from tqdm import tqdm

if TYPE_CHECKING:
    from types import TracebackType

# Seconds from line to line.
_APART: Final = 10.0


class Progress(Protocol):
    """What is told of every chunk."""

    def done(self, scenes: int) -> None:
        """Count so many scenes more."""

    def __enter__(self) -> Progress:
        """Begin."""

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End."""


class Bar:
    """A bar with the rate and the time that is left."""

    def __init__(self, stream: TextIO, scenes: int, before: int) -> None:
        self.bar = tqdm(
            total=scenes,
            initial=before,
            unit=" scenes",
            unit_scale=True,
            file=stream,
            smoothing=0.1,
        )

    def done(self, scenes: int) -> None:
        self.bar.update(scenes)

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_error: object) -> None:
        self.bar.close()


class Lines:
    """A line every few seconds, and one at the end."""

    def __init__(self, stream: TextIO, scenes: int, before: int) -> None:
        self.stream, self.scenes, self.count = stream, scenes, before
        self.before, self.start = before, monotonic()
        self.last = self.start

    def done(self, scenes: int) -> None:
        self.count += scenes
        if monotonic() - self.last >= _APART:
            self._tell()

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_error: object) -> None:
        self._tell()

    def _tell(self) -> None:
        self.last = monotonic()
        rate = (self.count - self.before) / max(self.last - self.start, 1e-9)
        left = f", {(self.scenes - self.count) / rate:.0f} s left" if rate else ""
        self.stream.write(f"{self.count:,} of {self.scenes:,} scenes, {rate:,.0f}/s{left}\n")
        self.stream.flush()


def progress(stream: TextIO, scenes: int, before: int) -> Progress:
    """Return what fits the stream; `before` scenes were done before."""
    return (Bar if stream.isatty() else Lines)(stream, scenes, before)
