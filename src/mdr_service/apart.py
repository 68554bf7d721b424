"""What a compute process does: it works, says how that went, and ends with its parent."""

import os
import signal
import threading
import traceback
from collections.abc import Callable
from functools import cache
from time import sleep, thread_time
from typing import Any, Final, NamedTuple

from mdr_service import cost, problems, questions, wire
from mdr_service.problems import Error, Kind

# How soon it notices that its parent is gone, whatever it is at.
_PARENT_SECONDS: Final = 0.5
_TRIES: Final = 7
_POLITE: Final = 5


class Outcome(NamedTuple):
    """What is sent back: exceptions do not survive the way as they are."""

    value: Any = None
    refusal: tuple[Kind, str, tuple[Error, ...]] | None = None
    defect: str | None = None


def outcome(work: Callable[..., Any], arguments: tuple[Any, ...]) -> Outcome:
    """Return what `work` returns, or why it does not."""
    prepare()
    try:
        return Outcome(work(*arguments))
    except problems.FAILURES as error:
        told = problems.told(error)
        return Outcome(refusal=(told.kind, told.detail, told.errors))
    except Exception:  # noqa: BLE001 -- the parent logs it, and answers
        return Outcome(defect=traceback.format_exc())


@cache
def prepare() -> None:
    """Leave signals to the parent, and end when it has ended."""
    # A terminal, or whoever ends a whole group, means the server: it ends once all is answered.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    # Where there are fewer processors than processes, the loop that serves all goes first.
    os.nice(_POLITE)
    threading.Thread(target=_follow, args=(os.getppid(),), daemon=True).start()


def slowness() -> float:
    """Return how many times as long this machine takes as that of the rates."""
    query = questions.QUESTIONS["tangential"].model.model_validate(cost.REFERENCE)
    taken = []
    for _ in range(_TRIES):
        start = thread_time()
        questions.answer("tangential", query, wire.MEDIA_TYPE)
        taken.append(thread_time() - start)
    return min(taken) / cost.REFERENCE_SECONDS


def _follow(parent: int) -> None:
    while os.getppid() == parent:
        sleep(_PARENT_SECONDS)
    os._exit(1)
