"""Writing templates: checked while one types, saved version by version, never over somebody's work."""

from __future__ import annotations

import re

import pytest

from annotations.exchange.generator_import import import_generator
from annotations.models import SemanticTemplate, TaskCategory
from tests.notices import levels

GOOD = {
    "pattern": "$vbfind the {kobject} now",
    "form": "(find {kobject})",
    "status": "ready",
}


@pytest.fixture
def category(sample):
    return sample.world.grammar.task_categories.get()


@pytest.fixture
def new(category):
    return {**GOOD, "task_category": category.pk}


def changed(sample, **values):
    row = SemanticTemplate.objects.get(pk=sample.template.pk)
    kept = {"pattern": row.pattern, "form": row.form, "status": row.status, "version": row.version}
    return {**kept, **values}


def test_a_new_template_joins_the_set_of_its_category(sample, category, new, anna, annotator):
    answer = anna.post("/w/home/templates/new/", new)
    made = SemanticTemplate.objects.latest("pk")
    assert answer.url == f"/w/home/templates/{made.pk}/"
    assert (made.source, made.task_category) == (category.template_sources[-1], category.name)
    assert (made.author, made.version, made.position) == (annotator, 1, 2)


def test_a_change_makes_the_next_version(sample, anna, annotator):
    pattern = "$vbfind a $object"
    assert anna.post(
        f"/w/home/templates/{sample.template.pk}/", changed(sample, pattern=pattern)
    ).url
    row = SemanticTemplate.objects.get(pk=sample.template.pk)
    assert (row.pattern, row.version, row.author) == (pattern, 2, annotator)


def test_nobody_overwrites_what_somebody_saved_meanwhile(sample, anna, adam):
    mine, theirs = (
        changed(sample, pattern="find my $object"),
        changed(sample, pattern="find a $object"),
    )
    adam.post(f"/w/home/templates/{sample.template.pk}/", theirs)
    answer = anna.post(f"/w/home/templates/{sample.template.pk}/", mine)
    page = answer.content.decode()
    assert answer.status_code == 409
    clash = answer.context["clash"]
    assert (clash.current.version, str(clash.last.history_user)) == (2, "adam")
    assert clash.sentence in page
    assert "find my $object" in page and "find a $object" in page
    assert SemanticTemplate.objects.get(pk=sample.template.pk).pattern == "find a $object"
    again = {**mine, "version": answer.context["form"]["version"].value()}
    assert anna.post(f"/w/home/templates/{sample.template.pk}/", again).status_code == 302


@pytest.mark.parametrize(
    ("field", "text", "named"),
    [
        ("form", "(find {kobject}", ""),
        ("form", "(find $7)", "$7"),
        ("form", "(find {room})", "{room}"),
        ("pattern", "find the {kobjct}", "kobjct"),
        ("pattern", "( find | locate the {kobject}", ""),
        ("form", "", ""),
    ],
)
def test_an_error_keeps_a_template_from_being_ready(field, text, named, sample, new, anna):
    answer = anna.post("/w/home/templates/new/", {**new, field: text})
    assert answer.status_code == 200
    errors = answer.context["form"].errors
    assert field in errors and named in " ".join(errors[field])
    assert SemanticTemplate.objects.count() == 2


def test_a_draft_may_be_unfinished(sample, new, anna):
    answer = anna.post("/w/home/templates/new/", {**new, "form": "(find", "status": "draft"})
    assert answer.status_code == 302


def test_the_checker_answers_an_editor(sample, new, anna):
    answer = anna.post("/w/home/templates/check/", new).json()
    assert answer["reading"] == "find({kobject})"
    assert answer["gloss"]
    assert all(problem["severity"] == "warning" for problem in answer["problems"])


def test_the_checker_says_in_which_field_and_where(sample, new, anna):
    answer = anna.post("/w/home/templates/check/", {**new, "form": "(find {kobject}"}).json()
    (problem,) = answer["problems"]
    assert (problem["field"], problem["severity"], problem["line"]) == ("form", "error", 1)


def test_what_the_grammar_never_says_leads_to_its_productions(sample, new, anna, reviewer):
    new = {**new, "pattern": "bring it to the {room}", "form": "(go {room})"}
    (problem,) = anna.post("/w/home/templates/check/", new).json()["problems"]
    assert problem["hint"]
    assert problem["task_category"] == "1"
    page = anna.post("/w/home/templates/preview/", new).content.decode()
    assert 'href="/w/home/grammar/?task_category=1"' in page


def test_the_checker_says_what_is_wrong_with_both_sides(sample, new, anna):
    both = {**new, "pattern": "find {kobjct}", "form": "(find"}
    fields = [
        each["field"] for each in anna.post("/w/home/templates/check/", both).json()["problems"]
    ]
    assert sorted(fields) == ["form", "pattern"]


def test_an_empty_editor_has_no_problems(sample, new, anna):
    assert anna.post("/w/home/templates/check/", {**new, "form": ""}).json() == {"problems": []}


def test_the_preview_shows_what_the_template_makes(sample, new, anna):
    checked = anna.post("/w/home/templates/preview/", new).context["checked"]
    assert checked.size == len(checked.commands) == 2


def test_a_reviewer_reads_a_template_without_an_editor(sample, reviewer, client):
    client.force_login(reviewer)
    page = client.get(f"/w/home/templates/{sample.template.pk}/")
    assert "data-editor" not in page.content.decode()
    assert page.context["checked"].size == 2


def test_generating_takes_new_templates_in(sample, new, anna):
    anna.post("/w/home/templates/new/", new)
    answer = anna.post("/w/home/generate/", follow=True)
    assert levels(answer)[-1] == "success"
    assert sample.world.commands.count() == 5
    assert sample.world.commands.values("logical_form").distinct().count() == 3


def test_a_misspelt_predicate_is_saved_and_told(sample, new, anna):
    answer = anna.post("/w/home/templates/new/", {**new, "form": "(fnd {kobject})"}, follow=True)
    row = SemanticTemplate.objects.latest("pk")
    assert any("fnd" in problem["message"] for problem in row.problems)
    assert {problem["severity"] for problem in row.problems} == {"warning"}
    assert levels(answer) == ["warning"]
    assert f" {len(row.problems)} " in str(*answer.context["messages"])
    assert "fnd" in anna.get("/w/home/templates/", {"problems": "yes"}).content.decode()
    anna.post(f"/w/home/templates/{row.pk}/", {**new, "version": 1})
    row.refresh_from_db()
    assert not any("fnd" in problem["message"] for problem in row.problems)


def test_an_import_says_in_the_row_what_is_wrong_with_it(world, tiny):
    tiny["tiny_category_1_semantics.txt"] += b'run home = (go "home")\n'
    import_generator(world.name, tiny)
    rows = SemanticTemplate.objects.filter(grammar__world=world)
    assert [bool(row.problems) for row in rows] == [False, False, True]
    assert list(rows.with_problems()) == [rows.last()]


def test_a_draft_with_an_error_keeps_what_the_checker_says(sample, new, anna):
    anna.post("/w/home/templates/new/", {**new, "form": "(find", "status": "draft"})
    (problem,) = SemanticTemplate.objects.latest("pk").problems
    assert (problem["field"], problem["severity"]) == ("form", "error")


def test_the_empty_fields_show_an_example_of_this_world(sample, anna):
    page = anna.get("/w/home/templates/new/").content.decode()
    assert 'placeholder="$vbfind the $object"' in page
    SemanticTemplate.objects.all().delete()
    page = anna.get("/w/home/templates/new/").content.decode()
    assert 'placeholder="find | locate"' in page


@pytest.mark.parametrize("key", ["", "²", "9" * 5000, "9" * 30, "-1", "x", "\0"], ids=len)
def test_the_checker_takes_any_task_category(key, sample, new, anna):
    answer = anna.post("/w/home/templates/check/", {**new, "task_category": key})
    assert answer.status_code == 200


@pytest.fixture
def other_category(sample, category):
    return TaskCategory.objects.create(
        grammar=category.grammar,
        name="2",
        position=9,
        rule_sources=category.rule_sources,
        template_sources=["tiny_category_2_semantics.txt"],
    )


def test_another_task_category_moves_a_template_to_its_set(sample, other_category, anna, adam):
    row = sample.template
    path = f"/w/home/templates/{row.pk}/"
    anna.post(path, changed(sample, task_category=other_category.pk))
    row.refresh_from_db()
    assert (row.task_category, row.source) == ("2", "tiny_category_2_semantics.txt")
    assert sample.world.commands.filter(template=row).first().task_category == "2"
    late = adam.post(path, changed(sample, version=1, task_category=other_category.pk, form="(go)"))
    assert late.status_code == 409


def test_a_copy_of_a_template_is_a_draft(sample, anna, annotator):
    answer = anna.post(f"/w/home/templates/{sample.template.pk}/duplicate/")
    copy = SemanticTemplate.objects.latest("pk")
    assert answer.url == f"/w/home/templates/{copy.pk}/"
    assert (copy.pattern, copy.form) == (sample.template.pattern, sample.template.form)
    assert (copy.status, copy.author, copy.source) == ("draft", annotator, sample.template.source)


def test_a_deleted_template_takes_its_commands_with_it_and_comes_back(sample, anna):
    row, before = sample.template, sample.world.commands.count()
    path = f"/w/home/history/template/{row.pk}/"
    late = anna.post(f"{path}delete/", {"version": 7}, follow=True)
    assert levels(late) == ["error"]
    assert SemanticTemplate.objects.filter(pk=row.pk).exists()
    anna.post(f"{path}delete/", {"version": row.version})
    assert not SemanticTemplate.objects.filter(pk=row.pk).exists()
    assert sample.world.commands.count() < before
    entry = anna.get(path).context["history"].versions[-1].entry
    anna.post(path, {"entry": entry})
    assert sample.world.commands.count() == before


def test_samples_name_entities_and_stay_the_same_for_one_seed(sample, new, anna):
    def texts(seed):
        sent = {**new, "pattern": "find the {object} now", "form": "(find {object})", "seed": seed}
        answer = anna.post("/w/home/templates/preview/", sent)
        return [each.text for each in answer.context["samples"].rows]

    assert texts("") == texts("0")
    assert {text.split()[2] for seed in range(4) for text in texts(seed)} == {"tea", "milk"}


def test_a_sample_without_an_entity_is_told(sample, new, anna):
    sent = {**new, "pattern": "wave {gesture}", "form": "(wave {gesture})"}
    answer = anna.post("/w/home/templates/preview/", sent)
    assert "{gesture}" in answer.context["samples"].missing
    assert not answer.context["samples"].rows
    assert answer.context["samples"].missing in answer.content.decode()


def test_an_empty_editor_explains_itself_with_templates_of_this_world(sample, anna):
    page = anna.get("/w/home/templates/new/")
    assert [each.pk for each in page.context["examples"]]
    assert re.search(r'<details class="template-help"[^>]* open>', page.content.decode())


def test_examples_share_a_slot_and_leave_nothing_unknown(sample, category, anna):
    for position, form in enumerate(("(halt)", "(go UNKNOWN)", '(greet "you")'), start=10):
        values = {"pattern": form, "form": form, "status": "ready", "position": position}
        SemanticTemplate.for_category(category, **values).save()
    examples = anna.get("/w/home/templates/new/").context["examples"]
    assert [each.form for each in examples][2:] == ["(halt)"]
    assert {each.pattern for each in examples[:2]} == {"go to the {room}", "$vbfind the $object"}
