"""A service is ready only if its compute processes compute."""

import pytest

from mdr_core import COMPILED, __version__
from mdr_service import health
from mdr_service.problems import NOT_READY, ServiceError
from tests.conftest import Client
from tests.contract import strict_json


@pytest.mark.parametrize("path", ["/health", "/health/live", "/health/ready"])
def test_working_instance_is_ready(client: Client, path: str) -> None:
    response = client.get(path)
    assert response.status_code == 200
    assert strict_json.loads(response.content) == {
        "status": "ok",
        "version": __version__,
        "compiled": COMPILED,
    }


def test_version_is_the_same_wherever_it_is_stated(client: Client) -> None:
    assert client.get("/openapi.json").json()["info"]["version"] == __version__
    assert f'mdr_build_info{{version="{__version__}"}} 1.0' in client.get("/metrics").text
    for path in ("/", "/health", "/nowhere", "/v1/normal?kind=spoon", "/explorer/main.js"):
        assert client.get(path).headers["mdr-version"] == __version__
    rejected = client.post_text("/v1/normal", b"{")
    assert rejected.headers["mdr-version"] == __version__


@pytest.mark.parametrize("name", ["normal_force", "contact_radius"])
def test_instance_with_a_wrong_result_is_not_ready(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    health.self_test()
    monkeypatch.setitem(health._EXPECTED, name, health._EXPECTED[name] * (1 + 1e-8))
    with pytest.raises(ServiceError, match=name) as caught:
        health.self_test()
    assert caught.value.type is NOT_READY
