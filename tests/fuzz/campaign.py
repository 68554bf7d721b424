"""Thousands of ordinary queries, computed in process, whose results are checked against laws.

python -m tests.fuzz.campaign [--queries N] [--seed S] [--report FILE]     # make fuzz

Some queries are repeated at the tightest tolerance, and as the inverse query.
Query i of seed S does not depend on earlier queries. The report has one entry per class of
failures, with the shortest query of the class.
"""

import argparse
import json
import re
import sys
import traceback
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from time import thread_time
from typing import Any, Final

import numpy as np

from tests.contract import strict_json
from tests.fuzz import laws, ordinary_cases
from tests.fuzz.service import Reply, Service

SOLVED: Final = 0.7
"""Smallest accepted fraction of queries with a result."""


REJECTED: Final = frozenset({"urn:mdr:problem:invalid-request", "urn:mdr:problem:outside-model"})
"""Accepted problem types: queries outside the model's validity."""


@dataclass
class Failures:
    """Classes of failures: their number, profile kinds, and the shortest query."""

    counts: Counter[str] = field(default_factory=Counter)
    kinds: dict[str, Counter[str]] = field(default_factory=dict)
    shortest: dict[str, tuple[str, str]] = field(default_factory=dict)
    details: dict[str, str] = field(default_factory=dict)

    def add(self, label: str, name: str, body: Any, detail: str = "") -> None:
        text = json.dumps({"ask": name, "request": body})
        self.counts[label] += 1
        kind = body.get("profile", {}).get("kind", "")
        self.kinds.setdefault(label, Counter())[kind] += 1
        known = self.shortest.get(label)
        if known is None or len(text) < len(known[0]):
            self.shortest[label] = text, name
            self.details[label] = detail

    def entries(self) -> list[dict[str, Any]]:
        return [
            {
                "label": label,
                "count": count,
                "kinds": dict(self.kinds[label]),
                "query": json.loads(self.shortest[label][0]),
                "detail": self.details[label],
            }
            for label, count in self.counts.most_common()
        ]


def _where(error: BaseException) -> str:
    """Return the type of an internal error and its last frames within this project."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if "/src/mdr_" in f.filename]
    last = " < ".join(f"{Path(f.filename).stem}.{f.name}" for f in reversed(frames[-3:]))
    return f"{type(error).__name__} in {last}"


class Campaign:
    """A series of queries against one service."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self.service = Service()
        self.failures = Failures()
        self.statuses: Counter[str] = Counter()
        self.slowest = (0.0, "")

    def run_query(self, index: int) -> None:
        """Send query number `index` of the seed, and those that have to agree with it."""
        random = Random(f"{self.seed} {index}")
        name, body = ordinary_cases.query(random)
        start = thread_time()
        reply = self.service.post(name, body)
        self.slowest = max(self.slowest, (thread_time() - start, f"query {index}: {name}"))
        self.statuses[f"{name} {reply.status}"] += 1
        result = self._checked_result(name, body, reply)
        if result:
            for label in self._repeat(random, name, body, result):
                self.failures.add(f"{name}: {label}", name, body)

    def _checked_result(self, name: str, body: Any, reply: Reply) -> dict[str, Any] | None:
        """Return the result, if any; record what is wrong with the reply."""
        if reply.status not in {200, 422}:
            label = f"{name}: {reply.status} {_where(reply.defect) if reply.defect else ''}"
            shown = "".join(traceback.format_exception(reply.defect)[-6:]) if reply.defect else ""
            self.failures.add(label, name, body, shown)
            return None
        try:
            document: Any = strict_json.loads(reply.content)
        except ValueError as error:
            self.failures.add(f"{name}: not JSON: {error}", name, body)
            return None
        if reply.status == 200:
            for law in laws.violations(name, body, document):
                self.failures.add(f"{name}: {law}", name, body)
            return dict(document)
        self.statuses[f"{name} 422 {document['type']}"] += 1
        expected = document.get("errors") and (
            document["type"] in REJECTED or "more nodes" in document["detail"]
        )
        if not expected:
            detail = re.sub(r"[-+.\d]+(e[-+]?\d+)?", "#", document["detail"])
            self.failures.add(f"{name}: {document['type']}: {detail}", name, body)
        return None

    def _repeat(
        self, random: Random, name: str, body: Any, result: dict[str, Any]
    ) -> Iterator[str]:
        if name in {"evolution", "impact"} and random.random() < 0.15:
            other = self._result_of(name, body | {"rtol": 1e-10 if name == "evolution" else 1e-6})
            if other:
                for each in laws.disagreements(name, result, other):
                    yield f"at the tightest rtol {each}"
        yield from self._inverse(random, name, body, result)

    def _result_of(self, name: str, body: Any) -> dict[str, Any] | None:
        reply = self.service.post(name, body)
        return self._checked_result(name, body, reply)

    def _inverse(self, random: Random, name: str, body: Any, result: Any) -> Iterator[str]:
        """Yield disagreements with the inverse query."""
        if name == "normal" and "indentation_depth" in body["load"] and random.random() < 0.3:
            other = self._result_of(name, body | {"load": {"normal_force": result["normal_force"]}})
            if other:
                yield from _differ("inverse", "indentation_depth", result, other)
        if name == "torsion" and "torque" in body["torsion"] and random.random() < 0.3:
            turn = {"rotation": result["rotation"]}
            other = self._result_of(name, body | {"torsion": turn})
            if other and "full_slip" not in other["regime"]:
                yield from _differ("inverse", "torque", result, other)
        given = body.get("tangential", {})
        if name == "tangential" and "tangential_force" in given and random.random() < 0.3:
            shift = {"tangential_displacement": result["tangential_displacement"]}
            other = self._result_of(name, body | {"tangential": shift})
            if other:
                yield from _differ("inverse", "tangential_force", result, other)


def _differ(label: str, quantity: str, one: Any, other: Any) -> Iterator[str]:
    a, b = np.array(one[quantity]), np.array(other[quantity])
    near = one["error_estimate"] + other["error_estimate"] + 1e-14
    if a.shape != b.shape or np.any(np.abs(a - b) > near * np.maximum(np.abs(a), np.abs(b))):
        yield f"{label}: {quantity} differs"
    elif near < 1e-9 and np.any(np.abs(a - b) > 1e-9 * np.maximum(np.abs(a), np.abs(b))):
        yield f"{label}: {quantity} differs by more than 1e-9"


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz.campaign", description=__doc__)
    parser.add_argument("--queries", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0, help="index of the first query")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--report", type=Path, help="file for the classes of failures, as JSON")
    given = parser.parse_args()
    campaign = Campaign(given.seed)
    for index in range(given.first, given.first + given.queries):
        campaign.run_query(index)
    entries = campaign.failures.entries()
    statuses = campaign.statuses
    total = sum(count for label, count in statuses.items() if len(label.split()) == 2)
    answered = sum(count for label, count in statuses.items() if label.endswith(" 200"))
    if answered < SOLVED * total:
        entries.append({"label": f"only {answered} of {total} queries have a result", "count": 1})
    if given.report:
        problem = {"statuses": statuses, "failures": entries, "slowest": campaign.slowest}
        given.report.write_text(json.dumps(problem, indent=1), "utf-8")
    for entry in entries:
        sys.stdout.write(f"{entry['count']:6} {entry['label']}\n")
    sys.stdout.write(
        f"{answered} of {total} queries with a result, {len(entries)} classes of failures\n"
    )
    sys.stdout.write(f"{dict(sorted(statuses.items()))}\nslowest: {campaign.slowest}\n")
    return 1 if entries else 0


if __name__ == "__main__":
    sys.exit(main())
