"""POST, GET, command line and batch return identical bytes, and identical error messages."""

import json
from pathlib import Path
from urllib.parse import urlencode

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mdr_command.__main__ import main
from tests.conftest import Client
from tests.service.test_any_query import LENGTHS, LOADS, PARAMETERS, SLOPES

NORMAL_LOADS = ["indentation_depth", "normal_force", "contact_radius"]
TANGENTIAL_LOADS = ["tangential_force", "tangential_displacement", "stick_radius"]
QUANTITIES = ["pressure", "shear_stress", "slip", "normal_displacement", "foundation_load"]
Query = tuple[str, dict[str, object], dict[str, object]]


@st.composite
def queries(draw: st.DrawFn) -> Query:
    """A query name, its POST request and the equivalent GET parameters."""
    name = draw(st.sampled_from(["normal", "tangential", "stress", "wear"]))
    kind = draw(st.sampled_from(list(PARAMETERS)))
    profile: dict[str, object] = {"kind": kind} | {
        field: draw(SLOPES if field == "slope" else LENGTHS) for field in PARAMETERS[kind]
    }
    material = {"e_star": draw(LENGTHS), "g_star": draw(LENGTHS)}
    load = {draw(st.sampled_from(NORMAL_LOADS[: 2 if name == "wear" else 3])): draw(LOADS)}
    request = {"profile": profile, "material": material, "load": load}
    parameters = {**profile, **material, **load}
    if name != "normal":
        friction = {"friction_coefficient": draw(st.floats(1e-3, 10.0))}
        tangential = {
            draw(st.sampled_from(TANGENTIAL_LOADS[: 2 if name == "wear" else 3])): draw(LOADS)
        }
        request |= friction | {"oscillation" if name == "wear" else "tangential": tangential}
        parameters |= friction | tangential
    if name == "stress":
        query = draw(st.lists(st.sampled_from(QUANTITIES), min_size=1, unique=True))
        request |= {"points": 5, "quantities": query}
        parameters |= {"points": 5, "quantities": ",".join(query)}
    return name, request, parameters


# Only the messages: for GET, the place is a parameter.
def words(document: dict[str, object]) -> dict[str, object]:
    errors = [error["detail"] for error in document.get("errors", [])]
    detail = document["detail"].partition(": ")[2] if errors else document["detail"]
    return document | {"errors": errors, "detail": detail}


@settings(
    max_examples=120,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(query=queries(), format_name=st.sampled_from(["json", "csv", "npz"]))
def test_all_interfaces_return_identical_bytes(
    client: Client,
    capfdbinary: pytest.CaptureFixture[bytes],
    tmp_path: Path,
    query: Query,
    format_name: str,
) -> None:
    name, request, parameters = query
    text = json.dumps(request).encode()
    single = client.post_text(f"/v1/{name}?format={format_name}", text)
    by_get = client.get(f"/v1/{name}?{urlencode({**parameters, 'format': format_name})}")
    file = tmp_path / "request.json"
    file.write_bytes(text)
    status = main([name, str(file), "--format", format_name])
    out, err = capfdbinary.readouterr()
    assert by_get.status_code == single.status_code
    if single.status_code == 200:
        assert by_get.content == single.content
        assert (status, out, err) == (0, single.content, b"")
    else:
        assert words(by_get.json()) == words(single.json())
        assert (status > 1, out) == (True, b"")
        for error in single.json().get("errors", []):
            assert error["detail"] in err.decode()
    if format_name == "json":
        entry = b'{"status":%d,"%s":%s}' % (
            single.status_code,
            b"answer" if single.status_code == 200 else b"problem",
            single.content,
        )
        batch = b'{"queries":[{"ask":"%s","request":%s}]}' % (name.encode(), text)
        assert client.post_text("/v1/batch", batch).content == b'{"answers":[%s]}' % entry
