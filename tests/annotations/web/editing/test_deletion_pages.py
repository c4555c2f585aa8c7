"""Before a row is deleted its page says what changes, and deleting it does that."""

from __future__ import annotations

import pytest

from annotations.editing.edits import delete
from annotations.generation.deletion_check import check_deletion
from annotations.generation.freezing import freeze_split
from annotations.models import Entity, Predicate, Production, SemanticTemplate
from tests.annotations.generation.test_up_to_date import commands_of


def address(kind, row):
    return f"/w/home/history/{kind}/{row.pk}/delete/"


@pytest.mark.parametrize("model", [SemanticTemplate, Production])
def test_deleting_does_what_was_said(sample, world, annotator, model):
    rows = model.objects.filter(**{model.world_path: world})
    for row in rows:
        before, expected = commands_of(world), check_deletion(row).expected
        delete(row, annotator, row.version)
        after = commands_of(world)
        assert not expected.trouble
        assert {each.command for each in expected.changes.lost} == before.keys() - after.keys()
        assert not after.keys() - before.keys()


def test_the_page_of_a_template_names_commands_and_splits(sample, world, anna):
    row = SemanticTemplate.objects.get(form="(go {room})")
    split = freeze_split(world, "before")
    before = commands_of(world)
    page = anna.get(address("template", row))
    assert [group.kind for group in page.context["groups"]] == ["lost", "splits"]
    assert split.name in page.content.decode()
    assert commands_of(world) == before
    assert anna.post(address("template", row), {"version": row.version}).status_code == 302
    assert len(commands_of(world)) < len(before)
    assert anna.get(address("template", row)).url == f"/w/home/history/template/{row.pk}/"


def test_the_page_of_a_production_names_what_the_grammar_lacks_then(sample, anna):
    row = Production.objects.get(nonterminal="vbfind")
    page = anna.get(address("production", row))
    (problem,) = page.context["deletion"].problems
    assert "$vbfind" in problem.message and problem.message in page.content.decode()


def test_the_page_of_a_predicate_names_the_templates_that_use_it(sample, anna):
    page = anna.get(address("predicate", Predicate.objects.get(name="go")))
    assert page.context["groups"] == []
    ((row, told),) = page.context["deletion"].templates
    assert row.form == "(go {room})" and "go" in told[0].split()
    assert row.pattern in page.content.decode() and told[0] in page.content.decode()


def test_the_page_of_an_entity_names_what_refers_to_it(sample, anna):
    row = Entity.objects.get(text="kitchen")
    page = anna.get(address("entity", row))
    assert page.context["groups"] == []
    (problem,) = page.context["deletion"].problems
    assert "kitchen" in problem.message and "drinks" in problem.message
    assert problem.message in page.content.decode()
