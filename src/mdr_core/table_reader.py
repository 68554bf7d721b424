"""Profiles and curves in files, as instruments and spreadsheets write them.

Nothing is guessed: a column is that of a quantity if its unit or its name says so, or if it is the
only one left of two. What is not understood is an error that names the line and the remedy.
"""

import json
import re
from collections.abc import Sequence
from importlib.resources import files
from math import isfinite
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from mdr_core.errors import InputError
from mdr_core.typing import Array
from mdr_core.validation import require_type

_WORDS: Final = json.loads(files("mdr_core").joinpath("table_words.json").read_text("utf-8"))
# Prefix -> power of ten; unit -> quantity, size in SI units, and whether it takes a prefix.
_PREFIXES, _UNITS = _WORDS["prefixes"], _WORDS["units"]
# Names of each quantity, and words beside a name that leave its meaning.
_NAMES, _NEUTRAL = _WORDS["names"], frozenset(_WORDS["neutral"])
UNITS: Final = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9}
"""Units of length of results, in metres."""
PROFILE, CURVE = ("radius", "height"), ("depth", "force")
_HEADS: Final = {"radius": "r", "height": "f", "depth": "d", "force": "F"}
_MEASURES: Final = dict.fromkeys(_HEADS, "length") | {"force": "force", "area": "area"}
# What is left in a name of a factor or a unit that is not understood.
_MULTIPLIER: Final = (
    r"/ ?\S|10 ?\^|[x×*] ?10|1e[-+]?\d|(?i:(?<![a-z])(nano|micro|milli|kilo)(?![a-z]))"
)
_AREAS: Final = {"area", "a", "section", "areas"}
_POINT: Final = r"(?ai)[-+]?(\d+\.?\d*|\.\d+)([ed][-+]?\d+)?"
_COMMA: Final = r"(?ai)[-+]?(\d+,?\d*|,\d+)([ed][-+]?\d+)?"
_BLANKS: Final = r",? +"
# Separator of columns, and the form of a number. Blanks separate numbers with a decimal comma
# before commas separate columns: `0,5 1,2` holds two numbers.
_DIALECTS: Final = (
    *((separator, form) for separator in "\t;" for form in (_POINT, _COMMA)),
    *((_BLANKS, _COMMA), (",", _POINT), (_BLANKS, _POINT)),
)
_COMMENT: Final = r"\s*(#|%|!|//)+"
# Words before the names, or the units, of columns in a comment.
_LABEL: Final = r"(?i)^(fancyNames|columns|headings?|units?)\s*[:=]\s*"
# Any number, with whatever decimal sign.
_NUMBERLIKE: Final = r"(?ai)[-+]?[\d.,]*\d[.,]?([ed][-+]?\d+)?"
# Number of a line, and its cells.
_Row = tuple[int, list[str]]
# Bytes of the longest file, some 10^5 points: more take seconds.
_LARGEST: Final = 4_000_000
# Characters of the longest heading: tables of instruments have some hundred.
_LONGEST: Final = 4_000
_SQUARE: Final = r"(²|\^2|\*\*2|2)$"
# A number before a unit, such as 10^-6, 1e-6 or x10-6.
_FACTOR: Final = (
    r"(?i)[x×*·]?\s*(?:(1|1[.,]0*)?\s*[x×*·]?\s*10(?:\^|\*\*)?\(?([-+]\d+)\)?|1e([-+]?\d+))"
)


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


class Title(NamedTuple):
    """Heading of a column."""

    name: str = ""
    unit: tuple[str, str, float] | None = None
    """What it measures, its name, and its size in SI units; of an area those of its root."""
    unknown: str = ""
    """What is not understood."""
    line: int = 0


class ParsedFile(NamedTuple):
    """Columns of a file, and the two lists that are taken."""

    titles: list[Title]
    taken: dict[int, str]
    """Quantity of the two columns by their index: radius or area, and height; depth and force."""
    values: list[list[float]]
    """Numbers as written, of an area r = (A/pi)^(1/2)."""
    lines: list[int]
    """Line of each point."""


class ColumnsError(InputError):
    """A file leaves open which of its columns are meant."""

    def __init__(self, line: int, detail: str, columns: dict[int, str]) -> None:
        super().__init__(("table",), f"Line {line}: {detail}")
        self.columns = columns
        """Names of the columns of numbers by their number, from 1."""


def read_table(
    file: str | Path, length_unit: str | Sequence[str] | None = None, *, to: str = "m"
) -> Points:
    r"""Return the radii and heights of a table in a file, in metres or the unit `to`.

    The file may have decimal commas, any separator, headings, a row of units, comments, quotes and
    further columns. A column named A or area, in place of the radii, holds the cross-sections A(h)
    of a tip: the radii are sqrt(A/pi). Two columns without a heading are radii and heights.

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
    return Points(*_in_units(file, PROFILE, given or (None, None), (metres(to), metres(to))))


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
    return MeasuredCurve(*_in_units(file, CURVE, units, (1.0, 1.0)))


def metres(name: str) -> float:
    """Return a unit of length in metres."""
    quantity, _, scale = _unit(name) or ("", "", 0.0)
    if quantity == "length":
        return scale
    raise InputError(("length_unit",), f"{name} is none of {', '.join(UNITS)}")


def _in_units(
    file: str | Path, kind: Sequence[str], given: Sequence[str | None], to: Sequence[float]
) -> list[Array]:
    require_type("file", file, str | Path, "the name of a file")
    with Path(file).open("rb") as stream:
        table = parse(stream.read(_LARGEST + 1), kind)
    member, lists = ("length_unit" if kind == PROFILE else "units",), []
    columns = zip(table.taken.items(), table.values, given, to, kind, strict=True)
    for (place, _), values, unit, target, wanted in columns:
        heading, known = table.titles[place].unit, _unit(unit or "")
        if unit and (not known or known[0] != _MEASURES[wanted]):
            raise InputError(member, f"{unit} is none of {_known(wanted)}")
        if known and heading and known[1:] != heading[1:]:
            detail = f"is {heading[1]} in the heading of {_HEADS[wanted]}, and not {unit}"
            raise InputError(member, detail)
        if not (known := known or heading):
            detail = f"is required: no heading names the unit of {_HEADS[wanted]}"
            raise InputError(member, detail)
        # The product of a decimal number and a power of ten, without its rounding error.
        lists.append(np.array([float(f"{each * (known[2] / target):.15g}") for each in values]))
    return lists


def _known(quantity: str) -> str:
    units = ["N", "mN", "µN", "nN"] if quantity == "force" else [*UNITS]
    return ", ".join(f"{unit}²" if quantity == "area" else unit for unit in units)


def _refuse(line: int, detail: str) -> InputError:
    return InputError(("table",), f"Line {line}: {detail}")


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

    `columns` are the numbers of the two columns, from 1, where headings do not tell them.
    """
    text = _decoded(content).replace("−", "-").replace("μ", "µ").replace("\xa0", " ")
    lines = [
        (number, re.match(_COMMENT, line), _content(line))
        for number, line in enumerate(re.split(r"\r\n|\r|\n", text), 1)
    ]
    expected = f"no line holds two numbers, a {kind[0]} and a {kind[1]}"
    errors = [(0, InputError(("table",), expected))]
    for separator, form in _DIALECTS:
        rows, heading, error = _rows(lines, separator, form)
        if error:
            errors.append((len(rows), error))
        elif rows:
            titles = _titles(heading, separator, len(rows[0][1]), kind)
            return _table(rows, titles, separator, kind, columns)
    # Of the dialects, the one in which most lines are numbers is probably meant.
    raise max(errors[1:] or errors, key=lambda each: each[0])[1]


def _content(line: str) -> str:
    """Return a line without comments, quotes and repeated blanks."""

    def unquoted(quoted: re.Match[str]) -> str:
        # A comma within quotes is a decimal comma, or part of a name.
        decimal = re.fullmatch(_COMMA, quoted[1].strip())
        return re.sub("[,;]", "." if decimal else " ", quoted[1])

    text = re.sub(" {2,}", " ", re.sub(f"^{_COMMENT}", "", line.strip(" ")))
    return re.sub('"([^"]*)"', unquoted, re.sub(r"\s[#!].*", "", text)).strip(" ")


def _cells(text: str, separator: str) -> list[str]:
    # Blanks before a tab are no cell of a table whose columns blanks separate.
    text = text.replace("\t", " ").strip() if separator == _BLANKS else text
    return [cell.strip() for cell in re.split(separator, text)]


def _rows(
    lines: Sequence[tuple[int, object, str]], separator: str, form: str
) -> tuple[list[_Row], list[tuple[int, str]], InputError | None]:
    """Return rows of numbers and words, the heading above, and the error at a line that is neither.

    A column of words holds no number in any row, with whatever decimal sign.
    """
    rows: list[_Row] = []
    heading, numeric = [], list[bool]()
    for number, comment, text in lines:
        cells = _cells(text.rstrip(" \t;,"), separator)
        if separator != _BLANKS:
            cells += [""] * (len(numeric) - len(cells))
        found = [bool(re.fullmatch(form, cell)) for cell in cells]
        looks = [
            each or bool(re.fullmatch(_NUMBERLIKE, cell))
            for each, cell in zip(found, cells, strict=True)
        ]
        if comment or (not rows and sum(found) < 2 and (found != looks or not found[0])):
            heading += [] if rows else [(number, text)]
        elif text and sum(found) > 1 and found == looks and numeric in ([], found):
            numeric = found
            rows.append((number, cells))
        elif text:
            count = sum(numeric) or max(len(cells), 2)
            return rows, heading, _refuse(number, f"{count} numbers are expected")
    return rows, heading, None


def _table(
    rows: Sequence[_Row],
    titles: list[Title],
    separator: str,
    kind: Sequence[str],
    columns: Sequence[int] | None,
) -> ParsedFile:
    first, cells = rows[0]
    numeric = [i for i, cell in enumerate(cells) if re.fullmatch(_NUMBERLIKE, cell)]
    whole = all(re.fullmatch(r"[-+]?\d+", cells[i]) for _, cells in rows for i in numeric)
    if separator == "," and len(cells) > 2 and whole and not any(each.name for each in titles):
        detail = "a comma may separate columns or decimals; separate columns by ; or tabs"
        raise _refuse(first, detail)
    if wrong := [number for number in columns or () if number - 1 not in numeric]:
        raise _refuse(first, f"column {wrong[0]} holds no numbers")
    places = [number - 1 for number in columns or ()] or _places(titles, numeric, kind, first)
    taken, values = {}, []
    for i, wanted in zip(places, kind, strict=True):
        title = titles[i]
        is_area = wanted == "radius" and _AREAS & set(re.split(r"[\W\d_]+", title.name.lower()))
        taken[i] = quantity = "area" if is_area else wanted
        if title.unknown or (title.unit and title.unit[0] != _MEASURES[quantity]):
            unknown = title.unknown or f"the unit {(title.unit or kind)[1]}"
            raise _refuse(title.line, f"{unknown} is none of {_known(quantity)}")
        numbers = [float(re.sub("[dD]", "e", row[i].replace(",", "."))) for _, row in rows]
        for (line, _), number in zip(rows, numbers, strict=True):
            if not isfinite(number) or (is_area and number < 0):
                raise _refuse(
                    line, "an area is negative" if number < 0 else "a number is too large"
                )
        values.append(np.sqrt(np.array(numbers) / np.pi).tolist() if is_area else numbers)
    return ParsedFile(titles, taken, values, [line for line, _ in rows])


def _titles(
    heading: Sequence[tuple[int, str]], separator: str, count: int, kind: Sequence[str]
) -> list[Title]:
    """Return the titles of the columns: the last line of names, and the units beneath or beside.

    Data of the measurement, such as `Length; 0,8 mm`, name no column; the last line does.
    """
    titles, common = [Title()] * count, None
    for number, text in heading:
        if len(text) > _LONGEST:
            continue
        if found := re.search(r"(?i)\bunits?\b\W*(\S+)\W*$", text):
            common = _unit(found[1]) or common
        # A unit stays with its name where blanks separate columns.
        joined = re.sub(r" (?=[\[({])", "~", re.sub(_LABEL, "", text))
        joined = re.sub(r"[\[({][^\[\](){}]*[\])}]", lambda b: re.sub("[ ,]", "~", b[0]), joined)
        cells = _cells(re.sub(r" ?/ ?|(?<=\w) in (?=\w)", "/", joined), separator)
        cells = [
            cell.replace("~", " ") for cell in cells[: count if not any(cells[count:]) else None]
        ]
        if len(cells) != count or any(re.match(r"[-+]?\d", cell) for cell in cells):
            continue
        units = [_unit(re.sub(r"[\[\](){}]", "", cell)) for cell in cells]
        new = [_title(cell, number) for cell in cells]
        if all(unit or not re.search(r"\w", c) for unit, c in zip(units, cells, strict=True)):
            new = [
                each._replace(name=old.name, unit=unit, unknown="") if unit else old
                for each, old, unit in zip(new, titles, units, strict=True)
            ]
        elif number != heading[-1][0] and not any(
            each.unit or each.unknown or _rank(each, q) is not None for each in new for q in kind
        ):
            continue
        titles = [
            each if each.line and (each.name or each.unit) else old
            for each, old in zip(new, titles, strict=True)
        ]
    return [each if each.unit else each._replace(unit=common) for each in titles]


def _title(cell: str, line: int) -> Title:
    """Return a title: `r [mm]`, `r (10^-6 m)`, `r/mm`, `r, mm`, `load_micro_N` or `A [mm²]`."""
    name, bracket, inside = re.match(r"([^\[({]*)([\[({]?)([^\])}]*)", cell).groups()  # type: ignore[union-attr]
    parts = re.split(r"(?<=[^\W\d])[ _]|[/,]", name)
    # The unit is what follows the name, or a word within it: Defl_nN_Ex.
    ends = [(i, len(parts)) for i in range(1, len(parts))]
    ends += [(i, i + 1) for i in range(1, len(parts)) if len(parts[i]) > 1]
    for i, end in [(len(parts), len(parts))] if bracket else ends:
        if unit := _unit(inside if bracket else " ".join(parts[i:end])):
            return Title(" ".join(parts[:i] + parts[end:]).strip(), unit, "", line)
    unknown = f"the unit {inside.strip()}" if re.search(r"\w", inside) else ""
    if re.search(_MULTIPLIER, name):
        unknown = f"the unit or factor in “{name.strip()}”"
    return Title(name.strip(), None, unknown, line)


def _rank(title: Title, quantity: str) -> int | None:
    """Place of a column among those of a quantity, last if only its unit tells it; None if none."""
    order, measure = _NAMES[quantity], title.unit and title.unit[0]
    # A known unit decides, whatever the name.
    if measure not in {None, _MEASURES[quantity]} and (measure, quantity) != ("area", "radius"):
        return None
    words = [w for w in re.split(r"[\W\d_]+", title.name.lower()) if w not in _NEUTRAL]
    for name in ("".join(re.split(r"[\W\d_]+", title.name.lower())), *words[: len(words) == 1]):
        if name in order:
            return order.index(name)
    return len(order) if measure and quantity in CURVE else None


def _places(
    titles: Sequence[Title], numeric: Sequence[int], kind: Sequence[str], line: int
) -> list[int]:
    """Return the indices of the two columns, or an InputError that asks for their names."""
    if len(numeric) == 2 and not any(titles[i].name for i in numeric):
        return list(numeric)
    places, names = [], {i + 1: titles[i].name for i in numeric}
    for quantity in kind:
        ranks = [(_rank(titles[i], quantity), i) for i in numeric]
        ranked = sorted((rank, i) for rank, i in ranks if rank is not None)
        if len(ranked) > 1 and ranked[0][0] == ranked[1][0]:
            both = " and ".join(titles[i].name for _, i in ranked[:2])
            detail = f"{both} may each be the {quantity}: name one of them {quantity}"
            raise ColumnsError(line, detail, names)
        places += [i for _, i in ranked[:1]] or [-1]
    left = [i for i in numeric if i not in places and not titles[i].unit]
    if len(numeric) == 2 and left and -1 in places:
        # The one that is known decides the other.
        places[places.index(-1)] = left[0]
    if -1 in places:
        asked = " and ".join(f"the {quantity} {_HEADS[quantity]}" for quantity in kind)
        detail = f"{len(titles)} columns; name {asked} in a line above"
        raise ColumnsError(line, detail, names)
    return places


def _unit(text: str) -> tuple[str, str, float] | None:
    """Return measure, name and size in SI units of a unit with its prefix and power of ten."""
    text = text.strip().translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    factor = re.match(_FACTOR, text)
    power = int(factor[2] or factor[3]) if factor else 0
    rest = re.sub(r"^[\s*·x×]+|[\s_-]", "", text[factor.end() :] if factor else text)
    for prefix, exponent in _PREFIXES.items():
        name = rest[len(prefix) :]
        known = _UNITS.get(name) or (_UNITS.get(name.lower()) if name.istitle() else None)
        if rest.startswith(prefix) and known and (known[2] or not prefix):
            measure, size, power = known[0], known[1], power + exponent
            symbol = {"length": "m", "force": "N"}.get(measure, name) if size == 1 else name
            sign = next((p for p, e in _PREFIXES.items() if e == power), f"10^{power} ")
            return measure, f"{sign}{symbol}", size * float(f"1e{power}")
    root = _unit(re.sub(_SQUARE, "", text)) if re.search(_SQUARE, text) else None
    return ("area", *root[1:]) if root else None
