"""Input that only Python can give is rejected, and the error names its place.

The wrong queries of `tests/service/test_wrong_input.py` reach the same checks over HTTP.
"""

import re
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from mdr_core import fields, fit, history, impact, normal, subsurface, tangential, wear
from mdr_core.errors import InputError
from mdr_core.materials import RIGID, Body, Material, from_bodies
from mdr_core.profiles import (
    Cone,
    Ellipsoid,
    FlatPunch,
    Paraboloid,
    PowerTerm,
    RoundedPunch,
    Series,
    Sphere,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)

STEEL = Body(2.1e11, 0.3)
HERTZ = normal.solve(Paraboloid(1.0), 1.0, contact_radius=[0.1, 0.2])
PUSHED = tangential.solve(HERTZ, 1.0, 0.5, stick_radius=[0.05, 0.1])
MASKED = np.ma.masked_equal([1.0, -999.0, 3.0], -999.0)
SWEPT = normal.solve(Paraboloid(np.array([1.0, 2.0])), 1.0, normal_force=1.0)
LOADED = partial(history.solve, Cone(1.0), 1.0, 1.0, 0.3, normal_force=1.0, tangential_force=0.0)
STATE = LOADED().final_state


def normal_contact(profile: Any, **load: Any) -> Callable[[], Any]:
    return lambda: normal.solve(profile, 1.0, **load)


def tangential_contact(contact: normal.NormalContact = HERTZ, **load: Any) -> Callable[[], Any]:
    return lambda: tangential.solve(contact, 1.0, 0.5, **load)


def hit(**velocities: Any) -> impact.Impact:
    given = {"normal_velocity": 1.0, "tangential_velocity": 1.0} | velocities
    masses = {"normal_mass": 1.0, "tangential_mass": 0.3}
    return impact.solve(Paraboloid(0.01), 1e9, 8e8, 0.1, **masses, **given)


def beneath(radius: float) -> Callable[[], Any]:
    contact = normal.solve(Cone(1.0), 1e-10, contact_radius=radius)
    return lambda: subsurface.stress(contact, 0.0, 0.0, radius, poissons_ratio=0.3)


REJECTED: list[tuple[Callable[[], Any], tuple[str | int, ...], str]] = [
    (
        normal_contact(Cone(1.0), indentation_depth=1.0, normal_force=1.0, contact_radius=1.0),
        ("load",),
        "exactly one of",
    ),
    (normal_contact(Cone(1.0), normal_force=[1.0, np.inf]), ("load", "normal_force", 1), "finite"),
    (normal_contact(Cone(1.0), normal_force=[1.0, True]), ("load", "normal_force"), "not bool"),
    (lambda: Cone([1.0, True]), ("profile", "slope"), "not bool"),
    (
        lambda: normal.solve(Cone(1.0), [1.0, True], normal_force=1.0),
        ("material", "e_star"),
        "not bool",
    ),
    (
        lambda: tangential.solve(HERTZ, 1.0, [0.5, True], stick_radius=0.05),
        ("friction_coefficient",),
        "not bool",
    ),
    (
        lambda: tangential.solve(HERTZ, 1.0, [[0.5] * 3], stick_radius=0.05),
        ("tangential", "stick_radius"),
        "1, does not agree with the normal loads, 2 and 1 x 3: give one, or as many",
    ),
    (
        normal_contact(Cone(np.ones(3)), normal_force=[1.0, 2.0]),
        ("load", "normal_force"),
        "does not agree",
    ),
    (lambda: normal.solve(Cone(1.0), 0.0, normal_force=1.0), ("material", "e_star"), "positive"),
    (
        lambda: fit.solve(
            Cone(1.0),
            indentation_depth=[0.0, 1.0, 2.0],
            normal_force=[0.0, 1.0, 4.0],
            time=[0.0, 1.0, 2.0],
            drift_rate=0.1,
            drift_rate_error=[1.0, 2.0],
        ),
        ("drift_rate_error",),
        "a single number",
    ),
    (lambda: hit(normal_velocity=None), ("normal_velocity",), "must be a number"),
    (lambda: hit(normal_velocity=-1.0), ("normal_velocity",), "must be positive"),
    (lambda: hit(normal_velocity=[]), ("normal_velocity",), "at least one value"),
    (lambda: hit(tangential_velocity=1e-165), ("tangential_velocity",), "change the units"),
    (lambda: Material(1.0, 0.0), ("material", "g_star"), "positive"),
    # Numbers beneath a mask are not input.
    (normal_contact(Cone(1.0), normal_force=MASKED), ("load", "normal_force", 1), "masked"),
    (lambda: Cone(MASKED), ("profile", "slope", 1), "masked"),
    (lambda: Tabulated([0.0, 1.0, 2.0], MASKED), ("profile", "f", 1), "masked"),
    (lambda: fields.pressure(HERTZ, MASKED), ("radius", 1), "masked"),
    (
        lambda: subsurface.stress(HERTZ, 0.0, 0.0, MASKED, poissons_ratio=0.3),
        ("z", 1),
        "masked",
    ),
    (
        lambda: fit.solve(Cone(1.0), indentation_depth=MASKED, normal_force=[1.0, 2.0, 3.0]),
        ("indentation_depth", 1),
        "masked",
    ),
    (lambda: history.unloaded(Cone(1.0), 1.0, 0.0, 0.3), ("material", "g_star"), "positive"),
    (lambda: LOADED(initial_state={}), ("initial_state",), "members"),
    (lambda: LOADED(initial_state=STATE | {"time": 1.0}), ("initial_state",), "members"),
    (lambda: LOADED(initial_state=STATE | {"regime": 1}), ("initial_state", "regime"), "one of"),
    (tangential_contact(tangential_force=np.nan), ("tangential", "tangential_force"), "finite"),
    (
        tangential_contact(tangential_force=[0.0, -1.0]),
        ("tangential", "tangential_force", 1),
        "no equilibrium",
    ),
    (
        tangential_contact(tangential_displacement=[0.0, 1e-3, 1e-2]),
        ("tangential", "tangential_displacement"),
        "does not agree",
    ),
    (lambda: from_bodies([STEEL, RIGID, STEEL]), ("material", "bodies"), "exactly two bodies"),
    (lambda: from_bodies([None, STEEL]), ("material", "bodies", 0), 'must be a Body or "rigid"'),
    (lambda: Body(0.0, 0.3), ("youngs_modulus",), "positive"),
    (lambda: Body(1.0, -1.0), ("poissons_ratio",), "at most 0.5"),
    (lambda: fields.pressure(SWEPT, [0.1]), ("profile", "radius"), "single number"),
    (
        lambda: fields.shear_stress(tangential.solve(SWEPT, 1.0, 0.5, tangential_force=0.0), [0.1]),
        ("profile", "radius"),
        "single number",
    ),
    (
        lambda: history.unloaded(Paraboloid(np.array([1.0, 2.0])), 1.0, 1.0, 0.5),
        ("profile", "radius"),
        "single number",
    ),
    (
        lambda: wear.limit.solve(
            normal.solve(Paraboloid(1.0), 1.0, maximum_pressure=0.03),
            *(1.0, 0.5),
            tangential_displacement=1e-3,
        ),
        ("load", "maximum_pressure"),
        "prescribe the depth or the normal force",
    ),
    (
        lambda: wear.limit.solve(SWEPT, 1.0, 0.5, tangential_force=0.0),
        ("profile", "radius"),
        "single number",
    ),
    (lambda: subsurface.largest(HERTZ, poissons_ratio=-1.0), ("poissons_ratio",), "at most 0.5"),
    (lambda: subsurface.largest(HERTZ, poissons_ratio=0.3, body=3), ("body",), "1 or 2"),
    (beneath(1e-97), ("profile",), "range of double precision"),
    (beneath(1e97), ("profile",), "range of double precision"),
    (lambda: fields.grid(HERTZ, 3), ("points",), "at least 4"),
    (
        tangential_contact(normal.solve(FlatPunch(1.0), 1.0, normal_force=1.0), stick_radius=0.5),
        ("tangential", "stick_radius"),
        "no slip annulus",
    ),
    (lambda: Series(()), ("profile", "terms"), "at least one term"),
    (
        lambda: Series((PowerTerm(1.0, 2.0), PowerTerm(1.0, 0.0))),
        ("profile", "terms", 1, "exponent"),
        "positive",
    ),
    (lambda: Series((PowerTerm(0.0, 2.0),)), ("profile", "terms", 0, "coefficient"), "not zero"),
    (lambda: Series((PowerTerm(-1.0, 1.0), PowerTerm(1.0, 2.0))), ("profile", "terms"), "f falls"),
    # It falls only at radii below exp(-1e6), which are not representable.
    (
        lambda: Series((PowerTerm(-0.03, 1.0), PowerTerm(0.1, 1.000001))),
        ("profile", "terms"),
        "f falls",
    ),
]


MISTAKES = {
    "an integer beyond double precision": 10**400,
    "a list of integers beyond double precision": [10**400, 1.0],
    "nothing": None,
    "a flag": True,
    "flags": np.array([True, False]),
    "text": "1,5",
    "Arabic digits": "\u0661\u0662",
    "texts": ["1", "2"],
    "rows of two lengths": [[1.0], [1.0, 2.0]],
    "arrays of two shapes": [np.zeros((2, 3)), np.zeros((2, 4))],
    "a complex number": 1j,
    "dates": np.array(["2020-01-01"], dtype="datetime64[D]"),
    "an object": object(),
}
CYCLE = partial(history.cycles, Cone(1.0), 1.0, 1.0, 0.3)
ARGUMENTS: dict[str, Callable[[Any], Any]] = {
    "slope": Cone,
    "r": lambda value: Tabulated(value, [0.0, 1.0, 2.0]),
    "breaks": lambda value: Tabulated([0.0, 1.0, 2.0], [0.0, 1.0, 4.0], breaks=value),
    "coefficient": lambda value: Series((PowerTerm(value, 2.0),)),
    "exponent": lambda value: Series((PowerTerm(1.0, value),)),
    "terms": Series,
    "youngs_modulus": lambda value: Body(value, 0.3),
    "poissons_ratio": lambda value: Body(1.0, value),
    "bodies": from_bodies,
    "e_star": lambda value: normal.solve(Cone(1.0), value, normal_force=1.0),
    "normal_force": lambda value: normal.solve(Cone(1.0), 1.0, normal_force=value),
    "profile": lambda value: normal.solve(value, 1.0, normal_force=1.0),
    "friction_coefficient": lambda value: history.unloaded(Cone(1.0), 1.0, 1.0, value),
    "indentation_depth": lambda value: history.advance_many(
        history.unloaded(Cone(1.0), 1.0, 1.0, 0.3), value, 0.0
    ),
    "amplitude": lambda value: CYCLE(
        normal_force=1.0, normal_amplitude=value, tangential_force=0.1
    ),
    "tangential_force": lambda value: CYCLE(normal_force=1.0, tangential_force=value),
    "count": lambda value: CYCLE(normal_force=1.0, tangential_force=0.1, count=value),
    "points": lambda value: fields.grid(HERTZ, value),
    "radius": lambda value: fields.pressure(HERTZ, value),
    "resolution": lambda value: wear.evolution.solve(
        normal.solve(Cone(1.0), 1.0, normal_force=1.0),
        1.0,
        0.3,
        wear_coefficient=1.0,
        cycles=[0.0],
        tangential_force=0.1,
        resolution=value,
    ),
}


# A load that is None is not given: errors of it name all loads.
PAIRS = [
    (argument, mistake)
    for argument in ARGUMENTS
    for mistake in MISTAKES
    if not (mistake == "nothing" and argument in {"normal_force", "tangential_force"})
]


@pytest.mark.parametrize(("argument", "mistake"), PAIRS)
def test_error_of_a_wrong_type_names_the_argument(argument: str, mistake: str) -> None:
    with pytest.raises(InputError) as raised:
        ARGUMENTS[argument](MISTAKES[mistake])
    assert argument in raised.value.path
    assert argument in re.split(r"[.\[]", str(raised.value).partition(":")[0])
    assert len(raised.value.detail) < 200


@pytest.mark.parametrize(("call", "path", "reason"), REJECTED)
def test_error_names_path_index_and_reason(
    call: Callable[[], Any], path: tuple[str | int, ...], reason: str
) -> None:
    with pytest.raises(InputError) as raised:
        call()
    assert raised.value.path == path
    assert reason in raised.value.detail


def test_text_of_an_error_begins_with_the_argument_and_its_index() -> None:
    with pytest.raises(InputError, match=r"^normal_force\[1\]: must not be negative"):
        normal.solve(Cone(1.0), 1.0, normal_force=[1.0, -1.0])


FLAT_ENDED = [RoundedPunch(0.5, 1.0), TruncatedCone(0.5, 0.3), TruncatedParaboloid(0.5, 1.0)]


@pytest.mark.parametrize("profile", FLAT_ENDED, ids=lambda profile: profile.kind)
def test_contact_smaller_than_its_flat_is_rejected(profile: Any) -> None:
    with pytest.raises(InputError, match="cannot be smaller than the flat") as raised:
        normal.solve(profile, 1.0, contact_radius=[0.6, 0.5, np.nextafter(0.5, 0.0), 0.4])
    assert raised.value.path == ("load", "contact_radius", 2)
    assert raised.value.cases.tolist() == [False, False, True, True]
    # The flat itself is in contact without a load.
    assert normal.solve(profile, 1.0, contact_radius=0.5).normal_force == 0


@pytest.mark.parametrize("profile", [Sphere(0.5), Ellipsoid(0.5, 2.0)], ids=lambda p: p.kind)
def test_contact_as_wide_as_its_body_is_rejected(profile: Any) -> None:
    normal.solve(profile, 1.0, contact_radius=0.5 * (1 - 2e-8))
    with pytest.raises(InputError) as raised:
        normal.solve(profile, 1.0, contact_radius=[0.4, 0.5])
    assert raised.value.path == ("load", "contact_radius", 1)


def test_contact_beyond_the_end_of_a_series_is_rejected_under_each_control() -> None:
    # f' = 2 r - 4 r^3 and g' ~ x - (8/3) x^3: g' vanishes first, at sqrt(3/8).
    profile = Series((PowerTerm(1.0, 2.0), PowerTerm(-1.0, 4.0)))
    end = np.sqrt(3 / 8)
    assert profile.domain == pytest.approx(end, rel=1e-14, abs=0)
    last = normal.solve(profile, 1.0, contact_radius=profile.domain)
    for name in ("indentation_depth", "normal_force", "contact_radius"):
        most = float(getattr(last, name))
        assert normal.solve(profile, 1.0, **{name: most * (1 - 1e-6)}).contact_radius < end
        with pytest.raises(InputError, match="ceases to be admissible") as raised:
            normal.solve(profile, 1.0, **{name: [most / 2, most * (1 + 1e-6)]})
        assert raised.value.path == ("load", name, 1)
