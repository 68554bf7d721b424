"""State of a load history, as JSON holds it, from which another history carries on."""

from collections.abc import Mapping, Sequence
from hashlib import sha256
from typing import Any, Final, NamedTuple, Self

import numpy as np

from mdr_core.doubles import ROUNDING
from mdr_core.errors import InputError
from mdr_core.history import slip_memory
from mdr_core.history.slip_layout import NORMAL
from mdr_core.history.slip_memory import Polyline
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# Numbers of an arc.
_ARC: Final = 3
SETS: Final = 3
"""Sets of chords from which the results of nonlinear load steps are extrapolated."""
# Attributes that define a table, which has no parameters.
_TABLE: Final = ("r", "values", "breaks", "uncertainty")


class SavedState(NamedTuple):
    """State between two load steps."""

    contact: str
    """Digest of the profile, the moduli, the friction coefficient and the controls."""
    normal: float
    """Prescribed depth or normal force."""
    tangential: float
    """Prescribed displacement or tangential force."""
    dissipated_energy: float
    """Energy dissipated by friction since the bodies were unloaded."""
    regime: str
    """Slip regime."""
    polylines: Sequence[Sequence[Sequence[float]]]
    """Polyline of the slip memory, or those on each set of chords of nonlinear load steps.

    They have the vertices below the load point, from the axis: the sums normal + anchor and normal
    - anchor, and where the segment above is part of an arc its rate, and the conjugate and the
    tangential coordinate of its end.
    """

    @classmethod
    def parsed(cls, given: Mapping[str, Any], contact: str) -> Self:
        """Return the state of a `contact` from its members; raise InputError if it is of none."""
        if given["contact"] != contact:
            detail = "belongs to another profile, material, friction coefficient or control"
            raise InputError(("initial_state", "contact"), f"{detail}: repeat those of the state")
        if len(given["polylines"]) not in {1, SETS}:
            raise InputError(("initial_state", "polylines"), f"must be one polyline, or {SETS}")
        return cls(**given)

    def restored(self, normal: float, tangential: float) -> tuple[tuple[Polyline, ...], Array]:
        """Return the polylines up to the load point, and the arcs, shape (3, m).

        The load steps of the segments are the indices of their arcs, from the end.

        Raises InputError if a polyline is impossible, because friction limits its slope.
        """
        place = "initial_state", "polylines"
        empty = {not line for line in self.polylines} | {self.regime == "no_contact"}
        if empty != {normal <= 0}:
            raise InputError(place, "must be empty, and the regime no_contact, only in separation")
        if normal <= 0:
            lines = [slip_memory.separated(normal, tangential)] * len(self.polylines)
            return tuple(lines), np.zeros((_ARC, 0))
        columns, none = NORMAL + _ARC, [0.0] * _ARC
        rows = [np.array([(*row, *none)[:columns] for row in line]) for line in self.polylines]
        arcs, labels = np.unique(np.concatenate(rows)[:, NORMAL:], axis=0, return_inverse=True)
        label, found = iter((labels.ravel() - len(arcs)).tolist()), []
        for index, vertices in enumerate(rows):
            sums, steps = vertices[:, :NORMAL], [next(label) for _ in vertices]
            line = slip_memory.through(sums, steps, normal, tangential)
            growth = np.diff(line.vertices[:, :NORMAL], axis=0)
            # By rounding a sum may decrease along a polyline.
            good = (growth.min(axis=1) >= -ROUNDING * normal) & (growth.max(axis=1) > 0)
            good[0] &= line.vertices[0, NORMAL] == 0
            if not good.all():
                detail = "exceeds the next vertex in a sum, or is the first one and not on the axis"
                raise InputError((*place, index, int(np.argmin(good))), detail)
            found.append(line)
        return tuple(found), arcs.T


UNLOADED: Final = SavedState("", 0.0, 0.0, 0.0, "no_contact", ([],))
"""State of bodies before first contact."""


def saved(line: Polyline, arcs: Array | None) -> list[list[float]]:
    """Return the vertices of a polyline below the load point, as `SavedState` has them."""
    rows = line.vertices[:-1, :NORMAL].tolist()
    if arcs is None:
        return rows
    above = arcs[:, line.load_step[1:]].T.tolist()
    return [row + arc if arc[0] else row for row, arc in zip(rows, above, strict=True)]


def digest(profile: Profile, *others: object) -> str:
    """Return a digest of a profile and other values."""
    names = profile.parameters or _TABLE
    own = {name: np.asarray(getattr(profile, name)).tolist() for name in names}
    return sha256(repr((profile.kind, own, others)).encode()).hexdigest()[:16]
