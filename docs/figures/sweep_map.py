"""Draw the parameter study of docs/sweeps.md: stick radius and dissipated energy.

python docs/figures/sweep_map.py

Runs the sweep over a million cases first, with the command shown on the page.
"""

import sys
from argparse import ArgumentParser
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import matplotlib as mpl
import numpy as np
import pyarrow.parquet as pq
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mdr_sweep import command

FOLDER: Final = Path(__file__).parent
POINTS: Final = 1000
# Every fourth case in each direction makes a small figure that looks smooth.
STEP: Final = 4
TEMPLATE: Final = """{
  "profile": {"kind": "paraboloid", "radius": 0.01},
  "material": {"bodies": [{"youngs_modulus": 210e9, "poissons_ratio": 0.3},
                          {"youngs_modulus": 210e9, "poissons_ratio": 0.3}]},
  "friction_coefficient": 0.3,
  "load": {"normal_force": "1:1000:1000:log"},
  "tangential": {"tangential_displacement": "1e-9:1e-5:1000:log"}
}
"""
RESULTS: Final = "contact_radius,stick_radius,regime,dissipated_energy"
Map = NDArray[np.float64]


def swept() -> dict[str, Map]:
    """Columns of the sweep, load by amplitude."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "study.json").write_text(TEMPLATE)
        template, result = str(folder / "study.json"), str(folder / "study.parquet")
        parser = ArgumentParser()
        command.declare(parser)
        options = ["--template", template, "--answers", RESULTS, "--out", result]
        if command.run(parser.parse_args(["tangential", *options])):
            sys.exit("the sweep failed")
        table = pq.read_table(result)
    numbers = (name for name in table.column_names if name not in {"regime", "warning", "error"})
    return {name: table[name].to_numpy().reshape(POINTS, POINTS) for name in numbers}


def draw(columns: dict[str, Map]) -> Figure:
    """Draw two maps with contour lines."""
    force, amplitude = columns["load.normal_force"], columns["tangential.tangential_displacement"]
    figure = Figure(figsize=(7.3, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    sticks = columns["stick_radius"] / columns["contact_radius"]
    # The loss per cycle is four times that of first loading to its amplitude.
    dissipated = 4 * columns["dissipated_energy"]
    _map(left, amplitude, force, sticks, levels=[0.8, 0.9, 0.95])
    _map(
        right, amplitude, force, dissipated, levels=10.0 ** np.arange(-12, -4, 2), logarithmic=True
    )
    left.set(title="stick radius over contact radius, $c/a$", ylabel="normal force $F_N$ in N")
    right.set(title="dissipated energy per cycle, in J")
    for axes in (left, right):
        axes.set_xlabel("amplitude of the displacement $u_x$ in m")
        # Full slip beyond this line.
        axes.contour(amplitude, force, sticks > 0, levels=[0.5], colors="black", linewidths=1.4)
    return figure


def _map(
    axes: Axes, x: Map, y: Map, values: Map, *, levels: object, logarithmic: bool = False
) -> None:
    part = (slice(None, None, STEP), slice(None, None, STEP))
    shown = np.maximum(values[part], 1e-17) if logarithmic else values[part]
    norm = LogNorm() if logarithmic else None
    # The left map is mostly bright, the right one mostly dark.
    color = "white" if logarithmic else "black"
    mesh = axes.pcolormesh(x[part], y[part], shown, norm=norm, cmap="cividis", rasterized=True)
    # Gaps for labels are cut in the scales that the axes have now.
    axes.set(xscale="log", yscale="log")
    lines = axes.contour(x[part], y[part], shown, levels=levels, colors=color, linewidths=0.6)
    axes.clabel(lines, fontsize=8, fmt="%g" if not logarithmic else "%.0e")
    axes.figure.colorbar(mesh, ax=axes)


def main() -> None:
    """Sweep, and draw."""
    with mpl.rc_context({"svg.hashsalt": "mdr", "font.size": 9.0}):
        figure = draw(swept())
        figure.savefig(FOLDER / "sweep_map.svg", dpi=110, metadata={"Date": None})


if __name__ == "__main__":
    main()
