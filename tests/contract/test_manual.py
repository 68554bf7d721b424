"""The manual: no broken link, no request to other hosts, served under a strict policy."""

import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Final, Literal

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser

from mdr_service.api import explorer
from tests.conftest import Client, running_client
from tests.contract.conftest import needs_chromium

SCHEMES: Final[tuple[Literal["light", "dark"], ...]] = ("light", "dark")
ROOT = Path(__file__).parents[2]


def test_address_without_slash_redirects(client: Client) -> None:
    response = client.get("/manual")
    assert response.status_code == 307
    assert response.headers["location"] in {"manual/", "readme"}


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the manual as `make docs`; a broken link is an error."""
    folder = tmp_path_factory.mktemp("manual")
    build = [Path(sys.executable).parent / "mkdocs", "build", "--site-dir", folder]
    done = subprocess.run(build, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.long
def test_pages_load_from_this_host_and_hold_no_script(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 20
    for page in pages:
        text = page.read_text("utf-8")
        assert not re.search(r"<script(?![^>]*(?:src=|application/json))", text), page
        assert not re.search(r"<(?:script|img|link|iframe)[^>]*(?:src|href)=\"?https?:", text), page
        assert not re.search(r"<em>[^<]*[=/(][^<]*</em>", text), f"{page}: escape the * of symbols"
    assert sum(path.stat().st_size for path in site.rglob("*")) < 8.5e6


@pytest.mark.long
@needs_chromium
def test_pages_pass_axe(site: Path, browser: Browser) -> None:
    """Apart from the bars of the theme about code, which have no names."""
    for path in ("", "http/", "physics/", "reference/", "half_space/"):
        # The colours are those of the theme on every page.
        for scheme in SCHEMES if path == "http/" else SCHEMES[:1]:
            page = browser.new_page(color_scheme=scheme)
            with served(site) as address:
                page.goto(f"{address}{path}")
                findings = Axe().run(page).response["violations"]
            assert {each["id"] for each in findings} <= {"landmark-unique"}, (path, scheme)
            page.close()


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serve a folder on this machine, and yield its address."""
    handler = partial(SimpleHTTPRequestHandler, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


@pytest.mark.long
def test_manual_is_served_with_the_policy(site: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(explorer, "MANUAL", site)
    with running_client() as client:
        assert client.get("/manual").headers["location"] == "manual/"
        for path, status in {"": 200, "gallery/": 200, "manual.css": 200, "nothing": 404}.items():
            assert client.get(f"/manual/{path}").status_code == status
        page = client.get("/manual/gallery/")
    assert page.headers["content-security-policy"].startswith("default-src 'self';")
    assert "Hertz contact" in page.text
