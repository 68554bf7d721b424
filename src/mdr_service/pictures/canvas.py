"""What all pictures share: their style, their panels, and how they are written."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MEDIA_TYPE: Final = "image/svg+xml"
UNITS: Final = "in the units of the request"

_WIDTH, _PANEL = 7.2, 2.6
_STYLE: Final[dict[Any, Any]] = {
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True,
    "axes.grid": True,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "font.size": 9.0,
    "grid.alpha": 0.25,
    "grid.linewidth": 0.5,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "mathtext.fontset": "dejavusans",
    # The same answer makes the same picture.
    "svg.hashsalt": "mdr",
}
# The library keeps its style in one place for all threads.
_lock: Final = Lock()


@contextmanager
def drawing() -> Iterator[None]:
    """Draw in this style, one picture at a time."""
    import matplotlib as mpl  # noqa: PLC0415 -- it takes longer to load than all else

    with _lock, mpl.rc_context(_STYLE):
        yield


def panels(count: int, height: float = _PANEL) -> "tuple[Figure, list[Axes]]":
    """Return a new picture of so many panels, one above the other."""
    from matplotlib.figure import Figure  # noqa: PLC0415 -- as above

    figure = Figure(figsize=(_WIDTH, 0.9 + height * count), layout="constrained")
    axes = figure.subplots(count, 1, sharex=True, squeeze=False)
    return figure, list(axes[:, 0])


def written(figure: "Figure") -> bytes:
    """Return the text of the picture."""
    text = io.BytesIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return text.getvalue()
