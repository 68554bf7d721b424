"""Polling of the event loop for a moment after a small query.

A client that sends one request after the other sends the next within some 100 µs. A process that
sleeps in between is woken late, and finds less of its code in the caches of the core: a small query
then takes 1.02 to 1.1 times as long for the client. For a moment the loop therefore asks for
events without waiting for them.
"""

from asyncio import get_running_loop
from collections.abc import Callable
from time import perf_counter


class IdlePoll:
    """Keeps the event loop awake for `seconds` after a query, unless others need the core."""

    def __init__(self, seconds: float, is_needed: Callable[[], bool]) -> None:
        """`is_needed` returns True while the core is needed elsewhere."""
        self._seconds = seconds
        self._is_needed = is_needed
        self._end = 0.0
        self._polls = False

    def extend(self) -> None:
        """Poll for `seconds` from now on."""
        self._end = perf_counter() + self._seconds
        if self._seconds and not self._polls:
            self._polls = True
            get_running_loop().call_soon(self._poll)

    def _poll(self) -> None:
        # A loop that has a callback to run does not wait for events.
        self._polls = perf_counter() < self._end and not self._is_needed()
        if self._polls:
            get_running_loop().call_soon(self._poll)
