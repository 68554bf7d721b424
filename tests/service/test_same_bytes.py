"""However a query is asked, its answer has the same bytes, and its refusal the same words."""

import json
from pathlib import Path
from urllib.parse import urlencode

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mdr_command.__main__ import main
from tests.conftest import Client
from tests.service.test_any_query import LENGTHS, LOADS, PARAMETERS, SLOPES

PRESSED = ["indentation_depth", "normal_force", "contact_radius"]
PUSHED = ["tangential_force", "tangential_displacement", "stick_radius"]
QUANTITIES = ["pressure", "shear_stress", "slip", "normal_displacement", "foundation_load"]
Asked = tuple[str, dict[str, object], dict[str, object]]


@st.composite
def queries(draw: st.DrawFn) -> Asked:
    """A question, its request, and the parameters that stand for it."""
    name = draw(st.sampled_from(["normal", "tangential", "stress", "wear"]))
    kind = draw(st.sampled_from(list(PARAMETERS)))
    profile: dict[str, object] = {"kind": kind} | {
        field: draw(SLOPES if field == "slope" else LENGTHS) for field in PARAMETERS[kind]
    }
    material = {"e_star": draw(LENGTHS), "g_star": draw(LENGTHS)}
    load = {draw(st.sampled_from(PRESSED[: 2 if name == "wear" else 3])): draw(LOADS)}
    tolerance = {"rtol": draw(st.sampled_from([1e-3, 1e-6]))}
    request = {"profile": profile, "material": material, "load": load} | tolerance
    parameters = {**profile, **material, **load, **tolerance}
    if name != "normal":
        friction = {"friction_coefficient": draw(st.floats(1e-3, 10.0))}
        sideways = {draw(st.sampled_from(PUSHED[: 2 if name == "wear" else 3])): draw(LOADS)}
        request |= friction | {"oscillation" if name == "wear" else "tangential": sideways}
        parameters |= friction | sideways
    if name == "stress":
        asked = draw(st.lists(st.sampled_from(QUANTITIES), min_size=1, unique=True))
        request |= {"points": 5, "quantities": asked}
        parameters |= {"points": 5, "quantities": ",".join(asked)}
    return name, request, parameters


# In words alone: of an address the pointers are to its parameters.
def words(document: dict[str, object]) -> dict[str, object]:
    errors = [error["detail"] for error in document.get("errors", [])]
    return document | {"errors": errors}


@settings(
    max_examples=200,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(asked=queries(), form=st.sampled_from(["json", "csv", "npz"]))
def test_all_ways_lead_to_the_same_bytes(
    client: Client,
    capfdbinary: pytest.CaptureFixture[bytes],
    tmp_path: Path,
    asked: Asked,
    form: str,
) -> None:
    name, request, parameters = asked
    text = json.dumps(request).encode()
    alone = client.post_text(f"/v1/{name}?format={form}", text)
    by_address = client.get(f"/v1/{name}?{urlencode({**parameters, 'format': form})}")
    file = tmp_path / "request.json"
    file.write_bytes(text)
    status = main([name, str(file), "--format", form])
    out, err = capfdbinary.readouterr()
    assert by_address.status_code == alone.status_code
    if alone.status_code == 200:
        assert by_address.content == alone.content
        assert (status, out, err) == (0, alone.content, b"")
    else:
        assert words(by_address.json()) == words(alone.json())
        assert (status > 1, out, err) == (True, b"", alone.content + b"\n")
    if form == "json":
        entry = b'{"status":%d,"%s":%s}' % (
            alone.status_code,
            b"answer" if alone.status_code == 200 else b"problem",
            alone.content,
        )
        batch = b'{"queries":[{"ask":"%s","request":%s}]}' % (name.encode(), text)
        assert client.post_text("/v1/batch", batch).content == b'{"answers":[%s]}' % entry
