"""Picture of the stress beneath the surface."""

from typing import Any

import numpy as np

from mdr_core import subsurface
from mdr_core.tangential import TangentialContact
from mdr_service.plots.plot import POINTS, VISIBLE, Map, some
from mdr_service.queries.subsurface import Source, poissons_ratio
from mdr_service.results import Result
from mdr_service.schemas.subsurface import SubsurfaceQuery

# Points of the map along x and z, and its extent in contact radii.
_ACROSS, _DOWN, _EXTENT = 161, 81, 1.5


def subsurface_map(query: SubsurfaceQuery, source: Source, result: Result) -> Map:
    """Return the von Mises stress of the first load in the plane of the request."""
    contact = source.normal if isinstance(source, TangentialContact) else source
    a = float(np.ravel(contact.contact_radius)[0])
    end = _EXTENT * a or 1.0
    x, z = np.linspace(-end, end, _ACROSS), np.linspace(0.0, end, _DOWN)
    depth = np.linspace(0.0, end, POINTS)
    given: dict[str, Any] = {
        "poissons_ratio": poissons_ratio(query),
        "body": query.body,
        "rtol": VISIBLE,
    }
    values = subsurface.stress(source, x, query.y, z[:, None], **given).von_mises
    on_axis = subsurface.stress(source, 0.0, query.y, depth, **given).von_mises
    first = values.reshape(-1, z.size, x.size)[0]
    stick = None
    if isinstance(source, TangentialContact):
        stick = float(np.ravel(source.stick_radius)[0])
    top = np.unravel_index(int(np.argmax(first)), first.shape)
    peak = (float(x[top[1]]), float(z[top[0]]))
    if "largest" in result and query.y == 0:
        found = result["largest"]["von_mises"]
        peak = (float(found["x"][0]), float(found["z"][0]))
    return Map(
        x,
        z,
        first,
        depth,
        on_axis.reshape(-1, depth.size)[0],
        "von Mises stress",
        a,
        stick,
        peak,
        some(1, query.loads, "loads"),
    )
