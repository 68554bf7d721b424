"""Draw the figures of chapter 5, and of torsion, with the public functions: `make figures`."""

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Final

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mdr_core import fields, normal, tangential, torsion
from mdr_core.normal import NormalContact
from mdr_core.profiles import Cone, FlatPunch, Paraboloid, Power, Profile, RoundedPunch
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.wear import limit

FOLDER: Final = Path(__file__).parent
# Every axis is a ratio, so the values are arbitrary.
E_STAR, G_STAR, FRICTION, EDGE = 1.0, 0.8, 0.3, 1.0
POINTS: Final = 401
STYLE: Final = {
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "figure.figsize": (5.6, 3.6),
    "figure.constrained_layout.use": True,
    "font.size": 9.0,
    "grid.alpha": 0.25,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "svg.hashsalt": "mdr",
}
SHAPES: Final[dict[str, Profile]] = {
    "cone": Cone(0.1),
    "paraboloid": Paraboloid(10.0),
    "$n = 6$": Power(0.01, 6.0),
    "flat punch": FlatPunch(EDGE),
}
FLATS: Final = (0.0, 0.5, 0.8, 0.95)


def normal_contact(profile: Profile) -> NormalContact:
    """Return the contact of radius a = 1; a flat punch has that radius under any load."""
    if isinstance(profile, FlatPunch):
        return normal.solve(profile, E_STAR, indentation_depth=1.0)
    return normal.solve(profile, E_STAR, contact_radius=EDGE)


def tangential_contacts(profile: Profile) -> TangentialContact:
    """Return contacts under tangential forces from zero to the limit, denser towards the limit."""
    contact = normal_contact(profile)
    rest = tangential.solve(contact, G_STAR, FRICTION, tangential_force=0.0)
    shares = 1 - np.linspace(1.0, 0.0, POINTS) ** 3
    forces = rest.limiting_force * shares
    return tangential.solve(contact, G_STAR, FRICTION, tangential_force=forces)


def rounded(flat: float) -> Profile:
    """Return the punch with rounded edges; without a flat it is the paraboloid."""
    return RoundedPunch(flat, 10.0) if flat else Paraboloid(10.0)


def force_ratio(contact: TangentialContact) -> Array:
    """F_x/(µ F_N)."""
    return contact.tangential_force / contact.limiting_force


def stick_radius_of_powers(axes: Axes) -> None:
    """Figure 5.2: c/a over the tangential force, Eq. (5.31)."""
    for name, profile in SHAPES.items():
        contact = tangential_contacts(profile)
        color = "0.6" if name == "$n = 6$" else None
        axes.plot(force_ratio(contact), contact.stick_radius / EDGE, label=name, color=color)
    _force_axis(axes)
    axes.set_ylabel("$c/a$")


def displacement_of_powers(axes: Axes) -> None:
    """Figure 5.3: the displacement over the tangential force, Eqs. (5.32), (5.33)."""
    for name, profile in SHAPES.items():
        contact = tangential_contacts(profile)
        color = "0.6" if name == "$n = 6$" else None
        reduced = G_STAR * EDGE * contact.tangential_displacement / contact.limiting_force
        axes.plot(force_ratio(contact), reduced, label=name, color=color)
    _force_axis(axes)
    axes.set_ylabel(r"$G^* a\, u_x/(\mu F_N)$")


def shear_stress_of_the_cone(axes: Axes) -> None:
    """Figure 5.4: the shear stress of the cone for ten stick radii, Eq. (5.53)."""
    contact = normal_contact(SHAPES["cone"])
    radius = np.linspace(0.0, EDGE, POINTS)
    sticking = np.arange(1, 11) / 10
    slipping = tangential.solve(contact, G_STAR, FRICTION, stick_radius=sticking * EDGE)
    stresses = fields.shear_stress(slipping, radius) / (FRICTION * contact.mean_pressure)
    colors = mpl.colormaps["viridis"](0.9 * (1 - sticking))
    for share, stress, color in zip(sticking, stresses, colors, strict=True):
        axes.plot(radius, stress, color=color, label=f"$c/a = {share:g}$")
    _radius_axis(axes)
    axes.set_ylabel(r"$\tau/(\mu p_m)$")


def profiles_of_the_rounded_punch(axes: Axes) -> None:
    """Figure 5.6: the profile f and the equivalent one-dimensional profile g, Eq. (5.58)."""
    flat, rounding = 0.5, 10.0
    profile = RoundedPunch(flat, rounding)
    x = np.linspace(-EDGE, EDGE, POINTS)
    depth = profile.g(np.array(EDGE))
    axes.plot(x, profile.f(np.abs(x)) / depth, label="$f(r)/d$, three-dimensional")
    axes.plot(x, profile.g(np.abs(x)) / depth, label="$g(x)/d$, one-dimensional")
    for edge in (-flat, flat):
        axes.axvline(edge, color="0.4", linestyle=":", linewidth=0.9)
    axes.annotate("$b$", (flat, 1.0), xytext=(3, 0), textcoords="offset points")
    axes.set_xlabel("$r/a$, $x/a$")
    axes.set_ylabel("height")
    axes.legend(loc="upper center")


def stick_radius_of_the_rounded_punch(axes: Axes) -> None:
    """Figure 5.7: c/a over the tangential force, for four flats, Eqs. (5.61), (5.65)."""
    for flat in FLATS:
        contact = tangential_contacts(rounded(flat))
        # Once the last point of the rounding slips, the flat slips at once.
        axes.plot(force_ratio(contact), contact.stick_radius / EDGE, label=f"$b/a = {flat:g}$")
    _force_axis(axes)
    axes.set_ylabel("$c/a$")


def pressure_of_the_rounded_punch(axes: Axes) -> None:
    """Figure 5.8: the pressure for four flats, Eq. (5.68)."""
    radius = _dense(FLATS)
    for flat in FLATS:
        contact = normal_contact(rounded(flat))
        stress = fields.pressure(contact, radius) / contact.mean_pressure
        axes.plot(radius, stress, label=f"$b/a = {flat:g}$")
    _radius_axis(axes)
    axes.set_ylabel("$p/p_m$")


def shear_stress_of_the_rounded_punch(axes: Axes) -> None:
    """Figure 5.9: the shear stress for the same flats and a stick radius each, Eq. (5.70)."""
    sticking = (0.5, 0.7, 0.9, 0.98)
    radius = _dense((*FLATS, *sticking))
    for flat, stick in zip(FLATS, sticking, strict=True):
        contact = normal_contact(rounded(flat))
        slipping = tangential.solve(contact, G_STAR, FRICTION, stick_radius=stick * EDGE)
        stress = fields.shear_stress(slipping, radius) / (FRICTION * contact.mean_pressure)
        axes.plot(radius, stress, label=f"$b/a = {flat:g}$, $c/a = {stick:g}$")
    _radius_axis(axes)
    axes.set_ylabel(r"$\tau/(\mu p_m)$")


def limiting_profiles_of_wear(axes: Axes) -> None:
    """Figure 5.12: the limiting profiles for nine stick radii, Eqs. (5.87), (5.88)."""
    contact = normal.solve(Paraboloid(10.0), E_STAR, indentation_depth=EDGE**2 / 10.0)
    depth, sticking = contact.indentation_depth, np.arange(1, 10) / 10
    # Eq. (5.84), solved for the displacement.
    displacement = FRICTION * E_STAR / G_STAR * depth * (1 - sticking**2)
    worn = limit.solve(contact, G_STAR, FRICTION, tangential_displacement=displacement)
    colors = mpl.colormaps["viridis"](0.9 * (1 - sticking))
    for index, (stick, color) in enumerate(zip(sticking, colors, strict=True)):
        stops = (worn.stick_radius[index], worn.wear_radius[index], 1.5 * EDGE)
        radius = _dense(stops)
        x = np.concatenate([-radius[::-1], radius])
        height = worn.limiting_profile(np.abs(x))[index] / depth
        axes.plot(x, height, color=color, label=f"$c/a = {stick:g}$")
    axes.set_xlabel("$r/a$")
    axes.set_ylabel(r"$f_\infty/d$")
    axes.legend(loc="upper center", ncols=3)


def torque_against_rotation(axes: Axes) -> None:
    """Torque of a twist for four profiles, beside the torque of a constant patch radius."""
    rotations = np.linspace(0.0, 0.5, POINTS)
    for name, profile in SHAPES.items():
        contact = normal_contact(profile)
        limit = FRICTION * contact.normal_force
        unit = limit / (G_STAR * EDGE**2)
        twisted = torsion.solve(contact, G_STAR, FRICTION, rotation=rotations * unit)
        color = "0.6" if name == "$n = 6$" else None
        axes.plot(rotations, twisted.torque / (limit * EDGE), label=name, color=color)
    patch = 3 * np.pi / 16
    axes.plot([0, 0, rotations[-1]], [0, patch, patch], "k:", label="constant patch radius")
    axes.set_xlim(-0.005, rotations[-1])
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(r"$G a^2\, \varphi/(\mu F_N)$")
    axes.set_ylabel(r"$M/(\mu F_N a)$")
    axes.legend()


FIGURES: Final[dict[str, Callable[[Axes], None]]] = {
    "5_2": stick_radius_of_powers,
    "5_3": displacement_of_powers,
    "5_4": shear_stress_of_the_cone,
    "5_6": profiles_of_the_rounded_punch,
    "5_7": stick_radius_of_the_rounded_punch,
    "5_8": pressure_of_the_rounded_punch,
    "5_9": shear_stress_of_the_rounded_punch,
    "5_12": limiting_profiles_of_wear,
    "torsion": torque_against_rotation,
}


def main() -> None:
    """Write every figure to this folder."""
    with mpl.rc_context(dict(STYLE)):
        for number, draw in FIGURES.items():
            figure = Figure()
            draw(figure.add_subplot())
            path = FOLDER / f"figure_{number}.svg"
            figure.savefig(path, metadata={"Date": None, "Creator": None})


def _dense(edges: tuple[float, ...]) -> Array:
    """Return radii up to the edge, denser near the slope discontinuities of the stresses."""
    places = np.unique([0.0, *edges, *(() if max(edges) > EDGE else (EDGE,))])
    shares = (1 - np.cos(np.pi * np.linspace(0.0, 1.0, POINTS // 4))) / 2
    parts = [low + (high - low) * shares for low, high in pairwise(places)]
    return np.unique(np.concatenate(parts))


def _force_axis(axes: Axes) -> None:
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(r"$F_x/(\mu F_N)$")
    axes.legend()


def _radius_axis(axes: Axes) -> None:
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("$r/a$")
    axes.legend()


if __name__ == "__main__":
    main()
