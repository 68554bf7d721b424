"""Polling of the event loop after a small query."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from mdr_service import app as application
from mdr_service.idle_poll import IdlePoll
from mdr_service.settings import SETTINGS

if TYPE_CHECKING:
    import pytest

SECONDS = 0.05


def turns(poll: IdlePoll, seconds: float) -> int:
    """Number of turns of a loop within a time after a query, which sleeps if nothing polls."""

    async def count() -> int:
        loop, number = asyncio.get_running_loop(), 0
        select = loop._selector.select  # type: ignore[attr-defined]

        def counting(timeout: float | None = None) -> object:
            nonlocal number
            number += 1
            return select(timeout)

        loop._selector.select = counting  # type: ignore[attr-defined]
        poll.extend()
        poll.extend()
        await asyncio.sleep(seconds)
        return number

    return asyncio.run(count())


def test_loop_polls_for_the_time_and_then_sleeps() -> None:
    poll = IdlePoll(SECONDS, lambda: False)
    assert turns(poll, SECONDS) > 100
    assert not turns(IdlePoll(0.0, lambda: False), SECONDS) > 5
    asyncio.run(asyncio.sleep(0))
    # The time has passed: the next query starts it again.
    assert turns(poll, SECONDS) > 100


def test_loop_sleeps_while_the_core_is_needed() -> None:
    assert turns(IdlePoll(SECONDS, lambda: True), SECONDS) <= 5


def test_single_core_is_left_to_the_client(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(application, "cores", lambda: 1)
    assert application.create_app().state.idle_poll._seconds == 0
    monkeypatch.setattr(application, "cores", lambda: 2)
    poll = application.create_app().state.idle_poll
    assert poll._seconds == SETTINGS.idle_poll_seconds
