"""Picture of the stress beneath the surface."""

import numpy as np

from mdr_core import subsurface
from mdr_core.tangential import TangentialContact
from mdr_service.plots.plot import Map, subset_note
from mdr_service.queries.fields import at_end
from mdr_service.queries.subsurface import body_of
from mdr_service.results import Contact, Result
from mdr_service.schemas.subsurface import SubsurfaceQuery

# Points of the map along z, and its extent in contact radii.
_DOWN, _EXTENT = 81, 1.5


def subsurface_map(query: SubsurfaceQuery, source: Contact, result: Result) -> Map:
    """Return the von Mises stress of the first load in the plane of the request."""
    contact, partial = at_end(source)
    a = float(np.ravel(contact.contact_radius)[0])
    end = _EXTENT * a or 1.0
    x, z = np.linspace(-end, end, 2 * _DOWN - 1), np.linspace(0.0, end, _DOWN)
    tensor = subsurface.stress(partial or contact, x, query.y, z[:, None], **body_of(query))
    first = tensor.von_mises.reshape(-1, z.size, x.size)[0]
    stick = None
    if isinstance(source, TangentialContact):
        stick = float(np.ravel(source.stick_radius)[0])
    down, across = np.unravel_index(np.argmax(first), first.shape)
    peak = float(x[across]), float(z[down])
    if "largest" in result and query.y == 0:
        found = result["largest"]["von_mises"]
        peak = float(found["x"][0]), float(found["z"][0])
    note = subset_note(1, query.loads, "loads")
    return Map(x, z, first, "von Mises stress", a, stick, peak, note)
