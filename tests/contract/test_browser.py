"""The documentation page in a browser: its examples run and give the textbook result."""

import json
from typing import Any

import httpx
import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Locator

from tests.contract.conftest import Visit, needs_chromium

pytestmark = [pytest.mark.long, needs_chromium]


def opened(visit: Visit, operation: str) -> Locator:
    visit.page.goto(f"{visit.address}docs")
    computed = visit.page.locator(f"#operations-{operation}")
    computed.locator(".opblock-summary-control").click()
    computed.locator(".try-out__btn").click()
    return computed


def executed(operation: Locator) -> Any:
    operation.locator(".execute").click()
    response = operation.locator(".live-responses-table .response-col_description code").first
    return json.loads(response.inner_text())


def test_example_gives_the_textbook_result(visit: Visit) -> None:
    """Hertz 1882, a steel ball of 1 cm on steel: a^3 = 3 F R/(4 E*)."""
    document = executed(opened(visit, "contact-normal"))
    (a,), force = document["contact_radius"], 10.0
    assert document["normal_force"] == [force]
    e_star = 210e9 / (1 - 0.3**2) / 2
    assert a == pytest.approx((3 * force * 0.01 / (4 * e_star)) ** (1 / 3), rel=1e-12, abs=0)
    assert document["elastic_energy"] == pytest.approx(
        [0.4 * force * a**2 / 0.01], rel=1e-12, abs=0
    )


# Findings in the components of Swagger UI, which the page cannot change.
OF_SWAGGER = {"color-contrast", "heading-order", "nested-interactive", "region", "select-name"}


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_page_adds_no_finding_of_axe_and_is_dark_in_dark_mode(visit: Visit, scheme: str) -> None:
    visit.page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    visit.page.goto(f"{visit.address}docs")
    visit.page.locator("#operations-contact-normal").wait_for()
    assert {each["id"] for each in Axe().run(visit.page).response["violations"]} <= OF_SWAGGER
    style = "body => getComputedStyle(body.querySelector('#swagger-ui')).filter"
    assert visit.page.locator("body").evaluate(style).startswith("invert") == (scheme == "dark")


@pytest.mark.parametrize("name", ["normal", "tangential", "stress"])
def test_get_example_runs(visit: Visit, name: str) -> None:
    assert executed(opened(visit, f"contact-get_{name}"))["warnings"] is not None


def test_svg_response_is_shown_as_an_image(visit: Visit) -> None:
    operation = opened(visit, "contact-normal")
    operation.locator("tr.response[data-code='200'] select.content-type").select_option(
        "image/svg+xml"
    )
    operation.locator(".execute").click()
    picture = operation.locator("img.picture")
    picture.wait_for()
    assert picture.evaluate("image => image.decode().then(() => image.naturalWidth)") > 100


def test_page_links_to_manual_licence_and_explorer(visit: Visit) -> None:
    visit.page.goto(f"{visit.address}docs")
    # Without a manual, `make docs`, the service shows its introduction instead.
    for name, text in {
        "Manual": ("# MDR", "\n<!doctype html>"),
        "Licence": "MIT License",
        "Explorer": "<!DOCTYPE html>",
    }.items():
        link = visit.page.locator(".info a", has_text=name).first.evaluate("link => link.href")
        response = httpx.get(link, follow_redirects=True)
        assert response.status_code == 200
        assert response.text.startswith(text)
