"""Largest von Mises and shear stress of a contact, and their places."""

from math import ceil, inf, log
from typing import Final, NamedTuple

import numpy as np

from mdr_core.errors import InputError
from mdr_core.fields import graded
from mdr_core.subsurface.foundation import Contact, Foundation, foundations, shape_of
from mdr_core.subsurface.stress import Rings, on_rings
from mdr_core.typing import Array
from mdr_core.validity import infinite_deviator

# Radii, and depths per e-fold, of the first grid. The radii cluster at the axis, the edges and the
# breaks; the depths lie between these parts of the contact radius.
_RADII, _PER_E_FOLD, _SHALLOWEST, _DEEPEST = 24, 2, 1e-4, 2.0
# Directions of the first grid; the field is symmetric.
_DIRECTIONS: Final = np.linspace(0, np.pi, 7)
# Peaks of the first grid that are refined, and the points across a box around each.
_PEAKS: Final = 3
_ACROSS: Final = np.linspace(-1, 1, 7)
# A round shrinks the boxes to the distance of these points.
_SHRINK: Final = 1 / 3
# A smooth peak is missed by the square of the last box's size.
_ROUNDS: Final = 8
# Tolerance of the stresses.
_RTOL: Final = 1e-7

MEASURES: Final = ("von_mises", "maximum_shear")


class Peak(NamedTuple):
    """Largest value of a measure of stress under each load, and its place; shape of the loads.

    Where the stress is infinite, the place is a radius of infinite pressure on the surface.
    """

    value: Array
    """[pressure]"""
    x: Array
    """[length]"""
    y: Array
    """[length], >= 0: the field is symmetric."""
    z: Array
    """[length]"""


def largest(
    contact: Contact,
    measure: str = "von_mises",
    *,
    poissons_ratio: float,
    body: int = 1,
    rounds: int = _ROUNDS,
    limit: float = inf,
) -> Peak:
    """Return the largest von Mises or shear stress in a body under each load, and its place.

    It is found by a grid over the half-space and its surface, refined around its highest points
    to a relative accuracy of about 1e-6.

    Source: notes, §14.

    Parameters
    ----------
    contact : a normal contact, or one that is loaded tangentially as well, under any loads; or
        the state at the end of a load history.
    measure : "von_mises" or "maximum_shear".
    poissons_ratio : of this body [1].
    body : 1 for the body of the profile, 2 for the other.
    rounds : refinements of the grid; each reduces the error of a smooth peak by nine.
    limit : stop at a stress above this one, or if the grid finds less than half of it [pressure].

    Raises
    ------
    InputError : another measure.

    Examples
    --------
    Hertz' contact, nu = 0.3: 0.31 p_0 at the depth 0.481 a, Johnson's section 4.2.

    >>> from mdr_core.normal import solve
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(2.0), 3.0, contact_radius=0.1)
    >>> peak = largest(contact, "maximum_shear", poissons_ratio=0.3)
    >>> [round(float(one), 3) for one in (peak.value / contact.maximum_pressure, peak.z / 0.1)]
    [0.31, 0.481]
    """
    if measure not in MEASURES:
        raise InputError(("measure",), f"must be one of {', '.join(MEASURES)}")
    found = []
    for under in foundations(contact, _RTOL):
        search = _Search(under, measure, poissons_ratio, body)
        found.append(search.peak(rounds, limit) if under.pressed else (0.0, 0.0, 0.0, 0.0))
    return Peak(*np.array(found).T.reshape(4, *shape_of(contact)))


class _Search(NamedTuple):
    """A case, and a measure of the stress in one of the bodies."""

    under: Foundation
    measure: str
    poissons_ratio: float
    body: int

    def at(self, r: Array, z: Array, angle: Array) -> Array:
        """Return the measure at points; zero where it is infinite.

        Parameters
        ----------
        r, z : radii and depths [length], shape (m,).
        angle : directions, shape (k, m).
        """
        place = Rings(r, z, np.cos(angle), np.sin(angle))
        found = on_rings(self.under, place, self.poissons_ratio, self.body)
        values = np.asarray(getattr(found, self.measure))
        return np.where(np.isinf(values), 0.0, values)

    def peak(self, rounds: int, limit: float) -> tuple[float, float, float, float]:
        """Return the value and the place of the largest stress; parameters: see `largest`."""
        edges, profile = self.under.edges, self.under.profile
        a = edges[-1]
        for b in profile.infinite_pressure_radii:
            ratios, slips_from = (self.poissons_ratio,), self.under.slips_from
            if b <= a and infinite_deviator(profile, b, ratios, slips_from):
                return inf, float(np.asarray(b)), 0.0, 0.0
        stops = np.unique([0.0, *edges, *(float(b) for b in profile.breaks if b < a)])
        r = graded(np.append(stops, 1.5 * a), max(_RADII, 4 * stops.size))
        shallow = min(_SHALLOWEST * a, 0.1 * float(np.diff(stops).min()))
        count = ceil(_PER_E_FOLD * log(_DEEPEST * a / shallow))
        z = np.append(0.0, np.geomspace(shallow, _DEEPEST * a, count))
        angle = _DIRECTIONS if self.under.sheared else np.zeros(1)
        at_r, at_z = (part.ravel() for part in np.meshgrid(r, z, indexing="ij"))
        values = self.at(at_r, at_z, np.repeat(angle[:, None], at_r.size, axis=1))
        values = values.T.reshape(r.size, z.size, angle.size)
        steps = [
            np.maximum(np.diff(axis, append=axis[-1]), np.diff(axis, prepend=axis[0]))
            for axis in (r, z, angle)
        ]
        best, (centre, box) = float(values.max()), np.empty((2, _PEAKS, 3))
        for peak in range(_PEAKS):
            i, j, k = map(int, np.unravel_index(int(np.argmax(values)), values.shape))
            centre[peak], box[peak] = (
                [axis[place] for axis, place in zip(axes, (i, j, k), strict=True)]
                for axes in ((r, z, angle), steps)
            )
            # Its neighbours are not peaks of their own.
            values[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2] = -1.0
        value = np.full(_PEAKS, best)
        if best < limit and (limit == inf or best > limit / 2):
            for _ in range(rounds):
                centre, value = self._refined(centre, box)
                box *= _SHRINK
                if value.max() >= limit:
                    break
        top = int(np.argmax(value))
        at, depth, turn = centre[top].tolist()
        # sin(pi) is not zero in double precision.
        y = 0.0 if turn == np.pi else at * np.sin(turn)
        return float(value[top]), at * np.cos(turn), y, depth

    def _refined(self, centre: Array, box: Array) -> tuple[Array, Array]:
        """Return the highest points of boxes in r, z and angle, shape (peaks, 3), and values."""
        around = _ACROSS if box[:, 2].any() else np.zeros(1)
        across, down = (part.ravel() for part in np.meshgrid(_ACROSS, _ACROSS, indexing="ij"))
        every = np.arange(len(centre))
        r = np.maximum(centre[:, :1] + box[:, :1] * across, 0.0)
        z = np.maximum(centre[:, 1:2] + box[:, 1:2] * down, 0.0)
        angle = np.clip(centre[:, 2:] + box[:, 2:] * around, 0.0, np.pi)
        values = self.at(r.ravel(), z.ravel(), np.repeat(angle.T, across.size, axis=1))
        values = values.reshape(around.size, len(centre), across.size)
        flat = np.moveaxis(values, 0, 1).reshape(len(centre), -1)
        turn, place = np.divmod(flat.argmax(axis=1), across.size)
        return np.stack([r[every, place], z[every, place], angle[every, turn]], 1), flat.max(axis=1)
