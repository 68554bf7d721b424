"""Energy lost to friction where the load goes along arcs: int R dxi over every piece.

All that is above the slip front slips by the fall of the sum xi that binds it, under

    R = I(d) - I(w) - 2 x(w) (d - w) = 2 int (x' - x(w)) dw' from the front to the edge.

The front w and the load d are on arcs, both known by the contact coordinate. What the two move
together is the variable, v = +-s(d) - s(w): neither of them has a root in it where its own arc is
as steep as the cone. Where forces are levels dxi is in forces, and dw = dI/(2x).
Source: notes, §10.
"""

from typing import Final, NamedTuple

import numpy as np

from mdr_core.history.adaptive import Integral, integrate
from mdr_core.history.arcs import Plane, rising_root
from mdr_core.history.branches import integral
from mdr_core.history.vertices import Points, Slips
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Indices

# Up to this part of the radius an annulus is narrow: a difference would lose digits.
_NARROW: Final = 0.1
# Rows are cut where they meet a break, up to so many: those of a long table are small.
_MOST_CUTS: Final = 16_384
# To a looser tolerance a table's breaks are not felt.
_FINE: Final = 5e-4


class _Rows(NamedTuple):
    """Pieces, or slides, with the load that moves."""

    sign: Array
    way: Array
    load_rate: Array
    load_from: Array
    load_to: Array
    entered: Array
    left: Array
    """How far the sum is below its start as the front enters and leaves."""
    fall: Array
    """The same at the end of the step."""
    front_rate: Array
    """NaN on a face of the cone."""
    upper: Array
    lower: Array
    """Coordinates between which the front runs."""
    begun: Array
    """Level and other of the load at first, and of the front."""
    begun_other: Array
    entry: Array
    entry_other: Array

    @property
    def load_range(self) -> tuple[Array, Array]:
        """Least and largest coordinate of the load."""
        ends = self.load_from, self.load_to
        return np.minimum(*ends), np.maximum(*ends)

    def spread(self, shape: tuple[int, ...]) -> "_Rows":
        """All of them broadcast, along one axis."""
        return _Rows(*(np.broadcast_to(part, shape).ravel() for part in self))

    def at(self, index: Indices | Flags) -> "_Rows":
        """Some of the rows, of any shape."""
        return _Rows(*(part[index] for part in self))


def per_step(plane: Plane, points: Points, slips: Slips, rtol: float) -> Integral:
    """Return D/(mu E*) [length^3] of every step, and what may be missing of each."""
    count = points.level.size
    if not slips.step:
        return Integral(np.zeros(count), np.zeros(count))
    step = np.array(slips.step, dtype=np.intp)
    sign, entered, left, fall, rate, s_up, y_up, s_low, y_low = np.array(slips.row).T
    slides = np.isnan(y_up)
    ends = [np.where(slides, 0.0, part) for part in (s_up, y_up, s_low, y_low)]
    before = np.append(plane.profile.first_coordinate, points.coordinate[:-1])
    begin, upper = before[step], _known(plane, ends[0], ends[1])
    rows = _Rows(
        sign,
        points.way[step],
        points.rate[step],
        begin,
        points.coordinate[step],
        entered,
        left,
        fall,
        rate,
        upper,
        _known(plane, ends[2], ends[3]),
        plane.level(begin),
        plane.other(begin),
        plane.level(upper),
        plane.other(upper),
    )
    parts = []
    for chosen, of_everything in ((~slides, False), (slides, True)):
        if chosen.any():
            own = rows.at(chosen)
            found = _Loss(plane, own, of_everything=of_everything).integral(rtol)
            parts.append((step[chosen], found))
    value, missing = (
        sum(np.bincount(index, found[k], count) for index, found in parts) for k in (0, 1)
    )
    return Integral(np.asarray(value), np.asarray(missing))


def _known(plane: Plane, s: Array, level: Array) -> Array:
    """The coordinates, found by their levels where they are not known."""
    missing = np.isnan(s)
    if missing.any():
        s[missing] = plane.at_level(level[missing])
    return s


class _Loss:
    """The integrand, over rows that are all pieces or all slides."""

    def __init__(self, plane: Plane, rows: _Rows, *, of_everything: bool) -> None:
        self._plane = plane
        self._rows = rows
        self._slides = of_everything

    def integral(self, rtol: float) -> Integral:
        """Return int R dxi of every row."""
        rows = self._rows
        if self._plane.profile.coordinate_breaks.size > 1 and not self._slides:
            # A table's slopes are infinite at its breaks, unless it is smooth.
            pieces = self._cut_by_sum(rtol)
            found = integrate(self._by_sum, pieces, rtol / 20, rough=True, smooth=False)
        else:
            rough = bool(self._plane.profile.coordinate_breaks.size)
            found = integrate(self._density, self._cut(), rtol / 20, rough=rough)
        short = rows.way.size - found.value.size
        return Integral(*(np.append(part, np.zeros(short)) for part in found))

    def _cut(self) -> tuple[Indices, Array, Array]:
        """Ends of the variable, and where the front or the load is on a break of the profile."""
        rows, breaks = self._rows, self._plane.profile.coordinate_breaks
        first, last = (
            self._variable(rows.way, self.load_at(over), front, over)
            for over, front in ((rows.entered, rows.upper), (rows.left, rows.lower))
        )
        owners, places = [np.arange(first.size)] * 2, [first, last]
        for at in breaks.tolist():
            for found in self._meetings(at):
                owners.append(found[0])
                places.append(found[1])
        return _between(owners, places, first, last)

    def _variable(self, way: Array, load: Array, front: Array, over: Array) -> Array:
        if self._slides:
            return np.where(way == 0, over, way * load)
        return way * load - front

    def load_at(self, over: Array) -> Array:
        """Coordinate of the load when its sum has fallen so far."""
        rows = self._rows
        inner = np.flatnonzero((over > 0) & (over < rows.fall) & (rows.way != 0))
        some, goal = rows.at(inner), over[inner]

        def miss(index: Indices, s: Array) -> tuple[Array, Array]:
            own = some.at(index)
            value, slope = self._load(own, s)
            # It falls on the way: where the coordinate grows it falls with it.
            return -own.way * (value + goal[index]), -own.way * slope

        found = np.where(over > 0, rows.load_to, rows.load_from)
        found[inner] = rising_root(miss, *some.load_range)
        return found

    def _load(self, rows: _Rows, s: Array) -> tuple[Array, Array]:
        """The load's sum above its start, and its slope."""
        plane, rate = self._plane, rows.sign * rows.load_rate
        value = plane.level(s) - rows.begun + rate * (plane.other(s) - rows.begun_other)
        steep = plane.slopes(s)
        return value, steep[0] + rate * steep[1]

    def _front(self, rows: _Rows, s: Array) -> tuple[Array, Array]:
        """The front's sum above the load's start, and its slope."""
        plane, face = self._plane, np.isnan(rows.front_rate)
        rate = np.where(face, 0.0, rows.sign * rows.front_rate)
        times = np.where(face, 2.0, 1.0)
        value = times * (plane.level(s) - rows.entry)
        value = value + rate * (plane.other(s) - rows.entry_other) - rows.entered
        steep = plane.slopes(s)
        return value, times * steep[0] + rate * steep[1]

    def _cut_by_sum(self, rtol: float) -> tuple[Indices, Array, Array]:
        """The same where the sum itself is the variable."""
        rows, breaks = self._rows, self._plane.profile.coordinate_breaks
        owners, places = [np.arange(rows.way.size)] * 2, [rows.entered, rows.left]
        most = _MOST_CUTS if rtol < _FINE else 0
        for low, high, moved in (
            (rows.lower, rows.upper, self._front),
            (*rows.load_range, self._load),
        ):
            first, last = np.searchsorted(breaks, low, side="right"), np.searchsorted(breaks, high)
            count = np.maximum(last - first, 0)
            if count.sum() > most:
                continue
            owner = np.repeat(np.arange(count.size), count)
            at = np.arange(owner.size) - np.repeat(np.cumsum(count) - count, count) + first[owner]
            value, _ = moved(rows.at(owner), breaks[at])
            owners.append(owner)
            places.append(-value)
        return _between(owners, places, rows.entered, rows.left)

    def _meetings(self, at: float) -> list[tuple[Indices, Array]]:
        """Rows, and values of the variable, where the load or the front is on a break."""
        rows, found = self._rows, []
        low, high = rows.load_range
        met = np.flatnonzero((low < at) & (at < high) & (rows.way != 0))
        if self._slides:
            return [(met, rows.way[met] * at)]
        s = np.full(met.size, at)
        value, _ = self._load(rows.at(met), s)
        own = (rows.entered[met] < -value) & (-value < rows.left[met])
        met, s, value = met[own], s[own], value[own]
        front = self._front_at(rows.at(met), value)
        found.append((met, rows.way[met] * s - front))
        met = np.flatnonzero((rows.lower < at) & (at < rows.upper))
        some, s = rows.at(met), np.full(met.size, at)
        value, _ = self._front(some, s)
        load = _Loss(self._plane, some, of_everything=False).load_at(-value)
        return [*found, (met, some.way * load - s)]

    def _front_at(self, rows: _Rows, value: Array) -> Array:
        def miss(index: Indices, s: Array) -> tuple[Array, Array]:
            own, slope = self._front(rows.at(index), s)
            return own - value[index], slope

        return rising_root(miss, rows.lower, rows.upper)

    def _density(self, owner: Indices, v: Array) -> Array:
        """R dxi/dv."""
        rows = self._rows.at(owner)
        profile = self._plane.profile
        if self._slides:
            s = np.where(rows.way == 0, rows.load_from, rows.way * v)
            _, slope = self._load(rows, s)
            return profile.reduced_force(s) * np.where(rows.way == 0, 1.0, -rows.way * slope)
        front = self._front_of(rows, v)
        lateral = rows.way == 0
        load = np.where(lateral, rows.load_from, rows.way * (v + front))
        _, front_slope = self._front(rows, front)
        _, load_slope = self._load(rows, load)
        falls = -rows.way * load_slope
        with np.errstate(all="ignore"):
            both = front_slope * falls / (front_slope + falls)
        slope = np.where(lateral, front_slope, np.where(np.isfinite(both), both, 0.0))
        return self._overlap(front, np.maximum(load, front)) * slope

    def _by_sum(self, owner: Indices, over: Array) -> Array:
        """R, where the sum has fallen so far: slopes that are infinite at breaks do no harm."""
        shape = np.broadcast_shapes(owner.shape, over.shape)
        rows, over = self._rows.at(owner).spread(shape), np.broadcast_to(over, shape).ravel()
        part = _Loss(self._plane, rows, of_everything=False)
        front = part._front_at(rows, -over)
        load = part.load_at(over)
        return self._overlap(front, np.maximum(load, front)).reshape(shape)

    def _overlap(self, front: Array, edge: Array) -> Array:
        """R [length^2], or R/2x [length]."""
        gap = overlap(self._plane.profile, front, edge)
        return (
            gap / (2 * self._plane.profile.contact_radius(front)) if self._plane.by_force else gap
        )

    def _front_of(self, rows: _Rows, v: Array) -> Array:
        """Coordinate of the front where load and front have moved by v."""
        lateral = rows.way == 0
        if lateral.all():
            return -v
        shape = v.shape
        rows, v = rows.spread(shape), v.ravel()
        lateral = rows.way == 0

        def miss(index: Indices, s: Array) -> tuple[Array, Array]:
            chosen = rows.at(index)
            own, own_slope = self._front(chosen, s)
            load, slope = self._load(chosen, chosen.way * (v[index] + s))
            return own - load, own_slope - chosen.way * slope

        low = np.maximum(rows.lower, self._least(rows, v))
        high = np.maximum(np.minimum(rows.upper, self._most(rows, v)), low)
        moving = np.flatnonzero(~lateral)
        front = -v
        front[moving] = rising_root(
            lambda index, s: miss(moving[index], s), low[moving], high[moving]
        )
        return front.reshape(shape)

    @staticmethod
    def _least(rows: _Rows, v: Array) -> Array:
        """Front below which the load would be off its way."""
        return np.where(rows.way > 0, rows.load_from - v, -rows.load_from - v)

    @staticmethod
    def _most(rows: _Rows, v: Array) -> Array:
        return np.where(rows.way > 0, rows.load_to - v, -rows.load_to - v)


def overlap(profile: Profile, front: Array, edge: Array) -> Array:
    """R = 2 int (x - x(front)) dw between two contact coordinates [length^2]."""
    ends = profile.contact_radius(front), profile.contact_radius(edge)
    narrow = ends[1] - ends[0] < _NARROW * ends[1]
    breaks = profile.coordinate_breaks
    if breaks.size > 1:
        # A difference over several breaks keeps digits enough; a rule takes one of them.
        narrow &= np.searchsorted(breaks, edge) - np.searchsorted(breaks, front, "right") <= 1
    wide = profile.reduced_force(edge) - profile.reduced_force(front)
    wide = wide - 2 * ends[0] * (profile.depth(edge) - profile.depth(front))
    if not narrow.any():
        return wide
    low, high = front[narrow], edge[narrow]
    span = high - low

    def density(left: Array, s: Array) -> Array:
        # How far from the front, where it has its digits.
        moved = profile.radius_width(s, np.maximum(span[..., None] - left, 0.0))
        return 2 * moved * profile.depth_slope(s)

    found = np.array(wide)
    found[narrow] = integral(density, low, span, breaks)
    return found


def _between(
    owners: list[Indices], places: list[Array], first: Array, last: Array
) -> tuple[Indices, Array, Array]:
    """Owners and ends of what is between neighbouring places of each owner."""
    owner, place = np.concatenate(owners), np.concatenate(places)
    place = np.clip(place, np.minimum(first, last)[owner], np.maximum(first, last)[owner])
    order = np.lexsort((place, owner))
    owner, place = owner[order], place[order]
    same = (owner[1:] == owner[:-1]) & (place[1:] > place[:-1])
    return owner[:-1][same], place[:-1][same], place[1:][same]
