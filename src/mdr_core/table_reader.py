"""Profiles and curves in files, as instruments and spreadsheets write them."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from mdr_core.doubles import TINY
from mdr_core.errors import InputError
from mdr_core.table_headings import (
    CURVE,
    HEADS,
    MEASURES,
    PROFILE,
    UNITS,
    Title,
    cells_of,
    known_units,
    places_of,
    refuse,
    segments_of,
    time_of,
    titles_of,
    unit_of,
)
from mdr_core.typing import Array
from mdr_core.validation import require_type

_AREAS: Final = {"area", "a", "section", "areas", "fläche", "kontaktfläche", "aire"}
_POINT: Final = re.compile(r"(?ai)[-+]?(\d+\.?\d*|\.\d+)([ed][-+]?\d+)?")
_COMMA: Final = re.compile(r"(?ai)[-+]?(\d+,?\d*|,\d+)([ed][-+]?\d+)?")
# Separator of columns, and the form of a number. Blanks, or a comma and a blank, separate numbers
# with a decimal comma before commas separate columns: `0,5 1,2` holds two numbers.
_DIALECTS: Final = (
    *((separator, form) for separator in "\t;" for form in (_POINT, _COMMA)),
    *((" ", _COMMA), (",", _POINT), (" ", _POINT)),
)
# Signs of one meaning, marks of comments, comments behind numbers, and repeated blanks.
_REPLACED: Final = (
    ("\r\n?", "\n"),
    ("−", "-"),
    ("μ", "µ"),
    ("\xa0", " "),
    (r"(?m)^[^\S\n]*(#|%|!|//)+", "#"),
    (r"[^\S\n][#!].*", ""),
    (" {2,}", " "),
)
# Any number, with whatever decimal sign.
_NUMBERLIKE: Final = re.compile(r"(?ai)[-+]?[\d.,]*\d[.,]?([ed][-+]?\d+)?")
_DECIMAL: Final = str.maketrans(",dD", ".ee")
# Number of a line, and its cells.
_Row = tuple[int, list[str]]
# Bytes of the longest file, some 10^5 points: more take seconds.
_LARGEST: Final = 4_000_000
# Height over radius, as written, above which columns without names may be h and A(h): A(h)/h of a
# tip in nanometres is in the hundreds, f/r of a ball in micrometres over millimetres is 10.
_STEEPEST: Final = 30.0


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
    """Kind of the segment of each point, None without a column of segments."""


class ParsedFile(NamedTuple):
    """Columns of a file, and the two lists that are taken."""

    titles: list[Title]
    taken: dict[int, str]
    """Quantity of the two columns by their index: radius or area, and height; depth and force."""
    values: list[list[float]]
    """Numbers as written, of an area r = (A/pi)^(1/2)."""
    lines: list[int]
    """Line of each point."""
    time: list[float] | None = None
    """Times of a curve from its first point [s], of a non-decreasing column with a unit."""
    segments: list[str] | None = None
    """Kind of the segment of each point of a curve, if a column names it."""


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
    file : see `read_table`; columns of depth and force, or distance and load.
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
    time = None if table.time is None else np.array(table.time)
    depth, force = _in_units(table, CURVE, units, (1.0, 1.0))
    return MeasuredCurve(depth, force, time, table.segments)


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
    columns = zip(table.taken.items(), table.values, given, to, kind, strict=True)
    for (place, _), values, unit, target, wanted in columns:
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
        lists.append(np.array([float(f"{each * (known[2] / target):.15g}") for each in values]))
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
        # As older instruments write it.
        return content.decode("cp1252", errors="replace")


def parse(content: bytes, kind: Sequence[str], columns: Sequence[int] | None = None) -> ParsedFile:
    """Return the table of a file, a `PROFILE` or a `CURVE`, as it is written, or an InputError.

    `columns` are the numbers of the two columns, from 1, if the headings do not identify them.
    """
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
            titles = titles_of(heading, separator, max(len(cells) for _, cells in rows), kind)
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
    lines = re.sub('"([^"\n]*)"', unquoted, text).split("\n")
    return [
        (number, line.startswith("#"), line.lstrip("#").strip(" ").rstrip(" \t;,"))
        for number, line in enumerate(lines, 1)
    ]


def _numbers(cells: Sequence[str], form: re.Pattern[str]) -> list[int]:
    """Return the indices of two or more numbers; none beside one with another decimal sign."""
    found = [i for i, cell in enumerate(cells) if form.fullmatch(cell)]
    if len(found) < len(cells) and any(
        _NUMBERLIKE.fullmatch(cell) for i, cell in enumerate(cells) if i not in found
    ):
        return []
    return found if len(found) > 1 else []


def _rows(
    lines: Sequence[tuple[int, bool, str]],
    separator: str,
    form: re.Pattern[str],
    columns: list[int],
) -> tuple[list[_Row], list[tuple[int, str]], InputError | None]:
    """Return rows of numbers and words, the heading above, and the error at a line that is neither.

    Parameters
    ----------
    columns : indices of the numbers in each row; empty for those in the first row.
    """
    rows: list[_Row] = []
    heading = []
    for number, comment, text in lines:
        if comment or not text:
            heading += [] if rows else [(number, text)]
            continue
        cells = cells_of(text, separator)
        found = _numbers(cells, form)
        if found and found == (columns or found):
            columns = found
            rows.append((number, cells))
        elif rows or form.fullmatch(cells[0]):
            count = len(columns) or max(len(cells), 2)
            return rows, heading, refuse(number, f"{count} numbers are expected")
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
    first, cells = rows[0]
    numeric = [i for i, cell in enumerate(cells) if _NUMBERLIKE.fullmatch(cell)]
    doubtful = separator == "," and len(cells) > 2 and not any(each.name for each in titles)
    if doubtful and all(re.fullmatch(r"[-+]?\d+", row[i]) for _, row in rows for i in numeric):
        detail = "a comma may separate columns or decimals; separate columns by ; or tabs"
        raise refuse(first, detail)
    if wrong := [number for number in columns or () if number - 1 not in numeric]:
        raise refuse(first, f"column {wrong[0]} holds no numbers")
    places = [number - 1 for number in columns or ()] or places_of(titles, numeric, kind, first)
    taken, values = {}, []
    for i, wanted in zip(places, kind, strict=True):
        title = titles[i]
        is_area = wanted == "radius" and _is_area(title)
        taken[i] = quantity = "area" if is_area else wanted
        if title.unknown or (title.unit and title.unit[0] != MEASURES[quantity]):
            measure, unit, _ = title.unit or ("", "", 0.0)
            unknown = title.unknown or f"the unit {unit}{'²' * (measure == 'area')}"
            raise refuse(title.line, f"{unknown} is none of {known_units(quantity)}")
        numbers = _column(rows, i)
        for bad, detail in (
            (~np.isfinite(numbers), "a number is too large"),
            (numbers < (0 if is_area else -np.inf), "an area is negative"),
        ):
            if bad.any():
                raise refuse(rows[int(np.argmax(bad))][0], detail)
        values.append((np.sqrt(numbers / np.pi) if is_area else numbers).tolist())
    if kind == PROFILE and not columns and not any(titles[i].name or titles[i].unit for i in taken):
        rise = np.ptp(values[1]) / max(np.abs(values[0]).max(), TINY)
        if rise > _STEEPEST:
            detail = (
                f"the second column rises {rise:.3g} times as much as the first: name the columns "
                "in a line above, as r [mm];f [µm] for a profile or h [nm];A [nm²] for areas"
            )
            raise refuse(first, detail)
    table = ParsedFile(titles, taken, values, [line for line, _ in rows])
    if kind == PROFILE:
        return table
    others = [i for i in numeric if i not in taken]
    segments = segments_of([cells for _, cells in rows], numeric)
    return table._replace(time=_time(rows, titles, others), segments=segments)


def _is_area(title: Title) -> bool:
    """Return whether a column is an area, by its name or its unit; r² in mm² is none."""
    words = re.split(r"[\W\d_]+", title.name.lower())
    measured = title.unit is not None and title.unit[0] == "area"
    return bool(_AREAS & set(words)) or (measured and not re.match("[rx]", words[0]))


def _column(rows: Sequence[_Row], i: int) -> Array:
    column = " ".join(row[i] for _, row in rows).translate(_DECIMAL)
    return np.array([float(each) for each in column.split()])


def _time(rows: Sequence[_Row], titles: list[Title], numeric: list[int]) -> list[float] | None:
    place = time_of(titles, numeric)
    if place is None or not (unit := titles[place].unit):
        return None
    times = _column(rows, place)
    rises = np.isfinite(times).all() and np.all(np.diff(times) >= 0)
    return ((times - times[0]) * unit[2]).tolist() if rises else None
