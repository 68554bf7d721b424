"""Profiles and curves in files, as instruments and spreadsheets write them.

Nothing is guessed: a column is that of a quantity if its unit or its name says so, or if it is the
only one left of two. What is not understood is an error that names the line and the remedy.
"""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from mdr_core.errors import InputError
from mdr_core.typing import Array

_PREFIXES: Final = {
    **{"p": -12, "n": -9, "u": -6, "µ": -6, "m": -3, "c": -2, "d": -1, "": 0, "k": 3, "M": 6},
    **{"pico": -12, "nano": -9, "micro": -6, "milli": -3, "centi": -2, "kilo": 3, "mega": 6},
}
# Unit -> quantity, size in SI units, and whether it takes a prefix. Pound and kilogram by
# definition (NIST SP 811).
_UNITS: Final = {
    **dict.fromkeys(("m", "meter", "metre", "meters", "metres"), ("length", 1.0, True)),
    **dict.fromkeys(("micron", "microns"), ("length", 1e-6, False)),
    **dict.fromkeys(("Å", "angstrom", "angstroms"), ("length", 1e-10, False)),
    **dict.fromkeys(("inch", "inches", "in"), ("length", 0.0254, False)),
    **dict.fromkeys(("N", "newton", "newtons", "Newton", "Newtons"), ("force", 1.0, True)),
    **dict.fromkeys(("gf", "g", "gram", "grams"), ("force", 9.80665e-3, True)),
    **dict.fromkeys(("lbf", "lb"), ("force", 4.4482216152605, False)),
    **dict.fromkeys(("s", "sec", "min", "h", "V", "Hz", "Pa", "°C", "%", "°", "A"), ("", 1.0, True)),
}
UNITS: Final = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9}
"""Units of length of results, in metres."""
# Names of instruments and spreadsheets, in lower case without blanks; the first that is there is
# taken. Of a tip's area function, A stands for the radius.
_NAMES: Final[Mapping[str, str]] = {
    "radius": "r radius radial rho x distance position lateral length weg area a section",
    "height": "f z h hc height depth profile höhe hauteur y",
    "depth": "d depth pd indentation indentationdepth indenterdisplacement penetrationdepth "
    "tipsampleseparation displacement displacementintosurface extension tensileextension "
    "compressiveextension standardweg traversenweg eindringtiefe tiefe weg profondeur enfoncement "
    "déplacement stroke distance crosshead calcrampex h hc travel position separation x z height "
    "heightmeasured",
    "force": "f fn normalforce force load loadonsample standardforce standardkraft kraft prüfkraft "
    "last charge force effort vdeflection defl deflection p y",
}
PROFILE, CURVE = ("radius", "height"), ("depth", "force")
_AREAS: Final = {"area", "a", "section", "areas"}
_POINT: Final = r"(?i)[-+]?(\d+\.?\d*|\.\d+)([ed][-+]?\d+)?"
_COMMA: Final = r"(?i)[-+]?(\d+,?\d*|,\d+)([ed][-+]?\d+)?"
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
_FACTOR: Final = r"(?i)[x×*·]?\s*(?:(1|1[.,]0*)?\s*[x×*·]?\s*10(?:\^|\*\*)?\(?([-+]\d+)\)?|1e([-+]?\d+))"


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
    member, lists = ("length_unit" if kind == PROFILE else "units",), []
    for column, values, unit, target in zip(table.taken, table.values, given, to, strict=True):
        known = _unit(unit) if unit else None
        if unit and (known is None or known[0] != ("force" if column.quantity == "force" else "length")):
            raise InputError(member, f"{unit} is none of {_known(column.quantity)}")
        if known and column.unit not in {None, known[1]}:
            detail = f"is {column.unit} in the heading of {column.quantity}, and not {unit}"
            raise InputError(member, detail)
        scale = known[2] if known else column.scale
        if scale is None:
            detail = f"is required: no heading names the unit of the {column.quantity}"
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
        odd = any(re.fullmatch(r"[-+]?[\d.,]+(e[-+]?\d+)?", c) for c, n in zip(cells, numeric, strict=True) if not n)
        if comment or (not words and (not numeric[0] or odd) and sum(numeric) < 2):
            heading.append((number, text))
        elif text and (not words or [not each for each in numeric] == words) and sum(numeric) > 1 and not odd:
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
    if separator == "," and len(cells) > 2 and whole:
        detail = "a comma may separate columns or decimals; separate columns by ; or tabs"
        raise _refuse(first, detail)
    titles, common = _titles(heading, separator, len(cells))
    found = [_column(titles[i], common, kind) for i in range(len(cells))]
    places = _places(found, numeric, kind, first)
    columns = []
    for i, (name, quantity, unit, scale, doubt) in enumerate(found):
        if i in places and doubt:
            raise _refuse(titles[i][-1][0], doubt)
        # The one left of two has no name that is known.
        quantity = (quantity or kind[places.index(i)]) if i in places else ""
        columns.append(Column(name, quantity, unit, scale))
    values = [
        [float(cells[i].replace(",", ".").lower().replace("d", "e")) for _, cells in rows]
        for i in places
    ]
    if columns[places[0]].quantity == "area":
        if negative := [line for (line, _), area in zip(rows, values[0], strict=True) if area < 0]:
            raise _refuse(negative[0], "an area is negative")
        values[0] = np.sqrt(np.array(values[0]) / np.pi).tolist()
    taken = columns[places[0]], columns[places[1]]
    return Table(columns, (values[0], values[1]), taken, [line for line, _ in rows])


def _titles(
    heading: Sequence[tuple[int, str]], separator: str, count: int
) -> tuple[list[list[tuple[int, str]]], str | None]:
    """Return the titles of each column with their lines, and the unit of all."""
    titles: list[list[tuple[int, str]]] = [[] for _ in range(count)]
    common = None
    for number, text in heading:
        if len(text) > _LONGEST:
            continue
        if (unit := re.search(r"(?i)\bunits?\b\W*(\S+)\W*$", text)) and _unit(unit[1]):
            common = unit[1]
        # A unit stays with its name where blanks separate columns.
        joined = re.sub(_LABEL, "", text)
        joined = re.sub(r"[\[({][^\[\](){}]*[\])}]", lambda unit: unit[0].replace(" ", "~").replace(",", "~"), joined)
        joined = re.sub(r" ?/ ?|(?<=\w) in (?=\w)", "/", re.sub(r" (?=[\[({])", "~", joined))
        cells = _cells(joined, separator)
        # Data of the measurement, such as `Length; 0,8 mm`, name no column.
        if len(cells) == count and not any(re.match(r"[-+]?\d", cell) for cell in cells):
            for title, cell in zip(titles, cells, strict=True):
                title += [(number, cell.replace("~", " "))] if cell else []
    return titles, common


def _column(
    titles: Sequence[tuple[int, str]], common: str | None, kind: Sequence[str]
) -> tuple[str, str, str | None, float | None, str]:
    """Return name, quantity, unit, its size, and what is not understood of a column."""
    words, unit, doubt = "", _unit(common or ""), ""
    for _, title in titles:
        # The unit is in brackets, or the last words: m, mN, micro_N, 10^-6 m.
        name, bracket, inside, rest = re.fullmatch(r"([^\[({]*)([\[({]?)([^\])}]*)(.*)", title).groups()  # type: ignore[union-attr]
        parts = [inside] if bracket else re.split(r"(?<=[^\W\d])[ _](?=\S)|[/,]", name)
        squared = None
        for i in range(len(parts)):
            text = " ".join(filter(None, parts[i:])).strip()
            squared = _unit(re.sub(_SQUARE, "", text)) if re.search(_SQUARE, text) else None
            found = _unit(text) if not squared else ("area", *squared[1:])
            if found and (bracket or i or len(parts) == 1 and (words or len(text) > 1)):
                unit, doubt = found, ""
                name = name if bracket else " ".join(parts[:i])
                break
        else:
            if inside and not re.fullmatch(r"[\W_]*", inside):
                doubt = f"the unit {inside.strip()} is none of {{}}"
            elif re.search(r"/\s*\S|10\^|[x×*]\s*10|1e[-+]?\d|(?i:\b(nano|micro|milli|kilo))(?![a-z])", name):
                doubt = f"“{title}” holds a factor or a unit that is not understood: write {{}}"
        words = f"{words} {name} {rest.strip(' )]}')}".strip()
    name = re.sub(r"[\W\d_]", "", words).lower()
    quantity = next((q for q in kind if name in _NAMES[q].split()), "")
    quantity = "area" if quantity == "radius" and name in _AREAS else quantity
    if unit and unit[0] == "force" or unit and unit[0] == "length" and kind == CURVE:
        # A known unit decides.
        quantity = "force" if unit[0] == "force" else "depth"
    wanted = {"area": "area", "force": "force"}.get(quantity, "length")
    if unit and unit[0] != wanted:
        doubt = doubt or f"the unit {unit[1]} is none of {{}}"
        quantity = "" if unit[0] != "length" else quantity
    doubt = doubt.format(_known(quantity))
    return words, quantity, unit and unit[1], unit and unit[2], doubt


def _places(
    found: Sequence[tuple[str, str, str | None, float | None, str]],
    numeric: Sequence[int],
    kind: Sequence[str],
    line: int,
) -> list[int]:
    """Return the indices of the two columns, or an InputError that asks for their names."""
    if len(numeric) == 2 and not any(found[i][0] for i in numeric):
        return list(numeric)
    places: list[int | None] = []
    for quantity in kind:
        order = _NAMES[quantity].split()

        def place(i: int, order: Sequence[str] = order) -> int:
            name = re.sub(r"[\W\d_]", "", found[i][0]).lower()
            return order.index(name) if name in order else len(order)

        alike = {"area"} if quantity == "radius" else set()
        named = sorted((i for i in numeric if found[i][1] in {quantity, *alike}), key=place)
        if len(named) > 1 and place(named[0]) == place(named[1]):
            both = " and ".join(found[i][0] for i in named[:2])
            raise _refuse(line, f"{both} may each be the {quantity}: keep one of them")
        places.append(named[0] if named else None)
    if len(numeric) == 2 and places.count(None) == 1:
        (known,) = (i for i in places if i is not None)
        other = next(i for i in numeric if i != known)
        places = [other if i is None else i for i in places]
    if None in places or places[0] == places[1]:
        heads = {"radius": "r", "height": "f", "depth": "d", "force": "F"}
        asked = " and ".join(f"the {quantity} {heads[quantity]}" for quantity in kind)
        raise _refuse(line, f"{len(found)} columns; name {asked} in a line above")
    return [i for i in places if i is not None]


def _unit(text: str) -> tuple[str, str, float] | None:
    """Return quantity, name and size in SI units of a unit with its prefix and power of ten."""
    text = text.strip().translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    factor = re.match(_FACTOR, text)
    power = int(factor[2] or factor[3]) if factor else 0
    rest = re.sub(r"^[\s*·x×]+|[\s_-]", "", text[factor.end() :] if factor else text)
    for prefix, exponent in _PREFIXES.items():
        name = rest[len(prefix) :]
        known = _UNITS.get(name) or (_UNITS.get(name.lower()) if len(name) > 2 else None)
        if rest.startswith(prefix) and known and (known[2] or not prefix):
            quantity, size, _ = known
            power += exponent
            symbol = {"length": "m", "force": "N"}.get(quantity, name)
            if size != 1:
                return quantity, rest if not factor else f"10^{power} {name}", size * float(f"1e{power}")
            named = next((p for p, e in _PREFIXES.items() if e == power and p not in "ud"), None)
            shown = f"10^{power} {symbol}" if named is None else f"{named}{symbol}"
            return quantity, shown, float(f"1e{power}")
    return None
