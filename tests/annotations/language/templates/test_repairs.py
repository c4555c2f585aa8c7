"""Repairs of templates: what each kind of mistake is offered, and that taking an offer helps."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import DEFAULT_CLASSES, canonical_text, read_form
from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import (
    Sides,
    make_template,
    read_known_sides,
    read_sides,
    template_checker,
    usage_of,
    with_repairs,
)
from annotations.language.world import infer_signatures
from tests.annotations.language.published import SHARED, needs_corpus
from tests.annotations.language.templates.mistakes import mistakes, published_checkers, value_of

GRAMMAR = Grammar(
    read_productions(
        "$Main = $vbbring me the $object from the {placement 1} | $vbfind (someone | a person) in the {room}\n"
        "$vbbring = bring | give\n"
        "$vbfind = find | locate\n"
        "$object = {kobject} | {aobject}\n"
    ).productions
)
FORMS = (
    "(bring (λ$1:e (is_a $1 $object) (at $1 {placement 1})))",
    "(find (λ$1:e (person $1) (at $1 {room})))",
    '(go "kitchen")',
    '(bring (λ$1:e (is_a $1 "<object>")))',
)
PATTERNS = (
    "$vbbring me the $object from the {placement 1}",
    "$vbfind (someone | a person) in the {room}",
    "go to the kitchen",
    "$vbbring me the $object",
)
CHECKER = template_checker(GRAMMAR, infer_signatures(map(read_form, FORMS)), "1")
TEMPLATES = tuple(make_template(*sides) for sides in zip(PATTERNS, FORMS, strict=True))


def problems_of(sides: Sides):
    template, unread = read_known_sides(sides.pattern, sides.form, DEFAULT_CLASSES)
    return unread if template is None else CHECKER.problems(template)


def offered(sides: Sides):
    return with_repairs(problems_of(sides), sides, CHECKER)


@pytest.mark.parametrize(
    ("pattern", "form", "label", "mended"),
    [
        (0, "(brng (λ$1:e (is_a $1 $object) (at $1 {placement 1})))", "Write bring for brng", FORMS[0]),
        (0, "(bring (λ$1:e (is_a $1 $object (at $1 {placement 1})))", "Close the parenthesis after", FORMS[0]),
        (0, "(bring (λ$1:e (is_a $1 $object) (at $1 {placement 2})))", "Write {placement 1}", FORMS[0]),
        (0, "(bring (λ$1:e (is_a $object $1) (at $1 {placement 1})))", "Exchange $object and $1", FORMS[0]),
        (0, "(bring (λ$1:e (is_a $1 object) (at $1 {placement 1})))", "Write $object", FORMS[0]),
        (0, "(bring (lamda $1:e (is_a $1 $object) (at $1 {placement 1})))", "Write λ for lamda", FORMS[0]),
        (0, "(bring (λ$1 (is_a $1 $object) (at $1 {placement 1})))", "Give $1 the type e", FORMS[0]),
        (0, "(bring (λ$1:e (is_a $1, $object), (at $1, {placement 1})))", "Remove the commas", FORMS[0]),
        (0, "(bring (λ$1:e (is_a $1 $object) (at $1 {placment 1})))", "Write {placement}", FORMS[0]),
        (0, "(bring (λ$1:e (is_a $1 $object)) (at $1 {placement 1}))", "Close the λ later", FORMS[0]),
        (0, "(bring (is_a $1 $object) (at $1 {placement 1}))", "Put λ$1 around", FORMS[0]),
        (1, "(find (λ$1:e (person $2) (at $1 {room})))", "Write $1 for $2", FORMS[1]),
        (1, "(find (λ$1:e (person $1) (at $1 {room}))))", "Remove the )", FORMS[1]),
        (2, "(go kitchen)", 'Quote it: "kitchen"', FORMS[2]),
        (2, '(go "kitchen)', 'Close it: "kitchen"', FORMS[2]),
        (3, "(bring $object)", "(is_a $1 $object)", "(bring (λ$1:e (is_a $1 $object)))"),
        (3, "(bring (λ$1:e (is_a $1 <object>)))", 'Write "<object>"', FORMS[3]),
    ],
)  # fmt: skip
def test_a_mistake_in_a_form_is_offered_its_repair_first(pattern, form, label, mended):
    sides = Sides(PATTERNS[pattern], form)
    first = next(problem.repairs[0] for problem in offered(sides) if problem.repairs)
    assert label in first.label
    after = sides.after(first)
    assert canonical_text(read_form(after.form)) == canonical_text(read_form(mended))


@pytest.mark.parametrize(
    ("pattern", "label"),
    [
        ("$vbbrng me the $object from the {placement 1}", "Write $vbbring"),
        ("$vbbring me the $object from the {placment 1}", "Write {placement}"),
        ("$vbbring me the $object from the {placement 1", "Close it: {placement 1}"),
        ("$vbbring me teh $object from the {placement 1}", "Write “the” for “teh”"),
        ("$vbbring me the $objects from the {placement 1}", "Write $object"),
    ],
)
def test_a_mistake_in_a_pattern_is_offered_its_repair_first(pattern, label):
    sides = Sides(pattern, FORMS[0])
    first = next(problem.repairs[0] for problem in offered(sides) if problem.repairs)
    assert label in first.label
    assert sides.after(first) == Sides(PATTERNS[0], FORMS[0])


def test_a_choice_is_closed_where_the_grammar_has_it():
    sides = Sides("$vbfind (someone | a person in the {room}", FORMS[1])
    (problem,) = offered(sides)
    assert sides.after(problem.repairs[0]).pattern == PATTERNS[1]


def test_spaces_around_the_texts_do_not_shift_the_edits():
    sides = Sides(f"  {PATTERNS[0]} ", "  (brng (λ$1:e (is_a $1 $object) (at $1 {placement 1})))")
    (problem,) = offered(sides)
    assert sides.after(problem.repairs[0]) == Sides(f"  {PATTERNS[0]} ", f"  {FORMS[0]}")


def test_a_template_without_problems_is_offered_nothing():
    assert offered(Sides(PATTERNS[0], FORMS[0])) == ()


@pytest.mark.parametrize(
    ("form", "mended"),
    [
        ("(bring (λ$1:e (is_a $1 $object)))", FORMS[0]),
        ("(bring (λ$1:e (at $1 {placement 1})))", FORMS[0]),
        ("(bring (λ$1:e (and (is_a $1 $object))))", "(bring (λ$1:e (and (is_a $1 $object) (at $1 {placement 1}))))"),
    ],
)  # fmt: skip
def test_a_slot_that_the_form_leaves_out_goes_where_other_templates_have_it(form, mended):
    sides = Sides(PATTERNS[0], form)
    usage = usage_of(TEMPLATES, GRAMMAR)
    first = next(each for each in with_repairs(problems_of(sides), sides, CHECKER, lambda: usage))
    assert sides.after(first.repairs[0]).form == mended
    assert not any(
        problem.repairs for problem in offered(sides) if "leaves it out" in problem.message
    )


def test_a_slot_that_no_template_has_is_offered_no_place():
    sides = Sides("$vbfind (someone | a person) in the {room}", "(find (λ$1:e (person $1)))")
    usage = usage_of([TEMPLATES[0]], GRAMMAR)
    (problem,) = with_repairs(problems_of(sides), sides, CHECKER, lambda: usage)
    assert problem.repairs == ()


TYPED = st.text(st.sampled_from('()λ$1:e {}"<>|,room is_a\\'), max_size=12)


@given(st.sampled_from(TEMPLATES), st.data(), TYPED)
def test_taking_a_repair_removes_its_problem_and_brings_no_error(template, data, typed):
    """Somebody types anything anywhere over a template."""
    form = template.form_text
    start, end = sorted(data.draw(st.tuples(*[st.integers(0, len(form))] * 2)))
    sides = Sides(template.pattern_text, form[:start] + typed + form[min(end, start + 4) :])
    before = offered(sides)
    counts = Counter(problem.message for problem in before)
    for problem in before:
        for repair in problem.repairs:
            after = problems_of(sides.after(repair))
            assert (
                Counter(each.message for each in after)[problem.message] < counts[problem.message]
            )
            assert sum(each.is_error for each in after) <= sum(each.is_error for each in before)


@needs_corpus
def test_most_mistakes_in_the_published_templates_are_taken_back_by_a_repair():
    made = mended = 0
    published = list(published_checkers(SHARED / "generator-2018"))
    for checker, template in published[::12]:
        usage = usage_of([each for _, each in published if each is not template], checker.grammar)
        for number, (_, sides) in enumerate(mistakes(template)):
            wrong, unread = read_sides(sides.pattern, sides.form)
            if number % 3 or (wrong and value_of(wrong) == value_of(template)):
                continue
            problems = unread if wrong is None else checker.problems(wrong)
            repairs = [
                each
                for problem in with_repairs(problems, sides, checker, lambda: usage)  # noqa: B023
                for each in problem.repairs
            ]
            texts = [sides.after(each) for each in repairs]
            results = [read_sides(each.pattern, each.form)[0] for each in texts]
            made += 1
            mended += value_of(template) in [value_of(each) for each in results if each]
    assert mended / made > 0.9
