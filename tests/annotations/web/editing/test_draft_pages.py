"""What is typed is kept on the server for its author alone, until it is saved."""

from __future__ import annotations

import json
from datetime import timedelta

import pytest
from django.utils import timezone

from annotations.editing.drafts import KEPT, MOST_BYTES, MOST_DRAFTS
from annotations.models import Draft, SemanticTemplate, World
from tests.annotations.web.editing.test_merge_pages import opened

NEW = "/w/home/drafts/template/new/"


def send(client, user, path=NEW, **sent):
    typed = {"fields": {"pattern": "go"}, "version": 1, "device": "a", **sent}
    return client.post(path, json.dumps({"of": user.pk, **typed}), "application/json")


def read(client, path=NEW):
    return client.get(path).json()["draft"]


def test_a_draft_is_kept_and_read_again(sample, anna, annotator):
    assert read(anna) is None
    place = {"about": "New template", "page": "templates/new/"}
    saved_at = send(anna, annotator, **place).json()["saved_at"]
    expected = {"fields": {"pattern": "go"}, "version": 1, "device": "a", "saved_at": saved_at}
    assert read(anna) == expected | place
    send(anna, annotator, fields={"pattern": "go home"}, device="b")
    assert (read(anna)["fields"], read(anna)["device"]) == ({"pattern": "go home"}, "b")


def test_nobody_else_sees_it(sample, anna, adam, annotator):
    send(anna, annotator)
    assert read(adam) is None


def test_a_page_of_another_account_keeps_nothing(sample, anna, admin):
    assert send(anna, admin).status_code == 409
    assert not Draft.objects.exists()


def test_saving_forgets_it(sample, anna, annotator):
    path = f"/w/home/drafts/template/{sample.template.pk}/"
    send(anna, annotator, path)
    send(anna, annotator)
    page = f"/w/home/templates/{sample.template.pk}/"
    assert anna.post(page, opened(sample.template, pattern="find my $object")).status_code == 302
    assert read(anna, path) is None
    assert read(anna)


def test_a_new_template_forgets_it_and_what_comes_late_is_not_kept(sample, anna, annotator):
    category = sample.world.grammar.task_categories.get().pk
    typed = {"pattern": "go to the {room}", "form": "(go {room})", "status": "draft", "once": "k"}
    send(anna, annotator, fields=typed)
    anna.post("/w/home/templates/new/", {**typed, "task_category": category})
    assert SemanticTemplate.objects.filter(author=annotator).exists()
    assert read(anna) is None
    assert send(anna, annotator, fields=typed).json()["saved_at"] is None
    assert read(anna) is None


def test_new_rows_for_different_reasons_have_drafts_of_their_own(sample, anna, annotator):
    category = sample.world.grammar.task_categories.get().pk
    typed = {"pattern": "go to the {room}", "form": "(go {room})", "status": "draft"}
    paths = {once: NEW.replace("new", f"new-{once}") for once in ("one", "two")}
    for once, path in paths.items():
        send(anna, annotator, path, fields={**typed, "once": once})
    anna.post("/w/home/templates/new/", {**typed, "once": "one", "task_category": category})
    assert [bool(read(anna, path)) for path in paths.values()] == [False, True]


def test_it_can_be_discarded(sample, anna, annotator):
    send(anna, annotator)
    assert send(anna, annotator, discard=True).json() == {"draft": None}
    assert read(anna) is None


@pytest.mark.parametrize(
    "sent",
    [
        {"fields": None},
        {"fields": {"pattern": 1}},
        {"fields": {"pattern": "\0"}},
        {"fields": {"pattern": "\ud800"}},
        {"fields": dict.fromkeys(map(str, range(51)), "")},
        {"device": "a" * 41},
        {"version": -1},
        {"version": True},
        {"version": 2**31},
        {"about": 1},
        {"page": None},
    ],
    ids=str,
)
def test_what_is_no_draft_is_refused(sent, sample, anna, annotator):
    answer = send(anna, annotator, **sent)
    assert answer.status_code == 400
    assert answer.json()["error"].endswith(".")


def test_it_has_a_size(sample, anna, annotator):
    assert send(anna, annotator, fields={"pattern": "a" * MOST_BYTES}).status_code == 413
    assert send(anna, annotator, fields={"pattern": "a" * (MOST_BYTES - 200)}).status_code == 200


def test_the_oldest_goes_where_there_are_too_many(sample, anna, annotator, monkeypatch):
    monkeypatch.setattr("annotations.editing.drafts.MOST_DRAFTS", 2)
    rows = [*sample.world.grammar.templates.all(), None]
    for row in rows:
        send(anna, annotator, f"/w/home/drafts/template/{row.pk if row else 'new'}/")
    assert [bool(read(anna, f"/w/home/drafts/template/{row.pk}/")) for row in rows[:2]] == [
        False,
        True,
    ]
    assert MOST_DRAFTS > 10


def test_what_is_sent_once_more_is_as_old_as_it_was(sample, anna, annotator):
    first = send(anna, annotator, fields={"pattern": "go", "once": "a"}).json()["saved_at"]
    assert send(anna, annotator, fields={"pattern": "go", "once": "b"}).json()["saved_at"] == first
    assert send(anna, annotator, fields={"pattern": "go on"}).json()["saved_at"] > first


def test_none_is_kept_for_longer_than_half_a_year(sample, anna, annotator):
    send(anna, annotator)
    Draft.objects.update(saved_at=timezone.now() - KEPT - timedelta(days=1))
    assert anna.get("/drafts/").context["drafts"] == []
    send(anna, annotator, f"/w/home/drafts/template/{sample.template.pk}/")
    assert Draft.objects.get().subject == str(sample.template.pk)


def test_all_of_them_are_listed_with_the_way_back(sample, anna, annotator, adam):
    assert 'data-key="' not in anna.get("/drafts/").text
    typed = {"pattern": "go to the {room}", "once": "a" * 40}
    send(anna, annotator, fields=typed, about="New template", page="templates/new/?command=go")
    World.objects.filter(pk=sample.world.pk).update(name="house")
    page = anna.get("/drafts/").text
    assert 'href="/w/house/templates/new/?command=go"' in page
    assert "go to the {room}" in page and "a" * 40 not in page
    assert "go to the {room}" not in adam.get("/drafts/").text


def test_drafts_of_a_world_that_one_has_left_are_not_listed(sample, anna, annotator):
    send(anna, annotator, about="New template")
    sample.world.memberships.filter(user=annotator).delete()
    assert "New template" not in anna.get("/drafts/").text


@pytest.mark.parametrize("subject", ["0", "x", "9" * 30, "-1", "new-" + "a" * 20])
def test_a_row_that_is_not_there_has_none(subject, sample, anna):
    assert anna.get(f"/w/home/drafts/template/{subject}/").status_code == 404
    assert anna.get(f"/w/home/drafts/nothing/{subject}/").status_code == 404
