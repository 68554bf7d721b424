"""Generate the bank of partial slip: ``python -m tests.oracles.slip_generate``.

The output is byte-reproducible. Two processes compute it in the order of the cases.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mpmath import mp, mpf

from tests.oracles import slip_reference as reference
from tests.oracles.cases import FAMILIES, SCALES, Family, Profile
from tests.oracles.generate import (
    checked,
    condition,
    digits,
    loads,
    profile_at,
    representable,
    write,
)
from tests.oracles.slip_reference import CONTROLS, OUTPUTS, WORK_DIGITS, Material, Setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SHORT = {"indentation_depth": "d", "normal_force": "F", "contact_radius": "a"}
TANGENTIAL = {
    "tangential_force": "Fx",
    "tangential_displacement": "u",
    "stick_radius": "c",
}
NORMAL = ("contact_radius", "normal_force", "indentation_depth")
#: rho = F_x/(mu F_N): from incipient slip to the onset of full slip.
RATIOS = (1e-14, 1e-10, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999, 1 - 1e-6, 1 - 1e-9, 1 - 1e-12)
#: Friction coefficients and ratios E*/G*, used in turn.
FRICTION = (0.3, 0.05, 0.9)
MISMATCH = (1.2, 1.0, 1.5)
#: Families at every scale, and regimes that use all of `RATIOS`.
EVERYWHERE = ("hertz", "cone0.3", "rounded-punch", "power7.3", "sphere")
CLOSE = ("b(1+1e-9)", "b(1+1e-6)")
BLUNT = ("rounded_punch", "truncated_cone", "truncated_paraboloid")
#: Kinds whose break is a computed result, so that radii near it carry its rounding error.
DERIVED_BREAK = ("rounded_cone", "spherical_tip_cone")

#: Equations of the chapter by kind, per control, used in turn.
EQUATIONS: dict[str, tuple[tuple[str, ...], ...]] = {
    "paraboloid": (("(5.15)", "(5.16)"), ("(5.12)", "(5.17)"), ("(5.16)", "(5.15)")),
    "cone": (("(5.49)", "(5.50)"), ("(5.47)", "(5.50)"), ("(5.48)", "(5.47)")),
    "power": (("(5.31)", "(5.32)"), ("(5.29)", "(5.32)"), ("(5.30)", "(5.29)")),
    "rounded_punch": (("(5.65)",), ("(5.62)",), ("(5.65)", "(5.62)")),
    "flat_punch": (("(5.33)",),) * 3,
}
GENERAL = (("(5.19)",), ("(5.20)",), ("(5.19)", "(5.20)"))
FIELD_EQUATION: dict[str, tuple[str, ...]] = {
    "paraboloid": ("(5.38)", "(5.45)"),
    "cone": ("(5.53)", "(5.54)"),
    "rounded_punch": ("(5.70)",),
}
GENERAL_FIELD = ("(5.40)", "(5.18)")

Record = dict[str, Any]


@dataclass(frozen=True)
class Task:
    """One record: a contact, a tangential control and the values to prescribe."""

    name: str
    equation: str
    tags: dict[str, str]
    profile: Profile
    material: Material
    control: str
    load: float
    tangential: str
    sign: int
    #: rho, or ("c", radius), or ("past", multiple of u_max).
    target: tuple[Any, ...]
    energy: bool = True
    break_radius: float = 0.0


def material_at(scale: str, turn: int) -> Material:
    e_star = SCALES[scale][1]
    return Material(e_star, e_star / MISMATCH[turn % 3], FRICTION[turn // 3 % 3])


def scenes() -> Iterator[tuple[Family, str, float, str, str, str, tuple[float, ...]]]:
    """(family, regime, ratio, scale, normal control, tangential control, rho) of every record."""
    turn = 0
    names = list(SCALES)
    for family in FAMILIES:
        for number, (regime, ratio) in enumerate(family.regimes):
            blunt_edge = regime in CLOSE and number and family.name == "rounded-punch"
            main = number == 0 or blunt_edge
            scales = names if number == 0 and family.name in EVERYWHERE else [None]
            for scale in scales:
                for tangential in CONTROLS if main else (CONTROLS[turn % 3],):
                    turn += 1
                    where = scale or names[turn % len(names)]
                    rhos = RATIOS if main or regime in CLOSE else RATIOS[turn % 3 :: 3]
                    normal = NORMAL[turn // 2 % 3]
                    yield family, regime, ratio, where, normal, tangential, rhos


def tasks() -> Iterator[Task]:
    for turn, scene in enumerate(scenes()):
        task = _task(turn, *scene)
        if task is not None:
            yield task
    yield from _break_tasks()


def _equation(kind: str, tangential: str, turn: int) -> str:
    choice = EQUATIONS.get(kind, GENERAL)[CONTROLS.index(tangential)]
    return choice[turn % len(choice)]


def _profile(family: Family, scale: str) -> tuple[Profile, str]:
    profile = profile_at(family, scale)
    if profile is None:
        profile, scale = profile_at(family, "m-GPa"), "m-GPa"
    assert profile is not None, family.name
    return profile, scale


def _task(
    turn: int,
    family: Family,
    regime: str,
    ratio: float,
    scale: str,
    normal: str,
    tangential: str,
    rhos: tuple[float, ...],
) -> Task | None:
    profile, scale = _profile(family, scale)
    if profile["kind"] == "flat_punch":
        normal = "normal_force" if normal == "contact_radius" else normal
        if tangential == "stick_radius":
            return None
    given = loads(family, profile, ratio, scale)
    if not representable(*given.values()):
        # The force of a steep power is not representable there.
        profile, scale = profile_at(family, "m-GPa") or profile, "m-GPa"
        given = loads(family, profile, ratio, scale)
    if not representable(*given.values()):
        return None
    target: tuple[Any, ...] = rhos
    if tangential == "tangential_displacement" and turn % 2:
        target = (*rhos, ("past", 1.5))
    equation = _equation(profile["kind"], tangential, turn)
    ident = (
        f"{family.name}-{equation[1:-1]}-{regime}-{SHORT[normal]}-{TANGENTIAL[tangential]}-{scale}"
    )
    return Task(
        ident,
        equation,
        {"family": family.name, "regime": regime, "scale": scale},
        profile,
        material_at(scale, turn),
        normal,
        given[normal],
        tangential,
        -1 if turn % 4 == 1 and tangential != "stick_radius" else 1,
        target,
    )


def _break_tasks() -> Iterator[Task]:
    """Stick radii on both sides of the break, as close as 1e-9 of it."""
    turn = 0
    for family in FAMILIES:
        if not any(regime in CLOSE for regime, _ in family.regimes):
            continue
        turn += 1
        scale = list(SCALES)[turn % len(SCALES)]
        profile, scale = _profile(family, scale)
        b = family.break_radius(profile)
        load = 2 * b
        sides = (1,) if profile["kind"] in BLUNT else (-1, 1)
        radii = [b * (1 + side * step) for side in sides for step in (1e-9, 1e-6, 1e-3)]
        for tangential in CONTROLS:
            equation = _equation(profile["kind"], tangential, turn)
            yield Task(
                f"{family.name}-{equation[1:-1]}-c-near-b-a-{TANGENTIAL[tangential]}-{scale}",
                equation,
                {"family": family.name, "regime": "c-near-b", "scale": scale},
                profile,
                material_at(scale, turn),
                "contact_radius",
                load,
                tangential,
                1,
                tuple(("c", radius) for radius in radii),
            )


def prescribed_value(at: Setting, task: Task, target: Any) -> float | None:
    """Return the double to prescribe that is nearest to the target rho or stick radius."""
    with mp.workdps(WORK_DIGITS):
        full = at.mu * at.e_star * at.n
        if isinstance(target, tuple) and target[0] == "past":
            # At depth d, u_max of Eq. (5.17) and F_N/(2 E* a) of the punch have the same formula.
            return task.sign * float(mpf(target[1]) * at.shift * at.depth)
        if task.tangential == "tangential_force" and not isinstance(target, tuple):
            return task.sign * float(mpf(target) * full)
        if at.flat_punch:
            return task.sign * float(mpf(target) * full / (2 * at.g_star * at.a))
        if isinstance(target, tuple):
            c = mpf(target[1])
        else:
            force = mpf(target) * full
            c = reference.stick_radius(at, "tangential_force", force)
        if task.tangential == "stick_radius":
            return _inside(at, task, float(c))
        computed = reference.values(at, c, energy=False)[task.tangential]
        return task.sign * float(computed)


def _inside(at: Setting, task: Task, c: float) -> float | None:
    """Return a stick radius that stays in [b, a] after rounding."""
    margin = 0.0 if task.control == "contact_radius" else 64 * 2.0**-52
    if mpf(c) > at.a * (1 - margin) or (at.body.blunt and mpf(c) <= at.body.b):
        return None
    return c


def _head(task: Task) -> Record:
    """Return the leading members of a task's record: its id and its case."""
    return {
        "id": task.name,
        "equation": task.equation,
        "tags": task.tags,
        "profile": task.profile,
        "e_star": task.material.e_star,
        "g_star": task.material.g_star,
        "friction_coefficient": task.material.mu,
        "control": task.control,
        "load": task.load,
        "tangential_control": task.tangential,
    }


def tangential_record(task: Task) -> Record | None:
    at = reference.setting(task.profile, task.control, task.load, task.material)
    outputs = OUTPUTS if task.energy else OUTPUTS[:-1]
    record: Record = {
        **_head(task),
        "given": [],
        "regime": [],
        "expected": {name: [] for name in outputs},
        "condition": {name: [] for name in outputs},
        "condition_load": {name: [] for name in outputs},
    }
    seen = set()
    for target in task.target:
        given = prescribed_value(at, task, target)
        if given is None or given in seen or not representable(given):
            continue
        seen.add(given)
        _append(
            record,
            at,
            task,
            given,
            beyond_full_slip=isinstance(target, tuple) and target[0] == "past",
        )
    return record if record["given"] else None


def _append(
    record: Record, at: Setting, task: Task, given: float, *, beyond_full_slip: bool
) -> None:
    conditions: dict[str, dict[str, mpf]] = {"condition": {}, "condition_load": {}}
    if at.flat_punch:
        answers = reference.flat_answer(at, task.tangential, given)
    elif beyond_full_slip:
        answers = reference.full_slip(at, given)
    else:
        answer = reference.solve(at, task.tangential, given, energy=task.energy)
        answers = answer.values
        loads_ = answer.condition_load
        if task.tangential == "stick_radius" and task.control != "contact_radius":
            # The contact radius is then a computed result, rounded accordingly, and c lies next to
            # it.
            edge = {
                name: value / abs(answer.rates["a_load"]) * at.a for name, value in loads_.items()
            }
            loads_ = {name: value + edge[name] for name, value in loads_.items()}
        conditions = {"condition": answer.condition, "condition_load": loads_}
    if not representable(*(float(v) or 1.0 for v in answers.values())):
        return
    record["given"].append(given)
    sliding = answers["stick_radius"] == 0
    whole = answers["slip_width"] == 0
    record["regime"].append("full_slip" if sliding else "stick" if whole else "partial_slip")
    for name, row in record["expected"].items():
        row.append(digits(answers[name]))
        for kind, computed in conditions.items():
            # Without partial slip the results are proportional to the prescribed value.
            record[kind][name].append(condition(computed.get(name, mpf(2))))


@dataclass(frozen=True)
class FieldTask:
    task: Task
    given: float
    radii: tuple[float, ...]
    beyond_full_slip: bool = False


#: Ratios c/a of the fields; for blunt profiles between b and a, in units of a - b.
STICKS = (0.5, 1e-3, 1 - 1e-3, 1 - 1e-7)
FIELD_FAMILIES = (
    "hertz", "cone0.3", "cone0.001", "sphere", "ellipsoid-tall", "power0.2", "power0.5",
    "power1.5", "power7.3", "power60", "series-real", "series-negative", "rounded-punch",
    "truncated-cone", "truncated-paraboloid", "rounded-cone0.3", "spherical-tip-cone0.1",
    "hyperboloid0.4", "capped-paraboloid-blunted", "capped-paraboloid-worn", "flat-punch",
)  # fmt: skip


def field_radii(a: float, c: float, b: float, *, exact: bool) -> tuple[float, ...]:
    """Radii near and between 0, b, c and a, and outside."""
    near = [a * q for q in (0.0, 1e-9, 1e-3, 0.5)]
    near += [a * (1 + side * 1e-9) for side in (-1, 1)]
    near += [c * (1 + side * 1e-9) for side in (-1, 1)]
    near += [c + (a - c) * q for q in (1e-3, 0.5, 0.999)]
    near += [a * q for q in (1 + 1e-3, 3.0, 1e6)]
    if exact:
        near += [a, c]
    if b > 0:
        near += [b, *(b * (1 + side * step) for side in (-1, 1) for step in (1e-12, 1e-9, 1e-4))]
    return tuple(sorted({r for r in near if exact or r not in (a, c)}))


def _stick_at(family: Family, profile: Profile, a: float, ratio: float) -> float | None:
    b = family.break_radius(profile)
    c = a * ratio
    if profile["kind"] in BLUNT:
        c = b + (a - b) * ratio if ratio < 0.99 else c
        return c if b < c < a else None
    return c


def field_tasks() -> Iterator[FieldTask]:
    turn = 0
    chosen = [family for family in FAMILIES if family.name in FIELD_FAMILIES]
    for family in chosen:
        if family.name == "flat-punch":
            yield from _flat_fields(family)
            continue
        two = family.regimes[0][0] == "b/a=0.5"
        regimes = list(family.regimes[:1])
        if family.name == "rounded-punch":
            regimes.append(("b(1+1e-6)", 1 + 1e-6))
        far = [one for one in family.regimes if one[0] == FAR.get(family.name)]
        ratios = (*STICKS, 0.25, 0.75) if two else STICKS
        for regime, size in regimes:
            for ratio in ratios:
                turn += 1
                task = _field_task(family, regime, size, ratio, turn)
                if task is not None:
                    yield task
        for regime, size in far:
            for turn_, ratio in ((1, 0.3), (2, 0.99)):
                task = _field_task(family, regime, size, ratio, turn_)
                if task is not None:
                    yield task


#: Contacts near a body's end, or far beyond its break.
FAR = {
    "sphere": "0.999",
    "ellipsoid-tall": "0.9",
    "power60": "1.9",
    "series-real": "1.9",
    "hyperboloid0.4": "1000",
    "rounded-punch": "b/a=1e-3",
    "truncated-cone": "b/a=1e-3",
    "spherical-tip-cone0.1": "b/a=1e-6",
    "capped-paraboloid-worn": "b/a=1e-3",
}


def _field_task(
    family: Family, regime: str, size: float, ratio: float, turn: int
) -> FieldTask | None:
    """Return the controls: exact radii for most records, forces for every fourth."""
    profile, scale = _profile(family, list(SCALES)[turn % len(SCALES)])
    given = loads(family, profile, size, scale)
    a = given["contact_radius"]
    c = _stick_at(family, profile, a, ratio)
    if c is None or not representable(*given.values()):
        return None
    exact = turn % 4 != 3
    control = "contact_radius" if exact or turn % 8 == 3 else "normal_force"
    tangential = "stick_radius" if exact else CONTROLS[turn // 4 % 2]
    choice = FIELD_EQUATION.get(profile["kind"], GENERAL_FIELD)
    equation = choice[turn % len(choice)]
    ident = (
        f"fields-{family.name}-{equation[1:-1]}-{regime}-c{ratio:g}-"
        f"{SHORT[control]}-{TANGENTIAL[tangential]}-{scale}"
    )
    task = Task(
        ident,
        equation,
        {"family": family.name, "regime": regime, "scale": scale},
        profile,
        material_at(scale, turn),
        control,
        given[control],
        tangential,
        -1 if turn % 4 == 3 and turn % 3 == 0 else 1,
        (("c", c),),
        break_radius=family.break_radius(profile),
    )
    at = reference.setting(task.profile, task.control, task.load, task.material)
    asked = prescribed_value(at, task, ("c", c))
    if asked is None:
        return None
    radii = field_radii(a, c, task.break_radius, exact=exact)
    return FieldTask(task, asked, radii)


def _flat_fields(family: Family) -> Iterator[FieldTask]:
    profile, scale = _profile(family, "mm-MPa")
    given = loads(family, profile, 1e-3, scale)
    a = profile["radius"]
    radii = tuple(a * q for q in (0.0, 1e-9, 0.5, 1 - 1e-9, 1.0, 1 + 1e-9, 3.0, 1e6))
    for tangential in CONTROLS[:2]:
        task = Task(
            f"fields-flat-punch-5.33-{TANGENTIAL[tangential]}-{scale}",
            "(5.33)",
            {"family": family.name, "regime": "stick", "scale": scale},
            profile,
            material_at(scale, 0),
            "normal_force",
            given["normal_force"],
            tangential,
            1,
            (0.4,),
        )
        at = reference.setting(task.profile, task.control, task.load, task.material)
        asked = prescribed_value(at, task, 0.4)
        assert asked is not None
        yield FieldTask(task, asked, radii)


FIELDS = ("shear_stress", "slip", "normal_displacement", "foundation_load", "foundation_shear")


def field_record(job: FieldTask) -> Record:
    task = job.task
    at = reference.setting(task.profile, task.control, task.load, task.material)
    record: Record = {
        **_head(task),
        "given": job.given,
        "radius": list(job.radii),
        "expected": {name: [] for name in FIELDS},
        "condition": {name: [] for name in FIELDS},
    }
    with mp.workdps(WORK_DIGITS):
        fields = _flat_field_rows(at, task, job) if at.flat_punch else _field_rows(at, task, job)
        for r in job.radii:
            for name, (value, doubt) in fields(mpf(r)).items():
                sign = task.sign if name in {"shear_stress", "slip", "foundation_shear"} else 1
                record["expected"][name].append(signed(sign * value))
                record["condition"][name].append(condition(doubt))
    return record


Row = dict[str, tuple[mpf, mpf]]


def _flat_field_rows(at: Setting, task: Task, job: FieldTask) -> Callable[[mpf], Row]:
    computed = reference.flat_answer(at, task.tangential, job.given)
    a = at.a

    def row(r: mpf) -> Row:
        edge = mp.pi * mp.sqrt((a - r) * (a + r)) if r < a else mp.inf
        held = at.g_star * computed["tangential_displacement"]
        stress = mp.inf if r == a else held / edge if r < a else mpf(0)
        outside = 2 / mp.pi * at.depth * mp.asin(a / r) if r > a else at.depth
        inside = 1 if r <= a else 0
        one = mpf(1)
        return {
            "shear_stress": (stress, one),
            "slip": (mpf(0), mpf(0)),
            "normal_displacement": (outside, one),
            "foundation_load": (inside * at.e_star * at.depth, one),
            "foundation_shear": (inside * held, one),
        }

    return row


def _field_rows(at: Setting, task: Task, job: FieldTask) -> Callable[[mpf], Row]:
    answer = reference.solve(at, task.tangential, job.given, energy=False)
    doubts = FieldConditions(at, answer, task)

    def row(r: mpf) -> Row:
        c = answer.c
        load, shear = reference.foundation(at, c, r)
        stress = at.mu * reference.traction(at, c, r)
        moved, up = reference.slip(at, c, r), reference.displacement(at, r)
        return {
            "shear_stress": (stress, doubts.shear_stress(r, stress)),
            "slip": (moved, doubts.slip(r, moved)),
            "normal_displacement": (up, doubts.displacement(r, up)),
            "foundation_load": (load, doubts.load(r, load)),
            "foundation_shear": (shear, doubts.load(r, shear)),
        }

    return row


def signed(value: mpf) -> str:
    """Like `digits`, with the sign of an infinity."""
    return f"-{digits(-value)}" if value < 0 else digits(value)


class FieldConditions:
    """Condition numbers of a field at an exact radius.

    They are zero where a and c are both prescribed. Otherwise the field has the condition numbers
    of the two prescribed values. An edge that is a rounded result is also uncertain in its
    position: the slip annulus shifts as a whole (its width is free of cancellation), or c alone
    shifts if only c is a result.
    """

    def __init__(self, at: Setting, answer: reference.Answer, task: Task) -> None:
        self.at, self.answer, self.task = at, answer, task
        self.exact_a = task.control == "contact_radius"
        self.exact_c = task.tangential == "stick_radius"

    def _total(self, value: mpf, to_a: mpf, to_c: mpf, r: mpf) -> mpf:
        if value == 0 or mp.isinf(value):
            return mpf(0)
        rates, c, a = self.answer.rates, self.answer.c, self.at.a
        total = mpf(0)
        if not self.exact_c:
            total += abs(to_c * rates["c_given"])
        if not self.exact_a:
            total += abs(to_a * rates["a_load"] + to_c * rates["c_load"])
            total += abs((to_a + to_c) * a)
        elif not self.exact_c and abs(r - c) < (a - c) / 100:
            total += abs(to_c * c)
        return total / abs(value)

    def _break(self, r: mpf, value: mpf, fn: Callable[[mpf], mpf]) -> mpf:
        """r d/dr at an exact distance from a break that carries rounding error."""
        if self.task.profile["kind"] not in DERIVED_BREAK or value == 0 or mp.isinf(value):
            return mpf(0)
        if abs(r - self.at.body.b) > mpf("0.01") * self.at.body.b:
            return mpf(0)
        width = mpf(10) ** -17
        return abs(fn(r * (1 + width)) - fn(r)) / width / abs(value)

    def shear_stress(self, r: mpf, value: mpf) -> mpf:
        at, c = self.at, self.answer.c
        factor = at.mu * at.e_star / mp.pi
        to_a = to_c = mpf(0)
        if r < at.a:
            to_a = factor * at.body.dg(at.a) / mp.sqrt((at.a - r) * (at.a + r))
        if r < c:
            to_c = -factor * at.body.dg(c) / mp.sqrt((c - r) * (c + r))
        doubt = self._total(value, to_a, to_c, r)
        return doubt + self._break(r, value, lambda x: at.mu * reference.traction(at, c, x))

    def slip(self, r: mpf, value: mpf) -> mpf:
        at, c = self.at, self.answer.c
        to_c = at.shift * 2 / mp.pi * at.body.dg(c) * mp.acos(c / r) if r > c else mpf(0)
        doubt = self._total(value, mpf(0), to_c, r)
        return doubt + self._break(r, value, lambda x: reference.slip(at, c, x))

    def displacement(self, r: mpf, value: mpf) -> mpf:
        at = self.at
        share = 2 / mp.pi * mp.asin(at.a / r) if r > at.a else mpf(1)
        return self._total(value, at.body.dg(at.a) * share, mpf(0), r)

    def load(self, x: mpf, value: mpf) -> mpf:
        """q is a difference by definition, so the radius itself conditions it."""
        at, c = self.at, self.answer.c
        if value == 0:
            return mpf(0)
        slope_c = at.body.dg(c) * c * at.mu * at.e_star
        own = slope_c if x <= c else at.body.dg(x) * x * at.e_star
        edge = at.body.dg(at.a) * at.a * at.e_star
        return (own + edge) / abs(value)


def tangential_line(task: Task) -> str | None:
    return checked(tangential_record(task))


def field_line(job: FieldTask) -> str | None:
    return checked(field_record(job))


def main(names: list[str]) -> None:
    with ProcessPoolExecutor(2) as pool:
        if not names or "tangential" in names:
            write("tangential", pool.map(tangential_line, tasks(), chunksize=1))
        if not names or "slip_fields" in names:
            write("slip_fields", pool.map(field_line, field_tasks(), chunksize=1))


if __name__ == "__main__":
    main(sys.argv[1:])
