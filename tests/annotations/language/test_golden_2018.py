"""What must come out of the 2018 generator with its templates."""

from collections import Counter
from itertools import chain

import pytest

from annotations.language.grammar import Recognizer
from annotations.language.templates import (
    TemplateChart,
    generate,
    read_generator_folder,
    set_problems,
)


@pytest.fixture(scope="module")
def folder(shared_data):
    return read_generator_folder(shared_data / "generator-2018")


@pytest.fixture(scope="module")
def categories(folder):
    return folder.categories()


@pytest.fixture(scope="module")
def generated(categories):
    return generate(categories)


@pytest.fixture(scope="module")
def published(shared_data):
    """Every generated pair that was published, as (command, form)."""
    pairs = []
    for part in ("gen/train", "gen/val", "gen_logical/train", "gen_logical/val"):
        lines = (shared_data / "walker2019" / f"{part}.txt").read_text("utf-8").splitlines()
        pairs.extend(zip(lines[::2], lines[1::2], strict=True))
    return pairs


def first_categories(generated):
    """Form → the first task category that has it."""
    category_of = {}
    for each in generated.expansions:
        category_of.setdefault(each.form_text, each.task_category)
    return category_of


def rounded_mean(lengths):
    lengths = list(lengths)
    return round(sum(lengths) / len(lengths), 2)


def test_production_lines(folder):
    counts = {name: len(file.productions) for name, file in folder.grammars.files.items()}
    assert counts == {
        "common_rules.txt": 61,
        "gpsr_category_1_grammar.txt": 12,
        "gpsr_category_2_grammar.txt": 25,
        "gpsr_category_3_grammar.txt": 51,
    }


def test_names_and_tiers(folder):
    files = folder.grammars.files
    tiers = [
        (files[each.grammar_file].name, files[each.grammar_file].tier)
        for each in folder.compositions
    ]
    assert tiers == [("Category I", "Easy"), ("Category II", "Moderate"), ("Category III", "High")]


def test_only_warnings_come_up(folder, categories, generated):
    problems = (*folder.problems, *set_problems(categories, generated))
    assert not any(problem.is_error for problem in problems)
    assert {problem.message.split(",")[0] for problem in folder.problems} >= {
        "nothing defines $pose",
        "nothing defines $pgenders",
    }
    assert sum("duplicate of" in problem.message for problem in problems) == 3


def test_template_lines(folder, categories):
    assert [len(templates) for _, templates in sorted(folder.templates.items())] == [28, 53, 44]
    assert [len(category.templates) for category in categories] == [28, 81, 44]
    everything = [template for file in folder.templates.values() for template in file]
    assert (len(everything), len(set(everything))) == (125, 122)


def test_commands_by_category(generated):
    assert Counter(each.task_category for each in generated.expansions) == {
        "1": 192,
        "2": 352,
        "3": 667,
    }


def test_forms_by_category(generated):
    assert Counter(first_categories(generated).values()) == {"1": 17, "2": 39, "3": 45}


def test_commands_outside_the_grammar(generated, categories):
    assert len(generated.outside_grammar) == 45
    recognizers = [Recognizer(category.grammar) for category in categories]
    covered = [
        each for each in generated.expansions if any(r.accepts(each.command) for r in recognizers)
    ]
    assert len(covered) == 1166


def test_conflicts_inside_the_sets(generated):
    assert Counter(each.task_category for each in generated.conflicts) == {"2": 3, "3": 5}


def test_one_template_matches_nothing_and_still_makes_a_command(generated, categories):
    ((name, index),) = generated.unmatched
    (category,) = (each for each in categories if each.name == name)
    text = category.templates[index].pattern_text
    assert text == "Tell me the gender of the person at the {room}"
    assert any(
        (each.task_category, each.template_index) == (name, index) for each in generated.expansions
    )


def test_mean_lengths_of_commands(generated):
    lengths = {name: [] for name in "123"}
    for each in generated.expansions:
        lengths[each.task_category].append(len(each.command.split()))
    assert [rounded_mean(counts) for counts in lengths.values()] == [11.92, 11.96, 10.40]
    assert rounded_mean(chain.from_iterable(lengths.values())) == 11.09


def test_mean_lengths_of_distinct_forms(generated):
    lengths = {name: [] for name in "123"}
    for form, name in first_categories(generated).items():
        lengths[name].append(len(form.split()))
    assert [rounded_mean(counts) for counts in lengths.values()] == [28.35, 26.97, 22.58]
    assert rounded_mean(chain.from_iterable(lengths.values())) == 25.25


def test_share_of_tokens_that_are_no_content(generated):
    tokens = [token for form in first_categories(generated) for token in form.split()]
    marks = sum(token in ("(", ")", '"', "e") for token in tokens)
    assert round(100 * marks / len(tokens), 2) == 57.96


def test_every_published_pair_is_generated_with_the_same_form(generated, published):
    forms = {each.command: each.form_text for each in generated.expansions}
    assert len(published) == 847 + 121 + 850 + 129
    assert [pair for pair in published if forms.get(pair[0]) != pair[1]] == []


def test_the_chart_parses_every_published_command_to_its_form(categories, published):
    chart = TemplateChart(categories)
    assert [pair for pair in published if chart.parse(pair[0])[0].form_text != pair[1]] == []
