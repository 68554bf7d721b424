"""Responses of the service to all cases, the table that compares them, and its summary."""

import csv
import io
import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import floor, log10
from textwrap import fill
from typing import Any, Final

from tests.conftest import Client

from verification import (
    abel_pairs,
    adhesion,
    conforming_balls,
    frictional_contacts,
    layers,
    measured,
    model_errors,
    normal_contacts,
    oblique_impacts,
    ring_elements,
    stresses,
    thresholds,
    torsion,
)
from verification.case import Case
from verification.sources import SOURCES

# Paragraphs of the page, wrapped when they are written.
_NOTES: Final = (
    (
        "[verification.csv](verification.csv) lists every case with its equation, reference value "
        "and deviation. The table of sources has the bound and the deviation of the case that "
        "comes closest to its bound."
    ),
    (
        "A published reference value is printed in its source, or a closed form of the source "
        "evaluated with 30 digits in `verification/`. Deviations, bounds and uncertainties of the "
        "reference are relative to the reference value, for stresses to the peak pressure. "
        "Deviations are rounded up to one digit; below 1e-11 they are rounding error, which varies "
        "with the processor."
    ),
    (
        "`model_error` is an estimate: its deviation is the factor between it and the error "
        "against the more complete model of the source, less one. The bound of a force with "
        "transverse slip is the estimate, 0.2 (ν/(4 − 2ν))²."
    ),
    (
        "The tables of Buie's pair no. 1 converge slowly, with the root of the spacing: the "
        "pressure jumps to zero at the edge, where the slope of g is infinite."
    ),
    (
        "Measured impacts (`kharaz`) and finite elements (`wu`) are read from figures, with the "
        "uncertainty of reading alone; their deviations refer to the tangential restitution "
        "e_t, and to w/(mu v)."
    ),
    (
        "For the punch with rounded edges of Ciavarella (Int. J. Solids Struct. 36 (1999) "
        "4149-4181) no printed numbers were available: its cases are problems 3 and 4 of `mdr-5`, "
        "equations (5.59) to (5.70), and ring elements. For the same reason the impacts of glass "
        "and cellulose acetate by Foerster et al. (Phys. Fluids 6 (1994) 1108-1115) are left out."
    ),
)


# Solutions and formulas that are evaluated here.
_OWN: Final = (
    *("compressed-ball", "conforming-balls", "layer-equation", "first-order"),
    *("transverse-slip", "ring-elements"),
)
# Deviations below it, of results conditioned like a difference of loads, are rounding error.
_ROUNDING: Final = 1e-11


@dataclass(frozen=True)
class Row:
    """Case with the deviation of the service."""

    case: Case
    deviation: float

    @property
    def met(self) -> bool:
        """True if the deviation is within the bound."""
        return self.deviation <= self.case.bound


def cases() -> Iterator[Case]:
    """Yield every case."""
    own = (normal_contacts, adhesion, frictional_contacts, oblique_impacts, stresses, abel_pairs)
    others = conforming_balls, measured, model_errors, layers, ring_elements, torsion, thresholds
    for module in (*own, *others):
        yield from module.cases()


def results(client: Client) -> list[Row]:
    """Return every case with its deviation; equal requests are sent once."""
    seen: dict[str, Any] = {}
    rows = []
    for case in cases():
        key = case.path + json.dumps(case.request)
        if key not in seen:
            response = client.post(case.path, case.request)
            if response.status_code != 200:
                raise RuntimeError(f"{case.source}, {case.case}: {response.text}")
            seen[key] = response.json()
        rows.append(Row(case, case.deviation(seen[key])))
    return rows


def in_order(rows: Iterable[Row]) -> list[Row]:
    """Return the rows in the order of their sources."""
    return sorted(rows, key=lambda row: list(SOURCES).index(row.case.source))


def table(rows: Iterable[Row]) -> str:
    """Return the CSV table of all cases."""
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\n")
    lines.writerow(
        ("source", "equation", "case", "reference", "uncertainty", "bound", "deviation", "met")
    )
    for row in in_order(rows):
        case = row.case
        sizes = _size(case.uncertainty, 0), _size(case.bound, 0), _size(row.deviation, _ROUNDING)
        reference = f"{float(case.expected):.9g}"
        met = "yes" if row.met else "no"
        lines.writerow((case.source, case.equation, case.case, reference, *sizes, met))
    return text.getvalue()


def page(rows: Iterable[Row]) -> str:
    """Return the page with a summary of the cases of each source."""
    rows = in_order(rows)
    used = [key for key in SOURCES if any(row.case.source == key for row in rows)]
    met = sum(row.met for row in rows)
    own = sum(row.case.source in _OWN for row in rows)
    summary = (
        f"{len(rows)} cases, each sent to the HTTP service by `make verification`: "
        f"{len(rows) - own} from published equations, numbers and codes of "
        f"{len(used) - len(_OWN)} sources, and {own} against independent solutions "
        f"({', '.join(f'`{key}`' for key in _OWN)}). {met} are within their bounds."
    )
    lines = ["# Verification", ""]
    for text in (summary, *_NOTES):
        lines += [fill(text, 120), ""]
    heading = "| key | source | cases | bound | deviation |"
    lines += ["## Sources", "", heading, "|---|---|---|---|---|"]
    for key in used:
        own_rows = [row for row in rows if row.case.source == key]
        # The bounds of a source differ: the row closest to its bound stands for them.
        worst = max(own_rows, key=lambda row: row.deviation / row.case.bound)
        lines.append(
            f"| {key} | {SOURCES[key]} | {len(own_rows)} "
            f"| {_size(worst.case.bound, 0)} | {_size(worst.deviation, _ROUNDING)} |"
        )
    return "\n".join(lines) + "\n"


def _size(value: float, least: float) -> str:
    """Return a magnitude, rounded up to one digit if it is a deviation."""
    if value == 0 and least == 0:
        return "exact"
    if value <= least:
        return f"< {least:.0e}"
    if least == 0:
        return f"{value:.1g}"
    decade = 10.0 ** floor(log10(value))
    return f"{-(-value // decade) * decade:.0e}"
