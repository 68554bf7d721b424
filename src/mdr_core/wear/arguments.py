"""Arguments that the limiting state and the wear over the cycles have in common."""

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.errors import InputError
from mdr_core.typing import Array
from mdr_core.validation import require_not_negative


def one_amplitude(displacement: ArrayLike | None, force: ArrayLike | None) -> tuple[str, Array]:
    """Return the name and the values of the one amplitude that is prescribed.

    Raises
    ------
    InputError : none or both; no value; a value that is negative or not finite.
    """
    given = {"tangential_displacement": displacement, "tangential_force": force}
    named = [name for name, values in given.items() if values is not None]
    if len(named) != 1:
        raise InputError(("tangential",), f"exactly one of {', '.join(given)} is needed")
    path, values = ("tangential", named[0]), np.asarray(given[named[0]], dtype=float)
    if not values.size:
        raise InputError(path, "at least one amplitude is needed")
    require_not_negative(path, values)
    return named[0], values
