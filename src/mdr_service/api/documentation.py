"""Texts and responses of the endpoints, as OpenAPI documents them, and headers of the pages."""

from typing import Any, Final

from mdr_service import problems
from mdr_service.problems import ProblemType
from mdr_service.serializers import FORMATS

Responses = dict[int | str, dict[str, Any]]

# The browser connects to no other host, whatever the page shows, and no other host frames the page.
# Plotly sets styles of elements, and draws a downloaded picture from a blob.
PAGE_HEADERS: Final = {
    "Content-Security-Policy": (
        "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
    )
}
_COMPUTATION: Final = (
    problems.NOT_ACCEPTABLE,
    problems.INVALID_REQUEST,
    problems.ACCURACY,
    problems.BUSY,
    problems.LOST,
    problems.TIME_EXCEEDED,
)
_BODY: Final = (
    problems.MALFORMED_JSON,
    problems.BODY_TOO_SLOW,
    problems.BODY_TOO_LARGE,
    problems.UNSUPPORTED_MEDIA_TYPE,
)
_TABLE: Final = """\
One column per quantity, one row per load, sample or number of cycles. With radii one row per load
and radius; the first column is the index of the load, if there are several, or the number of
cycles."""
_SCHEMAS: Final = {
    "csv": {"type": "string", "description": _TABLE},
    "npz": {
        "contentMediaType": FORMATS["npz"],
        "description": "Archive for `numpy.load`: one array per member of the JSON response.",
    },
    "txt": {
        "type": "string",
        "description": "The table without its heading; of one number, the number alone.",
    },
    "svg": {
        "type": "string",
        "description": "Picture of the values of the response.",
    },
    "png": {"contentMediaType": FORMATS["png"], "description": "The same picture."},
    "pdf": {"contentMediaType": FORMATS["pdf"], "description": "The same picture."},
}
_PROBLEM: Final = {"$ref": "#/components/schemas/Problem"}


def failures(*types: ProblemType) -> Responses:
    """Return the problem responses of an endpoint."""
    meanings: dict[int | str, list[str]] = {}
    for each in (*types, problems.INTERNAL):
        meanings.setdefault(each.status, []).append(f"`{each.uri}`: {each.title}")
    return {
        status: {
            "description": "\n".join(lines),
            "content": {problems.MEDIA_TYPE: {"schema": _PROBLEM}},
        }
        for status, lines in meanings.items()
    }


BATCH_RESPONSES: Final = failures(*_BODY, *_COMPUTATION)
_RESULT: Final[Responses] = {
    200: {
        "description": "Result of the query",
        "content": {FORMATS[name]: {"schema": schema} for name, schema in _SCHEMAS.items()},
    }
}
POST_RESPONSES: Final = _RESULT | BATCH_RESPONSES
# Without 304: generators of clients give a response without content no type.
GET_RESPONSES: Final[Responses] = _RESULT | failures(*_COMPUTATION)
QUERY_TEXTS: Final = {
    "normal": (
        "Normal contact under a depth, a force or a contact radius",
        """Compute the frictionless contact of a profile with an elastic half-space.

Every list of the response has one entry per load. `method` names the most expensive method
used, `error_estimate` is an upper bound on the relative error of every number.""",
    ),
    "tangential": (
        "Partial slip under a tangential force or displacement, or a stick radius",
        """Compute a contact with friction, loaded normally first and then tangentially once.

Every list of the response has one entry per pair of loads. A tangential force beyond µ F_N has
no equilibrium and is rejected; a displacement beyond full slip has the regime `full_slip`.""",
    ),
    "history": (
        "Load history: an arbitrary load path or identical cycles",
        """Follow a load path from first contact, and return samples along it.

The controls vary linearly from point to point. Paths of depths and displacements, and of
normal and tangential forces, are solved exactly. Where a depth changes with a tangential force,
or a normal force with a displacement, the path is replaced by chords: the error is mostly 1e-9
to 1e-7 and within `error_estimate`. A negative depth is a separation, which erases the slip
memory. A tangential force beyond µ F_N, at a point or between points, has no equilibrium and is
rejected.

`error_estimate` is relative to the largest value on the path. It does not include
`slip_fronts`. `energy_per_cycle` and `secant_stiffness` belong to
`cycles`.""",
    ),
    "stress": (
        "Surface stresses, slip and displacement over the radius",
        """Compute the fields named in `quantities`, and nothing else, by load and radius.

`error_estimate` bounds the error of each field relative to its largest value. A rounding error
of a requested radius near a, c or a break is not included.""",
    ),
    "subsurface": (
        "Stresses beneath the surface of either body, their peaks and the onset of yield",
        """Compute the stresses named in `quantities` by load, depth z and x, in the plane of one y.

`error_estimate` is relative to the largest stress of the response. With a `yield_strength` of
the material, and without `history`, the response holds the normal force at the onset of yield,
at the same ratio of tangential to normal force. The tangential force acts on body 1 along x,
its reaction on body 2.""",
    ),
    "wear": (
        "Limiting state of fretting wear under a small oscillation",
        """\
Compute the limiting profile: the annulus outside the stick zone wears until it is unloaded.

The given controls are held constant. With a constant depth and displacement amplitude, and with
constant forces, the limiting state is unique and does not depend on the wear law. With a
constant normal force and displacement amplitude it depends on the path: the response is the
approximation of Popov and Heß (2015), Eq. (5.90), with a warning `path_dependent`;
`/v1/wear/evolution` computes the path itself.

In full slip, wear is unbounded under a constant force (`endless_wear`), and ends in separation
at a constant depth (`contact_lost`). Without slip there is no wear (`no_wear`).""",
    ),
    "evolution": (
        "Fretting wear over the cycles: profile and pressure up to the limiting state",
        """Integrate the wear law dh/dN = K µ p S over the cycles.

h is the worn depth at a radius, and S the sliding distance of a cycle there. The given controls
are held constant. A query takes about a second, more with the `resolution` and the numbers of
cycles. A warning `limit_reached` reports after how many cycles wear stops.""",
    ),
    "batch": (
        "Queries of any kind, each with its own answer or problem",
        """Compute each query as at its own endpoint, in the given order.

The status is 200 if the list itself is valid. Each entry has its own `status`, with the
`answer` or the `problem`, whose pointers are into its own `request`.""",
    ),
}
"""Summary and description of each endpoint, by its name."""
