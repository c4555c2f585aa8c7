"""The published generators of 2018 and 2019, imported whole."""

from __future__ import annotations

import pytest

from annotations.exchange.generator_import import import_generator
from annotations.models import World
from tests.annotations.rows_of import rows_of


def test_2018_imports_with_the_published_counts(db, shared_data):
    report = import_generator("gpsr2018", shared_data / "generator-2018")
    assert not report.is_refused
    assert report.templates == {"1": 28, "2": 53, "3": 44}
    assert report.productions == {
        "common_rules.txt": 61,
        "gpsr_category_1_grammar.txt": 12,
        "gpsr_category_2_grammar.txt": 25,
        "gpsr_category_3_grammar.txt": 51,
    }
    assert report.entities == {
        "object": 39,
        "category": 9,
        "location": 36,
        "room": 6,
        "name": 20,
        "gesture": 5,
        "question": 16,
        "whattosay": 5,
    }
    assert report.predicates == 38


def test_2018_composes_its_task_categories_as_published(db, shared_data):
    import_generator("gpsr2018", shared_data / "generator-2018")
    categories = World.objects.get(name="gpsr2018").grammar.task_categories.all()
    sets = {each.name: (each.rule_sources, each.template_sources) for each in categories}
    one, two, three = (f"gpsr_category_{number}_semantics.txt" for number in "123")
    assert sets == {
        "1": (["common_rules.txt", "gpsr_category_1_grammar.txt"], [one]),
        "2": (["common_rules.txt", "gpsr_category_2_grammar.txt"], [one, two]),
        "3": (["common_rules.txt", "gpsr_category_3_grammar.txt"], [three]),
    }


def test_2019_imports_with_every_production_and_its_problems_listed(db, shared_data):
    report = import_generator("gpsr2019", shared_data / "generator-2019")
    assert report.productions == {"common_rules.txt": 62, "gpsr.txt": 73, "egpsr.txt": 198}
    messages = {str(problem) for problem in report.problems}
    assert any(each.startswith("common_rules.txt:60:1: warning: $Main") for each in messages)
    assert World.objects.get(name="gpsr2019").problems.count() == len(report.problems)


@pytest.mark.parametrize("year", ["2018", "2019"])
def test_a_second_import_changes_no_row(db, shared_data, year, django_assert_max_num_queries):
    folder = shared_data / f"generator-{year}"
    import_generator("again", folder)
    before = rows_of(World.objects.get(name="again"))
    with django_assert_max_num_queries(40):
        report = import_generator("again", folder)
    assert rows_of(World.objects.get(name="again")) == before
    assert report.changes.as_json() == {"added": 0, "changed": 0, "removed": 0, "moved": 0}
