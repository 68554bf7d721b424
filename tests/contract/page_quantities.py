"""Write the labels of the explorer, `quantities.js`, from the OpenAPI document.

python -m tests.contract.page_quantities < openapi.json > src/mdr_service/explorer/quantities.js

A label is the description of a member up to its first comma, semicolon or bracket.
"""

import json
import re
import sys
from typing import Any

from mdr_service.schemas.quantities import heading

# Schemas that describe the quantities, the first one of each.
DESCRIBED = [
    "NormalAnswer",
    "TangentialAnswer",
    "TorsionAnswer",
    "StressAnswer",
    "SubsurfaceAnswer",
    "EvolutionAnswer",
    "WearAnswer",
    "HistoryAnswer",
    "ImpactAnswer",
    "FitAnswer",
    "LoopAnswer",
    "TangentialQuery",
]
# Plain numbers that the page shows as quantities.
ERRORS = {"data_error", "pressure_data_error", "pull_off_data_error"}
NUMBERS = {"cycles", "friction_coefficient", "rotation"} | ERRORS
# Dimensions whose unit the page chooses apart from the others of the wire.
DISPLACEMENTS = re.compile(r"depth|displacement|retraction|slip$|profile|contact_point")
OWN = {
    "e_star": "modulus",
    "g_star": "modulus",
    "work_of_adhesion": "N/m",
    "rotation": "rad",
    "torque": "N·m",
    "torsional_stiffness": "N·m",
}
SHOWN = {
    "force*length": "energy", "force/length": "stiffness", "length^3": "volume",
    "length/force": "compliance",
    "length/time": "m/s", "time": "s", "force*time": "N·s",
}  # fmt: skip


def dimension(name: str, wire: str) -> str:
    if wire == "length" and DISPLACEMENTS.search(name):
        return "displacement"
    return OWN.get(name) or SHOWN.get(wire, wire)


def quantities(document: dict[str, Any]) -> str:
    """Return the module `quantities.js` for an OpenAPI document."""
    lines = [
        "// Label and dimension of each quantity, by its name in requests and responses.",
        "// Written from the OpenAPI document by `make openapi`.",
        "",
        "export const QUANTITIES = {",
    ]
    found: dict[str, list[str]] = {}
    for schema in DESCRIBED:
        for name, member in document["components"]["schemas"][schema]["properties"].items():
            wire = member.get("x-dimension", "1")
            if name not in found and (wire not in {"1", "as the parameter"} or name in NUMBERS):
                found[name] = [heading(member["description"]), dimension(name, wire)]
    rows = [f"  {name}: {json.dumps(row, ensure_ascii=False)}," for name, row in found.items()]
    return "\n".join([*lines, *rows, "};", ""])


if __name__ == "__main__":
    sys.stdout.write(quantities(json.load(sys.stdin)))
