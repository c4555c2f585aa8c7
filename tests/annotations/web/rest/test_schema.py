from __future__ import annotations

import json

import pytest
from django.core.management import call_command


@pytest.fixture(scope="module")
def schema(tmp_path_factory):
    """The schema, checked against OpenAPI 3.1; a warning is a failure."""
    path = tmp_path_factory.mktemp("schema") / "schema.json"
    options = {"format": "openapi-json", "validate": True, "fail_on_warn": True}
    call_command("spectacular", file=str(path), **options)
    return json.loads(path.read_text())


def test_the_schema_names_the_export_its_formats_and_the_token(schema):
    export = schema["paths"]["/api/v1/worlds/{world}/splits/{id}/export/"]["get"]
    assert schema["openapi"].startswith("3.1")
    texts = {"application/jsonl", "text/csv", "text/plain"}
    files = {"application/vnd.apache.parquet", "application/zip"}
    assert texts | files == set(export["responses"]["200"]["content"])
    assert {"as", "part", "source"} <= {parameter["name"] for parameter in export["parameters"]}
    assert {"token": []} in export["security"]
    assert schema["components"]["securitySchemes"]["token"] == {"type": "http", "scheme": "bearer"}


def test_every_change_names_its_version_and_its_refusals(schema):
    for path, methods in schema["paths"].items():
        for method, operation in methods.items():
            if method in ("patch", "put", "delete"):
                headers = {each["name"]: each for each in operation["parameters"]}
                assert headers["If-Match"]["required"], path
                refused = operation["responses"]["412"]["content"]
                assert "application/problem+json" in refused


def test_every_field_and_every_parameter_is_described(schema):
    silent = [
        f"{name}.{field}"
        for name, component in schema["components"]["schemas"].items()
        for field, said in component.get("properties", {}).items()
        if not said.get("description")
    ]
    silent += [
        f"{method} {path} {each['name']}"
        for path, methods in schema["paths"].items()
        for method, operation in methods.items()
        for each in operation.get("parameters", ())
        if not each.get("description")
    ]
    assert silent == []


def test_a_default_is_among_the_values_of_its_field(schema):
    operation = schema["paths"]["/api/v1/worlds/{world}/parse/jobs/"]["post"]
    parameters = {each["name"]: each["schema"] for each in operation["parameters"]}
    assert parameters["parser"]["default"] in parameters["parser"]["enum"]
    for path, methods in schema["paths"].items():
        for operation in methods.values():
            for each in operation.get("parameters", ()):
                values = each["schema"].get("enum")
                if values and "default" in each["schema"]:
                    assert each["schema"]["default"] in values, (path, each["name"])
