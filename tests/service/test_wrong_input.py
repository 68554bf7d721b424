"""Invalid queries are rejected with a pointer, in a short response without the input."""

import json
import re

import httpx
import pytest

from mdr_service import problems
from mdr_service.problems import MAX_ERRORS, MEDIA_TYPE
from mdr_service.settings import SETTINGS
from tests.conftest import Client

BALL = '{"kind": "paraboloid", "radius": 0.01}'
MODULUS = '{"e_star": 1e9}'
FORCE = '{"normal_force": 1}'


def query(profile: str = BALL, material: str = MODULUS, load: str = FORCE, more: str = "") -> bytes:
    return f'{{"profile": {profile}, "material": {material}, "load": {load}{more}}}'.encode()


def table(r: str, f: str) -> str:
    return f'{{"kind": "tabulated", "r": {r}, "f": {f}}}'


def problem(response: httpx.Response) -> dict[str, object]:
    assert response.headers["content-type"] == MEDIA_TYPE
    assert len(response.content) <= 4096
    document = response.json()
    assert document["status"] == response.status_code
    assert document["type"].startswith("urn:mdr:problem:")
    assert document["title"]
    assert document["detail"]
    # Sentences of pydantic begin with these words.
    assert not re.search(r"Input should|Field required|after validation", response.text)
    return document


def pointers(response: httpx.Response) -> list[str]:
    return [error["pointer"] for error in problem(response)["errors"]]


STEEL = '{"youngs_modulus": 210e9, "poissons_ratio": 0.3}'
NORMAL_QUERIES = {
    # non-finite numbers
    "NaN": (query(load='{"normal_force": NaN}'), "/load/normal_force"),
    "Infinity": (query(load='{"normal_force": Infinity}'), "/load/normal_force"),
    "-Infinity": (query(load='{"normal_force": -Infinity}'), "/load/normal_force"),
    "NaN in a list": (query(load='{"normal_force": [1, NaN]}'), "/load/normal_force/1"),
    "1e999": (query(BALL.replace("0.01", "1e999")), "/profile/radius"),
    "1e300 above the bound": (query(BALL.replace("0.01", "1e300")), "/profile/radius"),
    "a string": (query(load='{"normal_force": "5"}'), "/load/normal_force"),
    "a string in a list": (query(load='{"normal_force": [1, "5"]}'), "/load/normal_force/1"),
    "true": (query(load='{"normal_force": true}'), "/load/normal_force"),
    "true in a list": (query(load='{"normal_force": [true]}'), "/load/normal_force/0"),
    "null": (query(load='{"normal_force": null}'), "/load/normal_force"),
    "null in a list": (query(load='{"normal_force": [null]}'), "/load/normal_force/0"),
    "null modulus": (query(material='{"e_star": 1, "g_star": null}'), "/material/g_star"),
    "a thousand digits": (query(load=f'{{"normal_force": {"7" * 1000}}}'), "/load/normal_force"),
    "a thousand digits in a list": (
        query(load=f'{{"normal_force": [1, -{"7" * 1000}]}}'),
        "/load/normal_force/1",
    ),
    "1e51": (query(BALL.replace("0.01", "1e51")), "/profile/radius"),
    "1e-51": (query(BALL.replace("0.01", "1e-51")), "/profile/radius"),
    "1e51 in a list": (query(load='{"normal_force": [1, 1e51]}'), "/load/normal_force/1"),
    "a tiny coefficient": (
        query('{"kind": "series", "terms": [{"coefficient": -1e-51, "exponent": 2}]}'),
        "/profile/terms/0/coefficient",
    ),
    "a tiny radius of a table": (
        query('{"kind": "tabulated", "r": [0, 1e-60, 1], "f": [0, 1, 2]}'),
        "/profile/r/1",
    ),
    # structure of the request
    "two dimensions": (query(load='{"normal_force": [[1, 2]]}'), "/load/normal_force/0"),
    "an empty list": (query(load='{"normal_force": []}'), "/load/normal_force"),
    "an unknown field": (query(more=', "mu": 0.3'), "/mu"),
    "an unknown parameter": (query('{"kind": "cone", "slope": 1, "tip": 1}'), "/profile/tip"),
    "a field to be escaped": (query(more=', "a/b~c": 0.3'), "/a~1b~0c"),
    "an unknown kind": (query('{"kind": "pyramid"}'), "/profile/kind"),
    "no kind": (query('{"radius": 1}'), "/profile/kind"),
    "a kind that is a number": (query('{"kind": 5}'), "/profile/kind"),
    "a missing parameter": (query('{"kind": "cone"}'), "/profile/slope"),
    "a profile that is a string": (query('"cone"'), "/profile"),
    "two controls": (query(load='{"normal_force": 1, "contact_radius": 1}'), "/load"),
    "no control": (query(load="{}"), "/load"),
    "no load": (f'{{"profile": {BALL}, "material": {MODULUS}}}'.encode(), "/load"),
    "no material": (query(material="{}"), "/material/e_star"),
    "two materials": (
        query(material=f'{{"bodies": ["rigid", {STEEL}], "e_star": 1}}'),
        "/material/e_star",
    ),
    "one body": (query(material=f'{{"bodies": [{STEEL}]}}'), "/material/bodies"),
    "an unknown word for a body": (
        query(material=f'{{"bodies": [{STEEL}, "soft"]}}'),
        "/material/bodies/1",
    ),
    "a request that is a list": (b"[1]", ""),
    "nested 100 deep": (query(load="[" * 100 + "]" * 100), "/load"),
    "a term's exponent": (
        query('{"kind": "series", "terms": [{"coefficient": 1, "exponent": "2"}]}'),
        "/profile/terms/0/exponent",
    ),
    # physics
    "a negative depth": (query(load='{"indentation_depth": -1e-6}'), "/load/indentation_depth"),
    "a negative depth in a list": (
        query(load='{"indentation_depth": [0, -1e-6]}'),
        "/load/indentation_depth/1",
    ),
    "a tiny load": (query(load='{"normal_force": 5e-324}'), "/load/normal_force"),
    "a tiny load in a list": (
        query(load='{"normal_force": [0, 5e-324]}'),
        "/load/normal_force/1",
    ),
    "two rigid bodies": (query(material='{"bodies": ["rigid", "rigid"]}'), "/material/bodies"),
    "Poisson's ratio": (
        query(material=f'{{"bodies": ["rigid", {STEEL.replace("0.3", "0.6")}]}}'),
        "/material/bodies/1/poissons_ratio",
    ),
    "a contact up to the equator": (
        query('{"kind": "sphere", "radius": 1}', load='{"contact_radius": 1}'),
        "/load/contact_radius",
    ),
    "a contact beyond the equator, in a list": (
        query('{"kind": "sphere", "radius": 1}', load='{"contact_radius": [0.5, 2]}'),
        "/load/contact_radius/1",
    ),
    "beyond the end of a table": (
        query(table("[0, 1, 2]", "[0, 1, 4]"), load='{"contact_radius": [1, 2.5]}'),
        "/load/contact_radius/1",
    ),
    "beyond the end of a table by depth": (
        query(table("[0, 1, 2]", "[0, 1, 4]"), load='{"indentation_depth": 100}'),
        "/load/indentation_depth",
    ),
    "a result that overflows": (
        query(
            '{"kind": "power", "coefficient": 1, "exponent": 100}',
            load='{"contact_radius": [1, 1e5]}',
        ),
        "/load/contact_radius/1",
    ),
    "a tolerance too tight": (query(more=', "rtol": 1e-16'), "/rtol"),
    "a decreasing curvature": (
        query('{"kind": "capped_paraboloid", "cap_radius": 1, "tip_radius": 1, "radius": 2}'),
        "/profile/radius",
    ),
}


@pytest.mark.parametrize("name", NORMAL_QUERIES)
def test_invalid_normal_query_is_rejected_with_a_pointer(client: Client, name: str) -> None:
    body, pointer = NORMAL_QUERIES[name]
    response = client.post_text("/v1/normal", body)
    assert response.status_code == 422
    assert pointers(response) == [pointer]


@pytest.mark.parametrize("load", ["{}", '{"normal_force": 1, "contact_radius": 1}'])
def test_missing_control_is_named(client: Client, load: str) -> None:
    (error,) = client.post_text("/v1/normal", query(load=load)).json()["errors"]
    controls = "indentation_depth, normal_force, contact_radius"
    assert error["detail"] == f"exactly one of {controls} is needed"


def test_amplitude_is_no_control(client: Client) -> None:
    body = history_query(cycles_(normal='{"amplitude": 1}'))
    (error,) = client.post_text("/v1/tangential/history", body).json()["errors"]
    assert error["detail"] == "exactly one of indentation_depth, normal_force is needed"


SHEARED = '{"e_star": 1e9, "g_star": 8e8}'
TANGENTIAL_FORCE = '{"tangential_force": 0.1}'


def tangential_query(
    tangential: str = TANGENTIAL_FORCE,
    friction: str = "0.3",
    material: str = SHEARED,
    load: str = FORCE,
) -> bytes:
    more = f', "friction_coefficient": {friction}, "tangential": {tangential}'
    return query(material=material, load=load, more=more)


def fields(
    quantities: str = '["pressure"]', more: str = ', "radius": [0]', material: str = MODULUS
) -> bytes:
    return query(material=material, more=f', "quantities": {quantities}{more}')


FRICTION = f', "friction_coefficient": 0.3, "tangential": {TANGENTIAL_FORCE}, "radius": [0]'


def history(
    normal: str = '{"normal_force": [1, 2]}',
    tangential: str = '{"tangential_force": [0, 0.1]}',
    more: str = "",
    name: str = "history",
) -> str:
    return f', "{name}": {{"normal": {normal}, "tangential": {tangential}{more}}}'


def cycles_(
    normal: str = '{"normal_force": 1}',
    tangential: str = '{"tangential_force": 0.1}',
    more: str = "",
) -> str:
    return history(normal, tangential, more, "cycles")


def history_query(*histories: str, profile: str = BALL, material: str = SHEARED) -> bytes:
    friction = ', "friction_coefficient": 0.3'
    return (
        f'{{"profile": {profile}, "material": {material}{friction}{"".join(histories)}}}'.encode()
    )


def stress_at_end(*histories: str, more: str = ', "friction_coefficient": 0.3') -> bytes:
    fields_ = '"quantities": ["slip"], "radius": [0]'
    body = f'"profile": {BALL}, "material": {SHEARED}, {fields_}{more}{"".join(histories)}'
    return f"{{{body}}}".encode()


def wear_query(
    load: str = FORCE,
    oscillation: str = TANGENTIAL_FORCE,
    more: str = "",
    profile: str = BALL,
    material: str = SHEARED,
) -> bytes:
    friction = ', "friction_coefficient": 0.3'
    return query(profile, material, load, f'{friction}, "oscillation": {oscillation}{more}')


def evolution_query(
    load: str = FORCE,
    oscillation: str = TANGENTIAL_FORCE,
    more: str = "",
    cycles: str = "[1, 2]",
    coefficient: str = "1e-14",
) -> bytes:
    over = f', "cycles": {cycles}, "wear_coefficient": {coefficient}'
    return wear_query(load, oscillation, over + more)


TANGENTIAL_FORCES = "/history/tangential/tangential_force"
OTHER_QUERIES = {
    # friction
    "a yield strength of zero": (
        "normal",
        query(material='{"e_star": 1e9, "yield_strength": 0}'),
        "/material/yield_strength",
    ),
    "no shear modulus": ("tangential", tangential_query(material=MODULUS), "/material/g_star"),
    "a negative shear modulus": (
        "tangential",
        tangential_query(material=SHEARED.replace("8e8", "-8e8")),
        "/material/g_star",
    ),
    "two rigid bodies": (
        "tangential",
        tangential_query(material='{"bodies": ["rigid", "rigid"]}'),
        "/material/bodies",
    ),
    "no friction": ("tangential", tangential_query(friction="0"), "/friction_coefficient"),
    "negative friction": ("tangential", tangential_query(friction="-0.3"), "/friction_coefficient"),
    "friction that is a list": (
        "tangential",
        tangential_query(friction="[0.3]"),
        "/friction_coefficient",
    ),
    "friction that is NaN": (
        "tangential",
        tangential_query(friction="NaN"),
        "/friction_coefficient",
    ),
    "no tangential load": ("tangential", query(more=', "friction_coefficient": 1'), "/tangential"),
    "no tangential control": ("tangential", tangential_query("{}"), "/tangential"),
    "two tangential controls": (
        "tangential",
        tangential_query('{"tangential_force": 0, "stick_radius": 0}'),
        "/tangential",
    ),
    "an unknown tangential control": (
        "tangential",
        tangential_query('{"force": 0}'),
        "/tangential/force",
    ),
    "a tangential force beyond friction": (
        "tangential",
        tangential_query('{"tangential_force": 0.31}'),
        "/tangential/tangential_force",
    ),
    "a negative force beyond friction, in a list": (
        "tangential",
        tangential_query('{"tangential_force": [0.1, 0, 0.3, -0.31]}'),
        "/tangential/tangential_force/3",
    ),
    "a tangential force beyond the friction of one load": (
        "tangential",
        tangential_query('{"tangential_force": 0.5}', load='{"normal_force": [2, 1]}'),
        "/tangential/tangential_force",
    ),
    "a tangential load that is a string": (
        "tangential",
        tangential_query('{"tangential_force": [0, "1"]}'),
        "/tangential/tangential_force/1",
    ),
    "a tangential load of 1e999": (
        "tangential",
        tangential_query('{"tangential_displacement": -1e999}'),
        "/tangential/tangential_displacement",
    ),
    "a tangential load of null": (
        "tangential",
        tangential_query('{"stick_radius": [null]}'),
        "/tangential/stick_radius/0",
    ),
    "an empty list of tangential loads": (
        "tangential",
        tangential_query('{"stick_radius": []}'),
        "/tangential/stick_radius",
    ),
    "a stick radius outside the contact": (
        "tangential",
        tangential_query('{"stick_radius": [0, 0.2]}'),
        "/tangential/stick_radius/1",
    ),
    "a negative stick radius": (
        "tangential",
        tangential_query('{"stick_radius": -1e-9}'),
        "/tangential/stick_radius",
    ),
    "three tangential loads for two loads": (
        "tangential",
        tangential_query('{"tangential_force": [0, 0, 0]}', load='{"normal_force": [1, 1]}'),
        "/tangential/tangential_force",
    ),
    # histories
    "no history": ("tangential/history", history_query(), "/history"),
    "two histories": ("tangential/history", history_query(history(), cycles_()), "/cycles"),
    "a null history": ("tangential/history", history_query(', "history": null'), "/history"),
    "a history that is a list": (
        "tangential/history",
        history_query(', "history": []'),
        "/history",
    ),
    "a history without friction": (
        "tangential/history",
        history_query(history()).replace(b'"friction_coefficient": 0.3, ', b""),
        "/friction_coefficient",
    ),
    "a history without a shear modulus": (
        "tangential/history",
        history_query(history(), material=MODULUS),
        "/material/g_star",
    ),
    "a history with a load": (
        "tangential/history",
        history_query(history(), f', "load": {FORCE}'),
        "/load",
    ),
    "two normal controls": (
        "tangential/history",
        history_query(history('{"normal_force": 1, "indentation_depth": 1}')),
        "/history/normal",
    ),
    "no tangential control of a history": (
        "tangential/history",
        history_query(history(tangential="{}")),
        "/history/tangential",
    ),
    "a history of contact radii": (
        "tangential/history",
        history_query(history('{"contact_radius": [1, 2]}')),
        "/history/normal/contact_radius",
    ),
    "three tangential loads for two points": (
        "tangential/history",
        history_query(history(tangential='{"tangential_force": [0, 0, 0]}')),
        TANGENTIAL_FORCES,
    ),
    "no points": (
        "tangential/history",
        history_query(history('{"normal_force": []}')),
        "/history/normal/normal_force",
    ),
    "no tangential load of a history": (
        "tangential/history",
        history_query(history(tangential='{"tangential_force": []}')),
        TANGENTIAL_FORCES,
    ),
    "a point of NaN": (
        "tangential/history",
        history_query(history('{"normal_force": [1, NaN]}')),
        "/history/normal/normal_force/1",
    ),
    "a depth of Infinity": (
        "tangential/history",
        history_query(history('{"indentation_depth": [1e-6, -Infinity]}')),
        "/history/normal/indentation_depth/1",
    ),
    "a tangential load of a history that is a string": (
        "tangential/history",
        history_query(history(tangential='{"tangential_force": [0, "1"]}')),
        f"{TANGENTIAL_FORCES}/1",
    ),
    "a tangential load of true": (
        "tangential/history",
        history_query(history(tangential='{"tangential_force": true}')),
        TANGENTIAL_FORCES,
    ),
    "a negative normal force": (
        "tangential/history",
        history_query(history('{"normal_force": [1, -1]}')),
        "/history/normal/normal_force/1",
    ),
    "a tiny point": (
        "tangential/history",
        history_query(history('{"indentation_depth": [1e-6, -1e-300]}')),
        "/history/normal/indentation_depth/1",
    ),
    "a history beyond the end of a table": (
        "tangential/history",
        history_query(
            history('{"indentation_depth": [1, 100]}', '{"tangential_displacement": 0}'),
            profile=table("[0, 1, 2]", "[0, 1, 4]"),
        ),
        "/history/normal/indentation_depth/1",
    ),
    "a single point beyond the end of a table": (
        "tangential/history",
        history_query(
            history('{"indentation_depth": 100}', '{"tangential_displacement": [0, 1]}'),
            profile=table("[0, 1, 2]", "[0, 1, 4]"),
        ),
        "/history/normal/indentation_depth",
    ),
    "a tangential force beyond friction at a point": (
        "tangential/history",
        history_query(history(tangential='{"tangential_force": [0, 0.61]}')),
        f"{TANGENTIAL_FORCES}/1",
    ),
    "a single tangential force beyond friction": (
        "tangential/history",
        history_query(history(tangential='{"tangential_force": -0.31}')),
        TANGENTIAL_FORCES,
    ),
    "a tangential force beyond friction between two points": (
        "tangential/history",
        history_query(
            history(
                '{"indentation_depth": [1e-6, 0, 1e-6]}',
                '{"tangential_force": [0, 0, 0.011]}',
                ', "samples_per_step": 50',
            )
        ),
        f"{TANGENTIAL_FORCES}/2",
    ),
    "no samples": (
        "tangential/history",
        history_query(history(more=', "samples_per_step": 0')),
        "/history/samples_per_step",
    ),
    "half a sample": (
        "tangential/history",
        history_query(history(more=', "samples_per_step": 1.5')),
        "/history/samples_per_step",
    ),
    "too many samples": (
        "tangential/history",
        history_query(history(more=f', "samples_per_step": {SETTINGS.max_length}')),
        "/history/samples_per_step",
    ),
    "too many points of a history": (
        "tangential/history",
        history_query(history(f'{{"normal_force": [{"1," * SETTINGS.max_length}1]}}')),
        "/history/normal/normal_force",
    ),
    "an unknown field of a history": (
        "tangential/history",
        history_query(history(more=', "count": 2')),
        "/history/count",
    ),
    # cycles
    "a cycle beyond friction": (
        "tangential/history",
        history_query(cycles_(tangential='{"tangential_force": 0.31}')),
        "/cycles/tangential/tangential_force",
    ),
    "a cycle beyond friction in phase": (
        "tangential/history",
        history_query(cycles_('{"normal_force": 1, "amplitude": 0.9}')),
        "/cycles/tangential/tangential_force",
    ),
    "an amplitude larger than the mean": (
        "tangential/history",
        history_query(cycles_('{"normal_force": 1, "amplitude": 1.1}')),
        "/cycles/normal/amplitude",
    ),
    "an amplitude of NaN of the normal load": (
        "tangential/history",
        history_query(cycles_('{"normal_force": 1, "amplitude": NaN}')),
        "/cycles/normal/amplitude",
    ),
    "a tiny amplitude": (
        "tangential/history",
        history_query(cycles_('{"normal_force": 1, "amplitude": 1e-300}')),
        "/cycles/normal/amplitude",
    ),
    "an amplitude about zero": (
        "tangential/history",
        history_query(cycles_('{"amplitude": 1}')),
        "/cycles/normal",
    ),
    "a list of cycles": (
        "tangential/history",
        history_query(cycles_('{"normal_force": [1, 2]}')),
        "/cycles/normal/normal_force",
    ),
    "cycles of no force": (
        "tangential/history",
        history_query(cycles_(tangential='{"tangential_force": 0}')),
        "/cycles/tangential/tangential_force",
    ),
    "two amplitudes": (
        "tangential/history",
        history_query(cycles_(tangential='{"tangential_force": 1, "tangential_displacement": 1}')),
        "/cycles/tangential",
    ),
    "no cycles": (
        "tangential/history",
        history_query(cycles_(more=', "count": 0')),
        "/cycles/count",
    ),
    "cycles beyond the end of a table": (
        "tangential/history",
        history_query(
            cycles_('{"indentation_depth": 100}', '{"tangential_displacement": 1}'),
            profile=table("[0, 1, 2]", "[0, 1, 4]"),
        ),
        "/cycles/normal/indentation_depth",
    ),
    # fields at the end of a history
    "a history and a load": ("stress", stress_at_end(history(), f', "load": {FORCE}'), "/history"),
    "a history and a tangential load": (
        "stress",
        stress_at_end(history(), f', "tangential": {TANGENTIAL_FORCE}'),
        "/tangential",
    ),
    "fields of a history without friction": (
        "stress",
        stress_at_end(history(), more=""),
        "/friction_coefficient",
    ),
    "fields at the end of cycles": ("stress", stress_at_end(cycles_()), "/cycles"),
    "an end beyond friction": (
        "stress",
        stress_at_end(history(tangential='{"tangential_force": [0, 0.61]}')),
        f"{TANGENTIAL_FORCES}/1",
    ),
    # wear
    "wear by a contact radius": (
        "wear",
        wear_query('{"contact_radius": 1}'),
        "/load/contact_radius",
    ),
    "wear under two loads": (
        "wear",
        wear_query('{"normal_force": 1, "indentation_depth": 1}'),
        "/load",
    ),
    "wear under no load": ("wear", wear_query("{}"), "/load"),
    "wear by two amplitudes": (
        "wear",
        wear_query(oscillation='{"tangential_force": 1, "tangential_displacement": 1}'),
        "/oscillation",
    ),
    "wear by no amplitude": ("wear", wear_query(oscillation="{}"), "/oscillation"),
    "wear by a stick radius": (
        "wear",
        wear_query(oscillation='{"stick_radius": 1e-6}'),
        "/oscillation/stick_radius",
    ),
    "wear without a shear modulus": ("wear", wear_query(material=MODULUS), "/material/g_star"),
    "wear without friction": (
        "wear",
        wear_query().replace(b'"friction_coefficient": 0.3, ', b""),
        "/friction_coefficient",
    ),
    "a negative amplitude": (
        "wear",
        wear_query(oscillation='{"tangential_force": -0.1}'),
        "/oscillation/tangential_force",
    ),
    "a negative amplitude in a list": (
        "wear",
        wear_query(oscillation='{"tangential_force": [0, -0.1]}'),
        "/oscillation/tangential_force/1",
    ),
    "an amplitude of NaN": (
        "wear",
        wear_query(oscillation='{"tangential_displacement": [0, NaN]}'),
        "/oscillation/tangential_displacement/1",
    ),
    "an amplitude beyond friction": (
        "wear",
        wear_query(oscillation='{"tangential_force": 0.31}'),
        "/oscillation/tangential_force",
    ),
    "an amplitude beyond friction in a list": (
        "wear",
        wear_query(oscillation='{"tangential_force": [0.2, 0.31]}'),
        "/oscillation/tangential_force/1",
    ),
    "a force beyond the capacity at constant depth": (
        "wear",
        wear_query('{"indentation_depth": 1e-6}', '{"tangential_force": 0.39}'),
        "/oscillation/tangential_force",
    ),
    "two amplitudes for three loads": (
        "wear",
        wear_query('{"normal_force": [1, 1, 1]}', '{"tangential_force": [0, 0.1]}'),
        "/oscillation/tangential_force",
    ),
    "a tiny load of wear": (
        "wear",
        wear_query('{"normal_force": 1e-300}'),
        "/load/normal_force",
    ),
    "wear beyond the end of a table": (
        "wear",
        wear_query(
            '{"indentation_depth": [0.1, 7.5]}',
            '{"tangential_displacement": 1}',
            profile=table("[0, 1, 2]", "[0, 1, 4]"),
        ),
        "/load/indentation_depth/1",
    ),
    "a radius beyond the end of a table": (
        "wear",
        wear_query(more=', "radius": [1, 3]', profile=table("[0, 1, 2]", "[0, 1, 4]")),
        "/radius/1",
    ),
    "wear at radii and points": (
        "wear",
        wear_query(more=', "radius": [0], "points": 9'),
        "/points",
    ),
    "wear over no radii": ("wear", wear_query(more=', "quantities": ["pressure"]'), "/radius"),
    "wear at a negative radius": ("wear", wear_query(more=', "radius": [-1]'), "/radius/0"),
    "a field without a limit": (
        "wear",
        wear_query(more=', "radius": [0], "quantities": ["profile"]'),
        "/quantities/0",
    ),
    "a repeated field of wear": (
        "wear",
        wear_query(more=', "radius": [0], "quantities": ["pressure", "pressure"]'),
        "/quantities",
    ),
    "fewer points than edges": ("wear", wear_query(more=', "points": 3'), "/points"),
    # wear over the cycles
    "cycles under many loads": (
        "wear/evolution",
        evolution_query('{"normal_force": [1, 2]}'),
        "/load/normal_force",
    ),
    "cycles by many amplitudes": (
        "wear/evolution",
        evolution_query(oscillation='{"tangential_force": [0.1, 0.2]}'),
        "/oscillation/tangential_force",
    ),
    "cycles by a contact radius": (
        "wear/evolution",
        evolution_query('{"contact_radius": 1}'),
        "/load/contact_radius",
    ),
    "cycles by two controls": (
        "wear/evolution",
        evolution_query('{"normal_force": 1, "indentation_depth": 1}'),
        "/load",
    ),
    "a negative wear coefficient": (
        "wear/evolution",
        evolution_query(coefficient="-1e-14"),
        "/wear_coefficient",
    ),
    "no wear coefficient": (
        "wear/evolution",
        wear_query(more=', "cycles": [1]'),
        "/wear_coefficient",
    ),
    "no numbers of cycles": ("wear/evolution", evolution_query(cycles="[]"), "/cycles"),
    "cycles that are not a list": ("wear/evolution", evolution_query(cycles="1"), "/cycles"),
    "cycles of NaN": ("wear/evolution", evolution_query(cycles="[1, NaN]"), "/cycles/1"),
    "negative cycles": ("wear/evolution", evolution_query(cycles="[-1, 1]"), "/cycles/0"),
    "decreasing cycles": ("wear/evolution", evolution_query(cycles="[1, 3, 2]"), "/cycles/2"),
    "very many cycles": ("wear/evolution", evolution_query(cycles="[1, 1.1e12]"), "/cycles/1"),
    "too many numbers of cycles": (
        "wear/evolution",
        evolution_query(cycles=f"[{'1,' * SETTINGS.max_length}1]"),
        "/cycles",
    ),
    "cycles beyond friction": (
        "wear/evolution",
        evolution_query(oscillation='{"tangential_force": 0.31}'),
        "/oscillation/tangential_force",
    ),
    "cycles of a force at constant depth": (
        "wear/evolution",
        evolution_query('{"indentation_depth": 1e-6}'),
        "/oscillation/tangential_force",
    ),
    "cycles without an amplitude": (
        "wear/evolution",
        evolution_query(oscillation='{"tangential_force": 0}'),
        "/oscillation/tangential_force",
    ),
    "too coarse": ("wear/evolution", evolution_query(more=', "resolution": 7'), "/resolution"),
    "too fine": ("wear/evolution", evolution_query(more=', "resolution": 97'), "/resolution"),
    "half a node": ("wear/evolution", evolution_query(more=', "resolution": 8.5'), "/resolution"),
    "too tight a tolerance": ("wear/evolution", evolution_query(more=', "rtol": 1e-11'), "/rtol"),
    "the limiting profile of an evolution": (
        "wear/evolution",
        evolution_query(more=', "radius": [0], "quantities": ["limiting_profile"]'),
        "/quantities/0",
    ),
    # fields
    "neither a load nor a history": (
        "stress",
        stress_at_end(more=""),
        "/load",
    ),
    "no quantities": ("stress", query(more=', "radius": [0]'), "/quantities"),
    "an empty list of quantities": ("stress", fields("[]"), "/quantities"),
    "an unknown quantity": ("stress", fields('["pressure", "heat"]'), "/quantities/1"),
    "a repeated quantity": ("stress", fields('["pressure", "pressure"]'), "/quantities"),
    "shear without friction": ("stress", fields('["pressure", "slip"]'), "/quantities/1"),
    "shear without a modulus": (
        "stress",
        fields('["slip"]', FRICTION),
        "/material/g_star",
    ),
    "friction without a tangential load": (
        "stress",
        fields(more=', "radius": [0], "friction_coefficient": 0.3'),
        "/tangential",
    ),
    "a tangential load without friction": (
        "stress",
        fields(more=f', "radius": [0], "tangential": {TANGENTIAL_FORCE}'),
        "/friction_coefficient",
    ),
    "no radii": ("stress", fields(more=""), "/radius"),
    "radii and points": ("stress", fields(more=', "radius": [0], "points": 2'), "/points"),
    "an empty list of radii": ("stress", fields(more=', "radius": []'), "/radius"),
    "a radius that is not a list": ("stress", fields(more=', "radius": 0'), "/radius"),
    "a negative radius": ("stress", fields(more=', "radius": [0, -1e-9]'), "/radius/1"),
    "a radius of NaN": ("stress", fields(more=', "radius": [0, NaN]'), "/radius/1"),
    "a radius of true": ("stress", fields(more=', "radius": [true]'), "/radius/0"),
    "one point": ("stress", fields(more=', "points": 1'), "/points"),
    "fewer points than edges of a field": (
        "stress",
        query(
            '{"kind": "truncated_cone", "flat_radius": 1, "slope": 1}',
            load='{"normal_force": [1e9, 2e9, 3e9]}',
            more=', "quantities": ["pressure"], "points": 5',
        ),
        "/points",
    ),
    "half a point": ("stress", fields(more=', "points": 2.5'), "/points"),
    "too many points": ("stress", fields(more=', "points": 1000000000'), "/points"),
    "too many radii": (
        "stress",
        fields(more=f', "radius": [{"0," * SETTINGS.max_length}0]'),
        "/radius",
    ),
    "null for friction": (
        "stress",
        fields(more=', "radius": [0], "friction_coefficient": null'),
        "/friction_coefficient",
    ),
}


@pytest.mark.parametrize("name", OTHER_QUERIES)
def test_invalid_query_is_rejected_with_a_pointer(client: Client, name: str) -> None:
    path, body, pointer = OTHER_QUERIES[name]
    response = client.post_text(f"/v1/{path}", body)
    assert response.status_code == 422
    assert pointers(response) == [pointer]


@pytest.mark.parametrize("path", ["/v1/tangential", "/v1/stress"])
@pytest.mark.parametrize("name", ["NaN", "a string in a list", "two controls", "no kind"])
def test_shared_members_are_validated_by_every_query(client: Client, path: str, name: str) -> None:
    body, pointer = NORMAL_QUERIES[name]
    response = client.post_text(path, body)
    assert response.status_code == 422
    assert pointer in pointers(response)


@pytest.mark.parametrize(
    ("r", "f"),
    [("[0, 1, 2]", "[0, 2, 1]"), ("[0, 2, 1]", "[0, 1, 2]"), ("[0, 1, 2]", "[0, 1]")],
    ids=["falling", "radii not in order", "lengths that differ"],
)
def test_invalid_table_is_rejected(client: Client, r: str, f: str) -> None:
    response = client.post_text("/v1/normal", query(table(r, f)))
    assert response.status_code == 422
    assert all(pointer.startswith("/profile") for pointer in pointers(response))


NOT_JSON = {
    "words": b"hello",
    "nothing": b"",
    "half": query()[:-1],
    "nested 100000 deep": b"[" * 100_000,
    "nested 100000 deep in a field": query(load="[" * 100_000 + "]" * 100_000),
    "half a surrogate": query(BALL.replace("paraboloid", "\\ud800")),
    "half a surrogate in a name": query(more=', "\\ud800": 1'),
    "not UTF-8": query(more=', "') + b'\xff": 1}',
    "more digits than the parser takes": query(load=f'{{"normal_force": {"7" * 5000}}}'),
}


@pytest.mark.parametrize("name", NOT_JSON)
def test_malformed_json_is_rejected(client: Client, name: str) -> None:
    response = client.post_text("/v1/normal", NOT_JSON[name])
    assert response.status_code == 400
    assert pointers(response) == [""]


def test_problem_does_not_repeat_the_input(client: Client) -> None:
    secret = "s3cret" * 20
    bodies = [
        query(f'{{"kind": "{secret}"}}'),
        query(load=f'{{"normal_force": "{secret}"}}'),
        query(more=f', "{secret}": 1'),
        secret.encode(),
    ]
    for body in bodies:
        assert b"s3cret" not in client.post_text("/v1/normal", body).content


@pytest.mark.parametrize(
    ("radius", "detail"),
    [
        (-1.0, "must be positive, at least 1e-50"),
        (1e60, "must be at most 1e+50"),
    ],
)
def test_bounds_are_stated_in_short(client: Client, radius: float, detail: str) -> None:
    query = {
        "profile": {"kind": "paraboloid", "radius": radius},
        "material": {"e_star": 1.0},
        "load": {"normal_force": 1.0},
    }
    errors = client.post("/v1/normal", query).json()["errors"]
    assert errors == [{"pointer": "/profile/radius", "detail": detail}]


def test_unknown_parameter_lists_those_that_there_are(client: Client) -> None:
    response = client.get("/v1/normal?kind=paraboloid&radius=1&e_star=1&normal_force=1&force=1")
    (error,) = response.json()["errors"]
    assert error["pointer"] == "/force"
    listed = error["detail"].removeprefix("there is no such member; there are ").split(", ")
    assert set(listed) >= {"kind", "radius", "e_star", "youngs_modulus_1", "normal_force", "n"}


def test_pointer_ends_before_a_name_longer_than_any_field() -> None:
    longest = "x" * problems.MAX_NAME
    assert problems.pointer(["profile", longest]) == f"/profile/{longest}"
    assert problems.pointer(["profile", f"{longest}x", "kind"]) == "/profile"


def test_number_of_errors_is_limited(client: Client) -> None:
    many = "".join(f', "{"unknown" * 8}{i}": 1' for i in range(10_000))
    response = client.post_text("/v1/normal", query(more=many))
    assert 1 <= len(pointers(response)) <= MAX_ERRORS
    exactly = "".join(f', "u{i}": 1' for i in range(30))
    assert len(pointers(client.post_text("/v1/normal", query(more=exactly)))) == MAX_ERRORS


def test_problem_of_ten_thousand_errors_is_short(client: Client) -> None:
    bad = json.dumps({"normal_force": ["x"] * 10_000})
    assert pointers(client.post_text("/v1/normal", query(load=bad))) == ["/load/normal_force/0"]


def test_list_at_the_limit_is_accepted(client: Client) -> None:
    def loads(count: int) -> bytes:
        return query(load=json.dumps({"normal_force": [1.0] * count}))

    response = client.post_text("/v1/normal", loads(SETTINGS.max_length))
    assert len(response.json()["contact_radius"]) == SETTINGS.max_length
    response = client.post_text("/v1/normal", loads(SETTINGS.max_length + 1))
    assert pointers(response) == ["/load/normal_force"]


def test_long_body_is_rejected(client: Client) -> None:
    response = client.post_text("/v1/normal", b" " * (SETTINGS.max_body_bytes + 1))
    assert response.status_code == 413
    problem(response)


def test_body_at_the_limit_is_accepted(client: Client) -> None:
    text = f'{{"profile": {BALL}, "material": {{"e_star": 1}}, "load": {{"normal_force": 1}}}}'
    body = text.encode().ljust(SETTINGS.max_body_bytes)
    assert client.post_text("/v1/normal", body).status_code == 200


@pytest.mark.parametrize("media_type", ["text/plain", "application/x-www-form-urlencoded", ""])
def test_other_content_types_are_rejected(client: Client, media_type: str) -> None:
    headers = {"content-type": media_type}
    response = client.request("POST", "/v1/normal", content=query(), headers=headers)
    assert response.status_code == 415
    problem(response)


@pytest.mark.parametrize("media_type", ["application/json; charset=utf-8", "Application/JSON"])
def test_variants_of_the_json_content_type_are_accepted(client: Client, media_type: str) -> None:
    headers = {"content-type": media_type}
    response = client.request("POST", "/v1/normal", content=query(), headers=headers)
    assert response.status_code == 200


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/nothing", 404),
        ("GET", "/docs/swagger/nothing.js", 404),
        ("GET", "/v1/wear/evolution", 405),
        ("PUT", "/v1/normal", 405),
        ("DELETE", "/health", 405),
        ("POST", "/docs/swagger/swagger-ui.css", 405),
    ],
)
def test_unknown_endpoint_is_a_problem(client: Client, method: str, path: str, status: int) -> None:
    response = client.request(method, path)
    assert response.status_code == status
    assert ("allow" in response.headers) == (status == 405)
    problem(response)


@pytest.mark.parametrize(
    ("path", "methods"),
    [
        ("/v1/normal", "GET, HEAD, POST"),
        ("/v1/wear/evolution", "POST"),
        ("/health", "GET, HEAD"),
        ("/explorer/main.js", "GET, HEAD"),
        ("/docs/page/docs.css", "GET, HEAD"),
    ],
)
def test_allow_header_lists_the_methods(client: Client, path: str, methods: str) -> None:
    assert client.request("PUT", path).headers["allow"] == methods


@pytest.mark.parametrize("path", ["/", "/health", "/docs", "/openapi.json", "/v1/profiles"])
def test_head_is_allowed_where_get_is(client: Client, path: str) -> None:
    get, head = client.request("GET", path), client.request("HEAD", path)
    assert head.status_code == get.status_code
    assert head.headers["content-type" if get.content else "location"]
