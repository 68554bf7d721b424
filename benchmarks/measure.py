"""Ratios of run times, insensitive to other load on the machine."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from statistics import median
from time import perf_counter_ns, thread_time_ns
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

# `ratios.py --gate` takes a small part of the usual rounds, and of their time.
GATE = "--gate" in sys.argv
PART = 0.05 if GATE else 1.0
# Factor by which a ratio may miss its bound before the gate takes it for lost.
SPARE = 3.0
# A batch of this length is resolved to a fraction of a percent and is rarely preempted.
BATCH_SECONDS = 4e-4
# Longer runs need no warm-up, which would waste time.
LONG_SECONDS = 0.05
# Number of rounds that determines the median of a fast run.
ROUNDS = 60


@dataclass(frozen=True)
class Row:
    """One row of the table: `ratio` with its quartiles over the rounds, and its bound.

    `target` is "<= " or ">= " and a number.
    """

    name: str
    state: str
    ratio: float
    low: float
    high: float
    target: str
    detail: str

    @property
    def is_lost(self) -> bool:
        """True if the better half of the rounds misses the bound by more than a factor of 3."""
        sign, bound = self.target.split()
        if sign == "<=":
            return self.low > SPARE * float(bound)
        return self.high < float(bound) / SPARE


def interleaved(
    first_run: Callable[[], object], second_run: Callable[[], object], seconds: float
) -> list[tuple[float, float]]:
    """Seconds per call of both, in rounds A B A B ..., for about `seconds` of wall time.

    CPU time of this thread, since wall time would include other processes.
    """
    once = [fastest(run, _tries(run)) for run in (first_run, second_run)]
    # Equal batches: neither run finds the caches colder than its own calls leave them.
    batch = max(BATCH_SECONDS, *once)
    repeats = [max(1, round(batch / one)) for one in once]
    rounds: list[tuple[float, float]] = []
    end = perf_counter_ns() + int(seconds * PART * 1e9)
    while perf_counter_ns() < end or len(rounds) < count(9):
        rounds.append((_time(first_run, repeats[0]), _time(second_run, repeats[1])))
    return rounds


def count(rounds: int) -> int:
    """Number of rounds, at least three."""
    return max(3, round(rounds * PART))


def fastest(run: Callable[[], object], calls: int) -> float:
    """Processor time of the fastest of some calls [s]."""
    return min(_time(run, 1) for _ in range(calls))


def medians(runs: Mapping[str, Callable[[], object]], seconds: float) -> dict[str, float]:
    """Median seconds per call of each run, interleaved, for about `seconds` in total.

    CPU time, as `interleaved`. Slow runs are repeated less often, at least once, so that all runs
    get equal time.
    """
    once = {name: fastest(run, _tries(run)) for name, run in runs.items()}
    repeats = {name: max(1, round(BATCH_SECONDS / one)) for name, one in once.items()}
    share = seconds / len(runs)
    target_count = {name: share / max(one, BATCH_SECONDS) for name, one in once.items()}
    samples: dict[str, list[float]] = {name: [] for name in runs}
    for number in range(ROUNDS):
        for name, run in runs.items():
            # Runs are spread over all rounds, so that a busy period affects all alike.
            due = min(1.0, target_count[name] / ROUNDS) * (number + 1)
            if not samples[name] or len(samples[name]) < due:
                if once[name] < LONG_SECONDS:
                    # The previous run may have displaced the caches.
                    run()
                samples[name].append(_time(run, repeats[name]))
    return {name: median(times) for name, times in samples.items()}


def _tries(run: Callable[[], object]) -> int:
    """Fast runs are warmed up."""
    return 5 if _time(run, 1) < LONG_SECONDS else 1


def row(
    name: str, state: str, rounds: list[tuple[float, float]], target: str, detail: str = ""
) -> Row:
    """Row for rounds of (first, second): the ratio is first / second within each round."""
    times = " / ".join(_readable(median(column)) for column in zip(*rounds, strict=True))
    return Row(
        name,
        state,
        *spread(rounds),
        target,
        ", ".join(part for part in (times, detail) if part),
    )


def spread(rounds: list[tuple[float, float]]) -> tuple[float, float, float]:
    """Median and quartiles of first / second, each ratio taken within its round."""
    ratios = sorted(first / second for first, second in rounds)
    quarter = len(ratios) // 4
    return median(ratios), ratios[quarter], ratios[-1 - quarter]


def _time(run: Callable[[], object], repeats: int) -> float:
    start = thread_time_ns()
    for _ in range(repeats):
        run()
    return max(thread_time_ns() - start, 1) / repeats / 1e9


def _readable(seconds: float) -> str:
    for factor, unit in ((1e6, "us"), (1e3, "ms")):
        if seconds * factor < 1000:
            return f"{seconds * factor:.3g} {unit}"
    return f"{seconds:.3g} s"
