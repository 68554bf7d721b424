"""Batches of bank records, in a module of their own because charts need no pytest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


def batched(cases: Iterable[Mapping[str, Any]]) -> pytest.MarkDecorator:
    """Parametrize a test by batches of records, one per kind of profile and control."""
    batches: dict[str, list[Mapping[str, Any]]] = {}
    for case in cases:
        name = "-".join(filter(None, (case["profile"]["kind"], case.get("control"))))
        batches.setdefault(name, []).append(case)
    return pytest.mark.parametrize("cases", list(batches.values()), ids=list(batches))
