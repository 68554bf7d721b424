"""Cycles of a twist under a constant normal load, by Masing's rule."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.materials import Material
from mdr_core.normal import NormalContact
from mdr_core.torsion.contact import TorsionalContact, solve
from mdr_core.typing import Array, Parameter


class TorsionCycle(NamedTuple):
    """Closed loop of torque over rotation, starting at the upper turning point."""

    turning: TorsionalContact
    """Contact at the upper turning point, before the first reversal."""
    rotation: Array
    """phi [radian], shape (2 n + 1, ...) for n samples of a half-cycle."""
    torque: Array
    """M [force length]."""
    energy_per_cycle: Array
    """Energy dissipated by friction, the area of the loop [force length]."""


def cycle(
    contact: NormalContact,
    shear_modulus: Parameter | Material | None,
    friction_coefficient: Parameter,
    *,
    torque: ArrayLike | None = None,
    rotation: ArrayLike | None = None,
    samples: int = 32,
) -> TorsionCycle:
    """Return a cycle of the twist between two opposite torques or rotations.

    After a reversal at (phi_0, M_0) the torque follows the law M(phi) of the first twist, scaled by
    two: M_0 - 2 M((phi_0 - phi)/2). The second half of the loop is the mirror image of the first.
    A cycle dissipates four times the energy of the first twist.

    Source: deresiewicz; notes, §16.

    Parameters
    ----------
    contact, shear_modulus, friction_coefficient : as for `solve`.
    torque, rotation : exactly one, the amplitude [force length], [radian].
    samples : number of steps of each half-cycle, which cluster at the turning points.

    Raises
    ------
    InputError : as for `solve`.

    Examples
    --------
    At small amplitudes the energy grows with the cube of the torque.

    >>> from mdr_core import normal
    >>> from mdr_core.profiles import Paraboloid
    >>> ball = normal.solve(Paraboloid(0.01), 1.1e11, normal_force=10.0)
    >>> energy = cycle(ball, 4e10, 0.3, torque=[1e-8, 2e-8]).energy_per_cycle
    >>> round(float(energy[1] / energy[0]), 2)
    8.0
    """
    turning = solve(contact, shear_modulus, friction_coefficient, torque=torque, rotation=rotation)
    share = (1 - np.cos(np.linspace(0.0, np.pi, samples + 1))) / 2
    halves = np.multiply.outer(share, turning.rotation)
    half = solve(contact, shear_modulus, friction_coefficient, rotation=halves)
    down = turning.rotation - 2 * halves, turning.torque - 2 * half.torque
    rotations, torques = (np.concatenate([fallen, -fallen[1:]]) for fallen in down)
    return TorsionCycle(turning, rotations, torques, 4 * turning.dissipated_energy)
