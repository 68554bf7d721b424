"""Draw docs/figures/explorer.png, the explorer as the README shows it: `make figures`."""

import subprocess
from io import BytesIO
from pathlib import Path
from typing import Final

from PIL import Image
from playwright.sync_api import sync_playwright
from tests.contract.conftest import CHROMIUM, Visit
from tests.faults.server import free_port, running, service

FILE: Final = Path(__file__).with_name("explorer.png")
# A steel ball with friction: pressure, shear stress and the stick zone.
CASE: Final = "?tab=push"
SIZE: Final = {"width": 1280, "height": 860}
COLOURS: Final = 64


def main() -> None:
    """Open the page in headless Chromium and write what it shows."""
    port = free_port()
    with running(service(port), port, subprocess.DEVNULL), sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        visit = Visit(browser.new_page(viewport=SIZE), f"http://127.0.0.1:{port}/")
        visit.open(CASE)
        picture = Image.open(BytesIO(visit.page.screenshot()))
        browser.close()
    picture.convert("RGB").quantize(COLOURS).save(FILE, optimize=True)


if __name__ == "__main__":
    main()
