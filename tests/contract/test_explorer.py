"""The explorer in a browser: every tab is drawn, and every interaction works."""

import csv
import json
import math
import re
import zipfile
from importlib.metadata import version
from pathlib import Path
from typing import Any
from urllib.parse import urljoin

import httpx
import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page

from tests.contract.conftest import Visit, needs_chromium
from tests.contract.forged_addresses import forged

pytestmark = [pytest.mark.long, needs_chromium]
TABS = ["press", "push", "cycle", "impact", "stress", "wear", "fit"]
SCENES = 60
ADDRESSES = 120


def script(name: str) -> str:
    return Path(__file__).with_name(name).read_text("utf-8")


def test_first_visit_shows_results_and_charts(visit: Visit) -> None:
    visit.page.goto(visit.address)
    visit.page.locator("figure .plot .main-svg").first.wait_for()
    visit.page.locator("#accuracy").get_by_text("relative error").wait_for()
    assert visit.page.locator("figure").count() == 3
    assert visit.number("Normal force F_N") == "100 N"


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
        visit.page.locator("figure summary").first.click()
        visit.page.locator(".data table tr").nth(2).wait_for()
        findings = Axe().run(visit.page).response["violations"]
        assert [(each["id"], each["nodes"][0]["html"]) for each in findings] == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_catalogue_lists_kinds_and_limits_and_passes_axe(visit: Visit, scheme: str) -> None:
    visit.page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    visit.page.goto(f"{visit.address}explorer/catalogue.html")
    visit.page.locator("#limits tbody tr").first.wait_for()
    kinds = httpx.get(f"{visit.address}v1/profiles").json()["profiles"]
    assert visit.page.locator("#kinds tbody tr").count() == len(kinds)
    limits = httpx.get(f"{visit.address}v1/limits").json()
    assert visit.page.locator("#limits tbody tr").count() == len(limits)
    assert Axe().run(visit.page).response["violations"] == []


def test_every_profile_kind_is_drawn(visit: Visit) -> None:
    visit.open()
    kinds = visit.page.locator("#kind option").evaluate_all("all => all.map(one => one.value)")
    known = {each["kind"] for each in httpx.get(f"{visit.address}v1/profiles").json()["profiles"]}
    assert set(kinds) == known
    for kind in kinds:
        visit.open(f"?kind={kind}")
        assert visit.page.locator("#problem").is_hidden(), kind
        assert visit.number("Normal force F_N") == "100 N"


def test_results_are_those_of_hertz(visit: Visit) -> None:
    visit.open("?kind=paraboloid&ul=m&ud=m&up=Pa&uf=N")
    visit.fill("e1", "1e-9")
    visit.fill("nu1", "0")
    visit.page.select_option("#field-material-2", "Rigid")
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


def test_limits_of_the_model_are_shown_in_one_line(visit: Visit) -> None:
    visit.open("?kind=paraboloid&radius=0.01&load=100&ul=mm&up=MPa")
    e_star, t = 2.1e11 / 0.91 / 2, 0.01
    a = (0.75 * 100 * 0.01 / e_star) ** (1 / 3)
    # JKR: F = 4 E* b^3/(3 R) - (8 pi w E* b^3)^(1/2) at b = a (1 + t), F = 4 E* a^3/(3 R); and
    # 2 tau_max = 0.620 p_0 for a Poisson's ratio of 0.3 (Johnson, section 4.2).
    b = a * (1 + t)
    work = (100 * ((b / a) ** 3 - 1)) ** 2 / (8 * math.pi * e_star * b**3)
    strength = float(f"{0.620 * 1.5 * 100 / (math.pi * a**2) / 1e6:.2g}")
    line = visit.page.locator("#accuracy p").first.inner_text()
    expected = (
        rf"Left-out effects change the results by at most 1 %: adhesion below {work:.2g} N/m, "
        rf"tangential force below {1 - 0.98**3:.2g} µF_N, thickness above [\d.]+ mm, "
        rf"yield strength above {strength:g} MPa [(]body 1 has 250 MPa: it yields[)][.]"
    )
    assert re.fullmatch(expected, line), line
    # Of two bodies the weaker one whose strength is known is named, and no rigid one.
    for case, named in (
        ("e1=2.07e11&nu1=0.3&e2=7e10&nu2=0.33", "body 2 has 276 MPa: it yields"),
        ("e1=rigid&e2=2.07e11&nu2=0.3", "MPa."),
    ):
        visit.open(f"?kind=paraboloid&radius=0.01&load=100&ul=mm&up=MPa&{case}")
        assert named in visit.page.locator("#accuracy p").first.inner_text()
    visit.open("?kind=paraboloid&radius=0.01&load=100&ul=mm&up=MPa")
    # Johnson, section 4.2: 0.31 p_0 at the depth 0.48 a.
    p_0 = 1.5 * 100 / (math.pi * a**2) / 1e6
    axis = visit.page.locator("#accuracy p").nth(1).inner_text()
    found = re.match(
        r"On the axis .* is (\S+) MPa at the depth (\S+) mm, von Mises (\S+) MPa", axis
    )
    assert found, axis
    shown = [float(each) for each in found.groups()]
    assert shown == pytest.approx([0.31 * p_0, 0.48e3 * a, 0.62 * p_0], rel=1e-2, abs=0)
    # Without a load, and with adhesion, there are none.
    for case in ("?load=0", "?w=0.1"):
        visit.open(case)
        assert "Within" not in visit.page.inner_text("#accuracy")


def test_sources_of_the_results_are_shown_under_them(visit: Visit) -> None:
    visit.open("?tab=press")
    body = {"profile": {"kind": "paraboloid", "radius": 0.01}, "material": {"e_star": 1e11}}
    load = {"load": {"normal_force": 100}}
    path = f"{visit.address}v1/normal"
    sources = httpx.post(path, json=body | load).json()["sources"]
    assert sources
    shown = visit.page.inner_text("#accuracy small")
    assert shown.startswith("Sources: ")
    for source in sources:
        assert shown.count(source) == 1
    # The sources of another analysis replace them.
    with visit.changing():
        visit.page.click("#tab-wear")
    assert "(5.80)-(5.90)" in visit.page.inner_text("#accuracy small")


@pytest.mark.parametrize("load", ["-2e-4", "0", "1e-3"])
def test_adhesive_ball_pulls_off_as_jkr(visit: Visit, load: str) -> None:
    visit.open(f"?kind=paraboloid&radius=0.001&e1=rigid&e2=2e6&nu2=0.5&w=0.05&load={load}&uf=mN")
    assert visit.page.locator("#problem").is_hidden()
    # -(3/2) π w R.
    force = float(visit.number("Pull-off force").split()[0].replace("−", "-"))
    assert force == pytest.approx(-1.5 * math.pi * 0.05, rel=1e-4, abs=0)
    text = visit.page.inner_text("#accuracy")
    assert "The model itself errs by about 0." in text
    # The error of the state, not of the pull-off at which the curve begins.
    assert re.search(r"relative error [^ ]+·10⁻¹.", text) or "relative error 0" in text
    # Stable and unstable states, as they are drawn: F = 4 E* a³/(3 R) - (8 π E* w a³)^(1/2).
    drawn = visit.page.evaluate(
        "[...document.querySelectorAll('.plot')][2].data.map(({ name, x, y }) => [name, x, y])"
    )
    assert [name for name, *_ in drawn][2] == "unstable"
    for _, force, radius in (drawn[0], drawn[2]):
        a3, e_star = (np.array(radius) * 1e-3) ** 3, 2e6 / 0.75
        expected = 4 * e_star * a3 / 3e-3 - np.sqrt(8 * np.pi * e_star * 0.05 * a3)
        assert np.array(force) / 1e3 == pytest.approx(expected, rel=1e-5, abs=1e-12)
    assert not visit.errors


def test_work_of_adhesion_is_fitted(visit: Visit) -> None:
    # JKR at E* = 1 N/m², R = 1 m, w = 1e-3 N/m.
    a = np.geomspace(0.1, 0.4, 40)
    d, force = a**2 - np.sqrt(2e-3 * np.pi * a), 4 / 3 * a**3 - np.sqrt(8e-3 * np.pi * a**3)
    columns = [",".join(f"{x:.12g}" for x in column) for column in (d, force)]
    fitted = "contact_point,force_offset,work_of_adhesion"
    visit.open(
        f"?tab=fit&kind=paraboloid&radius=1&fitted={fitted}#d={columns[0]}&F={columns[1]}&ud=m&uF=N"
    )
    assert visit.page.locator("#problem").is_hidden()
    assert visit.number("Work of adhesion").startswith("0.001 ")
    assert not visit.errors


@pytest.mark.parametrize(
    ("base", "force", "depth"),
    # By finite elements and by 30 digits of the equation of a layer, for E* = R = a = h = 1.
    [("bonded", 1.880666899171, 0.5594154855629), ("sliding", 1.578122747287, 0.6739806449888)],
)
def test_press_computes_with_a_thickness(
    visit: Visit, base: str, force: float, depth: float
) -> None:
    units = "ul=m&ud=m&uf=N&up=Pa&um=Pa"
    visit.open(f"?kind=paraboloid&radius=1&e1=rigid&e2=0.75&nu2=0.5&load={force}&{units}")
    choice = visit.page.locator("#field-base")
    assert choice.is_hidden()
    visit.fill("thickness", "1")
    if base == "sliding":
        with visit.changing():
            choice.select_option(base)
    assert visit.number("Contact radius a") == "1 m"
    shown = float(visit.number("Indentation depth d").split()[0])
    assert shown == pytest.approx(depth, rel=1e-4, abs=0)
    assert "lebedev" in visit.page.inner_text("#accuracy")
    # With adhesion, too: its curve holds many loads.
    visit.fill("w", "0.01")
    assert visit.state() == "current"
    # Other analyses check the thickness.
    with visit.changing():
        visit.page.click("#tab-push")
    assert choice.count() == 0
    assert "thin body" in visit.page.inner_text("#warnings")


def test_contact_that_a_layer_cannot_carry_is_refused_at_its_load(visit: Visit) -> None:
    visit.open("?kind=paraboloid")
    visit.page.fill("#field-thickness", "1e-3")
    visit.page.locator("#problem").get_by_text("beyond radius 0.01 mm, where").wait_for()
    assert visit.state() == "refused"


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
    visit.page.wait_for_url("**amount=0.9*")
    visit.drawn()
    assert visit.number("Tangential force F_x") == "27 N"


def test_only_what_a_change_affects_is_computed_again(visit: Visit) -> None:
    visit.open("?tab=push")
    asked: list[str] = []
    visit.page.on(
        "request",
        lambda each: asked.append(each.url) if each.method == "POST" else None,
    )
    visit.fill("amount", "0.4")
    # The curve of all forces and the twist do not depend on the force.
    assert sorted(url.rpartition("/v1/")[2] for url in asked) == ["stress", "tangential"]


def pasted(visit: Visit, text: str) -> None:
    with visit.changing():
        visit.page.fill("#table", text)


def test_units_of_a_pasted_table_are_those_of_its_heading(visit: Visit) -> None:
    visit.open("?kind=tabulated")
    # A ball of radius 10 mm, in two units; without a heading in those that are chosen.
    points = [(0.01 * i, 0.005 * i * i) for i in range(41)]
    note = visit.page.locator("#table-note")
    for heading, (a, b) in {"r [mm]; f [µm]": (1, 1), "r/nm; f/nm": (1e6, 1e3)}.items():
        rows = [f"{r * a:.6g};{f * b:.6g}" for r, f in points]
        pasted(visit, "\n".join([heading, *rows]))
        assert note.inner_text() == (
            "41 points. Column 1, “r”, is taken as the radius. "
            "Column 2, “f”, is taken as the height."
        )
        assert visit.number("Contact radius a").startswith("0.186")
    visit.page.select_option("#unit-r", "mm")
    warning = visit.page.locator("#warnings").get_by_text("check the units of the table")
    assert re.search(
        r"contact radius is [\d.]+ (mm|µm|nm), small against .* mm:", warning.inner_text()
    )
    assert visit.page.input_value("#table").startswith("r [mm], f [nm]\n0, 0\n10000, 5\n")
    # Of the two units the user has chosen the first alone.
    visit.page.fill("#table", "\n".join(f"{r:.6g} {f:.6g}" for r, f in points))
    problem = visit.page.locator("#problem-table")
    problem.get_by_text("no heading names the unit of f: choose it").wait_for()
    assert visit.state() == "unreadable"
    with visit.changing():
        visit.page.select_option("#unit-f", "µm")
    assert visit.number("Contact radius a").startswith("0.186")


def test_topography_of_a_scan_becomes_a_profile(visit: Visit) -> None:
    visit.open("?kind=tabulated")
    problem = visit.page.locator("#problem-table")
    # A ball of radius 10 mm, whose summit is at 0.35 mm.
    rows = [f"{i / 50:.2f};{7 - 50 * (i / 50 - 0.35) ** 2:.4f}" for i in range(41)]
    visit.page.fill("#table", "\n".join(["x [mm]; z [µm]", *rows]))
    problem.get_by_text("of the axis, near 0.35 mm, and reverse the sign of the heights").wait_for()
    visit.page.click("#table-fields .reverse")
    problem.get_by_text("of the axis, near 0.35 mm; else").wait_for()
    with visit.changing():
        visit.page.click("#table-fields .centre")
    assert visit.page.input_value("#table").startswith("r [mm], f [µm]\n-0.35, -0.875\n")
    assert visit.number("Contact radius a").startswith("0.186")


def test_area_function_fills_the_table(visit: Visit) -> None:
    visit.open("?kind=tabulated&control=indentation_depth&load=1e-7")
    note = visit.page.locator("#table-note")
    # A = pi h^2 is a cone of slope 1, in nm: a = 2 d/pi.
    visit.page.select_option("#unit-f", "nm")
    visit.page.get_by_text("From a tip’s area function").click()
    visit.page.fill("#coefficients", f"{math.pi} x")
    visit.page.click(".use-area")
    visit.page.get_by_text("enter the coefficients as numbers").wait_for()
    visit.page.fill("#coefficients", str(math.pi))
    visit.page.fill("#largest-height", "300")
    with visit.changing():
        visit.page.click(".use-area")
    assert note.inner_text().startswith("200 points. Column 2, “A”, is taken as the area, with r =")
    assert visit.page.input_value("#unit-r") == "nm"
    assert visit.number("Contact radius a").startswith("63.66")
    # With a term that makes A(h) negative at the end of the tip, from a height at which it holds.
    visit.page.fill("#coefficients", f"{math.pi} -20".replace(".", ","))
    visit.page.fill("#lowest-height", "20")
    with visit.changing():
        visit.page.click(".use-area")
    assert visit.page.input_value("#table").splitlines()[2].startswith("20, ")


def test_curve_from_an_instrument_is_fitted(visit: Visit, tmp_path: Path) -> None:
    visit.open("?tab=fit")
    assert visit.number("Effective modulus E*").startswith("10.7")
    # 2 MPa under a ball of 10 mm, with contact at 3 µm, in nm and mN.
    depths = [250 * i for i in range(80)]
    forces = [4 / 3 * 2e6 * 0.1 * max(1e-9 * d - 3e-6, 0.0) ** 1.5 * 1e3 for d in depths]
    rows = (f"{i};{d};{f:.9f}" for i, (d, f) in enumerate(zip(depths, forces, strict=True)))
    file = tmp_path / "curve.csv"
    heading = "Time [s];Displacement [nm];Load [mN]\n"
    file.write_text(heading + "\n".join(rows).replace(".", ","), "utf-8")
    with visit.changing():
        visit.page.set_input_files("#curve-file", file)
    note = visit.page.locator("#curve-note").inner_text()
    assert note.startswith("80 points. Column 2, “Displacement”, is taken as the depth. Column 3")
    modulus = visit.number("Effective modulus E*").split()
    assert float(modulus[0]) == pytest.approx(2, rel=1e-6, abs=0)
    assert modulus[-1] == "MPa"
    assert visit.number("Contact point").startswith("3")
    # As a separation it is refused, until its sign is reversed.
    for column, problem in (("r", "of a separation or height"), ("f", "reverse its sign")):
        visit.page.click(f"#curve-fields [data-list={column}]")
        assert visit.state() == "refused"
        assert visit.page.locator("#problem-curve").inner_text().endswith(problem)
        visit.page.click(f"#curve-fields [data-list={column}]")
        assert visit.state() == "current"
    visit.page.fill("#curve", "d [nm], F [mm]\n0, 0\n1, 2\n2, 3")
    problem = visit.page.locator("#problem-curve")
    problem.get_by_text("name the depth d and the force F in a line above").wait_for()
    assert visit.state() == "unreadable"
    # The curve belongs to this tab alone.
    with visit.changing():
        visit.page.click("#tab-press")
    assert visit.page.locator("#measured").is_hidden()


def test_fit_computes_with_a_thickness(visit: Visit, address: str) -> None:
    # A ball of 5 µm on a gel of 2 kPa and 4 µm.
    gel = {"youngs_modulus": 2e3, "poissons_ratio": 0.5}
    material = {"bodies": ["rigid", gel], "layer": {"thickness": 4e-6, "base": "bonded"}}
    depths = np.linspace(5e-8, 1e-6, 20).tolist()
    body = {"profile": {"kind": "paraboloid", "radius": 5e-6}, "material": material}
    load = {"load": {"indentation_depth": depths}}
    forces = httpx.post(f"{address}v1/normal", json=body | load).json()["normal_force"]
    case = "?tab=fit&radius=5e-6&e1=rigid&nu2=0.5&um=kPa&thickness=4e-6"
    d, f = (",".join(map(str, each)) for each in (depths, forces))
    visit.open(f"{case}#d={d}&F={f}&ud=m&uF=N")
    modulus = visit.number("Young's modulus of the sample").split()[0]
    assert float(modulus) == pytest.approx(2, rel=1e-4, abs=0)
    # A loop checks the thickness.
    visit.page.select_option("#field-measured", "loop")
    assert visit.state() == "current"
    assert visit.page.locator("#field-base").count() == 0


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "cp1252"])
def test_text_of_a_file_is_that_which_is_read(visit: Visit, tmp_path: Path, encoding: str) -> None:
    visit.open("?kind=tabulated&load=1e-4")
    file = tmp_path / "profile.txt"
    file.write_text("Strecke [µm];Höhe [nm];Güte\n0;0;1\n1;2;1\n2;8;1\n", encoding)
    visit.page.set_input_files("#file", file)
    visit.page.locator("#problem-table").get_by_text("name the radius r").wait_for()
    text = visit.page.input_value("#table")
    assert text.startswith("Strecke [µm];Höhe [nm]")
    # An edited text is read as the file, and offers columns if there are any.
    columns = visit.page.locator("#table-fields .columns select")
    assert columns.count() == 2
    visit.page.fill("#table", "no numbers")
    visit.page.locator("#problem-table").get_by_text("no line holds two numbers").wait_for()
    assert columns.count() == 0
    with visit.changing():
        visit.page.fill("#table", text.replace("Strecke", "r"))
    assert visit.page.input_value("#unit-r") == "µm"


@pytest.mark.parametrize(("key", "depth"), [("to", "-30"), ("from", "39")])
def test_range_without_points_is_an_error_at_its_field(visit: Visit, key: str, depth: str) -> None:
    visit.open("?tab=fit")
    visit.page.fill(f"#field-{key}", depth)
    assert visit.state() == "refused"
    problem = visit.page.locator(f".field[data-key={key}] .problem")
    assert problem.inner_text() == "fewer than 3 points are left to fit"


def hertz(depths: np.ndarray, modulus: float, point: float) -> np.ndarray:
    """Return the forces [N] of a ball of 10 mm over depths [m]."""
    return 4 / 3 * modulus * 0.1 * np.maximum(depths - point, 0) ** 1.5


def test_columns_segment_and_depths_of_a_curve_are_chosen(visit: Visit, tmp_path: Path) -> None:
    visit.open("?tab=fit&e1=rigid&nu2=0.5&fitted=contact_point")
    loading, unloading = np.linspace(-5e-6, 2e-5, 51), np.linspace(1.9e-5, -5e-6, 49)
    depths = np.append(loading, unloading)
    forces = np.append(hertz(loading, 2e6, 3e-6), hertz(unloading, 3e6, 5e-6))
    rows = [
        f"{i},{9 - i},{d:.9g},{f:.12g}" for i, (d, f) in enumerate(zip(depths, forces, strict=True))
    ]
    file = tmp_path / "curve.csv"
    file.write_text("\n".join(["Point,Gauge,LVDT,Signal", *rows]), "utf-8")
    visit.page.set_input_files("#curve-file", file)
    columns = visit.page.locator("#curve-fields .columns select")
    columns.nth(1).wait_for()
    assert visit.state() == "unreadable"
    columns.nth(0).select_option("3")
    columns.nth(1).select_option("4")
    # The file names no units.
    problem = visit.page.locator("#problem-curve")
    problem.get_by_text("no heading names the unit of d and F: choose it").wait_for()
    visit.page.select_option("#unit-depth", "m")
    problem.get_by_text("the unit of F").wait_for()
    with visit.changing():
        visit.page.select_option("#unit-force", "N")
    visit.page.locator("#warnings").get_by_text("two branches").wait_for()
    segments = visit.page.locator("#field-rows option").all_inner_texts()
    assert segments == ["all points", "loading, 1 to 51", "unloading, 52 to 100"]
    for option, modulus in (("0,50", 2.0), ("51,99", 3.0)):
        with visit.changing():
            visit.page.select_option("#field-rows", option)
        fitted, unit = visit.number("Effective modulus E*").split(" ± ")[0], "MPa"
        assert float(fitted) == pytest.approx(modulus, rel=1e-6, abs=0)
        sample = visit.number("Young's modulus of the sample")
        assert float(sample.split()[0]) == pytest.approx(0.75 * modulus, rel=1e-6, abs=0)
        assert sample.endswith(unit)
    # Another step of the history and back, the segments are still those of the file.
    with visit.changing():
        visit.page.click("#tab-press")
    with visit.changing():
        visit.page.go_back()
    assert visit.page.locator("#field-rows option").all_inner_texts() == segments
    # Dragging over the chart takes the depths between, and a link keeps the choice.
    chart = visit.page.locator("figure", has_text="Force against depth").locator(".nsewdrag").first
    box = chart.bounding_box()
    assert box is not None
    with visit.changing():
        visit.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 30)
        visit.page.mouse.down()
        visit.page.mouse.move(box["x"] + 0.9 * box["width"], box["y"] + 60, steps=5)
        visit.page.mouse.up()
    assert "from=" in visit.page.url
    least = visit.page.input_value("#field-from")
    assert 0 < float(least) < float(visit.page.input_value("#field-to"))
    sent = json.loads(request(visit, "Fit"))["indentation_depth"]
    # In the units of the file.
    assert float(least) <= min(sent) * (1 + 1e-9)
    assert len(sent) < 49
    url = visit.page.url
    visit.open(url.removeprefix(visit.address))
    assert json.loads(request(visit, "Fit"))["indentation_depth"] == sent


def test_drift_of_a_hold_is_subtracted_on_request(visit: Visit, tmp_path: Path) -> None:
    visit.open("?tab=fit&e1=rigid&nu2=0.5&fitted=contact_point")
    # Loading to 20 µm, a hold, unloading to 6 µm, a hold and the rest, with a drift of 20 nm/s.
    parts = [np.linspace(-5e-6, 2e-5, 51), np.full(20, 2e-5), np.linspace(2e-5, 6e-6, 40)]
    depths = np.concatenate([*parts, np.full(40, 6e-6), np.linspace(6e-6, -5e-6, 30)])
    forces = hertz(depths, 2e6, 0.0)
    rows = [
        f"{i};{1e6 * d + 0.02 * i:.9f};{1e3 * f:.9f}"
        for i, (d, f) in enumerate(zip(depths, forces, strict=True))
    ]
    file = tmp_path / "curve.csv"
    file.write_text("\n".join(["t [s];d [µm];F [mN]", *rows]), "utf-8")
    with visit.changing():
        visit.page.set_input_files("#curve-file", file)
    segments = visit.page.locator("#field-rows option").all_inner_texts()
    kinds = ["all points", "loading", "hold", "unloading", "hold", "unloading"]
    assert [each.split(",")[0] for each in segments] == kinds
    with visit.changing():
        visit.page.select_option("#field-rows", index=1)
    assert not visit.number("Effective modulus E*").startswith("2.0000")
    with visit.changing():
        visit.page.select_option("#field-drift", index=1)
    modulus = visit.number("Effective modulus E*").split()
    assert float(modulus[0]) == pytest.approx(2, rel=1e-4, abs=0)
    assert visit.number("Drift").startswith("20 ±")
    sent = json.loads(request(visit, "Fit"))
    assert sent["drift_rate"] == pytest.approx(2e-8, rel=1e-4, abs=0)
    # A link keeps the times and the rate.
    visit.open(visit.page.url.removeprefix(visit.address))
    assert json.loads(request(visit, "Fit")) == sent


def mindlin_loop(rig: float, part: float = 1.5) -> tuple[np.ndarray, np.ndarray]:
    """Return a loop of a ball of 10 mm under 10 N, for E* = 2 GPa, G* = 1.6 GPa and mu = 0.3.

    The amplitude of the contact is a `part` of the amplitude of full slip.
    """
    depth = (7.5 / (2e9 * 0.1)) ** (2 / 3)
    whole = 0.3 * 2 / 1.6 * depth
    most = part * whole
    u = most * np.cos(np.linspace(0, 4, 161) * np.pi)
    way = np.where(np.arange(161) // 40 % 2, 1, -1)
    first = [3 * (1 - np.maximum(1 - x / whole, 0) ** 1.5) for x in ((most + way * u) / 2, most)]
    force = way * (2 * first[0] - first[1])
    return u + rig * force, force


@pytest.mark.parametrize("rig", ["", "1"])
def test_loop_tells_friction_and_shear_modulus(visit: Visit, rig: str) -> None:
    visit.open("?tab=fit&kind=paraboloid&radius=0.01&e1=rigid&e2=1.5e9&nu2=0.5&load=10")
    with visit.changing():
        visit.page.select_option("#field-measured", "loop")
    assert visit.page.inner_text("#lead").startswith("A loop of friction")
    u, force = mindlin_loop(1e-6)
    force += np.random.default_rng(2).normal(0, 0.01, force.size)
    rows = [f"{x * 1e6:.9g},{f:.9g}" for x, f in zip(u, force, strict=True)]
    with visit.changing():
        visit.page.fill("#curve", "\n".join(["u [µm],F [N]", *rows]))
    if rig:
        visit.fill("rig", rig)
    ends = u[:81], force[:81]
    energy = 1e6 * abs(np.trapezoid(ends[1], ends[0]))
    expected = {
        "Effective shear modulus G*": (1.6, "GPa"),
        "Coefficient of friction µ": (0.3, ""),
        "Dissipated energy per cycle": (energy, "µJ"),
        **({} if rig else {"Compliance of the rig": (1.0, "µm/N")}),
    }
    for label, (value, unit) in expected.items():
        shown, error = visit.number(label).split(" ± ")
        spread = float(error.split()[0])
        assert error.endswith(unit)
        # The energy of the trapezoidal rule has the noise of single points, too.
        assert abs(float(shown) - value) < 4 * spread + 1e-3 * value, label
        assert 0 < spread < 0.1 * value
    assert visit.page.inner_text("#warnings") == ""
    # A switch back finds the curve as it was.
    with visit.changing():
        visit.page.select_option("#field-measured", "curve")
    assert visit.number("Effective modulus E*").startswith("10.7")
    with visit.changing():
        visit.page.select_option("#field-measured", "loop")
    assert visit.number("Coefficient of friction µ").startswith("0.")
    # Partial slip does not tell a rig from the contact.
    if not rig:
        u, force = mindlin_loop(1e-6, 0.4)
        force += np.random.default_rng(3).normal(0, 0.03, force.size)
        rows = [f"{x * 1e6:.9g},{f:.9g}" for x, f in zip(u, force, strict=True)]
        visit.page.fill("#curve", "\n".join(["u [µm],F [N]", *rows]))
        visit.page.locator("#problem").get_by_text("partial slip cannot tell").wait_for()


def test_columns_of_a_loop_are_taken_only_if_they_leave_no_choice(
    visit: Visit, tmp_path: Path
) -> None:
    visit.open("?tab=fit&kind=paraboloid&radius=0.01&e1=rigid&e2=1.5e9&nu2=0.5&load=10")
    with visit.changing():
        visit.page.select_option("#field-measured", "loop")
    points = enumerate(zip(*mindlin_loop(1e-6), strict=True))
    rows = [[f"{i}", f"{1e6 * x:.9g}", f"{f:.9g}", "10"] for i, (x, f) in points]
    titles = ["Time [s]", "Position [µm]", "Tangential force [N]", "Normal force [N]"]
    file = tmp_path / "loop.csv"
    columns = visit.page.locator("#curve-fields .columns select")

    def is_read(count: int) -> None:
        assert [columns.nth(i).input_value() for i in (0, 1)] == ["2", "3"]
        assert visit.page.locator("#curve-note").inner_text() == (
            f"{count} points. Column 2, “Position”, is taken as the displacement. "
            "Column 3, “Tangential force”, is taken as the force."
        )
        fitted = visit.number("Coefficient of friction µ").split()[0]
        assert float(fitted) == pytest.approx(0.3, rel=1e-3, abs=0)

    file.write_text("\n".join(";".join(row) for row in [titles, *rows]), "utf-8")
    visit.page.set_input_files("#curve-file", file)
    problem = visit.page.locator("#problem-curve")
    problem.get_by_text("choose the columns of u and F").wait_for()
    assert visit.state() == "unreadable"
    assert [columns.nth(i).input_value() for i in (0, 1)] == ["", ""]
    columns.nth(0).select_option("2")
    with visit.changing():
        columns.nth(1).select_option("3")
    is_read(161)
    # Beside the time there are only two columns.
    file.write_text("\n".join(";".join(row[:3]) for row in [titles, *rows[:121]]), "utf-8")
    with visit.changing():
        visit.page.set_input_files("#curve-file", file)
    is_read(121)


def test_line_of_a_table_that_cannot_be_used_is_named(visit: Visit) -> None:
    visit.open("?kind=tabulated")
    problem = visit.page.locator("#problem-table")
    visit.page.fill("#table", "0, 0\n1e-5, x")
    problem.get_by_text("Line 2: 2 numbers are expected").wait_for()
    assert visit.state() == "unreadable"
    # The text stays while the rest of the form is built again.
    visit.page.click("#tab-push")
    assert visit.page.input_value("#table") == "0, 0\n1e-5, x"
    assert visit.state() == "unreadable"
    visit.page.fill(
        "#table", "r [m], f [m]\n" + "\n".join(f"{i}e-5, -{i * i}e-9" for i in range(9))
    )
    problem.get_by_text(re.compile("fall")).wait_for()
    assert visit.state() == "refused"


def test_file_with_too_many_points_is_thinned(visit: Visit, tmp_path: Path) -> None:
    visit.open("?kind=tabulated")
    file = tmp_path / "trace.csv"
    rows = (f"{i / 10:.1f};{5e-4 * i * i:.3f}".replace(".", ",") for i in range(4500))
    file.write_text("Weg [µm];Höhe [nm]\n" + "\n".join(rows), "cp1252")
    visit.page.set_input_files("#file", file)
    problem = visit.page.locator("#problem-table")
    problem.get_by_text("4500 points; the service takes at most 2000").wait_for()
    with visit.changing():
        visit.page.click("#table-fields .thin")
    assert visit.page.locator("#table-note").inner_text() == "1500 points."
    assert visit.page.input_value("#unit-r") == "µm"
    assert visit.number("Contact radius a").startswith("0.186")


def test_invalid_value_is_reported_at_its_field(visit: Visit) -> None:
    visit.open()
    radius = visit.page.locator(".field[data-key=radius]")
    visit.page.fill("#field-radius", "ten")
    assert radius.locator(".problem").inner_text() == "not a number"
    assert visit.state() == "unreadable"
    visit.page.fill("#field-radius", "1,000")
    assert radius.locator(".problem").inner_text() == "write 1000 or, for a decimal, 1.000"
    visit.page.fill("#field-radius", "-1")
    radius.locator(".problem").get_by_text("must be positive").wait_for()
    assert visit.page.locator("#problem").inner_text() == (
        "Invalid request: Radius of curvature at the tip: must be positive"
    )
    assert visit.page.locator("#field-radius").get_attribute("aria-invalid") == "true"
    assert visit.state() == "refused"
    visit.page.fill("#field-radius", "10")
    visit.page.locator("#problem").wait_for(state="hidden")
    assert radius.locator(".problem").inner_text() == ""


BAD_VALUES = ["", "ten", "1,000", "-1", "0", "1e400", "NaN", "1e-60", "0x10", "1 2", "--1", "1e60"]


@pytest.mark.parametrize("tab", TABS)
def test_no_results_are_shown_beside_input_of_another_case(visit: Visit, tab: str) -> None:
    visit.open()
    kinds = visit.page.locator("#kind option").evaluate_all("all => all.map(one => one.value)")
    assert len(kinds) == 16
    # All kinds have the same form in each analysis.
    if tab != TABS[0]:
        kinds = kinds[TABS.index(tab) % 4 :: 4]
    given = {"tabs": [tab], "kinds": kinds, "values": BAD_VALUES}
    result = visit.page.evaluate(script("bad_values.js"), given)
    assert result["errors"] == []
    assert result["wrong"] == []
    assert sum(result["states"].values()) == len(kinds) * len(BAD_VALUES)


def test_changed_values_are_kept_when_the_shape_changes(visit: Visit) -> None:
    visit.open()
    visit.fill("radius", "7")
    for kind in ("cone", "flat_punch", "rounded_cone", "paraboloid"):
        with visit.changing():
            visit.page.select_option("#kind", kind)
    assert visit.page.input_value("#field-radius") == "7"
    # A default value is that of its shape.
    visit.open()
    with visit.changing():
        visit.page.select_option("#kind", "flat_punch")
    assert visit.page.input_value("#field-radius") == "1"


def test_either_body_may_be_rigid(visit: Visit) -> None:
    visit.open("?tab=stress")
    with visit.changing():
        visit.page.select_option("#field-material-1", "Rigid")
    assert visit.page.locator("#field-e1").count() == 0
    # A rigid body has no stresses.
    assert visit.page.locator("#field-body").input_value() == "2"
    assert visit.state() == "current"
    visit.page.select_option("#field-material-2", "Rigid")
    visit.page.locator("#problem").get_by_text("at least one body must be elastic").wait_for()
    assert visit.state() == "refused"


def test_phone_shows_the_main_numbers_while_any_slider_moves(visit: Visit) -> None:
    visit.page.set_viewport_size({"width": 390, "height": 844})
    visit.open("?tab=push&kind=rounded_punch")
    numbers = visit.page.locator("#main-numbers")
    assert numbers.locator("dt").all_inner_texts() == [
        "Stick radius c",
        "Tangential displacement u_x",
    ]
    sliders = visit.page.locator("#inputs [type=range]")
    assert sliders.count() == 9
    for slider in sliders.all():
        before = numbers.inner_text()
        slider.scroll_into_view_if_needed()
        with visit.changing():
            slider.evaluate(
                "slider => { slider.value = Number(slider.value) - 0.1 * (slider.max - slider.min);"
                " slider.dispatchEvent(new Event('input')); }"
            )
        assert numbers.inner_text() != before
        box, moved = numbers.bounding_box(), slider.bounding_box()
        assert box is not None
        assert moved is not None
        assert box["y"] >= 0
        assert box["y"] + box["height"] <= moved["y"]
        assert moved["y"] + moved["height"] <= 844


@pytest.mark.parametrize("case", ["tab=stress&shear=ratio&amount=1", "tab=cycle&path=100,0;100,30"])
def test_largest_stress_at_the_surface_is_that_of_full_slip(visit: Visit, case: str) -> None:
    visit.open(f"?{case}&kind=paraboloid&mu=0.3&body=2&up=MPa")
    # Hamilton (1983): at the trailing edge.
    p_0 = (6 * 100 * (2.1e11 / 2 / 0.91) ** 2 / (math.pi**3 * 0.01**2)) ** (1 / 3)
    expected = p_0 * ((1 - 2 * 0.3) / 3 + (4 + 0.3) * math.pi * 0.3 / 8) / 1e6
    shown = visit.number("Largest σ_xx, body 2").split()[0]
    assert float(shown) == pytest.approx(expected, rel=1e-4, abs=0)


def test_stresses_beneath_a_singular_edge_keep_their_colours(visit: Visit) -> None:
    """All but a fiftieth of the points are below the colour of the largest."""
    visit.open("?tab=stress&kind=flat_punch&radius=0.02&e1=rigid&e2=5e6&nu2=0.5&load=500&body=2")
    chart = visit.page.locator("figure", has_text="Von Mises stress").locator(".plot")
    below = "({ data: [{ z, zmax }] }) => z.flat().filter((x) => x < zmax && x > zmax / 20).length"
    many = chart.evaluate("plot => plot.data[0].z.flat().length")
    assert chart.evaluate(below) > 0.9 * many


def test_narrow_worn_annulus_fills_its_chart(visit: Visit) -> None:
    """The chart shows the annulus after these cycles, which differs from the limit (5.90)."""
    amplitude = "&mu=0.6&oscillation=tangential_displacement&amplitude=1e-8"
    visit.open(f"?tab=wear&load=20{amplitude}")
    chart = visit.page.locator("figure", has_text="Worn depth").locator(".plot")
    low, high = chart.evaluate("plot => plot.layout.xaxis.range")
    stick, outer = (
        float(visit.number(label).split()[0]) for label in ("Stick radius c", "Contact radius a")
    )
    width = outer - stick
    assert [low, high] == pytest.approx([stick - width, outer + width], rel=0, abs=2e-2 * width)
    names = chart.locator(".annotation-text").all_text_contents()
    assert names == ["c", "a"]


def test_wear_coefficient_is_a_worn_volume_per_energy(visit: Visit) -> None:
    visit.open("?tab=wear")
    visit.fill("wear", "2e-4")
    assert visit.page.locator(".field[data-key=wear] .unit").inner_text() == "mm³/J"
    assert json.loads(request(visit, "Evolution"))["wear_coefficient"] == 2e-13


def test_energy_per_cycle_is_the_area_of_the_closed_loop(visit: Visit) -> None:
    # Full slip of a flat punch: the area is that of 4 mu F_N by the displacement beyond sticking.
    visit.open("?tab=cycle&kind=flat_punch&mu=0.3&ud=m&uf=N&tangential=tangential_displacement"
               "&path=100,0;100,1e-5;100,-1e-5;100,1e-5")  # fmt: skip
    body = json.loads(request(visit, "History"))
    stiffness = 2 * 1e-3 * 2.1e11 / ((2 - 0.3) * (1 + 0.3))
    assert body["profile"]["radius"] == 1e-3
    area = 4 * 0.3 * 100 * (1e-5 - 0.3 * 100 / stiffness)
    shown = visit.number("Energy per cycle")
    assert shown.endswith(" mJ")
    assert 1e-3 * float(shown.split()[0]) == pytest.approx(area, rel=1e-4, abs=0)
    visit.open("?tab=cycle&path=100,0;100,20")
    assert visit.number("Energy per cycle") == "no closed loop"


def test_several_loops_are_no_cycle(visit: Visit) -> None:
    visit.open("?tab=cycle&path=100,0;100,9;100,-9;100,18;100,-18;100,0")
    labels = visit.page.locator("#numbers dt").all_inner_texts()
    assert labels[0] == "Energy of the loops from point 1"


def hertz_yield(radius: float, modulus: float, ratio: float, strength: float) -> float:
    """Return the force at which a ball yields by von Mises on its axis (Hertz, Huber 1904)."""
    depth = np.linspace(0.2, 1.0, 20_001)
    across = 1 / (1 + depth**2)
    along = (1 + ratio) * (1 - depth * np.arctan(1 / depth)) - across / 2
    pressure = strength / np.abs(across - along).max()
    e_star = modulus / (1 - ratio**2) / 2
    return float(np.pi**3 * radius**2 * pressure**3 / (6 * e_star**2))


def test_strength_follows_the_material(visit: Visit) -> None:
    visit.open("?tab=stress")
    for body in (1, 2):
        with visit.changing():
            visit.page.select_option(f"#field-material-{body}", "Aluminium 6061-T6")
    assert visit.page.get_attribute("#field-yield2", "placeholder") == "276"
    expected = hertz_yield(0.01, 7e10, 0.33, 2.76e8)
    shown = visit.number("Normal force at onset of yield, von Mises").split()
    assert shown[1] == "N"
    assert float(shown[0]) == pytest.approx(expected, rel=1e-3, abs=0)
    # A strength of the user's own goes with its material, too.
    visit.fill("yield2", "500")
    with visit.changing():
        visit.page.select_option("#field-material-1", "Structural steel")
    # The weaker of the two, beside titanium too.
    with visit.changing():
        visit.page.select_option("#field-material-2", "Titanium Ti-6Al-4V")
    assert visit.page.input_value("#field-body") == "1"
    assert visit.page.get_attribute("#field-yield1", "placeholder") == "250"
    # The moduli of no listed material leave the strength open.
    visit.fill("e1", "190,5")
    assert visit.page.input_value("#field-material-1") == "Custom"
    assert visit.page.get_attribute("#field-yield1", "placeholder") == "needed"
    assert visit.number("Normal force at onset of yield, von Mises") == "needs a yield strength"


def test_mass_follows_radius_and_material(visit: Visit) -> None:
    visit.open("?tab=impact")
    visit.fill("radius", "5")
    for density, material in {7850: None, 2700: "Aluminium 6061-T6"}.items():
        if material:
            with visit.changing():
                visit.page.select_option("#field-material-1", material)
        body = json.loads(request(visit, "Impact"))
        mass = 4 / 3 * math.pi * 0.005**3 * density
        assert body["normal_mass"] == pytest.approx(mass, rel=1e-14, abs=0)
        assert body["tangential_mass"] == pytest.approx(2 / 7 * mass, rel=1e-14, abs=0)
    visit.page.select_option("#kind", "cone")
    visit.page.locator(".field[data-key=mass] .problem").get_by_text("is needed").wait_for()
    assert visit.page.get_attribute("#field-mass", "aria-invalid") == "true"


def test_null_is_never_computed_with(visit: Visit) -> None:
    """In full slip wear has no limit: no depth is below zero, and no limit is drawn."""
    visit.open("?tab=wear&oscillation=tangential_displacement&amplitude=1e-5")
    drawn = (
        visit.page.locator(".plot")
        .nth(1)
        .evaluate("plot => plot.data.map(({ name, y }) => [name, Math.min(...y)])")
    )
    assert [name for name, _ in drawn] == ["after these cycles"]
    assert drawn[0][1] >= 0


def test_negative_work_of_adhesion_is_refused_at_its_field(visit: Visit) -> None:
    visit.open()
    visit.page.fill("#field-w", "-5")
    visit.page.locator(".field[data-key=w] .problem:not(:empty)").wait_for()
    assert (
        visit.page.locator("#problem").inner_text().startswith("Invalid request: Work of adhesion")
    )
    assert visit.state() == "refused"


def test_limit_of_wear_is_one_line_in_both_charts(visit: Visit) -> None:
    visit.open("?tab=wear")
    lines = visit.page.evaluate(
        """[...document.querySelectorAll(".plot")].flatMap(({ data }) =>
            data.filter((each) => each.name === "limit").map(({ line }) => line.color + line.dash)
        )"""
    )
    assert len(lines) == 2
    assert lines[0] == lines[1]


def test_own_loads_can_be_typed(visit: Visit) -> None:
    visit.open()
    # Half of a number or unit is none, and can be completed.
    with visit.changing():
        visit.page.locator("#loads").press_sequentially("1e2 5 kN")
    assert "loads=100,5000" in visit.page.url
    visit.page.fill("#loads", "ten")
    assert visit.page.inner_text("#problem-loads") == "“ten”: not a number"
    with visit.changing():
        visit.page.fill("#loads", "10")
    assert visit.state() == "current"


def test_own_loads_give_a_table_of_all_results(visit: Visit, tmp_path: Path) -> None:
    visit.open()
    visit.page.fill("#loads", "1 2 5 10\n20; 50, 0.1 kN\t200 500 1e3 2e3 5 kN")
    forces = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1e3, 2e3, 5e3]
    rows = {}
    for suffix in ("csv", "xlsx"):
        with visit.page.expect_download() as download:
            visit.page.click(f"#own .{suffix}")
        download.value.save_as(tmp_path / suffix)
    rows["csv"] = list(csv.reader((tmp_path / "csv").read_text("utf-8").splitlines()))
    with zipfile.ZipFile(tmp_path / "xlsx") as archive:
        assert archive.testzip() is None
        sheet = archive.read("xl/worksheets/sheet1.xml").decode()
    cell = re.compile("<c[^>]*>(?:<is><t>|<v>)(.*?)<")
    rows["xlsx"] = [cell.findall(row) for row in re.findall("<row>(.*?)</row>", sheet)]
    assert rows["csv"] == rows["xlsx"]
    heading, *cells = rows["csv"]
    e_star = 2.1e11 / (1 - 0.3**2) / 2
    for force, row in zip(forces, cells, strict=True):
        radius = (3 * force * 0.01 / (4 * e_star)) ** (1 / 3)
        expected = {
            "Normal force F_N [N]": force,
            "Contact radius a [mm]": 1e3 * radius,
            "Indentation depth d [µm]": 1e6 * radius**2 / 0.01,
            "Maximum pressure [MPa]": 1.5e-6 * force / (math.pi * radius**2),
        }
        for name, value in expected.items():
            assert float(row[heading.index(name)]) == pytest.approx(value, rel=1e-12, abs=0)
    # The list belongs to the link, and its results to this case alone.
    assert "loads=1,2,5,10,20,50,100,200,500,1000,2000,5000" in visit.page.url
    assert visit.page.locator("#own table").count() == 1
    visit.fill("radius", "7")
    assert visit.page.locator("#own table").count() == 0


def test_tabs_are_steps_of_the_history(visit: Visit) -> None:
    visit.open("?tab=press&load=50")
    with visit.changing():
        visit.page.click("#tab-push")
    visit.page.go_back()
    visit.drawn()
    assert visit.page.get_attribute("#tab-press", "aria-selected") == "true"
    assert visit.number("Normal force F_N") == "50 N"


@pytest.mark.parametrize("tab", TABS)
def test_no_text_of_a_chart_is_cut(visit: Visit, tab: str) -> None:
    # The example of a table is shorter than the example of a curve needs, which is refused.
    tables = () if tab == "fit" else ("tabulated",)
    for width in (390, 1280):
        visit.page.set_viewport_size({"width": width, "height": 900})
        for kind in ("paraboloid", "flat_punch", "cone", *tables):
            visit.open(f"?tab={tab}&kind={kind}&mass=0.03")
            assert titles_outside(visit.page) == [], (width, kind)
            assert values_outside(visit.page) == [], (width, kind)


def request(visit: Visit, name: str) -> str:
    """Return the JSON of a request that the page has made."""
    visit.page.select_option("#language", "JSON")
    visit.page.select_option("#request", name)
    return visit.page.locator("#code").inner_text()


def test_copy_works_without_a_clipboard_and_says_so(visit: Visit) -> None:
    visit.open()
    visit.page.evaluate("Object.defineProperty(navigator, 'clipboard', { value: undefined })")
    visit.page.click("#copy")
    visit.page.locator("#copied").get_by_text("Copied.").wait_for()
    visit.page.evaluate("document.execCommand = () => false")
    visit.page.click("#copy")
    visit.page.locator("#copied").get_by_text("Selected: press Ctrl+C to copy.").wait_for()
    assert visit.page.evaluate("getSelection().toString()").startswith("curl -s http")


def test_load_path_points_are_keyboard_accessible(visit: Visit) -> None:
    visit.open("?tab=cycle&path=100,0;100,20")
    before = visit.number("Tangential force F_x")
    visit.page.locator("#editor circle").nth(1).focus()
    with visit.changing():
        visit.page.keyboard.press("ArrowLeft")
        visit.page.keyboard.press("ArrowLeft")
    assert before == "20 N"
    assert float(visit.number("Tangential force F_x").split()[0]) == pytest.approx(
        19, rel=1e-12, abs=0
    )
    visit.page.get_by_role("button", name="Remove point 2").click()
    visit.page.wait_for_url("**path=100,0*")


def test_error_of_a_load_path_names_it_and_the_point(visit: Visit) -> None:
    visit.page.goto(f"{visit.address}?tab=cycle&path=100,0;100,40")
    assert visit.state() == "refused"
    problem = visit.page.inner_text("#problem")
    assert problem.startswith("Invalid request: Load path: point 2: no equilibrium")


def test_load_path_is_typed_from_field_to_field(visit: Visit) -> None:
    visit.open("?tab=cycle&path=100,0;100,20")
    visit.page.locator("#editor input").nth(2).select_text()
    for text in ("0.2 kN", "x"):
        visit.page.keyboard.type(text)
        visit.page.keyboard.press("Tab")
    assert visit.page.inner_text("#problem-path") == "Point 2: not a number"
    visit.page.keyboard.press("Shift+Tab")
    with visit.changing():
        visit.page.keyboard.type("-20")
        visit.page.keyboard.press("Tab")
    visit.page.keyboard.press("Shift+Tab")
    visit.page.keyboard.type("-30")
    # A click that ends the entry of a number acts, too.
    with visit.changing():
        visit.page.get_by_role("button", name="Add a point after point 2").click()
    assert "path=100,0;200,-30;200,-30" in visit.page.url
    assert visit.page.inner_text("#problem-path") == ""
    assert visit.page.locator("#editor [aria-invalid]").count() == 0


def test_page_contents_can_be_downloaded(visit: Visit, tmp_path: Path) -> None:
    visit.open()
    starts = {"PNG": b"\x89PNG", "SVG": b"<svg"}
    for name, start in starts.items():
        with visit.page.expect_download() as download:
            visit.page.get_by_role("button", name=re.compile(f"^{name} of")).first.click()
        download.value.save_as(tmp_path / name)
        assert (tmp_path / name).read_bytes().startswith(start)
    first_columns = {
        "Response as CSV": '"indentation_depth [µm]","normal_force [N]",',
        "CSV of “Pressure”": '"Radius r [mm]","pressure [MPa]"\n0,1370.8',
        "CSV of “Force against depth”": (
            '"Indentation depth d [µm]","Normal force F_N [N]",'
            '"Indentation depth d [µm]","this load [N]"\n0,0,3.482'
        ),
    }
    for name, first in first_columns.items():
        with visit.page.expect_download() as download:
            visit.page.get_by_role("button", name=name).click()
        download.value.save_as(tmp_path / "table.csv")
        assert (tmp_path / "table.csv").read_text("utf-8").startswith(first)
    visit.page.select_option("#language", "JSON")
    visit.page.get_by_role("button", name="Request of “Pressure”").click()
    assert json.loads(visit.page.locator("#code").inner_text())["quantities"] == ["pressure"]
    visit.page.get_by_role("button", name="Request of “Force against depth”").click()
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


def titles_outside(page: Page) -> list[str]:
    """Return the texts of the charts that reach beyond their chart."""
    outside: list[str] = page.evaluate(
        """[...document.querySelectorAll(".plot")].flatMap((plot) => {
            const box = plot.getBoundingClientRect();
            return [...plot.querySelectorAll("text")].filter((text) => {
                const { left, right, top, bottom } = text.getBoundingClientRect();
                return right > left && (left < box.left - 1 || right > box.right + 1
                    || top < box.top - 1 || bottom > box.bottom + 1);
            }).map(({ textContent }) => textContent);
        })"""
    )
    return outside


def values_outside(page: Page) -> list[str]:
    """Return the titles of the charts that cut a value without a note of its peak."""
    outside: list[str] = page.evaluate(
        """[...document.querySelectorAll(".plot")].filter((plot) => {
            const { xaxis, yaxis, annotations = [] } = plot._fullLayout;
            if (annotations.some(({ text }) => /peak|∞/.test(text))) return false;
            const inside = ({ range, type }, value) => {
                const at = type === "log" ? Math.log10(value) : value;
                const [low, high] = [Math.min(...range), Math.max(...range)];
                const margin = 1e-9 * (high - low);
                return at >= low - margin && at <= high + margin;
            };
            return plot.data.filter(({ z }) => !z).some(({ x, y }) => [...x].some((at, i) =>
                Number.isFinite(y[i]) && inside(xaxis, at) && !inside(yaxis, y[i])));
        }).map((plot) => plot.getAttribute("aria-label"))"""
    )
    return outside


@pytest.mark.parametrize("tab", TABS)
def test_case_is_printed_as_a_report(visit: Visit, tab: str) -> None:
    visit.page.emulate_media(color_scheme="dark")
    # A cone has more warnings.
    for kind in ("cone", "paraboloid"):
        visit.open(f"?tab={tab}&kind={kind}" + ("&mass=0.03" if tab == "impact" else ""))
        sheets = re.findall(rb"/Type\s*/Page\b", visit.page.pdf(prefer_css_page_size=True))
        assert len(sheets) <= 2, kind
    visit.page.set_viewport_size({"width": 720, "height": 1100})
    shown = visit.page.locator("#numbers dd").all_text_contents()
    assert len(shown) > 3
    visit.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    report = visit.page.locator("#report").inner_text()
    assert report.startswith(f"{tab.capitalize()}: ")
    assert f"MDR {version('mdr-contact')}" in report
    assert "Radius of curvature at the tip\t10 mm" in report
    for entry in shown:
        assert f"\t{entry}" in report
    link = visit.page.locator("#link").inner_text()
    assert link.startswith(f"{visit.address}?tab={tab}&kind=paraboloid")
    if tab == "fit":
        assert "Measured curve (d [µm], F [mN]): -20, 0; " in visit.page.inner_text("#data")
    assert titles_outside(visit.page) == []
    assert visit.page.locator("form, #take-away").nth(0).is_hidden()
    plot = visit.page.locator("figure .main-svg").first
    assert plot.evaluate("plot => plot.clientWidth <= plot.closest('figure').clientWidth")
    visit.page.evaluate("dispatchEvent(new Event('afterprint'))")
    visit.page.locator("#inputs").wait_for()


def test_report_holds_the_table_of_own_loads(visit: Visit) -> None:
    visit.open("?kind=paraboloid&radius=0.01&ul=mm&loads=10,20,50")
    visit.page.evaluate("(window.print = () => dispatchEvent(new Event('beforeprint')), 0)")
    visit.page.click("#print")
    printed = visit.page.locator("#loads-printed")
    printed.locator("tbody tr").nth(2).wait_for()
    heading = printed.locator("th").all_inner_texts()
    at = heading.index("Contact radius a [mm]")
    e_star = 2.1e11 / 0.91 / 2
    for row, force in zip(printed.locator("tbody tr").all(), (10, 20, 50), strict=True):
        shown = row.locator("td").all_inner_texts()
        radius = 1e3 * (0.75 * force * 0.01 / e_star) ** (1 / 3)
        assert shown[0] == str(force)
        assert float(shown[at]) == pytest.approx(radius, rel=1e-4, abs=0)
    assert printed.evaluate("all => all.scrollWidth <= all.clientWidth")
    visit.page.evaluate("dispatchEvent(new Event('afterprint'))")
    # The table of another case is not in the report.
    visit.fill("radius", "7")
    visit.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert printed.locator("table").count() == 0


def test_url_restores_the_case_with_identical_requests(visit: Visit) -> None:
    visit.open()
    results: list[dict[str, Any]] = visit.page.evaluate(script("round_trip.js"), SCENES)
    assert [each["url"] for each in results if each["first"] != each["second"]] == []
    assert all(each["first"] for each in results)
    solved = sum(each["solved"] for each in results)
    assert solved >= 0.8 * SCENES


def test_forged_addresses_cause_no_error_and_no_markup(visit: Visit) -> None:
    visit.open()
    result = visit.page.evaluate(script("forged_addresses.js"), list(forged(ADDRESSES, seed=1)))
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
