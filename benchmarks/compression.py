"""What gzip would save, and what it would cost: why the service leaves it to a proxy.

Prints a table: the size of an answer, what is left of it, what computing and compressing it take,
and how slow a connection has to be for the compressed answer to arrive sooner.
"""

import gzip
import time
from collections.abc import Callable
from typing import Final

import numpy as np

from mdr_service.dispatch import respond
from mdr_service.queries import QUERIES
from mdr_service.schemas.examples import NORMAL_EXAMPLES, STRESS_EXAMPLES
from mdr_service.serializers import FORMATS

REPEATS: Final = 7
# The fastest; the others take several times as long for a tenth less.
LEVEL: Final = 1

BALL = NORMAL_EXAMPLES["hertz"]["value"]
FIELDS = {
    name: value
    for name, value in STRESS_EXAMPLES["cattaneo_mindlin"]["value"].items()
    if name != "radius"
}
CASES = {
    **{
        f"normal, {loads} loads": (
            "normal",
            BALL | {"load": {"normal_force": np.linspace(1.0, 2.0, loads).tolist()}},
        )
        for loads in (1, 100, 10_000)
    },
    "stress, 1000 radii": ("stress", FIELDS | {"points": 1_000}),
}


def fastest(work: Callable[[], object]) -> float:
    """Return the shortest of some times, in milliseconds."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times) * 1e3


def row(case: str, form: str) -> str:
    """Return one line of the table."""
    name, request = CASES[case]
    query = QUERIES[name].model.model_validate(request)
    media_type = FORMATS[form]
    content = respond(name, query, media_type)
    computed = fastest(lambda: respond(name, query, media_type))
    left = len(gzip.compress(content, LEVEL))
    compressed = fastest(lambda: gzip.compress(content, LEVEL))
    pays_below = 8e-3 * (len(content) - left) / compressed
    return (
        f"| {case} | {form} | {len(content)} | {left / len(content):.2f} | {computed:.2f} | "
        f"{compressed:.2f} | {pays_below:.0f} |"
    )


def main() -> None:
    """Print the table."""
    print("| answer | form | bytes | left | ms to answer | ms to compress | pays below, Mbit/s |")
    print("|---|---|---|---|---|---|---|")
    for case in CASES:
        for form in FORMATS:
            print(row(case, form))


if __name__ == "__main__":
    main()
