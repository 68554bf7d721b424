"""Draw the figures of docs/yield.md from requests to `/v1/subsurface`: `make figures`."""

import json
from pathlib import Path
from typing import Any, Final

import matplotlib as mpl
import numpy as np
from make_figures import STYLE
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mdr_service.dispatch import respond
from mdr_service.serializers import JSON

FOLDER: Final = Path(__file__).parent
STEEL: Final = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
MATERIAL: Final = {"bodies": [STEEL, STEEL], "yield_strength": 1e9}
BALL: Final = {"kind": "paraboloid", "radius": 0.01}
LOAD, FRICTIONS, FLATS = 100.0, np.linspace(0.0, 0.6, 25), np.linspace(0.0, 0.98, 50)
BLUE, RED, GREY = "tab:blue", "tab:red", "0.5"


def ask(name: str, query: dict[str, Any]) -> dict[str, Any]:
    """Return the response to a request, as JSON."""
    found: dict[str, Any] = json.loads(respond(name, json.dumps(query).encode(), JSON))
    return found


def sliding(friction: float) -> dict[str, Any]:
    """Ball that slides on a flat; request of docs/yield.md."""
    query = {
        "profile": BALL,
        "material": MATERIAL,
        "load": {"normal_force": LOAD},
        "x": [0.0],
        "z": [0.0],
        "largest": True,
    }
    if friction:
        query |= {
            "friction_coefficient": friction,
            "tangential": {"tangential_displacement": 1e-3},
        }
    return query


def ball(left: Axes, right: Axes) -> None:
    """Depth of the largest stress, and the onset of yield, over the coefficient of friction."""
    contact = ask("normal", {key: sliding(0.0)[key] for key in ("profile", "material", "load")})
    a, p0 = contact["contact_radius"][0], contact["maximum_pressure"][0]
    found = [ask("subsurface", sliding(float(friction))) for friction in FRICTIONS]
    for measure, name, criterion, color in (
        ("maximum_shear", "shear stress (Tresca)", "tresca", BLUE),
        ("von_mises", "von Mises stress", "von_mises", RED),
    ):
        depth = np.array([one["largest"][measure]["z"][0] / a for one in found])
        # The peak jumps to the surface, where another one is higher.
        jump = int(np.argmax(depth == 0))
        left.plot(FRICTIONS[:jump], depth[:jump], ".-", color=color, label=name)
        left.plot(FRICTIONS[jump:], depth[jump:], ".-", color=color)
        onset = [one["yield_onset_force"][criterion][0] for one in found]
        # p_0 grows with the cube root of the force.
        pressure = np.array([p0 * (force / LOAD) ** (1 / 3) / 1e9 for force in onset])
        right.plot(FRICTIONS, pressure, ".-", color=color, label=name)
    left.set(xlabel="coefficient of friction µ", ylabel="depth of the largest stress z/a")
    right.set(xlabel="coefficient of friction µ", ylabel="onset of yield $p_0/Y$", ylim=(0, None))
    left.legend(loc="center left")
    right.legend()


def punch(left: Axes, right: Axes) -> None:
    """Mean pressure at the onset of yield over b/a, and the place of the largest stress."""
    means, depths, radii = [], [], []
    for flat in FLATS.tolist():
        profile: dict[str, Any] = BALL
        if flat:
            profile = {"kind": "rounded_punch", "flat_radius": flat * 1e-3, "rounding_radius": 0.1}
        query = {"profile": profile, "material": MATERIAL, "load": {"contact_radius": 1e-3}}
        mean = ask("normal", query)["mean_pressure"][0]
        found = ask("subsurface", query | {"x": [0.0], "z": [0.0], "largest": True})
        peak = found["largest"]["maximum_shear"]
        means.append(mean / (2 * peak["value"][0]))
        depths.append(peak["z"][0] / 1e-3)
        radii.append(float(np.hypot(peak["x"][0], peak["y"][0])) / 1e-3)
    left.axhline(means[0], color=GREY, linewidth=0.8)
    left.plot(FLATS, means, ".-", color=BLUE)
    left.set(xlabel="flat radius b/a", ylabel="onset of yield $p_m/Y$", ylim=(0, None))
    left.annotate("ball", (0.8, means[0]), xytext=(0, 3), textcoords="offset points", color=GREY)
    right.plot(FLATS, depths, ".-", color=BLUE, label="depth z/a")
    right.plot(FLATS, radii, ".-", color=RED, label="radius r/a")
    right.set(xlabel="flat radius b/a", ylabel="place of the largest shear stress")
    right.legend()


def fretting_query(forces: list[float]) -> dict[str, Any]:
    """Ball on a flat whose tangential force oscillates; request of docs/yield.md."""
    return {
        "profile": BALL,
        "material": MATERIAL,
        "friction_coefficient": 0.5,
        "history": {
            "normal": {"normal_force": [LOAD] * len(forces)},
            "tangential": {"tangential_force": forces},
        },
        "body": 2,
    }


def fretting(left: Axes, right: Axes) -> None:
    """Stress along the surface over the cycle, and von Mises stress at its end."""
    contact = ask("normal", {"profile": BALL, "material": MATERIAL, "load": {"normal_force": LOAD}})
    a, p0 = contact["contact_radius"][0], contact["maximum_pressure"][0]
    x = np.linspace(-2, 2, 401)
    states = (
        ("$F_x = +0.8 µF_N$", [0.0, 40.0], RED, "-"),
        ("$F_x = 0$, end", [0.0, 40.0, -40.0, 0.0], BLUE, "-"),
        ("$F_x = -0.8 µF_N$", [0.0, 40.0, -40.0], GREY, "-"),
        ("without friction", [0.0, 0.0], "black", ":"),
    )
    for name, forces, color, style in states:
        line = {"x": (a * x).tolist(), "z": [0.0], "quantities": ["stress_xx"]}
        found = ask("subsurface", fretting_query(forces) | line)
        stress = np.array(found["stress_xx"][0][0]) / p0
        left.plot(x, stress, style, color=color, label=name)
    left.set(xlabel="x/a", ylabel=r"$\sigma_{xx}/p_0$ on the surface")
    left.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    at = np.linspace(-1.5, 1.5, 121), np.linspace(0.0, 1.5, 61)
    plane = {"x": (a * at[0]).tolist(), "z": (a * at[1]).tolist(), "largest": True}
    found = ask("subsurface", fretting_query([0.0, 40.0, -40.0, 0.0]) | plane)
    shown = right.contourf(
        *at, np.array(found["von_mises"][0]) / p0, 14, cmap="viridis", extend="max"
    )
    peak = found["largest"]["von_mises"]
    place = peak["x"][0] / a, peak["z"][0] / a
    right.plot(*place, "o", color=RED, markersize=5, clip_on=False)
    right.annotate("largest", place, xytext=(0, 6), textcoords="offset points", ha="center")
    right.set(xlabel="x/a", ylabel="z/a", aspect="equal")
    right.grid(visible=False)
    right.invert_yaxis()
    right.figure.colorbar(shown, ax=right, label="von Mises stress / $p_0$", shrink=0.75)


def main() -> None:
    """Write every figure as SVG."""
    with mpl.rc_context(STYLE):
        for name, draw in (("ball", ball), ("punch", punch), ("fretting", fretting)):
            figure = Figure(figsize=(7.3, 3.0))
            draw(*figure.subplots(1, 2))
            path = FOLDER / f"yield_{name}.svg"
            figure.savefig(path, metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main()
