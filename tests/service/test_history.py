"""Histories over HTTP have the core's digits at every sample, and its fields at the end."""

import pytest

from mdr_core import fields, history, normal
from mdr_service.settings import SETTINGS
from tests.conftest import Client
from tests.service.test_normal import E_STAR, PROFILES

G_STAR, FRICTION = 1.9e9, 0.4
PATH = "/v1/tangential/history"
SAMPLED = (
    "step",
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "tangential_displacement",
    "tangential_force",
    "dissipated_energy",
    "elastic_energy",
    "tangential_energy",
    "regime",
)
PATHS = {
    "forces": ({"normal_force": [1e5, 2e5, 5e4]}, {"tangential_force": [0.0, 5e4, -1e4]}),
    "one force": ({"normal_force": 1e5}, {"tangential_force": [0.0, 3e4, -3e4, 1e4]}),
    "depths, separation": (
        {"indentation_depth": [1e-4, 2e-4, -1e-5, 1e-4]},
        {"tangential_displacement": [0.0, 5e-5, 0.0, -1e-3]},
    ),
    "a force and displacements": (
        {"normal_force": 1e5},
        {"tangential_displacement": [0.0, 1e-6, -1e-6]},
    ),
    "a force on a curve": (
        {"normal_force": [1e5, 1.4e5]},
        {"tangential_displacement": [1e-5, -1e-5]},
    ),
    "a depth and forces": ({"indentation_depth": [1e-3]}, {"tangential_force": [0.0, 10.0, -5.0]}),
}


def query(kind: str = "paraboloid", **load_path: object) -> dict[str, object]:
    return {
        "profile": {"kind": kind, **PROFILES[kind][0]},
        "material": {"e_star": E_STAR, "g_star": G_STAR},
        "friction_coefficient": FRICTION,
        **load_path,
    }


def history_of(normal_load: object, tangential: object, **more: object) -> dict[str, object]:
    return {"history": {"normal": normal_load, "tangential": tangential, **more}}


def solved(kind: str, *controls: dict[str, object], **more: object) -> history.LoadHistory:
    given = controls[0] | controls[1]
    return history.solve(PROFILES[kind][1], E_STAR, G_STAR, FRICTION, **given, **more)


@pytest.mark.parametrize("load_path", PATHS)
@pytest.mark.parametrize("kind", ["paraboloid", "flat_punch", "cone", "truncated_cone"])
def test_response_equals_the_core(client: Client, kind: str, load_path: str) -> None:
    document = client.post(
        PATH, query(kind, **history_of(*PATHS[load_path], samples_per_step=3))
    ).json()
    expected = solved(kind, *PATHS[load_path], samples_per_step=3)
    for name in (*SAMPLED, "slip_fronts"):
        assert document[name] == getattr(expected, name).tolist(), name
    assert document["method"] == expected.method
    assert document["error_estimate"] == expected.error_estimate
    assert not {"energy_per_cycle", "secant_stiffness"} & set(document)


def test_scalars_equal_lists_of_length_one(client: Client) -> None:
    answers = [
        client.post(
            PATH, query(**history_of({"normal_force": one}, {"tangential_force": other}))
        ).json()
        for one, other in ((1e5, 1e4), ([1e5], 1e4), (1e5, [1e4]), ([1e5], [1e4]))
    ]
    assert all(response == answers[0] for response in answers)
    assert all(len(answers[0][name]) == 1 for name in SAMPLED)


CYCLES = {
    "forces": ({"normal_force": 1e5}, {"tangential_force": 3e4}),
    "forces in phase": ({"normal_force": 1e5, "amplitude": 2e4}, {"tangential_force": 3e4}),
    "depths": ({"indentation_depth": 2e-4}, {"tangential_displacement": 3e-5}),
    "depths in phase": (
        {"indentation_depth": 2e-4, "amplitude": 2e-4},
        {"tangential_displacement": 3e-5},
    ),
    "a force and a displacement": ({"normal_force": 1e5}, {"tangential_displacement": 1e-6}),
    "a force and a displacement in phase": (
        {"normal_force": 1e5, "amplitude": 2e4},
        {"tangential_displacement": 1e-6},
    ),
}


@pytest.mark.parametrize("samples", [{}, {"samples_per_step": 2}])
@pytest.mark.parametrize("load_path", CYCLES)
def test_cycles_equal_the_core(client: Client, load_path: str, samples: dict[str, int]) -> None:
    pressed, pushed = CYCLES[load_path]
    told_by = {"normal": pressed, "tangential": pushed, "count": 3, **samples}
    document = client.post(PATH, query(cycles=told_by)).json()
    controls = {name: value for name, value in pressed.items() if name != "amplitude"}
    expected = history.cycles(
        PROFILES["paraboloid"][1],
        E_STAR,
        G_STAR,
        FRICTION,
        **controls,
        **pushed,
        normal_amplitude=pressed.get("amplitude", 0.0),
        count=3,
        **samples,
    )
    for name in (*SAMPLED, "slip_fronts"):
        assert document[name] == getattr(expected, name).tolist(), name
    for name in ("energy_per_cycle", "secant_stiffness"):
        assert document[name] == getattr(expected, name).tolist()
        assert len(document[name]) == 3


def test_bodies_and_yield_strength(client: Client) -> None:
    rubber = {"youngs_modulus": 5e6, "poissons_ratio": 0.4, "yield_strength": 1.0}
    material = {"bodies": ["rigid", {k: rubber[k] for k in ("youngs_modulus", "poissons_ratio")}]}
    request = query(**history_of({"normal_force": 1.0}, {"tangential_force": 0.1}))
    response = client.post(PATH, request | {"material": material | {"yield_strength": 1.0}})
    assert {each["code"] for each in response.json()["warnings"]} == {"elastic_similarity", "yield"}


def test_zero_load_gives_zero(client: Client) -> None:
    request = query(
        "truncated_cone", **history_of({"normal_force": [0.0, 1.0]}, {"tangential_force": 0})
    )
    request["profile"] = {"kind": "power", "coefficient": 1.0, "exponent": 0.5}
    response = client.post(PATH, request)
    assert response.status_code == 200
    assert "singular" not in {each["code"] for each in response.json()["warnings"]}


def test_samples_are_limited(client: Client) -> None:
    for load_path in (PATHS["one force"], PATHS["a force and displacements"]):
        asked = query(**history_of(*load_path, samples_per_step=SETTINGS.max_length // 3 + 1))
        response = client.post(PATH, asked)
        assert response.status_code == 422
        pointers = [error["pointer"] for error in response.json()["errors"]]
        assert pointers == ["/history/samples_per_step"]


def test_cycles_are_limited(client: Client) -> None:
    told_by = {"normal": {"normal_force": 1.0}, "tangential": {"tangential_force": 0.1}}
    for more, pointer in (
        ({"count": SETTINGS.max_length // 2}, "/cycles"),
        ({"count": SETTINGS.max_length, "samples_per_step": 2}, "/cycles/samples_per_step"),
        ({"count": SETTINGS.max_length + 1}, "/cycles/count"),
        # Curved steps have 20 samples each by default.
        (
            {
                "normal": {"indentation_depth": 1e-6, "amplitude": 1e-7},
                "count": SETTINGS.max_length // 40,
            },
            "/cycles",
        ),
    ):
        response = client.post(PATH, query(cycles=told_by | more))
        assert response.status_code == 422
        assert [error["pointer"] for error in response.json()["errors"]] == [pointer]


RADII = [0.0, 0.001, 0.01, 0.3, 1.2]
OF_NORMAL = ("pressure", "normal_displacement", "foundation_load")
OF_SHEAR = ("shear_stress", "slip", "foundation_shear")


@pytest.mark.parametrize("load_path", ["forces", "depths, separation", "a depth and forces"])
@pytest.mark.parametrize("kind", ["paraboloid", "flat_punch", "cone", "truncated_cone"])
def test_fields_at_the_end_equal_the_core(client: Client, kind: str, load_path: str) -> None:
    asked = {"radius": RADII, "quantities": [*OF_NORMAL, *OF_SHEAR]}
    document = client.post(
        "/v1/stress", query(kind, **history_of(*PATHS[load_path]), **asked)
    ).json()
    expected = solved(kind, *PATHS[load_path])
    depth = max(float(expected.indentation_depth[-1]), 0.0)
    end = normal.solve(PROFILES[kind][1], E_STAR, indentation_depth=depth)
    for names, source in ((OF_NORMAL, end), (OF_SHEAR, expected.state)):
        for name in names:
            result = getattr(fields, name)(source, RADII).tolist()
            assert document[name] == [[r if abs(r) < float("inf") else None for r in result]], name


def test_error_of_a_list_of_one_points_at_its_only_value(client: Client) -> None:
    """The one tangential force exceeds µ F_N at the end of the second step."""
    query = {
        "profile": {"kind": "paraboloid", "radius": 1.0},
        "material": {"e_star": 1.0, "g_star": 1.0},
        "friction_coefficient": 0.5,
        "history": {
            "normal": {"normal_force": [10.0, 1.0]},
            "tangential": {"tangential_force": [2.0]},
        },
    }
    response = client.post("/v1/tangential/history", query)
    assert response.status_code == 422
    pointers = [error["pointer"] for error in response.json()["errors"]]
    assert pointers == ["/history/tangential/tangential_force/0"]


@pytest.mark.parametrize("samples", [1, 2, 3])
def test_force_that_acts_at_first_contact_is_rejected(client: Client, samples: int) -> None:
    path = {"indentation_depth": [-3e-5, 1e-4]}, {"tangential_force": [0.0, -10.0]}
    response = client.post(PATH, query("flat_punch", **history_of(*path, samples_per_step=samples)))
    assert response.status_code == 422
    (error,) = response.json()["errors"]
    assert error["pointer"] == "/history/tangential/tangential_force/1"
    assert "add a point in contact without the force" in error["detail"]
