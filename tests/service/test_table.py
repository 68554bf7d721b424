"""A file over HTTP has the columns and lists of the core, or is rejected with its line."""

import numpy as np
import pytest

from mdr_service.schemas.answers import TableAnswer
from tests.conftest import Client

CSV = {"content-type": "text/csv"}


def read(client: Client, content: str | bytes, query: str = "curve") -> tuple[int, dict]:
    body = content.encode() if isinstance(content, str) else content
    response = client.request("POST", f"/v1/table?as={query}", content=body, headers=CSV)
    return response.status_code, response.json()


def test_curve_has_columns_units_and_segments(client: Client) -> None:
    text = "time_s,load_micro_N,depth_nm\n0,0,0\n1,2,10\n2,5,20\n3,1,10\n4,0,0\n"
    status, document = read(client, text)
    assert status == 200
    TableAnswer.model_validate(document)
    assert document["indentation_depth"] == [0, 10, 20, 10, 0]
    assert document["normal_force"] == [0, 2, 5, 1, 0]
    assert document["units"] == ["nm", "µN"]
    assert document["scales"] == pytest.approx([1e-9, 1e-6], rel=1e-15, abs=0)
    assert [each["quantity"] for each in document["columns"]] == [None, "force", "depth"]
    assert document["lines"] == [2, 3, 4, 5, 6]
    assert document["segments"] == [
        {"kind": "loading", "first": 0, "last": 2},
        {"kind": "unloading", "first": 3, "last": 4},
    ]


def test_columns_that_are_left_open_are_listed_and_can_be_chosen(client: Client) -> None:
    text = "Point,Flag,Load,Gauge,LVDT\n1,a,2,3,4\n2,a,4,6,8\n"
    status, document = read(client, text)
    assert status == 422
    listed = [(each["pointer"], each["detail"]) for each in document["errors"][1:]]
    names = {1: "Point", 3: "Load", 4: "Gauge", 5: "LVDT"}
    assert listed == [(f"/columns/{number}", name) for number, name in names.items()]
    status, document = read(client, text, "curve&columns=5,3")
    assert status == 200
    assert (document["indentation_depth"], document["normal_force"]) == ([4, 8], [2, 4])
    for wrong in ("2,3", "5,9", "3,3", "0,1", "1", "x"):
        status, document = read(client, text, f"curve&columns={wrong}")
        assert (status, document["type"]) == (422, "urn:mdr:problem:invalid-request")
        assert document["errors"][0]["pointer"].startswith("/columns") or wrong in {"2,3", "5,9"}


def test_unit_of_an_area_is_a_square(client: Client) -> None:
    _, document = read(client, "A [nm^2],h [nm]\n0,0\n4,1\n", "profile")
    assert [each["unit"] for each in document["columns"]] == ["nm²", "nm"]
    # The unit of the radii.
    assert document["units"] == ["nm", "nm"]


def test_reversed_sign_of_a_separation_is_noted(client: Client) -> None:
    text = "Separation_nm_Ex Separation_nm_Rt Defl_nN_Ex Defl_nN_Rt\n5 -3 0 9\n-2 4 9 1\n"
    status, document = read(client, text)
    assert status == 200
    TableAnswer.model_validate(document)
    assert document["indentation_depth"] == [-5, 2, 3, -4]
    assert (document["units"], document["lines"]) == (["nm", "nN"], [2, 3, 2, 3])
    assert [each["quantity"] for each in document["columns"]] == [
        "depth",
        "depth",
        "force",
        "force",
    ]
    assert [(each["kind"], each["last"]) for each in document["segments"]] == [
        *(("loading", 1), ("unloading", 3))
    ]
    falls = "is taken as the depth, with its sign reversed: it falls towards the sample."
    assert document["notes"] == [
        f"Column 1, “Separation Ex”, {falls}",
        f"Column 2, “Separation Rt”, {falls}",
        "Column 3, “Defl Ex”, is taken as the force.",
        "Column 4, “Defl Rt”, is taken as the force.",
    ]


def test_axis_of_a_worn_ball_is_found_in_any_window_about_it(client: Client) -> None:
    axes = []
    for first, last in ((0, 825), (0, 700), (150, 600), (412.5, 800)):
        r = np.arange(first, last, 2.5)
        f = np.maximum(0, (r - 412.5) ** 2 - 60**2) / 12700
        text = "\n".join(f"{x:.17g} {y:.17g}" for x, y in zip(r, f, strict=True))
        axes.append(read(client, f"r_um f_um\n{text}\n", "profile")[1]["axis"])
    assert axes[:3] == pytest.approx([412.5] * 3, abs=0.1)
    assert axes[3] is None
    for points in ("1 2", "1 2\n1 3"):
        assert read(client, f"r f\n{points}\n", "profile")[1]["axis"] is None


def test_profile_without_a_heading_names_no_unit(client: Client) -> None:
    status, document = read(client, "0 0\n1 0,5\n2 2\n", "profile")
    assert status == 200
    TableAnswer.model_validate(document)
    assert (document["r"], document["f"]) == ([0, 1, 2], [0, 0.5, 2])
    assert document["units"] == document["scales"] == [None, None]


@pytest.mark.parametrize(
    ("content", "kind", "pointer", "detail"),
    [
        ("Alpha,Beta\n0.1,5\n", "curve", "/table", "Line 2: 2 columns; name the depth d"),
        (b"PK\x03\x04", "curve", "/table", "is a workbook"),
        ("", "curve", "/table", "no line holds two numbers"),
        (b"\xff\xfe\x00", "curve", "/table", "no line holds two numbers"),
        ("0,0\n1,1", "other", "/as", "must be one of profile, curve"),
    ],
)
def test_refusals_point_and_name_the_remedy(
    client: Client, content: str | bytes, kind: str, pointer: str, detail: str
) -> None:
    status, document = read(client, content, kind)
    assert status == 422
    assert document["errors"][0]["pointer"] == pointer
    assert detail in document["errors"][0]["detail"]


def test_file_that_is_too_long_is_refused(client: Client) -> None:
    assert read(client, b"0 0\n" * 1_100_000)[0] == 413


def test_holds_times_and_their_drift_are_listed(client: Client) -> None:
    # Loading to 100, a hold, unloading to 20, a hold in which the depth drifts by 0.6 nm/min.
    forces = [*range(0, 100, 2), *[100] * 20, *range(98, 20, -2), *[20] * 30, *range(18, -2, -2)]
    rows = "".join(f"{i / 60:.9f};{f + 0.01 * i:.2f};{f}\n" for i, f in enumerate(forces))
    status, document = read(client, f"t [min];d [nm];F [mN]\n{rows}")
    assert status == 200
    TableAnswer.model_validate(document)
    assert document["time"] == pytest.approx(list(range(len(forces))), abs=1e-6)
    assert [each["kind"] for each in document["segments"]] == [
        *("loading", "hold", "unloading", "hold", "unloading")
    ]
    second = document["segments"][3]
    assert [second["first"], second["last"]] == pytest.approx([109, 138], abs=1)
    assert document["drift_rate"] == pytest.approx([0.01], rel=1e-6, abs=0)
    assert 0 < document["drift_rate_error"][0] < 1e-6


def test_segment_column_has_priority_over_depth_direction(client: Client) -> None:
    text = "d [nm];F [mN];Segment\n0;0;Load\n1;1;Load\n2;2;Hold\n2;1;\n1;0;Unload\n"
    _, document = read(client, text)
    assert document["segments"] == [
        {"kind": "loading", "first": 0, "last": 1},
        {"kind": "hold", "first": 2, "last": 3},
        {"kind": "unloading", "first": 4, "last": 4},
    ]
