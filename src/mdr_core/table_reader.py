"""Profiles and curves in files, as instruments and spreadsheets write them."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from mdr_core.curve_segments import BRANCHES
from mdr_core.doubles import TINY
from mdr_core.errors import InputError
from mdr_core.table_headings import (
    CURVE,
    HEADS,
    MEASURES,
    PROFILE,
    UNITS,
    Title,
    best_of,
    cells_of,
    known_units,
    places_of,
    refuse,
    segments_of,
    titles_of,
    unit_of,
    words_of,
)
from mdr_core.typing import Array
from mdr_core.validation import require_type

# An `A` is an area, an `a` is not.
_AREAS: Final = {"A", "area", "section", "areas", "fläche", "kontaktfläche", "aire"}
_POINT: Final = re.compile(r"(?ai)[-+]?(\d+\.?\d*|\.\d+)([ed][-+]?\d+)?")
_COMMA: Final = re.compile(r"(?ai)[-+]?(\d+,?\d*|,\d+)([ed][-+]?\d+)?")
# Separator of columns, and the form of a number, in the order of trial. Numbers with a decimal
# comma come before columns separated by commas: `0,5 1,2` holds two numbers.
_DIALECTS: Final = (
    *((separator, form) for separator in "\t;" for form in (_POINT, _COMMA)),
    *((" ", _COMMA), (",", _POINT), (" ", _POINT)),
)
# Variants of a sign, marks of comments, comments after numbers, and repeated blanks. In `%;N` the
# percent sign is a unit.
_REPLACED: Final = (
    ("\r\n?", "\n"),
    ("−", "-"),
    ("μ", "µ"),
    (r"[^\S\n\t]", " "),
    (r"(?m)^[^\S\n]*(#|%(?!;)|!|//)+", "#"),
    (r"[^\S\n][#!].*", ""),
    (" {2,}", " "),
)
# Any number but a date, with whatever decimal sign, or parts of two: 1.234,5;0,5 has no column 5;0.
_NUMBERLIKE: Final = re.compile(r"(?ai)(?!\d+\.\d\d?\.\d)[-+]?[\d.,;]*\d[.,]?([ed][-+]?\d+)?")
_DECIMAL: Final = str.maketrans(",dD", ".ee")
# Quoted number with commas between thousands: in its column "3,000" is 3000, not 3.
_THOUSANDS: Final = re.compile(r'" *[-+]?\d{1,3}(,\d{3})*,\d{3}(\.\d*|,\d{3}) *"')
# Between commas "3,000" may be either, unless a number such as "0,5" shows a decimal comma.
_EITHER: Final = re.compile(r'(?m)(?:^|,) *"[-+]?[1-9]\d{0,2},\d{3}" *(?:,|$)')
_DECIMALS: Final = re.compile(r'"[-+]?(?![1-9]\d{0,2},\d{3}")\d*,\d*"')
# Comment that names the segment of the rows beneath it, in files of JPK.
_SEGMENT: Final = re.compile(r"segment: *(\w+)$")
# Bytes of the longest file, about 10^5 points; longer files take seconds.
_LARGEST: Final = 4_000_000
# Height over radius, as written, above which columns without names may be h and A(h): A(h)/h of a
# tip in nanometres is in the hundreds, f/r of a ball in micrometres over millimetres is 10.
_STEEPEST: Final = 30.0


class _Row(NamedTuple):
    line: int
    cells: list[str]
    segment: str
    """Name of the segment in the last comment of one."""


class Points(NamedTuple):
    """Points of a measured profile."""

    r: Array
    """Radii [length]."""
    f: Array
    """Heights [length]."""


class MeasuredCurve(NamedTuple):
    """Measured forces over depths."""

    indentation_depth: Array
    """Depths in the order of the file [length]."""
    normal_force: Array
    """Forces [force]."""
    time: Array | None = None
    """Times from the first point [s], None without a column of them."""
    segments: list[str] | None = None
    """Kind of the segment of each point, None unless the file names it."""
    is_reversed: bool = False
    """True if the depths are the negative of a separation, which falls towards the sample."""


class ParsedFile(NamedTuple):
    """Columns of a file, and the two lists that are taken."""

    titles: list[Title]
    taken: dict[str, list[int]]
    """Indices of the columns of radius or area, and height; of depth and force."""
    values: list[Array]
    """Numbers as written, of an area r = (A/pi)^(1/2), of a separation its negative."""
    lines: list[int]
    """Line of each point."""
    time: Array | None = None
    """Times of a curve from its first point [s], of a non-decreasing column with a unit."""
    segments: list[str] | None = None
    """Kind of the segment of each point of a curve, if the file names it."""

    @property
    def is_reversed(self) -> bool:
        """True if the depths are the negative of a column that falls towards the sample."""
        return any(self.titles[i].falls for i in self.taken.get("depth", ()))


def read_table(
    file: str | Path, length_unit: str | Sequence[str] | None = None, *, to: str = "m"
) -> Points:
    r"""Return the radii and heights of a table in a file, in metres or the unit `to`.

    The file may have decimal commas, any separator, headings, a row of units, comments, quotes and
    further columns. A column named A or area, in place of the radii, holds the cross-sections A(h)
    of a tip: the radii are sqrt(A/pi). Two columns without a heading are radii and heights, unless
    they are so steep that they may be heights and areas.

    Parameters
    ----------
    file : file in UTF-8, UTF-16 or Windows-1252.
    length_unit : unit of radii and heights, or of each, such as mm or um; needed where no heading
        names it.
    to : unit of the result: m for SI units, mm with N and MPa.

    Raises
    ------
    InputError : the file holds no such table, with the line, or its unit is missing or in doubt.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "tip.csv")
    ...     _ = file.write_text("r [mm];f [um]\n0;0\n0,1;0,5\n0,2;2\n", "utf-8")
    ...     read_table(file)
    Points(r=array([0.    , 0.0001, 0.0002]), f=array([0.e+00, 5.e-07, 2.e-06]))
    """
    given = (length_unit, length_unit) if isinstance(length_unit, str) else length_unit
    table = _parsed(file, PROFILE)
    return Points(*_in_units(table, PROFILE, given or (None, None), (metres(to), metres(to))))


def read_curve(file: str | Path, units: Sequence[str | None] = (None, None)) -> MeasuredCurve:
    r"""Return the depths and forces of a curve in a file, in metres and newtons.

    Parameters
    ----------
    file : see `read_table`; columns of depth and force, or distance and load. Tip-sample
        separations become depths by a change of sign. Two columns of each quantity, on
        approach and on retraction, are two segments in succession.
    units : units of depth and force, where no heading names them.

    Raises
    ------
    InputError : the file holds no such curve, with the line, or a unit is missing or in doubt.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "curve.csv")
    ...     _ = file.write_text("load_micro_N,depth_nm\n0,0\n2,10\n5,20\n", "utf-8")
    ...     read_curve(file).normal_force
    array([0.e+00, 2.e-06, 5.e-06])
    """
    table = _parsed(file, CURVE)
    depth, force = _in_units(table, CURVE, units, (1.0, 1.0))
    return MeasuredCurve(depth, force, table.time, table.segments, table.is_reversed)


def metres(name: str) -> float:
    """Return a unit of length in metres."""
    quantity, _, scale = unit_of(name) or ("", "", 0.0)
    if quantity == "length":
        return scale
    raise InputError(("length_unit",), f"{name} is none of {', '.join(UNITS)}")


def _parsed(file: str | Path, kind: Sequence[str]) -> ParsedFile:
    require_type("file", file, str | Path, "the name of a file")
    with Path(file).open("rb") as stream:
        return parse(stream.read(_LARGEST + 1), kind)


def _in_units(
    table: ParsedFile, kind: Sequence[str], given: Sequence[str | None], to: Sequence[float]
) -> list[Array]:
    member, lists = ("length_unit" if kind == PROFILE else "units",), []
    columns = zip(table.taken.values(), table.values, given, to, kind, strict=True)
    for (place, *_), values, unit, target, wanted in columns:
        heading, known = table.titles[place].unit, unit_of(unit or "")
        if unit and (not known or known[0] != MEASURES[wanted]):
            raise InputError(member, f"{unit} is none of {known_units(wanted)}")
        if known and heading and known[1:] != heading[1:]:
            detail = f"is {heading[1]} in the heading of {HEADS[wanted]}, and not {unit}"
            raise InputError(member, detail)
        if not (known := known or heading):
            detail = f"is required: no heading names the unit of {HEADS[wanted]}"
            raise InputError(member, detail)
        # The product of a decimal number and a power of ten, without its rounding error.
        numbers = (values * (known[2] / target)).tolist()
        lists.append(np.array([float(f"{each:.15g}") for each in numbers]))
    return lists


def _decoded(content: bytes) -> str:
    if len(content) > _LARGEST:
        raise InputError(("table",), f"longer than {_LARGEST} bytes: reduce the number of points")
    if content.startswith((b"PK\x03\x04", b"\xd0\xcf\x11\xe0")):
        raise InputError(("table",), "is a workbook: save its sheet as CSV, and read that")
    wide = content.startswith((b"\xff\xfe", b"\xfe\xff"))
    try:
        return content.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError:
        # Older instruments write this encoding.
        return content.decode("cp1252", errors="replace")


def parse(content: bytes, kind: Sequence[str], columns: Sequence[int] | None = None) -> ParsedFile:
    """Return the table of a file, a `PROFILE` or a `CURVE`, as it is written, or an InputError.

    `columns` are the numbers of the two columns, from 1, if the headings do not identify them.
    """
    if columns and columns[0] == columns[1]:
        raise InputError(("columns",), "must be two different columns")
    lines = _lines(_decoded(content))
    last = next((text for _, comment, text in reversed(lines) if text and not comment), "")
    expected = f"no line holds two numbers, a {kind[0]} and a {kind[1]}"
    errors = [(0, InputError(("table",), expected))]
    # A table goes on to the last line: the dialects in which that line is a row come first.
    numbers = {dialect: _numbers(cells_of(last, dialect[0]), dialect[1]) for dialect in _DIALECTS}
    for separator, form in sorted(_DIALECTS, key=lambda dialect: not numbers[dialect]):
        rows, heading, error = _rows(lines, separator, form, numbers[separator, form])
        if error:
            errors.append((len(rows), error))
        elif rows:
            count = max(len(row.cells) for row in rows)
            titles = titles_of(heading, separator, count, kind)
            # A comment that gives columns other names or units begins another table.
            within = {text: i for i, comment, text in lines if comment and i > rows[0].line}
            comments = [(i, text) for text, i in within.items()]
            again = titles_of([*comments, (0, "")], separator, count, kind)
            for old, new in zip(titles, again, strict=True):
                is_same = new.name in {"", old.name} and new.unit == old.unit
                if new.line and new.unit and not is_same:
                    raise refuse(new.line, "the columns change: put each table in its own file")
            return _table(rows, titles, separator, kind, columns)
    # The dialect in which most lines are numbers is probably the intended one.
    raise max(errors[1:] or errors, key=lambda each: each[0])[1]


def _lines(text: str) -> list[tuple[int, bool, str]]:
    """Return the number of each line, whether it is a comment, and what it holds.

    Marks of comments, quotes and repeated blanks are left out.
    """

    def unquoted(quoted: re.Match[str]) -> str:
        # A comma within quotes is a decimal comma, or part of a name.
        decimal = re.fullmatch(_COMMA, quoted[1].strip())
        return re.sub("[,;]", "." if decimal else " ", quoted[1])

    for pattern, replaced in _REPLACED:
        text = re.sub(pattern, replaced, text)
    either = None if _DECIMALS.search(text) else _EITHER.search(text)
    if grouped := _THOUSANDS.search(text) or either:
        line = text.count("\n", 0, grouped.start()) + 1
        detail = "a comma may stand before thousands: write 1000, and a decimal point"
        raise refuse(line, detail)
    lines = re.sub('"([^"\n]*)"', unquoted, text).split("\n")
    return [
        (number, line.startswith("#"), line.lstrip("#").strip(" ").rstrip(" \t;,"))
        for number, line in enumerate(lines, 1)
    ]


def _numbers(cells: Sequence[str], form: re.Pattern[str]) -> list[int]:
    """Return the indices of at least two numbers; none if a number has another decimal sign."""
    found = [i for i, cell in enumerate(cells) if form.fullmatch(cell)]
    if len(found) < len(cells) and any(
        _NUMBERLIKE.fullmatch(cell) for i, cell in enumerate(cells) if i not in found
    ):
        return []
    return found if len(found) > 1 else []


def _are_numberlike(cells: Sequence[str], columns: Sequence[int]) -> bool:
    """Return True if the columns, or all cells, are numbers: a row with another decimal sign."""
    places = columns or range(len(cells))
    return all(i < len(cells) and _NUMBERLIKE.fullmatch(cells[i]) for i in places)


def _rows(
    lines: Sequence[tuple[int, bool, str]],
    separator: str,
    form: re.Pattern[str],
    columns: list[int],
) -> tuple[list[_Row], list[tuple[int, str]], InputError | None]:
    """Return rows of numbers and words, the heading above, and the error at a line that is neither.

    Parameters
    ----------
    columns : indices of the numbers in each row; empty to take them from the first row.
    """
    rows: list[_Row] = []
    heading, segment = [], ""
    for number, comment, text in lines:
        if comment or not text:
            segment = named[1] if (named := _SEGMENT.match(text)) else segment
            heading += [] if rows or named else [(number, text)]
            continue
        cells = cells_of(text, separator)
        found = _numbers(cells, form)
        if found and found == (columns or found):
            columns = found
            rows.append(_Row(number, cells, segment))
        elif rows or form.fullmatch(cells[0]) or _are_numberlike(cells, columns):
            if found and not rows:
                # The last line is no row of the table: find the line where the table ends.
                return _rows(lines, separator, form, [])
            count = len(columns) or max(len(cells), 2)
            detail = "numbers are expected: correct the line, put # before it, or start a new file"
            return rows, heading, refuse(number, f"{count} {detail}")
        else:
            heading.append((number, text))
    return rows, heading, None


def _table(
    rows: Sequence[_Row],
    titles: list[Title],
    separator: str,
    kind: Sequence[str],
    columns: Sequence[int] | None,
) -> ParsedFile:
    first, cells, _ = rows[0]
    numeric = [i for i, cell in enumerate(cells) if _NUMBERLIKE.fullmatch(cell)]
    doubtful = separator == "," and len(cells) > 2 and not any(each.name for each in titles)
    if doubtful and all(re.fullmatch(r"[-+]?\d+", row.cells[i]) for row in rows for i in numeric):
        detail = "a comma may separate columns or decimals; separate columns by ; or tabs"
        raise refuse(first, detail)
    if wrong := [number for number in columns or () if number - 1 not in numeric]:
        raise refuse(first, f"column {wrong[0]} holds no numbers")
    places = [[number - 1] for number in columns or ()] or places_of(titles, numeric, kind, first)
    table = _taken(rows, titles, places, kind)
    if kind == PROFILE:
        if not columns:
            _require_profile(table)
        return table
    if len(places[0]) > 1:
        return table._replace(segments=[each for each in BRANCHES for _ in rows])
    words = [i for i in range(len(cells)) if i not in numeric]
    texts = [[row.cells[i] if i < len(row.cells) else "" for row in rows] for i in words]
    segments = segments_of([*texts, [row.segment for row in rows]])
    return table._replace(time=_time(rows, titles, numeric), segments=segments)


def _taken(
    rows: Sequence[_Row], titles: list[Title], places: Sequence[list[int]], kind: Sequence[str]
) -> ParsedFile:
    """Return the table with the numbers of the columns at the places, see `places_of`."""
    taken: dict[str, list[int]] = {}
    values = []
    lines = [row.line for row in rows] * len(places[0])
    for columns, wanted in zip(places, kind, strict=True):
        title = titles[columns[0]]
        is_area = wanted == "radius" and _is_area(title)
        quantity = "area" if is_area else wanted
        taken[quantity] = columns
        if title.unknown or (title.unit and title.unit[0] != MEASURES[quantity]):
            measure, unit, _ = title.unit or ("", "", 0.0)
            unknown = title.unknown or f"the unit {unit}{'²' * (measure == 'area')}"
            raise refuse(title.line, f"{unknown} is none of {known_units(quantity)}")
        numbers = np.concatenate([_column(rows, i) for i in columns])
        for bad, detail in (
            (~np.isfinite(numbers), "a number is too large"),
            (numbers < (0 if is_area else -np.inf), "an area is negative"),
        ):
            if bad.any():
                raise refuse(lines[int(np.argmax(bad))], detail)
        if wanted == "depth" and title.falls:
            numbers = 0.0 - numbers
        values.append(np.sqrt(numbers / np.pi) if is_area else numbers)
    return ParsedFile(titles, taken, values, lines)


def _require_profile(table: ParsedFile) -> None:
    """Raise InputError if an `a` has no unit, or columns without names may be h and A(h)."""
    titles = [table.titles[i] for (i,) in table.taken.values()]
    if titles[0].name == "a" and not titles[0].unit:
        detail = "a may be a radius or an area: name it r or A, or give its unit"
        raise refuse(titles[0].line, detail)
    if any(title.name or title.unit for title in titles):
        return
    rise = np.ptp(table.values[1]) / max(np.abs(table.values[0]).max(), TINY)
    if rise > _STEEPEST:
        detail = (
            f"the second column rises {rise:.3g} times as much as the first: name the columns "
            "in a line above, as r [mm];f [µm] for a profile or h [nm];A [nm²] for areas"
        )
        raise refuse(table.lines[0], detail)


def _is_area(title: Title) -> bool:
    """Return whether a column is an area, by its name or its unit; r² in mm² is not."""
    measured = title.unit is not None and title.unit[0] == "area"
    is_radius = title.name.lower().startswith(("r", "x"))
    words = {*title.words, *words_of(title.name)}
    return not _AREAS.isdisjoint(words) or (measured and not is_radius)


def _column(rows: Sequence[_Row], i: int) -> Array:
    column = " ".join(row.cells[i] for row in rows).translate(_DECIMAL)
    return np.array([float(each) for each in column.split()])


def _time(rows: Sequence[_Row], titles: list[Title], numeric: list[int]) -> Array | None:
    for i in best_of(titles, [i for i in numeric if titles[i].unit], "time")[:1]:
        times, (_, _, scale) = _column(rows, i), titles[i].unit or ("", "", 1.0)
        if np.isfinite(times).all() and np.all(np.diff(times) >= 0):
            return (times - times[0]) * scale
    return None
