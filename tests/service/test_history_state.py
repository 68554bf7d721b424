"""Histories carried on over HTTP: a path in pieces has the numbers of the whole path."""

import copy
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mdr_service.queries import QUERIES
from tests.conftest import Client
from tests.service.test_history import SAMPLED
from tests.service.test_normal import PROFILES

PATH = QUERIES["history"].path
E_STAR, G_STAR, MU = 1e9, 8e8, 0.3
NUMBERS = [name for name in SAMPLED if name not in {"step", "regime"}]
State = dict[str, Any]


def request(kind: str, controls: tuple[str, str], path: np.ndarray, **more: object) -> State:
    normal, tangential = path.tolist()
    return {
        "profile": {"kind": kind, **PROFILES[kind][0]},
        "material": {"e_star": E_STAR, "g_star": G_STAR},
        "friction_coefficient": MU,
        "history": {
            "normal": {controls[0]: normal},
            "tangential": {controls[1]: tangential},
            "samples_per_step": 2,
        },
        "return_state": True,
        **more,
    }


def path_of(client: Client, kind: str, controls: tuple[str, str], steps: int) -> np.ndarray:
    """Random load points within friction, with a separation and full slip where possible."""
    rng = np.random.default_rng(len(kind))
    depth = 1e-5 * rng.uniform(0.4, 1.0, steps)
    depth[3] = depth[4]
    by_depth = np.array([depth, 0 * depth])
    contact = client.post(
        PATH, request(kind, ("indentation_depth", "tangential_displacement"), by_depth)
    ).json()
    force = np.array(contact["normal_force"])[1::2]
    if controls[1] == "tangential_force":
        along = MU * force.min() * rng.uniform(-0.9, 0.9, steps)
        along[0] = 0.0
    else:
        along = MU * E_STAR / G_STAR * 1e-5 * rng.uniform(-1.2, 1.2, steps)
        if controls[0] == "indentation_depth":
            depth[7] = -1e-6
    return np.array([depth if controls[0] == "indentation_depth" else force, along])


@pytest.mark.every(5)
@pytest.mark.parametrize("kind", sorted(PROFILES))
@pytest.mark.parametrize("normal", ["indentation_depth", "normal_force"])
@pytest.mark.parametrize("tangential", ["tangential_displacement", "tangential_force"])
def test_pieces_have_the_numbers_of_the_whole_path(
    client: Client, kind: str, normal: str, tangential: str
) -> None:
    controls, steps = (normal, tangential), 12
    path = path_of(client, kind, controls, steps)
    whole = client.post(PATH, request(kind, controls, path)).json()
    for count in (2, 3, 10):
        parts: list[State] = []
        for piece in np.array_split(path, count, axis=1):
            carried = {"initial_state": parts[-1]["final_state"]} if parts else {}
            response = client.post(PATH, request(kind, controls, piece, **carried))
            assert response.status_code == 200, response.text
            parts.append(response.json())
        for name in NUMBERS:
            values = np.array(whole[name])
            joined = np.concatenate([part[name] for part in parts])
            assert joined == pytest.approx(values, rel=0, abs=1e-12 * np.abs(values).max()), name
        assert [each for part in parts for each in part["regime"]] == whole["regime"]
        fronts = np.array(whole["slip_fronts"])
        assert parts[-1]["slip_fronts"] == pytest.approx(fronts, rel=1e-12, abs=0)


@pytest.fixture
def state(client: Client) -> State:
    path = np.array([4 * [1e-5], [0.0, 2e-6, -1e-6, 5e-7]])
    answer = client.post(PATH, request("paraboloid", CONTROLS, path)).json()
    assert len(answer["final_state"]["polyline"]) == 4
    found: State = answer["final_state"]
    return found


CONTROLS = ("indentation_depth", "tangential_displacement")
NEXT = np.array([[1e-5], [0.0]])


def rejected(client: Client, state: object, pointer: str, **more: object) -> None:
    given = request("paraboloid", CONTROLS, NEXT, initial_state=state) | more
    response = client.post(PATH, given)
    assert response.status_code == 422, response.text
    assert response.json()["errors"][0]["pointer"].startswith(pointer), response.text


def _changed(change: Callable[[list[list[float]]], object]) -> Callable[[State], object]:
    return lambda state: change(state["polyline"])


FORGERIES: dict[str, tuple[str, Callable[[State], object]]] = {
    "order": ("/polyline/0", _changed(lambda rows: rows.reverse())),
    "two exchanged": ("/polyline", _changed(lambda rows: rows.insert(1, rows.pop()))),
    "no axis": ("/polyline/0", _changed(lambda rows: rows.pop(0))),
    "a vertex twice": ("/polyline/1", _changed(lambda rows: rows.insert(1, rows[1]))),
    "a sign": ("/polyline", _changed(lambda rows: rows[1].__setitem__(0, -rows[1][0]))),
    "signs": ("/polyline", _changed(lambda rows: rows.append([-x for x in rows.pop()]))),
    "too large": ("/polyline", _changed(lambda rows: rows[2].__setitem__(1, 1e308))),
    "too small": ("/polyline", _changed(lambda rows: rows[2].__setitem__(1, -1e308))),
    "null": ("/polyline/1/0", _changed(lambda rows: rows[1].__setitem__(0, None))),
    "text": ("/polyline/1/0", _changed(lambda rows: rows[1].__setitem__(0, "NaN"))),
    "one number": ("/polyline/1", _changed(lambda rows: rows[1].pop())),
    "three numbers": ("/polyline/1", _changed(lambda rows: rows[1].append(0.0))),
    "no vertices": ("/polyline", _changed(lambda rows: rows.clear())),
    "separation": ("/polyline", lambda state: state.update(normal=-1e-6)),
    "no contact": ("/polyline", lambda state: state.update(regime="no_contact")),
    "less depth": ("/polyline", lambda state: state.update(normal=1e-7)),
    "more displacement": ("/polyline", lambda state: state.update(tangential=1.0)),
    "energy": ("/dissipated_energy", lambda state: state.update(dissipated_energy=-1.0)),
    "regime": ("/regime", lambda state: state.update(regime="slip")),
    "digest": ("/contact", lambda state: state.update(contact="0" * 16)),
    "unknown member": ("", lambda state: state.update(time=1.0)),
}


@pytest.mark.parametrize("forgery", FORGERIES)
def test_a_forged_state_is_rejected_at_its_place(
    client: Client, state: State, forgery: str
) -> None:
    pointer, change = FORGERIES[forgery]
    change(state)
    rejected(client, state, f"/initial_state{pointer}")


def test_a_state_without_a_member_or_of_another_contact_is_rejected(
    client: Client, state: State
) -> None:
    for name in state:
        rejected(client, {k: v for k, v in state.items() if k != name}, "/initial_state")
    contact = "/initial_state/contact"
    rejected(client, state, contact, friction_coefficient=0.31)
    rejected(client, state, contact, material={"e_star": E_STAR, "g_star": 1.01 * G_STAR})
    rejected(client, state, contact, profile={"kind": "paraboloid", "radius": 0.011})
    forces = {"normal": {"normal_force": 1.0}, "tangential": {"tangential_force": 0.0}}
    rejected(client, state, contact, history=forces)
    cycles = {
        "normal": {"indentation_depth": 1e-5},
        "tangential": {"tangential_displacement": 1e-6},
    }
    given = request("paraboloid", CONTROLS, NEXT, initial_state=state, cycles=cycles)
    del given["history"]
    assert client.post(PATH, given).json()["errors"][0]["pointer"] == "/initial_state"


@pytest.mark.long
def test_no_change_of_a_number_is_an_internal_error(client: Client) -> None:
    """Holds for states under controls of different pairs, and of a flat punch."""
    values = [0.0, -0.0, 1e308, -1e308, 5e-324, 1e-6, -1.0, None, "NaN", [], {}, True]
    for kind, controls in (
        ("paraboloid", CONTROLS),
        ("rounded_punch", ("normal_force", "tangential_displacement")),
        ("flat_punch", ("indentation_depth", "tangential_force")),
    ):
        path = path_of(client, kind, controls, 8)[:, :-1]
        given = request(kind, controls, path)
        state = client.post(PATH, given).json()["final_state"]
        places: list[tuple[Any, ...]] = [(name,) for name in state]
        line = state["polyline"]
        for i in (0, len(line) // 2, -1):
            places += [("polyline", i), ("polyline", i, 0), ("polyline", i, 1)]
        for place in places:
            for value in values:
                forged = copy.deepcopy(state)
                *outer, last = place
                inner: Any = forged
                for key in outer:
                    inner = inner[key]
                inner[last] = value
                response = client.post(PATH, given | {"initial_state": forged})
                assert response.status_code in {200, 422}, (kind, place, value, response.text)


def test_a_batch_carries_states_on_and_tables_leave_them_out(client: Client, state: State) -> None:
    given = request("paraboloid", CONTROLS, NEXT, initial_state=state)
    entry = {"ask": "history", "request": given}
    (answer,) = client.post("/v1/batch", {"queries": [entry]}).json()["answers"]
    assert answer["answer"] == client.post(PATH, given).json()
    plain = {**given, "return_state": False}
    for media_type in ("csv", "npz", "svg"):
        responses = [client.post(f"{PATH}?format={media_type}", each) for each in (given, plain)]
        assert responses[0].content == responses[1].content, media_type


def test_steps_of_a_cosimulation_are_exact_without_a_warning(client: Client) -> None:
    """A mass slides and stops: the last steps dissipate little of the total energy."""
    request = {
        "profile": {"kind": "paraboloid", "radius": 0.01},
        "material": {"e_star": 115e9, "g_star": 95e9},
        "friction_coefficient": 0.3,
        "return_state": True,
    }
    mass, time_step = 0.01, 2e-6
    displacement, velocity = 0.0, 0.02
    for _ in range(41):
        load = {"normal_force": 10.0}, {"tangential_displacement": displacement}
        request["history"] = {"normal": load[0], "tangential": load[1]}
        answer = client.post(PATH, request).json()
        assert answer["error_estimate"] < 5e-12
        assert "accuracy" not in {warning["code"] for warning in answer["warnings"]}
        request["initial_state"] = answer["final_state"]
        velocity -= answer["tangential_force"][0] / mass * time_step
        displacement += velocity * time_step
