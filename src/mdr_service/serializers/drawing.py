"""Drawing of the panels of a picture with Matplotlib.

Many points are joined by a line. Few points are marks: no values between them were computed.
"""

import gc
import io
from collections.abc import Sequence
from typing import Any, Final

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from mdr_service.serializers.panels import FRAME, LINE, Map, Panel, Units, label

# Beside infinite values the axes end at this multiple of the highest decile, and the colours of a
# map at one of the highest fiftieth.
_HEADROOM: Final = 1.5
# Usual width of a picture, and height of a panel [mm].
_WIDTH, _PANEL = 180, 65
# Pixels per inch of a PNG, and of maps in other formats.
_DPI: Final = 150.0
# Maps less square than this have unequal scales.
_FLAT: Final = 0.2
_STYLE: Final[dict[Any, Any]] = {
    "axes.formatter.limits": (-2, 4),
    "axes.formatter.use_mathtext": True,
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "grid.alpha": 0.25,
    "lines.linewidth": 1.4,
    "lines.markersize": 4.0,
    # Text stays text: it can be searched, selected and read aloud.
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
    # Equal results give identical bytes.
    "svg.hashsalt": "mdr",
}
# Time and version of the program would differ from run to run.
_METADATA: Final = {
    "svg": {"Date": None, "Creator": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
# Matplotlib accepts more types than its annotations declare.
_Axes = Any


def draw(
    title: str,
    panels: Sequence[Panel | Map],
    name: str,
    size: tuple[int, int] | None,
    units: Units | None,
) -> bytes:
    """Return a picture with its panels above each other.

    Parameters
    ----------
    title : title of the legend.
    panels : the panels, which share the abscissa.
    name : format: ``svg``, ``png`` or ``pdf``.
    size : width and height [mm]; by default the usual size.
    units : units that the labels name.
    """
    # The parts of a figure refer to it, which would keep the previous figure in memory.
    gc.collect()
    usual = _WIDTH, FRAME + len(panels) * _PANEL
    width, height = size or usual
    is_small = width < usual[0] or height < usual[1]
    content = io.BytesIO()

    def text(quantity: str) -> str:
        # Characters of a line that fit beside a panel.
        return label(quantity, units, width=11 if is_small else 28)

    with mpl.rc_context(_STYLE | {"font.size": 6.5 if is_small else 9.7}):
        figure = Figure((width / 10, height / 10, "cm"), layout="constrained")
        axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        named: dict[str, Any] = {}
        for each, panel in zip(axes, panels, strict=True):
            if isinstance(panel, Map):
                colors = _draw_map(each, panel)
                # Along the whole height of a map there is room for longer lines.
                words = label(panel.name, units, width=20 if is_small else 28)
                figure.colorbar(colors, ax=each, aspect=12, label=words)
            else:
                _draw_curves(each, panel)
            each.set_ylabel(text(panel.y))
            named |= {line.get_label(): line for line in each.get_legend_handles_labels()[0]}
        # Keep the right end free: Matplotlib writes the axis' power of ten there.
        axes[-1].set_xlabel(text(panels[0].x), loc="left" if is_small else "center")
        if named or title:
            style: Any = {"loc": "outside upper center", "ncols": 1 if is_small else 3}
            figure.legend(list(named.values()), list(named), title=title or None, **style)
        # However large a drawing is, its maps have the pixels of the usual width.
        dpi = _DPI if name == "png" else _DPI * min(1.0, _WIDTH / max(width, height))
        figure.savefig(content, format=name, metadata=_METADATA[name], dpi=dpi)
    return content.getvalue()


def _draw_curves(axes: _Axes, panel: Panel) -> None:
    """Draw curves, with gaps at infinite values."""
    bound, places = 0.0, set[float]()
    for index, (x, y, name, is_reference, is_measured) in enumerate(panel.curves):
        style = "." if is_measured else "o" if x.size < LINE else "--" if is_reference else "-"
        finite = np.isfinite(y)
        if finite.any():
            places |= set(x[~finite].tolist())
            heights = np.abs(y[finite])
            if not finite.all() and y.size >= LINE and heights.any():
                even = np.interp(np.linspace(x[0], x[-1], y.size), x[finite], heights)
                heights = _HEADROOM * np.quantile(even[even > 0], [0.9])
            bound = max(bound, *heights)
        shown = name if finite.any() else f"{name} (∞)".strip()
        color = "0.4" if is_reference else f"C{index}"
        axes.plot(x, np.where(finite, y, np.nan), style, color=color, label=shown)
    # Extend the axes to include zero.
    axes.axhline(0.0, linewidth=0.0)
    if panel.x not in {"radius", "x", "z"}:
        axes.axvline(0.0, linewidth=0.0)
    for place in places:
        axes.axvline(place, linestyle=":", linewidth=0.8, color="0.4", label="∞")
    if places and bound:
        axes.set_ylim(*np.clip(axes.dataLim.intervaly, -bound, bound))


def _draw_map(axes: _Axes, panel: Map) -> Any:
    """Draw stresses in a plane, with the depth downwards, and return their colours."""
    # Peaks of few points would leave a single colour for the others.
    bound = _HEADROOM * np.quantile(np.abs(panel.values), 0.98, method="lower")
    shown = np.ma.masked_invalid(panel.values)
    signed = shown.min() < 0
    largest = min(np.abs(shown).max(), bound) or 1.0
    style = {"cmap": "RdBu_r" if signed else "viridis", "vmin": -largest * signed, "vmax": largest}
    # Each value fills the cell around its point: no values between points were computed.
    colors = axes.pcolormesh(panel.at_x, panel.at_z, shown, rasterized=True, **style)
    axes.grid(visible=False)
    if np.ptp(panel.at_z):
        axes.set_ylim(panel.at_z[-1], panel.at_z[0])
    if _FLAT < np.ptp(panel.at_z) / (np.ptp(panel.at_x) or 1.0) < 1 / _FLAT:
        axes.set_aspect("equal")
    return colors
