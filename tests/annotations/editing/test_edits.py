"""Rows that people edit: every verb keeps history, and nobody's work is overwritten unseen."""

from __future__ import annotations

import pytest
from django.core.exceptions import ValidationError
from django.db import transaction

from annotations.editing.edits import Overtaken, add, change, delete, restore
from annotations.exchange.generator_import import import_generator
from annotations.exchange.world_deletion import delete_world
from annotations.models import Entity, Paraphrase, Predicate, Production, SemanticTemplate
from annotations.models.description import TemplateStatus
from tests.sample_world import make_paraphrase

KINDS = [SemanticTemplate, Entity, Predicate, Production, Paraphrase]
TEXT = {
    SemanticTemplate: "pattern",
    Entity: "text",
    Predicate: "name",
    Production: "expansion",
    Paraphrase: "utterance",
}


@pytest.fixture(params=KINDS, ids=lambda model: model.__name__)
def row(request, tiny_world):
    """A stored row of each kind."""
    make_paraphrase(
        tiny_world,
        prompt="find the tea",
        utterance="where is the tea",
    )
    return request.param.objects.first()


def text_of(row):
    row = getattr(row, "instance", row)  # of a history entry
    return getattr(row, TEXT[type(row)])


def kinds_of(row):
    return "".join(row.history.order_by("history_id").values_list("history_type", flat=True))


def test_a_change_is_a_version_with_its_author(row, annotator):
    before = text_of(row)
    after = change(row, {TEXT[type(row)]: "other"}, annotator, row.version)
    assert (text_of(after), after.version) == ("other", 2)
    first, second = row.history.order_by("history_id")
    assert (text_of(first), first.version, first.history_user) == (before, 1, None)
    assert (text_of(second), second.version, second.history_user) == ("other", 2, annotator)


def test_the_second_of_two_gets_both_versions(row, annotator, reviewer):
    name, before = TEXT[type(row)], text_of(row)
    change(row, {name: "theirs"}, annotator, 1)
    with pytest.raises(Overtaken) as clash:
        change(row, {name: "mine"}, reviewer, 1)
    assert (text_of(clash.value.current), text_of(clash.value.base)) == ("theirs", before)
    assert (clash.value.current.version, clash.value.last.history_user) == (2, annotator)
    assert str(annotator) in clash.value.sentence
    row.refresh_from_db()
    assert text_of(row) == "theirs"


def test_saving_the_same_twice_is_one_version(row, annotator):
    for _ in range(2):
        assert change(row, {TEXT[type(row)]: "same"}, annotator, 1).version == 2


def test_what_is_deleted_comes_back_with_its_key(row, annotator):
    key, before = row.pk, text_of(row)
    delete(row, annotator, 1)
    assert not type(row).objects.filter(pk=key).exists()
    with pytest.raises(Overtaken) as clash:
        change(row, {TEXT[type(row)]: "mine"}, annotator, 1)
    assert clash.value.current is None and clash.value.last.history_type == "-"
    again = restore(row.history.first(), annotator)
    again.refresh_from_db()
    assert (again.pk, text_of(again), again.version) == (key, before, 2)
    assert kinds_of(row) == "+-+"


def test_an_earlier_version_is_restored_as_the_next_one(row, annotator):
    before = text_of(row)
    change(row, {TEXT[type(row)]: "other"}, annotator, 1)
    again = restore(row.history.last(), annotator)
    assert (text_of(again), again.version) == (before, 3)


def test_a_stale_page_deletes_nothing(row, annotator):
    change(row, {TEXT[type(row)]: "other"}, annotator, 1)
    with pytest.raises(Overtaken):
        delete(row, annotator, 1)
    assert type(row).objects.filter(pk=row.pk).exists()


def test_a_change_that_fails_leaves_no_trace(row, annotator):
    with pytest.raises(RuntimeError), transaction.atomic():
        change(row, {TEXT[type(row)]: "other"}, annotator, 1)
        raise RuntimeError
    assert not row.history.exists()


def test_a_new_row_stands_last_and_is_made_once(tiny_world, annotator):
    category = tiny_world.grammar.task_categories.get()
    unsaved = [SemanticTemplate.for_category(category, pattern="go", form="(go)") for _ in "ab"]
    first, second = (add(each, annotator, once="key") for each in unsaved)
    assert (first.pk, first.position, first.author) == (second.pk, 2, annotator)
    assert kinds_of(first) == "+"


def test_a_row_whose_place_was_taken_comes_back_at_the_end(tiny_world, annotator):
    first, second = tiny_world.grammar.templates.all()
    delete(first, annotator, 1)
    SemanticTemplate.objects.filter(pk=second.pk).update(position=0)
    assert restore(first.history.first(), annotator).position == 1


def test_a_name_that_was_taken_meanwhile_is_said(tiny_world, annotator):
    row = tiny_world.predicates.first()
    delete(row, annotator, 1)
    add(Predicate(world=tiny_world, name=row.name, kind=row.kind), annotator)
    with pytest.raises(ValidationError):
        restore(row.history.first(), annotator)


def test_what_makes_commands_makes_the_world_stale(tiny_world, annotator):
    revisions = []

    def revision():
        tiny_world.refresh_from_db()
        revisions.append(tiny_world.revision)

    template = tiny_world.grammar.templates.first()
    revision()
    template = change(template, {"status": TemplateStatus.DRAFT}, annotator, 1)
    revision()
    change(template, {"pattern": "a draft"}, annotator, 2)
    change(tiny_world.predicates.first(), {"gloss": "do it"}, annotator, 1)
    revision()
    delete(tiny_world.grammar.productions.first(), annotator, 1)
    revision()
    # A draft counts for nothing; templates are checked against predicates.
    assert [each - revisions[0] for each in revisions] == [0, 1, 2, 3]


def test_an_import_keeps_what_it_changes_and_removes(tiny_world, tiny, annotator):
    entities = tiny_world.ontology.entities
    milk, tea = entities.get(text="milk"), entities.get(text="tea")
    tiny["objects.xml"] = (
        tiny["objects.xml"].replace(b'"alike"', b'"other"').replace(b"tea", b"ale")
    )
    import_generator(tiny_world.name, tiny, by=annotator)
    assert (kinds_of(milk), kinds_of(tea)) == ("+~", "+-")
    assert milk.history.first().history_user == annotator
    assert entities.get(text="milk").version == 2
    restore(tea.history.first(), annotator)
    assert entities.get(text="tea").pk == tea.pk


def test_an_import_leaves_alone_what_people_made_of_an_entity(tiny_world, tiny, annotator):
    milk = tiny_world.ontology.entities.get(text="milk")
    change(milk, {"aliases": ["moo juice"]}, annotator, 1)
    import_generator(tiny_world.name, tiny)
    milk.refresh_from_db()
    assert (milk.aliases, milk.version) == (["moo juice"], 2)


def test_importing_the_same_files_again_keeps_nothing(tiny_world, tiny):
    import_generator(tiny_world.name, tiny)
    assert not any(model.history.exists() for model in KINDS)


def test_history_goes_with_the_world(row, annotator):
    change(row, {TEXT[type(row)]: "other"}, annotator, 1)
    delete(row, annotator, 2)
    delete_world(row.owning_world)
    assert not any(model.history.exists() for model in KINDS)
