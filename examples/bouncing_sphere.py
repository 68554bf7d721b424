"""Oblique impact of an elastic sphere on a flat: tangential restitution over the angle of impact.

Alumina spheres of 5 mm diameter hit glass at 3.9 m/s, mu = 0.092. The measured values are those of
Kharaz, Gorham & Salman, Powder Technology 120 (2001) 281-291; the elastic constants are typical.
"""

from math import cos, pi, radians, sin

import numpy as np

import mdr_core as mdr
from mdr_core.history import ContactState, advance, unloaded

RADIUS, DENSITY, FRICTION, SPEED = 2.5e-3, 4000.0, 0.092, 3.9
MATERIAL = mdr.from_bodies([mdr.Body(360e9, 0.23), mdr.Body(70e9, 0.25)])
MEASURED = {4.2: 0.746, 9.8: 0.676, 20.2: 0.599, 30.4: 0.690, 39.5: 0.774}
MASS = DENSITY * 4 / 3 * pi * RADIUS**3
# A force on its surface spins a sphere too, so that the surface feels only 2/7 of the mass.
MASSES = np.array([MASS, 2 / 7 * MASS])


def mean_force(old: ContactState, new: ContactState) -> np.ndarray:
    """Return the mean normal and tangential force of a step, from the work that they do."""
    work = (
        new.elastic_energy - old.elastic_energy,
        new.tangential_energy - old.tangential_energy + new.dissipation,
    )
    return np.array(work) / (position(new) - position(old))


def position(state: ContactState) -> np.ndarray:
    """Return the indentation depth and the tangential displacement."""
    return np.array([state.indentation_depth, state.tangential_displacement])


def bounce(degrees: float, step: float = 2e-7) -> tuple[float, float]:
    """Return the tangential restitution, and the relative error of the energy."""
    state = unloaded(mdr.Paraboloid(RADIUS), MATERIAL, MATERIAL, FRICTION)
    start = velocity = SPEED * np.array([cos(radians(degrees)), sin(radians(degrees))])
    dissipated = 0.0
    while velocity[0] > 0 or state.in_contact:
        old, before = state, velocity
        # The implicit midpoint rule with the mean force keeps the energy. Ten passes solve it.
        for _ in range(10):
            state = advance(old, *(position(old) + step * (before + velocity) / 2))
            velocity = before - step * mean_force(old, state) / MASSES
        dissipated += state.dissipation
    energy, rest = (float(MASSES @ v**2) / 2 for v in (start, velocity))
    slowed = 2 / 7 * (velocity[1] - start[1])
    return float(1 + slowed / start[1]), abs(rest + dissipated - energy) / energy


if __name__ == "__main__":
    print("degrees  e_t measured  e_t computed  energy error")
    for degrees, measured in MEASURED.items():
        restitution, error = bounce(degrees)
        print(f"{degrees:7}  {measured:12.3f}  {restitution:12.3f}  {error:12.1e}")
