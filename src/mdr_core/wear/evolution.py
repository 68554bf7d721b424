"""Fretting wear over the number of cycles, from the first to the last that wears anything."""

from math import inf
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import tangential
from mdr_core.checks import extremes, first_index
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact
from mdr_core.typing import Array
from mdr_core.wear.course import Progress
from mdr_core.wear.evolving import WearEvolution
from mdr_core.wear.rates import Control
from mdr_core.wear.scene import Scene

DEFAULT_RESOLUTION: Final = 24
COARSEST: Final = 8
FINEST: Final = 96


def solve(
    contact: NormalContact,
    g_star: float,
    friction_coefficient: float,
    *,
    wear_coefficient: float,
    cycles: ArrayLike,
    tangential_displacement: float | None = None,
    tangential_force: float | None = None,
    resolution: int = DEFAULT_RESOLUTION,
    rtol: float = 1e-6,
    progress: Progress | None = None,
) -> WearEvolution:
    """Return the wear of a contact that is moved to and fro, over the number of cycles.

    df/dN = K mu p(r) S(r), S = 4 |s(r)|: what wears is in proportion to the friction work of a
    cycle at each place, so that dV/dN = K W. The normal load that was given is held, the force
    or else the depth, and so is the amplitude.

    Source: mdr-5, Problem 6; dimaki, the law; notes, §11.

    Parameters
    ----------
    contact : the normal contact before wear, under a single load.
    g_star, friction_coefficient : as of `mdr_core.tangential.solve`; single numbers.
    wear_coefficient : K > 0, worn volume per dissipated energy [1/pressure].
    cycles : numbers of cycles at which to answer, >= 0, ascending, shape (k,).
    tangential_displacement, tangential_force : exactly one, the amplitude of the oscillation
        [length], [force]; the force only where the normal force is held as well.
    resolution : nodes over the worn annulus, 8 to 96.
    rtol : tolerance of the integration over the cycles, 1e-10 to 1e-3.
    progress : is told of the values of the profile's g that have been asked for, each time of
        those since the last; `evaluations` says how many there will be about.

    Raises
    ------
    InputError : several loads; an amplitude at which the whole contact slides; cycles that are
        negative or not ascending; a worn contact that reaches the profile's end.
    AccuracyError : the course could not be resolved.

    Examples
    --------
    The first cycle wears K W, W = (16 mu^2 E*^2/(15 G* R^2)) (a - c)^3 (a^2 + 3 a c + c^2).

    >>> from mdr_core.normal import solve as press
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = press(Paraboloid(1.0), 1.0, indentation_depth=1.0)
    >>> worn = solve(contact, 1.0, 1.0, wear_coefficient=1e-6, cycles=[1.0, 1e9],
    ...     tangential_displacement=0.75)
    >>> [float(f"{volume:.4g}") for volume in worn.worn_volume]
    [3.667e-07, 0.7593]
    """
    amplitude = _amplitude(contact, tangential_displacement, tangential_force)
    for path, value, low, high in (
        (("wear_coefficient",), wear_coefficient, 0.0, inf),
        (("resolution",), resolution, COARSEST - 1, FINEST + 1),
        (("rtol",), rtol, 0.0, 1.0),
    ):
        if not low < value < high:
            raise InputError(path, f"must lie between {low} and {high}")
    for name, number in (
        ("load", contact.contact_radius),
        ("g_star", g_star),
        ("friction_coefficient", friction_coefficient),
    ):
        if np.ndim(number):
            raise InputError((name,), "the wear over the cycles is answered for a single number")
    sideways = tangential.solve(contact, g_star, friction_coefficient, **amplitude)
    if sideways.full_slip.any():
        raise InputError(
            ("tangential", *amplitude),
            "the whole contact slides: no part of it keeps its shape, and it wears without a limit",
        )
    control = Control(
        force=contact.control == "normal_force", displacement=tangential_force is None
    )
    found = WearEvolution(
        Scene(sideways, float(wear_coefficient), control),
        _checked_cycles(cycles),
        int(resolution),
        float(rtol),
        progress,
    )
    # What cannot be answered is to be refused here.
    _ = found.course
    return found


def evaluations(resolution: int, cycles: int, radii: int = 0) -> int:
    """Return about how many values of the profile's g a query takes: its cost beforehand.

    The integrator asks for the nodes a few hundred times, and for as many again for each node
    while it differentiates; the error estimate costs half as much again, cycles and radii next
    to nothing.
    """
    return (_CALLS + _CALLS_A_NODE * resolution) * resolution + cycles * (resolution + 4 * radii)


_CALLS: Final = 800
_CALLS_A_NODE: Final = 60


def _amplitude(
    contact: NormalContact, displacement: float | None, force: float | None
) -> dict[str, float]:
    """The one amplitude that was given, by its name."""
    given = {"tangential_displacement": displacement, "tangential_force": force}
    found = {name: value for name, value in given.items() if value is not None}
    if len(found) != 1:
        raise InputError(("tangential",), f"exactly one of {', '.join(given)} is needed")
    name, value = next(iter(found.items()))
    if np.ndim(value):
        raise InputError(("tangential", name), "a single amplitude is needed")
    if force is not None and contact.control != "normal_force":
        raise InputError(
            ("tangential", name),
            "with the depth held give the displacement: wear would unload the contact until it "
            "no longer carries the force",
        )
    return {name: abs(value)}


def _checked_cycles(cycles: ArrayLike) -> Array:
    numbers = np.asarray(cycles, dtype=float)
    if numbers.ndim != 1 or numbers.size == 0:
        raise InputError(("cycles",), "a list of at least one number is needed")
    low, high = extremes(numbers)
    falls = np.append(False, np.diff(numbers) < 0)
    if not (low >= 0 and high < inf) or falls.any():
        bad = ~((numbers >= 0) & (numbers < inf)) | falls
        raise InputError(
            ("cycles", *first_index(bad)), "must be finite, not negative, and ascending"
        )
    return numbers
