"""What a robot does in a world whose actions no recipe covers: a greenhouse."""

from __future__ import annotations

from dataclasses import replace

import jsonschema
import pytest

from annotations.language.forms import read_form
from annotations.language.plans import (
    ASK,
    Lookup,
    RecipeBook,
    apply_recipes,
    default_book,
    join,
    joint_plan_schema,
    make_plan,
    plan_schema,
    propose,
    read_book,
    shipped_books,
    spoken,
    task_plan_schema,
    to_behavior_tree,
    with_proposals,
)
from annotations.language.world import Predicate, PredicateKind, Signature, gloss
from tests.annotations.language.plans.worlds import shipped
from tests.annotations.language.plans.xml_schema import xml_schema
from tests.greenhouse import CLASSES, ONTOLOGY, PREDICATES

BOOK = with_proposals(default_book(), PREDICATES)
LOOKUP = Lookup(ONTOLOGY, PREDICATES)


def plan_of(form, book=BOOK):
    plan = make_plan(read_form(form), ONTOLOGY, PREDICATES, lookup=LOOKUP)
    return apply_recipes(plan, book)


def rows(book):
    return [*map(str, book.primitives)], [*map(str, book.recipes)]


def taken(book=BOOK):
    assert book.proposed
    primitives = (*book.primitives, *book.proposed.primitives)
    return RecipeBook(primitives, (*book.recipes, *book.proposed.recipes))


def test_each_action_has_one_primitive_with_its_slots_and_its_english():
    primitives, recipes = rows(BOOK.proposed)
    assert primitives == [
        'water(plant, bed?) "water {plant} | water {plant} in {bed}"',
        'prune(plant, tool?) "prune {plant} | prune {plant} with {tool}"',
        'scan_shelf(bed) "scan the shelf of {bed}"',
        'fetch(tool) "fetch you {tool}"',
        'measure(plant) "measure {plant}": learns "the height of {plant}"',
        'report(argument_1) "tell you {argument_1}"',
    ]
    assert "water(plant, bed) -> water(plant, bed)" in recipes
    assert "water(plant) -> water(plant)" in recipes and len(recipes) == 8


def test_what_is_proposed_are_rows_without_problems_and_nothing_more_is_proposed_then():
    book, problems = read_book(*("\n".join(each) for each in rows(taken())))
    assert book == taken() and not [each for each in problems if each.is_error]
    assert propose(book, PREDICATES) == RecipeBook()


@pytest.mark.parametrize("name", ["household", "competition"])
@pytest.mark.parametrize("book", shipped_books())
def test_nothing_is_proposed_where_a_book_that_ships_covers_a_world_that_ships(name, book):
    assert propose(shipped_books()[book].book, shipped(name).predicates) == RecipeBook()


@pytest.mark.parametrize(
    ("form", "said", "text"),
    [
        ('(water "basil")', "water the basil", "I will water the basil."),
        (
            '(water "basil" "last bed")',
            "water the basil in the last bed",
            "I will water the basil in the last bed.",
        ),
        ('(fetch "hose")', "fetch me the hose", "I will fetch you the hose."),
        (
            '(water (λ$1:e (grows $1 "basil") (stands_in $1 "last bed")))',
            "water the basil in the last bed",
            "I will water the basil in the last bed.",
        ),
        (
            '(sequence (prune "basil" "shears") (water it))',
            "prune the basil with the shears, then water it",
            "I will prune the basil with the shears and water it.",
        ),
        (
            '(report (measure "basil"))',
            "tell me the height of the basil",
            "I will measure the basil and tell you its height.",
        ),
    ],
)
def test_a_form_has_a_plan_a_sentence_and_a_tree_before_anybody_takes_a_recipe(form, said, text):
    plan = make_plan(read_form(form), ONTOLOGY, PREDICATES)
    assert gloss(read_form(form), PREDICATES, CLASSES, ONTOLOGY.class_of_text) == said
    assert not plan.problems and not plan.unresolved
    for book, is_proposed in ((BOOK, True), (taken(), False)):
        task = apply_recipes(plan, book)
        assert spoken(task) == text
        assert {each.is_proposed for each in task.steps} == {is_proposed}
        assert {each.code for each in task.problems} == ({"no_recipe"} if is_proposed else set())
        assert task.is_executable is not is_proposed
        assert ("is_proposed" in task.as_json()["steps"][0]) is is_proposed
        jsonschema.validate(plan.as_json(), plan_schema())
        jsonschema.validate(task.as_json(), task_plan_schema())
        xml_schema().validate(to_behavior_tree(task))


def test_arguments_are_called_by_their_classes():
    (step,) = plan_of('(water "basil" "last bed")').steps
    assert {name: each.text for name, each in step.arguments} == {
        "plant": "basil",
        "bed": "last bed",
    }


@pytest.mark.parametrize(
    ("form", "question"),
    [
        ("(water UNKNOWN)", "Which plant shall I water?"),
        ('(water " <plant> " "last bed")', "Which plant shall I water in the last bed?"),
        ('(water "basil" UNKNOWN)', "Which bed shall I water the basil in?"),
        ("(report UNKNOWN)", "What shall I tell you?"),
    ],
)
def test_what_is_open_is_asked_for(form, question):
    for book in (BOOK, taken()):
        plan = plan_of(form, book)
        first, second = plan.steps
        assert first.action == ASK and not first.is_proposed and second.requires == (1,)
        assert plan.unresolved[0].open[0].question == question


def test_nobody_knows_where_the_robot_is_after_what_nobody_has_described():
    plan = plan_of('(sequence (go "last bed") (prune "basil") (go "last bed"))')
    assert [(each.action, each.is_proposed) for each in plan.steps] == [
        ("go_to", False),
        ("prune", True),
        ("go_to", False),  # it may be elsewhere
    ]
    assert plan.steps[1].place is None and plan.steps[1].requires == (1,)
    assert plan.steps[2].requires == (2,)


@pytest.mark.parametrize("book", [BOOK, taken()])
def test_three_commands_have_one_plan(book):
    forms = ('(water "basil" "last bed")', '(prune "tomato" "shears")', '(scan_shelf "first bed")')
    joint = join([plan_of(each, book) for each in forms], book)
    jsonschema.validate(joint.as_json(), joint_plan_schema())
    actions = [each.action for each in joint.plan.steps]
    assert actions[:3] == ["water", "prune", "scan_shelf"]
    assert list(joint.serves[:3]) == [(1,), (2,), (3,)]
    xml_schema().validate(to_behavior_tree(joint.plan))
    assert "prune the tomato with the shears" in spoken(joint.plan)


def test_a_book_without_a_question_takes_that_of_the_book_that_ships():
    book = with_proposals(RecipeBook(), PREDICATES)
    assert (
        plan_of("(water UNKNOWN)", book).steps[0].action
        == default_book().recipes_of(ASK)[0].calls[0].primitive
    )


def test_a_recipe_may_number_what_has_a_name():
    book, _ = read_book("move(x)", "fetch(argument_1) -> move(argument_1)")
    plan = plan_of('(fetch "hose")', book)
    assert [each.action for each in plan.steps] == ["move"] and plan.is_executable


@pytest.mark.parametrize("name", ["Sequence", "go_to", "go-to", "größe", "a b", "1st", "tell"])
def test_any_name_of_an_action_is_proposed_or_left_out(name):
    signatures = (Signature(("plant",)), Signature(("plant", "plant")), Signature(("bed",)))
    predicate = Predicate(name, PredicateKind.ACTION, signatures, 'say "{1}" {')
    book = with_proposals(default_book(), {name: predicate})
    problems = taken(book).problems()
    assert not [each for each in problems if each.is_error]
    (step,) = apply_recipes(
        replace(make_plan(read_form('(water "basil")'), ONTOLOGY, PREDICATES)), book
    ).steps
    assert step.action == "water"


def test_arguments_that_are_no_first_ones_of_others_have_a_primitive_of_their_own():
    signatures = (Signature(("lambda", "room")), Signature(("lambda", "lambda")))
    bring = Predicate("bring", PredicateKind.ACTION, signatures)
    proposed = propose(RecipeBook(), {"bring": bring})
    calls = {str(each.pattern): each.calls[0].primitive for each in proposed.recipes[1:]}
    assert calls == {"bring(thing, source)": "bring", "bring(thing, recipient)": "bring_2"}
