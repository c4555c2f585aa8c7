"""The panel beside a template, and the sentence after it was saved."""

from __future__ import annotations

import pytest

from annotations.generation import kept_expansions
from annotations.language.templates import BoundedCache
from annotations.models import SemanticTemplate
from annotations.splits.freezing import freeze_split
from parser_service.runs.requests import run_requests


@pytest.fixture
def new(sample):
    category = sample.world.grammar.task_categories.get()
    return {
        "task_category": category.pk,
        "pattern": "go to the {room}",
        "form": "(visit {room})",
        "status": "ready",
    }


def panel(client, values, pk=""):
    query = f"?template={pk}" if pk else ""
    answer = client.post(f"/w/home/templates/consequences/{query}", values)
    assert answer.status_code == 200
    return " ".join(answer.content.decode().split())


def test_the_panel_shows_old_and_new_forms_and_saves_nothing(sample, new, anna):
    page = panel(anna, new)
    assert "1 command with another form, 1 new conflict, 1 template overridden" in page
    assert "Form now" in page and "<mark>" in page
    assert "the commands of" not in page
    assert not SemanticTemplate.objects.filter(form="(visit {room})").exists()


def test_the_panel_of_a_stored_template_compares_with_it(sample, new, anna):
    row = SemanticTemplate.objects.get(form="(go {room})")
    split = freeze_split(sample.world, "all")
    run_requests.request(sample.world, split, "knn", seed=0, send=False)
    page = panel(anna, {**new, "version": row.version}, row.pk)
    assert "1 command with another form, 1 split out of date." in page
    assert "1 run used it." in page and "home-split" not in page
    same = {**new, "form": row.form, "version": row.version}
    assert "No command changes." in panel(anna, same, row.pk)


def test_a_draft_takes_its_commands_away(sample, new, anna):
    row = SemanticTemplate.objects.get(form="(go {room})")
    page = panel(anna, {**new, "status": "draft", "version": 1}, row.pk)
    assert "1 command without a form from then on" in page


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"form": ""}, "Write both sides"),
        ({"form": "(go"}, "correct the errors first"),
        ({"form": "(go $object)"}, "correct the errors first"),
        ({"task_category": 10**9}, "correct the errors first"),
    ],
)
def test_what_cannot_be_saved_has_no_consequences(sample, new, anna, values, sentence):
    assert sentence in panel(anna, {**new, **values})


def test_saving_says_what_came_of_it_and_the_tables_show_it(sample, new, anna):
    answer = anna.post(
        "/w/home/templates/new/", {**new, "pattern": "run to the {room}"}, follow=True
    )
    page = answer.content.decode()
    assert "Saved. 1 new command outside the grammar. <a href=" in page
    assert "run to the" in anna.get("/w/home/commands/?q=run").content.decode()


def test_saving_in_a_world_too_large_says_who_does_the_rest(sample, new, anna, monkeypatch):
    monkeypatch.setattr(kept_expansions, "_GENERATED", BoundedCache(0))
    monkeypatch.setattr(kept_expansions, "MOST_AT_ONCE", 1)
    answer = anna.post(
        "/w/home/templates/new/", {**new, "pattern": "run to the {room}"}, follow=True
    )
    assert 'The commands follow in a <a href="/w/home/jobs/">job</a>.' in answer.content.decode()


def test_templates_of_other_worlds_are_not_found(sample, other_sample, new, anna):
    for key in (other_sample.template.pk, 10**17, "9" * 30, "x", "-1"):
        assert anna.post(f"/w/home/templates/consequences/?template={key}", new).status_code == 404
