"""/api/v1/schema/: made once for each process, the same for everybody."""

from __future__ import annotations

import json

import pytest
import yaml

from annotations.api import schema_view

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


def test_it_comes_as_json_too(client, db):
    written = client.get(ADDRESS, headers={"accept": "application/json"})
    assert written["Content-Type"] == "application/json"
    assert json.loads(written.content) == yaml.load(client.get(ADDRESS).content, yaml.CSafeLoader)
    assert written["ETag"] != client.get(ADDRESS)["ETag"]
    assert client.get(ADDRESS, headers={"accept": "image/png"}).status_code == 406
