"""What is not there is named in our words, with the place to look for what is."""

from __future__ import annotations

import re

import pytest
from django.urls import resolve

from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import ALL_ROUTES
from tests.gpsr_site.routes.rules import undone
from tests.sample_world import SampleWorld

ROUTES = sorted(
    name for name, path in ALL_ROUTES.items() if "<int:" in path and name != "admin:index"
)


def test_a_row_that_is_not_there(sample: SampleWorld, client_as, subtests):
    for name in ROUTES:
        path = re.sub(r"/\d+/", "/999999/", address(name, sample))
        with subtests.test(name), undone():
            ask_for_what_is_not_there(name, path, sample, client_as("superuser"))


def ask_for_what_is_not_there(name: str, path: str, sample: SampleWorld, root) -> None:
    for method in ("get", "post", "patch", "delete"):
        answer = root.generic(method, path, b"{}", "application/json", headers={"if-match": "*"})
        if answer.status_code != 404:
            continue
        if name.startswith("api:"):
            said = answer.json()["detail"]
            where = re.search(r"\. (/api/v1/\S*) ", said)
            assert where is not None, said
            shown = where[1]
        else:
            said = answer.content.decode()
            shown = answer.context["where"] or f"/w/{sample.world}/"
        assert "matches the given query" not in said
        resolve(shown)
        if method == "get":
            assert root.get(shown).status_code == 200, (path, shown)


def test_a_split_is_named_by_its_number(sample: SampleWorld, client_as):
    path = "/api/v1/worlds/home/splits/"
    said = client_as("admin").get(f"{path}999999/export/").json()["detail"]
    assert "split 999999 " in said and f" {path} " in said


@pytest.mark.parametrize("path", ["/api/v1/worlds/nowhere/splits/", "/api/v1/worlds/nowhere/"])
def test_a_world_that_is_not_there(path, sample: SampleWorld, client_as):
    said = client_as("stranger").get(path).json()["detail"]
    assert " /api/v1/worlds/ " in said


def test_an_address_that_is_none(sample: SampleWorld, client_as):
    assert "/api/v1/schema/" in client_as("admin").get("/api/v1/nothing/").json()["detail"]
    answer = client_as("admin").get("/w/home/nothing/")
    assert (answer.status_code, answer.context["where"]) == (404, "/w/home/")
