"""A picture shows the numbers, names and units of the response."""

import json
import re
import struct
from itertools import combinations
from pathlib import Path
from typing import Any, get_args
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.text import Text

from mdr_core.errors import InputError
from mdr_service.dispatch import respond
from mdr_service.queries import QUERIES
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.schemas.fields import FieldName
from mdr_service.schemas.subsurface import SubsurfaceName
from mdr_service.schemas.wear import WearField
from mdr_service.serializers.panels import Units
from mdr_service.serializers.picture import Appearance
from tests.conftest import Client

CASES = {
    f"{name} {key}": (name, example["value"])
    for name in QUERIES
    for key, example in EXAMPLES[name].items()
}
BALL = EXAMPLES["normal"]["hertz"]["value"]
TANGENTIAL = EXAMPLES["tangential"]["cattaneo_mindlin"]["value"]
STRESS = EXAMPLES["stress"]["cattaneo_mindlin"]["value"]
PUNCH = EXAMPLES["stress"]["boussinesq"]["value"]
CONE = EXAMPLES["stress"]["sneddon"]["value"]
MAP = EXAMPLES["subsurface"]["partial_slip"]["value"]
WEAR = EXAMPLES["wear"]["amplitudes"]["value"]
EVOLUTION = EXAMPLES["evolution"]["held_forces"]["value"]
HISTORY = EXAMPLES["history"]["mindlin_deresiewicz"]["value"]
# The usual size, the smallest, and a column of a paper.
SIZES = [None, (50, 50), (90, 60)]
MILLIMETRES = Units("mm", "N", "MPa")


def drawn(
    name: str,
    query: dict[str, Any],
    monkeypatch: pytest.MonkeyPatch,
    appearance: Appearance = Appearance(),  # noqa: B008 -- immutable
) -> Figure:
    """Return the figure that the response to a query contains."""
    figures: list[Figure] = []

    def keep(figure: Figure, *_: object, **__: object) -> None:
        # Extents of texts, with the style of the picture.
        figure.draw_without_rendering()
        figures.append(figure)

    with monkeypatch.context() as context:
        context.setattr(Figure, "savefig", keep)
        respond(name, json.dumps(query).encode(), "image/svg+xml", appearance=appearance)
    (figure,) = figures
    return figure


def answer(name: str, query: dict[str, Any]) -> dict[str, Any]:
    """Return the numbers of a response; null is infinite."""
    text = respond(name, json.dumps(query).encode(), "application/json")
    found: dict[str, Any] = json.loads(text)
    return found


def panels(figure: Figure) -> list[Axes]:
    """Return the axes that are not a colour bar."""
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def curves(axes: Axes) -> list[np.ndarray[Any, Any]]:
    """Return the points [n][2] of the curves, with their gaps, without lines across the axes."""
    lines = [line for line in axes.lines if line.get_transform() == axes.transData]
    return [np.array(line.get_xydata()) for line in lines if line.get_linewidth() > 0]


def points(axes: Axes) -> set[tuple[float, float]]:
    """Return all points of the curves."""
    found = [each[np.isfinite(each).all(axis=1)] for each in curves(axes)]
    return {(x, y) for each in found for x, y in each.tolist()}


def names(figure: Figure) -> list[str]:
    """Return the names in the legend."""
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def title(figure: Figure) -> str:
    return "".join(each.get_title().get_text() for each in figure.legends)


def rows(values: Any) -> np.ndarray[Any, Any]:
    """Return an array, infinite where the response has null."""
    return np.array(values, dtype=float)


# Abscissa and ordinates of results over the loads.
DRAWN = {
    "normal": ("indentation_depth", "normal_force"),
    "fit": ("indentation_depth", "normal_force", "residual"),
    "tangential_fit": ("tangential_displacement", "tangential_force", "residual"),
    "impact": ("tangential_velocity", "tangential_rebound_velocity", "dissipated_energy"),
    "torsion": ("rotation", "torque"),
    "wear": ("stick_radius", "worn_volume", "wear_radius"),
}


@pytest.mark.parametrize(("name", "query"), CASES.values(), ids=CASES)
def test_points_are_the_numbers_of_the_response(
    name: str, query: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = answer(name, query)
    axes = panels(drawn(name, query, monkeypatch))
    if "radius" in found:
        fields = [each for each in query.get("quantities", found) if np.ndim(found.get(each)) == 2]
        expected = [
            {(r, v) for row in found[each] for r, v in zip(found["radius"], row, strict=True)}
            for each in fields
        ]
        if "initial_profile" in found:
            initial = zip(found["radius"], found["initial_profile"], strict=True)
            expected[fields.index("limiting_profile")] |= set(initial)
    elif "x" in found:
        fields = [each for each, values in found.items() if np.ndim(values) == 3]
        x, z = found["x"], found["z"]
        if len(x) == 1:
            expected = [{(z[i], row[0]) for i, row in enumerate(found[each][0])} for each in fields]
        else:
            expected = []
            for each, values in zip(axes, fields, strict=True):
                (cells,) = each.collections
                assert isinstance(cells, QuadMesh)
                assert np.array_equal(cells.get_array(), found[values][0])
                # The position of each value lies in its cell.
                corners = cells.get_coordinates()
                assert np.all((corners[0, :-1, 0] <= x) & (x <= corners[0, 1:, 0]))
                assert np.all((corners[:-1, 0, 1] <= z) & (z <= corners[1:, 0, 1]))
                expected.append(set())
    else:
        x, *ordinates = DRAWN.get(name, ("tangential_displacement", "tangential_force"))
        expected = [set(zip(found[x], found[y], strict=True)) for y in ordinates]
        if name in {"fit", "tangential_fit"}:
            given = query[ordinates[0]]
            measured = np.add(found[ordinates[0]], found["residual"]).tolist()
            assert measured == pytest.approx(given, rel=1e-12, abs=1e-12 * max(given))
            expected[0] |= set(zip(found[x], measured, strict=True))
    assert len(axes) == len(expected)
    for each, values in zip(axes, expected, strict=True):
        assert points(each) == {point for point in values if None not in point}


@pytest.mark.parametrize(
    ("name", "query", "quantities"),
    [
        ("stress", STRESS, get_args(FieldName)),
        ("subsurface", MAP, get_args(SubsurfaceName)),
        ("wear", WEAR | {"points": 50}, get_args(WearField)),
    ],
)
def test_every_quantity_has_a_label_with_its_unit(
    name: str, query: dict[str, Any], quantities: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    model = QUERIES[name].response.model_json_schema()["properties"]
    units = {"length": "mm", "pressure": "MPa", "force/length": "N/mm"}
    request = query | {"quantities": list(quantities)}
    figure = drawn(name, request, monkeypatch, Appearance(units=MILLIMETRES))
    labels = [axes.get_ylabel() for axes in figure.axes]
    if name == "subsurface":
        labels = labels[len(quantities) :]
    drawn_over = [each for each in quantities if each != "initial_profile"]
    assert len(labels) == len(drawn_over)
    for quantity, label in zip(drawn_over, labels, strict=True):
        assert label.endswith(f"{units[model[quantity]['x-dimension']]})")


def test_few_points_are_marks_and_many_a_line(monkeypatch: pytest.MonkeyPatch) -> None:
    for count in (29, 30):
        load = {"load": {"normal_force": np.linspace(1.0, 10.0, count).tolist()}}
        (axes,) = panels(drawn("normal", BALL | load, monkeypatch))
        line = axes.lines[0]
        assert (line.get_linestyle() == "None", line.get_marker() == "o") == (count < 30,) * 2


def test_measured_points_are_marks_beside_the_fitted_line(monkeypatch: pytest.MonkeyPatch) -> None:
    query = next(iter(EXAMPLES["fit"].values()))["value"]
    force, residual = panels(figure := drawn("fit", query, monkeypatch))
    measured, fitted = force.lines[:2]
    assert (measured.get_linestyle(), measured.get_marker()) == ("None", ".")
    assert (fitted.get_linestyle(), fitted.get_marker()) == ("-", "None")
    assert residual.lines[0].get_marker() == "."
    assert names(figure) == ["measured", "fitted"]


def test_points_are_joined_in_the_order_of_the_abscissa(monkeypatch: pytest.MonkeyPatch) -> None:
    radius = np.random.default_rng(1).permutation(np.linspace(0.0, 9e-5, 40)).tolist()
    request = STRESS | {"radius": radius, "quantities": ["slip"]}
    (axes,) = panels(drawn("stress", request, monkeypatch))
    (curve,) = curves(axes)
    assert np.all(np.diff(curve[:, 0]) > 0)
    forces = [3.0, 1.0, 2.0] * 20
    load = {"load": {"normal_force": forces}}
    (axes,) = panels(drawn("normal", BALL | load, monkeypatch))
    (curve,) = curves(axes)
    assert np.all(np.diff(curve[:, 0]) >= 0)


@pytest.mark.parametrize(
    ("query", "place"), [(PUNCH, PUNCH["profile"]["radius"]), (CONE, 0.0)], ids=["punch", "cone"]
)
def test_curve_is_cut_where_it_is_infinite(
    query: dict[str, Any], place: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    load = (
        {"load": {"normal_force": 1.0}} if query is PUNCH else {"load": {"contact_radius": 0.001}}
    )
    radii = {name: value for name, value in query.items() if name != "radius"}
    request = radii | load | {"points": 200, "quantities": ["pressure"]}
    figure = drawn("stress", request, monkeypatch)
    (axes,) = panels(figure)
    (curve,) = curves(axes)
    assert np.isnan(curve[curve[:, 0] == place, 1]).all()
    (line,) = (each for each in axes.lines if each.get_label() == "∞")
    assert line.get_xdata() == [place, place]
    assert names(figure) == ["∞"]
    # The limits show the mean pressure and several times as much, not the values beside infinity.
    mean = answer("normal", {k: request[k] for k in ("profile", "material", "load")})
    assert mean["mean_pressure"][0] < axes.get_ylim()[1] < 10 * mean["mean_pressure"][0]
    assert axes.get_ylim()[1] < np.nanmax(curve[:, 1])


@pytest.mark.parametrize("query", [CONE, CONE | {"radius": [0.0, 10.0]}], ids=["", "beside zero"])
def test_a_single_infinite_value_is_in_sight(
    query: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    figure = drawn("stress", query, monkeypatch)
    assert panels(figure)[0].get_xlim()[0] <= 0.0
    assert "∞" in names(figure)


def test_curves_have_names_and_six_of_more_loads_are_drawn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for count in (2, 6, 7, 1000):
        forces = np.linspace(8.0, 10.0, count).tolist()
        request = STRESS | {"load": {"normal_force": forces}}
        figure = drawn("stress", request, monkeypatch, Appearance(units=MILLIMETRES))
        # The panels share a legend.
        loads = names(figure)
        assert len(loads) == min(count, 6)
        assert (loads[0], loads[-1]) == ("normal force = 8 N", "normal force = 10 N")
        assert title(figure) == (f"6 of {count} loads" if count > 6 else "")
        colors = [str(line.get_color()) for line in panels(figure)[0].lines[:count]]
        assert len(set(colors[:6])) == min(count, 6)
        assert all(len(curves(axes)) == min(count, 6) for axes in panels(figure))


def test_curves_are_named_by_the_load_that_varies_most(monkeypatch: pytest.MonkeyPatch) -> None:
    loads = {"load": {"normal_force": [5.0, 10.0, 10.0]}}
    loads["tangential"] = {"tangential_force": [1.0, 2.0, 3.0]}
    figure = drawn("stress", STRESS | loads, monkeypatch, Appearance(units=MILLIMETRES))
    assert names(figure) == [f"tangential force = {force} N" for force in (1, 2, 3)]
    # The pressure does not depend on the tangential force.
    loads["load"] = {"normal_force": [10.0] * 3}
    figure = drawn("stress", STRESS | loads, monkeypatch)
    assert names(figure) == ["all loads", *(f"tangential force = {force}" for force in (1, 2, 3))]
    assert [len(curves(axes)) for axes in panels(figure)] == [1, 3, 3]


def test_tangential_loads_of_each_normal_force_are_a_curve(monkeypatch: pytest.MonkeyPatch) -> None:
    change = {
        "load": {"normal_force": [10.0, 20.0] * 3},
        "tangential": {"tangential_force": [1.0, 1.0, 2.0, 4.0, 0.0, 0.0]},
    }
    figure = drawn("tangential", TANGENTIAL | change, monkeypatch)
    assert names(figure) == ["normal force = 10", "normal force = 20"]
    (axes,) = panels(figure)
    assert [each[:, 1].tolist() for each in curves(axes)] == [[0.0, 1.0, 2.0], [0.0, 1.0, 4.0]]


def test_samples_of_a_history_follow_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    cycles = HISTORY["cycles"] | {"count": 1, "samples_per_step": 40}
    (axes,) = panels(drawn("history", HISTORY | {"cycles": cycles}, monkeypatch))
    found = answer("history", HISTORY | {"cycles": cycles})
    (curve,) = curves(axes)
    assert curve[:, 0].tolist() == found["tangential_displacement"]
    assert curve[:, 1].tolist() == found["tangential_force"]


def test_wear_shows_the_initial_profile(monkeypatch: pytest.MonkeyPatch) -> None:
    figure = drawn("wear", WEAR | {"points": 100}, monkeypatch)
    (axes,) = panels(figure)
    *limiting, initial = curves(axes)
    assert len(limiting) == 4
    assert initial[:, 1] == pytest.approx(initial[:, 0] ** 2 / 0.02, rel=1e-12, abs=0)
    assert names(figure)[-1] == "initial"
    assert axes.lines[4].get_linestyle() == "--"


def test_unbounded_wear_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    request = WEAR | {"oscillation": {"tangential_force": [2.0, 3.0]}, "points": 50}
    assert names(drawn("wear", request, monkeypatch)) == [
        "tangential force = 2",
        "tangential force = 3 (∞)",
        "initial",
    ]


def test_wear_without_radii_is_drawn_over_the_cycles(monkeypatch: pytest.MonkeyPatch) -> None:
    request = {name: value for name, value in EVOLUTION.items() if name != "points"}
    volume, _ = panels(drawn("evolution", request, monkeypatch))
    found = answer("evolution", request)
    assert points(volume) == set(zip(found["cycles"], found["worn_volume"], strict=True))


def test_maps_share_the_depth(monkeypatch: pytest.MonkeyPatch) -> None:
    request = MAP | {"points": 30, "quantities": ["stress_xx", "von_mises"]}
    request["load"] = {"normal_force": [500.0, 600.0]}
    figure = drawn("subsurface", request, monkeypatch, Appearance(units=MILLIMETRES))
    first, second = panels(figure)
    assert first.bbox.height == pytest.approx(second.bbox.height, rel=1e-9, abs=0)
    assert first.get_ylim() == second.get_ylim()
    # The depth increases downwards, in the scale of x.
    low, high = first.get_ylim()
    assert low > high == 0.0
    assert first.get_aspect() == 1.0
    assert title(figure) == "normal force = 500 N (1 of 2 loads)"


def test_infinite_stresses_do_not_hide_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    request = {
        "profile": {"kind": "flat_punch", "radius": 1.0},
        "material": {"e_star": 1.0, "poissons_ratio": 0.3},
        "load": {"normal_force": 1.0},
        "x": np.linspace(-2.0, 2.0, 41).tolist(),
        "z": np.linspace(0.0, 2.0, 21).tolist(),
    }
    figure = drawn("subsurface", request, monkeypatch)
    (axes,) = panels(figure)
    values = rows(answer("subsurface", request)["von_mises"][0])
    assert np.isnan(values).any()
    low, high = axes.collections[0].get_clim()
    shown = (values < high) & (values > high / 10)
    assert low == 0.0
    assert shown.mean() > 0.3


@pytest.mark.every(5)
@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize(("name", "query"), CASES.values(), ids=CASES)
def test_texts_do_not_collide(
    name: str,
    query: dict[str, Any],
    size: tuple[int, int] | None,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    try:
        figure = drawn(name, query, monkeypatch, Appearance(size, MILLIMETRES))
    except InputError as error:
        # Several panels need a larger picture.
        width, height = re.findall(r"(\d+)x(\d+) mm", error.detail)[0]
        larger = Appearance((int(width), int(height)), MILLIMETRES)
        figure = drawn(name, query, monkeypatch, larger)
    boxes = [(text.get_text(), Text.get_window_extent(text)) for text in visible(figure)]
    for text, box in boxes:
        assert box.x0 > -1 < box.y0, text
        assert box.x1 < figure.bbox.x1 + 1, text
        assert box.y1 < figure.bbox.y1 + 1, text
    for (one, first), (other, second) in combinations(boxes, 2):
        width = min(first.x1, second.x1) - max(first.x0, second.x0)
        height = min(first.y1, second.y1) - max(first.y0, second.y0)
        assert min(width, height) < 2, (one, other)
    assert capfd.readouterr() == ("", "")


def visible(figure: Figure) -> list[Text]:
    """Return all texts of a figure that are drawn."""
    found = [text for each in figure.legends for text in (*each.get_texts(), each.get_title())]
    for axes in figure.axes:
        found += [*axes.texts, axes.title]
        for axis, limits in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
            found += [axis.label, axis.get_offset_text()]
            ticks = axis.get_major_ticks()
            ticks = [t for t in ticks if min(limits) <= t.get_loc() <= max(limits)]
            found += [label for tick in ticks for label in (tick.label1, tick.label2)]
    return [text for text in found if text.get_visible() and text.get_text().strip()]


def test_labels_name_units_that_are_given(monkeypatch: pytest.MonkeyPatch) -> None:
    query = {name: value for name, value in STRESS.items() if name != "radius"} | {"points": 50}
    query["quantities"] = ["pressure", "shear_stress", "foundation_load"]
    for units, expected in (
        (
            None,
            [
                "Pressure p",
                "Shear stress τ",
                "Load q of the equivalent\nfoundation at x = r",
                "Radius r",
            ],
        ),
        (
            Units("µm", "mN", "GPa"),
            [
                "Pressure p\n(GPa)",
                "Shear stress τ\n(GPa)",
                "Load q of the equivalent\nfoundation at x = r\n(mN/µm)",
                "Radius r\n(µm)",
            ],
        ),
    ):
        axes = panels(drawn("stress", query, monkeypatch, Appearance(units=units)))
        assert [*(each.get_ylabel() for each in axes), axes[-1].get_xlabel()] == expected


def test_units_of_products_are_derived(monkeypatch: pytest.MonkeyPatch) -> None:
    axes = panels(drawn("wear", WEAR, monkeypatch, Appearance(units=MILLIMETRES)))
    assert axes[0].get_ylabel() == "Worn volume V\n(mm³)"


def words(svg: bytes) -> str:
    """Return the text of an SVG picture without white space."""
    return "".join("".join(ET.fromstring(svg).itertext()).split())  # noqa: S314 -- our own


def test_svg_text_is_text() -> None:
    text = words(respond("normal", json.dumps(BALL).encode(), "image/svg+xml"))
    assert "NormalforceF_N" in text
    assert "Indentationdepthd" in text


PARAMETERS = {"kind": "paraboloid", "radius": "0.01", "e_star": "1e11", "normal_force": "10"}
GET = "/v1/normal?kind=paraboloid&radius=0.01&e_star=1e11&normal_force=10"


def test_picture_has_the_requested_size(client: Client) -> None:
    post = client.request("POST", "/v1/normal?format=png&size=90x60", json=BALL)
    for response in (post, client.get(f"{GET}&format=png&size=90x60")):
        # Width and height in the header of a PNG.
        pixels = struct.unpack(">II", response.content[16:24])
        assert pixels == pytest.approx([90 / 25.4 * 150, 60 / 25.4 * 150], abs=1)
    assert 'width="510.236' in client.get(f"{GET}&format=svg&size=180x60").text


@pytest.mark.parametrize("size", ["49x60", "90x401", "90", "90.5x60", "x", ""])
def test_invalid_size_is_rejected(client: Client, size: str) -> None:
    for response in (
        client.request("POST", f"/v1/normal?format=svg&size={size}", json=BALL),
        client.get(f"{GET}&format=svg&size={size}"),
        client.get(f"{GET}&size=90x60"),
    ):
        assert response.status_code == 422
        assert response.json()["errors"][0]["pointer"] == "/size"


def test_panels_need_height(client: Client) -> None:
    response = client.request("POST", "/v1/stress?format=svg&size=90x60", json=STRESS)
    assert response.status_code == 422
    (error,) = response.json()["errors"]
    assert error["pointer"] == "/size"
    assert "3 panels need at least 90x80 mm" in error["detail"]
    fits = client.request("POST", "/v1/stress?format=svg&size=90x80", json=STRESS)
    assert fits.status_code == 200


def test_picture_names_the_requested_units(client: Client) -> None:
    for units in ("mm,N,MPa", "µm, mN, kN/m²"):
        parameters = {"format": "svg", "units": units}
        path, force = "/v1/normal", units.split(",")[1].strip()
        post = client.request("POST", path, params=parameters, json=BALL)
        get = client.request("GET", path, params=parameters | PARAMETERS)
        for response in (post, get):
            assert response.status_code == 200
            assert f"({force})" in words(response.content)


def test_request_of_the_manual_names_its_units(client: Client) -> None:
    page = (Path(__file__).parents[2] / "docs" / "http.md").read_text("utf-8")
    (path,) = re.findall(r"```http\nGET (\S*units=mm,N,MPa\S*)\n```", page)
    response = client.get(path)
    assert response.status_code == 200
    assert "mm" in words(response.content)


@pytest.mark.parametrize(
    "units",
    [
        "mm",
        "mm,N",
        "mm,N,MPa,s",
        "mm,,MPa",
        "",
        "mm,N,$x$",
        "mm,N,<b>",
        "mm,N,thirteen_char",
        "㎜,N,a",
    ],
)
def test_invalid_units_are_rejected(client: Client, units: str) -> None:
    post = client.request("POST", "/v1/normal", params={"format": "svg", "units": units}, json=BALL)
    for response in (
        post,
        client.request("GET", "/v1/normal", params={**PARAMETERS, "format": "svg", "units": units}),
    ):
        assert response.status_code == 422
        (error,) = response.json()["errors"]
        assert error["pointer"] == "/units"
        assert "mm,N,MPa" in error["detail"]
    (error,) = client.get(f"{GET}&units=mm,N,MPa").json()["errors"]
    assert (error["pointer"], "pictures only" in error["detail"]) == ("/units", True)
