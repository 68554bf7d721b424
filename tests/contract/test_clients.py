"""Clients generated from the OpenAPI document: typed throughout, and one call of each endpoint."""

import ast
import importlib
import json
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from openapi_spec_validator import validate

from mdr_core.profiles import KINDS
from mdr_service.schemas.examples import EXAMPLES
from tests.faults.server import free_port, running, service

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[2]
DOCUMENT = ROOT / "openapi.json"
SOURCES = Path(__file__).with_name("clients")
# Module of the generated client, path, example and model of the request of every endpoint.
ENDPOINTS = [
    ("contact.normal", "/v1/normal", EXAMPLES["normal"], "NormalQuery"),
    ("contact.tangential", "/v1/tangential", EXAMPLES["tangential"], "TangentialQuery"),
    ("contact.history", "/v1/tangential/history", EXAMPLES["history"], "HistoryQuery"),
    ("contact.stress", "/v1/stress", EXAMPLES["stress"], "StressQuery"),
    ("contact.subsurface", "/v1/subsurface", EXAMPLES["subsurface"], "SubsurfaceQuery"),
    ("wear.wear", "/v1/wear", EXAMPLES["wear"], "WearQuery"),
    ("wear.evolution", "/v1/wear/evolution", EXAMPLES["evolution"], "EvolutionQuery"),
    ("batch.batch", "/v1/batch", EXAMPLES["batch"], "BatchQuery"),
]


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    port = free_port()
    with running(service(port), port):
        yield f"http://127.0.0.1:{port}"


def run(*command: str | Path, folder: Path) -> str:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def untyped(text: str) -> list[str]:
    """Return annotations of classes and public functions that leave a type open."""
    result = []
    for node in ast.walk(ast.parse(text)):
        annotations: list[ast.expr | None] = []
        if isinstance(node, ast.ClassDef):
            annotations = [part.annotation for part in node.body if isinstance(part, ast.AnnAssign)]
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.name in {
            "sync",
            "asyncio",
            "sync_detailed",
            "asyncio_detailed",
        }:
            arguments = [*node.args.args, *node.args.kwonlyargs]
            annotations = [node.returns, *(argument.annotation for argument in arguments)]
        result += [ast.unparse(one) for one in annotations if one and "Any" in ast.unparse(one)]
    return result


def test_the_document_is_valid() -> None:
    validate(json.loads(DOCUMENT.read_text("utf-8")))


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    folder = tmp_path_factory.mktemp("openapi_python_client")
    program = Path(sys.executable).with_name("openapi-python-client")
    run(program, "generate", "--path", DOCUMENT, "--meta", "none", "--output-path",
        folder / "mdr_client", folder=folder)  # fmt: skip
    sys.path.insert(0, str(folder))
    yield folder / "mdr_client"
    sys.path.remove(str(folder))


def test_openapi_python_client_is_typed(package: Path) -> None:
    files = [*(package / "api").rglob("*.py"), *(package / "models").rglob("*.py")]
    assert len(files) > 100
    assert [one for file in files for one in untyped(file.read_text("utf-8"))] == []


@pytest.mark.parametrize(("module", "path", "cases", "model"), ENDPOINTS)
def test_openapi_python_client_calls_every_endpoint(
    package: Path, address: str, module: str, path: str, cases: dict[str, Any], model: str
) -> None:
    assert package.exists()
    models = importlib.import_module("mdr_client.models")
    endpoint = importlib.import_module(f"mdr_client.api.{module}")
    request = next(iter(cases.values()))["value"]
    with importlib.import_module("mdr_client").Client(base_url=address, timeout=60) as client:
        answer = endpoint.sync(client=client, body=getattr(models, model).from_dict(request))
    expected = httpx.post(address + path, json=request, timeout=60).json()
    assert answer.to_dict() == expected


def test_datamodel_code_generator_is_typed_and_reads_the_answers(
    tmp_path: Path, address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    program, target = (
        Path(sys.executable).with_name("datamodel-codegen"),
        tmp_path / "mdr_models.py",
    )
    run(program, "--input", DOCUMENT, "--input-file-type", "openapi", "--output", target,
        "--output-model-type", "pydantic_v2.BaseModel", "--target-python-version", "3.11",
        folder=tmp_path)  # fmt: skip
    assert "Any" not in target.read_text("utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    models = importlib.import_module("mdr_models")
    for _, path, cases, model in ENDPOINTS:
        request = next(iter(cases.values()))["value"]
        body = getattr(models, model).model_validate(request)
        content = body.model_dump_json(exclude_unset=True, by_alias=True)
        headers = {"Content-Type": "application/json"}
        answer = httpx.post(address + path, content=content, headers=headers, timeout=60)
        assert answer.status_code == 200, answer.text
        getattr(models, model.replace("Query", "Answer")).model_validate_json(answer.content)


@pytest.fixture(scope="module")
def node(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the tools of `package.json` installed."""
    npm = shutil.which("npm")
    if npm is None:
        pytest.skip("npm is not installed")
    folder = tmp_path_factory.mktemp("node")
    shutil.copytree(SOURCES, folder, dirs_exist_ok=True)
    command = [npm, "install", "--silent", "--no-audit", "--no-fund", "--no-package-lock"]
    if subprocess.run(command, cwd=folder, capture_output=True, check=False).returncode:
        pytest.skip("the tools of package.json cannot be installed")
    return folder


def test_openapi_typescript_is_typed_and_calls_every_endpoint(node: Path, address: str) -> None:
    bin_ = node / "node_modules" / ".bin"
    run(bin_ / "openapi-typescript", DOCUMENT, "--output", "api.d.ts", folder=node)
    options = ["--strict", "--target", "es2022", "--module", "nodenext", "--lib", "es2022,dom",
               "--noUncheckedIndexedAccess", "--skipLibCheck"]  # fmt: skip
    run(bin_ / "tsc", *options, "client.ts", folder=node)
    result = json.loads(run("node", "client.js", address, folder=node))
    assert result.pop("status") == 200
    assert result.pop("kinds") == len(KINDS)
    hertz = (9 * 10**2 / (16 * 0.01 * 1.15e11**2)) ** (1 / 3)
    assert result["depth"] == pytest.approx(hertz, rel=1e-12, abs=0)
    assert all(isinstance(value, float) and value > 0 for value in result.values())


def test_redocly_and_spectral_report_nothing(node: Path) -> None:
    bin_ = node / "node_modules" / ".bin"
    (node / "ruleset.yaml").write_text('extends: ["spectral:oas"]\n', "utf-8")
    run(bin_ / "spectral", "lint", "--fail-severity", "hint", "--ruleset", "ruleset.yaml", DOCUMENT,
        folder=node)  # fmt: skip
    problems = json.loads(run(bin_ / "redocly", "lint", "--format", "json", DOCUMENT, folder=node))
    assert problems["problems"] == []
