"""Reference runs of `test_wear_fields`; `python -m tests.stability.fine_wear` stores them.

They integrate wear over the cycles on the finest nodes, for up to half a minute each.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from mdr_core import normal, tangential
from mdr_core.profiles import (
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


def stored(kind: str, name: str) -> dict[str, np.ndarray]:
    """Stored results of `fine`."""
    with np.load(STORED) as file:
        names = (*evolution.SCALARS, *evolution.FIELDS)
        return {each: file[f"{kind}/{name}/{each}"] for each in names}


def main() -> None:
    result = {
        f"{kind}/{name}/{each}": values
        for kind, name in PAIRS
        for each, values in fine(kind, name).items()
    }
    np.savez_compressed(STORED, **result)


if __name__ == "__main__":
    main()
