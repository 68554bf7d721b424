"""What once went wrong in the core, each by its smallest example."""

import threading

from mdr_core.lazy import cached_property


class Answer:
    """An answer that takes as long as `started` and `released` say."""

    def __init__(self, started: threading.Event, released: threading.Event) -> None:
        self.started, self.released = started, released
        self.computed = 0

    @cached_property
    def value(self) -> int:
        self.started.set()
        assert self.released.wait(10)
        self.computed += 1
        return self.computed


def test_a_long_answer_does_not_keep_another_objects_waiting() -> None:
    started, released, open_gate = threading.Event(), threading.Event(), threading.Event()
    open_gate.set()
    slow, quick = Answer(started, released), Answer(threading.Event(), open_gate)
    thread = threading.Thread(target=lambda: slow.value)
    thread.start()
    assert started.wait(10)
    asked = threading.Thread(target=lambda: quick.value)
    asked.start()
    asked.join(5)
    answered = not asked.is_alive()
    released.set()
    thread.join()
    asked.join()
    assert answered
    assert (slow.value, slow.value, slow.computed) == (1, 1, 1)
