"""Specification of a sweep: query, constants of all cases, and quantities to compute."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from importlib.metadata import version
from typing import Any, Final

from mdr_core import __version__
from mdr_core.impact import Impact
from mdr_core.profiles.base import NORMAL_QUANTITIES
from mdr_core.tangential import TangentialContact
from mdr_core.torsion import TorsionalContact
from mdr_core.validity import MODEL_ERRORS
from mdr_core.wear.evolution import WearEvolution
from mdr_core.wear.limit import LimitingWear

_NORMAL: Final = tuple(name for name in NORMAL_QUANTITIES if name != "maximum_pressure")
PULL_OFF: Final = ("pull_off_force", "pull_off_depth", "retraction")
"""Quantities that only adhesive contacts have."""
QUANTITIES: Final[Mapping[str, tuple[str, ...]]] = {
    "normal": _NORMAL,
    "tangential": (*_NORMAL, *TangentialContact.quantities),
    "torsion": (*_NORMAL, *TorsionalContact.quantities),
    # The first quantities, velocities and numbers of cycles, are left out: they are columns of the
    # input.
    "impact": Impact.quantities[2:],
    "wear": LimitingWear.quantities,
    "evolution": WearEvolution.quantities[1:],
    # Parameters and statistics of a curve; its points and lists of errors are not columns.
    "fit": ("e_star", "contact_point", "force_offset", "work_of_adhesion", "noise", "misfit"),
    "tangential_fit": (
        *("g_star", "friction_coefficient", "force_offset", "rig_compliance"),
        *("noise", "misfit", "dissipated_energy"),
    ),
}
"""Quantities that a sweep computes by default, by query."""
ONLY_IF_NAMED: Final[Mapping[str, tuple[str, ...]]] = {
    "normal": ("maximum_pressure", *MODEL_ERRORS, "data_error", *PULL_OFF),
    "tangential": ("maximum_pressure", "maximum_shear_stress", *MODEL_ERRORS, "data_error"),
    "torsion": ("maximum_pressure", *MODEL_ERRORS, "data_error"),
    **dict.fromkeys(("impact", "wear", "evolution", "tangential_fit"), ("model_error",)),
    "fit": ("youngs_modulus", "youngs_modulus_error", *MODEL_ERRORS),
}
"""Quantities that are computed if they are named. Maxima of fields take a search and can be
infinite; `data_error` is NaN without a table, the pull-off NaN without adhesion, Young's modulus
NaN without Poisson's ratio, and the error of radius and pressure NaN but for round bodies."""
WARNING, ERROR = "warning", "error"
TEXTS: Final = frozenset({"regime", WARNING, ERROR})
"""Columns of the result that are not numbers."""
# Packages on which the last digits of the result, and the bytes of its file, depend.
_PACKAGES: Final = ("numpy", "scipy", "pyarrow")


class SweepStatus(IntEnum):
    """Exit status of a sweep; docs/sweeps.md lists them."""

    DONE = 0
    ENDED_EARLY = 1
    INVALID_INPUT = 2
    """The status with which argparse reports invalid arguments."""
    ALL_FAILED = 3
    INTERRUPTED = 130
    """The status with which shells report programs terminated by SIGINT."""


class SweepError(Exception):
    """The sweep cannot continue; completed chunks are kept."""


class UsageError(SweepError):
    """The sweep is not valid; nothing was computed."""


@dataclass(frozen=True)
class Spec:
    """Specification that all chunks of a sweep share.

    Parameters
    ----------
    query : name of the query, of `QUANTITIES`.
    constants : fields of all cases, by their dotted names.
    quantities : quantities to compute, in the order of the result.
    kept : columns of the input that are copied but not interpreted.
    """

    query: str
    constants: Mapping[str, Any]
    quantities: tuple[str, ...]
    kept: tuple[str, ...] = ()


def versions() -> dict[str, str]:
    """Return the versions of the packages on which the result depends."""
    return {"mdr": __version__} | {name: version(name) for name in _PACKAGES}
