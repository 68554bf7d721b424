"""Which route each query takes for each kind, and what it costs: `make chart-routes`.

Costs are counted, not timed: values of the integrand for each radius, and for a load, values of the
profile's own functions. The table is written to docs/routes.md.
"""

from __future__ import annotations

from drawing import FOLDER
from tests.core.evaluations import BEYOND, FIELDS, PROFILES, RADII, cost, counted, made

from mdr_core import normal, tangential
from mdr_core.profiles.profile import NORMAL_ANSWERS

TOLERANCES = (1e-3, 1e-6, 1e-10, 1e-13)
LOADS = ("indentation_depth", "normal_force", "contact_radius")

HEAD = """# Routes and what they cost

Written by `make chart-routes` ([routes.py](../benchmarks/charts/routes.py)). The counting is that
of [evaluations.py](../tests/core/evaluations.py); `tests/core/test_no_more_than_needed.py` holds
that a looser `rtol` never takes more. One profile of each kind, contact radius 1, stick radius
0.8.

## Fields

Values of the integrand for each radius, at `rtol` = 1e-3, 1e-6, 1e-10 (what is taken unless
another is given) and 1e-13. *closed* takes none, and 0 is a series, of a power's hypergeometric
function or of a short polynomial, for which no integrand is evaluated. *resolved*: a table's slope
is resolved into panels once (neighbouring ones are taken together as far as `rtol` allows), and its
stresses are then sums of closed moments. Displacements are asked for outside the contact, slip all
over it.

"""
LOADS_HEAD = """
## Loads

Values of the profile's own functions for one load, all six answers of a normal query
(depth, force, radius, mean pressure, stiffness, energy) together, by what is given; and for a
tangential force on top the stick radius and the displacement. They are solved to rounding
whatever `rtol` is: where there is no closed form an inverse takes some five steps of Newton's
method. The nodes of the energy's integral, which is computed only if it is asked for, are counted
apart.

"""


def table(header: list[str], rows: list[list[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def field_row(kind: str) -> list[str]:
    cells = []
    for name in FIELDS:
        count = BEYOND.size if name == "normal_displacement" else RADII.size
        costs = [cost(kind, name, rtol) / count for rtol in TOLERANCES]
        some = any(costs)
        closed = "resolved" if kind == "tabulated" else "closed"
        cells.append(", ".join(f"{one:.3g}" for one in costs) if some else closed)
    return [f"`{kind}`", *cells]


def load_row(kind: str) -> list[str]:
    profile = made(kind)
    force = float(normal.solve(profile, 1.0, indentation_depth=0.1).normal_force)
    loads = {"indentation_depth": 0.1, "normal_force": force, "contact_radius": 1.0}
    cells = [profile.normal_method]
    for name in LOADS:
        if profile.slips_at_once and name == "contact_radius":
            cells.append("its own")
            continue
        with counted(type(profile)) as count:
            contact = normal.solve(profile, 1.0, **{name: loads[name]})
            for answer in NORMAL_ANSWERS:
                if answer != "elastic_energy":
                    getattr(contact, answer)
        without = count.profile
        with counted(type(profile)) as count:
            _ = contact.elastic_energy
        cells.append(f"{without} + {count.profile}")
    contact = normal.solve(profile, 1.0, normal_force=force)
    _ = contact.indentation_depth
    with counted(type(profile)) as count:
        pushed = tangential.solve(contact, 0.8, 0.3, tangential_force=0.15 * force)
        _ = pushed.stick_radius, pushed.tangential_displacement
    return [f"`{kind}`", *cells, str(count.profile)]


def main() -> None:
    fields = table(["kind", *(f"`{name}`" for name in FIELDS)], [field_row(k) for k in PROFILES])
    header = ["kind", "route", *(f"given `{name}`: answers + energy" for name in LOADS)]
    header.append("tangential force on top")
    loads = table(header, [load_row(kind) for kind in PROFILES])
    text = HEAD + fields + LOADS_HEAD + loads
    (FOLDER.parent / "routes.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
