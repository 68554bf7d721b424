"""The documentation page loads resources from this host only."""

import re

import pytest

from tests.conftest import Client


def test_every_url_on_the_page_is_served_here(client: Client) -> None:
    page = client.get("/docs")
    assert page.status_code == 200
    result = re.findall(r'(?:src|href)="([^"]*)"', page.text)
    assert len(result) == 5
    for address in result:
        assert "//" not in address
        assert client.get(f"/{address}").status_code == 200


def test_content_security_policy_allows_this_host_only(client: Client) -> None:
    policy = client.get("/docs").headers["content-security-policy"]
    assert "default-src 'self'" in policy
    assert "http" not in policy
    assert "*" not in policy


@pytest.mark.parametrize("path", ["/docs", "/docs/page/docs.js"])
def test_page_names_no_other_host(client: Client, path: str) -> None:
    assert not re.search(r"https?://", client.get(path).text)
