"""Tables of a profile as instruments and spreadsheets write them.

The explorer reads the same files by `table_reader.js`; `tests/data/tables` holds examples for both.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from mdr_core.errors import InputError
from mdr_core.typing import Array
from mdr_core.validation import require_type

UNITS: Final = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9}
"""Units of length that are read, in metres."""

_UNIT_NAMES: Final = {
    "m": r"(?i)m|met(er|re)s?",
    "mm": r"(?i)mm|millimet(er|re)s?",
    "µm": r"(?i)[uµμ]m|microns?|micromet(er|re)s?",
    "nm": r"(?i)nm|nanomet(er|re)s?",
}
# Names of the radius and of the height, those that leave no doubt first.
_COLUMN_NAMES: Final = [
    [rf"(?i)(?<![a-z])({words})(?![a-z])" for words in names]
    for names in (
        ("r|radius|radial|rho", "x|distance|position|lateral"),
        ("f|z|h|hc|height|depth|profile", "y"),
    )
]
# Name and unit of the cross-section in a table of a tip's area function.
_AREA: Final = r"(?<![A-Za-z])(A|[Aa]reas?|[Ss]ection)(?![A-Za-z])"
_SQUARE: Final = r"(²|\^2|\*\*2|(?<=m)2)$"
_POINT: Final = r"(?i)[-+]?(\d+\.?\d*|\.\d+)([ed][-+]?\d+)?"
_COMMA: Final = r"(?i)[-+]?(\d+,?\d*|,\d+)([ed][-+]?\d+)?"
_BLANKS: Final = r",?\s+"
# Separator of columns, and the form of a number. Blanks separate numbers with a decimal comma
# before commas separate columns: `0,5 1,2` holds two numbers.
_DIALECTS: Final = (
    *((separator, form) for separator in "\t;" for form in (_POINT, _COMMA)),
    *((_BLANKS, _COMMA), (",", _POINT), (_BLANKS, _POINT)),
)
_COMMENT: Final = r"\s*(#|%|!|//)+"

# Bytes of the longest file, some 10^5 points: more take seconds.
_LARGEST: Final = 4_000_000

# Number of a line, and its cells.
_Row = tuple[int, list[str]]


class Points(NamedTuple):
    """Points of a measured profile."""

    r: Array
    """Radii [length]."""
    f: Array
    """Heights [length]."""


def read_table(
    file: str | Path, length_unit: str | Sequence[str] | None = None, *, to: str = "m"
) -> Points:
    r"""Return the radii and heights of a table in a file, in metres or the unit `to`.

    The file may have decimal commas, any separator, headings, a row of units, comments, quotes and
    further columns, which are named in a heading. A column named A or area, in place of the radii,
    holds the cross-sections A(h) of a tip: the radii are sqrt(A/pi).

    Parameters
    ----------
    file : file in UTF-8, UTF-16 or Windows-1252.
    length_unit : unit of radii and heights, or of each: m, mm, um or nm; needed where no heading
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
    require_type("file", file, str | Path, "the name of a file")
    with Path(file).open("rb") as stream:
        content = stream.read(_LARGEST + 1)
    if len(content) > _LARGEST:
        raise InputError(("table",), f"longer than {_LARGEST} bytes: reduce the number of points")
    rows, columns, of_areas = _parsed(_decoded(content))
    given = (length_unit, length_unit) if isinstance(length_unit, str) else length_unit or ("", "")
    points = []
    for name, (place, heading), unit in zip("rf", columns, given, strict=True):
        if unit and heading not in {None, _unit(unit)}:
            detail = f"is {heading} in the heading of {name}, and not {unit}"
            raise InputError(("length_unit",), detail)
        if not (heading or unit):
            detail = f"is required: no heading names the unit of {name}"
            raise InputError(("length_unit",), detail)
        scale = metres(heading or unit) / metres(to)
        cells = (row[place].replace(",", ".").lower().replace("d", "e") for _, row in rows)
        # The product of a decimal number and a power of ten, without its rounding error.
        numbers = np.array([float(cell) for cell in cells])
        if of_areas and name == "r":
            if negative := [
                line for (line, _), area in zip(rows, numbers, strict=True) if area < 0
            ]:
                raise _refuse(negative[0], "an area is negative")
            numbers = np.sqrt(numbers / np.pi)
        points.append(np.array([float(f"{number * scale:.15g}") for number in numbers]))
    return Points(*points)


def _unit(name: str) -> str | None:
    units = (unit for unit in UNITS if re.fullmatch(_UNIT_NAMES[unit], name))
    return next(units, None)


def metres(name: str) -> float:
    """Return a unit of length in metres."""
    if unit := _unit(name):
        return UNITS[unit]
    raise InputError(("length_unit",), f"{name} is none of {', '.join(UNITS)}")


def _refuse(line: int, detail: str) -> InputError:
    return InputError(("table",), f"Line {line}: {detail}")


def _decoded(content: bytes) -> str:
    wide = content.startswith((b"\xff\xfe", b"\xfe\xff"))
    try:
        return content.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError:
        # As older instruments write it.
        return content.decode("cp1252", errors="replace")


def _content(line: str) -> str:
    """Return a line without comments and quotes."""

    def unquoted(quoted: re.Match[str]) -> str:
        # A comma within quotes is a decimal comma, or part of a name.
        decimal = re.fullmatch(_COMMA, quoted[1].strip())
        return re.sub("[,;]", "." if decimal else " ", quoted[1])

    text = re.sub(r"\s[#%!].*", "", re.sub(f"^{_COMMENT}", "", line)).replace("−", "-")
    return re.sub('"([^"]*)"', unquoted, text).strip()


def _cells(text: str, separator: str) -> list[str]:
    return [cell.strip() for cell in re.split(separator, re.sub(r"[\s;,]+$", "", text))]


def _parsed(text: str) -> tuple[list[_Row], list[tuple[int, str | None]], bool]:
    """Return the rows of a table, index and unit of its columns, and whether one holds areas."""
    lines = list(enumerate(re.split(r"\r\n|\r|\n", text), 1))
    errors = [(0, InputError(("table",), "no line holds two numbers, a radius and a height"))]
    for separator, form in _DIALECTS:
        rows, heading, error = _rows(lines, separator, form)
        if error:
            errors.append((len(rows), error))
        elif rows:
            return rows, *_columns(rows, heading, separator)
    # Of the dialects, the one in which most lines are numbers is probably meant.
    raise max(errors[1:] or errors, key=lambda each: each[0])[1]


def _rows(
    lines: Sequence[tuple[int, str]], separator: str, form: str
) -> tuple[list[_Row], list[tuple[int, str]], InputError | None]:
    """Return rows of numbers, the heading above them, and the error at a line that is neither."""
    rows: list[_Row] = []
    heading = []
    for number, line in lines:
        text = _content(line)
        cells = _cells(text, separator)
        numeric = [re.fullmatch(form, cell) for cell in cells]
        count = len(rows[0][1]) if rows else max(len(cells), 2)
        if re.match(_COMMENT, line) or (not rows and not numeric[0]):
            heading.append((number, text))
        elif text and len(cells) == count and all(numeric):
            rows.append((number, cells))
        elif text:
            return rows, heading, _refuse(number, f"{count} numbers are expected")
    return rows, heading, None


def _columns(
    rows: Sequence[_Row], heading: Sequence[tuple[int, str]], separator: str
) -> tuple[list[tuple[int, str | None]], bool]:
    """Return index and unit of the columns of radii, or areas, and heights."""
    first, count = rows[0][0], len(rows[0][1])
    whole = all(re.fullmatch(r"[-+]?\d+", cell) for _, cells in rows for cell in cells)
    if separator == "," and count > 2 and whole:
        detail = "a comma may separate columns or decimals; separate columns by ; or tabs"
        raise _refuse(first, detail)
    names, units = [""] * count, list[str | None]([None] * count)
    # Units of columns that are not read do not matter.
    unknown = list[InputError | None]([None] * count)
    for number, text in heading:
        common = re.search(r"(?i)\bunits?\b\W*(\S+?)\W*$", text)
        if common and (unit := _unit(common[1])):
            units = [unit] * count
        # A unit stays with its name where blanks separate columns.
        joined = re.sub(r"\s*/\s*|\s+in\s+", "/", re.sub(r"\s+(?=[\[(])", "", text))
        titles = _cells(joined, separator)
        # Data of the measurement, such as `Length; 0,8 mm`, name no column.
        if len(titles) != count or any(re.match(r"[-+]?\d", title) for title in titles):
            continue
        for i, title in enumerate(titles):
            names[i] += f" {title}"
            unit, problem = _unit_of(title, number, of_area=_is_area(names[i]))
            units[i] = unit or units[i]
            unknown[i] = unknown[i] or problem
    places = [
        next((i for p in patterns for i in range(count) if re.search(p, names[i])), None)
        for patterns in _COLUMN_NAMES
    ]
    areas = next((i for i in range(count) if _is_area(names[i])), None)
    of_areas = places[0] is None and None not in {areas, places[1]}
    places[0] = areas if of_areas else places[0]
    if None in places or places[0] == places[1]:
        if count > 2:
            detail = f"{count} columns; name the radius r and the height f in a line above"
            raise _refuse(first, detail)
        places = [0, 1]
    found = [place for place in places if place is not None]
    for place in found:
        if not units[place] and (problem := unknown[place]):
            raise problem
    return [(place, units[place]) for place in found], of_areas


def _is_area(name: str) -> bool:
    radius, _ = _COLUMN_NAMES
    return bool(re.search(_AREA, name)) and not any(re.search(p, name) for p in radius)


def _unit_of(title: str, line: int, *, of_area: bool) -> tuple[str | None, InputError | None]:
    """Return the unit that a title names: `mm`, `r [mm]`, `r (mm)`, `r, mm`, `r_mm` or `A [mm²]`.

    The unit of an area is that of the length. A unit in brackets that is unknown is an error.
    """
    found = re.search(r"([\[(]?)\s*([^\[(/_,\s\])]*)\s*[\])]?$", title)
    bracket, word = found.groups() if found else ("", "")
    length = re.sub(_SQUARE, "", word)
    unit = _unit(length) if (length != word) == of_area else None
    if unit or bracket != "[":
        return unit, None
    known = ", ".join(f"{each}²" if of_area else each for each in UNITS)
    return None, _refuse(line, f"the unit {word} is none of {known}")
