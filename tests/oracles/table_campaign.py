"""Random tables of ten bodies with closed contact solutions, as people type and measure them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mdr_core.profiles import (
    CappedParaboloid,
    Cone,
    Hyperboloid,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
    SphericalTipCone,
)

if TYPE_CHECKING:
    from numpy.random import Generator

    Array = np.ndarray

#: Parts of the last radius at which depth and force are compared.
PARTS = np.array([0.1, 0.3, 0.6, 0.9])


@dataclass(frozen=True)
class Table:
    """Points of a known body, and what the user declares.

    Parameters
    ----------
    body : the profile that was sampled; its contact has a closed form.
    record : exact, digits, decimals or noise.
    r, f : points [length], shape (k,).
    breaks, uncertainty : see `Tabulated`.
    """

    body: Profile
    record: str
    r: Array
    f: Array
    breaks: tuple[float, ...]
    uncertainty: float | None

    @property
    def sharp(self) -> bool:
        """True for a slope on the axis."""
        return bool(self.body.tip_pressure > 0)


def bodies(random: Generator, end: float) -> tuple[tuple[Profile, tuple[float, ...]], ...]:
    """Ten bodies with the same last radius, each with the radii of its slope discontinuities."""
    steep, b = 10 ** random.uniform(-2, 0), end * random.uniform(0.15, 0.6)
    tip = end * 10 ** random.uniform(-2, 0)
    return (
        (Sphere(end * random.uniform(1.05, 5)), ()),
        (Paraboloid(end * random.uniform(1, 50)), ()),
        (Cone(steep), ()),
        *((Power(steep * end ** (1 - n), n), ()) for n in (1.5, 2.5, 5.0)),
        (Hyperboloid(steep, tip / steep), ()),
        (SphericalTipCone(steep, b / (steep / np.hypot(1, steep))), (b,)),
        (RoundedPunch(b / 3, end * random.uniform(1, 20)), (b / 3,)),
        (CappedParaboloid(b, end * 8, end * 2), (b,)),
    )


def spaced(random: Generator, count: int) -> Array:
    """Return radii over the last one, of any sign, zero among them."""
    kind = random.choice(["even", "even", "random", "two sides", "graded", "pairs", "geometric"])
    even = np.linspace(0, 1, count)
    if kind == "random":
        return np.r_[0.0, np.sort(random.uniform(0, 1, count - 2)), 1.0]
    if kind == "two sides":
        return np.linspace(-1, 1, count | 1)
    if kind == "graded":
        return np.asarray(even**2)
    if kind == "pairs":
        pairs = even[1:-1:4]
        return np.sort(np.append(even, pairs * (1 + 10 ** random.uniform(-6, -2, pairs.size))))
    if kind == "geometric":
        return np.append(0.0, np.geomspace(10 ** random.uniform(-4, -1), 1, count - 1))
    return even


def digits(values: Array, count: int) -> Array:
    """Round each value to `count` significant digits."""
    return np.array([float(f"{value:.{count - 1}e}") for value in values.tolist()])


def drawn(seed: int) -> Table:
    """Return the table of a seed."""
    random = np.random.default_rng(seed)
    end = float(10 ** random.uniform(-3, 3))
    number = int(random.integers(10))
    body, kinks = bodies(random, end)[number]
    count = int(np.exp(random.uniform(np.log(4), np.log(200))))
    even = number == 6
    r = _even_heights(body, end, count) if even else spaced(random, count) * end
    if random.random() < 0.25:
        r = r[np.abs(r) > 0]
    f = np.asarray(body.f(np.abs(r)))
    record = str(
        random.choice(["exact", "digits", "decimals", "noise"], p=[0.32, 0.17, 0.17, 0.34])
    )
    uncertainty, places = None, int(random.integers(3, 7))
    if record == "digits":
        r, f = digits(r, places), digits(f, places)
    elif record == "decimals":
        r, f = (_decimals(values, places) for values in (r, f))
    elif record == "noise":
        size = float(np.ptp(f)) * 10 ** random.uniform(-6, -2)
        f = f + size * random.standard_normal(f.size)
        uncertainty = size if random.random() < 0.37 else None
    breaks = kinks if kinks and random.random() < 0.5 else ()
    return Table(body, record, r, f, breaks, uncertainty)


def _decimals(values: Array, places: int) -> Array:
    return np.round(values, places - 1 - int(np.floor(np.log10(np.abs(values).max()))))


def _even_heights(body: Profile, end: float, count: int) -> Array:
    """Radii of evenly spaced heights of a hyperboloid, as of a tabulated area function."""
    height = np.linspace(0.0, float(body.f(np.array(end))), count)
    low, high = np.zeros(count), np.full(count, end)
    for _ in range(80):
        middle = (low + high) / 2
        below = np.asarray(body.f(middle)) < height
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return high * (height > 0)
