"""Normal contact over HTTP: responses equal the core's results."""

import json

import pytest

from mdr_core import materials, profiles
from mdr_core.normal import solve
from tests.conftest import Client
from tests.core.comparison import profile_from
from tests.core.evaluations import PROFILES as ONE_OF_EACH

NAMES = (
    "indentation_depth",
    "normal_force",
    "contact_radius",
    "mean_pressure",
    "normal_stiffness",
    "elastic_energy",
)
E_STAR = 2.3e9
#: The request of each kind and the profile of the core.
PROFILES = {
    kind: (given, profile_from({"kind": kind, **given})) for kind, given in ONE_OF_EACH.items()
}


def query(kind: str, **load: object) -> dict[str, object]:
    return {
        "profile": {"kind": kind, **PROFILES[kind][0]},
        "material": {"e_star": E_STAR},
        "load": load,
    }


def test_all_kinds_are_covered() -> None:
    assert set(PROFILES) == set(profiles.KINDS)


@pytest.mark.parametrize("kind", PROFILES)
def test_response_equals_the_core(client: Client, kind: str) -> None:
    forces = [1e3, 1e5, 2.5e7]
    response = client.post("/v1/normal", query(kind, normal_force=forces)).json()
    contact = solve(PROFILES[kind][1], E_STAR, normal_force=forces)
    for name in NAMES:
        assert response[name] == getattr(contact, name).tolist()
    assert response["method"] == contact.method
    assert response["error_estimate"] == contact.error_estimate


@pytest.mark.parametrize("kind", PROFILES)
@pytest.mark.parametrize("control", ["indentation_depth", "normal_force"])
def test_scalar_load_gives_lists_of_length_one(client: Client, kind: str, control: str) -> None:
    load = 1e-3 if control == "indentation_depth" else 1e4
    response = client.post("/v1/normal", query(kind, **{control: load})).json()
    for name in NAMES:
        assert len(response[name]) == 1
    assert response[control] == [load]


def test_bodies_equal_their_effective_modulus(client: Client) -> None:
    steel = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
    request = query("cone", indentation_depth=1e-6) | {"material": {"bodies": [steel, "rigid"]}}
    response = client.post("/v1/normal", request).json()
    e_star = materials.from_bodies([materials.Body(210e9, 0.3), "rigid"]).e_star
    (a,), (stiffness,) = response["contact_radius"], response["normal_stiffness"]
    assert stiffness == pytest.approx(2 * e_star * a, rel=1e-15, abs=0)


def test_infinity_is_null_with_a_warning(client: Client) -> None:
    request = query("cone", normal_force=[0, 1.0])
    request["profile"] = {"kind": "power", "coefficient": 1, "exponent": 0.5}
    response = client.post("/v1/normal", request).json()
    assert response["mean_pressure"][0] is None
    assert response["mean_pressure"][1] > 0
    assert "singular" in [warning["code"] for warning in response["warnings"]]


def test_catalogue_lists_every_kind_with_its_fields(client: Client) -> None:
    listed = {kind.pop("kind"): kind for kind in client.get("/v1/profiles").json()["profiles"]}
    assert list(listed) == list(profiles.KINDS)
    for name, kind in listed.items():
        assert kind["formula"]
        required = {field["name"] for field in kind["fields"] if field["required"]}
        # A slope may be given by an angle.
        assert required == set(PROFILES[name][0]) - {"uncertainty", "slope"}
    slope, angle = listed["cone"]["fields"]
    assert (slope["dimension"], angle["dimension"]) == ("1", "degree")
    assert "normal_force" in listed["cone"]["closed_forms"]


def test_page_files_are_revalidated(client: Client) -> None:
    first = client.get("/explorer/plotly.min.js")
    assert "default-src 'self'" in first.headers["content-security-policy"]
    again = {"If-None-Match": first.headers["etag"]}
    assert client.request("GET", "/explorer/plotly.min.js", headers=again).status_code == 304
    assert client.get("/explorer/missing.js").status_code == 404


@pytest.mark.parametrize("given", ["bytes=0-3", "bytes=9-3", "bytes=99999999-", "lines=1"])
def test_ranges_of_files_are_ignored(client: Client, given: str) -> None:
    whole = client.get("/explorer/main.js")
    assert whole.headers["accept-ranges"] == "none"
    for path in ("/explorer/main.js", "/"):
        response = client.request("GET", path, headers={"Range": given})
        assert (response.status_code, response.content) == (200, client.get(path).content)


def test_simultaneous_downloads_share_a_file(client: Client) -> None:
    """A download that counts as memory of its request is rejected beside 20 others."""
    transfers = client.app.state.transfers
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(transfers, "_limit", 0)
        patch.setattr(transfers, "_total", 1)
        assert client.get("/explorer/plotly.min.js").status_code == 200


def test_numbers_keep_all_their_digits(client: Client) -> None:
    load = 0.1 + 0.2
    text = client.post("/v1/normal", query("cone", normal_force=load)).content
    assert json.loads(text)["normal_force"] == [load]
