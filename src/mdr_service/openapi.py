"""OpenAPI document of the framework, extended by problem documents and examples."""

from typing import Any, Final

from mdr_service.schemas.examples import ANSWERS, EXAMPLES

DESCRIPTION: Final = """\
Contact mechanics of axisymmetric bodies by the method of dimensionality reduction.

[Explorer](./): the same queries with charts, in the browser. [Manual](manual),
with examples. [Licence](license): MIT.

**Units.** Use one consistent system of your choice (N, m, Pa; or N, mm, MPa). Nothing is
converted; each field names its dimension in brackets, `[1]` for a plain number.

**Arrays.** A load is a number or a list; responses are always lists over the loads. `null` stands
for a true infinity, and a warning with the code `singular` says where (`endless_wear` for unbounded
wear); as a `yield_onset_force` it means that no load reaches the yield strength.

**Formats.** `?format=` or the header `Accept` selects JSON (the default); `csv`, a table with a
column per quantity, in which infinities are written `inf`; `npz`, an archive of arrays for
`numpy.load`; `txt`, the table without its heading; or `svg`, `png` or `pdf`, a picture of the
values of the response, whose width and height `?size=` sets, and whose units `?units=` names.

**GET.** Six queries are available by parameters as well, for spreadsheets and browsers: numbers,
lists of loads, and one range. `answers` chooses members of the response, and with `format=txt` a
single number is returned as plain text.

**Errors** are `application/problem+json` (RFC 9457); `errors` points into the request.
"""
TAGS: Final = [
    {"name": "contact", "description": "Contacts, load histories and surface fields."},
    {"name": "wear", "description": "Fretting wear."},
    {"name": "batch", "description": "Several queries in one request."},
    {"name": "catalogue", "description": "Kinds of profile."},
    {"name": "operation", "description": "Health, metrics and limits."},
]


def extend(document: dict[str, Any]) -> None:
    """Extend the OpenAPI document of the framework by problem documents and examples.

    The framework documents additional responses as JSON only, has examples of single parameters
    only, and adds responses that do not occur.
    """
    for schema in document["components"]["schemas"].values():
        for needed in schema.get("dependentRequired", {}).values():
            # The framework stores required members as a set, whose order changes at every start.
            needed.sort()
    document["security"] = []
    for path in document["paths"].values():
        for operation in path.values():
            name = operation["operationId"].removeprefix("get_")
            if answer := ANSWERS.get(operation["operationId"]):
                operation["responses"]["200"]["content"]["application/json"]["example"] = answer
            given = EXAMPLES["parameters"].get(name, {})
            for parameter in operation.get("parameters", ()):
                if parameter["name"] in given:
                    parameter["example"] = given[parameter["name"]]
