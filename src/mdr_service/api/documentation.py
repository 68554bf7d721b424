"""Texts and responses of the endpoints, as OpenAPI documents them, and headers of the pages."""

from typing import Any, Final

from mdr_service import problems
from mdr_service.problems import ProblemType
from mdr_service.serializers import FORMATS

Responses = dict[int | str, dict[str, Any]]

# The policy keeps the browser from connecting to other hosts, and other hosts from framing the
# page. Plotly needs exceptions: it sets styles of elements, and draws a downloaded picture from a
# blob.
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
    "svg": {"type": "string", "description": "Picture of the values of the response."},
    "png": {"contentMediaType": FORMATS["png"], "description": "The same picture."},
    "pdf": {"contentMediaType": FORMATS["pdf"], "description": "The same picture."},
}


def failures(*types: ProblemType) -> Responses:
    """Return the problem responses of an endpoint."""
    meanings: dict[int | str, list[str]] = {}
    for each in (*types, problems.INTERNAL):
        meanings.setdefault(each.status, []).append(f"`{each.uri}`: {each.title}")
    return {
        status: {
            "description": "\n".join(lines),
            "content": {problems.MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}},
        }
        for status, lines in meanings.items()
    }


POST_FAILURES: Final = failures(problems.HEADERS_TOO_LARGE, *_BODY, *_COMPUTATION)
GET_FAILURES: Final = failures(problems.HEADERS_TOO_LARGE, *_COMPUTATION)
FILE_FAILURES: Final = failures(problems.HEADERS_TOO_LARGE, *_BODY[1:3], *_COMPUTATION[1:])
RESULT: Final[Responses] = {
    200: {
        "description": "Result of the query",
        "content": {FORMATS[name]: {"schema": schema} for name, schema in _SCHEMAS.items()},
    }
}
