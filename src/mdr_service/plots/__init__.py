"""Curves of the pictures: dense enough to look smooth, with the points of the response on them.

Each function takes a query, its core solution and its result, and returns plain data.
"""

from collections.abc import Callable, Mapping
from typing import Any, Final

from mdr_service.plots.forces import history, normal, tangential
from mdr_service.plots.plot import Map, Plot
from mdr_service.plots.surfaces import evolution, stress, subsurface_map, wear
from mdr_service.results import Result

PLOTS: Final[Mapping[str, Callable[[Any, Any, Result], Plot | Map]]] = {
    "normal": normal,
    "tangential": tangential,
    "history": history,
    "stress": stress,
    "subsurface": subsurface_map,
    "wear": wear,
    "evolution": evolution,
}

__all__ = ["PLOTS", "Map", "Plot"]
