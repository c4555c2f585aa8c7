"""Entities are edited in place, singly and many at a time."""

from __future__ import annotations

import pytest
from django.urls import reverse

from annotations.editing.edits import change
from annotations.models import Entity
from annotations.rows.history import history_of
from tests.notices import levels


@pytest.fixture
def tea(sample) -> Entity:
    return Entity.objects.get(text="tea")


def opened(row, **values):
    attributes = "\n".join(f"{name}: {value}" for name, value in row.attributes.items())
    kept = {"entity_class": row.entity_class, "aliases": "", "attributes": attributes}
    return {**kept, "version": row.version, **values}


def test_an_entity_gets_aliases_and_attributes(tea, anna):
    sent = opened(tea, aliases="cuppa\n\n cuppa \nbrew", attributes="category: drinks\ncolor: red")
    assert anna.post(f"/w/home/ontology/{tea.pk}/", sent).status_code == 302
    row = Entity.objects.get(pk=tea.pk)
    assert (row.aliases, row.version) == (["cuppa", "brew"], 2)
    assert row.attributes == {"category": "drinks", "color": "red"}
    assert row.text == "tea"


def test_the_checker_speaks_of_what_was_saved_and_the_page_of_problems_follows(tea, anna, world):
    sent = opened(tea, attributes="category: drinks\ndifficulty: hard")
    answer = anna.post(f"/w/home/ontology/{tea.pk}/", sent, follow=True)
    assert levels(answer) == ["warning"]
    assert "difficulty" in str(*answer.context["messages"])
    assert world.problems.filter(subject="ontology", message__contains="difficulty").count() == 1
    tea.refresh_from_db()
    anna.post(f"/w/home/ontology/{tea.pk}/", opened(tea, attributes="category: drinks"))
    assert not world.problems.filter(subject="ontology", message__contains="difficulty").exists()


@pytest.mark.parametrize(
    "values", [{"aliases": "a <cup>"}, {"attributes": "red"}, {"entity_class": "planet"}]
)
def test_what_cannot_be_is_refused_and_kept_in_the_form(tea, anna, values):
    answer = anna.post(f"/w/home/ontology/{tea.pk}/", opened(tea, **values))
    form = answer.context["form"]
    assert list(form.errors) == list(values)
    assert {name: form[name].value() for name in values} == values
    assert Entity.objects.get(pk=tea.pk).version == 1


def test_two_people_on_one_entity_get_a_merge(tea, anna, admin):
    mine = opened(tea, aliases="brew")
    change(tea, {"attributes": {"category": "drinks", "color": "red"}}, admin, 1)
    answer = anna.post(f"/w/home/ontology/{tea.pk}/", mine)
    assert answer.status_code == 409
    merged = {field.name: field.value() or "" for field in answer.context["form"]}
    assert merged["attributes"] == "category: drinks\ncolor: red"
    assert anna.post(f"/w/home/ontology/{tea.pk}/", merged).status_code == 302
    row = Entity.objects.get(pk=tea.pk)
    assert (row.aliases, row.attributes["color"], row.version) == (["brew"], "red", 3)


def test_a_new_entity_is_made_once_and_deleted_again(sample, anna):
    sent = {"entity_class": "object", "text": " red  mug ", "once": "k"}
    for _ in range(2):
        assert anna.post("/w/home/ontology/new/", sent).status_code == 302
    row = Entity.objects.get(text="red mug")
    assert [entry.version for entry in history_of(Entity).filter(id=row.pk)] == [1]
    again = anna.post("/w/home/ontology/new/", {**sent, "once": "l", "text": "Red Mug"})
    assert "there already" in again.content.decode()
    delete = reverse("delete_row", kwargs={"world": "home", "kind": "entity", "pk": row.pk})
    anna.post(delete, {"version": 1})
    assert not Entity.objects.filter(pk=row.pk).exists()


def test_a_world_without_an_ontology_gets_one(world, anna):
    assert anna.post("/w/home/ontology/new/", {"entity_class": "room", "text": "den"}).url


def test_many_are_shown_first_and_added_together(sample, anna):
    sent = {"entity_class": "object", "lines": "mug | cup, beaker\ntea\nlamp", "once": "k"}
    page = anna.post("/w/home/ontology/paste/", sent)
    assert "2 new, 1 there already" in page.content.decode()
    assert not Entity.objects.filter(text="mug").exists()
    for _ in range(2):
        answer = anna.post("/w/home/ontology/paste/", {**sent, "add": "yes"}, follow=True)
    assert Entity.objects.filter(text__in=["mug", "lamp"]).count() == 2
    assert Entity.objects.get(text="mug").aliases == ["cup", "beaker"]
    assert answer.status_code == 200


def test_nothing_is_added_where_one_line_is_wrong(sample, anna):
    sent = {"entity_class": "object", "lines": "mug\na <b>", "add": "yes"}
    page = anna.post("/w/home/ontology/paste/", sent).content.decode()
    assert "Line 2" in page
    assert not Entity.objects.filter(text="mug").exists()
