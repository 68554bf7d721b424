"""What cannot be answered is refused by pointing at it, in few bytes, without repeating it."""

import json

import httpx
import pytest

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


def problem(answer: httpx.Response) -> dict[str, object]:
    assert answer.headers["content-type"] == MEDIA_TYPE
    assert len(answer.content) <= 4096
    document = answer.json()
    assert document["status"] == answer.status_code
    assert document["type"].startswith("urn:mdr:problem:")
    assert document["title"]
    assert document["detail"]
    return document


def pointers(answer: httpx.Response) -> list[str]:
    return [error["pointer"] for error in problem(answer)["errors"]]


STEEL = '{"youngs_modulus": 210e9, "poissons_ratio": 0.3}'
POINTED = {
    # numbers that are none
    "NaN": (query(load='{"normal_force": NaN}'), "/load/normal_force"),
    "Infinity": (query(load='{"normal_force": Infinity}'), "/load/normal_force"),
    "-Infinity": (query(load='{"normal_force": -Infinity}'), "/load/normal_force"),
    "NaN in a list": (query(load='{"normal_force": [1, NaN]}'), "/load/normal_force/1"),
    "1e999": (query(BALL.replace("0.01", "1e999")), "/profile/radius"),
    "1e300 beyond the bound": (query(BALL.replace("0.01", "1e300")), "/profile/radius"),
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
    # shapes of the request
    "two dimensions": (query(load='{"normal_force": [[1, 2]]}'), "/load/normal_force/0"),
    "an empty list": (query(load='{"normal_force": []}'), "/load/normal_force"),
    "an unknown field": (query(more=', "mu": 0.3'), "/mu"),
    "an unknown parameter": (query('{"kind": "cone", "slope": 1, "tip": 1}'), "/profile/tip"),
    "a field to be escaped": (query(more=', "a/b~c": 0.3'), "/a~1b~0c"),
    "an unknown kind": (query('{"kind": "pyramid"}'), "/profile/kind"),
    "no kind": (query('{"radius": 1}'), "/profile/kind"),
    "a kind that is a number": (query('{"kind": 5}'), "/profile/kind"),
    "a missing parameter": (query('{"kind": "cone"}'), "/profile/slope"),
    "a profile that is a word": (query('"cone"'), "/profile"),
    "two controls": (query(load='{"normal_force": 1, "contact_radius": 1}'), "/load"),
    "no control": (query(load="{}"), "/load"),
    "no load": (f'{{"profile": {BALL}, "material": {MODULUS}}}'.encode(), "/load"),
    "no material": (query(material="{}"), "/material/e_star"),
    "two materials": (
        query(material=f'{{"bodies": ["rigid", {STEEL}], "e_star": 1}}'),
        "/material/e_star",
    ),
    "one body": (query(material=f'{{"bodies": [{STEEL}]}}'), "/material/bodies"),
    "a soft word": (query(material=f'{{"bodies": [{STEEL}, "soft"]}}'), "/material/bodies/1"),
    "a list for a request": (b"[1]", ""),
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
    "a whole sphere": (
        query('{"kind": "sphere", "radius": 1}', load='{"contact_radius": 1}'),
        "/load/contact_radius",
    ),
    "more than a sphere, in a list": (
        query('{"kind": "sphere", "radius": 1}', load='{"contact_radius": [0.5, 2]}'),
        "/load/contact_radius/1",
    ),
    "past the end of a table": (
        query(table("[0, 1, 2]", "[0, 1, 4]"), load='{"contact_radius": [1, 2.5]}'),
        "/load/contact_radius/1",
    ),
    "past the end of a table by depth": (
        query(table("[0, 1, 2]", "[0, 1, 4]"), load='{"indentation_depth": 100}'),
        "/load/indentation_depth",
    ),
    "an answer that overflows": (
        query(
            '{"kind": "power", "coefficient": 1, "exponent": 100}',
            load='{"contact_radius": [1, 1e5]}',
        ),
        "/load/contact_radius/1",
    ),
    "a tolerance too tight": (query(more=', "rtol": 1e-16'), "/rtol"),
    "a curvature that drops": (
        query('{"kind": "capped_paraboloid", "cap_radius": 1, "tip_radius": 1, "radius": 2}'),
        "/profile/radius",
    ),
}


@pytest.mark.parametrize("name", POINTED)
def test_is_refused_by_pointing_at_it(client: Client, name: str) -> None:
    body, pointer = POINTED[name]
    answer = client.post_text("/v1/normal", body)
    assert answer.status_code == 422
    assert pointers(answer) == [pointer]


SHEARED = '{"e_star": 1e9, "g_star": 8e8}'
PUSH = '{"tangential_force": 0.1}'


def pushed(
    tangential: str = PUSH, friction: str = "0.3", material: str = SHEARED, load: str = FORCE
) -> bytes:
    more = f', "friction_coefficient": {friction}, "tangential": {tangential}'
    return query(material=material, load=load, more=more)


def fields(
    quantities: str = '["pressure"]', more: str = ', "radius": [0]', material: str = MODULUS
) -> bytes:
    return query(material=material, more=f', "quantities": {quantities}{more}')


FRICTION = f', "friction_coefficient": 0.3, "tangential": {PUSH}, "radius": [0]'


def way(
    normal: str = '{"normal_force": [1, 2]}',
    tangential: str = '{"tangential_force": [0, 0.1]}',
    more: str = "",
    name: str = "history",
) -> str:
    return f', "{name}": {{"normal": {normal}, "tangential": {tangential}{more}}}'


def swing(
    normal: str = '{"normal_force": 1}',
    tangential: str = '{"tangential_force": 0.1}',
    more: str = "",
) -> str:
    return way(normal, tangential, more, "cycles")


def along(*ways: str, profile: str = BALL, material: str = SHEARED) -> bytes:
    friction = ', "friction_coefficient": 0.3'
    return f'{{"profile": {profile}, "material": {material}{friction}{"".join(ways)}}}'.encode()


def at_the_end(*ways: str, more: str = ', "friction_coefficient": 0.3') -> bytes:
    asked = '"quantities": ["slip"], "radius": [0]'
    return f'{{"profile": {BALL}, "material": {SHEARED}, {asked}{more}{"".join(ways)}}}'.encode()


def worn(
    load: str = FORCE,
    oscillation: str = PUSH,
    more: str = "",
    profile: str = BALL,
    material: str = SHEARED,
) -> bytes:
    friction = ', "friction_coefficient": 0.3'
    return query(profile, material, load, f'{friction}, "oscillation": {oscillation}{more}')


def fretted(
    load: str = FORCE,
    oscillation: str = PUSH,
    more: str = "",
    cycles: str = "[1, 2]",
    coefficient: str = "1e-14",
) -> bytes:
    over = f', "cycles": {cycles}, "wear_coefficient": {coefficient}'
    return worn(load, oscillation, over + more)


PUSHES = "/history/tangential/tangential_force"
POINTED_ELSEWHERE = {
    # friction
    "a yield strength of nothing": (
        "normal",
        query(material='{"e_star": 1e9, "yield_strength": 0}'),
        "/material/yield_strength",
    ),
    "no shear modulus": ("tangential", pushed(material=MODULUS), "/material/g_star"),
    "a negative shear modulus": (
        "tangential",
        pushed(material=SHEARED.replace("8e8", "-8e8")),
        "/material/g_star",
    ),
    "two rigid bodies": (
        "tangential",
        pushed(material='{"bodies": ["rigid", "rigid"]}'),
        "/material/bodies",
    ),
    "no friction": ("tangential", pushed(friction="0"), "/friction_coefficient"),
    "negative friction": ("tangential", pushed(friction="-0.3"), "/friction_coefficient"),
    "friction that is a list": ("tangential", pushed(friction="[0.3]"), "/friction_coefficient"),
    "friction that is NaN": ("tangential", pushed(friction="NaN"), "/friction_coefficient"),
    "no tangential load": ("tangential", query(more=', "friction_coefficient": 1'), "/tangential"),
    "no tangential control": ("tangential", pushed("{}"), "/tangential"),
    "two tangential controls": (
        "tangential",
        pushed('{"tangential_force": 0, "stick_radius": 0}'),
        "/tangential",
    ),
    "an unknown tangential control": ("tangential", pushed('{"force": 0}'), "/tangential/force"),
    "a push beyond friction": (
        "tangential",
        pushed('{"tangential_force": 0.31}'),
        "/tangential/tangential_force",
    ),
    "a pull beyond friction, in a list": (
        "tangential",
        pushed('{"tangential_force": [0.1, 0, 0.3, -0.31]}'),
        "/tangential/tangential_force/3",
    ),
    "a push beyond the friction of one load": (
        "tangential",
        pushed('{"tangential_force": 0.5}', load='{"normal_force": [2, 1]}'),
        "/tangential/tangential_force",
    ),
    "a push of a string": (
        "tangential",
        pushed('{"tangential_force": [0, "1"]}'),
        "/tangential/tangential_force/1",
    ),
    "a push of 1e999": (
        "tangential",
        pushed('{"tangential_displacement": -1e999}'),
        "/tangential/tangential_displacement",
    ),
    "a push of null": (
        "tangential",
        pushed('{"stick_radius": [null]}'),
        "/tangential/stick_radius/0",
    ),
    "an empty list of pushes": (
        "tangential",
        pushed('{"stick_radius": []}'),
        "/tangential/stick_radius",
    ),
    "sticking outside the contact": (
        "tangential",
        pushed('{"stick_radius": [0, 0.2]}'),
        "/tangential/stick_radius/1",
    ),
    "a negative stick radius": (
        "tangential",
        pushed('{"stick_radius": -1e-9}'),
        "/tangential/stick_radius",
    ),
    "three pushes for two loads": (
        "tangential",
        pushed('{"tangential_force": [0, 0, 0]}', load='{"normal_force": [1, 1]}'),
        "/tangential/tangential_force",
    ),
    # histories
    "no way": ("tangential/history", along(), "/history"),
    "two ways": ("tangential/history", along(way(), swing()), "/cycles"),
    "a way of null": ("tangential/history", along(', "history": null'), "/history"),
    "a way that is a list": ("tangential/history", along(', "history": []'), "/history"),
    "a way without friction": (
        "tangential/history",
        along(way()).replace(b'"friction_coefficient": 0.3, ', b""),
        "/friction_coefficient",
    ),
    "a way without a shear modulus": (
        "tangential/history",
        along(way(), material=MODULUS),
        "/material/g_star",
    ),
    "a way with a load": (
        "tangential/history",
        along(way(), f', "load": {FORCE}'),
        "/load",
    ),
    "two normal controls": (
        "tangential/history",
        along(way('{"normal_force": 1, "indentation_depth": 1}')),
        "/history/normal",
    ),
    "no tangential control on the way": (
        "tangential/history",
        along(way(tangential="{}")),
        "/history/tangential",
    ),
    "a way by contact radii": (
        "tangential/history",
        along(way('{"contact_radius": [1, 2]}')),
        "/history/normal/contact_radius",
    ),
    "three pushes for two points": (
        "tangential/history",
        along(way(tangential='{"tangential_force": [0, 0, 0]}')),
        PUSHES,
    ),
    "no points": (
        "tangential/history",
        along(way('{"normal_force": []}')),
        "/history/normal/normal_force",
    ),
    "no push": ("tangential/history", along(way(tangential='{"tangential_force": []}')), PUSHES),
    "a point of NaN": (
        "tangential/history",
        along(way('{"normal_force": [1, NaN]}')),
        "/history/normal/normal_force/1",
    ),
    "a depth of Infinity": (
        "tangential/history",
        along(way('{"indentation_depth": [1e-6, -Infinity]}')),
        "/history/normal/indentation_depth/1",
    ),
    "a push of a string on the way": (
        "tangential/history",
        along(way(tangential='{"tangential_force": [0, "1"]}')),
        f"{PUSHES}/1",
    ),
    "a push of true": (
        "tangential/history",
        along(way(tangential='{"tangential_force": true}')),
        PUSHES,
    ),
    "a pulling force": (
        "tangential/history",
        along(way('{"normal_force": [1, -1]}')),
        "/history/normal/normal_force/1",
    ),
    "a tiny point": (
        "tangential/history",
        along(way('{"indentation_depth": [1e-6, -1e-300]}')),
        "/history/normal/indentation_depth/1",
    ),
    "a way past the end of a table": (
        "tangential/history",
        along(
            way('{"indentation_depth": [1, 100]}', '{"tangential_displacement": 0}'),
            profile=table("[0, 1, 2]", "[0, 1, 4]"),
        ),
        "/history/normal/indentation_depth/1",
    ),
    "a single point past the end of a table": (
        "tangential/history",
        along(
            way('{"indentation_depth": 100}', '{"tangential_displacement": [0, 1]}'),
            profile=table("[0, 1, 2]", "[0, 1, 4]"),
        ),
        "/history/normal/indentation_depth",
    ),
    "a push beyond friction at a point": (
        "tangential/history",
        along(way(tangential='{"tangential_force": [0, 0.61]}')),
        f"{PUSHES}/1",
    ),
    "a single push beyond friction": (
        "tangential/history",
        along(way(tangential='{"tangential_force": -0.31}')),
        PUSHES,
    ),
    "a push beyond friction between two points": (
        "tangential/history",
        along(
            way(
                '{"indentation_depth": [1e-6, 0, 1e-6]}',
                '{"tangential_force": [0, 0, 0.011]}',
                ', "samples_per_step": 50',
            )
        ),
        f"{PUSHES}/2",
    ),
    "no samples": (
        "tangential/history",
        along(way(more=', "samples_per_step": 0')),
        "/history/samples_per_step",
    ),
    "half a sample": (
        "tangential/history",
        along(way(more=', "samples_per_step": 1.5')),
        "/history/samples_per_step",
    ),
    "too many samples": (
        "tangential/history",
        along(way(more=f', "samples_per_step": {SETTINGS.max_samples}')),
        "/history/samples_per_step",
    ),
    "too many points of a way": (
        "tangential/history",
        along(way(f'{{"normal_force": [{"1," * SETTINGS.max_loads}1]}}')),
        "/history/normal/normal_force",
    ),
    "an unknown field of a way": (
        "tangential/history",
        along(way(more=', "count": 2')),
        "/history/count",
    ),
    # cycles
    "a cycle beyond friction": (
        "tangential/history",
        along(swing(tangential='{"tangential_force": 0.31}')),
        "/cycles/tangential/tangential_force",
    ),
    "a cycle beyond friction in phase": (
        "tangential/history",
        along(swing('{"normal_force": 1, "amplitude": 0.9}')),
        "/cycles/tangential/tangential_force",
    ),
    "a swing larger than its mean": (
        "tangential/history",
        along(swing('{"normal_force": 1, "amplitude": 1.1}')),
        "/cycles/normal/amplitude",
    ),
    "a swing of NaN": (
        "tangential/history",
        along(swing('{"normal_force": 1, "amplitude": NaN}')),
        "/cycles/normal/amplitude",
    ),
    "a tiny amplitude": (
        "tangential/history",
        along(swing('{"normal_force": 1, "amplitude": 1e-300}')),
        "/cycles/normal/amplitude",
    ),
    "a swing about nothing": (
        "tangential/history",
        along(swing('{"amplitude": 1}')),
        "/cycles/normal",
    ),
    "a list of cycles": (
        "tangential/history",
        along(swing('{"normal_force": [1, 2]}')),
        "/cycles/normal/normal_force",
    ),
    "cycles of no force": (
        "tangential/history",
        along(swing(tangential='{"tangential_force": 0}')),
        "/cycles/tangential/tangential_force",
    ),
    "two amplitudes": (
        "tangential/history",
        along(swing(tangential='{"tangential_force": 1, "tangential_displacement": 1}')),
        "/cycles/tangential",
    ),
    "no cycles": ("tangential/history", along(swing(more=', "count": 0')), "/cycles/count"),
    "cycles past the end of a table": (
        "tangential/history",
        along(
            swing('{"indentation_depth": 100}', '{"tangential_displacement": 1}'),
            profile=table("[0, 1, 2]", "[0, 1, 4]"),
        ),
        "/cycles/normal/indentation_depth",
    ),
    # fields of an end
    "a history and a load": ("stress", at_the_end(way(), f', "load": {FORCE}'), "/history"),
    "a history and a push": ("stress", at_the_end(way(), f', "tangential": {PUSH}'), "/tangential"),
    "a history without friction": (
        "stress",
        at_the_end(way(), more=""),
        "/friction_coefficient",
    ),
    "the end of cycles": ("stress", at_the_end(swing()), "/cycles"),
    "an end beyond friction": (
        "stress",
        at_the_end(way(tangential='{"tangential_force": [0, 0.61]}')),
        f"{PUSHES}/1",
    ),
    # wear
    "wear by a contact radius": ("wear", worn('{"contact_radius": 1}'), "/load/contact_radius"),
    "wear under two loads": (
        "wear",
        worn('{"normal_force": 1, "indentation_depth": 1}'),
        "/load",
    ),
    "wear under no load": ("wear", worn("{}"), "/load"),
    "wear by two amplitudes": (
        "wear",
        worn(oscillation='{"tangential_force": 1, "tangential_displacement": 1}'),
        "/oscillation",
    ),
    "wear by no amplitude": ("wear", worn(oscillation="{}"), "/oscillation"),
    "wear by a stick radius": (
        "wear",
        worn(oscillation='{"stick_radius": 1e-6}'),
        "/oscillation/stick_radius",
    ),
    "wear without a shear modulus": ("wear", worn(material=MODULUS), "/material/g_star"),
    "wear without friction": (
        "wear",
        worn().replace(b'"friction_coefficient": 0.3, ', b""),
        "/friction_coefficient",
    ),
    "a negative amplitude": (
        "wear",
        worn(oscillation='{"tangential_force": -0.1}'),
        "/oscillation/tangential_force",
    ),
    "a negative amplitude in a list": (
        "wear",
        worn(oscillation='{"tangential_force": [0, -0.1]}'),
        "/oscillation/tangential_force/1",
    ),
    "an amplitude of NaN": (
        "wear",
        worn(oscillation='{"tangential_displacement": [0, NaN]}'),
        "/oscillation/tangential_displacement/1",
    ),
    "an amplitude beyond friction": (
        "wear",
        worn(oscillation='{"tangential_force": 0.31}'),
        "/oscillation/tangential_force",
    ),
    "an amplitude beyond friction in a list": (
        "wear",
        worn(oscillation='{"tangential_force": [0.2, 0.31]}'),
        "/oscillation/tangential_force/1",
    ),
    "a force that a held depth does not carry": (
        "wear",
        worn('{"indentation_depth": 1e-6}', '{"tangential_force": 0.39}'),
        "/oscillation/tangential_force",
    ),
    "two amplitudes for three loads": (
        "wear",
        worn('{"normal_force": [1, 1, 1]}', '{"tangential_force": [0, 0.1]}'),
        "/oscillation/tangential_force",
    ),
    "a tiny load to wear": (
        "wear",
        worn('{"normal_force": 1e-300}'),
        "/load/normal_force",
    ),
    "wear past the end of a table": (
        "wear",
        worn(
            '{"indentation_depth": [0.1, 7.5]}',
            '{"tangential_displacement": 1}',
            profile=table("[0, 1, 2]", "[0, 1, 4]"),
        ),
        "/load/indentation_depth/1",
    ),
    "a radius past the end of a table": (
        "wear",
        worn(more=', "radius": [1, 3]', profile=table("[0, 1, 2]", "[0, 1, 4]")),
        "/radius/1",
    ),
    "wear at radii twice": ("wear", worn(more=', "radius": [0], "points": 9'), "/points"),
    "wear over no radii": ("wear", worn(more=', "quantities": ["pressure"]'), "/radius"),
    "wear at a negative radius": ("wear", worn(more=', "radius": [-1]'), "/radius/0"),
    "a field that no limit has": (
        "wear",
        worn(more=', "radius": [0], "quantities": ["profile"]'),
        "/quantities/0",
    ),
    "a field of wear twice": (
        "wear",
        worn(more=', "radius": [0], "quantities": ["pressure", "pressure"]'),
        "/quantities",
    ),
    "fewer points than edges": ("wear", worn(more=', "points": 3'), "/points"),
    # wear over the cycles
    "cycles under many loads": (
        "wear/evolution",
        fretted('{"normal_force": [1, 2]}'),
        "/load/normal_force",
    ),
    "cycles by many amplitudes": (
        "wear/evolution",
        fretted(oscillation='{"tangential_force": [0.1, 0.2]}'),
        "/oscillation/tangential_force",
    ),
    "cycles by a contact radius": (
        "wear/evolution",
        fretted('{"contact_radius": 1}'),
        "/load/contact_radius",
    ),
    "cycles by two controls": (
        "wear/evolution",
        fretted('{"normal_force": 1, "indentation_depth": 1}'),
        "/load",
    ),
    "a negative wear coefficient": (
        "wear/evolution",
        fretted(coefficient="-1e-14"),
        "/wear_coefficient",
    ),
    "no wear coefficient": ("wear/evolution", worn(more=', "cycles": [1]'), "/wear_coefficient"),
    "no numbers of cycles": ("wear/evolution", fretted(cycles="[]"), "/cycles"),
    "cycles that are no list": ("wear/evolution", fretted(cycles="1"), "/cycles"),
    "cycles of NaN": ("wear/evolution", fretted(cycles="[1, NaN]"), "/cycles/1"),
    "negative cycles": ("wear/evolution", fretted(cycles="[-1, 1]"), "/cycles/0"),
    "cycles that fall": ("wear/evolution", fretted(cycles="[1, 3, 2]"), "/cycles/2"),
    "very many cycles": ("wear/evolution", fretted(cycles="[1, 1.1e12]"), "/cycles/1"),
    "too many numbers of cycles": (
        "wear/evolution",
        fretted(cycles=f"[{'1,' * SETTINGS.max_samples}1]"),
        "/cycles",
    ),
    "cycles that slide as a whole": (
        "wear/evolution",
        fretted(oscillation='{"tangential_displacement": 1}'),
        "/oscillation/tangential_displacement",
    ),
    "cycles beyond friction": (
        "wear/evolution",
        fretted(oscillation='{"tangential_force": 0.31}'),
        "/oscillation/tangential_force",
    ),
    "cycles of a force at a held depth": (
        "wear/evolution",
        fretted('{"indentation_depth": 1e-6}'),
        "/oscillation/tangential_force",
    ),
    "cycles without an amplitude": (
        "wear/evolution",
        fretted(oscillation='{"tangential_force": 0}'),
        "/oscillation/tangential_force",
    ),
    "too coarse": ("wear/evolution", fretted(more=', "resolution": 7'), "/resolution"),
    "too fine": ("wear/evolution", fretted(more=', "resolution": 97'), "/resolution"),
    "half a node": ("wear/evolution", fretted(more=', "resolution": 8.5'), "/resolution"),
    "too exact": ("wear/evolution", fretted(more=', "rtol": 1e-11'), "/rtol"),
    "the limit on the way": (
        "wear/evolution",
        fretted(more=', "radius": [0], "quantities": ["limiting_profile"]'),
        "/quantities/0",
    ),
    # fields
    "neither a load nor a history": (
        "stress",
        at_the_end(more=""),
        "/load",
    ),
    "no quantities": ("stress", query(more=', "radius": [0]'), "/quantities"),
    "an empty list of quantities": ("stress", fields("[]"), "/quantities"),
    "an unknown quantity": ("stress", fields('["pressure", "heat"]'), "/quantities/1"),
    "a quantity twice": ("stress", fields('["pressure", "pressure"]'), "/quantities"),
    "shear without friction": ("stress", fields('["pressure", "slip"]'), "/quantities/1"),
    "shear without a modulus": (
        "stress",
        fields('["slip"]', FRICTION),
        "/material/g_star",
    ),
    "friction without a push": (
        "stress",
        fields(more=', "radius": [0], "friction_coefficient": 0.3'),
        "/tangential",
    ),
    "a push without friction": (
        "stress",
        fields(more=f', "radius": [0], "tangential": {PUSH}'),
        "/friction_coefficient",
    ),
    "no radii": ("stress", fields(more=""), "/radius"),
    "radii twice": ("stress", fields(more=', "radius": [0], "points": 2'), "/points"),
    "an empty list of radii": ("stress", fields(more=', "radius": []'), "/radius"),
    "a radius that is no list": ("stress", fields(more=', "radius": 0'), "/radius"),
    "a negative radius": ("stress", fields(more=', "radius": [0, -1e-9]'), "/radius/1"),
    "a radius of NaN": ("stress", fields(more=', "radius": [0, NaN]'), "/radius/1"),
    "a radius of true": ("stress", fields(more=', "radius": [true]'), "/radius/0"),
    "one point": ("stress", fields(more=', "points": 1'), "/points"),
    "fewer points than places": (
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
        fields(more=f', "radius": [{"0," * SETTINGS.max_radii}0]'),
        "/radius",
    ),
    "null for friction": (
        "stress",
        fields(more=', "radius": [0], "friction_coefficient": null'),
        "/friction_coefficient",
    ),
}


@pytest.mark.parametrize("name", POINTED_ELSEWHERE)
def test_is_refused_elsewhere_by_pointing_at_it(client: Client, name: str) -> None:
    path, body, pointer = POINTED_ELSEWHERE[name]
    answer = client.post_text(f"/v1/{path}", body)
    assert answer.status_code == 422
    assert pointers(answer) == [pointer]


@pytest.mark.parametrize("path", ["/v1/tangential", "/v1/stress"])
@pytest.mark.parametrize("name", ["NaN", "a string in a list", "two controls", "no kind"])
def test_the_shared_parts_are_refused_everywhere(client: Client, path: str, name: str) -> None:
    body, pointer = POINTED[name]
    answer = client.post_text(path, body)
    assert answer.status_code == 422
    assert pointer in pointers(answer)


@pytest.mark.parametrize(
    ("r", "f"),
    [("[0, 1, 2]", "[0, 2, 1]"), ("[0, 2, 1]", "[0, 1, 2]"), ("[0, 1, 2]", "[0, 1]")],
    ids=["falling", "radii not in order", "lengths that differ"],
)
def test_a_bad_table_is_refused(client: Client, r: str, f: str) -> None:
    answer = client.post_text("/v1/normal", query(table(r, f)))
    assert answer.status_code == 422
    assert all(pointer.startswith("/profile") for pointer in pointers(answer))


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
def test_what_is_not_json_is_malformed(client: Client, name: str) -> None:
    answer = client.post_text("/v1/normal", NOT_JSON[name])
    assert answer.status_code == 400
    assert pointers(answer) == [""]


def test_the_input_is_never_repeated(client: Client) -> None:
    secret = "s3cret" * 20
    bodies = [
        query(f'{{"kind": "{secret}"}}'),
        query(load=f'{{"normal_force": "{secret}"}}'),
        query(more=f', "{secret}": 1'),
        secret.encode(),
    ]
    for body in bodies:
        assert b"s3cret" not in client.post_text("/v1/normal", body).content


def test_few_of_many_errors_are_told(client: Client) -> None:
    many = "".join(f', "{"unknown" * 8}{i}": 1' for i in range(10_000))
    answer = client.post_text("/v1/normal", query(more=many))
    assert 1 <= len(pointers(answer)) <= MAX_ERRORS
    exactly = "".join(f', "u{i}": 1' for i in range(30))
    assert len(pointers(client.post_text("/v1/normal", query(more=exactly)))) == MAX_ERRORS


def test_ten_thousand_bad_elements_make_a_short_answer(client: Client) -> None:
    bad = json.dumps({"normal_force": ["x"] * 10_000})
    assert pointers(client.post_text("/v1/normal", query(load=bad))) == ["/load/normal_force/0"]


def test_a_list_may_be_as_long_as_the_limit(client: Client) -> None:
    def loads(count: int) -> bytes:
        return query(load=json.dumps({"normal_force": [1.0] * count}))

    answer = client.post_text("/v1/normal", loads(SETTINGS.max_loads))
    assert len(answer.json()["contact_radius"]) == SETTINGS.max_loads
    answer = client.post_text("/v1/normal", loads(SETTINGS.max_loads + 1))
    assert pointers(answer) == ["/load/normal_force"]


def test_a_long_body_is_refused(client: Client) -> None:
    answer = client.post_text("/v1/normal", b" " * (SETTINGS.max_body_bytes + 1))
    assert answer.status_code == 413
    problem(answer)


@pytest.mark.parametrize("media_type", ["text/plain", "application/x-www-form-urlencoded", ""])
def test_only_json_is_read(client: Client, media_type: str) -> None:
    headers = {"content-type": media_type}
    answer = client.request("POST", "/v1/normal", content=query(), headers=headers)
    assert answer.status_code == 415
    problem(answer)


@pytest.mark.parametrize("media_type", ["application/json; charset=utf-8", "Application/JSON"])
def test_json_is_read_however_it_is_written(client: Client, media_type: str) -> None:
    headers = {"content-type": media_type}
    answer = client.request("POST", "/v1/normal", content=query(), headers=headers)
    assert answer.status_code == 200


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
def test_a_wrong_address_is_a_problem_too(
    client: Client, method: str, path: str, status: int
) -> None:
    answer = client.request(method, path)
    assert answer.status_code == status
    assert ("allow" in answer.headers) == (status == 405)
    problem(answer)


@pytest.mark.parametrize(
    ("path", "methods"),
    [
        ("/v1/normal", "GET, HEAD, POST"),
        ("/v1/wear/evolution", "POST"),
        ("/health", "GET, HEAD"),
    ],
)
def test_all_methods_of_an_address_are_told(client: Client, path: str, methods: str) -> None:
    assert client.request("PUT", path).headers["allow"] == methods


@pytest.mark.parametrize("path", ["/", "/health", "/docs", "/openapi.json", "/v1/profiles"])
def test_what_may_be_read_may_be_asked_about(client: Client, path: str) -> None:
    answer, asked = client.request("GET", path), client.request("HEAD", path)
    assert asked.status_code == answer.status_code
    assert asked.headers["content-type" if answer.content else "location"]
