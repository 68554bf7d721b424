"""Savings and costs of gzip: the reason to leave compression to a proxy.

Prints the size of a response, the compressed fraction, the times of computation and compression,
and the bandwidth below which the compressed response arrives earlier.
"""

import gzip
import time
from collections.abc import Callable
from typing import Final

import numpy as np

from mdr_service.dispatch import respond
from mdr_service.queries import QUERIES
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.serializers import FORMATS

REPEATS: Final = 7
# The fastest level; higher ones take several times as long for a tenth less.
LEVEL: Final = 1

BALL = EXAMPLES["normal"]["hertz"]["value"]
FIELDS = {
    name: value
    for name, value in EXAMPLES["stress"]["cattaneo_mindlin"]["value"].items()
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
    """Return the shortest of several run times [ms]."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times) * 1e3


def row(case: str, form: str) -> str:
    """Return one line of the table."""
    name, request = CASES[case]
    query = QUERIES[name].request.model_validate(request)
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
    print(
        "| response | type | bytes | compressed | ms to compute | ms to compress "
        "| useful below, Mbit/s |"
    )
    print("|---|---|---|---|---|---|---|")
    for case in CASES:
        for form in FORMATS:
            print(row(case, form))


if __name__ == "__main__":
    main()
