"""Chart of measured tables: true and stated error of depth and force over the number of points.

`make chart-tables`. The tables are random samples of ten bodies with closed solutions, exact,
rounded or noisy, on 4 to 200 points; four contact radii are compared for each.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from drawing import GREY, MDR_COLOR, panels, save, table
from machine import footer
from tests.oracles import table_campaign

from mdr_core.normal import solve
from mdr_core.profiles import Tabulated

#: Tables that are drawn, and classes of the number of points.
TABLES, EDGES = 600, np.array([4, 6, 9, 14, 22, 35, 55, 90, 201])
HEADER = ("points", "errors", "median true error", "median stated error", "covered")
LOWEST = 1e-12
#: Larger errors are drawn here.
HIGHEST = 10.0


def main() -> None:
    found = []
    for seed in range(TABLES):
        given = table_campaign.drawn(seed)
        a = table_campaign.PARTS * np.abs(given.r).max()
        a = a[a > 1.001 * given.body.first_radius]
        if not a.size:
            continue
        profile = Tabulated(given.r, given.f, given.breaks, given.uncertainty)
        own, exact = (solve(each, 1.0, contact_radius=a) for each in (profile, given.body))
        names = ("indentation_depth", "normal_force")
        missed = np.max([abs(1 - getattr(exact, n) / getattr(own, n)) for n in names], axis=0)
        stated = np.asarray(own.data_error) + own.error_estimate
        found += [(given.r.size, *pair) for pair in zip(missed, stated, strict=True)]
    count, missed, stated = np.maximum(np.array(found), LOWEST).T
    figure, (axis,) = panels(1, 1, 3.4)
    # A force of almost zero has an error of any size.
    shown = np.minimum(missed, HIGHEST)
    axis.loglog(count, shown, ".", color=GREY, markersize=2, alpha=0.5, rasterized=True)
    rows = []
    for first, end in pairwise(EDGES):
        own = (count >= first) & (count < end)
        middles = np.median(missed[own]), np.median(stated[own])
        covered = np.mean(missed[own] <= stated[own])
        rows.append((f"{first} to {end - 1}", own.sum(), *(f"{x:.2g}" for x in middles)))
        rows[-1] += (f"{covered:.3f}",)
    places = np.sqrt(EDGES[:-1] * (EDGES[1:] - 1.0))
    for column, style, name in ((2, "-", "median true error"), (3, "--", "median stated error")):
        axis.loglog(places, [float(row[column]) for row in rows], style, c=MDR_COLOR, label=name)
    axis.set_xlabel("points of the table")
    axis.set_ylabel("error of depth or force, 10 or more at 10")
    axis.legend()
    axis.set_title("Points: true errors of random tables; lines: medians")
    save(figure, "tables", footer(), [])
    table(HEADER, rows, "tables")


if __name__ == "__main__":
    main()
