"""Generate the bank of wear limits: ``python -m tests.oracles.wear_generate``.

The output is byte-reproducible. Two processes compute it in the order of the cases.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mpmath import mp, mpf

from tests.oracles import wear_reference as reference
from tests.oracles.cases import FAMILIES, SCALES, Profile
from tests.oracles.generate import (
    checked,
    condition,
    digits,
    loads,
    profile_at,
    representable,
    write,
)
from tests.oracles.slip_generate import BLUNT, material_at
from tests.oracles.slip_reference import WORK_DIGITS, Material, Setting, setting
from tests.oracles.wear_reference import FIELDS, OUTPUTS, Limit

if TYPE_CHECKING:
    from collections.abc import Iterator

#: c/a, or its position between the flat and a; every second one in turn.
PLACES = (1e-3, 0.1, 0.5, 0.9, 1 - 1e-3, 1 - 1e-6)
PAIRS = (
    ("indentation_depth", "tangential_displacement"),
    ("normal_force", "tangential_force"),
    ("indentation_depth", "tangential_force"),
    ("normal_force", "tangential_displacement"),
)
SHORT = {"indentation_depth": "d", "normal_force": "F"}
AMPLITUDE = {"tangential_displacement": "u", "tangential_force": "Fx"}
#: Flats that make up nearly all of the contact.
CLOSE = ("b(1+1e-3)", "b(1+1e-6)")
#: Equations that apply to a pair, used in turn.
EQUATIONS = {
    PAIRS[0]: ("(5.80)", "(5.82)", "(5.83)"),
    PAIRS[1]: ("(5.82)", "(5.83)"),
    PAIRS[2]: ("(5.83)", "(5.82)"),
    PAIRS[3]: ("(5.90)",),
}
OF_PARABOLOID = {
    PAIRS[0]: ("(5.85)", "(5.87)", "(5.88)"),
    PAIRS[1]: ("(5.88)", "(5.85)"),
    PAIRS[2]: ("(5.87)", "(5.88)"),
    PAIRS[3]: ("(5.90)",),
}
#: Beyond it, adjacent doubles as amplitudes give unrelated results.
MAX_CONDITION = 1e11
WIDE, NARROW = mpf("0.5"), mpf("1e-6")

Record = dict[str, Any]


@dataclass(frozen=True)
class Task:
    """One record to compute."""

    name: str
    equation: str
    tags: dict[str, str]
    profile: Profile
    material: Material
    control: str
    load: float
    amplitude: str
    places: tuple[float, ...]


def tasks() -> Iterator[Task]:
    turn, names = 0, list(SCALES)
    for family in FAMILIES:
        if family.name == "flat-punch":
            continue
        for number, (regime, ratio) in enumerate(family.regimes):
            blunt = family.make(1.0)["kind"] in BLUNT
            if number and not (blunt and regime in CLOSE):
                continue
            for pair in PAIRS:
                turn += 1
                # Every pair is used at every scale: five scales, four pairs.
                wanted = names[turn % len(names)]
                for scale in (wanted, "m-GPa"):
                    profile = profile_at(family, scale)
                    given = loads(family, profile, ratio, scale) if profile else {"": 0.0}
                    if representable(*given.values()):
                        break
                else:
                    continue
                assert profile is not None
                tags = {"family": family.name, "regime": regime, "scale": scale}
                yield _task(turn, pair, tags, profile, material_at(scale, turn), given[pair[0]])


def _task(
    turn: int,
    pair: tuple[str, str],
    tags: dict[str, str],
    profile: Profile,
    material: Material,
    load: float,
) -> Task:
    choice = (OF_PARABOLOID if profile["kind"] == "paraboloid" else EQUATIONS)[pair]
    equation = choice[turn // 4 % len(choice)]
    short = f"{SHORT[pair[0]]}-{AMPLITUDE[pair[1]]}"
    name = f"wear-{tags['family']}-{equation[1:-1]}-{tags['regime']}-{short}-{tags['scale']}"
    places = PLACES[turn // 2 % 2 :: 2]
    return Task(name, equation, tags, profile, material, pair[0], load, pair[1], places)


def prescribed_value(at: Setting, task: Task, place: float) -> float | None:
    """Amplitude to prescribe for a stick edge at this position; None if there is no such limit."""
    body = at.body
    with mp.workdps(WORK_DIGITS):
        low = body.b if body.blunt else mpf(0)
        c = low + (at.a - low) * mpf(place)
        step = at.depth - body.g(c)
        if (task.control, task.amplitude) == PAIRS[0]:
            return float(at.shift * step)
        if task.control == "normal_force":
            lost = at.n - body.force(c)
            if task.amplitude == "tangential_force":
                return float(at.mu * at.e_star * lost)
            step = lost / (2 * c)
            return float(at.shift * step) if step < at.depth * WIDE * 2 else None
        # Only the branch that is reached from outside: c (d - g) decreases with c.
        share = c * step
        return float(2 * at.mu * at.e_star * share) if step < c * body.dg(c) else None


def perturbed(task: Task, given: float) -> tuple[Limit, ...]:
    """The limit, and the limits for a perturbed load and a perturbed amplitude."""
    with mp.workdps(WORK_DIGITS):
        far = 1 + mpf(10) ** -reference.NUDGE_DIGITS
        exact = mpf(task.load), mpf(given)
        inputs = (exact, (exact[0] * far, exact[1]), (exact[0], exact[1] * far))
    near, result = None, []
    for load, amplitude in inputs:
        query = task.profile, task.control, load, task.material, task.amplitude, amplitude
        result.append(reference.solve(*query, near))
        near = result[0].width
    return tuple(result)


def _condition(values: list[mpf], own: mpf) -> float | None:
    first = values[0]
    if first == 0 or mp.isinf(first):
        return condition(mpf(0) if first == 0 else first)
    with mp.workdps(WORK_DIGITS):
        change = mp.fsum(abs(other / first - 1) for other in values[1:])
        return condition(change * mpf(10) ** reference.NUDGE_DIGITS + own)


def record_of(task: Task) -> Record | None:
    at = setting(task.profile, task.control, task.load, task.material)
    rows: dict[str, dict[str, list[Any]]] = {
        kind: {name: [] for name in OUTPUTS} for kind in ("expected", "condition")
    }
    given: list[float] = []
    fields: list[Record] = []
    for place in task.places:
        amplitude = prescribed_value(at, task, place)
        if amplitude is None or amplitude in given or not representable(amplitude):
            continue
        try:
            limits = perturbed(task, amplitude)
        except ArithmeticError as error:
            if "profile's end" in str(error) or "no stick zone" in str(error):
                continue
            raise
        result = [reference.answers(limit) for limit in limits]
        if not representable(*(float(value) for value in result[0].values())):
            continue
        edges = _condition([answer["stick_radius"] for answer in result], mpf(0))
        if edges is None or edges > MAX_CONDITION:
            continue
        for name in OUTPUTS:
            values = [answer[name] for answer in result]
            rows["expected"][name].append(digits(values[0]))
            rows["condition"][name].append(_condition(values, mpf(0)))
        if given or place >= PLACES[2]:
            fields.append({"index": len(given), **field_rows(limits)})
        given.append(amplitude)
    if not given:
        return None
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
        "amplitude": task.amplitude,
        "given": given,
        **rows,
        "fields": fields,
    }


def field_rows(limits: tuple[Limit, ...]) -> Record:
    """All fields from the axis to beyond the worn annulus, with radii near both of its edges."""
    first = limits[0]
    c, width, end = first.c, first.width, reference._end(first.at)
    inside = [c * q for q in (mpf("1e-9"), mpf("1e-3"), WIDE, 1 - mpf("1e-3"), 1 - mpf("1e-8"))]
    parts = (NARROW, mpf("1e-3"), WIDE, 1 - mpf("1e-3"), 1 - NARROW)
    radii = [float(r) for r in (*inside, *(c + width * q for q in parts), (c + width) * 3)]
    b = first.at.body.b
    # No closer to an edge than the resolution of a double.
    edges = [edge for edge in (b, c, c + width) if edge]
    apart = [r for r in radii if all(abs(r - edge) > edge * 1e-13 for edge in edges)]
    kept = sorted({r for r in apart if mpf(r) <= end})
    values: dict[str, list[list[mpf]]] = {
        name: [[reference.field(limit, name, mpf(r)) for limit in limits] for r in kept]
        for name in ("worn_depth", "pressure")
    }
    with mp.workdps(WORK_DIGITS):
        values["limiting_profile"] = [
            [worn + first.at.body.f(mpf(r)) for worn in row]
            for r, row in zip(kept, values["worn_depth"], strict=True)
        ]
    rows: Record = {"radius": kept, "expected": {}, "condition": {}}
    for name in FIELDS:
        rows["expected"][name] = [digits(row[0]) for row in values[name]]
        rows["condition"][name] = [
            _condition(row, _own(first, name, mpf(r), row[0]))
            for r, row in zip(kept, values[name], strict=True)
        ]
    return rows


def _own(limit: Limit, name: str, r: mpf, value: mpf) -> mpf:
    """Effect of the rounding error of c: c d/dc at an exact radius."""
    c, step, at = limit.c, limit.step, limit.at
    if value == 0 or mp.isinf(value):
        return mpf(0)
    if name == "pressure":
        rate = at.e_star / mp.pi * step * c / mp.sqrt((c - r) * (c + r)) ** 3 if r < c else mpf(0)
        return abs(c * rate / value)
    inside = c < r < c + limit.width
    return abs(2 / mp.pi * c * step / mp.sqrt((r - c) * (r + c)) / value) if inside else mpf(0)


def line(task: Task) -> str | None:
    return checked(record_of(task))


def main() -> None:
    with ProcessPoolExecutor(2) as pool:
        write("wear_limit", pool.map(line, tasks(), chunksize=1))


if __name__ == "__main__":
    main()
