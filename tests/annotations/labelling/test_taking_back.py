"""What lines have made of a world is taken back with their upload, all of it or nothing, and comes back."""

from __future__ import annotations

import pytest

from annotations.editing.edits import add, change
from annotations.labelling.storing_examples import store_examples
from annotations.labelling.taking_back import StillUsed, brought_by
from annotations.labelling.utterance_uploads import redo, undo
from annotations.models import (
    Command,
    Entity,
    EntityClass,
    Predicate,
    Production,
    Recipe,
    SemanticTemplate,
    TaskCategory,
    Upload,
)

MODELS = (EntityClass, Entity, Predicate, Production, SemanticTemplate, TaskCategory)
FIRST = "water the [roses](plant) in [bed two](bed)\nirrigate the [roses] in [bed two] = water"
THEN = (
    "sprinkle the [tulips](plant) in [bed two] = water\nwater the [roses]\ncall [nurse Kim](staff)"
)


def stored_world():
    return {model: sorted(str(row) for row in model.objects.all()) for model in (*MODELS, Command)}


def stored(world, lines, by) -> Upload:
    return Upload.objects.get(pk=store_examples(world, lines, by).upload)


def test_all_that_lines_have_made_is_taken_back_and_comes_back(world, admin):
    empty = stored_world()
    first = stored(world, FIRST, admin)
    before = stored_world()
    then = stored(world, THEN, admin)
    after = stored_world()
    assert brought_by(then).counts == (
        "1 class, 2 entities, 1 predicate, 2 productions, 2 templates, 2 changed lines"
    )
    for _ in range(2):
        undo(then, admin, with_labelled=True, with_world=True)
        assert stored_world() == before
        assert not world.utterances.filter(upload=then).exists()
        redo(then, admin)
        assert stored_world() == after
    undo(then, admin, with_labelled=True, with_world=True)
    undo(first, admin, with_labelled=True, with_world=True)
    assert stored_world() == empty


def test_what_something_else_needs_is_not_taken_back(world, admin):
    first = stored(world, FIRST, admin)
    stored(world, "in [bed two], water the [roses]", admin)
    before = stored_world()
    with pytest.raises(StillUsed) as refused:
        undo(first, admin, with_labelled=True, with_world=True)
    assert "$water" in refused.value.message and "plant" in refused.value.message
    assert stored_world() == before
    first.refresh_from_db()
    assert first.undone_at is None and world.utterances.filter(upload=first).exists()


def test_what_was_changed_since_is_not_taken_back(world, admin):
    first = stored(world, FIRST, admin)
    predicate = Predicate.objects.get()
    change(predicate, {"gloss": "wet {1}"}, admin, predicate.version)
    with pytest.raises(StillUsed):
        undo(first, admin, with_labelled=True, with_world=True)
    assert SemanticTemplate.objects.exists()


def test_a_recipe_keeps_the_action_that_it_is_for(world, admin):
    first = stored(world, "stop", admin)
    columns = Recipe.columns_of("stop() -> halt()")
    add(Recipe(world=world, position=0, **columns), admin)
    with pytest.raises(StillUsed):
        undo(first, admin, with_labelled=True, with_world=True)


def test_what_was_kept_stays_as_people_have_made_it(world, admin):
    first = stored(world, FIRST, admin)
    undo(first, admin, with_labelled=True)
    assert SemanticTemplate.objects.exists()
    predicate = Predicate.objects.get()
    change(predicate, {"gloss": "wet {1}"}, admin, predicate.version)
    redo(first, admin)
    assert Predicate.objects.get().gloss == "wet {1}"


def test_lines_whose_texts_are_known_can_be_undone(world, admin):
    store_examples(world, "water the [roses](plant)", admin)
    world.utterances.get()
    again = stored(world, "water the [roses](plant)\n[roses] = hold", admin)
    undo(again, admin, with_labelled=True, with_world=True)
    assert not Predicate.objects.filter(name="hold").exists()


def test_the_page_asks_what_becomes_of_what_came_with_it(adam, call_as, admin, world):
    first = stored(world, FIRST, admin)
    address = f"/w/home/utterances/uploads/{first.pk}/undo/"
    asked = adam.post(address)
    assert asked.status_code == 200 and 'name="world" value="delete"' in asked.content.decode()
    stored(world, "water the [roses]", admin)
    blocked = adam.get(address).content.decode()
    assert 'type="hidden" name="world" value="keep"' in blocked
    route = f"worlds/home/uploads/{first.pk}/undo/"
    refused = call_as(admin, "post", route, {"world": "delete"})
    assert (refused.status_code, refused.json()["code"]) == (409, "in_use")
    then = Upload.objects.latest("pk")
    done = call_as(admin, "post", f"worlds/home/uploads/{then.pk}/undo/", {"world": "delete"})
    assert done.status_code == 200
    assert adam.post(address, {"world": "delete"}).status_code == 302
    assert not Predicate.objects.exists() and not world.utterances.exists()
