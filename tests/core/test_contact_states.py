"""Contacts of many bodies have the results of each, whatever their parameters and order."""

from __future__ import annotations

import numpy as np
import pytest

from mdr_core import history
from mdr_core.profiles import Cone, Paraboloid, PowerTerm, Series, Tabulated
from tests.core.comparison import profile_from
from tests.core.test_history_paths import (
    DEPTH,
    FULL_SLIP,
    MATERIAL,
    PROFILES,
    every_profile,
    random_path,
)

CONTACTS, STEPS = 5, 10
random = np.random.default_rng(3)
# Moduli and friction of each contact, in ratios that leave the path of the displacements as it is.
FACTOR = random.uniform(0.5, 2.0, (3, CONTACTS))
MODULI = [
    FACTOR[0] * MATERIAL.e_star,
    FACTOR[1] * MATERIAL.g_star,
    FACTOR[2] * MATERIAL.mu,
]


@every_profile
def test_parameters_of_each_contact_give_its_own_results(name: str) -> None:
    body = profile_from(PROFILES[name])
    numbers = {
        name: value * np.linspace(1.0, 1.3, CONTACTS)
        for name, value in body.parameters.items()
        if isinstance(value, float | int)
    }
    together = type(body)(**{**body.parameters, **numbers}) if numbers else body
    states = history.unloaded_many(together, *MODULI)
    single = []
    for i in range(CONTACTS):
        own = type(body)(**{name: value[i] for name, value in numbers.items()}) if numbers else body
        single.append(history.unloaded(own, *(float(modulus[i]) for modulus in MODULI)))
    paths = np.array([random_path(seed, STEPS) for seed in range(CONTACTS)])
    paths[:, 0] *= 0.6
    regimes = []
    for d, u in paths.transpose(2, 1, 0):
        states = history.advance_many(states, d, u)
        single = list(map(history.advance, single, d.tolist(), u.tolist()))
        for quantity in history.ContactState.quantities[:-1]:
            values = np.array([getattr(each, quantity) for each in single])
            near = pytest.approx(values, rel=1e-12, abs=1e-13 * np.max(np.abs(values)))
            assert getattr(states, quantity) == near, quantity
        regimes.append(states.regime)
    for i, each in enumerate(single):
        d, u = paths[i]
        whole = history.solve(
            each.profile,
            *(float(modulus[i]) for modulus in MODULI),
            indentation_depth=d,
            tangential_displacement=u,
        )
        assert whole.regime.tolist() == [row[i] for row in regimes]
        assert states[i].tangential_force == pytest.approx(each.tangential_force, rel=1e-12, abs=0)


def stepped() -> history.ContactStates:
    """Balls of several radii, one of them in separation, after three steps."""
    states = history.unloaded_many(Paraboloid(np.linspace(1.0, 2.0, CONTACTS)), *MODULI)
    for share in (0.6, 1.0, 0.4):
        depth = DEPTH * np.array([0.2, 0.8, -0.1, 0.5, 1.0]) * (1 + share)
        states = history.advance_many(states, depth, FULL_SLIP * share)
    return states


def assert_same(states: history.ContactStates, others: history.ContactStates) -> None:
    for name, value in states.values().items():
        assert np.array_equal(value, others.values()[name]), name


@pytest.mark.parametrize(
    "index", [[True, False, True, True, False], slice(1, 4), [4, 0], [2], slice(0)], ids=str
)
def test_chosen_contacts_go_on_as_they_would_among_all(index: list[int] | slice) -> None:
    states = stepped()
    chosen, at = states[index], np.arange(CONTACTS)[index]
    assert len(chosen) == at.size
    further = history.advance_many(states, DEPTH, -FULL_SLIP)
    assert_same(history.advance_many(chosen, DEPTH, -FULL_SLIP), further[index])
    for name, value in chosen.values().items():
        assert np.array_equal(value, states.values()[name][at]), name


def test_joined_contacts_are_those_of_the_parts() -> None:
    states = stepped()
    assert_same(history.join(states[:2], states[[2]], states[3:]), states)
    one = states[1]
    both = history.join(one, history.unloaded(Paraboloid(3.0), one.e_star, 1.0, 0.1))
    assert both.profile.parameters["radius"].tolist() == [1.25, 3.0]
    assert both.e_star == one.e_star
    assert both.tangential_force.tolist() == [states.tangential_force[1], 0.0]
    assert both.regime.tolist() == [states.regime[1], "no_contact"]


def test_terms_in_a_list_are_those_in_a_tuple() -> None:
    one, same = (Series(kind([PowerTerm(1.0, 2.0), PowerTerm(2, 4)])) for kind in (list, tuple))
    assert one == same
    assert len(history.join(*(history.unloaded(each, 1.0, 1.0, 0.5) for each in (one, same)))) == 2


def test_profiles_of_two_kinds_are_not_joined() -> None:
    ball, cone = (history.unloaded(body, 1.0, 1.0, 0.3) for body in (Paraboloid(1.0), Cone(0.1)))
    tables = [
        history.unloaded(Tabulated([0.0, 0.5, 1.0], [0.0, rise / 4, rise]), 1.0, 1.0, 0.3)
        for rise in (0.1, 0.2)
    ]
    assert len(history.join(tables[0], tables[0])) == 2
    for pair in ((ball, cone), tables):
        with pytest.raises(ValueError, match="cannot be joined"):
            history.join(*pair)
    with pytest.raises(ValueError, match="at least one"):
        history.join()


def test_a_hertz_contact_of_each_radius_and_modulus() -> None:
    """F_N = 4/3 E* sqrt(R) d^1.5, a = sqrt(R d), and 2/5 F_N d of energy, at scales far apart."""
    radius, modulus = np.array([1e-50, 1.0, 1e50]), np.array([1e50, 1.0, 1e-20])
    start = history.unloaded_many(Paraboloid(radius), modulus, modulus, 0.3)
    d = 1e-3 * radius
    states = history.advance_many(start, d, 0.0)
    force = 4 / 3 * modulus * np.sqrt(radius * d) * d
    assert states.normal_force == pytest.approx(force, rel=1e-13, abs=0)
    assert states.contact_radius == pytest.approx(np.sqrt(radius * d), rel=1e-13, abs=0)
    assert states.elastic_energy == pytest.approx(0.4 * force * d, rel=1e-13, abs=0)
    # At full slip F_x = mu F_N; the work of the next slip is mu F_N times its length.
    full = 2 * 0.3 * d
    states = history.advance_many(states, d, full)
    assert states.regime.tolist() == ["full_slip"] * 3
    states = history.advance_many(states, d, 3 * full)
    assert states.tangential_force == pytest.approx(0.3 * force, rel=1e-13, abs=0)
    assert states.dissipation == pytest.approx(0.3 * force * 2 * full, rel=1e-12, abs=0)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (([1.0, -1.0], 1.0, 1.0, 0.3), "radius: must be positive"),
        ((1.0, [1.0, 0.0], 1.0, 0.3), r"^e_star.*: must be positive"),
        ((1.0, 1.0, [np.inf, 1.0], 0.3), r"^g_star.*: must be finite"),
        ((1.0, 1.0, 1.0, [0.3, -0.3]), "friction_coefficient: must be positive"),
        (([1.0, 2.0], 1.0, [1.0, 1.0, 1.0], 0.3), "one for each of 3 contacts"),
    ],
)
def test_values_of_each_contact_are_checked(given: tuple, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        history.unloaded_many(Paraboloid(given[0]), *given[1:])


def test_depths_may_be_changed_in_place_for_the_next_step() -> None:
    """A state keeps its depth, and F_N = (4/3) E* sqrt(R) d^(3/2) holds for the changed depth."""
    states = history.unloaded_many(Paraboloid([1.0, 4.0]), 1.0, 1.0, 0.5)
    for total in (0.25, 0.5):
        depth = states.indentation_depth
        depth += 0.25
        assert states.indentation_depth == pytest.approx(total - 0.25, rel=0, abs=0)
        states = history.advance_many(states, depth, 0.0)
        force = 4 / 3 * np.array([1.0, 2.0]) * total**1.5
        assert states.normal_force == pytest.approx(force, rel=1e-14, abs=0)


def test_readable_form_has_one_line_for_each_result() -> None:
    lines = repr(stepped()).splitlines()
    assert lines[0] == "ContactStates:"
    assert [line.split(":")[0].strip() for line in lines[1:]] == [*history.ContactStates.quantities]
    assert "'full_slip'" in lines[-1]
