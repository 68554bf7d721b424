"""Unit systems, and conversion of queries and results."""

from collections.abc import Mapping
from typing import Any, Final, NamedTuple

from tests.fuzz import laws


class Units(NamedTuple):
    """Units per SI unit of one unit system."""

    length: float
    force: float


UNITS: Final = (Units(1.0, 1.0), Units(1e3, 1.0), Units(1e6, 1e3))
"""m and N (Pa); mm and N (MPa); µm and mN (GPa)."""

DIMENSIONS: Final[Mapping[str, tuple[int, int]]] = {
    **dict.fromkeys(("radius", "height", "flat_radius", "rounding_radius"), (1, 0)),
    **dict.fromkeys(("tip_radius", "cap_radius", "r", "f", "breaks", "uncertainty"), (1, 0)),
    **dict.fromkeys(("x", "y", "z"), (1, 0)),
    **dict.fromkeys(("indentation_depth", "contact_radius", "stick_radius"), (1, 0)),
    **dict.fromkeys(("tangential_displacement", "body_thickness"), (1, 0)),
    **dict.fromkeys(("normal_force", "tangential_force"), (0, 1)),
    **dict.fromkeys(("e_star", "g_star", "youngs_modulus", "yield_strength"), (-2, 1)),
    "wear_coefficient": (2, -1),
}
"""Powers of length and force in the members of a query, by name."""


def converted(part: Any, units: Units, name: str = "") -> Any:
    """Return a query, or a part of it, in other units."""
    if isinstance(part, dict):
        computed = {key: converted(value, units, key) for key, value in part.items()}
        if "coefficient" in part:
            # A coefficient has the dimension length^(1 - exponent).
            computed["coefficient"] *= units.length ** (1 - part["exponent"])
        if "amplitude" in part:
            (control,) = part.keys() & {"indentation_depth", "normal_force"}
            computed["amplitude"] = converted(part["amplitude"], units, control)
        return computed
    if isinstance(part, list):
        return [converted(each, units, name) for each in part]
    if name not in DIMENSIONS:
        return part
    length, force = DIMENSIONS[name]
    value = part * units.length**length * units.force**force
    # Tables have decimal digits in any units.
    return float(f"{value:.15g}") if name in {"r", "f", "breaks"} else value


def exactly_scalable(body: Mapping[str, Any]) -> bool:
    """Report whether powers of two scale every number of the query exactly."""
    terms = body["profile"].get("terms", [body["profile"]])
    return all(float(term.get("exponent", 1)).is_integer() for term in terms)


def is_representable(part: Any) -> bool:
    """Report whether the service accepts the magnitude of every number of a query."""
    if isinstance(part, dict | list):
        return all(map(is_representable, part.values() if isinstance(part, dict) else part))
    return not isinstance(part, float) or part == 0 or 1e-50 <= abs(part) <= 1e50


def scaled(body: Any, units: Units) -> Any:
    """Return the query in units that are powers of two."""
    computed = converted({key: value for key, value in body.items() if key != "profile"}, units)
    table = body["profile"].get("kind") == "tabulated"
    shape = converted(body["profile"], units)
    if table:
        shape |= {
            key: [value * units.length for value in body["profile"][key]]
            for key in ("r", "f", "breaks")
            if key in body["profile"]
        }
    return computed | {"profile": shape}


_ANSWER_DIMENSIONS: Final = DIMENSIONS | {
    **dict.fromkeys(("mean_pressure", "maximum_pressure", "pressure", "shear_stress"), (-2, 1)),
    **dict.fromkeys(("normal_stiffness", "tangential_stiffness", "secant_stiffness"), (-1, 1)),
    **dict.fromkeys(("foundation_load", "foundation_shear"), (-1, 1)),
    **dict.fromkeys(("elastic_energy", "dissipated_energy", "tangential_energy"), (1, 1)),
    "energy_per_cycle": (1, 1),
    **dict.fromkeys(("slip_width", "slip_fronts", "slip", "normal_displacement"), (1, 0)),
    **dict.fromkeys(("wear_radius", "initial_profile", "limiting_profile"), (1, 0)),
    **dict.fromkeys(("worn_depth", "profile"), (1, 0)),
    "worn_volume": (3, 0),
    **dict.fromkeys(("von_mises", "maximum_shear", "mean_stress", "value"), (-2, 1)),
    **{f"stress_{name}": (-2, 1) for name in ("xx", "yy", "zz", "xy", "xz", "yz")},
    **{f"principal_{number}": (-2, 1) for number in (1, 2, 3)},
    **{f"yield_onset_force.{name}": (0, 1) for name in ("tresca", "von_mises")},
}


def scaled_result(result: Mapping[str, Any], units: Units) -> dict[str, Any]:
    """Return a result in other units."""
    computed: dict[str, Any] = {
        name: value for name, value in result.items() if not isinstance(value, Mapping)
    }
    for name, values in laws.numbers(result).items():
        own = name if name in _ANSWER_DIMENSIONS else name.rpartition(".")[2]
        length, force = _ANSWER_DIMENSIONS.get(own, (0, 0))
        computed[name] = values * units.length**length * units.force**force
    return computed
