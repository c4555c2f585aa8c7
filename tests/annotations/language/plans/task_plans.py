"""Task plans of forms in the small ontology of the tests."""

from __future__ import annotations

from annotations.language.forms import read_form
from annotations.language.plans import RecipeBook, TaskPlan, apply_recipes, default_book, make_plan
from tests.annotations.language.sample_ontology import HOME


def task_plan(text: str, book: RecipeBook | None = None) -> TaskPlan:
    """Return the task plan of a form, by default with the book that a new world starts with."""
    return apply_recipes(make_plan(read_form(text), HOME), book or default_book())


def calls(plan: TaskPlan) -> list[str]:
    """Return the steps as ``go_to(attic)``; a description is its text without articles."""
    return [
        f"{step.primitive.name}({', '.join(word(value.as_json()) for _, value in step.arguments)})"
        for step in plan.steps
    ]


def word(value: dict) -> str:
    text = value.get("text") or value.get("step") or value.get("value") or value["kind"]
    return str(text).removeprefix("the ").removeprefix("person named ")


def codes(plan: TaskPlan) -> list[str]:
    return [each.code for each in plan.problems]
