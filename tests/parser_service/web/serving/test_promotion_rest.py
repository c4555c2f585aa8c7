"""/api/v1/worlds/<w>/promotions/"""

from __future__ import annotations

import pytest

from parser_service.models import Promotion
from parser_service.runs.promoting import promote, promoted_run
from tests.parser_service.served import make_home, trained_run

ALL = "worlds/home/promotions/"


@pytest.fixture
def runs(world):
    split = make_home(world)
    first = trained_run(split)
    promote(first, None, "The first.")
    return first, trained_run(split, seed=1)


@pytest.fixture
def call(call_as, admin):
    return lambda method, path="", data=None: call_as(admin, method, ALL + path, data)


def test_a_run_is_promoted_and_rolled_back(call, runs, world):
    first, second = runs
    made = call("post", data={"run": second.pk, "reason": "better"})
    assert (made.status_code, made.json()["run"], made.json()["decided_by"]) == (
        201,
        second.pk,
        "adam",
    )
    assert promoted_run(world) == second
    assert call("post", "roll-back/", {}).json()["run"] == first.pk
    listed = call("get").json()["results"]
    assert [each["run"] for each in listed] == [first.pk, second.pk, first.pk]
    assert listed[-1]["decided_by"] is None


def test_what_cannot_be_decided_is_a_conflict(call, runs, world):
    first, second = runs
    assert call("post", data={"run": first.pk}).status_code == 409
    assert call("post", data={"run": 10**9}).status_code == 404
    assert call("post", "roll-back/", {}).status_code == 409
    row = Promotion.objects.create(world=world, run=second, state="proposed")
    assert call("post", f"{row.pk}/decline/").json()["state"] == "declined"
    assert call("post", f"{row.pk}/decline/").status_code == 409
