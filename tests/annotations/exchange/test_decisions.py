"""A file does not undo what people have decided: what they deleted, moved or renamed stays so."""

from __future__ import annotations

import pytest

from annotations.editing.edits import change, delete
from annotations.exchange.generator_export import complete, generator_files
from annotations.exchange.generator_import import import_generator
from annotations.exchange.pair_import import import_pairs
from annotations.models import Entity, Paraphrase, Production, SemanticTemplate
from tests.annotations.exchange.test_pair_import import folder, generated  # noqa: F401

LINE = "tiny_category_1_semantics.txt: go to the {room} = (go {room})"


@pytest.fixture
def by_kind(tiny_world):
    """A row of each kind that files bring."""
    return {
        "templates": tiny_world.grammar.templates.get(pattern="go to the {room}"),
        "productions": tiny_world.grammar.productions.last(),
        "entities": tiny_world.ontology.entities.get(text="tea"),
        "predicates": tiny_world.predicates.get(name="go"),
    }


def texts_of(row):
    return [str(each) for each in type(row).objects.all()]


@pytest.mark.parametrize("kind", ["templates", "productions", "entities", "predicates"])
def test_what_people_deleted_stays_away_until_it_is_brought_back(
    kind, by_kind, tiny_world, tiny, annotator, admin
):
    row = by_kind[kind]
    before = texts_of(row)
    delete(row, annotator, 1)
    for _ in range(2):
        report = import_generator("home", tiny, admin, may_remove=False)
        (text,) = report.left_out.as_json()[kind]
        assert str(row) in text and "anna" in text.partition(str(row))[2]
        assert not report.is_waiting and report.changes.added == 0
    assert not type(row).objects.filter(pk=row.pk).exists()
    report = import_generator("home", tiny, admin, brings_back=True)
    assert not report.left_out and report.changes.added == 1
    restored = type(row).objects.get(pk=row.pk)
    assert (restored.version, restored.history.latest("history_id").history_user) == (2, admin)
    assert texts_of(row) == before
    assert not import_generator("home", tiny).left_out


def test_what_an_import_removed_comes_back_with_its_file(tiny_world, tiny):
    left = dict(tiny)
    del left["tiny_category_1_semantics.txt"]
    import_generator("home", left)
    assert not import_generator("home", tiny).left_out
    assert tiny_world.grammar.templates.count() == 2


def test_one_of_two_equal_lines_can_be_deleted(tiny_world, tiny, annotator):
    tiny["tiny_category_1_semantics.txt"] += b"go to the {room} = (go {room})\n"
    import_generator("home", tiny)
    rows = tiny_world.grammar.templates.filter(pattern="go to the {room}")
    delete(rows[1], annotator, 1)
    assert len(import_generator("home", tiny).left_out.templates) == 1
    assert rows.count() == 1


def test_a_deletion_outlives_the_account_of_who_deleted(tiny_world, tiny, annotator):
    delete(tiny_world.grammar.templates.get(pattern="go to the {room}"), annotator, 1)
    annotator.delete()
    (text,) = import_generator("home", tiny).left_out.templates
    assert text.startswith(f"{LINE} (") and "anna" not in text


def test_a_template_that_was_moved_is_not_doubled(tiny_world, tiny, annotator):
    template = tiny_world.grammar.templates.get(pattern="go to the {room}")
    moved = {"source": "other_semantics.txt", "task_category": "other"}
    change(template, moved, annotator, 1)
    for files in (tiny, complete(tiny_world, tiny)):
        report = import_generator("home", files, may_remove=False)
        assert not report.is_waiting and report.changes.added == 0
        (text,) = report.left_out.templates
        assert text.startswith(f"{LINE} (kept ") and "anna" in text
        rows = tiny_world.grammar.templates.filter(pattern="go to the {room}")
        assert [(row.pk, row.source) for row in rows] == [(template.pk, "other_semantics.txt")]
    assert not import_generator("home", as_files(tiny_world, tiny)).left_out


def as_files(world, files):
    """What the world gives out, in the place of the files that it was imported from."""
    return files | {name: text.encode() for name, text in generator_files(world).items()}


def test_a_moved_template_that_is_deleted_stays_away_from_where_it_was(tiny_world, tiny, annotator):
    template = tiny_world.grammar.templates.get(pattern="go to the {room}")
    change(template, {"source": "other_semantics.txt"}, annotator, 1)
    delete(template, annotator, 2)
    (text,) = import_generator("home", tiny).left_out.templates
    assert text.startswith(f"{LINE} (deleted ") and "anna" in text


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        ("productions", {"expansion": "somewhere else"}),
        ("entities", {"text": "green tea"}),
    ],
)
def test_what_people_changed_is_neither_doubled_nor_removed(
    kind, values, by_kind, tiny_world, tiny, annotator
):
    row = by_kind[kind]
    change(row, values, annotator, 1)
    before = type(row).objects.count()
    report = import_generator("home", tiny, may_remove=False)
    assert not report.is_waiting
    (text,) = report.left_out.as_json()[kind]
    assert "anna" in text and next(iter(values.values())) in text
    assert type(row).objects.count() == before
    row.refresh_from_db()
    assert all(getattr(row, name) == value for name, value in values.items())


def test_the_coverage_is_that_of_the_grammar_that_is_left(tiny_world, tiny, annotator):
    production = tiny_world.grammar.productions.filter(nonterminal="Main").first()
    category = tiny_world.grammar.task_categories.get()
    before = category.commands_in_grammar
    delete(production, annotator, 1)
    import_generator("home", tiny)
    category.refresh_from_db()
    assert category.commands_in_grammar < before


def test_paraphrases_that_people_deleted_or_corrected_stay_so(generated, folder, annotator):  # noqa: F811
    import_pairs("home", "walker", folder)
    first, second = Paraphrase.objects.all()
    delete(first, annotator, 1)
    change(second, {"utterance": "where is my tea"}, annotator, 1)
    report = import_pairs("home", "walker", folder)
    assert (len(report.left_out), report.added) == (2, 0)
    assert Paraphrase.objects.get().utterance == "where is my tea"
    report = import_pairs("home", "walker", folder, annotator, brings_back=True)
    assert (len(report.left_out), report.added) == (1, 1)
    assert Paraphrase.objects.get(pk=first.pk).version == 2


def test_nothing_is_left_out_of_a_new_world(db, tiny):
    assert not import_generator("new", tiny).left_out
    assert Entity.objects.exists() and Production.objects.exists()
    assert SemanticTemplate.objects.exists()
