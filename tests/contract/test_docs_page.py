"""The documentation page loads resources from this host only."""

import re

from tests.conftest import Client


def test_every_url_on_the_page_is_served_here(client: Client) -> None:
    page = client.get("/docs")
    result = re.findall(r'(?:src|href)="([^"]*)"', page.text)
    assert len(result) == 5
    for address in result:
        assert "//" not in address
        assert client.get(f"/{address}").status_code == 200
    for text in (page.text, client.get("/docs/page/docs.js").text):
        assert not re.search(r"https?://", text)


def test_content_security_policy_allows_this_host_only(client: Client) -> None:
    policy = client.get("/docs").headers["content-security-policy"]
    assert "default-src 'self'" in policy
    assert "http" not in policy
    assert "*" not in policy
