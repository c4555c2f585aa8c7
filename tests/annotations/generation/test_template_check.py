"""The checker answers within its budget, whatever somebody types, and refuses what cannot be stored."""

from __future__ import annotations

import pytest
from django.db import connection

from annotations.language.texts.limits import MAX_PATTERN
from annotations.models import SemanticTemplate
from tests.work import steps_of

MOST_STEPS = 4_000_000  # lines of Python; twice what the worst takes
PATHOLOGICAL = {
    "nonterminals": (" ".join(["$Main"] * 5), "(go $Main)"),
    "choices": ("(a|b) " * 60 + "| $vbfind", "(go $vbfind)"),
    "many choices": ("(a|b) " * 800, "(go {room})"),
    "both": ("$Main (a|b) " * 300, "(go $Main)"),
}


@pytest.fixture
def category(sample):
    return sample.world.grammar.task_categories.get()


@pytest.mark.parametrize("pattern, form", PATHOLOGICAL.values(), ids=PATHOLOGICAL)
@pytest.mark.parametrize("path", ["check", "preview", "new"])
def test_every_way_to_ask_the_checker_is_bounded(path, pattern, form, category, anna):
    sent = {"pattern": pattern, "form": form, "task_category": category.pk, "status": "draft"}
    answers = []
    steps = steps_of(lambda: answers.append(anna.post(f"/w/home/templates/{path}/", sent)))
    assert answers[0].status_code in (200, 302)
    assert steps < MOST_STEPS


def test_a_draft_is_opened_without_expanding_it(sample, anna, monkeypatch):
    pattern, form = PATHOLOGICAL["nonterminals"]
    row = SemanticTemplate.objects.get(pk=sample.template.pk)
    remark = {
        "field": "pattern",
        "line": 1,
        "column": 2,
        "severity": "warning",
        "message": "too many combinations",
        "hint": "",
    }
    row.pattern, row.form, row.status, row.problems = pattern, form, "draft", [remark]
    row.save()
    monkeypatch.setattr(
        "annotations.generation.template_check.checker_of", lambda *args: pytest.fail("expanded")
    )
    page = anna.get(f"/w/home/templates/{row.pk}/")
    assert page.status_code == 200
    assert "too many combinations" in page.content.decode()


@pytest.mark.parametrize("field", ["pattern", "form"])
@pytest.mark.parametrize("path", ["check", "preview", "new"])
def test_texts_that_nobody_types_are_not_looked_at(field, path, category, anna, monkeypatch):
    monkeypatch.setattr(
        "annotations.generation.template_check.read_known_sides",
        lambda *args: pytest.fail("looked at"),
    )
    sent = {"pattern": "go", "form": "UNKNOWN", "task_category": category.pk, "status": "ready"}
    sent[field] = "a " * MAX_PATTERN
    answer = anna.post(f"/w/home/templates/{path}/", sent)
    assert answer.status_code == 200
    assert "5,000" in answer.content.decode() or "5000" in answer.content.decode()


@pytest.mark.parametrize("length, is_saved", [(80, True), (81, False)])
def test_a_predicate_longer_than_the_database_holds_is_told(length, is_saved, category, anna):
    name = "p" * length
    sent = {"pattern": "go", "form": f"({name} {{room}})", "status": "ready"}
    sent = {**sent, "pattern": "go {room}", "task_category": category.pk}
    answer = anna.post("/w/home/templates/new/", sent)
    assert (answer.status_code == 302) is is_saved
    if not is_saved:
        (told,) = answer.context["form"].errors["form"]
        assert " 81 " in told and "80" in told
    if is_saved and connection.vendor == "postgresql":
        assert anna.post("/w/home/generate/").status_code == 302
