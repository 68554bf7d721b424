"""A chunk of scenes answered: grouped by what they have in common, in a table of their own."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from mdr_core.sweeps import BLOCK
from mdr_service import problems
from mdr_sweep import closed, single
from mdr_sweep.bounds import bounds
from mdr_sweep.columns import Cells, Column, Flags, Values, columns
from mdr_sweep.study import Study

Rows = NDArray[np.intp]
# Fewer scenes take longer together than one by one.
_FEW: Final = 4
_KIND: Final = "profile.kind"
_WORDS: Final = frozenset({"regime"})
WARNING, ERROR = "warning", "error"


@dataclass
class Answers:
    """The answers of all scenes of a chunk, filled group by group."""

    size: int
    names: tuple[str, ...]
    numbers: dict[str, Values] = field(default_factory=dict)
    words: dict[str, "Words"] = field(default_factory=dict)
    answered: Flags = field(init=False)

    def __post_init__(self) -> None:
        self.answered = np.zeros(self.size, dtype=bool)
        for name in (*self.names, WARNING, ERROR):
            if name in _WORDS or name in {WARNING, ERROR}:
                self.words[name] = Words(self.size)
            else:
                self.numbers[name] = np.zeros(self.size)

    @property
    def batch(self) -> pa.RecordBatch:
        """One column per answer, warnings and errors last."""
        mask = None if self.answered.all() else ~self.answered
        arrays = {
            name: self.words[name].arrow
            if name in self.words
            else pa.array(self.numbers[name], mask=mask)
            for name in (*self.names, WARNING, ERROR)
        }
        return pa.record_batch(arrays)


class Words:
    """A column of few different words, in some rows none."""

    def __init__(self, size: int) -> None:
        self.codes = np.full(size, -1, dtype=np.int32)
        self.known: dict[str, int] = {}

    def put(self, rows: Rows | slice | int, word: str | None) -> None:
        """Write a word into rows."""
        if word is not None:
            self.codes[rows] = self.known.setdefault(word, len(self.known))

    @property
    def arrow(self) -> Cells:
        """The column as text."""
        codes: Cells = pa.array(self.codes, mask=self.codes < 0)
        return pc.take(pa.array([*self.known], pa.string()), codes)


def answer(study: Study, batch: pa.RecordBatch) -> pa.RecordBatch:
    """Return the answers to a batch of scenes, in their order."""
    given = {name: one for name, one in columns(batch).items() if name not in study.kept}
    found = Answers(batch.num_rows, study.answers)
    # Blocks of the core's size: what is larger than the cache waits for the memory.
    for start in range(0, batch.num_rows, BLOCK):
        rows = np.arange(start, min(start + BLOCK, batch.num_rows))
        for group in _groups(study, given, rows):
            _answer(study, given, group, found)
    return found.batch


def _groups(study: Study, given: Mapping[str, Column], rows: Rows) -> Iterator[Rows]:
    """Yield the rows that give the same fields, and the same in all but the numbers that differ.

    First by the kind of profile, which says which of its fields those are.
    """
    if _KIND not in given:
        yield from _alike(study, given, rows, str(study.constants.get(_KIND)))
        return
    kinds = given[_KIND]
    for part in _split([kinds], rows):
        yield from _alike(study, given, part, str(kinds.odd.get(int(part[0]))))


def _alike(study: Study, given: Mapping[str, Column], rows: Rows, kind: str) -> Iterator[Rows]:
    spread = closed.together(study, kind)
    fixed, sparse = [], []
    for name, column in given.items():
        if spread and closed.spreads(kind, name):
            sparse.append(column)
        elif name != _KIND:
            fixed.append(column)
    if not spread:
        # One by one in any case.
        yield rows
        return
    presence = [Column(column.given.astype(float), column.given) for column in sparse]
    yield from _split([*fixed, *(one for one in presence if not one.given.all())], rows)


def _split(by: list[Column], rows: Rows) -> list[Rows]:
    """Split rows into those that have the same in all columns, in the order of their first."""
    if not by:
        return [rows]
    keys = np.zeros(rows.size, dtype=np.intp)
    for column in by:
        codes = _codes(column, rows)
        _, keys = np.unique(keys * (codes.max() + 1) + codes, return_inverse=True)
    order = np.argsort(keys, kind="stable")
    ends = np.flatnonzero(np.diff(keys[order])) + 1
    return sorted((rows[part] for part in np.split(order, ends)), key=lambda part: int(part[0]))


def _codes(column: Column, rows: Rows) -> NDArray[np.intp]:
    """Numbers that are the same where the column says the same."""
    if not column.odd:
        _, codes = np.unique(column.values[rows], return_inverse=True)
        return np.asarray(codes * 2 + column.given[rows])
    known: dict[str, int] = {}
    texts = (repr(column.value(row)) if column.given[row] else "" for row in map(int, rows))
    return np.array([known.setdefault(text, len(known)) for text in texts], dtype=np.intp)


def _answer(study: Study, given: Mapping[str, Column], rows: Rows, found: Answers) -> None:
    """Answer the rows of one group: at once as far as that goes, the others one by one."""
    together = rows[:0]
    if rows.size >= _FEW and closed.together(study, _kind(study, given, rows)):
        together = _checked(study, given, rows)
    left = rows
    if together.size >= _FEW:
        open_ = _at_once(study, given, together, found)
        left = np.setdiff1d(rows, together[~open_], assume_unique=True)
    for row in map(int, left):
        _put(found, row, single.answer(study, fields(study, given, row)))


def fields(study: Study, given: Mapping[str, Column], row: int) -> dict[str, Any]:
    """Return the fields of one scene."""
    own = {name: column.value(row) for name, column in given.items() if column.given[row]}
    return {**study.constants, **own}


def _kind(study: Study, given: Mapping[str, Column], rows: Rows) -> str:
    column = given.get(_KIND)
    return str(column.odd.get(int(rows[0])) if column else study.constants.get(_KIND))


def _swept(study: Study, given: Mapping[str, Column], rows: Rows) -> dict[str, Column]:
    kind = _kind(study, given, rows)
    return {
        name: column
        for name, column in given.items()
        if column.given[rows[0]] and closed.spreads(kind, name)
    }


def _checked(study: Study, given: Mapping[str, Column], rows: Rows) -> Rows:
    """Return the rows whose numbers the service takes."""
    kind = _kind(study, given, rows)
    good = np.ones(rows.size, dtype=bool)
    swept = _swept(study, given, rows)
    for name, column in swept.items():
        known = bounds(study.query, kind, name)
        if known is None:
            return rows[:0]
        good &= known.hold(column.values[rows])
        if column.odd:
            good &= ~np.isin(rows, list(column.odd))
    rows = rows[good]
    if rows.size < _FEW:
        return rows[:0]
    # The service's own models have the last word: on one scene, and on both ends of each interval.
    fixed = fields(study, given, int(rows[0]))
    for end in (_first, np.min, np.max):
        ends = {name: float(end(column.values[rows])) for name, column in swept.items()}
        try:
            single.read(study.query, fixed | ends)
        except problems.ServiceError:
            return rows[:0]
    return rows


def _first(values: Values) -> float:
    return float(values[0])


def _at_once(study: Study, given: Mapping[str, Column], rows: Rows, found: Answers) -> Flags:
    """Answer the rows by one call, and return which of them are still open."""
    query: Any = single.read(study.query, fields(study, given, int(rows[0])))
    swept = {name: one.values[rows] for name, one in _swept(study, given, rows).items()}
    told = closed.solve(query, swept, study.answers, rows.size)
    whole = rows.size == found.size
    done = ~told.open
    if not done.any():
        return told.open
    place = slice(None) if whole and done.all() else rows[done]
    part: Any = slice(None) if done.all() else done
    found.answered[place] = True
    for name, values in told.answers.items():
        if name in found.words:
            _put_words(found.words[name], rows[part], values[part])
        else:
            found.numbers[name][place] = values[part]
    _put_codes(found.words[WARNING], rows, done, told.codes)
    return told.open


def _put_words(words: Words, rows: Rows, values: NDArray[np.str_]) -> None:
    for word in _distinct(values):
        words.put(rows[values == word], word)


def _distinct(values: NDArray[np.str_]) -> list[str]:
    """The different words; nearly always there are one or two."""
    left, found = values, []
    while left.size:
        found.append(str(left[0]))
        left = left[left != left[0]]
    return found


def _put_codes(words: Words, rows: Rows, done: Flags, codes: Mapping[str, Flags]) -> None:
    """Write the codes of each scene, in their order and one after the other."""
    said = {name: flags for name, flags in codes.items() if flags.any()}
    if not said:
        return
    bits = np.zeros(rows.size, dtype=np.intp)
    for place, flags in enumerate(said.values()):
        bits |= flags.astype(np.intp) << place
    bits[~done] = 0
    for mask in np.unique(bits[bits > 0]).tolist():
        named = [name for place, name in enumerate(said) if mask >> place & 1]
        words.put(rows[bits == mask], single.coded(named))


def _put(found: Answers, row: int, told: single.Told) -> None:
    found.words[WARNING].put(row, told.warning)
    found.words[ERROR].put(row, told.error)
    if told.error is not None:
        return
    found.answered[row] = True
    for name, value in told.answers.items():
        if name in found.words:
            found.words[name].put(row, value)
        else:
            found.numbers[name][row] = value
