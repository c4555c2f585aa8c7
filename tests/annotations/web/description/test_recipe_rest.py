"""Recipes over the API: rows, checks, and whole books."""

from __future__ import annotations

import jsonschema
import pytest

from annotations.language.plans import DEFAULT_BOOK, default_book, shipped_books, task_plan_schema
from annotations.rows.from_rows import recipe_book_of
from tests.greenhouse import fill_greenhouse
from tests.sample_world import fill_world

API = "/api/v1/worlds/home/"
JSON = "application/json"


@pytest.fixture
def browse(client, annotator, world):
    client.force_login(annotator)
    return client


def test_rows_are_listed_added_changed_and_deleted(browse, world):
    listed = browse.get(f"{API}recipes/?limit=1000&sort=position").json()["results"]
    assert [each["text"] for each in listed] == list(map(str, default_book().recipes))
    made = browse.post(f"{API}recipes/", {"text": "dance()->greet(operator)"}, JSON)
    assert made.status_code == 201 and made.json()["action"] == "dance"
    assert made.json()["text"] == "dance() -> greet(operator)"
    address, tag = f"{API}recipes/{made.json()['id']}/", made["ETag"]
    changed = {"text": "dance() -> wait()"}
    saved = browse.patch(address, changed, JSON, headers={"If-Match": tag})
    assert saved.status_code == 200 and saved.json()["version"] == 2
    assert browse.patch(address, changed, JSON, headers={"If-Match": tag}).status_code == 412
    assert browse.delete(address, headers={"If-Match": saved["ETag"]}).status_code == 204
    assert recipe_book_of(world) == default_book()


def test_what_is_wrong_has_its_place(browse):
    answer = browse.post(f"{API}recipes/", {"text": "dance() -> spin()"}, JSON)
    (problem,) = answer.json()["problems"]
    assert answer.status_code == 400
    assert (problem["field"], problem["column"]) == ("text", 12)


def test_a_primitive_in_use_is_not_deleted(browse, world):
    row = world.primitives.get(name="go_to")
    answer = browse.delete(f"{API}primitives/{row.pk}/", headers={"If-Match": '"1"'})
    assert answer.status_code == 409


def test_a_row_is_tried_on_a_command(browse, world):
    fill_world(world)
    row = world.recipes.get(left="go(destination)")
    sent = {"text": row.text, "replaces": row.pk}
    answer = browse.post(f"{API}check/recipe/", sent, JSON).json()
    assert not [each for each in answer["problems"] if each["severity"] == "error"]
    assert answer["commands"] and answer["example"]["spoken"]
    jsonschema.validate(answer["example"]["task_plan"], task_plan_schema())


def test_a_whole_book_is_replaced(browse, world):
    shown = browse.get(f"{API}recipe-book/")
    assert shown.json()["shipped"] == DEFAULT_BOOK
    books = browse.get(f"{API}recipe-book/shipped/").json()
    other = next(each for each in books if each["name"] != DEFAULT_BOOK)
    headers = {"If-Match": shown["ETag"]}
    answer = browse.patch(f"{API}recipe-book/", {"shipped": other["name"]}, JSON, headers=headers)
    assert answer.json()["recipes"] == other["recipes"]
    assert recipe_book_of(world) == shipped_books()[other["name"]].book
    late = browse.patch(f"{API}recipe-book/", {"shipped": DEFAULT_BOOK}, JSON, headers=headers)
    assert late.status_code == 412
    rows = {"primitives": ["go_to(place)"], "recipes": ["go(destination) -> fly(destination)"]}
    headers = {"If-Match": answer["ETag"]}
    wrong = browse.patch(f"{API}recipe-book/", rows, JSON, headers=headers)
    assert wrong.status_code == 400
    rows["recipes"] = ["go(destination) -> go_to(destination)"]
    assert browse.patch(f"{API}recipe-book/", rows, JSON, headers=headers).status_code == 200
    assert world.recipes.count() == 1


def test_a_name_and_rows_are_refused_together(browse):
    tag = browse.get(f"{API}recipe-book/")["ETag"]
    sent = {"shipped": DEFAULT_BOOK, "recipes": ["go(destination) -> go_to(destination)"]}
    answer = browse.patch(f"{API}recipe-book/", sent, JSON, headers={"If-Match": tag})
    assert answer.status_code == 400


def test_a_form_becomes_a_task_plan(browse):
    sent = {"form": '( go " kitchen " )'}
    answer = browse.post(f"{API}task-plan/", sent, JSON).json()
    jsonschema.validate(answer["task_plan"], task_plan_schema())
    assert [step["primitive"] for step in answer["task_plan"]["steps"]] == ["go_to"]
    assert "kitchen" in answer["spoken"]
    tree = browse.post(f"{API}task-plan/", {**sent, "as": "xml"}, JSON)
    assert b'ID="go_to"' in tree.content


def test_what_is_proposed_is_taken_action_by_action_or_all_at_once(browse, world):
    fill_greenhouse(world)
    address = f"{API}recipe-book/proposed/"
    assert len(browse.get(address).json()["recipes"]) == 5
    added = browse.post(address, {"actions": ["fetch"]}, JSON).json()
    assert added == {
        "primitives": ['fetch(tool) "fetch {tool}"'],
        "recipes": ["fetch(tool) -> fetch(tool)"],
    }
    assert len(browse.post(address, {}, JSON).json()["recipes"]) == 4
    assert browse.get(address).json() == {"primitives": [], "recipes": []}
    assert browse.post(address, {}, JSON).json() == {"primitives": [], "recipes": []}
    assert world.recipes.get(left="fetch(tool)").history.count() == 1
    sent = {"form": '( water " basil " " last bed " )'}
    answer = browse.post(f"{API}task-plan/", sent, JSON).json()
    assert answer["task_plan"]["is_executable"]
