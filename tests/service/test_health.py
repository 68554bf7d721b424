"""Readiness: a compute process solves a contact with a known answer."""

import pytest

from mdr_service import health
from mdr_service.problems import NOT_READY, ServiceError
from tests.conftest import Client
from tests.contract import strict_json


@pytest.mark.parametrize("path", ["/health", "/health/live", "/health/ready"])
def test_working_instance_is_ready(client: Client, path: str) -> None:
    response = client.get(path)
    assert response.status_code == 200
    assert strict_json.loads(response.content) == {"status": "ok"}


@pytest.mark.parametrize("name", ["normal_force", "contact_radius"])
def test_instance_with_a_wrong_result_is_not_ready(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    health.self_test()
    monkeypatch.setitem(health._EXPECTED, name, health._EXPECTED[name] * (1 + 1e-13))
    with pytest.raises(ServiceError, match=name) as caught:
        health.self_test()
    assert caught.value.type is NOT_READY
