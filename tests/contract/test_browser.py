"""A newcomer's first minute: open the page, press Execute, read the textbook's number."""

import base64
import json
import shutil
import subprocess
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from websockets.sync.client import ClientConnection, connect

from tests.contract.test_examples import hertz
from tests.faults.server import PATIENCE, free_port, running, service

CHROMIUM = shutil.which("chromium")
FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # Whatever is not this machine has no address.
    "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1",
    "--remote-debugging-port=0",
    "--window-size=1200,1600",
]
OPERATION = "#operations-contact-normal"


class Page:
    """One page of the browser, by the DevTools protocol."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._last = 0
        self.requested: list[str] = []

    def call(self, method: str, **parameters: object) -> dict[str, object]:
        self._last += 1
        question = {"id": self._last, "method": method, "params": parameters}
        self._connection.send(json.dumps(question))
        while True:
            message = json.loads(self._connection.recv(timeout=PATIENCE))
            if message.get("method") == "Network.requestWillBeSent":
                self.requested.append(message["params"]["request"]["url"])
            if message.get("id") == self._last:
                return message["result"]

    def evaluate(self, expression: str) -> object:
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        return result["result"].get("value")

    def click(self, selector: str) -> None:
        self.wait_for(f"document.querySelector({json.dumps(selector)}) !== null")
        self.evaluate(f"document.querySelector({json.dumps(selector)}).click()")

    def text(self, selector: str) -> str:
        self.wait_for(f"document.querySelector({json.dumps(selector)}) !== null")
        return str(self.evaluate(f"document.querySelector({json.dumps(selector)}).textContent"))

    def wait_for(self, condition: str) -> None:
        deadline = time.monotonic() + PATIENCE
        while not self.evaluate(condition):
            if time.monotonic() > deadline:
                raise TimeoutError(condition)
            time.sleep(0.05)

    def picture(self) -> bytes:
        return base64.b64decode(str(self.call("Page.captureScreenshot")["data"]))


@contextmanager
def browser(profile: Path) -> Iterator[Page]:
    assert CHROMIUM is not None
    command = [CHROMIUM, *FLAGS, f"--user-data-dir={profile}", "about:blank"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        with connect(_debugger_of_the_page(profile), max_size=None) as connection:
            page = Page(connection)
            page.call("Network.enable")
            yield page
    finally:
        process.terminate()
        process.wait(PATIENCE)


def _debugger_of_the_page(profile: Path) -> str:
    announced = profile / "DevToolsActivePort"
    deadline = time.monotonic() + PATIENCE
    while not (announced.exists() and announced.read_text().count("\n") == 1):
        if time.monotonic() > deadline:
            raise TimeoutError("chromium did not start")
        time.sleep(0.05)
    port = announced.read_text().partition("\n")[0]
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list") as listing:
        pages = [target for target in json.load(listing) if target["type"] == "page"]
    return str(pages[0]["webSocketDebuggerUrl"])


@pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed (Debian: apt-get install)")
def test_the_example_of_the_page_gives_the_textbook_number(tmp_path: Path) -> None:
    port = free_port()
    with running(service(port), port), browser(tmp_path / "profile") as page:
        page.call("Page.navigate", url=f"http://127.0.0.1:{port}/")
        page.click(f"{OPERATION} .opblock-summary-control")
        page.click(f"{OPERATION} .try-out__btn")
        page.click(f"{OPERATION} .execute")
        answered = f"{OPERATION} .live-responses-table .response-col_description code"
        answer = json.loads(page.text(answered))
        (tmp_path / "docs.png").write_bytes(page.picture())
    for quantity, expected in hertz().items():
        assert answer[quantity] == pytest.approx(expected, rel=1e-12)
    hosts = {urlsplit(url).netloc for url in page.requested if not url.startswith("data:")}
    assert hosts == {f"127.0.0.1:{port}"}
