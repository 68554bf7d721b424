"""Who may import whom: data flows one way, so imports point one way."""

import ast
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src"
NUMBERS = {"numpy", "scipy"}
WEB = {"fastapi", "starlette"}
ANSWERING = {"anyio", "orjson"}
OURS = {path.name for path in SOURCE.iterdir() if path.joinpath("__init__.py").exists()}


@dataclass(frozen=True)
class Row:
    """A module, or a package as a whole, and what it may import besides the standard library."""

    name: str
    ours: set[str]
    others: set[str]


CORE = {"mdr_core.errors", "mdr_core.typing", "mdr_core.checks", "mdr_core.lazy"}
TRANSFORMS = {"mdr_core.quadrature", "mdr_core.abel"}
CONTACT = CORE | TRANSFORMS | {"mdr_core.materials", "mdr_core.profiles", "mdr_core.foundation"}
# What the wire may name of the core: its public face, never the way it calculates.
RESULTS = {"mdr_core.normal", "mdr_core.tangential", "mdr_core.history"}
PUBLIC = RESULTS | {
    "mdr_core.wear",
    "mdr_core.errors",
    "mdr_core.materials",
    "mdr_core.profiles",
    "mdr_core.fields",
    "mdr_core.validity",
}
SCHEMAS = {"mdr_service.settings", "mdr_service.schemas"}
WIRE = SCHEMAS | {"mdr_service.problems", "mdr_service.wire"}

SOLVED = {"mdr_service.convert", "mdr_service.worn", "mdr_service.solve"}
WRITTEN = {"mdr_service.arrays", "mdr_service.pictures", "mdr_service.table"} | {
    "mdr_service.documents"
}

ADDRESSED = {"mdr_service.address", "mdr_service.arrays", "mdr_service.forms"} | {
    "mdr_service.parameters"
}

SWEEPS = {
    f"mdr_sweep.{name}"
    for name in ("engine", "errors", "grid", "plan", "progress", "requests", "study", "tables")
} | {"mdr_sweep.work"}

# Each row imports only from rows above it.
TABLE = (
    Row("mdr_core.errors", set(), set()),
    Row("mdr_core.typing", set(), NUMBERS),
    Row("mdr_core.checks", {"mdr_core.errors", "mdr_core.typing"}, NUMBERS),
    Row("mdr_core.lazy", set(), set()),
    Row("mdr_core.materials", CORE, NUMBERS),
    Row("mdr_core.quadrature", CORE, NUMBERS),
    Row("mdr_core.abel", CORE | {"mdr_core.quadrature"}, NUMBERS),
    Row("mdr_core.profiles", CORE | TRANSFORMS, NUMBERS),
    Row("mdr_core.sweeps", CORE | {"mdr_core.profiles"}, NUMBERS),
    Row("mdr_core.foundation", CONTACT - {"mdr_core.foundation"}, NUMBERS),
    Row("mdr_core.annulus", CONTACT | {"mdr_core.sweeps"}, NUMBERS),
    Row("mdr_core.validity", CONTACT, NUMBERS),
    Row("mdr_core.range", CONTACT, NUMBERS),
    Row(
        "mdr_core.normal",
        CONTACT | {"mdr_core.range", "mdr_core.sweeps", "mdr_core.validity"},
        NUMBERS,
    ),
    Row(
        "mdr_core.partial_slip",
        CONTACT | {"mdr_core.annulus", "mdr_core.normal", "mdr_core.sweeps"},
        NUMBERS,
    ),
    Row("mdr_core.sensitivity", CONTACT | {"mdr_core.annulus", "mdr_core.normal"}, NUMBERS),
    Row(
        "mdr_core.tangential",
        CONTACT
        | {"mdr_core.annulus", "mdr_core.normal", "mdr_core.partial_slip"}
        | {"mdr_core.sensitivity", "mdr_core.sweeps", "mdr_core.validity"},
        NUMBERS,
    ),
    Row(
        "mdr_core.history",
        CONTACT
        | {"mdr_core.annulus", "mdr_core.normal", "mdr_core.sensitivity"}
        | {"mdr_core.validity"},
        NUMBERS,
    ),
    Row(
        "mdr_core.fields",
        CONTACT
        | {"mdr_core.annulus", "mdr_core.history", "mdr_core.normal"}
        | {"mdr_core.tangential"},
        NUMBERS,
    ),
    Row("mdr_core.wear", CONTACT | RESULTS | {"mdr_core.annulus", "mdr_core.fields"}, NUMBERS),
    Row("mdr_core", set(), set()),
    Row("mdr_service.settings", set(), {"pydantic", "pydantic_core"}),
    Row("mdr_service.schemas", {"mdr_service.settings"}, {"pydantic", "pydantic_core"}),
    Row("mdr_service.catalogue", {"mdr_core.errors", "mdr_core.profiles"} | SCHEMAS, set()),
    Row("mdr_service.convert", PUBLIC | SCHEMAS, {"numpy"}),
    Row("mdr_service.worn", PUBLIC | SCHEMAS | {"mdr_service.convert"}, {"numpy"}),
    Row("mdr_service.solve", PUBLIC | SCHEMAS | SOLVED - {"mdr_service.solve"}, {"numpy"}),
    Row(
        "mdr_service.documents",
        PUBLIC | SCHEMAS | SOLVED,
        {"numpy"},
    ),
    Row(
        "mdr_service.problems",
        {"mdr_core.errors"} | SCHEMAS,
        {"orjson", "pydantic", "pydantic_core"},
    ),
    Row("mdr_service.wire", WIRE - {"mdr_service.wire"}, {"orjson", "pydantic"}),
    Row("mdr_service.arrays", set(), {"numpy"}),
    Row("mdr_service.table", set(), {"numpy", "orjson"}),
    Row("mdr_service.pictures", RESULTS | SOLVED | {"mdr_core.wear"}, {"matplotlib", "numpy"}),
    Row("mdr_service.questions", WRITTEN | SCHEMAS | SOLVED | {"mdr_service.wire"}, {"numpy"}),
    Row(
        "mdr_service.forms",
        WRITTEN - {"mdr_service.documents"} | {"mdr_service.problems", "mdr_service.wire"},
        set(),
    ),
    Row("mdr_service.parameters", SCHEMAS, set()),
    Row("mdr_service.address", WIRE | {"mdr_service.parameters"}, {"numpy"}),
    Row("mdr_service.sizes", SCHEMAS | WRITTEN | {"mdr_service.wire"}, set()),
    Row("mdr_service.cost", WIRE | {"mdr_service.sizes"}, {"orjson"}),
    Row(
        "mdr_service.batch",
        WIRE | {"mdr_service.cost", "mdr_service.questions", "mdr_service.sizes"},
        {"pydantic_core"},
    ),
    Row("mdr_service.watch", set(), {"orjson", "prometheus_client"}),
    Row("mdr_service.headers", set(), {"starlette"}),
    Row(
        "mdr_service.handlers",
        {"mdr_service.headers", "mdr_service.problems", "mdr_service.watch"},
        WEB | ANSWERING,
    ),
    Row("mdr_service.body", WIRE | {"mdr_service.headers"}, WEB),
    Row("mdr_service.apart", WIRE | {"mdr_service.cost", "mdr_service.questions"}, set()),
    Row(
        "mdr_service.compute",
        {"mdr_core.errors", "mdr_service.apart", "mdr_service.problems"}
        | {"mdr_service.settings", "mdr_service.watch"},
        {"anyio"},
    ),
    Row(
        "mdr_service.health",
        {"mdr_service.compute", "mdr_service.questions"} | WIRE,
        {"orjson"},
    ),
    Row("mdr_service.openapi", WIRE | ADDRESSED, WEB | {"pydantic"}),
    Row(
        "mdr_service.described",
        WIRE | WRITTEN | {"mdr_service.openapi", "mdr_service.questions"},
        set(),
    ),
    Row(
        "mdr_service.asking",
        WIRE
        | ADDRESSED
        | {"mdr_service.batch", "mdr_service.body", "mdr_service.compute", "mdr_service.cost"}
        | {"mdr_service.headers", "mdr_service.questions"},
        WEB,
    ),
    Row(
        "mdr_service.routes",
        WIRE
        | {"mdr_service.asking", "mdr_service.catalogue", "mdr_service.described"}
        | {"mdr_service.health", "mdr_service.openapi", "mdr_service.parameters"}
        | {"mdr_service.watch"},
        WEB,
    ),
    Row(
        "mdr_service.app",
        {"mdr_service.compute", "mdr_service.handlers", "mdr_service.openapi"}
        | {"mdr_service.routes"},
        WEB,
    ),
    Row("mdr_command.progress", set(), set()),
    Row(
        "mdr_command.ask",
        WIRE
        | {"mdr_command.progress", "mdr_core.wear", "mdr_service.forms", "mdr_service.questions"},
        set(),
    ),
    Row("mdr_command.openapi", {"mdr_service.app"}, set()),
    Row("mdr_command.serve", {"mdr_service.settings", "mdr_service.watch"}, {"uvicorn"}),
    # Loads the module of a command by its name, when it is asked for.
    Row("mdr_command.__main__", set(), set()),
    Row("mdr_command", set(), set()),
    Row("mdr_sweep.errors", set(), set()),
    Row("mdr_sweep.requests", set(), set()),
    Row("mdr_sweep.columns", {"mdr_sweep.requests"}, {"numpy", "pyarrow"}),
    Row("mdr_sweep.study", SCHEMAS, {"pydantic"}),
    Row(
        "mdr_sweep.bounds",
        SCHEMAS | {"mdr_service.questions", "mdr_sweep.columns"},
        {"numpy"},
    ),
    Row(
        "mdr_sweep.single",
        WIRE
        | {"mdr_core.fields", "mdr_service.questions", "mdr_service.solve"}
        | {"mdr_sweep.requests", "mdr_sweep.study"},
        {"numpy"},
    ),
    Row(
        "mdr_sweep.closed",
        PUBLIC
        | SCHEMAS
        | {"mdr_service.convert", "mdr_sweep.columns", "mdr_sweep.single", "mdr_sweep.study"},
        {"numpy"},
    ),
    Row(
        "mdr_sweep.chunk",
        {"mdr_core.sweeps", "mdr_service.problems", "mdr_sweep.bounds", "mdr_sweep.closed"}
        | {"mdr_sweep.columns", "mdr_sweep.single", "mdr_sweep.study"},
        {"numpy", "pyarrow"},
    ),
    Row("mdr_sweep.grid", {"mdr_sweep.columns", "mdr_sweep.errors"}, {"numpy", "pyarrow"}),
    Row("mdr_sweep.tables", {"mdr_sweep.columns", "mdr_sweep.errors"}, {"pyarrow"}),
    Row("mdr_sweep.work", {"mdr_sweep.errors"}, {"pyarrow"}),
    Row("mdr_sweep.plan", {"mdr_sweep.study", "mdr_sweep.tables"}, set()),
    Row("mdr_sweep.progress", set(), {"tqdm"}),
    Row(
        "mdr_sweep.engine",
        {"mdr_sweep.chunk", "mdr_sweep.errors", "mdr_sweep.study"},
        {"dask", "distributed", "pyarrow"},
    ),
    Row("mdr_sweep.command", SWEEPS, {"distributed"}),
    Row("mdr_sweep", set(), set()),
    Row("mdr_service", set(), set()),
)


def modules() -> Iterator[tuple[str, Path]]:
    for path in sorted(SOURCE.rglob("*.py")):
        parts = path.relative_to(SOURCE).with_suffix("").parts
        yield ".".join(part for part in parts if part != "__init__"), path


MODULES = dict(modules())


def row_of(module: str) -> Row:
    """Return the row of a module: its own, or that of the package around it."""
    for row in TABLE:
        if module == row.name or (row.name.count(".") and module.startswith(row.name + ".")):
            return row
    raise LookupError(f"{module} has no row in the table")


def imports(path: Path) -> Iterator[str]:
    """Yield what a file imports, wherever in the file, as full names of modules."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.module is not None
            assert node.level == 0, "imports are absolute"
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if inner in MODULES else node.module


@pytest.mark.parametrize("module", MODULES)
def test_imports_only_what_the_table_allows(module: str) -> None:
    row = row_of(module)
    for name in imports(MODULES[module]):
        top = name.partition(".")[0]
        if top in OURS:
            assert row_of(name).name in row.ours | {row.name}, f"{module} imports {name}"
        else:
            assert top in row.others | sys.stdlib_module_names, f"{module} imports {name}"


def test_the_table_points_upwards() -> None:
    above: set[str] = set()
    for row in TABLE:
        assert row.ours <= above, row.name
        above.add(row.name)


def test_the_table_has_no_row_without_a_module() -> None:
    assert {row.name for row in TABLE} <= set(MODULES)


def test_no_two_modules_need_each_other() -> None:
    graph = {
        module: {name for name in imports(path) if name in MODULES} - {module}
        for module, path in MODULES.items()
    }
    TopologicalSorter(graph).prepare()


def test_no_file_is_a_drawer() -> None:
    nameless = {"utils", "helpers", "common", "base", "manager"}
    assert not nameless & {module.rpartition(".")[2] for module in MODULES}
