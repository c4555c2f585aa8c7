"""Lists: filtered, sorted, and paged by keyset."""

from __future__ import annotations

import pytest

ENTITIES = "/api/v1/worlds/home/entities/"


@pytest.fixture
def read(caller, annotator, tiny_world):
    return lambda path: caller(path, annotator)


def test_pages_follow_one_another_in_both_directions(read):
    rows, address = [], f"{ENTITIES}?sort=class&limit=2"
    while address:
        page = read(address).json()
        assert len(page["results"]) <= 2
        rows += page["results"]
        last, address = page, page["next"]
    everything = read(f"{ENTITIES}?sort=class").json()
    assert rows == everything["results"]
    assert everything["next"] is everything["previous"] is None
    assert read(last["previous"]).json()["next"]
    backwards = read(f"{ENTITIES}?sort=-class").json()["results"]
    assert [row["id"] for row in backwards] == [row["id"] for row in rows][::-1]


@pytest.mark.parametrize(
    "query",
    [
        *("sort=colour", "limit=0", "limit=1001", "limit=x", "entity_class=planet"),
        *("after=%FF", "after=W10=", "after=bm9uZQ==", "before=é"),
    ],
)
def test_what_the_address_gets_wrong_is_a_problem(read, query):
    answer = read(f"{ENTITIES}?{query}")
    assert answer.status_code == 400
    assert answer.json()["problems"][0]["field"] == query.partition("=")[0]


@pytest.mark.parametrize("key", ["9.223372036854776e18", str(2**63), "1.5", "0", "x"])
def test_keys_that_no_row_can_have_are_refused(read, anna, key):
    for noun, name in (("commands", "template"), ("evaluations", "run"), ("reviews", "example")):
        assert read(f"/api/v1/worlds/home/{noun}/?{name}={key}").status_code == 400
    assert anna.get(f"/w/home/commands/?template={key}").status_code == 200


def test_filters_are_those_of_the_pages(read, anna):
    for query in ("entity_class=room", "q=milk"):
        listed = anna.get(f"/w/home/ontology/?{query}").context["listing"].rows
        shown = read(f"{ENTITIES}?{query}").json()["results"]
        assert [row["id"] for row in shown] == [row.pk for row in listed]


def test_the_worlds_of_the_caller(read, other_world):
    (world,) = read("/api/v1/worlds/").json()["results"]
    assert (world["name"], world["duties"]) == ("home", ["annotate", "view"])
    assert read("/api/v1/worlds/home/").json() == world
