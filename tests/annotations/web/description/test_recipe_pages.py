"""The page of recipes: rows with an example beside them, and whole books."""

from __future__ import annotations

import pytest

from annotations.language.plans import DEFAULT_BOOK, default_book, shipped_books
from annotations.models import Predicate, Recipe
from annotations.rows.from_rows import recipe_book_of
from tests.greenhouse import fill_greenhouse
from tests.notices import levels
from tests.sample_world import fill_world

PAGE = "/w/home/recipes/"
OTHER = next(name for name in shipped_books() if name != DEFAULT_BOOK)


@pytest.fixture
def browse(client, annotator, world):
    client.force_login(annotator)
    return client


@pytest.fixture
def go(world) -> Recipe:
    return world.recipes.get(left="go(destination)")


def test_a_new_world_starts_with_the_book_that_ships(browse, world):
    assert recipe_book_of(world) == default_book()
    page = browse.get(PAGE)
    assert page.context["shipped"].name == DEFAULT_BOOK
    assert len(page.context["recipes"]) == len(default_book().recipes)
    assert not any(problems for _, _, problems in page.context["recipes"])


def test_a_world_without_recipes_uses_the_book_that_ships(browse, world):
    world.recipes.all().delete()
    world.primitives.all().delete()
    ours = default_book().of_actions(())
    assert recipe_book_of(world) == ours and ours.recipes
    Predicate.objects.create(world=world, name="go", kind="action", signatures=[["room"]])
    used = recipe_book_of(world)
    assert {each.pattern.action for each in used.recipes if each not in ours.recipes} == {"go"}
    page = browse.get(PAGE)
    assert page.context["shipped"].name == DEFAULT_BOOK and not page.context["has_own"]
    shown = [value for row, value, _ in page.context["recipes"] if row is None]
    assert shown == list(used.recipes) and f"{PAGE}new/" not in page.content.decode()
    page = browse.post(
        f"{PAGE}book/",
        {"shipped": DEFAULT_BOOK, "version": page.context["version"]},
        follow=True,
    )
    assert world.recipes.count() == len(default_book().recipes)
    undo = {"primitives": "", "recipes": "", "version": page.context["version"]}
    browse.post(f"{PAGE}book/", undo)
    assert not world.recipes.exists() and not world.primitives.exists()


def test_primitives_without_recipes_are_no_book(browse, world):
    sent = {"primitives": "fly(place): moves to place", "recipes": ""}
    page = browse.post(f"{PAGE}book/", sent, follow=True)
    assert levels(page) == ["error"] and recipe_book_of(world) == default_book()


def test_another_book_is_taken_and_undone(browse, world, go):
    version = browse.get(PAGE).context["version"]
    page = browse.post(f"{PAGE}book/", {"shipped": OTHER, "version": version}, follow=True)
    assert recipe_book_of(world) == shipped_books()[OTHER].book
    assert page.context["shipped"].name == OTHER
    before = default_book()
    undo = {
        "primitives": "\n".join(map(str, before.primitives)),
        "recipes": "\n".join(map(str, before.recipes)),
        "version": page.context["version"],
    }
    browse.post(f"{PAGE}book/", undo)
    assert recipe_book_of(world) == before
    go.refresh_from_db()  # the row is the same one
    assert go.version == 3


def test_a_book_that_has_changed_meanwhile_is_not_replaced(browse, world):
    page = browse.post(f"{PAGE}book/", {"shipped": OTHER, "version": "old"}, follow=True)
    assert levels(page) == ["error"] and recipe_book_of(world) == default_book()


def test_a_recipe_is_saved_in_its_one_spelling(browse, go):
    text = 'go( destination )->go_to(destination)\r\n say( "here" )'
    browse.post(f"{PAGE}{go.pk}/", {"text": text, "version": go.version})
    go.refresh_from_db()
    assert go.text == 'go(destination) -> go_to(destination) say("here")'
    assert go.version == 2 and go.history.count() == 2


@pytest.mark.parametrize(
    ("text", "column"),
    [
        ("go(destination) -> fly_to(destination)", 20),
        ("go(destination) -> go_to(place)", 26),
        ("go(destination) go_to(destination)", 17),
        ("find(target) -> find_object(target)", 1),
    ],
)
def test_what_is_wrong_is_said_with_its_place(browse, go, text, column):
    page = browse.post(f"{PAGE}{go.pk}/", {"text": text, "version": go.version})
    problem = page.context["form"].checked.error
    assert problem.position.column == column and problem.hint
    assert page.context["form"].errors["text"]
    preview = browse.post(f"{PAGE}preview/?row={go.pk}", {"text": text})
    assert preview.context["checked"].error == problem
    go.refresh_from_db()
    assert go.version == 1


def test_a_command_of_the_world_is_the_example(browse, world, go):
    fill_world(world)
    page = browse.get(f"{PAGE}{go.pk}/")
    checked = page.context["checked"]
    assert checked.chosen in checked.commands
    assert checked.example.task_plan.steps[0].action == "go_to"
    typed = {"text": 'go(destination) -> say("no")', "example": checked.commands[-1]}
    answer = browse.post(f"{PAGE}preview/?row={go.pk}", typed)
    again = answer.context["checked"]
    assert again.chosen == checked.commands[-1]
    assert "say" in [step.action for step in again.example.task_plan.steps]


def test_a_primitive_that_recipes_use_stays_and_is_renamed_with_them(browse, world):
    row = world.primitives.get(name="go_to")
    address = f"{PAGE}primitives/{row.pk}/"
    users = world.recipes.filter(text__contains="go_to(").count()
    page = browse.post(f"/w/home/history/primitive/{row.pk}/delete/", {"version": 1}, follow=True)
    assert levels(page) == ["error"] and world.primitives.filter(pk=row.pk).exists()
    named = {"text": row.text.replace("go_to", "drive"), "version": 1}
    assert browse.post(address, named).context["form"].errors["text"]
    longer = {"text": 'go_to(place, speed) "go to {place}": moves to place', "version": 1}
    assert browse.post(address, longer).context["form"].checked.error
    browse.post(
        f"/w/home/rename/primitive/{row.pk}/", {"old": "go_to", "new": "drive", "version": 1}
    )
    row.refresh_from_db()
    assert row.name == "drive" and row.text.startswith("drive(")
    assert world.recipes.filter(text__contains="drive(").count() == users
    assert not world.recipes.filter(text__contains="go_to(").exists()
    assert not recipe_book_of(world).problems()


def test_a_deleted_recipe_comes_back(browse, world, go):
    browse.post(f"/w/home/history/recipe/{go.pk}/delete/", {"version": 1})
    assert not world.recipes.filter(pk=go.pk).exists()
    entry = Recipe.history.filter(id=go.pk).first()
    browse.post(f"/w/home/history/recipe/{go.pk}/", {"entry": entry.history_id})
    assert recipe_book_of(world) == default_book()


def test_recipes_are_proposed_for_a_greenhouse_and_taken_with_a_click(browse, world):
    fill_greenhouse(world)
    before = recipe_book_of(world)
    page = browse.get(PAGE)
    actions = [value.pattern.action for value, _ in page.context["proposed"]]
    assert sorted(actions) == ["fetch", "prune", "scan_shelf", "water", "water"]
    assert all(primitives for _, primitives in page.context["proposed"])
    page = browse.post(f"{PAGE}proposed/", {"action": "water"}, follow=True)
    assert levels(page) == ["success"] and len(page.context["proposed"]) == 3
    assert not any(problems for _, _, problems in page.context["recipes"])
    assert world.primitives.get(name="water").history.count() == 1
    page = browse.post(f"{PAGE}proposed/", follow=True)
    assert not page.context["proposed"] and world.recipes.count() == len(before.recipes) + 5
    again = browse.post(f"{PAGE}proposed/", follow=True)
    assert levels(again) == ["error"] and again.context["version"] == page.context["version"]
    undo = {
        "primitives": "\n".join(map(str, before.primitives)),
        "recipes": "\n".join(map(str, before.recipes)),
        "version": page.context["version"],
    }
    browse.post(f"{PAGE}book/", undo)
    assert recipe_book_of(world) == before


def test_a_world_without_rows_gets_those_that_it_uses_with_what_is_proposed(browse, world):
    fill_greenhouse(world)
    world.recipes.all().delete()
    world.primitives.all().delete()
    used = recipe_book_of(world)
    browse.post(f"{PAGE}proposed/", {"action": "fetch"})
    assert world.recipes.count() == len(used.recipes) + 1
