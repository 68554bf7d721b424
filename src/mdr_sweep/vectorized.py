"""Solution of a batch of cases, with one call of the core for cases that differ only in numbers.

Cases that such a call cannot solve are solved one by one.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import nan
from typing import Any, Final

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from mdr_core import normal, tangential, validity
from mdr_core.errors import InputError
from mdr_core.normal import ACCURACY, NormalContact
from mdr_core.profiles import KINDS
from mdr_core.tangential import TangentialContact
from mdr_service import problems
from mdr_service.queries import QUERIES
from mdr_service.queries.contacts import body, control, friction, yields
from mdr_service.schemas.contacts import NormalQuery, Query, TangentialQuery
from mdr_service.schemas.flat import nested
from mdr_sweep.request_columns import Column, Values, read_columns
from mdr_sweep.spec import ERROR, TEXTS, WARNING, Spec

Rows = NDArray[np.intp]
Results = dict[str, NDArray[Any]]
Columns = Mapping[str, Column]
# Queries that the core solves for arrays of profiles, moduli and loads.
_VECTORIZED: Final = frozenset({"normal", "tangential"})
# Fields, or groups of fields, whose numbers can be arrays over the cases.
_ARRAYS: Final = (
    *("profile.", "load.", "tangential.", "friction_coefficient"),
    *("material.e_star", "material.g_star"),
)


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
            # The column of the result has no place for them.
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
    in_list = name.startswith(("profile.terms.", "profile.radii."))
    return column.field.type == "number" and name.startswith(_ARRAYS) and not in_list


def _groups(columns: Columns, size: int) -> Iterator[Rows]:
    """Yield groups of rows with equal fields, and equal values of those that are not arrays."""
    keys: dict[str, Any] = {}
    for name, column in columns.items():
        if not _is_array(name, column):
            is_list = column.field.type == "array"
            keys[name] = list(map(repr, column.cells.to_pylist())) if is_list else column.cells
        elif not column.given.all():
            keys[name] = column.given
    rows = np.arange(size)
    if not keys:
        yield rows
        return
    grouped = pa.table({**keys, "row": rows}).group_by([*keys], use_threads=False)
    for group in grouped.aggregate([("row", "list")])["row_list"]:
        yield np.array(group.as_py())


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
        rows = rows[column.field.accepts(column.values[rows])]
    while rows.size:
        try:
            query: Any = _validated(spec, _request(spec, columns, int(rows[0])))
            if query.material.has("work_of_adhesion"):
                break
            arrays = {name: column.values[rows] for name, column in swept.items()}
            with np.errstate(all="ignore"):
                solved, results = _call(spec, query, arrays, rows.size)
            return rows[solved], {name: values[solved] for name, values in results.items()}
        except InputError as error:
            rejected = np.ravel(np.asarray(True if error.cases is None else error.cases))
            if rejected.shape != rows.shape or not rejected.any():
                break
            rows = rows[~rejected]
        except Exception:  # noqa: BLE001 -- each case reports its own error
            break
    return rows[:0], {}


def _call(
    spec: Spec, query: NormalQuery, swept: Mapping[str, Values], size: int
) -> tuple[NDArray[np.bool_], Results]:
    """Solve the cases that differ from a valid request in the `swept` fields only."""
    given: dict[str, Any] = {name.rpartition(".")[2]: values for name, values in swept.items()}
    if any(name.startswith("profile.") for name in swept):
        kind: Any = KINDS[query.profile.kind]
        names = kind.__match_args__
        given["profile"] = kind(*(given.get(name, getattr(query.profile, name)) for name in names))

    moduli = {name: given.pop(name) for name in ("e_star", "g_star") if name in given}
    if moduli:
        given |= dict.fromkeys(("e_star", "g_star"), replace(query.material.effective, **moduli))

    def with_arrays(constants: dict[str, Any]) -> dict[str, Any]:
        return {name: given.get(name, value) for name, value in constants.items()}

    contact = normal.solve(**with_arrays(body(query) | control(query.load)))
    source: NormalContact | TangentialContact = contact
    if isinstance(query, TangentialQuery):
        source = tangential.solve(
            contact, **with_arrays(friction(query) | control(query.tangential))
        )
    results: Results = {WARNING: _warnings(query, source, size)}
    # Cases with overflow or infinite pressures are solved one by one.
    solved = np.array(np.broadcast_to(np.isfinite(contact.mean_pressure), (size,)))
    for name in spec.quantities:
        values: Any = getattr(source if hasattr(type(source), name) else contact, name)
        if values is None:
            # These profiles have no data error.
            values = nan
        elif name not in TEXTS:
            solved &= np.isfinite(values)
        results[name] = np.broadcast_to(values, (size,))
    return solved, results


def _warnings(
    query: NormalQuery, source: NormalContact | TangentialContact, size: int
) -> NDArray[Any]:
    """Return the codes of the warnings of each case, in the service's order."""
    contact = source.normal
    flags: dict[str, Any] = {each.code: each.where for each in validity.findings(source)}
    flags |= {each.code: each.where for each in contact.findings}
    flags["accuracy"] = source.error_estimates > ACCURACY
    flags |= {each.code: each.where for each in yields(query, source)}
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
            # The last: of several numbers of cycles only the end of wear has a place in the row.
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
