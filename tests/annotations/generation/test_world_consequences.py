"""What saving a template would do is what saving it does."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from annotations.editing.edits import add, change
from annotations.exchange.generator_import import import_generator
from annotations.generation import kept_expansions
from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs
from annotations.generation.world_consequences import consequences
from annotations.language.templates import BoundedCache
from annotations.models import SemanticTemplate, TaskCategory
from annotations.models.description import TemplateStatus
from annotations.web.description.template_forms import change_to
from tests.annotations.conftest import as_bytes
from tests.annotations.generation.test_up_to_date import (
    FORMS,
    PATTERNS,
    TWO_CATEGORIES,
    commands_of,
)


@pytest.fixture
def two_categories(world):
    assert not import_generator(world.name, as_bytes(TWO_CATEGORIES)).is_refused
    generate_pairs(world)
    return world


def category(world, name):
    return TaskCategory.objects.get(grammar__world=world, name=name)


def values(pattern, form, status=TemplateStatus.READY):
    return {"pattern": pattern, "form": form, "status": status}


@settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    st.sampled_from(PATTERNS),
    st.sampled_from(FORMS),
    st.integers(0, 10),
    st.sampled_from(TemplateStatus),
)
def test_saving_does_what_was_said(two_categories, annotator, pattern, form, number, status):
    rows = list(SemanticTemplate.objects.filter(grammar__world=two_categories))
    row = rows[number % len(rows)] if number < 8 else None
    chosen = category(two_categories, "2")
    new = values(pattern, form, status)
    before = commands_of(two_categories)
    expected = consequences(two_categories, change_to(row, chosen, new))
    if row:
        change(row, new, annotator, row.version)
    else:
        add(SemanticTemplate.for_category(chosen, **new), annotator)
    after = commands_of(two_categories)
    assert {each.command for each in expected.changes.covered} == after.keys() - before.keys()
    assert {each.command for each in expected.changes.lost} == before.keys() - after.keys()
    assert {each.command: (each.before, each.after) for each in expected.changes.changed} == {
        command: (before[command], form)
        for command, form in after.items()
        if command in before and before[command] != form
    }


def test_looking_changes_nothing(two_categories, django_assert_max_num_queries):
    before = commands_of(two_categories)
    with django_assert_max_num_queries(12):
        expected = consequences(
            two_categories,
            change_to(None, category(two_categories, "2"), values("$go $fetch", "(go)")),
        )
    assert expected.sentence.startswith("4 ")
    assert commands_of(two_categories) == before
    assert SemanticTemplate.objects.filter(pattern="$go $fetch").count() == 0


def test_every_kind_is_counted(two_categories, annotator):
    chosen = category(two_categories, "2")
    expected = consequences(
        two_categories, change_to(None, chosen, values("($go|run) out", "(flee)"))
    )
    assert [each.command for each in expected.changes.changed] == ["go out", "drive out", "run out"]
    assert len(expected.changes.conflicts) == 3
    assert {expected.templates[each.template].form for each in expected.changes.shadowed} == {
        "(leave)",
        "(run)",
    }
    same = consequences(two_categories, change_to(None, chosen, values("$go out", "(leave)")))
    (duplicate,) = same.changes.duplicates
    assert expected.templates[duplicate.earlier].form == "(leave)"


def test_a_split_of_the_old_forms_becomes_stale_and_one_of_others_does_not(two_categories):
    split = freeze_split(two_categories, "all")
    row = SemanticTemplate.objects.get(form="(leave)")
    new = values(row.pattern, "(depart)")
    chosen = category(two_categories, "2")
    expected = consequences(two_categories, change_to(row, chosen, new))
    assert expected.splits.splits == (split,)
    assert len(expected.splits.splits) == 1 and "1 split" in expected.sentence
    other = consequences(two_categories, change_to(None, chosen, values("$go $fetch", "(go)")))
    assert other.splits.splits == ()


def test_a_world_too_large_to_compare_says_so(two_categories, monkeypatch):
    monkeypatch.setattr(kept_expansions, "_GENERATED", BoundedCache(0))
    monkeypatch.setattr(kept_expansions, "MOST_AT_ONCE", 3)
    new = values("$go $fetch", "(go)")
    expected = consequences(two_categories, change_to(None, category(two_categories, "2"), new))
    assert "up to" in expected.trouble and expected.changes.is_none
