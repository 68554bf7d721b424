"""Unit systems, and conversion of queries."""

from collections.abc import Mapping
from typing import Any, Final, NamedTuple


class Units(NamedTuple):
    """Units per SI unit of one unit system."""

    length: float
    force: float


UNITS: Final = (Units(1.0, 1.0), Units(1e3, 1.0), Units(1e6, 1e3))
"""m and N (Pa); mm and N (MPa); µm and mN (GPa)."""

DIMENSIONS: Final[Mapping[str, tuple[int, int]]] = {
    **dict.fromkeys(("radius", "radii", "height", "flat_radius", "rounding_radius"), (1, 0)),
    **dict.fromkeys(("tip_radius", "cap_radius", "r", "f", "breaks", "uncertainty"), (1, 0)),
    **dict.fromkeys(("x", "y", "z"), (1, 0)),
    **dict.fromkeys(("indentation_depth", "contact_radius", "stick_radius"), (1, 0)),
    **dict.fromkeys(("tangential_displacement", "body_thickness"), (1, 0)),
    **dict.fromkeys(("normal_force", "tangential_force"), (0, 1)),
    **dict.fromkeys(("e_star", "g_star", "shear_modulus"), (-2, 1)),
    **dict.fromkeys(("youngs_modulus", "yield_strength"), (-2, 1)),
    "torque": (1, 1),
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
