"""Reference runs of `test_wear_fields`; `python -m tests.stability.fine_wear` stores them.

They integrate wear over the cycles on the finest nodes, for up to half a minute each. Where the
worn annulus contains a break of the profile, they take three times as many nodes.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mdr_core import normal, tangential
from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    Hyperboloid,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
)
from mdr_core.wear import evolution
from mdr_core.wear.initial_state import InitialState
from mdr_core.wear.integrator import integrate

if TYPE_CHECKING:
    from mdr_core.tangential import TangentialContact

E_STAR, G_STAR, MU, WEAR = 1.0, 0.8, 0.4, 1e-3
DEPTH, PART = 0.05, 0.5
PROFILES: dict[str, Profile] = {
    "paraboloid": Paraboloid(1.0),
    "cone": Cone(0.3),
    "sphere": Sphere(1.0),
    "power": Power(1.0, 4.0),
    "rounded_punch": RoundedPunch(0.5, 1.0),
    "hyperboloid": Hyperboloid(0.5, 0.5),
}
#: Whether the normal force, not the depth, and the displacement amplitude, not that of the force,
#: are constant.
CONTROLS = {
    "depth, displacement": (False, True),
    "forces": (True, False),
    "force, displacement": (True, True),
    "depth, force": (False, False),
}
#: Characteristic numbers of cycles for the decay of the pressure on the annulus.
CYCLES = (0.1, 1.0, 10.0, 100.0, 1000.0)
PAIRS = [(kind, constant) for kind in PROFILES for constant in CONTROLS]
#: Radii relative to the largest contact radius.
RADII = np.linspace(0.0, 1.05, 241)[1:]


class Break(NamedTuple):
    """A worn annulus with a break of the profile, at one characteristic number of cycles."""

    profile: Profile
    contact_radius: float
    controls: str
    part: float
    """Displacement amplitude before wear, as a part of full slip."""
    cycles: float


#: Below the error of a scalar or field, or rejected, by two runs of fewer nodes alone.
BREAKS = {
    "first cycles": Break(CappedParaboloid(1.0, 1.2, 1.0), 1.1, "depth, displacement", 0.3, 1e-3),
    "edge passes": Break(CappedParaboloid(1.0, 1.2, 1.0), 0.98, "depth, displacement", 0.3, 2.0),
    "nearly worn off": Break(
        CappedParaboloid(0.69389344, 3.9115115, 1.02886893),
        0.55295223,
        "depth, displacement",
        0.97,
        20.0,
    ),
    "forces": Break(CappedParaboloid(1.0, 4.0, 1.0), 1.1, "forces", 0.97, 16.0),
}
#: Half as many give scalars within 5e-4.
FINE_NODES = 336
STORED = Path(__file__).with_name("fine_wear.npz")


@cache
def worn(kind: str, name: str, resolution: int, rtol: float = 1e-6) -> evolution.WearEvolution:
    """Wear at half the displacement or force of full slip."""
    profile, (constant_force, constant_displacement) = PROFILES[kind], CONTROLS[name]
    contact = normal.solve(profile, E_STAR, indentation_depth=DEPTH)
    if constant_force:
        contact = normal.solve(profile, E_STAR, normal_force=float(contact.normal_force))
    force = PART * MU * float(contact.normal_force)
    tangential_contact = tangential.solve(contact, G_STAR, MU, tangential_force=force)
    amplitude = {"tangential_force": force}
    if constant_displacement:
        amplitude = {"tangential_displacement": float(tangential_contact.tangential_displacement)}
    unit = InitialState(tangential_contact, WEAR, resolution).cycle_unit
    return evolution.solve(
        contact,
        G_STAR,
        MU,
        wear_coefficient=WEAR,
        cycles=unit * np.array(CYCLES),
        resolution=resolution,
        rtol=rtol,
        **amplitude,
    )


def fine(kind: str, name: str) -> dict[str, np.ndarray]:
    """Scalars, and fields at `RADII`, on the finest nodes."""
    run = worn(kind, name, 96, 1e-8)
    radius = RADII * run.contact_radius.max()
    result = {scalar: np.asarray(getattr(run, scalar)) for scalar in evolution.SCALARS}
    return result | {field: getattr(run, field)(radius) for field in evolution.FIELDS}


def before_wear(name: str) -> TangentialContact:
    """Partial slip of `BREAKS` before wear."""
    body, radius, controls, part, _ = BREAKS[name]
    constant_force, constant_displacement = CONTROLS[controls]
    depth = float(normal.solve(body, E_STAR, contact_radius=radius).indentation_depth)
    contact = normal.solve(body, E_STAR, indentation_depth=depth)
    if constant_force:
        contact = normal.solve(body, E_STAR, normal_force=float(contact.normal_force))
    moved = {"tangential_displacement": part * MU * E_STAR / G_STAR * depth}
    start = tangential.solve(contact, G_STAR, MU, **moved)
    if constant_displacement:
        return start
    return tangential.solve(contact, G_STAR, MU, tangential_force=float(start.tangential_force))


def worn_over_break(name: str) -> evolution.WearEvolution:
    """Wear of `BREAKS` at the default resolution."""
    start = before_wear(name)
    return evolution.solve(
        start.normal,
        G_STAR,
        MU,
        wear_coefficient=WEAR,
        cycles=[InitialState(start, WEAR, 1).cycle_unit * BREAKS[name].cycles],
        **{start.control: float(getattr(start, start.control))},
    )


def fine_over_break(name: str, nodes: int = FINE_NODES) -> dict[str, np.ndarray]:
    """Scalars, and fields at `RADII`, of `BREAKS` on very many nodes."""
    initial = InitialState(before_wear(name), WEAR, nodes)
    cycles = np.array([initial.cycle_unit * BREAKS[name].cycles])
    run = integrate(initial, cycles, 1e-7)
    result = {scalar: np.asarray(getattr(run, scalar)) for scalar in evolution.SCALARS}
    radius = RADII * run.contact_radius.max()
    return result | {field: getattr(run, field)(radius) for field in evolution.FIELDS}


def stored(kind: str, name: str) -> dict[str, np.ndarray]:
    """Stored results of `fine`, or of `fine_over_break` for the kind "break"."""
    with np.load(STORED) as file:
        names = (*evolution.SCALARS, *evolution.FIELDS)
        return {each: file[f"{kind}/{name}/{each}"] for each in names}


def main() -> None:
    result = {
        f"{kind}/{name}/{each}": values
        for kind, name in PAIRS
        for each, values in fine(kind, name).items()
    }
    result |= {
        f"break/{name}/{each}": values
        for name in BREAKS
        for each, values in fine_over_break(name).items()
    }
    np.savez_compressed(STORED, **result)


if __name__ == "__main__":
    main()
