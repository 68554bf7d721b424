"""Ratios of running times, measured so that whatever else the machine does cancels."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import median
from time import perf_counter_ns, thread_time_ns
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

# A batch this long is timed to a fraction of a percent, and seldom loses the processor.
BATCH_SECONDS = 4e-4
# What takes longer needs no warming up, and is not run for nothing.
LONG_SECONDS = 0.05
# So many rounds tell the median of a quick one.
ROUNDS = 60


@dataclass(frozen=True)
class Row:
    """One line of the table: `ratio` with the bounds between which half of its rounds lie."""

    name: str
    state: str
    ratio: float
    low: float
    high: float
    target: str
    detail: str


def interleaved(
    ours: Callable[[], object], theirs: Callable[[], object], seconds: float
) -> list[tuple[float, float]]:
    """Seconds per call of both, in rounds A B A B ..., for about `seconds` of wall time."""
    fastest = [min(_time(run, 1) for _ in range(5)) for run in (ours, theirs)]
    # Equal batches: neither side finds the caches colder than its own calls leave them.
    batch = max(BATCH_SECONDS, *fastest)
    repeats = [max(1, round(batch / one)) for one in fastest]
    rounds: list[tuple[float, float]] = []
    end = perf_counter_ns() + int(seconds * 1e9)
    while perf_counter_ns() < end or len(rounds) < 9:
        rounds.append((_time(ours, repeats[0]), _time(theirs, repeats[1])))
    return rounds


def medians(runs: Mapping[str, Callable[[], object]], seconds: float) -> dict[str, float]:
    """Median seconds per call of each, all of them in turn, for about `seconds` in all.

    Seconds of this thread on the processor: what takes longer than a slice of time would else be
    charged with whatever else the machine does. What takes long is run less often, at least once:
    its share of the time is that of the others.
    """
    fastest = {
        name: min(_time(run, 1, thread_time_ns) for _ in range(_tries(run)))
        for name, run in runs.items()
    }
    repeats = {name: max(1, round(BATCH_SECONDS / one)) for name, one in fastest.items()}
    share = seconds / len(runs)
    wanted = {name: share / max(one, BATCH_SECONDS) for name, one in fastest.items()}
    found: dict[str, list[float]] = {name: [] for name in runs}
    for number in range(ROUNDS):
        for name, run in runs.items():
            # Spread over all rounds, so that a busy moment of the machine hits all alike.
            due = min(1.0, wanted[name] / ROUNDS) * (number + 1)
            if not found[name] or len(found[name]) < due:
                if repeats[name] > 1:
                    # The one before may have taken the caches.
                    run()
                found[name].append(_time(run, repeats[name], thread_time_ns))
    return {name: median(times) for name, times in found.items()}


def _tries(run: Callable[[], object]) -> int:
    """What is quick is warmed up."""
    return 5 if _time(run, 1) < LONG_SECONDS else 1


def row(
    name: str, state: str, rounds: list[tuple[float, float]], target: str, detail: str = ""
) -> Row:
    """The line for rounds of (first, second): the ratio is first / second within each round."""
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


def _time(
    run: Callable[[], object], repeats: int, clock: Callable[[], int] = perf_counter_ns
) -> float:
    start = clock()
    for _ in range(repeats):
        run()
    return max(clock() - start, 1) / repeats / 1e9


def _readable(seconds: float) -> str:
    for factor, unit in ((1e6, "us"), (1e3, "ms")):
        if seconds * factor < 1000:
            return f"{seconds * factor:.3g} {unit}"
    return f"{seconds:.3g} s"
