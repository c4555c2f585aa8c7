"""docs/reference/recipes.md shows what the code does."""

from __future__ import annotations

import re
from pathlib import Path

from annotations.exchange.predicates_file import read_predicates
from annotations.language.forms import read_form
from annotations.language.plans import (
    EffectKind,
    RecipeTrouble,
    TaskPlan,
    apply_recipes,
    default_book,
    join,
    make_plan,
    read_primitive,
    read_recipe,
    spoken,
    usual_places,
)
from tests.annotations.language.ontology_files import read_ontology_folder

ROOT = Path(__file__).parents[4]
PAGE = (ROOT / "docs" / "reference" / "recipes.md").read_text("utf-8")
WORLD = ROOT / "annotations" / "starter" / "competition"
ONTOLOGY, _ = read_ontology_folder(WORLD)
PREDICATES = read_predicates((WORLD / "predicates.json").read_bytes(), classes=ONTOLOGY.classes)


def task_plan(form: str) -> TaskPlan:
    plan = make_plan(read_form(form), ONTOLOGY, PREDICATES)
    return apply_recipes(plan, default_book(), usual_places(ONTOLOGY))


def test_its_rows_are_those_of_the_book():
    fences = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    rows = (text.splitlines() for language, text in fences if language == "text")
    recipes, primitives, at_the_end, *_ = rows
    assert {read_recipe(each) for each in recipes + at_the_end} <= set(default_book().recipes)
    assert {read_primitive(each) for each in primitives} <= set(default_book().primitives)


def test_its_tables_have_every_effect_and_every_problem():
    rows = re.findall(r"^\| (`[^|]*`) \|", PAGE, re.MULTILINE)
    words = {word for row in rows for word in re.findall(r"`([\w]+)", row)}
    assert words >= {str(each) for each in (*EffectKind, *RecipeTrouble)}


def test_its_examples_are_what_comes_out():
    bring = '(bring (λ$1:e (is_a $1 "quince") (at $1 "larder")))'
    forms = (
        bring,
        '(say (count (λ$1:e (is_a $1 "drinks") (at $1 "larder"))))',
        '(greet (λ$1:e (person $1) (name $1 "Maria") (at $1 "piano")))',
    )
    assert spoken(task_plan(bring)) in PAGE
    joint = join([task_plan(form) for form in forms], default_book())
    for step, commands in zip(joint.plan.steps, joint.serves, strict=True):
        line = f"{step.number:2} {step.text:<38} for {' and '.join(map(str, commands))}"
        assert line in PAGE
    for each in joint.interleavings:
        assert each.message.removesuffix(".") in re.sub(r"\s+", " ", PAGE)
