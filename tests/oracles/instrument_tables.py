"""Tables as instruments, meshes and spreadsheets write them, each with the body that it measures.

A habit is what a file does to exact heights: it rounds, quantises, adds noise, offsets or repeats
points. `drawn` combines several habits at random, as files do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mdr_core import normal
from mdr_core.profiles import Tabulated
from tests.oracles.bodies import BODIES, AreaFunction, Body

if TYPE_CHECKING:
    from numpy.random import Generator

    Array = np.ndarray


@dataclass(frozen=True)
class InstrumentTable:
    """Points of a body, in the units of the file.

    Parameters
    ----------
    name : body, number of points, and habits.
    kind : what happened to the heights, for statistics.
    r, f : points of the file [length], shape (k,).
    body : what was measured.
    length, height : units of the radii and heights of the body in those of the file.
    end : last radius at which the table shows the body, in units of the body.
    error : standard error of the heights, due to noise and the rounding of r and f [length].
    breaks, uncertainty : what the user declares.
    single_disc : False if the file shows more than the body, of another shape than a disc allows.
    """

    name: str
    kind: str
    r: Array
    f: Array
    body: Body
    length: float
    height: float
    end: float
    error: float
    breaks: tuple[float, ...] = ()
    uncertainty: float | None = None
    single_disc: bool = True

    def depth(self, radius: float) -> float:
        """Depth at a contact radius in units of the file."""
        return self.height * self.body.depth(radius / self.length)

    def force(self, radius: float) -> float:
        """F_N/E* at a contact radius in units of the file."""
        return self.height * self.length * self.body.force(radius / self.length)

    @property
    def rise(self) -> float:
        """Height of the body in the table [length]."""
        return self.height * float(self.body.f(np.array(self.end)))

    def radii(self) -> list[float]:
        """Contact radii within the body whose depth is at least 5 % of its height [length]."""
        places = [self.length * self.end * part for part in (0.15, 0.3, 0.45, 0.6, 0.75, 0.9)]
        flat = self.length * self.body.flat
        return [a for a in places if a > 1.02 * flat and self.depth(a) >= 0.05 * self.rise]


def radii(random: Generator, count: int, end: float, spacing: str) -> Array:
    """Ascending radii from zero to `end`."""
    if spacing == "geometric":
        return np.append(0.0, end * np.geomspace(10 ** random.uniform(-3, -1), 1.0, count - 1))
    if spacing == "random":
        return np.sort(np.r_[0.0, end, random.uniform(0, end, count - 2)])
    power = {"uniform": 1.0, "graded": 2.0, "coarse tip": 0.7}[spacing]
    return end * np.linspace(0.0, 1.0, count) ** power


def rounded(values: Array, decimals: int) -> Array:
    """Numbers as written with `decimals` decimals after the leading digit of the largest."""
    largest = float(np.abs(values).max())
    place = decimals - int(np.floor(np.log10(largest))) if largest else decimals
    return np.round(values, place)


def significant(values: Array, digits: int) -> Array:
    """Numbers as written with `digits` significant digits each."""
    return np.array([float(f"{value:.{digits - 1}e}") for value in values.tolist()])


def quantised(values: Array, step: float) -> Array:
    """Heights of an instrument of that resolution."""
    return np.round(values / step) * step


def waviness(random: Generator, r: Array, size: float, length: float) -> Array:
    """Roughness with a given standard deviation and correlation length."""
    waves = 2 * np.pi * random.standard_normal(40) / length
    phases = random.uniform(0, 2 * np.pi, 40)
    return np.asarray(size * np.sqrt(2 / 40) * np.cos(np.outer(r, waves) + phases).sum(axis=1))


#: Habits of heights and radii, of which a file has one; each with its share.
RECORDS = {
    "exact": 4,
    "decimals": 5,
    "significant digits": 3,
    "float32": 2,
    "resolution": 3,
    "noise 0.1 %": 4,
    "noise 1 %": 2,
    "waviness": 2,
}
DIGITAL = ("decimals", "significant digits", "float32", "resolution")


def drawn(seed: int, name: str | None = None, most: int = 2000) -> InstrumentTable:
    """Return a table of a body (any, if not given) with habits of its own."""
    random = np.random.default_rng(seed)
    name = name or str(random.choice(list(BODIES)))
    body, shares = BODIES[name], np.array(list(RECORDS.values()))
    record = str(random.choice(list(RECORDS), p=shares / shares.sum()))
    count = int(np.exp(random.uniform(np.log(16), np.log(400 if random.random() < 0.9 else most))))
    habits = [name, f"{count} points", record]
    breaks = body.kinks if body.kinks and random.random() < 0.5 else ()
    r = _places(random, body, count, breaks, habits)
    f, rise = body.f(r), float(body.f(np.array(body.end)))
    r, f, single_disc = _surroundings(random, body, r, f, habits)
    # Units of the file, and how steep the body is.
    length = 1.0 if random.random() < 0.5 else float(10 ** random.uniform(-9, 3))
    height = length * float(10 ** random.uniform(-2, 0.3))
    r, f, rise = length * r, height * f, height * rise
    exact_r, exact_f = r, f
    f, known = _measured(random, record, f, r, rise)
    offset = float(random.choice([0.0, 0.0, 0.3, -1.0, 20.0])) * rise
    habits += ["offset"] if offset else []
    r, f = _written(random, record, r, f + offset, rise)
    error = known
    if record in DIGITAL:
        steepest = body.df(0.9 * body.end) * height / length
        moved = np.hypot(f - offset - exact_f, steepest * (r - exact_r))
        error = float(np.sqrt(np.mean(moved**2)))
    index = _order(random, r.size, habits)
    # A break is the radius as the file has it.
    declared = tuple(float(r[np.argmin(np.abs(r - length * b))]) for b in breaks)
    return InstrumentTable(
        name=", ".join(habits),
        kind=next((habit for habit in habits if habit in {"wall", "ledge"}), record),
        r=r[index],
        f=f[index],
        body=body,
        length=length,
        height=height,
        end=body.end,
        error=error,
        breaks=declared,
        uncertainty=known if known and random.random() < 0.7 else None,
        single_disc=single_disc,
    )


def _places(
    random: Generator, body: Body, count: int, breaks: tuple[float, ...], habits: list[str]
) -> Array:
    """Radii of the points, negative on the other side of the axis."""
    spacing = str(random.choice(["uniform"] * 4 + ["graded", "coarse tip", "geometric", "random"]))
    habits.append(spacing)
    r = radii(random, count, body.end, spacing)
    if random.random() < 0.25:
        r = np.append(random.uniform(0.1, 0.9) * r[1], r[1:])
        habits.append("first radius above 0")
    if random.random() < 0.3:
        other = r if random.random() < 0.5 else radii(random, count, body.end, "random")
        r = np.append(-other[::-1], r)
        habits.append("both sides")
    if breaks:
        habits.append("declared breaks")
        return np.sort(np.append(r, breaks))
    habits += ["undeclared kink"] if body.kinks else []
    if random.random() < 0.2:
        some = random.choice(r, max(1, count // 8))
        gap = float(random.choice([0.0, 1e-7, 1e-6, 1e-4]))
        r = np.append(r, some * (1 + gap * random.uniform(-1, 1, some.size)))
        habits.append("near radii" if gap else "repeated radii")
    return r


def _surroundings(
    random: Generator, body: Body, r: Array, f: Array, habits: list[str]
) -> tuple[Array, Array, bool]:
    """Add what a file shows beyond the body: a wall, or a ledge, which is not a single disc."""
    draw = random.random()
    if draw > 0.12:
        return r, f, True
    beyond = body.end * np.linspace(1.02, random.uniform(1.3, 3.0), max(5, r.size // 5))
    slope = 3 * body.df(body.end) if draw < 0.08 else 0.0
    last = float(body.f(np.array(body.end)))
    habits.append("wall" if slope else "ledge")
    return np.append(r, beyond), np.append(f, last + slope * (beyond - body.end)), slope > 0


def _measured(
    random: Generator, record: str, f: Array, r: Array, rise: float
) -> tuple[Array, float]:
    """Heights with the errors of the instrument, and the standard deviation that it states."""
    if record.startswith("noise"):
        size = rise * (0.01 if record == "noise 1 %" else 0.001)
        return f + size * random.standard_normal(f.size), size
    if record == "waviness":
        size = rise * float(10 ** random.uniform(-4, -2))
        waves = float(np.abs(r).max() * random.uniform(0.02, 0.2))
        return f + waviness(random, r, size, waves), size
    if record == "resolution":
        return quantised(f, rise / float(random.integers(50, 5000))), 0.0
    return f, 0.0


def _written(
    random: Generator, record: str, r: Array, f: Array, rise: float
) -> tuple[Array, Array]:
    """Numbers as the file has them."""
    digits = int(random.integers(3, 8))
    if record == "decimals":
        # Digits of the rise, whatever the offset.
        return rounded(r, digits), np.round(f, digits - int(np.floor(np.log10(rise))))
    if record == "significant digits":
        # As many as a careful user writes: an offset takes two.
        more = 2 if abs(f[0]) > rise else 0
        return significant(r, digits + 1), significant(f, digits + more)
    if record == "float32":
        return r.astype(np.float32).astype(float), f.astype(np.float32).astype(float)
    return r, f


def _order(random: Generator, count: int, habits: list[str]) -> Array:
    order = str(random.choice(["ascending"] * 4 + ["descending", "shuffled"]))
    habits.append(order)
    index = np.arange(count)
    if order == "shuffled":
        return random.permutation(index)
    return index if order == "ascending" else index[::-1]


def noisy(name: str, count: int, noise: float, seed: int) -> InstrumentTable:
    """Return a table with white noise relative to the rise, and with its uncertainty."""
    random, body = np.random.default_rng(seed), BODIES[name]
    r = np.linspace(0.0, body.end, count)
    rise = float(body.f(np.array(body.end)))
    f = body.f(r) + noise * rise * random.standard_normal(count)
    return InstrumentTable(
        name=f"{name}, {count} points, noise {noise:g}",
        kind=f"noise {noise:g}",
        r=r,
        f=f,
        body=body,
        length=1.0,
        height=1.0,
        end=body.end,
        error=noise * rise,
        uncertainty=noise * rise,
    )


def _table(
    name: str, r: Array, f: Array, body: Body, length: float, height: float, error: float
) -> InstrumentTable:
    end = float(np.abs(r).max()) / length
    return InstrumentTable(name, name, r, f, body, length, height, end, error)


def ball_of_a_stylus(points: int = 801, radius: float = 5000.0) -> InstrumentTable:
    """Ball, every 0.5 µm, heights in steps of 0.01 µm [µm]."""
    r = 0.5 * np.arange(points)
    f = np.round(r * r / (2 * radius), 2)
    body, step = BODIES["paraboloid"], 0.01
    # f = r²/(2R) is R f₁(r/R).
    return _table("ball, stylus", r, f, body, radius, radius, step / np.sqrt(12))


def rough_ball(seed: int = 0, points: int = 401, radius: float = 5000.0) -> InstrumentTable:
    """Ball with waves of 3 nm and 20 µm: 1.5 % of the depth under the loads of the tests [µm]."""
    r = 0.5 * np.arange(points)
    f = r * r / (2 * radius) + waviness(np.random.default_rng(seed), r, 3e-3, 20.0)
    return _table("ball, rough", r, f, BODIES["paraboloid"], radius, radius, 3e-3)


def mesh_of_a_ball(around: int = 1, seed: int = 0) -> InstrumentTable:
    """Vertices of a ball of 15 mm in fifteen rings, with six decimals, two radii 1 µm apart [m]."""
    angle = np.pi / 2 * np.repeat(np.arange(1, 15), around) / 14.5
    radius = 0.015
    r, f = radius * np.sin(angle), radius * 2 * np.sin(angle / 2) ** 2
    r, f = np.r_[0.0, r, r[3 * around] + 1e-6], np.r_[0.0, f, f[3 * around]]
    order = np.random.default_rng(seed).permutation(r.size) if around > 1 else np.argsort(r)
    error = 3e-7
    body = BODIES["sphere"]
    return _table(
        "ball, mesh", np.round(r, 6)[order], np.round(f, 8)[order], body, radius, radius, error
    )


#: Tip of A = 0.9 h² + 1100 h [nm].
TIP = Body(lambda: (AreaFunction(0.9, 1100.0, 0.0),), 440.0)


def area_function(points: int = 590, step: float = 0.714, pixel: float = 15.3) -> tuple[Array, ...]:
    """Depths and areas of a blunt tip as counted in pixels of an image, at least one [nm]."""
    h = step * np.arange(points)
    area = 0.9 * h * h + 1100 * h
    return h, pixel * np.maximum(np.round(area / pixel), 1.0)


@dataclass
class Answers:
    """Results of the library for loads on a table, with its estimates of their errors."""

    depth_by_radius: Array
    force_by_depth: Array
    depth_by_force: Array
    estimates: dict[str, Array]
    codes: frozenset[str]


def answers(table: InstrumentTable, radius: Array, depth: Array, force: Array) -> Answers:
    """Solve the loads on a table by the library."""
    options = {} if table.uncertainty is None else {"uncertainty": table.uncertainty}
    profile = Tabulated(table.r, table.f, breaks=table.breaks, **options)
    solved = {
        "depth_by_radius": normal.solve(profile, 1.0, contact_radius=radius),
        "force_by_depth": normal.solve(profile, 1.0, indentation_depth=depth),
        "depth_by_force": normal.solve(profile, 1.0, normal_force=force),
    }
    return Answers(
        solved["depth_by_radius"].indentation_depth,
        solved["force_by_depth"].normal_force,
        solved["depth_by_force"].indentation_depth,
        {name: np.asarray(contact.data_error) for name, contact in solved.items()},
        frozenset(notice.code for contact in solved.values() for notice in contact.warnings),
    )
