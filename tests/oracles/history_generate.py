"""Generate the banks of histories: ``python -m tests.oracles.history_generate``.

The output is byte-reproducible. Two processes compute it in the order of the cases.
"""

from __future__ import annotations

import random
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from mpmath import mp, mpf

from tests.oracles import slip_reference as slip
from tests.oracles.cases import FAMILIES, SCALES, Family, Profile
from tests.oracles.generate import checked, condition, digits, loads, profile_at, write
from tests.oracles.history_reference import history
from tests.oracles.slip_generate import CLOSE, EQUATIONS, GENERAL, material_at
from tests.oracles.slip_reference import WORK_DIGITS, Material, Setting

if TYPE_CHECKING:
    from collections.abc import Iterator

Record = dict[str, Any]

#: Amplitude over that of full slip; the last four under displacement control only.
RATIOS = (1e-6, 1e-4, 1e-2, 0.1, 0.5, 0.9, 0.999, 1 - 1e-9)
BEYOND_FULL_SLIP = (1.0, 1.000001, 1.5, 100.0)
SHORT = {
    "indentation_depth": "d",
    "normal_force": "F",
    "tangential_force": "Fx",
    "tangential_displacement": "u",
}
#: Relative step of the difference quotients for condition numbers.
NUDGE = mpf(10) ** -18
#: Cycles with oscillating normal load: its relative amplitude, and the tangential amplitude as a
#: fraction of full slip. Those with a ratio below one never slip.
COUNT = 3
WAVES = ((1 / 64, 0.1), (1 / 8, 0.3), (1 / 8, 1e-3), (1 / 2, 0.7), (3 / 4, 1.5), (2**-10, 1e-2))


@dataclass(frozen=True)
class Scene:
    """A profile and its two normal loads, chosen for nearly identical contact radii."""

    family: str
    regime: str
    scale: str
    profile: Profile
    loads: dict[str, float]
    material: Material
    turn: int

    def tags(self) -> dict[str, str]:
        return {"family": self.family, "regime": self.regime, "scale": self.scale}

    def common(self) -> Record:
        return {
            "tags": self.tags(),
            "profile": self.profile,
            "e_star": self.material.e_star,
            "g_star": self.material.g_star,
            "friction_coefficient": self.material.mu,
        }

    def equation(self, control: str) -> str:
        choice = EQUATIONS.get(self.profile["kind"], GENERAL)
        own = choice[("tangential_force", "tangential_displacement").index(control)]
        return own[self.turn % len(own)]


def _chosen_regimes(family: Family) -> Iterator[tuple[str, float]]:
    """The first regime, and the regimes next to a break."""
    yield family.regimes[0]
    for regime, ratio in family.regimes[1:]:
        if regime in (*CLOSE, "b/a=0.95") and family.name in ("rounded-punch", "rounded-cone0.3"):
            yield regime, ratio


def scenes() -> Iterator[Scene]:
    turn = 0
    names = list(SCALES)
    for family in FAMILIES:
        for regime, ratio in _chosen_regimes(family):
            turn += 1
            scale = names[turn % len(names)]
            profile = profile_at(family, scale)
            if profile is None:
                profile, scale = profile_at(family, "m-GPa"), "m-GPa"
            assert profile is not None, family.name
            given = loads(family, profile, ratio, scale)
            yield Scene(family.name, regime, scale, profile, given, material_at(scale, turn), turn)


# Cycles at constant normal load -----------------------------------------------------------------


def _setting(scene: Scene, control: str, load: mpf) -> Setting:
    with mp.workdps(WORK_DIGITS):
        # A perturbed load is not representable and is therefore passed unrounded.
        return slip.setting(scene.profile, control, load, scene.material)


def _full_slip_displacement(at: Setting) -> mpf:
    """u_max; the flat punch has the same formula (Eqs. 5.17, 5.33)."""
    return at.shift * at.depth


def loop(at: Setting, control: str, amplitude: mpf) -> tuple[mpf, mpf]:
    """W and secant stiffness (F_max - F_min)/(u_max - u_min) of a cycle of given amplitude."""
    body, factor = at.body, 8 * (at.mu * at.e_star) ** 2 / at.g_star
    bound = at.mu * at.e_star * at.n
    if at.flat_punch:
        stiffness = 2 * at.g_star * at.a
        if control == "tangential_force" or amplitude * stiffness <= bound:
            return mpf(0), stiffness
        return 4 * bound * (amplitude - bound / stiffness), bound / amplitude
    if control == "tangential_displacement" and amplitude >= _full_slip_displacement(at):
        edge = body.b if body.blunt else mpf(0)
        # 4 mu F_N u0 - (8 mu^2 E*^2/G*) int (d - g)^2 dx, with int (d - g) dx = N/2.
        way = 4 * bound * (amplitude - _full_slip_displacement(at))
        return way + factor * slip.overlap(at, edge), bound / amplitude
    c = slip.stick_radius(at, control, amplitude)
    force = at.mu * at.e_star * (at.n - body.force(c))
    return factor * slip.overlap(at, c), force / (at.shift * (at.depth - body.g(c)))


def cycle_record(scene: Scene, normal: str, control: str) -> Record:
    load = scene.loads[normal]
    at = _setting(scene, normal, mpf(load))
    ident = (
        f"cycle-{scene.family}-{scene.equation(control)[1:-1]}-{scene.regime}"
        f"-{SHORT[normal]}-{SHORT[control]}-{scene.scale}"
    )
    record: Record = {
        "id": ident,
        "equation": scene.equation(control),
        **scene.common(),
        "control": normal,
        "load": load,
        "tangential_control": control,
        "given": [],
        "expected": {"energy_per_cycle": [], "secant_stiffness": []},
        "condition": {"energy_per_cycle": [], "secant_stiffness": []},
        "condition_load": {"energy_per_cycle": [], "secant_stiffness": []},
    }
    ratios = RATIOS if control == "tangential_force" else (*RATIOS, *BEYOND_FULL_SLIP)
    if at.flat_punch:
        # Immediate full slip; just below it, the dissipated energy is rounding error.
        ratios = tuple(ratio for ratio in ratios if ratio != 1)
    with mp.workdps(WORK_DIGITS):
        most = (
            at.mu * at.e_star * at.n
            if control == "tangential_force"
            else _full_slip_displacement(at)
        )
        near = _setting(scene, normal, mpf(load) * (1 + NUDGE))
        for ratio in ratios:
            given = float(mpf(ratio) * most)
            result = loop(at, control, mpf(given))
            nudged = loop(at, control, mpf(given) * (1 + NUDGE))
            moved = loop(near, control, mpf(given))
            record["given"].append(given)
            for index, name in enumerate(("energy_per_cycle", "secant_stiffness")):
                value = result[index]
                record["expected"][name].append(digits(value))
                for kind, other in (("condition", nudged), ("condition_load", moved)):
                    rate = (other[index] / value - 1) / NUDGE if value else mpf(0)
                    record[kind][name].append(condition(rate))
    return record


# Normal and tangential load in phase ------------------------------------------------------------


def _wave(mean: mpf, normal_amplitude: mpf, amplitude: mpf) -> list[tuple[mpf, mpf]]:
    top, bottom = (mean + normal_amplitude, amplitude), (mean - normal_amplitude, -amplitude)
    return [(mean, mpf(0)), top, *[bottom, top] * COUNT]


def _dissipated_energies(
    scene: Scene, mean: mpf, normal_amplitude: mpf, amplitude: mpf
) -> tuple[list[mpf], list[mpf]]:
    path = _wave(mean, normal_amplitude, amplitude)
    result = history(scene.profile, path, scene.material)
    steps = range(1, len(path) - 1, 2)
    dissipated = [result[i + 2].dissipated_energy - result[i].dissipated_energy for i in steps]
    forces = [[result[i + k].tangential_force for k in (0, 1, 2)] for i in steps]
    return dissipated, [(max(f) - min(f)) / (2 * amplitude) for f in forces]


def inphase_record(scene: Scene, part: float, ratio: float) -> Record:
    # Few digits, so that mean + swing and mean - swing are representable.
    mean = float(np.float32(scene.loads["indentation_depth"] / (1 + part)))
    normal_amplitude = mean * part
    top = scene.material.mu * scene.material.e_star / scene.material.g_star * mean
    given = (mean, normal_amplitude, ratio * top)
    with mp.workdps(WORK_DIGITS):
        exact = [mpf(value) for value in given]
        assert mpf(mean + normal_amplitude) - mean == normal_amplitude
        assert mean - mpf(mean - normal_amplitude) == normal_amplitude
        dissipated, stiffness = _dissipated_energies(scene, *exact)
        conditions = [mpf(0)] * COUNT
        for index in range(3):
            near = list(exact)
            near[index] *= 1 + NUDGE
            nudged, _ = _dissipated_energies(scene, *near)
            for cycle, (new, old) in enumerate(zip(nudged, dissipated, strict=True)):
                conditions[cycle] += abs(new / old - 1) / NUDGE if old else mpf(0)
    return {
        "id": f"inphase-{scene.family}-5.8-{part:g}-{ratio:g}-{scene.scale}",
        "equation": "(5.8)",
        **scene.common(),
        "mean": mean,
        "swing": normal_amplitude,
        "amplitude": given[2],
        "expected": {
            "energy_per_cycle": [digits(value) for value in dissipated],
            "secant_stiffness": [digits(value) for value in stiffness],
        },
        "condition": [condition(value) for value in conditions],
    }


# Random paths -----------------------------------------------------------------------------------


def random_path(name: str, load_steps: int, depth: float, most: float) -> list[tuple[float, float]]:
    """Depths up to `depth` and separations; monotonic load steps and reversals."""
    source = random.Random(name)
    path: list[tuple[float, float]] = []
    d, u = 0.0, 0.0
    for _ in range(load_steps):
        kind = source.randrange(8)
        if kind == 0 and path:
            d, u = source.choice(path)
        else:
            d = d if kind in (1, 2) else depth * source.uniform(-0.08, 1.0)
            u = u if kind == 3 else most * source.uniform(-1.1, 1.1)
        path.append((d, u))
    return path


def path_record(scene: Scene, load_steps: int) -> Record:
    depth = scene.loads["indentation_depth"]
    most = scene.material.mu * scene.material.e_star / scene.material.g_star * depth
    ident = f"path-{scene.family}-5.8-{load_steps}-{scene.scale}"
    path = random_path(ident, load_steps, depth, most)
    result = history(scene.profile, path, scene.material)
    names = ("normal_force", "tangential_force", "tangential_energy", "dissipated_energy")
    return {
        "id": ident,
        "equation": "(5.8)",
        **scene.common(),
        "indentation_depth": [d for d, _ in path],
        "tangential_displacement": [u for _, u in path],
        "expected": {name: [digits(getattr(one, name)) for one in result] for name in names},
    }


# All --------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Task:
    name: str
    scene: Scene
    options: tuple[Any, ...]


RUN = {"cycles": cycle_record, "inphase": inphase_record, "paths": path_record}


def tasks() -> Iterator[Task]:
    everything = list(scenes())
    controls = ("tangential_force", "tangential_displacement")
    normals = ("normal_force", "indentation_depth")
    for scene in everything:
        for number, control in enumerate(controls):
            yield Task("cycles", scene, (normals[(scene.turn + number) % 2], control))
    first = [one for number, one in enumerate(everything) if _new_kind(everything, number)]
    for number, scene in enumerate(first):
        for wave in WAVES if number < 3 else (WAVES[number % 6], WAVES[(number + 3) % 6]):
            yield Task("inphase", scene, wave)
    for scene in first:
        yield Task("paths", scene, (12,))
        yield Task("paths", scene, (50,))


def _new_kind(everything: list[Scene], number: int) -> bool:
    """The first case of each kind, and for powers all but the steep ones."""
    scene = everything[number]
    if scene.regime in CLOSE:
        return False
    if scene.profile["kind"] == "power":
        return scene.profile["exponent"] in (0.5, 1.5, 4.0)
    earlier = (one.profile["kind"] for one in everything[:number])
    return scene.profile["kind"] not in earlier


def line(task: Task) -> str | None:
    return checked(RUN[task.name](task.scene, *task.options))


def main() -> None:
    everything = list(tasks())
    with ProcessPoolExecutor(2) as pool:
        for name in RUN:
            chosen = [task for task in everything if task.name == name]
            write(f"history_{name}", pool.map(line, chosen, chunksize=1))


if __name__ == "__main__":
    main()
