"""Queries made from the OpenAPI document, answered without a server: far more in the same time.

    python -m tests.faults.random_queries [number] [seed]      # make random

Prints every query that meets a defect, and those that take far longer than was estimated. What is
found here once would be answered by 500, or be ended by the budget.
"""

from __future__ import annotations

import json
import sys
import traceback
from collections import Counter
from pathlib import Path
from time import thread_time
from typing import Any

import schemathesis
from hypothesis import HealthCheck, Phase, given, seed, settings
from schemathesis import GenerationMode

from mdr_service import batch, cost, problems, questions, wire
from mdr_service.schemas.batch import BatchQuery
from tests.contract import strict_json

DOCUMENT = json.loads((Path(__file__).parents[2] / "openapi.json").read_text("utf-8"))
PATHS = [path for path, operations in DOCUMENT["paths"].items() if "post" in operations]
#: Of the estimate, with this many seconds besides: what an extreme query may take.
TIMES, BESIDES = 10.0, 1.0
#: Dearer ones are refused by the service.
MOST_SECONDS = 10.0


class Found:
    """What was asked, and what went wrong."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.wrong = 0

    def ask(self, name: str, body: Any) -> None:
        """Answer one query in all its forms."""
        try:
            text = json.dumps(body, allow_nan=False).encode()
        except (TypeError, ValueError):
            return
        try:
            self.counts[_batched(text) if name == "batch" else self._answered(name, text)] += 1
        except problems.FAILURES as error:
            self.counts[problems.told(error).kind.name] += 1
        except Exception:  # noqa: BLE001 -- whatever it is, it is told
            self._tell(name, text, traceback.format_exc())

    def _answered(self, name: str, text: bytes) -> str:
        question = questions.QUESTIONS[name]
        query = wire.read(question.model, text)
        expected = cost.seconds(name, query, wire.MEDIA_TYPE)
        if expected > MOST_SECONDS:
            return problems.TOO_COSTLY.name
        start = thread_time()
        answer = questions.answer(name, query, wire.MEDIA_TYPE)
        taken = thread_time() - start
        strict_json.loads(answer.content)
        if taken > TIMES * expected + BESIDES:
            self._tell(name, text, f"took {taken:.2f} s, estimated {expected:.2f} s")
        for media_type in question.media_types[1:]:
            questions.answer(name, query, media_type)
        return "answered"

    def _tell(self, name: str, text: bytes, what: str) -> None:
        self.wrong += 1
        sys.stdout.write(f"! {name} {text.decode()}\n{what}\n")
        sys.stdout.flush()


def _batched(text: bytes) -> str:
    asked = batch.read(wire.read(BatchQuery, text))
    tried, _ = batch.priced(asked, MOST_SECONDS, 1.0)
    strict_json.loads(batch.answer(tried))
    return "answered"


def ask_all(bodies: Any, name: str, number: int, first: int, found: Found) -> None:
    """Ask so many queries of one kind."""

    @seed(first)
    @settings(
        max_examples=number,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=bodies)
    def every(case: Any) -> None:
        found.ask(name, case.body)

    every()


def main(number: int = 500, first: int = 1) -> int:
    found, document = Found(), schemathesis.openapi.from_dict(DOCUMENT)
    for path in PATHS:
        name = path.rpartition("/")[2]
        for mode in (GenerationMode.POSITIVE, GenerationMode.NEGATIVE):
            bodies = document[path]["POST"].as_strategy(generation_mode=mode)
            ask_all(bodies, name, number, first, found)
    sys.stdout.write(f"{dict(found.counts)}, {found.wrong} wrong\n")
    return 1 if found.wrong else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
