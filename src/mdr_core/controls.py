"""Default number of samples of a load step, by the names of its controls."""

from typing import Final

# With this number of samples the energy of nine curved cycles in ten is within 0.1 %; the error
# falls with the square of the number. Source: http.md, Cost of a coarse path.
_ON_CURVES: Final = 20


def default_samples(normal: str, tangential: str) -> int:
    """Return the samples of a load step on which both controls change.

    One sample is exact on the straight step of a depth with a displacement, or of a normal with a
    tangential force. With controls of different pairs the step is a curve.

    Parameters
    ----------
    normal, tangential : names of the controls, such as ``"normal_force"``.
    """
    of_one_pair = (normal == "normal_force") == (tangential == "tangential_force")
    return 1 if of_one_pair else _ON_CURVES
