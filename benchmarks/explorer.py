"""Performance of the explorer in headless Chromium, with the service on this machine.

make pages

Prints the time to the first chart with and without the browser cache, the time from a slider to the
new charts, alone and beside twenty browsers that drag sliders, and the latency of small queries
beside them.
"""

import asyncio
import json
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from playwright.sync_api import BrowserContext, Page, sync_playwright
from tests.contract.conftest import CHROMIUM
from tests.faults.campaign import small_queries
from tests.faults.load import clients, percentile, post
from tests.faults.server import free_port, running, service

REPEATS = 5
BROWSERS = 20
SECONDS = 10.0
# Time a browser spends on drawing before its next query [s].
DRAWING = 0.04
SLIDERS = {"press": "load", "push": "amount"}
# Queries of one drawing of the tab that the browsers drag.
QUERIES = 4
# Moves a slider step by step, each as soon as the previous charts are drawn; returns the times.
DRAG = """async key => {
    const drawn = async () => {
        while (!document.body.dataset.drawn) {
            if (document.body.dataset.state === "refused") throw new Error("a query was refused");
            await new Promise(requestAnimationFrame);
        }
    };
    await drawn();
    const slider = document.querySelector(`.field[data-key=${key}] [type=range]`);
    const [low, high] = [Number(slider.min), Number(slider.max)];
    const times = [];
    for (let i = 1; i <= 20; i++) {
        const start = performance.now();
        delete document.body.dataset.drawn;
        slider.value = low + (high - low) * (0.3 + 0.02 * i);
        slider.dispatchEvent(new Event("input"));
        await drawn();
        times.push(performance.now() - start);
    }
    return times;
}"""


@contextmanager
def browser() -> Iterator[BrowserContext]:
    """Yield a browser that keeps its cache between pages."""
    with TemporaryDirectory() as folder, sync_playwright() as playwright:
        context = playwright.chromium.launch_persistent_context(
            folder, executable_path=CHROMIUM, args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        yield context
        context.close()


def first_chart(context: BrowserContext, address: str) -> float:
    """Return the time to the first chart of a new page [s]."""
    page = context.new_page()
    start = time.monotonic()
    page.goto(address, wait_until="commit")
    page.locator("figure .plot .main-svg").first.wait_for()
    taken = time.monotonic() - start
    page.wait_for_timeout(1000)
    page.close()
    return taken


def drag(page: Page, address: str, tab: str, kind: str, slider: str = "") -> list[float]:
    """Return the times from a slider to the new charts [ms]."""
    page.goto(f"{address}?tab={tab}&kind={kind}")
    times: list[float] = page.evaluate(DRAG, slider or SLIDERS[tab])
    return times


def recorded(page: Page, address: str) -> list[list[Any]]:
    """Return the requests of a dragged slider that changes all charts, grouped by drawing."""
    requests: list[Any] = []
    page.on(
        "request",
        lambda each: each.method == "POST" and requests.append([each.url, each.post_data_json]),
    )
    drag(page, address, "push", "rounded_punch", "load")
    of_path = [[url.partition("/v1")[2], body] for url, body in requests]
    return [of_path[i : i + QUERIES] for i in range(0, len(of_path) - QUERIES + 1, QUERIES)]


async def dragging(port: int, drawings: list[list[Any]]) -> None:
    """Send the requests of a browser whose slider is dragged continuously."""
    async with clients(port, QUERIES) as connections:
        while True:
            for drawing in drawings:
                requests = [post(f"/v1{path}", body) for path, body in drawing]
                await asyncio.gather(
                    *(client.ask(text) for client, text in zip(connections, requests, strict=True))
                )
                await asyncio.sleep(DRAWING)


async def replay(port: int, drawings: list[list[Any]]) -> None:
    await asyncio.gather(*(dragging(port, drawings) for _ in range(BROWSERS)))


@contextmanager
def others_dragging(port: int, drawings: list[list[Any]]) -> Iterator[None]:
    """Let twenty browsers drag sliders within the context."""
    others = subprocess.Popen(
        [sys.executable, __file__, str(port)], stdin=subprocess.PIPE, text=True
    )
    assert others.stdin
    others.stdin.write(json.dumps(drawings))
    others.stdin.close()
    time.sleep(2.0)
    yield
    assert others.poll() is None
    others.kill()
    others.wait()


def small_p99(port: int) -> float:
    """Return the 99th percentile of small queries [s]."""
    return percentile(asyncio.run(small_queries(port, SECONDS)), 0.99)


def main() -> None:
    port = free_port()
    address = f"http://127.0.0.1:{port}/"
    with running(service(port), port, subprocess.DEVNULL):
        firsts = []
        for _ in range(REPEATS):
            with browser() as context:
                firsts.append(first_chart(context, address))
        with browser() as context:
            first_chart(context, address)
            first_chart(context, address)
            again = [first_chart(context, address) for _ in range(REPEATS)]
            page = context.new_page()
            moves = {
                (tab, kind): median(drag(page, address, tab, kind))
                for tab in SLIDERS
                for kind in ("paraboloid", "rounded_punch")
            }
            drawings = recorded(page, address)
            with others_dragging(port, drawings):
                beside = sorted(drag(page, address, "push", "rounded_punch"))
        asyncio.run(small_queries(port, 1.0))
        idle = small_p99(port)
        with others_dragging(port, drawings):
            busy = small_p99(port)
    print(f"first chart            {median(firsts):6.2f} s   (bound 1.5)")
    print(f"first chart, cached    {median(again):6.2f} s   (bound 0.7)")
    for (tab, kind), taken in moves.items():
        print(f"{tab:5} {kind:16} {taken:6.0f} ms  (bound 100)")
    print(
        f"push  rounded_punch    {median(beside):6.0f} ms  beside {BROWSERS} browsers that drag, "
        f"slowest of {len(beside)} {beside[-1]:.0f} ms"
    )
    print(
        f"small query, p99       {1e3 * busy:6.2f} ms  while {BROWSERS} browsers drag, "
        f"{1e3 * idle:.2f} ms idle: {busy / idle:.1f} x (bound 10)"
    )


if __name__ == "__main__":
    if len(sys.argv) > 1:
        asyncio.run(replay(int(sys.argv[1]), json.load(sys.stdin)))
    else:
        main()
