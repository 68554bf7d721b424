"""Profiles and curves in files, as instruments and spreadsheets write them.

Nothing is guessed: a column is that of a quantity if its unit or its name says so, or if it is the
only one left of two. What is not understood is an error that names the line and the remedy.
"""

import json
import re
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from mdr_core.errors import InputError
from mdr_core.typing import Array

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


class Curve(NamedTuple):
    """Measured forces over depths."""

    indentation_depth: Array
    """Depths in the order of the file [length]."""
    normal_force: Array
    """Forces [force]."""


class Column(NamedTuple):
    """A column of a file."""

    name: str
    quantity: str
    """Radius, area, height, depth or force, "" where it is not taken."""
    unit: str | None
    """Unit of the length or force, or None without one; of an area that of its root."""
    scale: float | None
    """Its size in SI units."""


class Table(NamedTuple):
    """Columns of a file, and the two lists that are taken."""

    columns: list[Column]
    values: tuple[list[float], list[float]]
    """Numbers as written, of an area r = (A/pi)^(1/2)."""
    taken: tuple[Column, Column]
    lines: list[int]
    """Line of each point."""
    notes: list[str]
    """What was taken without a name, or computed."""


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


def read_curve(file: str | Path, units: Sequence[str | None] = (None, None)) -> Curve:
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
    ...     read_curve(file)
    Curve(indentation_depth=array([0.e+00, 1.e-08, 2.e-08]), normal_force=array([0.e+00, 2.e-06, 5.e-06]))
    """
    return Curve(*_in_units(file, CURVE, units, (1.0, 1.0)))


def metres(name: str) -> float:
    """Return a unit of length in metres."""
    quantity, _, scale = _unit(name) or ("", "", 0.0)
    if quantity == "length":
        return scale
    raise InputError(("length_unit",), f"{name} is none of {', '.join(UNITS)}")


def _in_units(
    file: str | Path, kind: Sequence[str], given: Sequence[str | None], to: Sequence[float]
) -> list[Array]:
    with Path(file).open("rb") as stream:
        table = parse(stream.read(_LARGEST + 1), kind)
    member, lists = ("length_unit" if kind == PROFILE else "force_unit",), []
    for column, values, unit, target in zip(table.taken, table.values, given, to, strict=True):
        known, name = (_unit(unit) if unit else None), _HEADS.get(column.quantity, "r")
        if unit and (
            known is None or known[0] != ("force" if column.quantity == "force" else "length")
        ):
            raise InputError(member, f"{unit} is none of {_known(column.quantity)}")
        if known and column.unit not in {None, known[1]}:
            detail = f"is {column.unit} in the heading of {name}, and not {unit}"
            raise InputError(member, detail)
        scale = known[2] if known else column.scale
        if scale is None:
            detail = f"is required: no heading names the unit of {name}"
            raise InputError(member, detail)
        # The product of a decimal number and a power of ten, without its rounding error.
        lists.append(np.array([float(f"{number * (scale / target):.15g}") for number in values]))
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


def parse(content: bytes, kind: Sequence[str]) -> Table:
    """Return the table of a file, a `PROFILE` or a `CURVE`, as it is written, or an InputError."""
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
            return _table(rows, heading, separator, kind, form)
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
) -> tuple[list[tuple[int, list[str]]], list[tuple[int, str]], InputError | None]:
    """Return rows of numbers and words, the heading above, and the error at a line that is neither.

    A column of words holds no number in any row.
    """
    rows: list[tuple[int, list[str]]] = []
    heading, words = [], list[bool]()
    for number, comment, text in lines:
        cells = _cells(text, separator)
        numeric = [bool(re.fullmatch(form, cell)) for cell in cells]
        while separator != _BLANKS and len(cells) > max(len(words), 2) and not cells[-1]:
            del cells[-1], numeric[-1]
        while words and len(cells) < len(words) and separator != _BLANKS and words[len(cells)]:
            cells.append("")
            numeric.append(False)
        # A number with another decimal sign is no word.
        odd = any(
            re.fullmatch(r"[-+]?[\d.,]+(e[-+]?\d+)?", c)
            for c, n in zip(cells, numeric, strict=True)
            if not n
        )
        if comment and rows:
            continue
        if comment or (not words and (not numeric[0] or odd) and sum(numeric) < 2):
            heading.append((number, text))
        elif (
            text
            and (not words or [not each for each in numeric] == words)
            and sum(numeric) > 1
            and not odd
        ):
            words = words or [not each for each in numeric]
            rows.append((number, cells))
        elif text:
            count = len(words) - sum(words) if words else max(len(cells), 2)
            return rows, heading, _refuse(number, f"{count} numbers are expected")
    return rows, heading, None


def _table(
    rows: Sequence[tuple[int, list[str]]],
    heading: Sequence[tuple[int, str]],
    separator: str,
    kind: Sequence[str],
    form: str,
) -> Table:
    first, cells = rows[0]
    numeric = [i for i, cell in enumerate(cells) if re.fullmatch(form, cell)]
    whole = all(re.fullmatch(r"[-+]?\d+", cells[i]) for _, cells in rows for i in numeric)
    titles = _titles(heading, separator, len(cells), kind)
    named = any(title.name for title in titles)
    if separator == "," and len(cells) > 2 and whole and not named:
        detail = "a comma may separate columns or decimals; separate columns by ; or tabs"
        raise _refuse(first, detail)
    quantities = [_quantity(title, kind) for title in titles]
    places = _places(titles, quantities, numeric, kind, first)
    columns = [Column(title.name, "", *(title.unit or ("", None, None))[1:]) for title in titles]
    for i, wanted in zip(places, kind, strict=True):
        title, quantity = titles[i], "area" if quantities[i] == "area" else wanted
        measured = title.unit[0] if title.unit else _MEASURES[quantity]
        if title.unknown or measured != _MEASURES[quantity]:
            unknown = title.unknown or f"the unit {title.text}"
            raise _refuse(title.line, f"{unknown} is none of {_known(quantity)}")
        columns[i] = columns[i]._replace(quantity=quantity)
    values = [
        [float(cells[i].replace(",", ".").lower().replace("d", "e")) for _, cells in rows]
        for i in places
    ]
    for numbers in values:
        if not np.isfinite(numbers).all():
            raise _refuse(rows[int(np.isinf(numbers).argmax())][0], "a number is too large")
    notes = []
    for i, quantity in zip(places, kind, strict=True):
        if quantities[i] not in {quantity, "area"}:
            which = f"“{titles[i].name}”" if titles[i].name else "without a name"
            notes.append(f"Column {i + 1}, {which}, is taken as the {quantity}.")
    if columns[places[0]].quantity == "area":
        if negative := [line for (line, _), area in zip(rows, values[0], strict=True) if area < 0]:
            raise _refuse(negative[0], "an area is negative")
        values[0] = np.sqrt(np.array(values[0]) / np.pi).tolist()
        notes.append("The radii are r = √(A/π) of the areas.")
    taken = columns[places[0]], columns[places[1]]
    return Table(columns, (values[0], values[1]), taken, [line for line, _ in rows], notes)


class _Title(NamedTuple):
    """Name and unit of a column, what is not understood of it, and where it stands."""

    name: str = ""
    unit: tuple[str, str, float] | None = None
    text: str = ""
    """The unit as it is written."""
    unknown: str = ""
    line: int = 0


def _titles(
    heading: Sequence[tuple[int, str]], separator: str, count: int, kind: Sequence[str]
) -> list[_Title]:
    """Return the titles of the columns: the last line of names, and the units beneath or beside.

    Data of the measurement, such as `Length; 0,8 mm`, name no column.
    """
    titles = [_Title()] * count
    for number, text in heading:
        if len(text) > _LONGEST:
            continue
        common = re.search(r"(?i)\bunits?\b\W*(\S+)\W*$", text)
        if common and (unit := _unit(common[1])):
            titles = [title._replace(unit=unit, text=common[1], line=number) for title in titles]
        # A unit stays with its name where blanks separate columns.
        joined = re.sub(r" (?=[\[({])", "~", re.sub(_LABEL, "", text))
        joined = re.sub(r"[\[({][^\[\](){}]*[\])}]", _kept, joined)
        cells = _cells(re.sub(r" ?/ ?|(?<=\w) in (?=\w)", "/", joined), separator)
        cells = [cell.replace("~", " ") for cell in cells]
        if len(cells) != count or any(re.match(r"[-+]?\d", cell) for cell in cells):
            continue
        units = [_unit(re.sub(r"[\[\](){}]", "", cell)) for cell in cells]
        if all(unit or not re.search(r"\w", c) for unit, c in zip(units, cells, strict=True)):
            for i, unit in enumerate(units):
                if unit:
                    titles[i] = titles[i]._replace(
                        unit=unit, text=cells[i].strip("[](){} "), unknown="", line=number
                    )
            continue
        found = [_title(cell, number) for cell in cells]
        if any(title.unit or title.unknown or _quantity(title, kind) for title in found):
            titles = [
                new._replace(unit=new.unit or (old.unit if common else None)) if new.name else old
                for new, old in zip(found, titles, strict=True)
            ]
    return titles


def _kept(bracket: re.Match[str]) -> str:
    return re.sub("[ ,]", "~", bracket[0])


def _title(cell: str, line: int) -> _Title:
    """Return a title: `r [mm]`, `r (10^-6 m)`, `r/mm`, `r, mm`, `load_micro_N` or `A [mm²]`."""
    name, bracket, inside = re.match(r"([^\[({]*)([\[({]?)([^\])}]*)", cell).groups()  # type: ignore[union-attr]
    parts = re.split(r"(?<=[^\W\d])[ _]|[/,]", name)
    for i in range(1, len(parts)) if not bracket else [0]:
        text = inside.strip() if bracket else " ".join(parts[i:]).strip()
        squared = re.sub(_SQUARE, "", text)
        unit = _unit(text)
        if not unit and squared != text and (root := _unit(squared)):
            unit = "area", *root[1:]
        if unit:
            return _Title(name.strip() if bracket else " ".join(parts[:i]), unit, text, "", line)
    unknown = f"the unit {inside.strip()}" if re.search(r"\w", inside) else ""
    if re.search(_MULTIPLIER, name):
        unknown = f"the unit or factor in “{name.strip()}”"
    return _Title(name.strip(), None, "", unknown, line)


def _place(name: str, quantity: str) -> int | None:
    """Place of a name among those of a quantity, or None; other words must be neutral."""
    order = _NAMES[quantity]
    whole = re.sub(r"[\W\d_]", "", name).lower()
    words = [word for word in re.split(r"[\W\d_]+", name.lower()) if word not in _NEUTRAL]
    known = [each for each in (whole, *words[:1]) if each in order]
    return order.index(known[0]) if known and (whole in order or len(words) == 1) else None


def _quantity(title: _Title, kind: Sequence[str]) -> str:
    """Return the quantity of a column, "" if neither name nor unit tell it."""
    measure = title.unit[0] if title.unit else None
    named = next((each for each in kind if _place(title.name, each) is not None), "")
    if named == "radius" and _AREAS & set(re.split(r"[\W\d_]+", title.name.lower())):
        return "area"
    if measure is None:
        return named
    # A known unit decides.
    fits = [each for each in kind if _MEASURES[each] == measure]
    return (
        named
        if named in fits or (named and measure == "area")
        else "".join(fits[:1] * (len(fits) == 1))
    )


def _places(
    titles: Sequence[_Title],
    quantities: Sequence[str],
    numeric: Sequence[int],
    kind: Sequence[str],
    line: int,
) -> list[int]:
    """Return the indices of the two columns, or an InputError that asks for their names."""
    if len(numeric) == 2 and not any(titles[i].name for i in numeric):
        return list(numeric)
    places = []
    for quantity in kind:
        alike = {quantity, "area"} if quantity == "radius" else {quantity}
        ranks = [(_place(titles[i].name, quantity), i) for i in numeric if quantities[i] in alike]
        ranked = sorted((len(_NAMES[quantity]) if rank is None else rank, i) for rank, i in ranks)
        if len(ranked) > 1 and ranked[0][0] == ranked[1][0]:
            both = " and ".join(titles[i].name for _, i in ranked[:2])
            raise _refuse(line, f"{both} may each be the {quantity}: name one of them {quantity}")
        places += [i for _, i in ranked[:1]] or [-1]
    left = [i for i in numeric if i not in places and not titles[i].unit]
    if len(numeric) == 2 and places.count(-1) == 1 and left:
        places[places.index(-1)] = left[0]
    if -1 in places:
        asked = " and ".join(f"the {quantity} {_HEADS[quantity]}" for quantity in kind)
        raise _refuse(line, f"{len(titles)} columns; name {asked} in a line above")
    return places


def _unit(text: str) -> tuple[str, str, float] | None:
    """Return quantity, name and size in SI units of a unit with its prefix and power of ten."""
    text = text.strip().translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    factor = re.match(_FACTOR, text)
    power = int(factor[2] or factor[3]) if factor else 0
    rest = re.sub(r"^[\s*·x×]+|[\s_-]", "", text[factor.end() :] if factor else text)
    for prefix, exponent in _PREFIXES.items():
        name = rest[len(prefix) :]
        known = _UNITS.get(name) or (
            _UNITS.get(name.lower()) if name.istitle() and len(name) > 2 else None
        )
        if rest.startswith(prefix) and known and (known[2] or not prefix):
            quantity, size, _ = known
            power += exponent
            symbol = {"length": "m", "force": "N"}.get(quantity, name)
            if size != 1:
                return (
                    quantity,
                    rest if not factor else f"10^{power} {name}",
                    size * float(f"1e{power}"),
                )
            named = next((p for p, e in _PREFIXES.items() if e == power), None)
            shown = f"10^{power} {symbol}" if named is None else f"{named}{symbol}"
            return quantity, shown, float(f"1e{power}")
    return None
