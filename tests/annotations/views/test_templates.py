"""Writing templates: checked while one types, saved version by version, never over somebody's work."""

from __future__ import annotations

import pytest

from annotations.models import SemanticTemplate

GOOD = {
    "pattern": "$vbfind the {kobject} now",
    "form": "(find {kobject})",
    "status": "ready",
}


@pytest.fixture
def category(house):
    return house.world.grammar.task_categories.get()


@pytest.fixture
def new(category):
    return {**GOOD, "task_category": category.pk}


def changed(house, **values):
    row = SemanticTemplate.objects.get(pk=house.template.pk)
    kept = {"pattern": row.pattern, "form": row.form, "status": row.status, "version": row.version}
    return {**kept, **values}


def test_a_new_template_joins_the_set_of_its_category(house, category, new, anna, annotator):
    answer = anna.post("/w/home/templates/new/", new)
    made = SemanticTemplate.objects.latest("pk")
    assert answer.url == f"/w/home/templates/{made.pk}/"
    assert (made.source, made.task_category) == (category.template_sources[-1], category.name)
    assert (made.author, made.version, made.position) == (annotator, 1, 2)


def test_a_change_makes_the_next_version(house, anna, annotator):
    pattern = "$vbfind a $object"
    assert anna.post(f"/w/home/templates/{house.template.pk}/", changed(house, pattern=pattern)).url
    row = SemanticTemplate.objects.get(pk=house.template.pk)
    assert (row.pattern, row.version, row.author) == (pattern, 2, annotator)


def test_nobody_overwrites_what_somebody_saved_meanwhile(house, anna, adam):
    mine, theirs = (
        changed(house, pattern="find my $object"),
        changed(house, pattern="find a $object"),
    )
    adam.post(f"/w/home/templates/{house.template.pk}/", theirs)
    answer = anna.post(f"/w/home/templates/{house.template.pk}/", mine)
    page = answer.content.decode()
    assert answer.status_code == 409
    assert "adam has saved version 2 in the meantime" in page
    assert "find my $object" in page and "find a $object" in page
    assert SemanticTemplate.objects.get(pk=house.template.pk).pattern == "find a $object"
    again = {**mine, "version": answer.context["form"]["version"].value()}
    assert anna.post(f"/w/home/templates/{house.template.pk}/", again).status_code == 302


@pytest.mark.parametrize(
    ("field", "text", "sentence"),
    [
        ("form", "(find {kobject}", "form"),
        ("form", "(find $7)", "$7"),
        ("form", "(find {room})", "which the pattern never produces"),
        ("pattern", "find the {kobjct}", "kobjct"),
        ("pattern", "( find | locate the {kobject}", "never closed"),
        ("form", "", "This field is required."),
    ],
)
def test_an_error_keeps_a_template_from_being_ready(field, text, sentence, house, new, anna):
    answer = anna.post("/w/home/templates/new/", {**new, field: text})
    assert answer.status_code == 200
    assert sentence in " ".join(answer.context["form"].errors[field])
    assert SemanticTemplate.objects.count() == 2


def test_a_draft_may_be_unfinished(house, new, anna):
    answer = anna.post("/w/home/templates/new/", {**new, "form": "(find", "status": "draft"})
    assert answer.status_code == 302


def test_the_checker_answers_an_editor(house, new, anna):
    answer = anna.post("/w/home/templates/check/", new).json()
    assert answer["reading"] == "find({kobject})"
    assert answer["gloss"]
    assert all(problem["severity"] == "warning" for problem in answer["problems"])


def test_the_checker_says_in_which_field_and_where(house, new, anna):
    answer = anna.post("/w/home/templates/check/", {**new, "form": "(find {kobject}"}).json()
    (problem,) = answer["problems"]
    assert (problem["field"], problem["severity"], problem["line"]) == ("form", "error", 1)


def test_the_checker_says_what_is_wrong_with_both_sides(house, new, anna):
    both = {**new, "pattern": "find {kobjct}", "form": "(find"}
    fields = [
        each["field"] for each in anna.post("/w/home/templates/check/", both).json()["problems"]
    ]
    assert sorted(fields) == ["form", "pattern"]


def test_an_empty_editor_has_no_problems(house, new, anna):
    assert anna.post("/w/home/templates/check/", {**new, "form": ""}).json() == {"problems": []}


def test_the_preview_shows_what_the_template_makes(house, new, anna):
    page = anna.post("/w/home/templates/preview/", new).content.decode()
    assert "2 commands" in page


def test_a_reviewer_reads_a_template_without_an_editor(house, reviewer, client):
    client.force_login(reviewer)
    page = client.get(f"/w/home/templates/{house.template.pk}/").content.decode()
    assert "<textarea" not in page
    assert "2 commands" in page


def test_generating_takes_new_templates_in(house, new, anna):
    anna.post("/w/home/templates/new/", new)
    answer = anna.post("/w/home/generate/", follow=True)
    assert "5 commands with 3 logical forms" in answer.content.decode()
    assert house.world.commands.count() == 5
