"""Pictures: a plot drawn by Matplotlib, as SVG, PNG or PDF."""

import io
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mdr_service.plots.plot import Curve, Map, Mark, Panel, Plot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MEDIA_TYPES: Final = {"svg": "image/svg+xml", "png": "image/png", "pdf": "application/pdf"}

# Millimetres in an inch.
_INCH: Final = 25.4
# Usual width of the picture and height of a panel, a single and one of several, in inches.
_WIDTH, _SINGLE, _PANEL = 7.2, 4.0, 2.6
# Marks closer than this share of the axis share one label.
_CLOSE: Final = 0.025
# Largest number of levels of a map.
_LEVELS: Final = 20
# Levels end where the highest values of a few points would exceed the others much.
_QUANTILE, _PEAK = 0.99, 1.5
# More points than this hide their curve.
_MAX_POINTS: Final = 60
_STYLE: Final[dict[Any, Any]] = {
    "axes.formatter.limits": (-3, 4),
    "axes.grid": True,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "font.size": 9.0,
    "grid.alpha": 0.25,
    "grid.linewidth": 0.5,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    # Text stays text: it can be searched, selected and read aloud.
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
    # Pixels per inch of a PNG.
    "savefig.dpi": 150.0,
    # Equal plots give identical bytes.
    "svg.hashsalt": "mdr",
}
# Time and version of the program would differ from run to run.
_METADATA: Final = {
    "svg": {"Date": None, "Creator": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}


def write(plot: Plot | Map, name: str, size: tuple[int, int] | None = None) -> bytes:
    """Return the picture in a format of `MEDIA_TYPES`, with width and height in millimetres.

    Equal plots give identical bytes.
    """
    import matplotlib as mpl  # noqa: PLC0415 -- loading takes longer than all other imports
    from matplotlib.figure import Figure  # noqa: PLC0415 -- as above

    content = io.BytesIO()
    with mpl.rc_context(_STYLE):
        figure = Figure(layout="constrained")
        if isinstance(plot, Map):
            figure.set_size_inches(_WIDTH, _SINGLE)
            _draw_map(figure, plot)
        else:
            count = len(plot.panels)
            figure.set_size_inches(_WIDTH, 0.9 + (_SINGLE if count == 1 else _PANEL * count))
            _draw_plot(figure, plot)
        if size:
            figure.set_size_inches(size[0] / _INCH, size[1] / _INCH)
        figure.savefig(content, format=name, metadata=_METADATA[name])
    return content.getvalue()


def _draw_plot(figure: "Figure", plot: Plot) -> None:
    """Draw panels above each other."""
    axes = figure.subplots(len(plot.panels), 1, sharex=True, squeeze=False)[:, 0]
    for each, panel in zip(axes, plot.panels, strict=True):
        _draw(each, panel, plot)
    if plot.x_limits and plot.x_limits[0] < plot.x_limits[1]:
        axes[0].set_xlim(*plot.x_limits)
    axes[-1].set_xlabel(f"{plot.x_label}   (in the units of the request)")
    _label(axes[0], plot.marks)
    _legend(axes[0], plot)


def _draw_map(figure: "Figure", plot: Map) -> None:
    """Draw contours, and beside them the values on the axis."""
    finite = plot.values[np.isfinite(plot.values)]
    # Singular peaks would leave a single colour for the rest.
    top = min(float(finite.max()), _PEAK * float(np.quantile(finite, _QUANTILE)))
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=[3, 1])
    shown = np.where(np.isfinite(plot.values), plot.values, top)
    drawn = left.contourf(plot.x, plot.z, np.minimum(shown, top), _LEVELS)
    figure.colorbar(drawn, ax=left, location="bottom", label=plot.label)
    left.plot([-plot.contact, plot.contact], [0, 0], color="0.1", linewidth=4, label="contact")
    if plot.stick:
        left.plot([-plot.stick, plot.stick], [0, 0], color="C1", linewidth=4, label="stick")
    if plot.peak:
        left.plot(*plot.peak, "x", color="C3", label="maximum", clip_on=False, zorder=5)
    left.set(xlabel="x", ylabel="depth z   (in the units of the request)", aspect="equal")
    left.legend(title=plot.note or None, loc="lower right")
    on_axis = plot.values[:, plot.x.size // 2]
    right.plot(np.where(np.isfinite(on_axis), on_axis, np.nan), plot.z)
    right.set(xlabel=f"{plot.label}\non the axis", xlim=(0, None))
    left.invert_yaxis()


def _draw(axes: "Axes", panel: Panel, plot: Plot) -> None:
    for index, curve in enumerate(panel.curves):
        color = f"C{index}" if curve.style == "-" else "0.4"
        finite = np.where(np.isfinite(curve.y), curve.y, np.nan)
        label = curve.label or "_nolegend_"
        axes.plot(curve.x, finite, curve.style, color=color, label=label)
        if curve.point_x.size <= _MAX_POINTS:
            axes.plot(curve.point_x, curve.point_y, "o", color=color, markersize=3.5)
        _mark_infinities(axes, curve)
    for mark in plot.marks:
        axes.axvline(mark.place, color=_color(mark), linestyle=":", linewidth=0.9, zorder=1)
    for mark in panel.marks:
        axes.axhline(mark.place, color=_color(mark), linestyle=":", linewidth=0.9, zorder=1)
        _annotate(axes, mark.symbol, (0.0, mark.place), ("axes fraction", "data"), (3, 3))
    axes.set_ylabel(panel.y_label)
    if panel.y_limits:
        axes.set_ylim(*panel.y_limits)


def _color(mark: Mark) -> str:
    return "0.4" if mark.curve is None else f"C{mark.curve}"


def _annotate(
    axes: "Axes",
    text: str,
    place: tuple[float, float],
    coordinates: Any,
    offset: tuple[float, float],
) -> None:
    axes.annotate(
        text,
        place,
        xycoords=coordinates,
        xytext=offset,
        textcoords="offset points",
        ha="center" if offset[0] == 0 else "left",
    )


def _mark_infinities(axes: "Axes", curve: Curve) -> None:
    """Write the symbol of infinity at isolated infinities, and where a run of them begins."""
    infinite = np.isinf(curve.y)
    padded = np.concatenate([[True], infinite, [True]])
    for x, y in zip(
        *(v[infinite & ~(padded[:-2] & padded[2:])] for v in (curve.x, curve.y)), strict=True
    ):
        place, offset = (x, 1.0 if y > 0 else 0.0), (8, -9 if y > 0 else 3)
        _annotate(axes, "∞", place, ("data", "axes fraction"), offset)


def _label(axes: "Axes", marks: Iterable[Mark]) -> None:
    """Write the symbols of vertical marks above the axes, close ones together."""
    low, high = axes.get_xlim()
    inside = [mark for mark in marks if low <= mark.place <= high]
    groups: list[list[Mark]] = []
    for mark in sorted(inside, key=lambda mark: (mark.place, mark.symbol)):
        if groups and mark.place - groups[-1][0].place <= _CLOSE * (high - low):
            groups[-1].append(mark)
        else:
            groups.append([mark])
    for close in groups:
        middle = (close[0].place + close[-1].place) / 2
        text = ", ".join(dict.fromkeys(mark.symbol for mark in close))
        _annotate(axes, text, (middle, 1.0), ("data", "axes fraction"), (0, 2))


def _legend(axes: "Axes", plot: Plot) -> None:
    """Name the curves of the first panel and the points."""
    curves = [curve for panel in plot.panels for curve in panel.curves]
    if any(0 < curve.point_x.size <= _MAX_POINTS for curve in curves):
        axes.plot([], [], "o", color="0.4", markersize=3.5, label=plot.points_label)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(title=plot.note or None, loc="best")
