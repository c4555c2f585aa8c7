"""/api/v1/schema/: made once for each process, the same for everybody."""

from __future__ import annotations

import json

import pytest
import yaml

from annotations.web.rest import schema_view

ADDRESS = "/api/v1/schema/"


@pytest.fixture(autouse=True)
def nothing_made(monkeypatch):
    monkeypatch.setattr(schema_view, "_made", {})


def test_it_is_made_once_whoever_asks(client, adam, db, monkeypatch):
    first = client.get(ADDRESS)
    monkeypatch.setattr(schema_view.SchemaFile, "generator_class", None)  # fails when called
    assert adam.get(ADDRESS).content == first.content
    assert client.get(f"{ADDRESS}?version=7").content == first.content
    assert b"/api/v1/worlds/" in first.content


def test_it_is_sent_again_only_where_it_has_changed(client, db):
    first = client.get(ADDRESS)
    again = client.get(ADDRESS, headers={"if-none-match": first["ETag"]})
    assert (again.status_code, again.content) == (304, b"")
    other = client.get(ADDRESS, headers={"if-none-match": '"other"'})
    assert (other.status_code, other["ETag"]) == (200, first["ETag"])


@pytest.mark.parametrize(
    ("query", "accept", "kind"),
    [
        ("", "*/*", "application/json"),
        ("", "application/json", "application/json"),
        ("", "application/vnd.oai.openapi+json", "application/vnd.oai.openapi+json"),
        ("?format=json", "*/*", "application/json"),
        ("?format=json", "application/yaml", "application/json"),
        ("", "application/yaml", "application/yaml"),
        ("?format=yaml", "*/*", "application/vnd.oai.openapi"),
        ("?format=yaml", "application/json", "application/vnd.oai.openapi"),
    ],
)
def test_the_format_is_that_of_the_address_or_of_the_header(query, accept, kind, client, db):
    answer = client.get(ADDRESS + query, headers={"accept": accept})
    assert (answer.status_code, answer["Content-Type"]) == (200, kind)
    assert answer.content[:1] == (b"{" if kind.endswith("json") else b"o")


def test_a_format_that_is_not_there_is_refused(client, db):
    assert client.get(f"{ADDRESS}?format=xml").status_code == 400


def test_it_comes_as_yaml_too(client, db):
    written = client.get(ADDRESS, headers={"accept": "application/yaml"})
    assert json.loads(client.get(ADDRESS).content) == yaml.load(written.content, yaml.CSafeLoader)
    assert written["ETag"] != client.get(ADDRESS)["ETag"]
    assert client.get(ADDRESS, headers={"accept": "image/png"}).status_code == 406
