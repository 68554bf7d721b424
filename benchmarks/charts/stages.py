"""Time of a small query by stage, for each profile kind and endpoint: `make chart-stages`.

Validation, computation and serialisation are timed in this process with the functions of the
service. Within the computation, the outermost calls of `ROOTS` and `QUADRATURE` are timed as well.
HTTP is what a request on one open loopback connection takes beyond these stages: framework, sockets
and waiting, which do not depend on the profile, measured with a flat punch. Other work on the
machine only adds time: of many repetitions the fastest counts.

The label of the measured version, "after" by default, is the argument; the chart shows all
labels in its table.
"""

from __future__ import annotations

import csv
import json
import sys
from contextlib import ExitStack
from functools import partial
from importlib import import_module
from time import perf_counter
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

import numpy as np
import small_queries
import wire
import wire_ratio
from drawing import FOLDER, panels, save, table
from machine import footer

from mdr_service.queries import QUERIES
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.serializers import json as json_format

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes

ROOTS = (
    ("mdr_core.equivalent_1d", "invert"),
    ("mdr_core.wear.worn_annulus", "invert"),
    ("mdr_core.wear.limiting_stick", "invert"),
    ("mdr_core.abel.subpanels.Subpanels", "inverse"),
)
QUADRATURE = (
    ("mdr_core.tangential", "slip_moment"),
    ("mdr_core.normal", "largest_stress"),
    ("mdr_core.profiles.base", "power_law_integral"),
    ("mdr_core.profiles.tipped", "power_law_integral"),
    ("mdr_core.profiles.capped_paraboloid", "power_law_integral"),
    ("mdr_core.equivalent_1d", "_narrow_step"),
    ("mdr_core.interval_moments.IntervalMoments", "over_narrow"),
    ("mdr_core.interval_moments.IntervalMoments", "over_wide"),
    ("mdr_core.wear.worn_annulus", "annulus_integrals"),
    ("mdr_core.fields.normal", "stress"),
    ("mdr_core.fields.tangential", "stress"),
)
ENDPOINTS = ("normal", "tangential", "stress", "tangential/history", "wear")
STAGES = ("validation", "root finding", "quadrature", "other", "serialisation", "HTTP")
COLORS = ("#1f5fa8", "#c1272d", "#e0922f", "#8a6d3b", "#2b8a3e", "0.7")
HEADER = ("label", "endpoint", "kind", *(f"{name} [us]" for name in STAGES), "all [us]")
SECONDS, LEAST, ASKED, SHORTEST = 0.25, 5, 500, "flat_punch"
# Length of the axis over the longest bar of the last label. Longer bars are cut, and end with their
# time.
AXIS_TO_LAST = 1.25


class Timed:
    """Seconds in the outermost calls of functions, since they were last taken."""

    def __init__(self) -> None:
        self.inside = False
        self.seconds = {"root finding": 0.0, "quadrature": 0.0}

    def wrap(self, stage: str, run: Callable[..., Any]) -> Callable[..., Any]:
        """Return the function with a clock."""

        def timed(*args: Any, **named: Any) -> Any:
            if self.inside:
                return run(*args, **named)
            self.inside, start = True, perf_counter()
            try:
                return run(*args, **named)
            finally:
                self.inside = False
                self.seconds[stage] += perf_counter() - start

        return timed

    def patches(self) -> ExitStack:
        """Put a clock on every function."""
        stack = ExitStack()
        for stage, places in (("root finding", ROOTS), ("quadrature", QUADRATURE)):
            for path, name in places:
                module, _, owner = path.rpartition(".")
                holder = getattr(import_module(module), owner)
                stack.enter_context(
                    patch.object(holder, name, self.wrap(stage, getattr(holder, name)))
                )
        return stack


def once(name: str, text: bytes, timed: Timed) -> list[float]:
    """Seconds of each stage but the last."""
    question = QUERIES[name]
    timed.seconds = dict.fromkeys(timed.seconds, 0.0)
    clock = [perf_counter()]
    query = SCHEMAS[name].model.model_validate_json(text)
    clock.append(perf_counter())
    with np.errstate(all="ignore"):
        result = question.result(query, question.solve(query))
    clock.append(perf_counter())
    json_format.write(result)
    clock.append(perf_counter())
    validation, computation, writing = np.diff(clock)
    parts = list(timed.seconds.values())
    return [validation, *parts, computation - sum(parts), writing]


def fastest(run: Callable[[], list[float]]) -> np.ndarray:
    """Times of the fastest run."""
    end, found = perf_counter() + SECONDS, []
    while perf_counter() < end or len(found) < LEAST:
        found.append(run())
    return np.array(min(found, key=sum))


def measured(label: str) -> list[list[str]]:
    """Rows of the table, for every endpoint and kind."""
    rows, timed = [], Timed()

    def stages(kind: str, endpoint: str) -> np.ndarray:
        text, name = body(kind, endpoint), endpoint.rpartition("/")[2]
        with timed.patches():
            return fastest(lambda: once(name, text, timed))

    command = [sys.executable, "-m", "mdr_command", "serve", "--port"]
    for endpoint in ENDPOINTS:
        text = body(SHORTEST, endpoint)
        with wire_ratio.server(command) as port, wire.connection(port) as link:
            ask = partial(wire.ask, link, text, json_format.MEDIA_TYPE, endpoint)
            whole = min(ask() for _ in range(ASKED))
        rest = max(whole - stages(SHORTEST, endpoint).sum(), 0.0)
        for kind in small_queries.kinds()[:-1]:
            times = [*stages(kind, endpoint), rest]
            rows.append([label, endpoint, kind, *(f"{t * 1e6:.0f}" for t in (*times, sum(times)))])
    return rows


def body(kind: str, endpoint: str) -> bytes:
    """Text of a request."""
    return json.dumps(small_queries.requests(kind)[endpoint]).encode()


def draw(ax: Axes, rows: list[list[str]], kinds: list[str]) -> None:
    """Draw the stages of one endpoint, for each kind the bars of all labels."""
    labels = list(dict.fromkeys(row[0] for row in rows))
    end = AXIS_TO_LAST * max(float(row[-1]) for row in rows if row[0] == labels[-1]) / 1e3
    for number, label in enumerate(labels):
        mine = {row[2]: row for row in rows if row[0] == label}
        parts = np.array([[float(x) for x in mine[kind][3:9]] for kind in kinds])
        left = np.zeros(len(kinds))
        place = np.arange(len(kinds)) + (number - (len(labels) - 1) / 2) * 0.4
        for column, name, color in zip(parts.T, STAGES, COLORS, strict=True):
            own = name if number == len(labels) - 1 else None
            ax.barh(place, column / 1e3, 0.36, left=left / 1e3, color=color, label=own)
            left += column
        for y, time in zip(place, left / 1e3, strict=True):
            if time > end:
                ax.text(end, y, f" {time:.3g}", fontsize=6, va="center")
    ax.set_xlim(0.0, end)
    ax.set_yticks(range(len(kinds)), [""] * len(kinds))
    ax.set(xlabel="ms")
    ax.invert_yaxis()
    ax.grid(visible=False, axis="y")


def main(label: str) -> None:
    path = FOLDER / "stages.csv"
    known = list(csv.reader(path.open(encoding="utf-8")))[1:] if path.exists() else []
    rows = [row for row in known if row[0] != label] + measured(label)
    table(HEADER, rows, "stages")
    kinds = list(dict.fromkeys(row[2] for row in rows))
    figure, axes = panels(1, len(ENDPOINTS), 2.4, 5.0)
    for ax, endpoint in zip(axes, ENDPOINTS, strict=True):
        draw(ax, [row for row in rows if row[1] == endpoint], kinds)
        ax.set_title(f"/v1/{endpoint}")
    axes[0].set_yticklabels(kinds, fontsize=7)
    shown = axes[0].get_legend_handles_labels()
    figure.legend(*shown, loc="outside upper center", ncols=len(STAGES))
    save(figure, "stages", footer("fastapi", "pydantic", "uvicorn", "orjson"))


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "after")
