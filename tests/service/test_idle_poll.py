"""Polling of the event loop after a small query."""

from __future__ import annotations

import asyncio
import selectors

import pytest

from mdr_service import app as application
from mdr_service.idle_poll import IdlePoll
from mdr_service.settings import SETTINGS

SECONDS = 0.05


class Waits(selectors.DefaultSelector):
    """Selector that records for how long a loop would wait for events, None for ever."""

    def __init__(self) -> None:
        super().__init__()
        self.waits: list[float | None] = []

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        self.waits.append(timeout)
        return super().select(timeout)


def waits(poll: IdlePoll) -> list[float | None]:
    """Waits of a loop after two queries, until long after both."""
    selector = Waits()

    async def queries() -> list[float | None]:
        poll.extend()
        poll.extend()
        await asyncio.sleep(3 * SECONDS)
        return list(selector.waits)

    with asyncio.Runner(loop_factory=lambda: asyncio.SelectorEventLoop(selector)) as runner:
        return runner.run(queries())


def polls(found: list[float | None]) -> int:
    return found.count(0)


def test_loop_polls_for_the_time_and_then_sleeps() -> None:
    poll = IdlePoll(SECONDS, lambda: False)
    for _ in range(2):
        found = waits(poll)
        assert polls(found) > 100
        # One sleep for the rest.
        assert [wait for wait in found if wait] == [pytest.approx(2 * SECONDS, rel=0.5, abs=0)]


def test_loop_sleeps_at_once_without_a_time() -> None:
    assert polls(waits(IdlePoll(0.0, lambda: False))) <= 5


def test_loop_sleeps_while_the_core_is_needed() -> None:
    assert polls(waits(IdlePoll(SECONDS, lambda: True))) <= 5


def test_single_core_is_left_to_the_client(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(application, "cores", lambda: 1)
    assert application.create_app().state.idle_poll._seconds == 0
    monkeypatch.setattr(application, "cores", lambda: 2)
    poll = application.create_app().state.idle_poll
    assert poll._seconds == SETTINGS.idle_poll_seconds
