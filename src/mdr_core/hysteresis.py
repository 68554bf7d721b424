"""Shear modulus and friction coefficient from a hysteresis loop under a constant normal load.

After a reversal of the displacement the force follows the law of first loading, enlarged twice.

Source: mindlin-deresiewicz; notes, §15.
"""

from typing import Final, NamedTuple
from warnings import catch_warnings, simplefilter

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import OptimizeWarning, curve_fit

from mdr_core import tangential
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact
from mdr_core.typing import Array
from mdr_core.validation import as_curve, require_type

# Amplitudes that are tried first, over that of full slip.
_TRIED: Final = np.geomspace(0.01, 30.0, 24)
# Points, two for each parameter.
_FEWEST: Final = 6


class LoopFit(NamedTuple):
    """Fitted parameters of a loop with their standard errors."""

    g_star: float
    """Effective shear modulus G* [pressure]."""
    friction_coefficient: float
    """mu [1]."""
    force_offset: float
    """F_0, the force in the middle of the loop [force]."""
    standard_errors: Array
    """Standard deviations of these three, from the residuals, shape (3,)."""
    residual: Array
    """Measured less fitted forces [force], shape (k,)."""


def solve(
    contact: NormalContact, *, tangential_displacement: ArrayLike, tangential_force: ArrayLike
) -> LoopFit:
    """Fit G* and mu to a steady loop, or several, of the tangential force over the displacement.

    F_x = F_0 + s (2 F((A + s (u - u_0))/2) - F(A)), s = 1 on rising and -1 on falling displacement,
    with the amplitude A and the middle u_0 of the displacements, and F the force on first loading.

    Parameters
    ----------
    contact : contact under the constant normal load.
    tangential_displacement : in the order of the measurement, exact beside the forces [length],
        shape (k,).
    tangential_force : measured forces [force], shape (k,).

    Returns
    -------
    The parameters with standard errors, and the residuals.

    Raises
    ------
    InputError : lists of different lengths, fewer than six points, or a loop without slip, which
        leaves mu open.

    Examples
    --------
    >>> from mdr_core import history, normal
    >>> from mdr_core.profiles import Paraboloid
    >>> u = 1e-6 * np.sin(np.linspace(0.5, 4.5, 81) * np.pi)
    >>> path = {"normal_force": np.full(82, 10.0), "tangential_displacement": np.append(0.0, u)}
    >>> force = history.solve(Paraboloid(0.01), 2e9, 1.6e9, 0.3, **path).tangential_force[1:]
    >>> ball = normal.solve(Paraboloid(0.01), 2e9, normal_force=10.0)
    >>> found = solve(ball, tangential_displacement=u, tangential_force=force)
    >>> print(f"{found.g_star:.6g} {found.friction_coefficient:.6g}")
    1.6e+09 0.3
    """
    require_type("contact", contact, NormalContact, "a contact from normal.solve")
    if np.ndim(contact.normal_force) or not contact.normal_force > 0:
        raise InputError(("contact",), "must be under a single normal load")
    u, force = _points(tangential_displacement, tangential_force)
    amplitude, middle, size = np.ptp(u) / 2, (u.max() + u.min()) / 2, float(np.ptp(force)) or 1.0
    sign = _directions(u)
    # Displacements on first loading that stand for the points, and the amplitude.
    places = np.append((amplitude + sign * (u - middle)) / 2, amplitude)

    def loop(logarithms: Array) -> tuple[Array, Array, Array]:
        """Forces without offset over `size`, and their slopes in log G* and log mu."""
        g_star, friction = np.exp(logarithms).tolist()
        law = tangential.solve(contact, g_star, friction, tangential_displacement=places)
        # F/(mu E*) depends on G* u/(mu E*) alone, and dF/du = 2 G* c.
        of_g_star = 2 * g_star * law.stick_radius * places
        forces = law.tangential_force, of_g_star, law.tangential_force - of_g_star
        value, *slopes = (sign * (2 * each[:-1] - each[-1]) / size for each in forces)
        return value, *slopes

    def start(ratio: float) -> tuple[float, list[float]]:
        """Least sum of squares for an amplitude over that of full slip, and the parameters."""
        g_star = ratio * float(contact.e_star * contact.indentation_depth) / amplitude
        columns = np.column_stack([loop(np.array([np.log(g_star), 0.0]))[0], np.ones_like(u)])
        (friction, offset), *_ = np.linalg.lstsq(columns, force / size)
        if friction <= 0:
            raise InputError(("tangential_force",), "must rise with the displacement")
        left = columns @ [friction, offset] - force / size
        return float(left @ left), [np.log(friction * g_star), np.log(friction), offset]

    with catch_warnings():
        # Of a covariance that is infinite.
        simplefilter("ignore", OptimizeWarning)
        found, covariance = curve_fit(
            lambda _, *x: loop(np.array(x[:2]))[0] + x[2],
            *(u, force / size, min(map(start, _TRIED))[1]),
            jac=lambda _, *x: np.column_stack([*loop(np.array(x[:2]))[1:], np.ones_like(u)]),
        )
    errors = np.sqrt(np.diag(covariance))
    determined = np.linalg.matrix_rank(np.column_stack(loop(found[:2])[1:]))
    if determined < 2 or not errors[:2].max() < 1:
        detail = "leaves G* or mu open: take an amplitude at which a part of the contact slips"
        raise InputError(("tangential_displacement",), detail)
    g_star, friction = np.exp(found[:2]).tolist()
    errors *= [g_star, friction, size]
    residual = force - size * (loop(found[:2])[0] + found[2])
    return LoopFit(g_star, friction, size * float(found[2]), errors, residual)


def _points(displacement: ArrayLike, force: ArrayLike) -> tuple[Array, Array]:
    """Return displacements and forces, or an InputError."""
    u, measured = as_curve(
        "displacements", tangential_displacement=displacement, tangential_force=force
    )
    if u.size < _FEWEST or np.ptp(u) == 0:
        raise InputError(("tangential_displacement",), f"must hold {_FEWEST} points of a loop")
    return u, measured


def _directions(u: Array) -> Array:
    """Signs of the steps to each displacement; a rest has that of the step before."""
    steps = np.sign(np.diff(u, prepend=u[0]))
    moving = np.flatnonzero(steps)
    last = np.searchsorted(moving, np.arange(u.size), side="right") - 1
    return np.asarray(steps[moving[np.maximum(last, 0)]])
