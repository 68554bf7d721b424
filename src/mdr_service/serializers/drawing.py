"""Drawing of the panels of a picture with Matplotlib.

Many points are joined by a line. Few are marks: what lies between them was not computed.
"""

import io
from collections.abc import Sequence
from typing import Any, Final

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from mdr_service.serializers.panels import (
    LINE,
    NAMED,
    Array,
    Curve,
    Map,
    Panel,
    Units,
    label,
    symbol,
)

# Of more curves than this an evenly spaced selection is drawn.
_CURVES: Final = 200
# A jump is a step of more than the first share of the ordinate, between steps of less than the
# second, at less than the third share of the abscissa.
_JUMP, _SMOOTH, _NEAR = 0.2, 0.02, 0.05
# Margin of axes that are cut, relative to their length as Matplotlib's.
_MARGIN: Final = 0.05
# Beside infinite values the axes end at this multiple of the highest decile.
_HEADROOM: Final = 1.5
# Fewer values along x or z are marks, more are drawn as this number of contours.
_FINE, _LEVELS = 15, 20
# Maps less square than this have unequal scales.
_FLAT: Final = 0.2
# A scale of colours is logarithmic for loads of a greater ratio.
_WIDE: Final = 100
# Names: points of a line and places along each axis that are compared, space around a name, and
# distance of two curves beyond which they are apart [pixels].
_POINTS, _PLACES, _SPACE, _APART = 300, 24, 3.0, 20.0
# Distance from a curve that a name accepts to cover no point and no other name, and to point to
# where the curve is a pixel farther from others [pixels].
_COVER, _MEET, _PULL = 30.0, 1e4, 8.0
# Usual width of a picture, and heights of a panel and of what surrounds the panels [mm].
_WIDTH, _PANEL, _FRAME = 180, 65, 35
# Size of type in points, which is smaller below a width in millimetres.
_TYPE, _SMALLEST_TYPE, _NARROW = 9.0, 6.5, 120
# Millimetres in an inch.
_INCH: Final = 25.4
_REFERENCE: Final = np.array([0.4, 0.4, 0.4, 1.0])
# The brightest colours are pale on white.
_COLORS: Final = ListedColormap(mpl.colormaps["viridis"](np.linspace(0.0, 0.8, 256)))
# Colour of text against that of a line, which is thicker.
_DARK: Final = np.array([0.7, 0.7, 0.7, 1.0])
_LEADER: Final = {"arrowstyle": "-", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0}
_STYLE: Final[dict[Any, Any]] = {
    "axes.formatter.limits": (-2, 4),
    "axes.formatter.use_mathtext": True,
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "figure.titlesize": "medium",
    "grid.alpha": 0.25,
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.4,
    "lines.markersize": 4.0,
    # Text stays text: it can be searched, selected and read aloud.
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
    # Pixels per inch of a PNG.
    "savefig.dpi": 150.0,
    # Equal results give identical bytes.
    "svg.hashsalt": "mdr",
}
# Time and version of the program would differ from run to run.
_METADATA: Final = {
    "svg": {"Date": None, "Creator": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
# Matplotlib's annotations are narrower than what it takes.
_Axes = Any


def draw(
    panels: Sequence[Panel | Map], name: str, size: tuple[int, int] | None, units: Units | None
) -> bytes:
    """Return a picture with its panels above each other.

    Parameters
    ----------
    panels : the panels, which share the abscissa.
    name : format: ``svg``, ``png`` or ``pdf``.
    size : width and height [mm]; by default the usual size, of a map without an empty margin.
    units : units that the labels name.
    """
    width, height = size or (_WIDTH, _FRAME + len(panels) * _PANEL)
    maps = [panel for panel in panels if isinstance(panel, Map)]
    content = io.BytesIO()
    font = max(_TYPE * min(width / _NARROW, 1.0), _SMALLEST_TYPE)
    with mpl.rc_context(_STYLE | {"font.size": font}):
        inches = width / _INCH, height / _INCH
        figure = Figure(inches, layout="compressed" if maps else "constrained")
        axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0].tolist()
        if maps:
            _draw_maps(axes, maps, units)
            _fit_labels(figure)
        else:
            curves = [panel for panel in panels if isinstance(panel, Panel)]
            _draw_curves(axes, curves, units)
            _fit_labels(figure)
            for each, panel in zip(axes, curves, strict=True):
                _place_names(each, [curve.name for curve in panel.curves])
        box = "tight" if maps and not size else None
        figure.savefig(content, format=name, metadata=_METADATA[name], bbox_inches=box)
    return content.getvalue()


def _draw_curves(axes: Sequence[_Axes], panels: Sequence[Panel], units: Units | None) -> None:
    """Draw curves in the colours of their loads, with a scale of these unless they have names."""
    x, load = panels[0].x, panels[0].load
    loads = np.unique([c.load for p in panels for c in p.curves if c.load is not None] or [0.0])
    is_log = 0 < _WIDE * loads[0] < loads[-1]
    scale = ScalarMappable((LogNorm if is_log else Normalize)(loads[0], loads[-1]), _COLORS)
    few = _COLORS(np.linspace(0.2, 1.0, loads.size))
    colors = dict(zip(loads.tolist(), scale.to_rgba(loads) if load else few, strict=True))
    for each, panel in zip(axes, panels, strict=True):
        count = len(panel.curves)
        for index in np.unique(np.linspace(0, count - 1, min(count, _CURVES)).astype(int)):
            curve = panel.curves[index]
            dashed = curve.load is None and count > 1
            style = "o" if curve.x.size < LINE else "--" if dashed else "-"
            color = _REFERENCE if curve.load is None else colors[curve.load]
            each.plot(*_with_gaps(curve).T, style, color=color)
        # Zero is in sight.
        each.axhline(0.0, linewidth=0.0)
        if x not in {"radius", "x", "z"}:
            each.axvline(0.0, linewidth=0.0)
        if any(np.isinf(curve.y).any() for curve in panel.curves):
            _show_infinities(each, panel.curves)
        each.set_ylabel(label(panel.y, units))
    axes[-1].set_xlabel(label(x, units))
    if load:
        figure, total = axes[0].figure, len(panels[0].curves)
        some = f", {_CURVES} of {total} curves" if total > _CURVES else ""
        figure.colorbar(scale, ax=axes, label=label(load, units) + some)


def _draw_maps(axes: Sequence[_Axes], maps: Sequence[Map], units: Units | None) -> None:
    """Draw stresses in a plane, with the depth downwards."""
    figure = axes[0].figure
    for each, (x, z, values, name, peak, _) in zip(axes, maps, strict=True):
        # Peaks of few points would leave a single colour for the others.
        bound = _HEADROOM * np.quantile(np.abs(values), 0.98, method="lower")
        shown = np.ma.masked_invalid(values)
        ends = np.append(shown.compressed(), 0.0).clip(-bound, bound)
        signed, largest = ends.min() < 0, np.abs(ends).max()
        levels = np.array(MaxNLocator(_LEVELS).tick_values(-largest * signed, largest))
        style = {"cmap": "RdBu_r" if signed else "viridis", "vmin": levels[0], "vmax": levels[-1]}
        if min(values.shape) < _FINE:
            drawn = each.scatter(*np.meshgrid(x, z), c=shown, s=60, rasterized=True, **style)
        else:
            extend = "both" if np.abs(values).max() > bound else "neither"
            drawn = each.contourf(x, z, shown, levels, extend=extend, **style)
            # Otherwise the page shines through between the contours of an SVG.
            drawn.set_edgecolor("face")
        ticks = levels[int(np.argmin(np.abs(levels))) % 4 :: 4]
        figure.colorbar(drawn, ax=each, aspect=12, label=label(name, units), ticks=ticks)
        each.grid(visible=False)
        each.invert_yaxis()
        if _FLAT < np.ptp(z) / (np.ptp(x) or 1.0) < 1 / _FLAT:
            each.set_aspect("equal")
        if peak and x[0] <= peak[0] <= x[-1] and z[0] <= peak[1] <= z[-1]:
            each.plot(*peak, "kx", clip_on=False)
            each.annotate("largest", peak, (5, -9), textcoords="offset points")
    axes[len(axes) // 2].set_ylabel(label("z", units))
    axes[-1].set_xlabel(label("x", units))
    figure.suptitle(maps[0].load or None)


def _with_gaps(curve: Curve) -> Array:
    """Return the points [n][2] of a curve, with gaps at infinite values and at jumps."""
    y = np.where(np.isfinite(curve.y), curve.y, np.nan)
    steps, span = np.abs(np.diff(y)), np.ptp(np.append(0.0, y[np.isfinite(y)]))
    beside = np.nan_to_num(np.concatenate([[0.0], steps, [0.0]]))
    smooth = np.maximum(beside[:-2], beside[2:]) < _SMOOTH * span
    near = np.abs(np.diff(curve.x)) < _NEAR * np.ptp(curve.x)
    jumps = np.flatnonzero((steps > _JUMP * span) & smooth & near & (y.size >= LINE)) + 1
    return np.insert(np.column_stack([curve.x, y]), jumps, np.nan, axis=0)


def _show_infinities(axes: _Axes, curves: Sequence[Curve]) -> None:
    """Mark infinite values, if they are few, and end the axes where curves tend to them."""
    places, endless, bounds = set(), [], [0.0]
    for x, y, name, _ in curves:
        finite = np.isfinite(y)
        heights = np.abs(y[finite])
        if not finite.any():
            endless.append(name.replace("\n", ", "))
            continue
        places |= set(x[~finite].tolist())
        if not finite.all() and y.size >= LINE and heights.any():
            even = np.interp(np.linspace(x[0], x[-1], y.size), x[finite], heights)
            heights = _HEADROOM * np.quantile(even[even > 0], [0.9])
        bounds.append(float(heights.max()))
    for place in sorted(places) if len(places) <= NAMED else []:
        axes.axvline(place, linestyle=":", linewidth=0.8, color=_REFERENCE)
        axes.text(place, 1.0, "∞", transform=axes.get_xaxis_transform(), ha="center")
    if endless:
        axes.set_title(f"∞ for {', '.join(endless)}", loc="right", fontsize="medium")
    bound = max(bounds) or 1.0
    bottom, top = np.clip(axes.dataLim.intervaly, -bound, bound)
    axes.set_ylim(bottom - _MARGIN * bound, top + _MARGIN * bound)


def _fit_labels(figure: Figure) -> None:
    """Lay out the figure, with powers of ten in the labels, and long labels without words."""
    figure.draw_without_rendering()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            text, power = axis.label, axis.get_major_formatter().get_offset()
            words = text.get_text()
            if power and words:
                scaled = words.replace(" (", f" ({power} ")
                text.set_text(scaled if scaled != words else f"{words} ({power})")
                axis.offsetText.set_visible(False)
            if np.greater(text.get_window_extent().size, axes.bbox.size).any():
                text.set_text(symbol(text.get_text()))
    figure.draw_without_rendering()
    figure.set_layout_engine("none")


def _place_names(axes: _Axes, names: Sequence[str]) -> None:
    """Write names beside their curves, where they cover neither curves nor other names.

    Each is connected to its curve where that is apart from the others.
    """
    start, end = axes.bbox.get_points()
    clouds = [_in_frame(line, start, end) for line in axes.lines[: len(names)]]
    every, taken = np.concatenate(clouds), list[tuple[Array, Array]]()
    for index, (name, line, own) in enumerate(zip(names, axes.lines, clouds, strict=False)):
        if not name or not own.size:
            continue
        text = axes.text(0.0, 0.0, name)
        half = text.get_window_extent().size / 2 + _SPACE
        text.remove()
        places = np.stack(np.meshgrid(*np.linspace(start + half, end - half, _PLACES).T), axis=-1)
        places = places.reshape(-1, 1, 2)
        cost = _COVER * (np.abs(every - places) < half).all(axis=2).sum(axis=1)
        for at, other in taken:
            cost += _MEET * (np.abs(at - places) < half + other).all(axis=(1, 2))
        # Distances [place][own point], and of own points to other curves.
        away = np.hypot(*(np.abs(own - places) - half).clip(0.0).T).T
        others = np.concatenate([own[:0], *clouds[:index], *clouds[index + 1 :]])
        apart = np.hypot(*(own - others[:, None]).T).min(axis=1, initial=_APART)
        best = np.argmin(away + cost[:, None] - _PULL * apart)
        place, anchor = np.unravel_index(best, away.shape)
        ends = axes.transData.inverted().transform([own[anchor], places[place, 0]])
        color = line.get_color()
        style = {"ha": "center", "va": "center", "in_layout": False, "color": color * _DARK}
        axes.annotate(name, *ends, arrowprops=_LEADER | {"color": color}, **style)
        taken.append((places[place, 0], half))


def _in_frame(line: Any, start: Array, end: Array) -> Array:
    """Return the points of a curve in the frame [pixels], with others between those of a line."""
    points = line.axes.transData.transform(line.get_xydata())
    if line.get_marker() != "o":
        index = np.linspace(0, len(points) - 1, _POINTS)
        points = np.stack([np.interp(index, range(len(points)), each) for each in points.T], -1)
    return points[((start <= points) & (points <= end)).all(axis=1)]
