"""Facts of the interface `/v1` on which clients depend, one line each.

`python -m tests.contract.interface` writes the facts of the committed `openapi.json` at a release:

    POST /v1/normal                        an operation
    POST /v1/normal 200 text/csv           a format of its response
    GET /v1/normal ?radius                 a parameter
    FitQuery.fit                           a member of a schema
    FitQuery.fit: contact_point            a value or a schema that it can have
    FitQuery.normal_force is required

Parameters and members are optional without the last line.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
RELEASED = ROOT / "tests" / "data" / "released_interface.txt"
IS_REQUIRED = " is required"


def facts(document: dict[str, Any]) -> set[str]:
    """Return the facts of an OpenAPI document."""
    return {*_of_operations(document), *_of_schemas(document)}


def _of_operations(document: dict[str, Any]) -> Iterator[str]:
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            name = f"{method.upper()} {path}"
            yield name
            for parameter in operation.get("parameters", ()):
                member = f"{name} ?{parameter['name']}"
                yield from _of_member(member, parameter["schema"])
                if parameter.get("required"):
                    yield member + IS_REQUIRED
            # Problems have one format, which tests/contract/test_openapi.py asserts.
            for media_type, content in operation["responses"]["200"].get("content", {}).items():
                yield from _of_member(f"{name} 200 {media_type}", content)
            for media_type, content in operation.get("requestBody", {}).get("content", {}).items():
                yield from _of_member(f"{name} {media_type}", content.get("schema", {}))


def _of_schemas(document: dict[str, Any]) -> Iterator[str]:
    for name, schema in document["components"]["schemas"].items():
        yield name
        for member, described in schema.get("properties", {}).items():
            yield from _of_member(f"{name}.{member}", described)
        for member in schema.get("required", ()):
            yield f"{name}.{member}{IS_REQUIRED}"


def _of_member(name: str, described: Any) -> Iterator[str]:
    yield name
    for value in _values(described):
        yield f"{name}: {value}"


def _values(part: Any) -> Iterator[str]:
    """Yield the constants, names of schemas and types that a member can have."""
    if isinstance(part, dict):
        yield from part.get("enum", ())
        for key in ("const", "$ref", "type"):
            if isinstance(part.get(key), str):
                yield part[key].rpartition("/")[2] if key == "$ref" else part[key]
        for key in ("schema", "items", "oneOf", "anyOf", "allOf"):
            yield from _values(part.get(key))
    for each in part if isinstance(part, list) else ():
        yield from _values(each)


def used_in_requests(document: dict[str, Any]) -> set[str]:
    """Return the names of the schemas that requests consist of."""
    bodies = [
        operation.get("requestBody")
        for methods in document["paths"].values()
        for operation in methods.values()
    ]
    found: set[str] = set()
    new = set(_references(bodies))
    while new:
        found |= new
        schemas = [document["components"]["schemas"][name] for name in new]
        new = set(_references(schemas)) - found
    return found


def _references(part: Any) -> Iterator[str]:
    if isinstance(part, dict):
        if "$ref" in part:
            yield part["$ref"].rpartition("/")[2]
        part = list(part.values())
    for each in part if isinstance(part, list) else ():
        yield from _references(each)


def broken(released: set[str], document: dict[str, Any]) -> list[str]:
    """Return the facts that no longer hold, and the requirements that are new."""
    now, requests = facts(document), used_in_requests(document)

    def is_demand(fact: str) -> bool:
        """A requirement of a request, whose removal breaks no client."""
        owner = fact.partition(" ")[0].partition(".")[0]
        return fact.endswith(IS_REQUIRED) and (" ?" in fact or owner in requests)

    lost = {fact for fact in released - now if not is_demand(fact)}
    new = {
        fact
        for fact in now - released
        # A new query or schema requires what it needs.
        if is_demand(fact) and {fact.partition(".")[0], fact.partition(" ?")[0]} & released
    }
    return sorted(f"- {fact}" for fact in lost) + sorted(f"+ {fact}" for fact in new)


def main() -> None:
    document = json.loads((ROOT / "openapi.json").read_text("utf-8"))
    RELEASED.write_text("\n".join(sorted(facts(document))) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
