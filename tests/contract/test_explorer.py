"""The explorer in a browser: every tab is drawn, and every interaction works."""

import json
import re
from pathlib import Path
from typing import Any
from urllib.parse import urljoin

import httpx
import pytest
from axe_playwright_python.sync_playwright import Axe

from tests.contract.conftest import Visit, needs_chromium
from tests.contract.forged_addresses import forged

pytestmark = [pytest.mark.long, needs_chromium]
TABS = ["press", "push", "cycle", "stress", "wear"]
SCENES = 60
ADDRESSES = 2_000


def test_first_visit_shows_results_and_charts(visit: Visit) -> None:
    visit.page.goto(visit.address)
    visit.page.locator("figure .plot .main-svg").first.wait_for()
    visit.page.locator("#accuracy").get_by_text("relative error").wait_for()
    assert visit.page.locator("figure").count() == 3
    assert visit.number("Normal force") == "100 N"


def test_head_links_are_served(address: str) -> None:
    links = httpx.get(address, headers={"Accept": "application/json"}).json()
    for link in links.values():
        assert httpx.get(urljoin(address, link), follow_redirects=True).status_code == 200


@pytest.mark.parametrize("tab", TABS)
def test_tab_draws_its_charts_and_passes_axe(visit: Visit, tab: str) -> None:
    for scheme in ("light", "dark"):
        visit.page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
        visit.open(f"?tab={tab}")
        assert visit.page.locator("figure .main-svg").count() >= 3
        visit.page.locator("details summary").first.click()
        visit.page.locator(".data table tr").nth(2).wait_for()
        findings = Axe().run(visit.page).response["violations"]
        assert [(each["id"], each["nodes"][0]["html"]) for each in findings] == []


def test_every_profile_kind_is_drawn(visit: Visit) -> None:
    visit.open()
    kinds = visit.page.locator("#kind option").evaluate_all("all => all.map(one => one.value)")
    known = {each["kind"] for each in httpx.get(f"{visit.address}v1/profiles").json()["profiles"]}
    assert set(kinds) - {"balls"} == known
    for kind in kinds:
        visit.open(f"?kind={kind}")
        assert visit.page.locator("#problem").is_hidden(), kind
        assert visit.number("Normal force") == "100 N"


def test_results_are_those_of_hertz(visit: Visit) -> None:
    visit.open("?kind=paraboloid&ul=m&ud=m&up=Pa&uf=N")
    visit.fill("e1", "1e-9")
    visit.fill("nu1", "0")
    visit.page.select_option("#material-2", "Rigid")
    visit.fill("radius", "1")
    visit.fill("load", "1")
    visit.drawn()
    # E* = 1, R = 1, F = 1: a = (3/4)^(1/3), d = a².
    radius = 0.75 ** (1 / 3)
    assert float(visit.number("Contact radius a").split()[0]) == pytest.approx(
        radius, rel=1e-4, abs=0
    )
    assert float(visit.number("Indentation depth d").split()[0]) == pytest.approx(
        radius**2, rel=1e-4, abs=0
    )


def test_latest_slider_position_is_drawn(visit: Visit) -> None:
    visit.open("?tab=push&kind=rounded_punch")
    visit.page.evaluate(
        """async () => {
            const slider = document.querySelector(".field[data-key=amount] [type=range]");
            for (let i = 0; i <= 40; i++) {
                slider.value = 0.5 + i / 100;
                slider.dispatchEvent(new Event("input"));
                await new Promise((done) => setTimeout(done, 5));
            }
        }"""
    )
    visit.page.wait_for_url("**amount=0.9&**")
    visit.drawn()
    assert visit.number("Tangential force") == "27 N"


def test_pasted_table_is_solved_and_invalid_line_is_reported(visit: Visit) -> None:
    visit.open("?kind=tabulated")
    heading = "r, f\n"
    rows = [f"{1e-5 * i:.6g}, {5e-9 * i * i:.6g}" for i in range(41)]
    with visit.changing():
        visit.page.fill("#table", heading + "\n".join(rows))
    assert visit.page.locator("#problem").is_hidden()
    visit.page.fill("#table", heading + "\n".join([*rows[:20], "0.0002, 1e-9", *rows[21:]]))
    problem = visit.page.locator("#table-problem")
    problem.get_by_text("Line").wait_for()
    assert problem.inner_text().startswith("Line 22: f falls")
    visit.page.fill("#table", "0, 0\n1e-5, x")
    problem.get_by_text("Line 2: two numbers are expected").wait_for()


def test_invalid_value_is_reported_at_its_field(visit: Visit) -> None:
    visit.open()
    radius = visit.page.locator(".field[data-key=radius]")
    visit.page.fill("#field-radius", "ten")
    assert radius.locator(".problem").inner_text() == "not a number"
    visit.page.fill("#field-radius", "-1")
    radius.locator(".problem").get_by_text("greater than or equal to").wait_for()
    assert visit.page.locator("#field-radius").get_attribute("aria-invalid") == "true"
    visit.page.fill("#field-radius", "10")
    visit.page.locator("#problem").wait_for(state="hidden")
    assert radius.locator(".problem").inner_text() == ""


def test_load_path_points_are_keyboard_accessible(visit: Visit) -> None:
    visit.open("?tab=cycle&path=100,0;100,20")
    before = visit.number("Tangential force")
    visit.page.locator("#editor circle").nth(1).focus()
    with visit.changing():
        visit.page.keyboard.press("ArrowLeft")
        visit.page.keyboard.press("ArrowLeft")
    assert before == "20 N"
    assert float(visit.number("Tangential force").split()[0]) == pytest.approx(19, rel=1e-12, abs=0)
    visit.page.get_by_role("button", name="Remove point 2").click()
    visit.page.wait_for_url("**path=100,0&**")


def test_page_contents_can_be_downloaded(visit: Visit, tmp_path: Path) -> None:
    visit.open()
    starts = {"PNG": b"\x89PNG", "SVG": b"<svg"}
    for name, start in starts.items():
        with visit.page.expect_download() as download:
            visit.page.get_by_role("button", name=re.compile(f"^{name} of")).first.click()
        download.value.save_as(tmp_path / name)
        assert (tmp_path / name).read_bytes().startswith(start)
    first_columns = {"Download CSV": "indentation_depth,", "CSV of “Pressure”": "radius,"}
    for name, first in first_columns.items():
        with visit.page.expect_download() as download:
            visit.page.get_by_role("button", name=name).click()
        download.value.save_as(tmp_path / "table.csv")
        assert (tmp_path / "table.csv").read_text().startswith(first)
    visit.page.select_option("#language", "JSON")
    visit.page.get_by_role("button", name="Request of “Pressure”").click()
    assert json.loads(visit.page.locator("#code").inner_text())["quantities"] == ["pressure"]
    visit.page.get_by_role("button", name="Request of “Force over depth”").click()
    body = json.loads(visit.page.locator("#code").inner_text())
    assert body["profile"] == {"kind": "paraboloid", "radius": 0.01}
    visit.page.select_option("#language", "Python")
    compile(visit.page.locator("#code").inner_text(), "example", "exec")


def test_hover_radius_is_shown_in_every_radial_chart(visit: Visit) -> None:
    visit.open("?tab=push")
    plots = visit.page.locator("figure", has=visit.page.locator("h2", has_text="Shear stress"))
    plots.locator(".plot").hover()
    shown = visit.page.locator(".hoverlayer:has(.hovertext), .hoverlayer:has(.legend)")
    shown.nth(1).wait_for(state="attached")
    assert shown.count() == 2


@pytest.mark.parametrize("tab", TABS)
def test_case_is_printed_on_one_sheet(visit: Visit, tab: str) -> None:
    visit.page.emulate_media(color_scheme="dark")
    visit.open(f"?tab={tab}")
    assert len(re.findall(rb"/Type\s*/Page\b", visit.page.pdf(prefer_css_page_size=True))) == 1
    visit.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    given = visit.page.locator("#given").inner_text()
    assert given.startswith("Shape: Paraboloid (ball); Radius of curvature at the tip: 10 mm; ")
    assert visit.page.locator("form, #take-away").nth(0).is_hidden()
    plot = visit.page.locator("figure .main-svg").first
    assert plot.evaluate("plot => plot.clientWidth <= plot.closest('figure').clientWidth")
    visit.page.evaluate("dispatchEvent(new Event('afterprint'))")
    visit.page.locator("#inputs").wait_for()


ROUND_TRIP = Path(__file__).with_name("round_trip.js").read_text("utf-8")


def test_url_restores_the_case_with_identical_requests(visit: Visit) -> None:
    visit.open()
    results: list[dict[str, Any]] = visit.page.evaluate(ROUND_TRIP, SCENES)
    assert [each["url"] for each in results if each["first"] != each["second"]] == []
    assert all(each["first"] for each in results)
    solved = sum(each["solved"] for each in results)
    assert solved >= 0.8 * SCENES


FORGED = Path(__file__).with_name("forged_addresses.js").read_text("utf-8")


def test_forged_addresses_cause_no_error_and_no_markup(visit: Visit) -> None:
    visit.open()
    result = visit.page.evaluate(FORGED, list(forged(ADDRESSES, seed=1)))
    assert result["found"] == []
    assert result["cases"] >= 0.2 * ADDRESSES


@pytest.mark.parametrize(
    ("member", "link"),
    [
        ("ul", "?ul=<a href=https://evil.example>mm</a>"),
        ("kind", "?kind=constructor"),
        ("control", "?control=foo"),
        ("push", "?push=evil&tab=push"),
        ("normal", "?normal=evil&tab=cycle"),
        ("table", "?kind=tabulated#r=0,1e-3&f=0"),
        # Offered, but not for wear.
        ("control", "?tab=wear&control=contact_radius"),
    ],
)
def test_unreadable_member_of_a_link_is_named(visit: Visit, member: str, link: str) -> None:
    visit.open(link)
    assert visit.page.locator("#unread").inner_text().endswith(f"cannot read: {member}.")
    assert visit.page.locator("#charts a").count() == 0


@pytest.mark.parametrize("kind", ["paraboloid", "sphere", "ellipsoid", "flat_punch", "balls"])
def test_radius_zero_is_reported_at_its_field(visit: Visit, kind: str) -> None:
    visit.open(f"?kind={kind}")
    field = visit.page.locator("#profile-fields .field").first
    field.locator("[type=text]").fill("0")
    field.locator(".problem:not(:empty)").wait_for()
    assert visit.page.locator("#results").get_attribute("data-state") == "refused"
