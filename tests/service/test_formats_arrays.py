"""Responses as NumPy archives: bit-identical to the JSON response, without pickle."""

import io
import zipfile
from math import inf

import httpx
import numpy as np
import pytest

from tests.conftest import Client
from tests.service.test_formats import BALL, EVERY_EXAMPLE, ask

NPZ = "application/x-npz"


def arrays(response: httpx.Response) -> dict[str, np.ndarray]:
    assert response.status_code == 200
    assert response.headers["content-type"] == NPZ
    with np.load(io.BytesIO(response.content), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def with_infinity(value: object) -> object:
    """Return a JSON value with `null` replaced by the infinity it represents."""
    if isinstance(value, list):
        return [with_infinity(each) for each in value]
    return inf if value is None else value


@pytest.mark.every(2)
@EVERY_EXAMPLE
def test_arrays_are_bit_identical_to_json(
    client: Client, path: str, query: dict[str, object]
) -> None:
    result = arrays(ask(client, path, query, NPZ))
    document = client.post(path, query).json()
    # The state of a history has no array.
    document.pop("final_state", None)
    assert list(result) == list(document)
    warnings = document.pop("warnings")
    warning_array = result.pop("warnings")
    assert warning_array.dtype.names == ("code", "message", "instead", "value", "limit")
    assert [
        {
            name: None if value == "" or str(value) == "nan" else value
            for name, value in zip(warning_array.dtype.names, each, strict=True)
        }
        for each in warning_array.tolist()
    ] == warnings
    for name, values in document.items():
        assert result[name].tolist() == with_infinity(values), name
        assert result[name].dtype.kind in {"f", "i", "U"}


def test_fields_are_arrays_by_load_and_radius(client: Client) -> None:
    query = {
        **BALL,
        "load": {"normal_force": [1.0, 10.0, 20.0]},
        "radius": [0.0, 1e-5],
        "quantities": ["pressure"],
    }
    result = arrays(ask(client, "/v1/stress", query, NPZ))
    assert result["pressure"].shape == (3, 2)
    assert result["pressure"].dtype == np.float64
    assert result["radius"].shape == (2,)
    assert result["method"].shape == result["error_estimate"].shape == ()


def test_repeated_query_has_identical_bytes(client: Client) -> None:
    first, second = (ask(client, "/v1/normal", BALL, NPZ).content for _ in range(2))
    assert first == second
    with zipfile.ZipFile(io.BytesIO(first)) as archive:
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


@pytest.mark.parametrize(
    ("name", "media_type"),
    [
        ("json", "application/json"),
        ("csv", "text/csv"),
        ("npz", NPZ),
        ("svg", "image/svg+xml"),
    ],
)
def test_format_parameter_selects_the_media_type(
    client: Client, name: str, media_type: str
) -> None:
    query = {**BALL, "radius": [0.0, 1e-5], "quantities": ["pressure"]}
    named = ask(client, f"/v1/stress?format={name}", query, "text/html, image/svg+xml;q=0.1")
    assert named.status_code == 200
    assert named.headers["content-type"].partition(";")[0] == media_type
    assert named.content == ask(client, "/v1/stress", query, media_type).content


@pytest.mark.parametrize("name", ["xml", "", "JSON", "text/csv"])
def test_unknown_format_is_rejected_with_the_available_formats(client: Client, name: str) -> None:
    response = ask(client, f"/v1/normal?format={name}", BALL, "application/json")
    assert response.status_code == 406
    assert response.json()["detail"] == (
        "available formats: json (application/json), csv (text/csv), npz (application/x-npz), "
        "txt (text/plain), svg (image/svg+xml), png (image/png), pdf (application/pdf)"
    )


@pytest.mark.parametrize(
    ("query_string", "pointer"),
    [
        ("fromat=csv", "/fromat"),
        ("format=csv&format=json", "/format"),
        ("&".join(f"u{i}=1" for i in range(101)), ""),
    ],
)
def test_other_query_parameters_of_post_are_rejected(
    client: Client, query_string: str, pointer: str
) -> None:
    response = ask(client, f"/v1/normal?{query_string}", BALL, "*/*")
    assert response.status_code == 422
    assert response.json()["errors"][0]["pointer"] == pointer
