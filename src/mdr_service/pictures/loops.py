"""Force over displacement along a history."""

from typing import TYPE_CHECKING, Final

import numpy as np

from mdr_core.history import History
from mdr_service.convert import Array
from mdr_service.pictures import canvas
from mdr_service.solve import Followed, smooth

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_HEIGHT: Final = 4.0
# Turning points that can be numbered and still be read.
_MOST_NUMBERS: Final = 20
# From this share of it on, the limit is shown.
_NEAR: Final = 0.6
# Points closer than this share of the picture are one.
_SAME: Final = 0.01


def history(followed: Followed) -> bytes:
    """Return force over displacement from rest to the end, with the points that were given."""
    way = followed.history
    curve = smooth(way)
    displacement, force = (
        np.append(0.0, values) for values in (curve.tangential_displacement, curve.tangential_force)
    )
    with canvas.drawing():
        figure, (axes,) = canvas.panels(1, _HEIGHT)
        axes.plot(displacement, force, color="C0")
        _mark_points(axes, curve)
        _mark_limit(axes, curve)
        axes.set_xlabel(f"tangential displacement $u_x$   ({canvas.UNITS})")
        axes.set_ylabel("tangential force $F_x$")
        # Above the axes: within them a loop may be anywhere.
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.0)
        return canvas.written(figure)


def _mark_points(axes: "Axes", curve: History) -> None:
    """Mark the ends of the legs; number them in their order, while they can be told apart."""
    ends = slice(curve.path.per_step - 1, None, curve.path.per_step)
    x, y = curve.tangential_displacement[ends], curve.tangential_force[ends]
    axes.plot(x, y, "o", color="C1", markersize=4, label="turning points")
    shares = np.stack([_shares(x), _shares(y)])
    places = _together(shares)
    if len(places) > _MOST_NUMBERS:
        return
    for first, numbers in places:
        # On the side that the loop leaves free.
        offset = (4, 4) if shares[1, first] > 0.5 else (4, -11)
        axes.annotate(
            _listed(numbers), (x[first], y[first]), xytext=offset, textcoords="offset points"
        )


def _together(points: Array) -> list[tuple[int, list[int]]]:
    """Return the places of the points, each by its first point, with the numbers of all there."""
    places: list[tuple[int, list[int]]] = []
    for index in range(points.shape[1]):
        for first, numbers in places:
            if np.abs(points[:, index] - points[:, first]).max() < _SAME:
                numbers.append(index + 1)
                break
        else:
            places.append((index, [index + 1]))
        if len(places) > _MOST_NUMBERS:
            break
    return places


def _shares(values: Array) -> Array:
    span = float(np.ptp(values))
    return (values - values.min()) / span if span > 0 else np.zeros_like(values)


def _listed(numbers: list[int]) -> str:
    shown = ", ".join(map(str, numbers[:3]))
    return shown if len(numbers) <= 3 else f"{shown}, …"


def _mark_limit(axes: "Axes", curve: History) -> None:
    """Draw what friction carries, where the normal force stays the same and it is near."""
    force = curve.normal_force[curve.path.per_step - 1 :]
    if np.ptp(force) > _SAME * force.max():
        return
    limit = curve.start.friction_coefficient * float(force[-1])
    for sign, symbol in ((1, r"$\mu F_N$"), (-1, r"$-\mu F_N$")):
        if (sign * curve.tangential_force).max() < _NEAR * limit:
            continue
        axes.axhline(sign * limit, color="0.5", linestyle=":", linewidth=0.8)
        axes.annotate(
            symbol,
            (0.0, sign * limit),
            xycoords=("axes fraction", "data"),
            xytext=(3, 3),
            textcoords="offset points",
            color="0.4",
        )
