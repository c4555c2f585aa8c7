"""The panel beside a template, and the sentence after it was saved."""

from __future__ import annotations

import pytest

from annotations.generation import kept_expansions
from annotations.generation.freezing import freeze_split
from annotations.language.templates import BoundedCache
from annotations.models import SemanticTemplate
from parser_service.runs import run_requests


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
    return answer


def kinds_in(answer) -> dict[str, int]:
    """Return how many rows of each kind of consequence a page shows."""
    return {group.kind: len(group.rows) for group in answer.context["groups"]}


def test_the_panel_shows_old_and_new_forms_and_saves_nothing(sample, new, anna):
    answer = panel(anna, new)
    assert kinds_in(answer) == {"changed": 1, "conflicts": 1, "shadowed": 1}
    assert "<mark>" in answer.content.decode()
    assert not SemanticTemplate.objects.filter(form="(visit {room})").exists()


def test_the_panel_of_a_stored_template_compares_with_it(sample, new, anna):
    row = SemanticTemplate.objects.get(form="(go {room})")
    split = freeze_split(sample.world, "all")
    run_requests.request(sample.world, split, "knn", seed=0, send=False)
    answer = panel(anna, {**new, "version": row.version}, row.pk)
    assert kinds_in(answer) == {"changed": 1, "splits": 1}
    stale = answer.context["expected"].splits
    assert (list(stale.splits), list(stale.results)) == ([split], [("run", 1)])
    assert f'href="/w/home/splits/{split.pk}/"' in answer.content.decode()
    same = {**new, "form": row.form, "version": row.version}
    assert kinds_in(panel(anna, same, row.pk)) == {}


def test_a_draft_takes_its_commands_away(sample, new, anna):
    row = SemanticTemplate.objects.get(form="(go {room})")
    answer = panel(anna, {**new, "status": "draft", "version": 1}, row.pk)
    assert kinds_in(answer) == {"lost": 1}


@pytest.mark.parametrize(
    ("values", "is_whole"),
    [
        ({"form": ""}, False),
        ({"form": "(go"}, True),
        ({"form": "(go $object)"}, True),
        ({"task_category": 10**9}, True),
    ],
)
def test_what_cannot_be_saved_has_no_consequences(sample, new, anna, values, is_whole):
    answer = panel(anna, {**new, **values})
    expected = answer.context["expected"]
    assert kinds_in(answer) == {}
    assert bool(expected and expected.trouble) is is_whole


def test_saving_says_what_came_of_it_and_the_tables_show_it(sample, new, anna):
    answer = anna.post(
        "/w/home/templates/new/", {**new, "pattern": "run to the {room}"}, follow=True
    )
    made = SemanticTemplate.objects.latest("pk")
    assert f'href="/w/home/commands/?template={made.pk}"' in str(*answer.context["messages"])
    assert "run to the" in anna.get("/w/home/commands/?q=run").content.decode()


def test_saving_in_a_world_too_large_says_who_does_the_rest(sample, new, anna, monkeypatch):
    monkeypatch.setattr(kept_expansions, "_GENERATED", BoundedCache(0))
    monkeypatch.setattr(kept_expansions, "MOST_AT_ONCE", 1)
    answer = anna.post(
        "/w/home/templates/new/", {**new, "pattern": "run to the {room}"}, follow=True
    )
    assert 'href="/w/home/jobs/"' in str(*answer.context["messages"])


def test_templates_of_other_worlds_are_not_found(sample, other_sample, new, anna):
    for key in (other_sample.template.pk, 10**17, "9" * 30, "x", "-1"):
        assert anna.post(f"/w/home/templates/consequences/?template={key}", new).status_code == 404
