"""One scene at a time, the way the service goes: for what cannot be answered many at once."""

import json
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from mdr_core import fields
from mdr_service import problems, solve, wire
from mdr_service.questions import QUESTIONS
from mdr_service.schemas.queries import Query
from mdr_sweep.requests import nested
from mdr_sweep.study import Study


class Told(NamedTuple):
    """What is said of one scene: its answers, or why there are none."""

    answers: Mapping[str, Any]
    warning: str | None = None
    error: str | None = None


def answer(study: Study, given: Mapping[str, Any]) -> Told:
    """Return what the service answers to one scene, or the sentence that it fails with."""
    try:
        with np.errstate(all="ignore"):
            return _answer(study, read(study.query, given))
    except problems.FAILURES as error:
        return Told({}, error=sentence(problems.told(error)))
    except Exception:  # noqa: BLE001 -- as the service would
        # A defect in one scene stops no sweep.
        return Told({}, error=sentence(problems.DEFECT))


def read(query: str, given: Mapping[str, Any]) -> Query:
    """Return the request of some fields, checked as the service checks it."""
    # What has no JSON is no number either, and is refused where it stands.
    text = json.dumps(nested(given), default=str)
    return wire.read(QUESTIONS[query].model, text.encode())


def sentence(error: problems.ServiceError) -> str:
    """Return a failure in one line: where the request is wrong, and why."""
    document = problems.document(error)
    if "errors" not in document:
        return error.detail
    return "; ".join(f"{each['pointer']} {each['detail']}" for each in document["errors"])


def _answer(study: Study, query: Query) -> Told:
    question = QUESTIONS[study.query]
    found = question.solve(query)
    # The answers of wear come with its fields.
    result = getattr(found, "result", found)
    parts = (result, getattr(result, "normal", result))
    plain = [name for name in study.answers if name not in study.largest]
    answers = {name: _one(getattr(_of(parts, name), name)) for name in plain}
    said = (notice.code for notice in solve.notices(query, result))
    # What is infinite before any wear is none of the answers of wear.
    codes = [code for code in said if study.query != "wear" or code != "singular"]
    if not all(isinstance(one, str) or np.isfinite(one) for one in answers.values()):
        # A true infinity, or a number that no double holds: the document knows.
        document = question.document(query, found)
        answers = {name: document[name][0] for name in plain}
        codes = [notice["code"] for notice in document["warnings"]]
    # Infinite under tips, kinks and edges, as the warning `plastic` says.
    answers |= {name: _one(largest(name, result, query.rtol)) for name in study.largest}
    return Told(answers, coded(codes))


def largest(name: str, result: Any, rtol: float) -> Any:
    """Return the largest value of a field of a contact, with friction or without."""
    if name == "maximum_shear_stress":
        return fields.largest_shear_stress(result, rtol=rtol)
    return fields.largest_pressure(getattr(result, "normal", result), rtol=rtol)


def coded(codes: list[str]) -> str | None:
    """Return the codes of warnings in one word each."""
    return " ".join(dict.fromkeys(codes)) or None


def _of(parts: tuple[Any, Any], name: str) -> Any:
    """The contact with friction where it knows the answer, else the normal contact."""
    return next(part for part in parts if hasattr(type(part), name))


def _one(value: Any) -> Any:
    return np.ravel(value)[0].item()
