"""People at the same time, and forms that are sent twice: nothing is lost and nothing made double."""

from __future__ import annotations

import pytest
from django.test import Client

from annotations.editing.drafts import read_draft, save_draft
from annotations.editing.edits import Overtaken, change
from annotations.models import Draft, SemanticTemplate, Utterance, World
from annotations.rows.row_kinds import KINDS
from tests.at_once import at_once
from tests.conftest import member
from tests.sample_world import fill_world, guidelines_in, paraphrase_in

NEW = {"pattern": "$vbfind the {kobject}", "form": "(find {kobject})", "status": "ready"}


@pytest.fixture
def sample(transactional_db, world):
    return fill_world(world)


def logged_in(user):
    client = Client()
    client.force_login(user)
    return client


def test_templates_added_at_once_are_all_saved(sample, world):
    category = world.grammar.task_categories.get()
    clients = [logged_in(member(world, f"anna{number}", "annotator")) for number in range(6)]
    before = SemanticTemplate.objects.count()

    def add(client, number):
        sent = {**NEW, "pattern": f"find {number} {{kobject}}", "task_category": category.pk}
        return client.post("/w/home/templates/new/", sent).status_code

    actions = [
        lambda client=client, number=number: add(client, number)
        for number, client in enumerate(clients)
    ]
    assert at_once(*actions) == [302] * 6
    assert SemanticTemplate.objects.count() == before + 6


def test_a_form_that_is_sent_twice_makes_one_template(sample, world, annotator):
    client = logged_in(annotator)
    form = client.get("/w/home/templates/new/").context["form"]
    category = world.grammar.task_categories.get()
    sent = {**NEW, "task_category": category.pk, "once": form["once"].value()}
    before = SemanticTemplate.objects.count()
    first, second = at_once(
        *(lambda: logged_in(annotator).post("/w/home/templates/new/", sent) for _ in range(2))
    )
    assert first.url == second.url
    assert SemanticTemplate.objects.count() == before + 1


def test_two_forms_make_two_templates(sample, world, annotator):
    client = logged_in(annotator)
    category = world.grammar.task_categories.get()
    keys = {client.get("/w/home/templates/new/").context["form"]["once"].value() for _ in range(2)}
    urls = {
        client.post(
            "/w/home/templates/new/", {**NEW, "task_category": category.pk, "once": key}
        ).url
        for key in keys
    }
    assert len(keys) == len(urls) == 2


def test_the_key_of_somebody_else_shows_nothing_of_theirs(sample, world, annotator):
    category = world.grammar.task_categories.get()
    other = member(world, "berta", "annotator")
    sent = {**NEW, "task_category": category.pk, "once": "same"}
    first = logged_in(annotator).post("/w/home/templates/new/", sent).url
    assert logged_in(other).post("/w/home/templates/new/", sent).url != first


def test_worlds_of_one_name_at_once_make_one(transactional_db, superuser):
    def create():
        return logged_in(superuser).post("/worlds/new/", {"name": "lab"}).status_code

    statuses = at_once(*[create] * 5)
    assert sorted(statuses) == [200, 200, 200, 200, 302]
    assert World.objects.filter(name="lab").count() == 1


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda kind: kind.name)
def test_of_those_who_change_one_row_at_once_one_is_first(kind, sample, world):
    paraphrase_in(world)
    guidelines_in(world)
    Utterance.objects.create(world=world, text="go", anonymized_text="go")
    row = kind.rows_of(world).first()
    field = next(
        name
        for name in ("pattern", "text", "name", "said", "expansion", "utterance")
        if hasattr(row, name)
    )
    people = [member(world, f"anna{number}", "annotator") for number in range(4)]

    def save(person):
        try:
            return change(row, {field: f"by {person}"}, person, 1).version
        except Overtaken as clash:
            return clash.current.version, getattr(clash.base, field)

    before = getattr(row, field)
    saved = at_once(*(lambda person=person: save(person) for person in people))
    assert sorted(saved, key=str) == [(2, before)] * 3 + [2]
    first, second = row.history.order_by("history_id")
    row.refresh_from_db()
    assert (first.version, second.version, row.version) == (1, 2, 2)
    assert getattr(row, field) == getattr(second, field) == f"by {second.history_user}"


def test_drafts_kept_at_once_are_one(sample, world):
    person = member(world, "anna", "annotator")

    def keep(number):
        fields = {"pattern": str(number)}
        return save_draft(
            person, world, "template", "new", read_draft({"fields": fields, "device": "a"})
        )

    assert all(at_once(*(lambda number=number: keep(number) for number in range(4))))
    assert Draft.objects.count() == 1
