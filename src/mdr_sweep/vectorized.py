"""Solution of a batch of cases, with one call of the core for cases that differ only in numbers.

Cases that such a call cannot solve are solved one by one.
"""

import re
from collections.abc import Iterator, Mapping
from math import nan
from typing import Any, Final

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from mdr_core import validity
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_service import problems
from mdr_service.queries import QUERIES
from mdr_service.queries.contacts import yields
from mdr_service.schemas.contacts import Query
from mdr_service.schemas.flat import nested
from mdr_sweep.request_columns import Column, Rows, Values, read_columns
from mdr_sweep.spec import ERROR, TEXTS, WARNING, Spec

Results = dict[str, NDArray[Any]]
Columns = Mapping[str, Column]
Contact = NormalContact | TangentialContact
# Queries that the core solves for arrays of profiles, moduli and loads.
_VECTORIZED: Final = frozenset({"normal", "tangential"})
# Fields whose numbers can be arrays over the cases of one call; members of lists cannot.
_ARRAYS: Final = re.compile(
    r"(profile|load|tangential)\.\w+|friction_coefficient|material\.[eg]_star"
)
# Members of a material whose contacts are solved one by one.
_ALONE: Final = {"work_of_adhesion", "layer"}


def solve(spec: Spec, batch: pa.RecordBatch) -> pa.RecordBatch:
    """Return the rows of the result: the cases, their quantities, warnings and errors."""
    columns, size = read_columns(spec, batch), batch.num_rows
    names = (*spec.quantities, WARNING, ERROR)
    results: Results = {name: np.full(size, None if name in TEXTS else np.nan) for name in names}
    solved = np.zeros(size, dtype=bool)
    if spec.query in _VECTORIZED:
        for group in _groups(columns, size):
            rows, group_results = _solve_group(spec, columns, group)
            solved[rows] = True
            for name, values in group_results.items():
                results[name][rows] = values
    for row in np.flatnonzero(~solved).tolist():
        case = _solve_alone(spec, _request(spec, columns, row))
        solved[row] = WARNING in case
        texts = [str(column.cells[row]) for column in columns.values() if column.is_unreadable(row)]
        if texts:
            # A column of numbers cannot hold these texts.
            case[ERROR] += "; read " + ", ".join(map(repr, texts))
        for name, value in case.items():
            results[name][row] = value
    found = dict(zip(batch.schema.names, batch.columns, strict=True))
    found |= {name: column.output for name, column in columns.items()}
    for name, values in results.items():
        is_text = name in TEXTS
        found[name] = pa.array(values, pa.string()) if is_text else pa.array(values, mask=~solved)
    return pa.record_batch(found)


def _is_array(name: str, column: Column) -> bool:
    """Return True if a field can be an array over the cases of one call."""
    return column.schema["type"] == "number" and _ARRAYS.fullmatch(name) is not None


def _groups(columns: Columns, size: int) -> Iterator[Rows]:
    """Yield groups of rows with equal fields, and equal values of those that are not arrays."""
    keys: list[list[Any]] = [[None] * size]
    for name, column in columns.items():
        if not _is_array(name, column):
            keys.append(list(map(repr, column.cells.to_pylist())))
        elif not column.given.all():
            keys.append(column.given.tolist())
    groups: dict[Any, list[int]] = {}
    for row, key in enumerate(zip(*keys, strict=True)):
        groups.setdefault(key, []).append(row)
    return map(np.array, groups.values())


def _request(spec: Spec, columns: Columns, row: int) -> dict[str, Any]:
    own = {name: column.value(row) for name, column in columns.items() if column.given[row]}
    return {**spec.constants, **own}


def _solve_group(spec: Spec, columns: Columns, rows: Rows) -> tuple[Rows, Results]:
    """Return the cases of a group that one call of the core solves, and their results."""
    swept = {
        name: column
        for name, column in columns.items()
        if _is_array(name, column) and column.given[rows[0]]
    }
    for column in swept.values():
        rows = rows[column.accepts(rows)]
    while rows.size:
        try:
            query = _validated(spec, _request(spec, columns, int(rows[0])))
            if query.material.model_fields_set & _ALONE:
                break
            arrays = {name: column.values[rows] for name, column in swept.items()}
            with np.errstate(all="ignore"):
                source = QUERIES[spec.query].solve(_with_arrays(query, arrays))
                solved, results = _results(spec, query, source, rows.size)
            return rows[solved], {name: values[solved] for name, values in results.items()}
        except InputError as error:
            rejected = np.ravel(error.cases)
            if rejected.shape != rows.shape or not rejected.any():
                break
            rows = rows[~rejected]
        except Exception:  # noqa: BLE001 -- each case reports its own error
            break
    return rows[:0], {}


def _with_arrays(query: Query, swept: Mapping[str, Values]) -> Query:
    """Return a valid request with arrays over the cases in the swept fields."""
    changes = {
        name: getattr(query, name).model_copy(update=part) if isinstance(part, dict) else part
        for name, part in nested(swept).items()
    }
    return query.model_copy(update=changes)


def _results(
    spec: Spec, query: Query, source: Contact, size: int
) -> tuple[NDArray[np.bool_], Results]:
    """Return the results of the cases of one call, and True for those that it solves."""
    contact = source.normal
    results: Results = {WARNING: _warnings(query, source, size)}
    # Cases with overflow or infinite pressures are solved one by one.
    solved = np.array(np.broadcast_to(np.isfinite(contact.mean_pressure), (size,)))
    for name in spec.quantities:
        values: Any = getattr(source if hasattr(type(source), name) else contact, name)
        if values is not None and name not in TEXTS:
            solved &= np.isfinite(values)
        # Profiles that are not tables have no data error.
        results[name] = np.broadcast_to(nan if values is None else values, (size,))
    return solved, results


def _warnings(query: Query, source: Contact, size: int) -> NDArray[Any]:
    """Return the codes of the warnings of each case, in the service's order."""
    found = [*validity.findings(source), *source.normal.findings]
    found += [validity.inaccurate(source.error_estimates), *yields(query, source)]
    flags = {each.code: each.where for each in found}
    codes = np.full(size, None)
    for code, where in flags.items():
        here = np.broadcast_to(where, (size,))
        codes[here] = [f"{known} {code}" if known else code for known in codes[here]]
    return codes


def _solve_alone(spec: Spec, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the quantities and warnings of the case with the given fields, or its error."""
    query = QUERIES[spec.query]
    try:
        with np.errstate(all="ignore"):
            request = _validated(spec, given)
            source = query.solve(request)
            result = query.result(request, source)
            # A row has one value: of several numbers of cycles, the last.
            values = {
                name: result[name][-1]
                if name in result
                else np.ravel(getattr(source, name, nan))[-1]
                for name in spec.quantities
            }
        codes = dict.fromkeys(warning["code"] for warning in result["warnings"])
        return values | {WARNING: " ".join(codes) or None}
    except problems.FAILURES as error:
        failure = problems.to_problem(error)
    except Exception:  # noqa: BLE001 -- an internal error of one case must not end the sweep
        failure = problems.INTERNAL_ERROR
    return {ERROR: "; ".join(map(" ".join, failure.errors)) or failure.detail}


def _validated(spec: Spec, given: Mapping[str, Any]) -> Query:
    """Return the request with the given fields; raise InputError or ValidationError."""
    return QUERIES[spec.query].request.model_validate(nested(given))
