"""Content of the plots: curves, points, limits, markers, labels and legends."""

import json
import struct
from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mdr_service.plots import PLOTS, Map, Plot
from mdr_service.queries import QUERIES
from mdr_service.schemas.examples import EXAMPLES
from mdr_service.schemas.queries import SCHEMAS
from mdr_service.serializers import picture
from tests.conftest import Client

CASES = [
    (name, example["value"])
    for name in QUERIES
    # A map has no curves.
    if name != "subsurface"
    for example in EXAMPLES[name].values()
]
BALL = EXAMPLES["normal"]["hertz"]["value"]
TANGENTIAL = EXAMPLES["tangential"]["cattaneo_mindlin"]["value"]
STRESS = EXAMPLES["stress"]["cattaneo_mindlin"]["value"]
PUNCH = EXAMPLES["stress"]["boussinesq"]["value"]
WEAR = EXAMPLES["wear"]["amplitudes"]["value"]
EVOLUTION = EXAMPLES["evolution"]["held_forces"]["value"]
HISTORY = EXAMPLES["history"]["mindlin_deresiewicz"]["value"]


def plotted(name: str, value: Mapping[str, Any]) -> tuple[Any, dict[str, Any]]:
    """Return the plot and the result of a query."""
    kind = QUERIES[name]
    query = SCHEMAS[name].model.model_validate_json(json.dumps(value).encode())
    with np.errstate(all="ignore"):
        source = kind.solve(query)
        result = kind.result(query, source)
        return PLOTS[name](query, source, result), result


def drawn(plot: Plot | Map, monkeypatch: pytest.MonkeyPatch) -> list[Axes]:
    """Return the axes that the serializer draws."""
    figures: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: figures.append(figure))
    picture.write(plot, "svg")
    (figure,) = figures
    return figure.axes


def points(plot: Plot, panel: int = 0) -> list[tuple[float, float]]:
    curves = plot.panels[panel].curves
    return [(x, y) for c in curves for x, y in zip(c.point_x, c.point_y, strict=True)]


def labels(plot: Plot, panel: int = 0) -> list[str]:
    return [curve.label for curve in plot.panels[panel].curves]


@pytest.mark.parametrize("value", [example["value"] for example in EXAMPLES["subsurface"].values()])
def test_stress_map_marks_the_contact_and_its_maximum(
    value: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    plot, result = plotted("subsurface", value)
    assert isinstance(plot, Map)
    axis = plot.x.size // 2
    assert plot.x[axis] == 0
    if "largest" in result:
        largest = result["largest"]["von_mises"]
        assert plot.peak == (largest["x"][0], largest["z"][0])
    left, right = drawn(plot, monkeypatch)[:2]
    marks = {line.get_label(): line for line in left.lines}
    assert np.array_equal(marks["contact"].get_xdata(), [-plot.contact, plot.contact])
    assert ("stick" in marks) == ("tangential" in value)
    assert (marks["maximum"].get_xdata()[0], marks["maximum"].get_ydata()[0]) == plot.peak
    assert np.array_equal(right.lines[0].get_ydata(), plot.z)
    # The depth increases downwards.
    low, high = left.get_ylim()
    assert low > high


@pytest.mark.parametrize(("name", "value"), CASES)
def test_every_point_lies_on_its_curve(name: str, value: dict[str, Any]) -> None:
    plot, _ = plotted(name, value)
    for panel in plot.panels:
        for curve in panel.curves:
            finite = np.isfinite(curve.y)
            if not finite.any():
                continue
            steps = np.hypot(
                np.diff(curve.x[finite]) / (np.ptp(curve.x) or 1.0),
                np.diff(curve.y[finite]) / (np.ptp(curve.y[finite]) or 1.0),
            )
            # The samples are dense: chords are short except at a jump or at a maximum that is
            # infinite.
            assert np.median(steps) < 0.01
            for x, y in zip(curve.point_x, curve.point_y, strict=True):
                if np.isfinite(y):
                    away = np.hypot(
                        (curve.x[finite] - x) / (np.ptp(curve.x) or 1.0),
                        (curve.y[finite] - y) / (np.ptp(curve.y[finite]) or 1.0),
                    )
                    assert away.min() < 0.03


@pytest.mark.parametrize(("name", "value"), CASES)
def test_svg_draws_the_plot(
    name: str, value: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    plot, _ = plotted(name, value)
    axes = drawn(plot, monkeypatch)
    assert [each.get_ylabel() for each in axes] == [panel.y_label for panel in plot.panels]
    assert axes[-1].get_xlabel() == f"{plot.x_label}   (in the units of the request)"
    for each, panel in zip(axes, plot.panels, strict=True):
        if panel.y_limits:
            assert each.get_ylim() == pytest.approx(panel.y_limits, rel=1e-12, abs=0)
        if plot.x_limits:
            assert each.get_xlim() == pytest.approx(plot.x_limits, rel=1e-12, abs=0)
        lines = [(line.get_xdata(), line.get_ydata(), line.get_marker()) for line in each.lines]
        for curve in panel.curves:
            shown = np.where(np.isfinite(curve.y), curve.y, np.nan)
            assert any(
                np.array_equal(x, curve.x) and np.array_equal(y, shown, equal_nan=True)
                for x, y, marker in lines
                if marker == "None"
            )
            if 0 < curve.point_x.size <= 60:
                assert any(
                    np.array_equal(x, curve.point_x) and np.array_equal(y, curve.point_y)
                    for x, y, marker in lines
                    if marker == "o"
                )
        upright = [x[0] for x, _, _ in lines if len(x) == 2 and x[0] == x[1]]
        assert set(upright) >= {mark.place for mark in plot.marks}
        level = [y[0] for _, y, _ in lines if len(y) == 2 and y[0] == y[1]]
        assert set(level) >= {mark.place for mark in panel.marks}


def test_force_over_depth_runs_from_first_contact_to_the_largest_load() -> None:
    forces = [10.0, 2.0, 5.0]
    plot, result = plotted("normal", BALL | {"load": {"normal_force": forces}})
    (curve,) = plot.panels[0].curves
    assert (curve.x[0], curve.y[0]) == (0.0, 0.0)
    assert curve.y[-1] == pytest.approx(10.0, rel=1e-12, abs=0)
    assert curve.x[-1] == pytest.approx(result["indentation_depth"][0], rel=1e-12, abs=0)
    # Hertz: F_N grows as d^(3/2).
    inner = slice(10, None)
    exact = 10.0 * (curve.x[inner] / curve.x[-1]) ** 1.5
    assert curve.y[inner] == pytest.approx(exact, rel=1e-12, abs=0)
    assert [y for _, y in points(plot)] == forces
    assert (plot.x_label, plot.panels[0].y_label) == ("indentation depth d", "normal force F_N")
    assert plot.points_label == "requested loads"


def test_each_normal_force_has_a_curve_into_full_slip() -> None:
    change = {"load": {"normal_force": [10.0, 20.0]}, "tangential": {"tangential_force": 2.0}}
    plot, result = plotted("tangential", TANGENTIAL | change)
    assert labels(plot) == ["F_N = 10", "F_N = 20"]
    for curve, force in zip(plot.panels[0].curves, (10.0, 20.0), strict=True):
        assert curve.y.max() == pytest.approx(0.3 * force, rel=1e-12, abs=0)
        assert curve.x[0] == curve.y[0] == 0.0
        # Beyond the onset of full slip the force is constant.
        assert curve.y[-10] == curve.y[-1]
    assert [y for _, y in points(plot)] == pytest.approx([2.0, 2.0], rel=1e-12, abs=0)
    assert sorted(x for x, _ in points(plot)) == sorted(result["tangential_displacement"])
    places = [(mark.place, mark.symbol, mark.curve) for mark in plot.panels[0].marks]
    expected = [(3.0, "µ F_N", 0), (6.0, "µ F_N", 1)]
    assert [place[1:] for place in places] == [place[1:] for place in expected]
    assert [p for p, *_ in places] == pytest.approx([3.0, 6.0], rel=1e-12, abs=0)


def test_forces_of_both_signs_show_both_limits() -> None:
    plot, _ = plotted("tangential", TANGENTIAL | {"tangential": {"tangential_force": [-2.0, 1.0]}})
    (curve,) = plot.panels[0].curves
    assert curve.y.min() == pytest.approx(-3.0, rel=1e-12, abs=0)
    assert curve.y.max() == pytest.approx(3.0, rel=1e-12, abs=0)
    symbols = [mark.symbol for mark in plot.panels[0].marks]
    assert symbols == ["µ F_N", "−µ F_N"]


def test_history_is_a_smooth_curve_through_its_turning_points() -> None:
    plot, _ = plotted("history", HISTORY)
    (curve,) = plot.panels[0].curves
    assert plot.points_label == "turning points"
    assert set(curve.point_y) == {0.0, 2.0, -2.0}
    assert curve.y.size > 1000
    assert [mark.symbol for mark in plot.panels[0].marks] == ["µ F_N", "−µ F_N"]
    low = HISTORY["cycles"] | {"tangential": {"tangential_force": 1.0}}
    plot, _ = plotted("history", HISTORY | {"cycles": low})
    assert plot.panels[0].marks == []


def test_field_plot_is_dense_and_marks_the_edges() -> None:
    radii = [0.0, 4e-5, 9e-5]
    plot, result = plotted("stress", STRESS | {"radius": radii})
    contact = plotted("tangential", {k: v for k, v in STRESS.items() if k in TANGENTIAL})[1]
    a, c = contact["contact_radius"][0], contact["stick_radius"][0]
    assert plot.x_limits == (0.0, 9e-5)
    assert [(mark.place, mark.symbol) for mark in plot.marks] == [(a, "a"), (c, "c")]
    for index, name in enumerate(STRESS["quantities"]):
        (curve,) = plot.panels[index].curves
        assert curve.x.size > 300
        assert curve.point_x.tolist() == radii
        assert curve.point_y.tolist() == result[name][0].tolist()
    names = [panel.y_label for panel in plot.panels]
    assert names == ["pressure p", "shear stress τ", "slip s"]
    # Hertz: p = p_0 sqrt(1 - r^2/a^2).
    pressure = plot.panels[0].curves[0]
    inside = pressure.x < 0.99 * a
    exact = pressure.y[0] * np.sqrt(1 - (pressure.x[inside] / a) ** 2)
    assert pressure.y[inside] == pytest.approx(exact, rel=1e-4, abs=0)


def test_single_radius_plots_the_whole_contact() -> None:
    plot, _ = plotted("stress", STRESS | {"radius": [4e-5]})
    contact = plotted("tangential", {k: v for k, v in STRESS.items() if k in TANGENTIAL})[1]
    assert plot.x_limits is not None
    assert plot.x_limits[0] == 0.0
    assert plot.x_limits[1] > 1.4 * contact["contact_radius"][0]


def test_no_line_crosses_an_infinite_pressure(monkeypatch: pytest.MonkeyPatch) -> None:
    plot, _ = plotted("stress", PUNCH | {"quantities": ["pressure"]})
    (curve,) = plot.panels[0].curves
    radius = PUNCH["profile"]["radius"]
    assert np.isinf(curve.y[curve.x == radius]).all()
    # The limits show the typical pressures, not the maximum: the mean is 1.0, the centre 0.5 of it.
    limits = plot.panels[0].y_limits
    assert limits is not None
    centre = curve.y[0]
    assert limits[0] == 0.0
    assert 1.5 * centre < limits[1] < 10 * centre
    (axes,) = drawn(plot, monkeypatch)
    texts = [text.get_text() for text in axes.texts]
    assert texts.count("∞") == 1
    assert "a, b" in texts


def test_curves_are_labelled_by_the_varying_quantity(monkeypatch: pytest.MonkeyPatch) -> None:
    loads = {"load": {"normal_force": [5.0, 10.0]}, "radius": [0.0, 1e-5]}
    plot, _ = plotted("stress", STRESS | loads | {"tangential": {"tangential_force": 1.0}})
    assert labels(plot) == ["F_N = 5", "F_N = 10"]
    axes = drawn(plot, monkeypatch)
    legend = axes[0].get_legend()
    assert legend is not None
    texts = [text.get_text() for text in legend.get_texts()]
    assert texts == ["F_N = 5", "F_N = 10", "requested radii"]
    # Edges have the colour of their curve.
    edges = [(mark.symbol, mark.curve) for mark in plot.marks]
    assert edges == [("a", 0), ("a", 1), ("c", 0), ("c", 1)]


@pytest.mark.parametrize(
    ("name", "value", "note"),
    [
        ("stress", STRESS | {"load": {"normal_force": [10.0 + i for i in range(9)]}}, "loads"),
        (
            "wear",
            WEAR | {"oscillation": {"tangential_force": [0.1 * i for i in range(9)]}},
            "loads",
        ),
        (
            "tangential",
            TANGENTIAL
            | {"load": {"normal_force": [10.0 + i for i in range(9)]}}
            | {"tangential": {"tangential_force": 1.0}},
            "normal forces",
        ),
        ("evolution", EVOLUTION | {"cycles": [1e4 * i for i in range(9)]}, "numbers of cycles"),
    ],
)
def test_legend_states_the_number_of_omitted_curves(
    name: str, value: dict[str, Any], note: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    plot, _ = plotted(name, value)
    assert plot.note == f"6 of 9 {note}"
    legend = drawn(plot, monkeypatch)[0].get_legend()
    assert legend is not None
    assert legend.get_title().get_text() == plot.note


def test_wear_shows_initial_and_limiting_profile() -> None:
    plot, result = plotted("wear", WEAR | {"oscillation": {"tangential_force": 2.0}})
    limiting, initial = plot.panels[0].curves
    assert (limiting.label, initial.label) == ("limiting", "initial")
    assert initial.style == "--"
    c, worn = result["stick_radius"][0], result["wear_radius"][0]
    assert [(mark.place, mark.symbol) for mark in plot.marks] == [
        (c, "c"),
        (worn, "ã"),
    ]
    spared = (initial.x < c) | (initial.x > worn)
    assert limiting.y[spared].tolist() == initial.y[spared].tolist()
    assert (limiting.y[~spared] >= initial.y[~spared]).all()
    assert initial.y == pytest.approx(initial.x**2 / 0.02, rel=1e-12, abs=0)


def test_unbounded_wear_is_labelled_and_not_drawn() -> None:
    plot, _ = plotted("wear", WEAR | {"oscillation": {"tangential_force": [2.0, 3.0]}})
    assert labels(plot) == ["F_x = 2", "F_x = 3: unbounded", "initial"]
    assert np.isinf(plot.panels[0].curves[1].y).any()
    assert {mark.curve for mark in plot.marks} == {0}


def test_evolution_shows_the_cycles_and_the_initial_profile() -> None:
    plot, result = plotted("evolution", EVOLUTION | {"cycles": [1e4, 1e6]})
    names = ["N = 1e+04", "N = 1e+06"]
    assert labels(plot) == [*names, "initial"]
    assert labels(plot, 1) == names
    styles = [curve.style for curve in plot.panels[0].curves]
    assert styles == ["-", "-", "--"]
    assert [panel.y_label for panel in plot.panels] == ["profile f", "pressure p"]
    edges = [result["stick_radius"][-1], result["contact_radius"][-1]]
    assert [(mark.place, mark.symbol) for mark in plot.marks] == [(edges[0], "c"), (edges[1], "a")]


def test_svg_text_is_text() -> None:
    plot, _ = plotted("normal", BALL)
    root = ET.fromstring(picture.write(plot, "svg"))  # noqa: S314 -- our own
    texts = {"".join(each.itertext()) for each in root.iter("{http://www.w3.org/2000/svg}text")}
    assert texts >= {"requested loads", "normal force F_N"}
    assert "indentation depth d   (in the units of the request)" in texts


GET = "/v1/normal?kind=paraboloid&radius=0.01&e_star=1e11&normal_force=10"


def test_picture_has_the_requested_size(client: Client) -> None:
    post = client.request("POST", "/v1/normal?format=png&size=90x60", json=BALL)
    for response in (post, client.get(f"{GET}&format=png&size=90x60")):
        # Width and height in the header of a PNG.
        pixels = struct.unpack(">II", response.content[16:24])
        assert pixels == pytest.approx([90 / 25.4 * 150, 60 / 25.4 * 150], abs=1)
    assert 'width="510.236' in client.get(f"{GET}&format=svg&size=180x60").text


@pytest.mark.parametrize("size", ["29x60", "90x401", "90", "90.5x60", "x"])
def test_invalid_size_is_rejected(client: Client, size: str) -> None:
    for response in (
        client.request("POST", f"/v1/normal?format=svg&size={size}", json=BALL),
        client.get(f"{GET}&format=svg&size={size}"),
        client.get(f"{GET}&size=90x60"),
    ):
        assert response.status_code == 422
        assert response.json()["errors"][0]["pointer"] == "/size"


@pytest.mark.parametrize("force", [2.9999999999999996, 3.0])
@pytest.mark.parametrize("kind", ["cone", "paraboloid", "sphere", "truncated_cone"])
def test_onset_of_full_slip_has_a_plot(kind: str, force: float) -> None:
    fields = {"radius": 0.01, "slope": 0.1, "flat_radius": 1e-5}
    model = next(
        m
        for m in SCHEMAS["normal"].model.model_json_schema()["$defs"].values()
        if m.get("properties", {}).get("kind", {}).get("const") == kind
    )
    profile = {"kind": kind} | {n: fields[n] for n in model["properties"] if n != "kind"}
    value = TANGENTIAL | {"profile": profile, "tangential": {"tangential_force": force}}
    plot, _ = plotted("tangential", value)
    assert plot.panels[0].curves[0].y.max() == pytest.approx(3.0, rel=1e-12, abs=0)
