"""Patterns that no expansion gets through are answered soon, and with a sentence."""

import pytest

from annotations.language.grammar import Budget, Grammar, TooManyCombinations, read_productions
from annotations.language.templates import (
    TaskCategory,
    TemplateChart,
    TemplateExpander,
    generate,
    make_template,
    template_checker,
)
from annotations.language.texts.errors import LanguageError, Position
from annotations.language.world import infer_signatures
from tests.work import steps_of

GRAMMAR = Grammar(
    read_productions(
        "$Main = $verb the $thing | go to the {room}\n"
        "$verb = get | bring | take\n"
        "$thing = {kobject} | {aobject} | " + " | ".join(f"thing{n}" for n in range(200)) + "\n"
        "$lead = lead | guide\n"
        "$some = " + " | ".join(("a " * n).strip() or "{void}" for n in range(12)) + "\n"
        + "".join(f"$s{n} = $some\n" for n in range(10))
    ).productions
)  # fmt: skip
ENDLESS = [
    ("$Main $Main $Main $Main $Main", "(go $Main)"),
    ("(a|b) " * 60 + "| $lead", "(go $lead)"),
    ("(a|b) " * 10_000, "UNKNOWN"),
    ("(a|b) " * 400, "UNKNOWN"),
    ("$thing $thing $Main $thing", "(go $thing $Main $verb)"),
    ("$verb $lead", "(go $verb " + "$lead " * 700 + ")"),
]


@pytest.mark.parametrize(("pattern", "form"), ENDLESS)
def test_a_check_answers_endless_patterns_at_their_place(pattern, form):
    assert {problem.position.source for problem in check(pattern, form)} <= {"t.txt"}


@pytest.mark.parametrize(("pattern", "form"), ENDLESS)
def test_the_work_of_a_check_is_a_small_multiple_of_its_budget(pattern, form):
    budget = Budget(20_000)
    assert steps_of(lambda: check(pattern, form, budget)) < 25 * budget.steps


def check(pattern, form, budget=None):
    """The problems of a template, or the one for which it is no template."""
    try:
        template = make_template(pattern, form, Position("t.txt", 3))
        return template_checker(GRAMMAR, infer_signatures([])).problems(template, budget)
    except LanguageError as error:
        return (error.problem,)


def test_combinations_that_disagree_are_counted_and_reported_at_the_template():
    template = make_template("$Main $Main $Main $Main $Main", "(go $Main)", Position("t.txt", 3))
    (problem,) = [each for each in template_checker(GRAMMAR).problems(template) if each.is_error]
    assert str(problem.position) == "t.txt:3:1"
    assert problem.hint


def test_expansions_that_lack_a_slot_are_counted():
    template = make_template("(a|b) " * 60 + "| $lead", "(go $lead)")
    with pytest.raises(TooManyCombinations):
        list(TemplateExpander(GRAMMAR).pairs(template, Budget(50_000)))
    with pytest.raises(TooManyCombinations):
        list(TemplateExpander(GRAMMAR).derivations(template, budget=Budget(50_000)))


def test_a_pattern_of_too_many_words_is_refused_before_it_is_expanded():
    template = make_template("(a|b) " * 501, "UNKNOWN", Position("t.txt", 3))
    with pytest.raises(LanguageError, match=r"\b501\b"):
        TemplateExpander(GRAMMAR).size(template)
    (problem,) = template_checker(GRAMMAR).problems(template)
    assert problem.is_error and "501" in problem.message


def test_a_generation_spends_at_most_what_its_limit_allows():
    wide = make_template("$Main $Main", "(go $Main)")
    category = TaskCategory("1", GRAMMAR, (wide,))
    (left,) = generate([category], limit=1_000).left_out
    assert " 1,000" in left.problem.message
    long = make_template("(a|b) " * 9 + "long " * 450, "UNKNOWN")
    with pytest.raises(TooManyCombinations):
        generate([TaskCategory("1", GRAMMAR, (long,))], limit=600)
    assert len(generate([TaskCategory("1", GRAMMAR, (long,))]).expansions) == 512


def test_a_check_that_succeeds_says_the_same_as_without_a_budget():
    template = make_template("$verb the $thing", "($verb $thing)")
    checker = template_checker(GRAMMAR)
    assert checker.problems(template) == checker.problems(template, Budget())


def test_the_chart_keeps_two_readings_of_a_template_with_many():
    names = [f"$s{n}" for n in range(10)]
    endless = make_template(" ".join(names), f"(go {' '.join(names)})")
    plain = make_template("$some", "UNKNOWN")
    chart = TemplateChart([TaskCategory("1", GRAMMAR, (plain, endless))])
    assert [each.template_index for each in chart.parse("a " * 11)] == [1, 1, 0]
