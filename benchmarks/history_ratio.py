"""A million steps of random loading: the polyline of `mdr_core.history` against 1000 springs.

The springs are implemented twice: directly from the friction law, for all springs at once, and as
fast as NumPy allows, in place, without temporaries, for springs in contact only. Their time is
measured for a part of the steps and extrapolated; that of MDR is for the whole call.

`python history_ratio.py` prints the row; `ratios.py` includes it.
"""

from __future__ import annotations

import os

# Set before NumPy is loaded: BLAS threads would compete for the cores.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import sys
from pathlib import Path

import measure
import numpy as np

from mdr_core import history
from mdr_core.profiles import Paraboloid, Profile, Sphere, Tabulated

Array = np.ndarray

STEPS, PART, SPRINGS = 1_000_000, 5_000, 1000
#: Steps of the reference, and its number of springs.
CHECKED, MANY = 300, 400_000
#: Contacts of one step of `history.advance_many`.
CONTACTS = 10_000
R, E_STAR, G_STAR, MU = 0.01, 1.1e11, 0.9e11, 0.3
DEPTH, PARABOLOID = 1e-6, Paraboloid(R)
FULL_SLIP = MU * E_STAR / G_STAR * DEPTH


def random_path() -> tuple[Array, Array]:
    random = np.random.default_rng(11)
    return (
        DEPTH * random.uniform(0.2, 1.0, STEPS),
        FULL_SLIP * random.uniform(-0.8, 0.8, STEPS),
    )


def springs(d: Array, u: Array, count: int) -> Array:
    """F_x after each step, from `count` springs at the midpoints of equal lengths."""
    a = np.sqrt(R * DEPTH)
    touch = ((np.arange(count) + 0.5) * (a / count)) ** 2 / R
    # The springs in first contact in a step are contiguous.
    below = np.searchsorted(touch, d)
    load, limit, most = np.zeros(count), np.empty(count), np.empty(count)
    np.multiply(touch, -MU * E_STAR, out=most)
    scale = 2 * a / count
    force = np.empty(d.size)
    last_d = last_u = 0.0
    inside = 0
    for step, (new_d, new_u, reach) in enumerate(
        zip(d.tolist(), u.tolist(), below.tolist(), strict=True)
    ):
        push = G_STAR * (new_u - last_u)
        if reach < inside:
            load[reach:inside] = 0.0
        elif reach > inside:
            entering = load[inside:reach]
            np.subtract(new_d, touch[inside:reach], out=entering)
            entering *= push / (new_d - last_d)
        in_contact, bound = load[:reach], limit[:reach]
        in_contact[:inside] += push
        np.add(most[:reach], MU * E_STAR * new_d, out=bound)
        np.minimum(in_contact, bound, out=in_contact)
        np.negative(bound, out=bound)
        np.maximum(in_contact, bound, out=in_contact)
        force[step] = scale * in_contact.sum()
        last_d, last_u, inside = new_d, new_u, reach
    return force


def springs_plain(d: Array, u: Array, count: int) -> Array:
    """F_x after each step, directly from the friction law: trial, bounds, clip."""
    a = np.sqrt(R * DEPTH)
    touch = ((np.arange(count) + 0.5) * (a / count)) ** 2 / R
    load, force = np.zeros(count), np.empty(d.size)
    last_d = last_u = 0.0
    for step, (new_d, new_u) in enumerate(zip(d.tolist(), u.tolist(), strict=True)):
        entered = np.clip((new_d - touch) / (new_d - last_d), 0.0, 1.0) if new_d > last_d else 1.0
        share = np.where(touch < last_d, 1.0, entered)
        bound = MU * E_STAR * np.maximum(new_d - touch, 0.0)
        load = np.clip(load + G_STAR * (new_u - last_u) * share, -bound, bound)
        force[step] = 2 * a / count * load.sum()
        last_d, last_u = new_d, new_u
    return force


def mdr(d: Array, u: Array, profile: Profile = PARABOLOID) -> history.LoadHistory:
    return history.solve(
        profile, E_STAR, G_STAR, MU, indentation_depth=d, tangential_displacement=u
    )


def all_results(d: Array, u: Array) -> None:
    result = mdr(d, u)
    for name in result.quantities:
        getattr(result, name)


def steps(profile: Profile, d: Array, u: Array) -> Array:
    """F_x after each step of `history.advance`."""
    state, force = history.unloaded(profile, E_STAR, G_STAR, MU), np.empty(d.size)
    for step, end in enumerate(zip(d.tolist(), u.tolist(), strict=True)):
        state = history.advance(state, *end)
        force[step] = state.tangential_force
    return force


def forces(states: history.ContactStates, d: Array, u: Array) -> tuple[Array, Array]:
    moved = history.advance_many(states, d, u)
    return moved.normal_force, moved.tangential_force


def rows() -> list[measure.Row]:
    d, u = random_path()
    few, part, more = slice(CHECKED), slice(PART), slice(STEPS // 10)
    truth = springs(d[few], u[few], MANY)
    size = np.max(np.abs(truth))
    # The whole path is requested, so that the checked results are those that are timed.
    errors = [
        float(np.max(np.abs(found - truth)) / size)
        for found in (mdr(d, u).tangential_force[few], springs(d[few], u[few], SPRINGS))
    ]
    detail = (
        f"against {MANY} springs: MDR within {errors[0]:.0e}, {SPRINGS} springs {errors[1]:.0e}"
    )
    found = []
    for how, simulate, target in (
        ("plain", springs_plain, ">= 150"),
        ("in place", springs, ">= 60"),
    ):
        rounds = measure.interleaved(
            lambda run=simulate: run(d[part], u[part], SPRINGS),
            lambda: mdr(d, u).tangential_force,
            4.0,
        )
        whole = [(first * (STEPS / PART), second) for first, second in rounds]
        name = f"{SPRINGS} springs in NumPy, {how} / F_x after 1e6 random steps"
        found.append(measure.row(name, "", whole, target, detail))
    rounds = measure.interleaved(
        lambda: all_results(d[more], u[more]), lambda: mdr(d[more], u[more]).tangential_force, 2.0
    )
    found.append(measure.row("1e5 random steps, all results / F_x alone", "", rounds, "<= 10"))
    r = np.linspace(0.0, 2 * np.sqrt(R * DEPTH), 200)
    table = Tabulated(r, R - np.sqrt(R * R - r * r))
    for profile, target in ((PARABOLOID, "<= 3"), (Sphere(R), "<= 9"), (table, "<= 9")):
        rounds = measure.interleaved(
            lambda body=profile: steps(body, d[few], u[few]),
            lambda: springs(d[few], u[few], SPRINGS),
            2.0,
        )
        name = f"history.advance with F_x, {profile.kind} / a step of {SPRINGS} springs in NumPy"
        found.append(measure.row(name, "", rounds, target))
    # After ten steps, as in a discrete element code.
    paths = (each[: 11 * CONTACTS].reshape(11, CONTACTS) for each in (d, u))
    *first, last = zip(*paths, strict=True)
    states = history.unloaded(PARABOLOID, E_STAR, G_STAR, MU)
    for loads in first:
        states = history.advance_many(states, *loads)
    rounds = measure.interleaved(
        lambda: steps(PARABOLOID, d[few], u[few]), lambda: forces(states, *last), 2.0
    )
    per_contact = [(single / CHECKED, many / CONTACTS) for single, many in rounds]
    name = f"history.advance with F_x / one of {CONTACTS} contacts of history.advance_many"
    detail = f"{1e6 * float(np.median(per_contact, axis=0)[1]):.2g} µs a contact"
    found.append(measure.row(name, "", per_contact, ">= 12", detail))
    return found


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parent))
    for one in rows():
        print(
            f"{one.name}: {one.ratio:.3g} ({one.low:.3g} .. {one.high:.3g}), {one.target}; "
            f"{one.detail}"
        )
