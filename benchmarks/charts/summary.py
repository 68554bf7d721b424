"""Summary chart: time of each query, and of the fastest other program at three accuracies.

`make chart-summary`. It draws the files of the other charts and measures nothing. A program that
does not reach an accuracy at any setting has no point there.
"""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

from drawing import BLUE, GREEN, MDR_COLOR, VIOLET, panels, rows_of, save, table

if TYPE_CHECKING:
    from collections.abc import Iterator

LEVELS = (1e-2, 1e-4, 1e-6)
COLORS = (BLUE, GREEN, VIOLET)
HEADER = ("query", "MDR [s]", *(f"fastest other at {level:.0e} [s]" for level in LEVELS))
#: File, column of the error, and the query that it measures.
OTHERS = (
    ("hertz_contact", "largest error", "pressure on 64² pixels"),
    ("partial_slip", "rms error", "shear stress on 64² pixels"),
    ("history", "largest error / largest force", "history of 300 steps"),
    ("contact_laws", "largest error / largest force", "one time step of a contact"),
    ("wear_evolution", "largest error / depth", "wear over 10⁴ cycles"),
)
#: Times of MDR are those of these settings, if there are several.
SETTINGS = {"64²", "", "resolution 48, rtol 1e-07", "1000"}
Row = tuple[str, float, list[float]]


def from_pareto() -> Iterator[Row]:
    """Pressure and shear stress at 1000 radii."""
    found: dict[str, Row] = {}
    for row in rows_of("pareto"):
        quantity = "shear stress" if row["quantity"] == "traction" else row["quantity"]
        name = f"{quantity}, {row['case']}"
        _, _, others = found.setdefault(name, (name, float(row["MDR [s]"]), []))
        if float(row["largest error"]) in LEVELS:
            others.append(float(row["reference [s]"]))
    yield from found.values()


def of(name: str, error: str, query: str) -> Row:
    """A chart whose rows are MDR and other programs at several settings."""
    rows = rows_of(name)
    setting, time = list(rows[0])[1:3]

    def seconds(row: dict[str, str]) -> float:
        return float(row[time])

    own = [row for row in rows if row["method"].startswith("MDR")]
    chosen = [row for row in own if row[setting] in SETTINGS]
    others = [row for row in rows if row not in own]
    fastest = [
        min((seconds(row) for row in others if float(row[error]) <= level), default=inf)
        for level in LEVELS
    ]
    return query, min(map(seconds, chosen)), fastest


def main() -> None:
    rows = [*from_pareto(), *(of(*each) for each in OTHERS)]
    table(
        HEADER,
        [(name, own, *("none" if t == inf else t for t in others)) for name, own, others in rows],
        "summary",
    )
    figure, (axis,) = panels(1, 1, 5.0)
    for place, (_, own, others) in enumerate(rows):
        for shift, time, color in zip((-0.2, 0.0, 0.2), others, COLORS, strict=True):
            axis.plot([time], [place + shift], "o", color=color, markersize=4)
        missing = [
            f"{level:.0e}" for level, time in zip(LEVELS, others, strict=True) if time == inf
        ]
        if missing:
            at = "" if len(missing) == len(LEVELS) else f" at {' and '.join(missing)}"
            axis.text(0.8, place, f"no other{at}", color="0.35", va="center")
        axis.plot([own], [place], "|", color=MDR_COLOR, markersize=11, markeredgewidth=2.5)
    for level, color in zip(LEVELS, COLORS, strict=True):
        axis.plot([], [], "o", color=color, label=f"fastest other program, error ≤ {level:.0e}")
    axis.plot([], [], "|", color=MDR_COLOR, markeredgewidth=2.5, label="MDR")
    axis.set_xscale("log")
    axis.set_xlim(5e-8, 30)
    axis.set_yticks(range(len(rows)), [row[0] for row in rows])
    axis.invert_yaxis()
    axis.set_xlabel("CPU time [s]")
    figure.legend(loc="outside upper center", ncols=2)
    foot = "from the files of the other charts; without another program: subsurface, torsion, fits"
    save(figure, "summary", foot)


if __name__ == "__main__":
    main()
