"""Write the labels of the explorer, `quantities.js`, from the OpenAPI document.

python -m tests.contract.page_quantities < openapi.json > src/mdr_service/explorer/quantities.js

A label is the description of a member up to its first comma, semicolon or bracket.
"""

import json
import re
import sys
from typing import Any

# Schema that describes a quantity first -> quantities of the page.
DESCRIBED = {
    "NormalAnswer": "indentation_depth normal_force contact_radius mean_pressure maximum_pressure"
    " normal_stiffness elastic_energy pull_off_force pull_off_depth retraction data_error",
    "TangentialAnswer": "tangential_force tangential_displacement stick_radius slip_width"
    " tangential_stiffness dissipated_energy",
    "StressAnswer": "radius pressure shear_stress slip normal_displacement",
    "EvolutionAnswer": "profile worn_depth worn_volume cycles",
    "TangentialQuery": "friction_coefficient",
    "ImpactAnswer": "normal_velocity tangential_velocity normal_rebound_velocity"
    " tangential_rebound_velocity duration maximum_indentation_depth maximum_normal_force",
    "FitAnswer": "e_star contact_point force_offset work_of_adhesion",
}
# Dimensions whose unit the page chooses apart from the others of the wire.
DISPLACEMENTS = re.compile(r"depth|displacement|retraction|slip$|profile|contact_point")
OWN = {"e_star": "modulus", "work_of_adhesion": "N/m"}
SHOWN = {
    "force*length": "energy", "force/length": "stiffness", "length^3": "volume",
    "length/time": "m/s", "time": "s",
}  # fmt: skip


def dimension(name: str, member: dict[str, Any]) -> str:
    wire = member["x-dimension"]
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
    for schema, names in DESCRIBED.items():
        members = document["components"]["schemas"][schema]["properties"]
        for name in names.split():
            label = re.split(r"[,;:]| ?\[", members[name]["description"])[0].replace("(r)", "")
            row = json.dumps([label, dimension(name, members[name])], ensure_ascii=False)
            lines.append(f"  {name}: {row},")
    return "\n".join([*lines, "};", ""])


if __name__ == "__main__":
    sys.stdout.write(quantities(json.load(sys.stdin)))
