"""Solution of a single case, exactly as the service solves it."""

import json
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from mdr_service import problems
from mdr_service.dispatch import parse
from mdr_service.queries import QUERIES
from mdr_service.schemas.contacts import Query
from mdr_service.schemas.flat import nested
from mdr_sweep.spec import ERROR, WARNING, Spec


def solve(spec: Spec, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the quantities and warnings of the case with the given fields, or its error."""
    try:
        with np.errstate(all="ignore"):
            return _solve(spec, read(spec.query, given))
    except problems.FAILURES as error:
        failure = problems.to_problem(error)
    except Exception:  # noqa: BLE001 -- an internal error of one case must not end the sweep
        failure = problems.INTERNAL_ERROR
    listed = problems.document(failure).get("errors", ())
    message = "; ".join(f"{each['pointer']} {each['detail']}" for each in listed)
    return {ERROR: message or failure.detail}


def read(query: str, given: Mapping[str, Any]) -> Query:
    """Return the request with the given fields, validated by the model of the service.

    Raises
    ------
    InputError, ServiceError : the request is not valid.
    """
    return parse(QUERIES[query].model, json.dumps(nested(given)).encode())


def joined(codes: Iterable[str]) -> str | None:
    """Return the different codes of warnings as one text, None if there are none."""
    return " ".join(dict.fromkeys(codes)) or None


def _solve(spec: Spec, request: Query) -> dict[str, Any]:
    query = QUERIES[spec.query]
    source = query.solve(request)
    result = query.result(request, source)
    values = {
        name: result[name][0] if name in result else np.ravel(getattr(source, name))[0].item()
        for name in spec.quantities
    }
    return values | {WARNING: joined(warning["code"] for warning in result["warnings"])}
