"""A change brings commands up to date in its own transaction, exactly as a full generation does."""

from __future__ import annotations

import pytest
from django.db import transaction
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from annotations.editing.edits import add, change, delete, restore
from annotations.exchange.generator_import import import_generator
from annotations.generation import kept_expansions
from annotations.generation.generating import generate_pairs
from annotations.language.templates import BoundedCache
from annotations.models import Job, JobKind, Production, SemanticTemplate, TaskCategory, World
from annotations.models.description import ProblemSubject, TemplateStatus
from tests.annotations.conftest import as_bytes
from tests.annotations.rows_of import rows_of
from tests.sample_world import make_paraphrase

# Category 2 uses the templates of category 1 as well, and makes some of the same commands.
TWO_CATEGORIES = {
    "common_rules.txt": "$go = go | drive\n$fetch = get | bring\n$thing = {kobject} | it\n",
    "x_category_1_grammar.txt": "; import common.txt\n$Main = $go to the {room} | $fetch $thing\n",
    "x_category_2_grammar.txt": "; import common.txt\n$Main = $fetch $thing | $go out | $go $fetch\n",
    "x_category_1_semantics.txt": "$go to the {room} = (go {room})\n$fetch $thing = (bring $thing)\n",
    "x_category_2_semantics.txt": "$go out = (leave)\n(go|run) out = (run)\nget it = (stop)\n",
    "objects.xml": '<categories><category name="drinks" room="kitchen">'
    '<object name="tea"/></category></categories>',
    "locations.xml": '<rooms><room name="kitchen"><location name="sink" isPlacement="true"/>'
    "</room></rooms>",
}
PATTERNS = (
    *("$go out", "$fetch $thing", "get it", "(go|run) out", "$go $fetch", "$nothing", "$go"),
    *("$thing -> the {kobject}", "$thing -> it", "$fetch -> (get|take)", "$go $thing out"),
)
FORMS = (
    *("(go)", "(bring $thing)", '($fetch "it")', "(stop)", "UNKNOWN"),
    *("$thing", "(sequence $fetch $thing)", "(is_a {kobject})"),
)
EXPANSIONS = ("get it", "the {kobject} | it", "go", "(drive | run) out")
edits = st.tuples(
    st.sampled_from(["add", "change", "change", "delete", "restore", "status", "production"]),
    st.integers(0, 20),
    st.integers(0, 20),
)


@pytest.fixture
def two_categories(world):
    assert not import_generator(world.name, as_bytes(TWO_CATEGORIES)).is_refused
    generate_pairs(world)
    return world


def edit(world, by, kind, first, second):
    """Carry out one edit; ``first`` and ``second`` choose the row and what it becomes."""
    templates = list(SemanticTemplate.objects.filter(grammar__world=world))
    values = {"pattern": PATTERNS[first % len(PATTERNS)], "form": FORMS[second % len(FORMS)]}
    if kind == "production":
        row = pick(Production.objects.filter(grammar__world=world), first)
        change(row, {"expansion": EXPANSIONS[second % len(EXPANSIONS)]}, by, row.version)
    elif kind == "add":
        category = pick(TaskCategory.objects.filter(grammar__world=world), first)
        add(SemanticTemplate.for_category(category, **values), by)
    elif kind == "restore":
        gone = SemanticTemplate.history.filter(grammar=world.grammar, history_type="-")
        if gone:
            restore(pick(gone, first), by)
    elif templates:
        row = pick(templates, first)
        if kind == "delete":
            delete(row, by, row.version)
        else:
            status = list(TemplateStatus)[second % len(TemplateStatus)]
            change(row, values if kind == "change" else {"status": status}, by, row.version)


def pick(rows, number):
    rows = list(rows)
    return rows[number % len(rows)]


@settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.lists(edits, min_size=1, max_size=6))
def test_after_any_edits_a_full_generation_finds_nothing_to_do(two_categories, annotator, steps):
    with transaction.atomic():
        for step in steps:
            edit(two_categories, annotator, *step)
        two_categories.refresh_from_db()
        assert not two_categories.commands_are_stale
        before = rows_of(two_categories)
        report = generate_pairs(two_categories)
        assert report.changes.as_json() == {"added": 0, "changed": 0, "removed": 0, "moved": 0}
        assert rows_of(two_categories) == before
        transaction.set_rollback(True)


def commands_of(world):
    return dict(world.commands.values_list("anonymized_text", "logical_form__text"))


def test_only_the_commands_of_the_change_are_touched(two_categories, annotator):
    before = {row.anonymized_text: row.pk for row in two_categories.commands.all()}
    leave = SemanticTemplate.objects.get(form="(leave)")
    changed = change(leave, {"form": "(depart)"}, annotator, leave.version)
    assert commands_of(two_categories)["drive out"] == "( depart )"
    assert {row.anonymized_text: row.pk for row in two_categories.commands.all()} == before
    delete(changed, annotator, changed.version)
    after = {row.anonymized_text: row.pk for row in two_categories.commands.all()}
    assert after == {text: pk for text, pk in before.items() if text != "drive out"}


def test_what_is_taken_back_leaves_everything_as_it_was(two_categories, annotator):
    before = commands_of(two_categories)
    category = TaskCategory.objects.get(grammar__world=two_categories, name="2")
    row = add(SemanticTemplate.for_category(category, pattern="$go $fetch", form="(go)"), annotator)
    assert len(commands_of(two_categories)) == len(before) + 4
    category.refresh_from_db()
    assert category.commands_without_form == 0
    delete(row, annotator, row.version)
    assert commands_of(two_categories) == before
    category.refresh_from_db()
    assert category.commands_without_form == 4


def test_a_conflict_comes_and_goes_with_the_template(two_categories, annotator):
    conflicts = two_categories.problems.filter(subject=ProblemSubject.COMMANDS)
    before = set(conflicts.values_list("message", flat=True))
    category = TaskCategory.objects.get(grammar__world=two_categories, name="1")
    row = add(SemanticTemplate.for_category(category, pattern="bring it", form="(x)"), annotator)
    new = set(conflicts.values_list("message", flat=True)) - before
    (message,) = new  # of both categories that have the template
    assert '"bring it" gets ( x ) here' in message
    delete(row, annotator, row.version)
    assert set(conflicts.values_list("message", flat=True)) == before


def test_a_draft_changes_nothing(two_categories, annotator):
    before = rows_of(two_categories)["Command"]
    category = TaskCategory.objects.filter(grammar__world=two_categories).first()
    draft = SemanticTemplate.for_category(category, pattern="$go $fetch", form="(go)")
    draft.status = TemplateStatus.DRAFT
    add(draft, annotator)
    assert rows_of(two_categories)["Command"] == before


def test_paraphrases_keep_their_commands_and_find_them_again(two_categories, annotator):
    said = make_paraphrase(
        two_categories,
        command=two_categories.commands.get(anonymized_text="go to the <room>"),
        prompt="go to the bath",
        utterance="drive to the bath",
        grounded_form='( go " bath " )',
        logical_form='( go " <room> " )',
    )
    row = SemanticTemplate.objects.get(form="(leave)")
    delete(row, annotator, row.version)
    said.refresh_from_db()
    assert said.command.anonymized_text == "go to the <room>"
    own = SemanticTemplate.objects.get(form="(go {room})")
    draft = change(own, {"status": TemplateStatus.DRAFT}, annotator, own.version)
    said.refresh_from_db()
    assert (said.command, said.command_text) == (None, "go to the <room>")
    change(draft, {"status": TemplateStatus.READY}, annotator, draft.version)
    said.refresh_from_db()
    assert (said.command.anonymized_text, said.command_text) == ("go to the <room>", "")


def test_a_world_too_large_for_a_request_is_marked_and_left_to_a_worker(
    two_categories, annotator, monkeypatch
):
    monkeypatch.setattr(kept_expansions, "_GENERATED", BoundedCache(0))
    monkeypatch.setattr(kept_expansions, "MOST_AT_ONCE", 3)
    before = rows_of(two_categories)["Command"]
    row = SemanticTemplate.objects.get(form="(leave)")
    for form in ("(depart)", "(part)"):
        row = change(row, {"form": form}, annotator, row.version)
    two_categories.refresh_from_db()
    assert two_categories.commands_are_stale
    assert rows_of(two_categories)["Command"] == before
    job = Job.objects.get(kind=JobKind.GENERATE, world=two_categories)
    assert job.created_by == annotator


def test_a_grammar_that_cannot_be_expanded_is_saved_and_the_world_marked(two_categories, annotator):
    row = Production.objects.get(grammar__world=two_categories, nonterminal="go")
    change(row, {"expansion": "$go"}, annotator, row.version)
    two_categories.refresh_from_db()
    assert two_categories.commands_are_stale
    row.refresh_from_db()
    change(row, {"expansion": "go | drive"}, annotator, row.version)
    assert not World.objects.get(pk=two_categories.pk).commands_are_stale


def messages_of(template):
    template.refresh_from_db()
    return " ".join(each["message"] for each in template.problems)


def test_a_changed_production_is_felt_by_the_templates_that_use_it(two_categories, annotator):
    template = SemanticTemplate.objects.get(form="(leave)")
    before = messages_of(template)
    main = Production.objects.get(expansion__contains="$go out")
    row = change(main, {"expansion": "$fetch $thing"}, annotator, main.version)
    assert messages_of(template) != before
    change(row, {"expansion": main.expansion}, annotator, row.version)
    assert messages_of(template) == before


def test_the_other_template_of_a_conflict_hears_of_it(two_categories, annotator):
    run = SemanticTemplate.objects.get(form="(run)")
    assert "with a different form" in messages_of(run)
    leave = SemanticTemplate.objects.get(form="(leave)")
    change(leave, {"form": "(run)"}, annotator, leave.version)
    assert "with a different form" not in messages_of(run)
    assert run.version == 1


def test_a_changed_predicate_is_felt_by_the_templates_that_use_it(two_categories, annotator):
    template = SemanticTemplate.objects.get(form="(leave)")
    predicate = two_categories.predicates.get(name="leave")
    row = change(predicate, {"name": "depart"}, annotator, predicate.version)
    assert "leave" in messages_of(template)
    change(row, {"name": "leave"}, annotator, row.version)
    assert "leave" not in messages_of(template)
