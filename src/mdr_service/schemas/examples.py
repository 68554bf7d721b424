"""Filled-in requests, in SI units (N, m, Pa); a test compares each answer with its textbook."""

from typing import Any, Final

_STEEL: Final = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
_RUBBER: Final = {"youngs_modulus": 5e6, "poissons_ratio": 0.5}


def _example(summary: str, value: dict[str, Any]) -> dict[str, Any]:
    return {"summary": summary, "value": value}


NORMAL_EXAMPLES: Final = {
    "hertz": _example(
        "Hertz: a steel ball of 10 mm radius on a steel flat, pressed by 10 N",
        {
            "profile": {"kind": "paraboloid", "radius": 0.01},
            "material": {"bodies": [_STEEL, _STEEL]},
            "load": {"normal_force": 10.0},
        },
    ),
    "boussinesq": _example(
        "Boussinesq: a rigid flat punch of 5 mm radius on rubber, four depths",
        {
            "profile": {"kind": "flat_punch", "radius": 0.005},
            "material": {"bodies": ["rigid", _RUBBER]},
            "load": {"indentation_depth": [0.0, 1e-4, 2e-4, 5e-4]},
        },
    ),
    "sneddon": _example(
        "Sneddon: a rigid cone with a slope of 0.1 on steel, pressed 1 µm deep",
        {
            "profile": {"kind": "cone", "slope": 0.1},
            "material": {"bodies": ["rigid", _STEEL]},
            "load": {"indentation_depth": 1e-6},
        },
    ),
    "exact_sphere": _example(
        "An exact sphere of 10 mm radius, E* = 1 MPa, by its contact radius",
        {
            "profile": {"kind": "sphere", "radius": 0.01},
            "material": {"e_star": 1e6},
            "load": {"contact_radius": [0.001, 0.005]},
        },
    ),
    "worn_ball": _example(
        "A ball of 10 mm radius with a worn flat of 1 mm radius, E* = 1 GPa",
        {
            "profile": {"kind": "truncated_paraboloid", "flat_radius": 0.001, "radius": 0.01},
            "material": {"e_star": 1e9},
            "load": {"contact_radius": 0.002},
        },
    ),
    "table": _example(
        "A measured profile: seven points of a ball, joined by a cubic spline",
        {
            "profile": {
                "kind": "tabulated",
                "r": [0.0, 0.0005, 0.001, 0.0015, 0.002, 0.0025, 0.003],
                "f": [0.0, 1.25e-05, 5e-05, 0.0001125, 0.0002, 0.0003125, 0.00045],
            },
            "material": {"e_star": 1e9},
            "load": {"contact_radius": [0.001, 0.002]},
            "rtol": 1e-6,
        },
    ),
}

# A steel ball of 10 mm radius on a steel flat, pressed by 10 N, as in NORMAL_EXAMPLES.
_BALL: Final = {
    "profile": {"kind": "paraboloid", "radius": 0.01},
    "material": {"bodies": [_STEEL, _STEEL]},
    "load": {"normal_force": 10.0},
}

TANGENTIAL_EXAMPLES: Final = {
    "cattaneo_mindlin": _example(
        "Cattaneo and Mindlin: a steel ball on a steel flat, µ = 0.3, pushed sideways",
        {
            **_BALL,
            "friction_coefficient": 0.3,
            "tangential": {"tangential_force": [0.0, 1.0, 2.0, 2.9, 3.0]},
        },
    ),
    "truman": _example(
        "Truman: a rigid cone with a slope of 0.1 on rubber, by the radius of its stick zone",
        {
            "profile": {"kind": "cone", "slope": 0.1},
            "material": {"bodies": ["rigid", _RUBBER]},
            "load": {"contact_radius": 0.004},
            "friction_coefficient": 0.8,
            "tangential": {"stick_radius": [0.001, 0.002, 0.003]},
        },
    ),
    "flat_punch": _example(
        "A rigid flat punch on rubber: it sticks as a whole, then slides at once",
        {
            "profile": {"kind": "flat_punch", "radius": 0.005},
            "material": {"bodies": ["rigid", _RUBBER]},
            "load": {"indentation_depth": 1e-4},
            "friction_coefficient": 0.5,
            "tangential": {"tangential_displacement": [1e-5, 1e-3]},
        },
    ),
}

# The same ball, by forces along a way.
_FOLLOWED: Final = {name: _BALL[name] for name in ("profile", "material")} | {
    "friction_coefficient": 0.3
}

HISTORY_EXAMPLES: Final = {
    "mindlin_deresiewicz": _example(
        "Mindlin and Deresiewicz: a steel ball on a steel flat, pushed 2 N to and fro",
        {
            **_FOLLOWED,
            "cycles": {
                "normal": {"normal_force": 10.0},
                "tangential": {"tangential_force": 2.0},
                "count": 2,
                "samples_per_step": 2,
            },
        },
    ),
    "residual": _example(
        "The same ball pushed and let go: the displacement that is left, and the slip fronts",
        {
            **_FOLLOWED,
            "history": {
                "normal": {"normal_force": 10.0},
                "tangential": {"tangential_force": [0.0, 2.0, 0.0]},
            },
        },
    ),
    "oblique": _example(
        "Pressed and pushed at once, within friction: it sticks all over; then pulled back",
        {
            **_FOLLOWED,
            "history": {
                "normal": {"normal_force": [10.0, 10.0]},
                "tangential": {"tangential_force": [1.0, -1.0]},
            },
        },
    ),
    "cone_with_a_gap": _example(
        "A rigid cone on rubber, by depths: slid, lifted off, and pressed again without memory",
        {
            "profile": {"kind": "cone", "slope": 0.1},
            "material": {"bodies": ["rigid", _RUBBER]},
            "friction_coefficient": 0.5,
            "history": {
                "normal": {"indentation_depth": [1e-4, 1e-4, -1e-5, 1e-4]},
                "tangential": {"tangential_displacement": [0.0, 1e-4, 1e-4, 1e-4]},
                "samples_per_step": 4,
            },
        },
    ),
}

# The same ball, sticking up to half of its contact radius under 0.75 of what it takes to slide.
_FRETTED: Final = {
    "profile": {"kind": "paraboloid", "radius": 0.01},
    "material": {"e_star": 115e9, "g_star": 95e9},
    "friction_coefficient": 0.3,
}
_HELD_DEPTH: Final = _FRETTED | {
    "load": {"indentation_depth": 1e-6},
    "oscillation": {"tangential_displacement": 0.75 * 0.3 * 115 / 95 * 1e-6},
}

WEAR_EXAMPLES: Final = {
    "shakedown": _example(
        "Fretting of a steel ball at a depth of 1 µm: the shape that wears no further",
        _HELD_DEPTH | {"radius": [0.0, 4e-5, 7e-5, 1e-4, 1.2e-4, 1.5e-4]},
    ),
    "amplitudes": _example(
        "The same ball under 10 N, µ F_N = 3 N: the worn rim by the amplitude of the force",
        _FRETTED
        | {
            "load": {"normal_force": 10.0},
            "oscillation": {"tangential_force": [0.0, 1.0, 2.0, 2.9]},
        },
    ),
    "endless": _example(
        "Under a force that lets it slide as a whole it wears without end",
        _FRETTED
        | {
            "load": {"normal_force": 10.0},
            "oscillation": {"tangential_force": [2.0, 3.0]},
            "radius": [0.0, 5e-5, 1e-4],
            "quantities": ["worn_depth", "pressure"],
        },
    ),
    "held_force": _example(
        "A held force with a held displacement: the book's limit, which depends on the path",
        _FRETTED
        | {
            "load": {"normal_force": 10.0},
            "oscillation": {"tangential_displacement": 2e-7},
            "points": 200,
        },
    ),
}

EVOLUTION_EXAMPLES: Final = {
    "shakedown": _example(
        "The ball at a depth of 1 µm, over the cycles, until nothing wears any more",
        _HELD_DEPTH
        | {
            "wear_coefficient": 1e-14,
            "cycles": [0.0, 1.0, 1e5, 1e6, 1e8],
            "radius": [0.0, 4e-5, 7e-5, 1e-4, 1.2e-4, 1.5e-4],
        },
    ),
    "held_forces": _example(
        "The same ball under 10 N and ±2 N: it sinks in, and the contact grows",
        _FRETTED
        | {
            "load": {"normal_force": 10.0},
            "oscillation": {"tangential_force": 2.0},
            "wear_coefficient": 1e-14,
            "cycles": [1e4, 1e5, 3e5, 1e6, 3e6],
            "points": 100,
        },
    ),
}

STRESS_EXAMPLES: Final = {
    "cattaneo_mindlin": _example(
        "Cattaneo and Mindlin: pressure, shear stress and slip at seven radii",
        {
            **_BALL,
            "friction_coefficient": 0.3,
            "tangential": {"tangential_force": 2.0},
            "radius": [0.0, 2e-5, 4e-5, 6e-5, 7e-5, 8e-5, 9e-5],
            "quantities": ["pressure", "shear_stress", "slip"],
        },
    ),
    "sneddon": _example(
        "Sneddon: the pressure of a cone, infinite at the tip",
        {
            "profile": {"kind": "cone", "slope": 0.1},
            "material": {"e_star": 1e9},
            "load": {"contact_radius": [0.001, 0.002]},
            "radius": [0.0, 0.0005, 0.001, 0.0015],
            "quantities": ["pressure"],
        },
    ),
    "boussinesq": _example(
        "Boussinesq: a flat punch on rubber, its pressure and the surface around it",
        {
            "profile": {"kind": "flat_punch", "radius": 0.005},
            "material": {"bodies": ["rigid", _RUBBER]},
            "load": {"indentation_depth": 1e-4},
            "radius": [0.0, 0.004, 0.006, 0.01],
            "quantities": ["pressure", "normal_displacement", "foundation_load"],
        },
    ),
    "rounded_punch": _example(
        "A flat punch with rounded edges in partial slip, on a grid of 200 radii",
        {
            "profile": {"kind": "rounded_punch", "flat_radius": 0.004, "rounding_radius": 0.05},
            "material": {"bodies": ["rigid", _RUBBER]},
            "load": {"contact_radius": 0.005},
            "friction_coefficient": 0.5,
            "tangential": {"stick_radius": 0.0045},
            "points": 200,
            "quantities": ["pressure", "shear_stress"],
        },
    ),
}

# In parameters: numbers and one range.
_BALL_IN_ADDRESS: Final = {
    "kind": "paraboloid",
    "radius": 0.01,
    "e_star": 1.15e11,
    "g_star": 9.5e10,
    "friction_coefficient": 0.3,
}

NORMAL_IN_ADDRESS: Final = {
    "kind": "paraboloid",
    "radius": 0.01,
    "e_star": 1.1e11,
    "normal_force_from": 1.0,
    "normal_force_to": 10.0,
    "n": 10,
}
TANGENTIAL_IN_ADDRESS: Final = _BALL_IN_ADDRESS | {
    "normal_force": 10.0,
    "tangential_force_from": 0.0,
    "tangential_force_to": 3.0,
    "n": 7,
}
STRESS_IN_ADDRESS: Final = _BALL_IN_ADDRESS | {
    "normal_force": 10.0,
    "tangential_force": 2.0,
    "r_from": 0.0,
    "r_to": 1e-4,
    "n": 11,
    "quantities": "pressure,shear_stress",
}
WEAR_IN_ADDRESS: Final = _BALL_IN_ADDRESS | {
    "normal_force": 10.0,
    "tangential_force_from": 0.5,
    "tangential_force_to": 2.5,
    "n": 5,
}

BATCH_EXAMPLES: Final = {
    "two": _example(
        "A ball pressed, and a cone that cannot be pulled: an answer and a problem",
        {
            "queries": [
                {"ask": "normal", "request": _BALL},
                {
                    "ask": "normal",
                    "request": {
                        "profile": {"kind": "cone", "slope": 0.1},
                        "material": {"e_star": 1e9},
                        "load": {"normal_force": -1.0},
                    },
                },
            ]
        },
    ),
}
