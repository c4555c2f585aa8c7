from __future__ import annotations

import yaml


def test_the_schema_names_the_export_its_formats_and_the_token(client, db):
    schema = yaml.safe_load(client.get("/api/v1/schema/").content)
    export = schema["paths"]["/api/v1/worlds/{world}/splits/{id}/export/"]["get"]
    assert schema["openapi"].startswith("3.1")
    assert {"application/jsonl", "text/csv", "text/plain"} == set(
        export["responses"]["200"]["content"]
    )
    assert {"as", "part", "source"} <= {parameter["name"] for parameter in export["parameters"]}
    assert {"token": []} in export["security"]
    assert schema["components"]["securitySchemes"]["token"] == {"type": "http", "scheme": "bearer"}
