from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.exchange.predicates_file import read_predicates
from annotations.language.forms import read_form
from annotations.language.plans import (
    AFTER_COMMANDS,
    ASK,
    EffectKind,
    Lookup,
    Plan,
    RecipeBook,
    RecipeTrouble,
    TaskPlan,
    apply_recipes,
    default_book,
    join,
    make_plan,
    plan_schema,
    read_book,
    shipped_books,
    spoken,
    task_plan_schema,
    to_behavior_tree,
    usual_places,
)
from annotations.language.plans.situation import Situation
from annotations.language.templates import (
    Balance,
    Language,
    SampleRequest,
    generate,
    read_generator_files,
)
from annotations.language.texts import ARGUMENT_NAMES
from annotations.language.texts.decoding import read_folder
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.plans.task_plans import calls, codes, task_plan
from tests.annotations.language.plans.xml_schema import xml_schema
from tests.annotations.language.published import SHARED
from tests.annotations.language.random_commands import commands
from tests.annotations.language.random_forms import forms
from tests.annotations.language.sample_ontology import HOME

JSON_SCHEMA = jsonschema.Draft202012Validator(task_plan_schema())
STARTER = Path(__file__).parents[4] / "annotations" / "starter"
WORLDS = {
    "household": STARTER / "household",
    "competition": STARTER / "competition",
    "generator-2018": SHARED / "generator-2018",
}

TEA = '(λ$1:e (is_a $1 "tea") (at $1 "attic"))'
ADA = '(λ$1:e (person $1) (name $1 "Ada") (at $1 "stool"))'


def require_valid(plan: TaskPlan) -> None:
    JSON_SCHEMA.validate(plan.as_json())
    xml_schema().validate(to_behavior_tree(plan))


@pytest.mark.parametrize(
    ("form", "steps"),
    [
        ('(go "attic")', "go_to(attic)"),
        (
            f"(bring {TEA})",
            "go_to(attic) find_object(tea) pick_up(tea) go_to(operator) give(tea, operator)",
        ),
        (
            f"(sequence (take {TEA}) (bring it {ADA}))",
            "go_to(attic) find_object(tea) pick_up(tea) go_to(stool) find_person(Ada) give(tea, Ada)",
        ),
        (
            f'(sequence (find {ADA}) (say "a joke" them) (follow them))',
            "go_to(stool) find_person(Ada) say(a joke, Ada) follow(Ada)",
        ),
        (
            '(say (count (λ$1:e (is_a $1 "drinks") (at $1 "stool"))))',
            "go_to(stool) count(drinks) go_to(operator) say(2, operator)",
        ),
        (
            f'(say (answer "What is up?") {ADA})',
            "go_to(stool) find_person(Ada) answer(What is up?, Ada)",
        ),
        (
            '(say (λ$1:e (λ$2:e (person $2) (name $2 $1) (at $2 "attic"))) (λ$3:e (person $3) (at $3 "stool")))',
            "go_to(attic) find_person(person) get_person_info(person, name) "
            "go_to(stool) find_person(person) say(3, person)",
        ),
        (
            f'(sequence (put {TEA} "stool") (go "tea room") (bring it))',
            "go_to(attic) find_object(tea) pick_up(tea) go_to(stool) place(tea, stool) "
            "go_to(tea room) go_to(stool) find_object(tea) pick_up(tea) go_to(operator) "
            "give(tea, operator)",
        ),
        (
            f'(sequence (guide {ADA} "attic") (go "tea room") (greet them))',
            "go_to(stool) find_person(Ada) guide(Ada, attic) go_to(tea room) go_to(attic) "
            "find_person(Ada) greet(Ada)",
        ),
        (
            f"(sequence (follow {ADA}) (greet them))",
            "go_to(stool) find_person(Ada) follow(Ada) greet(Ada)",
        ),
        (
            f'(sequence (follow {ADA}) (guide them "current"))',
            "go_to(stool) find_person(Ada) follow(Ada) guide(Ada, operator)",
        ),
        ('(sequence (go "attic") (say "a joke"))', "go_to(attic) say(a joke)"),
    ],
)
def test_an_action_becomes_the_primitives_of_its_recipe(form, steps):
    plan = task_plan(form)
    assert " ".join(calls(plan)) == steps
    assert plan.is_executable
    require_valid(plan)


def test_a_step_says_where_it_is_what_it_holds_and_what_it_requires():
    plan = task_plan(f"(bring {TEA} {ADA})").as_json()
    rows = [
        tuple((step[name] or {}).get("text") for name in ("place", "holds", "releases"))
        for step in plan["steps"]
    ]
    assert rows == [
        ("attic", None, None),
        ("attic", None, None),
        ("attic", "the tea", None),
        ("stool", "the tea", None),
        ("stool", "the tea", None),
        ("stool", None, "the tea"),
    ]
    assert [step["requires"] for step in plan["steps"]] == [[], [1], [1, 2], [3], [4], [3, 4, 5]]
    assert {step["source"] for step in plan["steps"]} == {1}


def test_the_most_specific_recipe_is_used_and_then_the_first():
    book, problems = read_book(
        "one(x)\ntwo(x)\nthree(x)",
        "go(destination) -> one(destination)\n"
        "go(destination: room) -> two(destination)\ngo(destination: place) -> three(destination)",
    )
    assert not problems
    assert calls(task_plan('(go "attic")', book)) == ["two(attic)"]
    assert calls(task_plan('(go "stool")', book)) == ["three(stool)"]
    assert calls(task_plan('(go "moon")', book)) == ["one(moon)"]


def test_an_action_without_a_recipe_stays_and_is_a_problem():
    book, _ = read_book("go_to(place): moves to place", "go(destination) -> go_to(destination)")
    plan = task_plan(f'(sequence (go "attic") (find {ADA}))', book)
    assert calls(plan)[0] == "go_to(attic)" and plan.steps[1].action == "find"
    assert [(each.code, each.step) for each in plan.problems] == [(RecipeTrouble.NO_RECIPE, 2)]
    require_valid(plan)


def test_a_recipe_that_gives_no_result_is_a_problem_where_one_is_used():
    book, _ = read_book(
        "count(x)\nsay(x)", "count(things) -> count(things)\nsay(text) -> say(text)"
    )
    assert codes(task_plan(f"(say (count {TEA}))", book)) == [RecipeTrouble.NO_RESULT]


@pytest.mark.parametrize(
    ("form", "code"),
    [
        (f'(sequence (take {TEA}) (take (λ$1:e (is_a $1 "knife"))))', RecipeTrouble.HANDS_FULL),
        (
            f'(sequence (follow {ADA}) (go "attic") (greet them))',
            RecipeTrouble.UNKNOWN_PLACE,
        ),
    ],
)
def test_what_the_command_cannot_have_is_a_problem_at_its_step(form, code):
    plan = task_plan(form)
    (problem,) = plan.problems
    assert problem.code == code
    assert 1 < problem.step <= len(plan.steps)
    require_valid(plan)


def test_questions_come_first_while_the_robot_is_with_the_operator():
    plan = task_plan(f'(sequence (go "attic") (bring UNKNOWN {ADA}) (guide {ADA} UNKNOWN))')
    assert [step.action == "ask_operator" for step in plan.steps[:3]] == [True, True, False]
    assert [each.step for each in plan.problems] == [4, 9]
    asked = [each for step in plan.as_json()["steps"] for each in step["arguments"].values()]
    assert [each["step"] for each in asked if each["kind"] == "result"] == [1, 1, 1, 2]


@pytest.mark.parametrize(
    ("form", "places"),
    [
        ('(bring (λ$1:e (is_a $1 "tea")))', ["shelf", "operator"]),
        ('(bring (λ$1:e (is_a $1 "drinks")))', ["shelf", "operator"]),
        ('(bring "tea")', ["shelf", "operator"]),
        ('(bring (λ$1:e (is_a $1 "knife")))', []),
        (f"(bring {TEA})", ["attic", "operator"]),
        (
            '(sequence (go "stool") (find (λ$1:e (is_a $1 "tea"))) (bring it))',
            ["stool", "operator"],
        ),
        (
            f'(sequence (find {ADA}) (bring (λ$1:e (is_a $1 "tea")) them))',
            ["stool", "shelf", "stool"],
        ),
    ],
)
def test_what_has_no_place_is_looked_for_where_the_robot_is_sent_or_where_it_usually_is(
    form, places
):
    plan = apply_recipes(make_plan(read_form(form), HOME), default_book(), drinks_on_the_shelf())
    assert places_of(plan) == places


A_TEA, TEA_THERE = (
    '(find (λ$1:e (is_a $1 "tea")))',
    '(find (λ$1:e (is_a $1 "tea") (at $1 "attic")))',
)


@pytest.mark.parametrize(
    ("forms", "places"),
    [
        (['(go "attic")', A_TEA], ["attic", "operator"]),
        (['(go "attic")', '(bring (λ$1:e (is_a $1 "tea")))'], ["attic", "operator"]),
        (['(go "attic")', '(bring (λ$1:e (is_a $1 "drink")))'], ["attic", "operator"]),
        (['(sequence (go "stool") (go "attic"))', A_TEA], ["stool", "attic", "operator"]),
        (['(go "stool")', TEA_THERE], ["stool", "attic", "operator"]),
        ([TEA_THERE, '(go "stool")'], ["attic", "stool", "operator"]),
        ([A_TEA, '(go "attic")'], ["shelf", "attic", "operator"]),
        (
            ['(go "attic")', f"(sequence {A_TEA} (bring it))", A_TEA],
            ["attic", "operator", "shelf", "operator"],
        ),
        (['(go "attic")', "(bring UNKNOWN)"], ["attic", "operator"]),
    ],
)
def test_a_command_after_one_to_go_somewhere_looks_there(forms, places):
    usual, plans = drinks_on_the_shelf(), []
    for form in forms:
        sent_to = plans[-1].sends_to if plans else None
        plan = make_plan(read_form(form), HOME)
        plans.append(apply_recipes(plan, default_book(), usual, sent_to))
    assert sorted(set(places_of(join(plans, default_book()).plan))) == sorted(set(places))
    if len(forms) == 2:
        assert places_of(join(plans, default_book()).plan) == places


@pytest.mark.parametrize("noun", ["drinks", "drink", "Drink"])
def test_any_of_a_category_is_looked_for_where_its_things_usually_are(noun):
    form = read_form(f'(bring (λ$1:e (is_a $1 "{noun}")))')
    plan = apply_recipes(make_plan(form, HOME), default_book(), drinks_on_the_shelf())
    assert places_of(plan) == ["shelf", "operator"]


def drinks_on_the_shelf():
    entities = [
        replace(each, attributes={"defaultLocation": "shelf"}) if each.text == "drinks" else each
        for each in HOME.entities
    ]
    return usual_places(replace(HOME, entities=tuple(entities)))


def places_of(plan):
    return [call[6:-1] for call in calls(plan) if call.startswith("go_to")]


@given(commands())
def test_every_command_has_consistent_effects(text):
    plan = task_plan(text)
    require_valid(plan)
    reported = {(each.code, each.step) for each in plan.problems}
    held = None
    for number, step in enumerate(plan.steps, start=1):
        assert step.number == number
        assert all(0 < each < number for each in step.requires)
        values = dict(step.arguments)
        if effect := step.primitive.effect(EffectKind.TAKES):
            assert held is None or (RecipeTrouble.HANDS_FULL, number) in reported
            held = values[effect.subject]
        if effect := step.primitive.effect(EffectKind.RELEASES):
            assert (
                held == values[effect.subject] == step.releases
                or (
                    RecipeTrouble.NOT_HELD,
                    number,
                )
                in reported
            )
            held = None
        assert step.holds == held
    spoken(plan)


@given(commands())
def test_doing_a_task_plan_again_leaves_nothing_out_and_adds_nothing(text):
    plan = task_plan(text)
    situation = Situation()
    for step in plan.steps:
        assert situation.add(step.primitive, dict(step.arguments), step.source) == step


@given(commands())
def test_no_two_equal_moves_follow_each_other(text):
    steps = task_plan(text).steps
    for one, next_one in pairwise(steps):
        if one.primitive.name == next_one.primitive.name == "go_to":
            assert one.arguments != next_one.arguments


@given(commands())
def test_the_second_book_does_the_same(text):
    one, other = task_plan(text), task_plan(text, shipped_books()["behavior_tree"].book)
    require_valid(other)
    assert [each.requires for each in one.steps] == [each.requires for each in other.steps]
    assert spoken(one) == spoken(other)


@given(forms())
def test_every_form_has_a_task_plan(form):
    require_valid(apply_recipes(make_plan(form, HOME), default_book()))


@cache
def plans_of(world: str) -> tuple[tuple[str, Plan], ...]:
    """The plans of all forms of a world, of a balanced sample where they are too many; slots have entities."""
    folder = WORLDS[world]
    ontology, _ = read_ontology_folder(folder)
    categories = read_generator_files(read_folder(folder, "*.txt"), ontology.classes).categories()
    if world == "competition":
        request = SampleRequest(1_000, balance=Balance.FORMS)
        generated = Language(categories).sample(request).generated
    else:
        generated = generate(categories)
    file = folder / "predicates.json"
    predicates = (
        read_predicates(file.read_bytes(), classes=ontology.classes) if file.is_file() else {}
    )
    lookup = Lookup(ontology, predicates)
    return tuple(
        (text, make_plan(read_form(grounded(text, ontology)), ontology, predicates, lookup=lookup))
        for text in sorted({each.form_text for each in generated.expansions})
    )


def grounded(form: str, ontology) -> str:
    for each in ontology.classes:
        texts = [entity.text for entity in ontology.entities if entity.entity_class == each.token]
        while f"<{each.token}" in form and texts:
            before, _, after = form.partition(f"<{each.token}")
            form = f"{before}{texts[len(before) % len(texts)]}{after.partition('>')[2]}"
    return form


@pytest.mark.parametrize("book", shipped_books())
@pytest.mark.parametrize("world", WORLDS)
def test_every_form_of_the_worlds_has_a_recipe_for_each_action(world, book):
    if not WORLDS[world].is_dir():
        pytest.skip(f"there is no {WORLDS[world]}")
    own = {str(code) for code in RecipeTrouble} - {RecipeTrouble.UNKNOWN_PLACE}
    for form, plan in plans_of(world):
        task = apply_recipes(plan, shipped_books()[book].book)
        assert not own & set(codes(task)), form
        asks = sum(step.predicate == ASK for step in plan.steps)
        assert task.steps and task.is_executable == plan.is_executable, form
        assert {step.source for step in task.steps} >= set(range(1, asks + 1)), form
    require_valid(task)


ARGUMENTS = ("thing", "person", "place of thing", "place of person", "operator", '"x"', "thing")
EFFECTS = (
    *("moves to a", "finds a", "takes a", "releases a", "releases a at b", "releases b to a"),
    *("accompanies a", "accompanies a to b", "learns", "speaks", "speaks to b", "acts on b"),
)


@st.composite
def books(draw: st.DrawFn) -> RecipeBook:
    """A book of odd primitives, some of which a recipe uses in any order with any arguments."""
    rows = []
    for number in range(4):
        effects = draw(
            st.lists(st.sampled_from(EFFECTS), max_size=2, unique_by=lambda e: e.split()[0])
        )
        rows.append(f"p{number}(a?, b?): {', '.join(effects)}" if effects else f"p{number}(a?, b?)")
    recipes = []
    for left in ("bring(thing)", "bring(thing, person: recipient)", "take(thing)", "find(target)"):
        names = [each for each in ARGUMENTS if "person" not in each]
        calls = draw(
            st.lists(st.tuples(st.integers(0, 3), st.lists(st.sampled_from(names), max_size=2)))
        )
        text = " ".join(f"p{number}({', '.join(values)})" for number, values in calls) or "p0()"
        if "target" in left:
            text = text.replace("thing", "target")
        recipes.append(f"{left} -> {text}")
    book, _ = read_book("\n".join(rows), "\n".join(recipes))
    return book


@given(books(), st.lists(commands(), min_size=1, max_size=2))
def test_any_book_makes_task_plans(book, texts):
    plans = [task_plan(text, book) for text in texts]
    for plan in plans:
        JSON_SCHEMA.validate(plan.as_json())
        assert all(each.step <= len(plan.steps) for each in plan.problems)
        spoken(plan)
    joint = join(plans, book)
    assert len(joint.serves) == len(joint.plan.steps)


def test_a_book_has_a_recipe_for_each_action_whose_arguments_have_names():
    for shipped in shipped_books().values():
        actions = {each.pattern.action for each in shipped.book.recipes}
        assert actions == {*ARGUMENT_NAMES, ASK, AFTER_COMMANDS}
        assert not shipped.book.problems(actions - {AFTER_COMMANDS})
        assert not shipped.book.problems()


def test_a_recipe_with_an_error_is_not_used():
    book, problems = read_book(
        "go_to(place)", "go(destination) -> go_to()\ngo(destination: room) -> fly()"
    )
    assert len(problems) == 2
    assert codes(task_plan('(go "attic")', book)) == [RecipeTrouble.NO_RECIPE]


def test_the_schema_of_task_plans_has_the_values_of_plans():
    ours, theirs = task_plan_schema()["$defs"], plan_schema()["$defs"]
    own = {"operator", "value_or_null"}
    assert ours.keys() - theirs.keys() == own and theirs.keys() - ours.keys() == {"said"}
    for name in theirs.keys() - {"step", "problem", "said", "value"}:
        without = dict(theirs[name]["properties"]) if "properties" in theirs[name] else {}
        without.pop("said", None)
        assert ours[name].get("properties", {}) == without, name
    codes_of_plan = theirs["problem"]["properties"]["code"]["enum"]
    assert ours["problem"]["properties"]["code"]["enum"] == [
        *codes_of_plan,
        *map(str, RecipeTrouble),
    ]
    refs = [each["$ref"] for each in theirs["value"]["oneOf"]]
    assert [each["$ref"] for each in ours["value"]["oneOf"]] == [*refs, "#/$defs/operator"]


def test_the_behaviour_tree_has_the_nodes_of_the_book():
    plan = task_plan(f"(bring {TEA})", shipped_books()["behavior_tree"].book)
    tree = to_behavior_tree(plan)
    assert '<Action ID="MoveTo" name="4 come back to you" goal="operator"' in tree
