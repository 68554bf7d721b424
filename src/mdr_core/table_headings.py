"""Names and units of the columns of a file.

Nothing is guessed: the unit or the name of a column decides its quantity, or it is the only column
left of two. An unclear heading is an error that names the line and the remedy.
"""

import json
import re
from collections.abc import Sequence
from importlib.resources import files
from typing import Final, NamedTuple

from mdr_core.curve_segments import BRANCHES
from mdr_core.errors import InputError

_WORDS: Final = json.loads(files("mdr_core").joinpath("table_words.json").read_text("utf-8"))
# Prefix -> power of ten; unit -> quantity, size in SI units, and whether it takes a prefix.
_PREFIXES, _UNITS = _WORDS["prefixes"], _WORDS["units"]
# Names of each quantity, and words beside a name that do not change its meaning.
_NAMES, _NEUTRAL = _WORDS["names"], frozenset(_WORDS["neutral"])
# Parts of names of depths that fall towards the sample, and of positions of a cantilever, which are
# not depths until its deflection is subtracted.
_FALLING, _DEFLECTED = _WORDS["falling"], _WORDS["deflected"]
# Words of each kind of segment; of several the first kind is meant, as in "hold at peak load".
_SEGMENTS: Final = {kind: frozenset(words) for kind, words in _WORDS["segments"].items()}
UNITS: Final = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9}
"""Units of length of results, in metres."""
PROFILE, CURVE = ("radius", "height"), ("depth", "force")
HEADS: Final = {"radius": "r", "height": "f", "depth": "d", "force": "F"}
MEASURES: Final = dict.fromkeys(HEADS, "length") | {
    each: each for each in ("force", "area", "time")
}
# Remainder in a name of a factor or a unit that is not understood.
_MULTIPLIER: Final = (
    r"/ ?\S|10 ?\^|[x×*] ?10|1e[-+]?\d|(?i:(?<![a-z])(nano|micro|milli|kilo)(?![a-z]))"
)
# Words before the names, or the units, of columns in a comment.
_LABEL: Final = r"(?i)^(fancyNames|columns|headings?|units?)\s*[:=]\s*"
# Characters of the longest heading, and most lines of text that are searched for headings: tables
# of instruments have a few hundred.
_LONGEST, _MOST = 4_000, 10_000
# Argument of a function after its name: A(h), A(hc), f(r), z(x), F(d).
_ARGUMENT: Final = r"(?<=\w) ?\((h|h_?c|r)\)|(?<=\b\w)\([dx]\)"
# Names of last columns that may be empty in every row.
_REMARKS: Final = frozenset(_WORDS["remarks"])
_SQUARE: Final = r"(²|\^2|\*\*2|2)$"
# A number before a unit, such as 10^-6, 1e-6 or x10-6.
_FACTOR: Final = (
    r"(?i)[x×*·]?\s*(?:(1|1[.,]0*)?\s*[x×*·]?\s*10(?:\^|\*\*)?\(?([-+]\d+)\)?|1e([-+]?\d+))"
)


def words_of(text: str) -> list[str]:
    """Return the words of a text."""
    return [word for word in re.split(r"[\W\d_]+", text) if word]


class Title(NamedTuple):
    """Heading of a column."""

    name: str = ""
    unit: tuple[str, str, float] | None = None
    """Quantity, name and size in SI units of the unit; for an area those of its square root."""
    unknown: str = ""
    """Part of the heading that is not understood."""
    line: int = 0

    @property
    def words(self) -> list[str]:
        """Words of the name in lower case."""
        return words_of(self.name.lower())

    def has(self, parts: Sequence[str]) -> bool:
        """Return True if the name has one of the parts, its words written together."""
        return any(part in "".join(self.words) for part in parts)

    @property
    def falls(self) -> bool:
        """True for a depth that falls towards the sample, such as a separation."""
        return self.has(_FALLING)


class ColumnsError(InputError):
    """A file leaves open which of its columns are meant."""

    def __init__(self, line: int, detail: str, columns: dict[int, str]) -> None:
        super().__init__(("table",), f"Line {line}: {detail}")
        self.columns = columns
        """Names of the columns of numbers by their number, from 1."""


def known_units(quantity: str) -> str:
    """Return the units of a quantity that an error names."""
    units = ["N", "mN", "µN", "nN"] if quantity == "force" else [*UNITS]
    return ", ".join(f"{unit}²" if quantity == "area" else unit for unit in units)


def refuse(line: int, detail: str) -> InputError:
    """Return the error at a line of the file."""
    return InputError(("table",), f"Line {line}: {detail}")


def cells_of(text: str, separator: str) -> list[str]:
    """Return the cells of a line; a separating blank may have a comma before it."""
    if separator == " ":
        return text.replace(", ", " ").split()
    return [cell.strip() for cell in text.split(separator)]


def titles_of(
    heading: Sequence[tuple[int, str]], separator: str, count: int, kind: Sequence[str]
) -> list[Title]:
    """Return the titles of the columns: the last line of names, and the units beneath or beside.

    Data of the measurement, such as `Length; 0,8 mm`, name no column; the last line does.

    Parameters
    ----------
    heading : number and text of each line above the numbers.
    separator : separator of the cells, a blank for blanks of any number.
    count : number of columns.
    kind : names of the two quantities that are read, such as `PROFILE`.
    """
    titles, common = [Title()] * count, None
    for number, text in heading[-_MOST:]:
        if len(text) > _LONGEST:
            continue
        if found := re.search(r"(?i)\bunits?\b\W*(\S+)\W*$", text):
            common = unit_of(found[1]) or common
        # A unit stays with its name where blanks separate columns; a row of units has no names.
        joined = re.sub(_LABEL, "", text)
        if not joined.startswith(("[", "(", "{")):
            joined = re.sub(r" (?=[\[({])", "~", joined)
        joined = re.sub(r"[\[({][^\[\](){}]*[\])}]", lambda b: re.sub("[ ,]", "~", b[0]), joined)
        cells = cells_of(re.sub(r" ?/ ?|(?<=\w) in (?=\w)", "/", joined), separator)
        end = count if _REMARKS.issuperset(each.lower() for each in cells[count:]) else None
        cells = [cell.replace("~", " ") for cell in cells[:end]]
        units = [unit_of(re.sub(r"[\[\](){}]", "", cell)) for cell in cells]
        if all(units):
            # The last columns may have no unit.
            units += [None] * (count - len(cells))
            cells += [""] * (count - len(cells))
        if len(cells) != count or any(re.match(r"[-+]?\d", cell) for cell in cells):
            continue
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
    """Return a title: `r [mm]`, `r (10^-6 m)`, `r/mm`, `r, mm`, `load_micro_N` or `A(h) [mm²]`."""
    cell = re.sub(_ARGUMENT, "", cell)
    # Brackets hold the unit, or words that do not change the meaning: Height (measured) [nm].
    brackets = re.findall(r"([\[({]([^\])}]*)[\])}]?)", cell)
    for bracket, inside in brackets:
        if unit := unit_of(inside):
            return Title(cell.replace(bracket, "").strip(), unit, "", line)
    for bracket, inside in brackets:
        if not _NEUTRAL.issuperset(re.findall(r"\w+", inside.lower())):
            return Title(
                cell.replace(bracket, "").strip(), None, f"the unit {inside.strip()}", line
            )
    parts = re.split(r"(?<=[^\W\d])[ _]|[/,]", cell)
    # The unit follows the name, or is a word within it: Defl_nN_Ex.
    ends = [(i, len(parts)) for i in range(1, len(parts))]
    ends += [(i, i + 1) for i in range(1, len(parts)) if len(parts[i]) > 1]
    for i, end in ends:
        if unit := unit_of(" ".join(parts[i:end])):
            return Title(" ".join(parts[:i] + parts[end:]).strip(), unit, "", line)
    unknown = f"the unit or factor in “{cell.strip()}”" if re.search(_MULTIPLIER, cell) else ""
    return Title(cell.strip(), None, unknown, line)


def _rank(title: Title, quantity: str) -> int | None:
    """Rank of a column for a quantity, last if only its unit fits; None if it does not fit."""
    order, measure = _NAMES[quantity], title.unit and title.unit[0]
    # A known unit decides, whatever the name.
    if measure not in {None, MEASURES[quantity]} and (measure, quantity) != ("area", "radius"):
        return None
    if quantity == "depth" and title.has(_DEFLECTED):
        return None
    words = [word for word in title.words if word not in _NEUTRAL]
    for name in ("".join(title.words), *words[: len(words) == 1]):
        if name in order:
            return order.index(name)
    # A length may be a radius or a height; an area is the area function of a tip.
    return len(order) if measure and (quantity not in PROFILE or measure == "area") else None


def places_of(
    titles: Sequence[Title], numeric: Sequence[int], kind: Sequence[str], line: int
) -> list[list[int]]:
    """Return the indices of the columns of each quantity: one, or loading and unloading.

    Parameters
    ----------
    titles : titles of all columns.
    numeric : indices of the columns of numbers.
    kind : names of the two quantities that are read, such as `PROFILE`.
    line : number of the first line of numbers, to which an error points.

    Raises
    ------
    ColumnsError : columns that the titles do not distinguish; it requests their names.
    """
    if len(numeric) == 2 and kind == PROFILE and not any(titles[i].name for i in numeric):
        return [[i] for i in numeric]
    names = {i + 1: titles[i].name for i in numeric}
    places = [best_of(titles, numeric, quantity) for quantity in kind]
    if kind == CURVE and (wrong := _of_cantilever(titles, numeric, *places)):
        detail = (
            f"column {wrong[0] + 1} is a position or a deflection of a cantilever, no depth: take "
            "the tip-sample separation, or name the column of depths d"
        )
        raise ColumnsError(line, detail, names)
    if kind == CURVE and all(_are_branches([titles[i] for i in best]) for best in places):
        return [sorted(best, key=lambda i: str(segment_of(titles[i].name))) for best in places]
    for quantity, best in zip(kind, places, strict=True):
        if len(best) > 1:
            both = " and ".join(titles[i].name for i in best[:2])
            detail = f"{both} may each be the {quantity}: name one of them {quantity}"
            raise ColumnsError(line, detail, names)
    if len(numeric) == 2 and [] in places:
        # If one of two columns is known, the other one is the missing quantity.
        left = [i for i in numeric if [i] not in places and not titles[i].unit]
        places[places.index([])] = left[:1]
    if [] in places:
        asked = " and ".join(f"the {quantity} {HEADS[quantity]}" for quantity in kind)
        form = "r [mm];f [µm]" if kind == PROFILE else "d [nm];F [mN]"
        detail = f"{len(titles)} columns; name {asked} in a line above, as {form}"
        raise ColumnsError(line, detail, names)
    return places


def _of_cantilever(
    titles: Sequence[Title], numeric: Sequence[int], depths: list[int], forces: list[int]
) -> list[int]:
    """Return the columns of a curve without a depth that include the deflection of a cantilever."""
    if not depths:
        return [i for i in numeric if [i] != forces and titles[i].has(_DEFLECTED)]
    # Beside a deflection a position is the cantilever's.
    if not any(titles[i].has(_DEFLECTED) for i in forces):
        return []
    return [i for i in depths if "position" in titles[i].words and not titles[i].falls]


def best_of(titles: Sequence[Title], numeric: Sequence[int], quantity: str) -> list[int]:
    """Return the indices of the columns with the first of the names of a quantity."""
    ranks = {i: rank for i in numeric if (rank := _rank(titles[i], quantity)) is not None}
    return [i for i, rank in ranks.items() if rank == min(ranks.values())]


def _are_branches(titles: Sequence[Title]) -> bool:
    """Return whether two columns are one quantity on loading and on unloading: z_Ex and z_Rt."""
    kinds = sorted(str(segment_of(each.name)) for each in titles)
    return tuple(kinds) == BRANCHES and titles[0].unit == titles[1].unit


def segments_of(columns: Sequence[list[str]]) -> list[str] | None:
    """Return the kind of segment of each row, from the first column of such words only.

    Empty cells continue the segment above.
    """
    for cells in columns:
        known = {cell: segment_of(cell) for cell in {*cells} - {""}}
        # A column with a single word is not a column of segments.
        if None not in (kinds := set(known.values())) and len(kinds) > 1 and cells[0]:
            for row in range(1, len(cells)):
                cells[row] = cells[row] or cells[row - 1]
            return [str(known[cell]) for cell in cells]
    return None


def segment_of(text: str) -> str | None:
    """Return the kind of segment that a word of a text names, or None."""
    words = words_of(text.lower())
    return next((kind for kind, known in _SEGMENTS.items() if not known.isdisjoint(words)), None)


def unit_of(text: str) -> tuple[str, str, float] | None:
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
    # A power of ten before a square multiplies the area, and half of it the root.
    is_square = re.search(_SQUARE, rest) and power % 2 == 0
    root = unit_of(f"1e{power // 2} {re.sub(_SQUARE, '', rest)}") if is_square else None
    return ("area", *root[1:]) if root else None
