"""Generate the bank of subsurface stresses: ``python -m tests.oracles.subsurface_generate``.

The stresses follow directly from the foundation's loads: the potentials are V = int q/rho dx and so
on, differentiated under the integral sign. There is no integration by parts, and the load q_x
enters in place of the slip. The kernels are therefore one order more singular than those of the
library.
"""

from __future__ import annotations

import itertools
import json
import math
import random
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from typing import Any

from mpmath import mp, mpf

from tests.oracles.bank import DATA
from tests.oracles.shapes import Shape, shape_of

WORK_DIGITS = 55
NODES = 32
#: Profiles with contact radius 1; stick radii are chosen at random beyond b.
PROFILES: tuple[dict[str, Any], ...] = (
    {"kind": "paraboloid", "radius": 1.7},
    {"kind": "cone", "slope": 0.2},
    {"kind": "sphere", "radius": 1.3},
    {"kind": "ellipsoid", "radius": 1.05, "height": 0.4},
    {"kind": "power", "coefficient": 0.3, "exponent": 0.6},
    {"kind": "power", "coefficient": 0.3, "exponent": 3.7},
    {
        "kind": "series",
        "terms": [{"coefficient": 0.1, "exponent": 1.5}, {"coefficient": 0.2, "exponent": 4.0}],
    },
    {"kind": "rounded_punch", "flat_radius": 0.6, "rounding_radius": 2.0},
    {"kind": "rounded_punch", "flat_radius": 0.01, "rounding_radius": 2.0},
    {"kind": "truncated_cone", "flat_radius": 0.5, "slope": 0.2},
    {"kind": "truncated_paraboloid", "flat_radius": 0.4, "radius": 1.5},
    {"kind": "rounded_cone", "slope": 0.3, "tip_radius": 2.0},
    {"kind": "spherical_tip_cone", "slope": 0.3, "tip_radius": 1.5},
    {"kind": "hyperboloid", "slope": 0.3, "tip_radius": 0.4},
    {"kind": "capped_paraboloid", "cap_radius": 0.5, "tip_radius": 3.0, "radius": 1.2},
)
POINTS = 24


@cache
def rule() -> tuple[list[mpf], list[mpf]]:
    """Gauss-Legendre nodes and weights on [0, 1] by Newton's method."""
    nodes, weights = [], []
    for i in range(NODES):
        x = mp.cos(mp.pi * (i + mpf(3) / 4) / (NODES + mpf(1) / 2))
        for _ in range(12):
            value, before = x, mpf(1)
            for k in range(2, NODES + 1):
                value, before = ((2 * k - 1) * x * value - (k - 1) * before) / k, value
            slope = NODES * (x * value - before) / (x * x - 1)
            x -= value / slope
        nodes.append((1 + x) / 2)
        weights.append(1 / ((1 - x * x) * slope * slope))
    return nodes, weights


def stops(low: mpf, high: mpf, centre: mpf, near: mpf) -> list[mpf]:
    """Panel ends in [low, high] that double away from `centre` and quadruple from 0."""
    result = {low, high}
    distance = near / 4
    while distance < 4 * high:
        result |= {centre - distance, centre + distance}
        distance *= 2
    place = high
    while place > mpf(10) ** -18:
        result.add(place)
        place /= 4
    return sorted(x for x in result if low <= x <= high)


def kernels(x: mpf, r: mpf, z: mpf) -> list[mpf]:
    """Derivatives of 1/rho, ln(rho + s) and s ln(rho + s) - rho at s = z + i x, twice real part."""
    s = mp.mpc(z, x)
    rho = mp.sqrt(r * r + s * s)
    u = rho + s
    cube, fifth = rho**3, rho**5
    values = (
        -r / cube,
        -s / cube,
        3 * s * s / fifth - 1 / cube,
        3 * r * s / fifth,
        3 * r * r / fifth - 1 / cube,
        -1 / cube,
        1 / (rho * u),
        -(2 * rho + s) * r / (cube * u * u),
        r / (rho * u * u),
    )
    return [2 * value.real for value in values]


@cache
def derivatives(
    shape: Shape, a: mpf, c: mpf | None, r: mpf, z: mpf
) -> tuple[list[mpf], list[mpf] | None]:
    """Derivatives of the potentials of q/E* and of q_x/(mu E*)."""
    depth, held = shape.g(a), None if c is None else shape.g(a) - shape.g(c)
    pressed, sheared = [mpf(0)] * 9, [mpf(0)] * 9
    parts = [(mpf(0), mpf(0), a)] if not shape.b else [(shape.b, mpf(0), shape.beyond(a))]
    if shape.b:
        parts.append((mpf(0), mpf(0), shape.b))
    nodes, weights = rule()
    for base, low, high in parts:
        root = mp.sqrt(mp.mpc(r, z) ** 2 - base**2)
        ends = stops(low, high, root.real, root.imag)
        if c is not None and c > base:
            place = mp.sqrt(c * c - base * base)
            if low < place < high:
                ends = sorted({*ends, place})
        for start, stop in itertools.pairwise(ends):
            for node, weight in zip(nodes, weights, strict=True):
                s = start + (stop - start) * node
                x = mp.sqrt(base * base + s * s)
                run = (stop - start) * weight * s / x
                g = shape.g(x, s) if base or not shape.b else shape.inner_g(x)
                values = kernels(x, r, z)
                q = depth - g
                pressed = [t + run * q * v for t, v in zip(pressed, values, strict=True)]
                if held is not None:
                    q = min(q, held)
                    sheared = [t + run * q * v for t, v in zip(sheared, values, strict=True)]
    return pressed, None if c is None else sheared


def tensor(
    shape: Shape, a: mpf, c: mpf | None, friction: mpf, nu: mpf, place: tuple[mpf, mpf, mpf]
) -> list[mpf]:
    """xx, yy, zz, xy, xz, yz over E* in the body on which the shear stress acts."""
    x, y, z = place
    r = mp.sqrt(x * x + y * y)
    k, m = (x / r, y / r) if r else (mpf(1), mpf(0))
    pressed, sheared = derivatives(shape, a, c, r, z)
    _, v_z, v_zz, v_rz, v_rr, v_ring, om_ring, _, _ = pressed
    om_rr = -v_z - om_ring
    radial = 2 * nu * v_z - z * v_rr - (1 - 2 * nu) * om_rr
    hoop = 2 * nu * v_z - z * v_ring - (1 - 2 * nu) * om_ring
    total = [
        k * k * radial + m * m * hoop,
        m * m * radial + k * k * hoop,
        v_z - z * v_zz,
        k * m * (radial - hoop),
        -k * z * v_rz,
        -m * z * v_rz,
    ]
    if sheared is not None:
        v_r, v_z, v_zz, v_rz, v_rr, v_ring, _, om_t, f_t = sheared
        om_rrr, f_rrr = -v_rz - om_t, -v_r - f_t

        def third(rrr: mpf, ring: mpf) -> tuple[mpf, mpf, mpf]:
            return (
                k**3 * rrr + 3 * k * m * m * ring,
                k * m * m * rrr + k * (k * k - 2 * m * m) * ring,
                m * k * k * rrr + m * (m * m - 2 * k * k) * ring,
            )

        om, f = third(om_rrr, om_t), third(f_rrr, f_t)
        extra = [
            (2 + 2 * nu) * k * v_r + 2 * nu * f[0] - z * om[0],
            2 * nu * k * v_r + 2 * nu * f[1] - z * om[1],
            -z * k * v_rz,
            m * v_r + 2 * nu * f[2] - z * om[2],
            v_z - z * (k * k * v_rr + m * m * v_ring),
            -z * k * m * (v_rr - v_ring),
        ]
        total = [t + friction * e for t, e in zip(total, extra, strict=True)]
    return [t / (2 * mp.pi) for t in total]


def record(number: int) -> str:
    """Return the record of one profile as JSON."""
    mp.dps = WORK_DIGITS
    chosen = random.Random(number)
    profile = PROFILES[number]
    shape = shape_of(profile)
    first = max(float(shape.b) if shape.blunt else 0.0, 0.05)
    c = first + (1 - first) * chosen.choice([0.3, 0.8, 0.999])
    nu, friction = chosen.choice([0.0, 0.3, 0.5]), 0.4
    points, expected = [], []
    for i in range(POINTS):
        at = (0.0, 1.0, c)[i % 3]
        if i < POINTS // 2:
            distance, angle = 10 ** chosen.uniform(-7, -3), chosen.uniform(0, math.pi)
            r, z = abs(at + distance * math.cos(angle)), distance * math.sin(angle)
        else:
            r, z = chosen.uniform(0, 1.6), 10 ** chosen.uniform(-7 if i % 4 == 0 else -1.5, 0.7)
        phi = chosen.uniform(-math.pi, math.pi)
        place = (r * math.cos(phi), r * math.sin(phi), z)
        points.append(place)
        exact = tuple(mpf(one) for one in place)
        values = tensor(shape, mpf(1), mpf(c), mpf(friction), mpf(nu), exact)
        expected.append([mp.nstr(value, 20) for value in values])
    return json.dumps(
        {
            "id": f"subsurface-{number}",
            "equation": "(5.79)",
            "profile": profile,
            "contact_radius": 1.0,
            "stick_radius": c,
            "friction_coefficient": friction,
            "poissons_ratio": nu,
            "points": points,
            "expected": expected,
        }
    )


def main() -> None:
    with ProcessPoolExecutor(2) as pool:
        lines = list(pool.map(record, range(len(PROFILES)), chunksize=1))
    (DATA / "subsurface.json").write_text("[\n" + ",\n".join(lines) + "\n]\n", encoding="utf-8")


if __name__ == "__main__":
    main()
