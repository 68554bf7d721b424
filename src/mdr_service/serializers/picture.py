"""Pictures: the arrays of a result as SVG, PNG or PDF."""

from collections.abc import Mapping
from typing import Any, Final, NamedTuple

from mdr_core.errors import InputError
from mdr_service.serializers.panels import FRAME, Map, Units, panels_of

MEDIA_TYPES: Final = {"svg": "image/svg+xml", "png": "image/png", "pdf": "application/pdf"}

# Labels collide below this width of several maps, and below this height of a panel [mm].
_MAPS, _LEAST_PANEL = 90, 15


class Appearance(NamedTuple):
    """Width and height of a picture [mm], and the units that its labels name."""

    size: tuple[int, int] | None = None
    units: Units | None = None


AS_USUAL: Final = Appearance()
"""Usual size, and labels without units."""


def write(query: Any, result: Mapping[str, Any], appearance: Appearance, name: str) -> bytes:
    """Return the picture of a result; equal results give identical bytes.

    Parameters
    ----------
    query : the request, which names the loads.
    result : all members of the response.
    appearance : size and units, by default the usual size without units.
    name : format, a key of `MEDIA_TYPES`.

    Raises
    ------
    InputError : the panels need more space.
    """
    from mdr_service.serializers.drawing import draw  # noqa: PLC0415 -- Matplotlib loads slowly

    size, units = appearance
    title, panels = panels_of(query, result, units)
    count = len(panels)
    wide = _MAPS if count > 1 and isinstance(panels[0], Map) else 0
    high = FRAME + count * _LEAST_PANEL
    if size and (size[0] < wide or size[1] < high):
        detail = f"{count} panels need at least {max(wide, size[0])}x{max(high, size[1])}"
        raise InputError(("size",), f"{detail} mm: enlarge it, or request fewer quantities")
    return draw(title, panels, name, size, units)
