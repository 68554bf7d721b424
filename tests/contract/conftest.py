"""Fixtures: a service and a browser for the tests of the pages."""

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from tests.faults.server import PATIENCE, free_port, running, service

CHROMIUM = shutil.which("chromium")
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
MILLISECONDS = 1000


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    port = free_port()
    # Queries must not exceed their time limit on a busy machine.
    patient = {
        "MDR_QUEUE_SECONDS": "100",
        "MDR_BUDGET_SECONDS": "100",
    }
    with running(service(port), port, subprocess.DEVNULL, **patient):
        yield f"http://127.0.0.1:{port}/"


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        # Only this machine can be resolved.
        hosts = "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1"
        started = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--disable-dev-shm-usage", hosts]
        )
        yield started
        started.close()


@dataclass
class Visit:
    """A page and the errors that occur on it."""

    page: Page
    address: str
    errors: list[str] = field(default_factory=list)
    hosts: set[str] = field(default_factory=set)

    def open(self, query: str = "") -> None:
        self.page.goto(self.address + query)
        self.drawn()

    def drawn(self) -> None:
        """Wait until the charts and the address show the case of the form."""
        # A form that changes is pending at once; its address follows later.
        shown = """document.body.dataset.state !== "pending" &&
            document.body.dataset.drawn === location.search + location.hash"""
        for _ in range(int(PATIENCE * MILLISECONDS / 50)):
            if self.page.evaluate(shown):
                return
            self.page.wait_for_timeout(50)
        raise TimeoutError(self.page.url)

    def state(self) -> str | None:
        """Return the state of the page when it is at rest, see `main.js`."""
        self.page.locator("body:not([data-state=pending])").wait_for()
        return self.page.locator("body").get_attribute("data-state")

    def number(self, label: str) -> str:
        entry = self.page.locator("#numbers div", has=self.page.get_by_text(label, exact=True))
        return entry.locator("dd").inner_text()

    @contextmanager
    def changing(self) -> Iterator[None]:
        """Change the form within the context, then wait until URL and charts show the change."""
        before = self.page.url
        yield
        # The URL follows the form with a delay.
        self.page.wait_for_url(lambda url: url != before)
        self.drawn()

    def fill(self, key: str, text: str) -> None:
        with self.changing():
            self.page.fill(f"#field-{key}", text)


@pytest.fixture
def visit(browser: Browser, address: str) -> Iterator[Visit]:
    context = browser.new_context(viewport={"width": 1300, "height": 1000}, accept_downloads=True)
    page = context.new_page()
    watched = Visit(page, address)
    page.on("request", lambda request: watched.hosts.add(urlsplit(request.url).netloc))
    page.on("pageerror", lambda error: watched.errors.append(str(error)))
    # The browser also logs a rejected request, which the page shows at its field.
    page.on(
        "console",
        lambda message: (
            watched.errors.append(message.text)
            if message.type == "error" and "status of 422" not in message.text
            else None
        ),
    )
    yield watched
    context.close()
    assert watched.errors == []
    assert watched.hosts - {""} == {urlsplit(address).netloc}
