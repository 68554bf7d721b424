"""Random queries of physically ordinary cases, in the units that engineers use.

All lengths, moduli and loads are first drawn in SI, so that they suit each other, and then
converted. Most queries have a result; a few exceed a limit (friction, or the end of a table) and
must be rejected with a reason.
"""

from collections.abc import Callable, Mapping
from random import Random
from typing import Any, Final, NamedTuple

from tests.fuzz.profiles import Case, profile, spread
from tests.fuzz.units import UNITS, converted


class Moduli(NamedTuple):
    """A material as it appears in a query, and its effective moduli in SI."""

    material: dict[str, Any]
    e_star: float
    g_star: float


def material(random: Random) -> Moduli:
    """Return two bodies between soft rubber and diamond, or effective moduli."""
    bodies: list[Any] = []
    for _ in range(2):
        nu = random.choice((0.0, 0.3, 0.3, 0.5, random.uniform(0.0, 0.5)))
        bodies.append({"youngs_modulus": spread(random, 1e5, 1e12), "poissons_ratio": nu})
    if random.random() < 0.4:
        bodies[random.randrange(2)] = "rigid"
    elastic = [
        (body["youngs_modulus"], body["poissons_ratio"]) for body in bodies if body != "rigid"
    ]
    e_star = 1 / sum((1 - nu * nu) / E for E, nu in elastic)
    g_star = 1 / sum((1 + nu) * (2 - nu) / (2 * E) for E, nu in elastic)
    given: dict[str, Any] = {"bodies": bodies}
    if random.random() < 0.6:
        twist = 1 / sum(2 * (1 + nu) / E for E, nu in elastic)
        given = {"e_star": e_star, "g_star": g_star, "shear_modulus": twist}
    if random.random() < 0.1:
        given["yield_strength"] = e_star * spread(random, 1e-4, 1e-1)
    return Moduli(given, e_star, g_star)


class Contact(NamedTuple):
    """A query without loads, in SI, with typical depth and force."""

    query: dict[str, Any]
    case: Case
    moduli: Moduli
    friction: float
    depth: float
    force: float


def contact(random: Random, kind: str | None = None) -> Contact:
    """Return a profile and a material, with suitable loads."""
    case, moduli = profile(random, kind), material(random)
    query: dict[str, Any] = {"profile": case.profile, "material": moduli.material}
    lift = case.height(case.radius)
    depth = random.uniform(1.05, 1.6) * lift if lift else case.radius * spread(random, 1e-6, 1e-2)
    # A foundation compressed by d - g carries at most 2 E* a d, a cone half of that.
    force = 2 * moduli.e_star * case.radius * depth * random.uniform(0.4, 0.7)
    friction = random.choice((0.1, 0.3, 0.5, spread(random, 1e-3, 1.2)))
    return Contact(query, case, moduli, friction, depth, force)


def _several(random: Random, one: Callable[[], float]) -> float | list[float]:
    """Return one value in most cases, otherwise a list."""
    if random.random() < 0.6:
        return one()
    many = random.random() < 0.1
    return [one() for _ in range(random.randint(30, 200) if many else random.randint(1, 8))]


def _load(random: Random, scene: Contact, controls: tuple[str, ...]) -> dict[str, Any]:
    control = random.choice(controls)
    typical = {
        "indentation_depth": scene.depth,
        "normal_force": scene.force,
        "contact_radius": scene.case.radius,
    }[control]

    shape = scene.case.profile
    least = shape.get("flat_radius", 0.0) if control == "contact_radius" else 0.0

    def one() -> float:
        return least + (typical - least) * (random.random() > 0.02) * spread(random, 0.3, 1.0)

    if control == "contact_radius" and shape["kind"] == "flat_punch":
        # Its contact radius is not a load and is rejected.
        control, one = random.choice(((control, one), ("normal_force", lambda: scene.force)))
    return {control: _several(random, one)}


def _friction_fraction(random: Random) -> float:
    """Return a fraction of the friction limit: any value, or either end of partial slip."""
    small = spread(random, 1e-12, 1e-3)
    share = random.choice((random.random(), random.random(), small, 1 - small, 0.0, 1.0))
    return share * random.choice((1, 1, 1, -1))


def _values(load: Mapping[str, Any]) -> list[float]:
    (value,) = load.values()
    return list(value) if isinstance(value, list) else [value]


def _like(load: Mapping[str, Any], values: list[float]) -> float | list[float]:
    (value,) = load.values()
    return values if isinstance(value, list) else values[0]


def _tangential(random: Random, scene: Contact, load: Mapping[str, Any]) -> dict[str, Any]:
    (control,) = load
    mu, ratio = scene.friction, scene.moduli.e_star / scene.moduli.g_star
    normal_control = _values(load)
    if control == "normal_force" and random.random() < 0.7:
        return {
            "tangential_force": _like(
                load, [mu * F * _friction_fraction(random) for F in normal_control]
            )
        }
    if control == "contact_radius" and random.random() < 0.5:
        b = scene.case.profile.get("flat_radius", 0.0)
        return {
            "stick_radius": _like(load, [b + (a - b) * random.random() for a in normal_control])
        }
    longest = 1.2 * mu * ratio * scene.depth
    return {
        "tangential_displacement": _like(
            load, [longest * _friction_fraction(random) for _ in normal_control]
        )
    }


def normal(random: Random, kind: str | None = None) -> dict[str, Any]:
    """Return a query of a normal contact."""
    scene = contact(random, kind)
    controls = ("indentation_depth", "normal_force", "contact_radius")
    return scene.query | {"load": _load(random, scene, controls)}


def tangential(random: Random, kind: str | None = None) -> dict[str, Any]:
    """Return a query of a contact with friction."""
    scene = contact(random, kind)
    load = _load(random, scene, ("indentation_depth", "normal_force", "contact_radius"))
    return scene.query | {
        "friction_coefficient": scene.friction,
        "load": load,
        "tangential": _tangential(random, scene, load),
    }


def _history(random: Random, scene: Contact) -> dict[str, Any]:
    """Return a history under any two controls, with its friction coefficient."""
    by_force, pushed_by_force = random.random() < 0.5, random.random() < 0.5
    mu, ratio = scene.friction, scene.moduli.e_star / scene.moduli.g_star
    straight = by_force == pushed_by_force
    count = random.randint(1, 8) if random.random() < 0.9 else random.randint(9, 40)
    # Under mixed control the force between two depths is not known a priori.
    low, largest = (0.05, 1.0) if straight else (0.6, 0.4)
    normal_control: list[float] = []
    tangential_control: list[float] = []
    for i in range(count):
        level = (
            normal_control[-1]
            if normal_control and random.random() < 0.4
            else random.uniform(low, 1.0)
        )
        if straight and random.random() < 0.05:
            level = 0.0
        share = 0.0 if i == 0 and not straight else largest * _friction_fraction(random)
        normal_control.append(level)
        tangential_control.append(share * (level if pushed_by_force and straight else low))
    force_scale, depth_scale = scene.force, scene.depth
    normal_name, normal_scale = (
        ("normal_force", force_scale) if by_force else ("indentation_depth", depth_scale)
    )
    tangential_name, tangential_scale = (
        ("tangential_force", mu * (force_scale if by_force else 0.3 * force_scale))
        if pushed_by_force
        else ("tangential_displacement", 1.2 * mu * ratio * depth_scale)
    )
    way: dict[str, Any] = {
        "normal": {normal_name: [normal_scale * level for level in normal_control]},
        "tangential": {tangential_name: [tangential_scale * share for share in tangential_control]},
    }
    if random.random() < 0.5:
        way["samples_per_step"] = random.randint(1, 10)
    return {"friction_coefficient": mu, "history": way}


def history(random: Random, kind: str | None = None) -> dict[str, Any]:
    """Return a query of a load history, linear or under mixed control."""
    scene = contact(random, kind)
    return scene.query | _history(random, scene)


def cycles(random: Random, kind: str | None = None) -> dict[str, Any]:
    """Return a query of identical cycles, with constant or in-phase normal load."""
    scene = contact(random, kind)
    mu, ratio = scene.friction, scene.moduli.e_star / scene.moduli.g_star
    by_force, pushed_by_force = random.random() < 0.5, random.random() < 0.5
    normal_name, mean = (
        ("normal_force", scene.force) if by_force else ("indentation_depth", scene.depth)
    )
    normal_amplitude: dict[str, Any] = {normal_name: mean}
    lowest = 1.0
    if random.random() < 0.4:
        part = random.uniform(0.05, 0.5)
        normal_amplitude["amplitude"], lowest = mean * part, (1 - part) ** (1 if by_force else 3)
    share = lowest * (spread(random, 1e-3, 1.0) if by_force else random.uniform(0.05, 0.5))
    name, amplitude = (
        ("tangential_force", mu * scene.force * share)
        if pushed_by_force
        else ("tangential_displacement", 1.2 * mu * ratio * scene.depth * share)
    )
    way = {
        "normal": normal_amplitude,
        "tangential": {name: amplitude},
        "count": random.randint(1, 5),
    }
    if random.random() < 0.5:
        way["samples_per_step"] = random.randint(1, 10)
    return scene.query | {"friction_coefficient": mu, "cycles": way}


_NORMAL_FIELDS: Final = ("pressure", "normal_displacement", "foundation_load")
_SHEAR_FIELDS: Final = ("shear_stress", "slip", "foundation_shear")


def _radii(random: Random, scene: Contact) -> dict[str, Any]:
    if random.random() < 0.5:
        return {"points": random.randint(12, 200)}
    end = scene.case.radius * spread(random, 0.3, 3.0)
    if scene.case.profile["kind"] == "tabulated":
        end = min(end, scene.case.profile["r"][-1])
    count = random.randint(1, 30)
    return {"radius": [end * random.random() for _ in range(count)]}


def _any_load(random: Random, scene: Contact) -> dict[str, Any]:
    """Return a normal load, without friction or with it, or a history."""
    sort = random.choice(("normal", "tangential", "history"))
    if sort == "history":
        return _history(random, scene)
    load = _load(random, scene, ("indentation_depth", "normal_force", "contact_radius"))
    if sort == "normal":
        return {"load": load}
    pushed = _tangential(random, scene, load)
    return {"load": load, "friction_coefficient": scene.friction, "tangential": pushed}


def stress(random: Random, kind: str | None = None) -> dict[str, Any]:
    """Return a query of fields: frictionless, tangentially loaded, or at the end of a history."""
    scene = contact(random, kind)
    query = scene.query | _radii(random, scene)
    loaded = _any_load(random, scene)
    names = [*_NORMAL_FIELDS, *(_SHEAR_FIELDS if "friction_coefficient" in loaded else ())]
    query |= loaded
    query["quantities"] = random.sample(names, random.randint(1, len(names)))
    return query


_STRESSES: Final = (
    *("stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_xz", "stress_yz"),
    *("von_mises", "maximum_shear", "principal_1", "principal_2", "principal_3", "mean_stress"),
)

_MOST_SEARCHED: Final = 50


def subsurface(random: Random, kind: str | None = None) -> dict[str, Any]:
    """Return a query of stresses beneath the surface under any load; some search for the peak."""
    scene = contact(random, kind)
    query = scene.query | {"body": random.choice((1, 2))}
    query["material"].pop("yield_strength", None)
    if "bodies" not in query["material"]:
        query["material"]["poissons_ratio"] = random.choice((0.0, 0.3, 0.5, random.random() / 2))
    query |= _any_load(random, scene)
    if random.random() < 0.5:
        query["points"] = random.randint(2, 12)
    else:
        far = 3.0 * scene.case.radius
        count = random.randint(1, 6), random.randint(1, 6)
        query["x"] = [
            far * random.uniform(-1, 1) * (random.random() > 0.1) for _ in range(count[0])
        ]
        query["z"] = [far * random.random() ** 3 * (random.random() > 0.2) for _ in range(count[1])]
        if random.random() < 0.3:
            query["y"] = far * random.uniform(-1, 1)
    query["quantities"] = random.sample(_STRESSES, random.randint(1, len(_STRESSES)))
    # Each load takes some hundredths of a second.
    if random.random() < 0.2 and len(_values(query.get("load", {"": 0.0}))) <= _MOST_SEARCHED:
        query["largest"] = True
    if random.random() < 0.03 and "load" in query and scene.case.profile["kind"] != "tabulated":
        query["material"]["yield_strength"] = scene.moduli.e_star * spread(random, 1e-4, 1e-1)
    return query


def _oscillation(random: Random, scene: Contact, load: Mapping[str, Any]) -> dict[str, Any]:
    share = random.uniform(0.1, 0.95)
    mu, ratio = scene.friction, scene.moduli.e_star / scene.moduli.g_star
    normal_control = _values(load)
    if "normal_force" in load and random.random() < 0.8:
        return {"tangential_force": _like(load, [mu * F * share for F in normal_control])}
    amplitude = 0.7 * mu * ratio * scene.depth * share
    return {"tangential_displacement": _like(load, [amplitude for _ in normal_control])}


def wear(random: Random, kind: str | None = None) -> dict[str, Any]:
    """Return a query of the limiting state of fretting wear."""
    scene = contact(random, kind)
    load = _load(random, scene, ("indentation_depth", "normal_force"))
    query = scene.query | {
        "friction_coefficient": scene.friction,
        "load": load,
        "oscillation": _oscillation(random, scene, load),
    }
    if random.random() < 0.7:
        query |= _radii(random, scene)
        names = ("initial_profile", "limiting_profile", "worn_depth", "pressure")
        query["quantities"] = random.sample(names, random.randint(1, 4))
    return query


def evolution(random: Random, kind: str | None = None) -> dict[str, Any]:
    """Return a query of fretting wear over the cycles."""
    scene = contact(random, kind)
    load = {
        control: _values({control: value})[0]
        for control, value in _load(random, scene, ("indentation_depth", "normal_force")).items()
    }
    query = scene.query | {
        "friction_coefficient": scene.friction,
        "load": load,
        "oscillation": _oscillation(random, scene, load),
        # Wear coefficients from steel to a soft coating: 1e-15 to 1e-11 m³/J.
        "wear_coefficient": spread(random, 1e-15, 1e-11),
        "cycles": sorted(spread(random, 1.0, 1e8) for _ in range(random.randint(1, 5))),
        "resolution": random.choice((8, 16, 24)),
    }
    if random.random() < 0.5:
        query |= _radii(random, scene)
    return query


def torsion(random: Random, kind: str | None = None) -> dict[str, Any]:
    """Return a query of a twist."""
    scene = contact(random, kind)
    scene.query["material"].pop("yield_strength", None)
    mu, a = scene.friction, scene.case.radius
    typical = {
        "torque": 0.4 * mu * scene.force * a,
        # With G of about a third of E*.
        "rotation": mu * scene.depth / a,
        "stick_radius": 0.5 * a,
    }
    name = random.choice(tuple(typical))
    query = scene.query | {
        "friction_coefficient": mu,
        "load": _load(random, scene, ("indentation_depth", "normal_force", "contact_radius")),
        "torsion": {name: typical[name] * spread(random, 1e-3, 2.0)},
    }
    if random.random() < 0.4:
        query |= _radii(random, scene) | {"quantities": ["pressure", "shear_stress"]}
    return query


QUERIES: Final[Mapping[str, Callable[..., dict[str, Any]]]] = {
    "normal": normal,
    "tangential": tangential,
    "history": history,
    "cycles": cycles,
    "stress": stress,
    "wear": wear,
    "evolution": evolution,
    "subsurface": subsurface,
    "torsion": torsion,
}
"""The generators by name; `cycles` uses the endpoint of histories."""

_SHARES: Final = (24, 26, 18, 8, 16, 7, 1, 4, 10)


def query(random: Random) -> tuple[str, dict[str, Any]]:
    """Return an ordinary query in one of the unit systems, with the name of its endpoint."""
    (name,) = random.choices(tuple(QUERIES), _SHARES)
    body = converted(QUERIES[name](random), random.choice(UNITS))
    return "history" if name == "cycles" else name, body
