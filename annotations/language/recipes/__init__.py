"""Recipes: from the actions of a form to the primitives of a team's own robot."""

from __future__ import annotations

from annotations.language.recipes.applying import apply_recipes
from annotations.language.recipes.book import (
    DEFAULT_BOOK,
    RecipeBook,
    ShippedBook,
    default_book,
    read_book,
    shipped_books,
)
from annotations.language.recipes.comparing import plan_key, same_plan
from annotations.language.recipes.habitual_places import UsualPlaces, usual_places
from annotations.language.recipes.joint_plans import (
    METRES,
    MOST_COMMANDS,
    Distances,
    Interleaving,
    JointPlan,
    Note,
    NoteKind,
    Reason,
    TooManyCommands,
    WrongDistance,
    join,
    joint_plan_schema,
    joint_plan_schema_text,
    say_length,
)
from annotations.language.recipes.reading import MAX_ROW, read_primitive, read_recipe
from annotations.language.recipes.rows import (
    AFTER_COMMANDS,
    ActionPattern,
    Effect,
    EffectKind,
    Primitive,
    Recipe,
)
from annotations.language.recipes.speaking import spoken
from annotations.language.recipes.task_plan import (
    RecipeTrouble,
    TaskPlan,
    TaskProblem,
    TaskStep,
    task_plan_schema,
    task_plan_schema_text,
)
from annotations.language.recipes.values import TaskValue

__all__ = [
    "AFTER_COMMANDS",
    "DEFAULT_BOOK",
    "MAX_ROW",
    "METRES",
    "MOST_COMMANDS",
    "ActionPattern",
    "Distances",
    "Effect",
    "EffectKind",
    "Interleaving",
    "JointPlan",
    "Note",
    "NoteKind",
    "Primitive",
    "Reason",
    "Recipe",
    "RecipeBook",
    "RecipeTrouble",
    "ShippedBook",
    "TaskPlan",
    "TaskProblem",
    "TaskStep",
    "TaskValue",
    "TooManyCommands",
    "UsualPlaces",
    "WrongDistance",
    "apply_recipes",
    "default_book",
    "join",
    "joint_plan_schema",
    "joint_plan_schema_text",
    "plan_key",
    "read_book",
    "read_primitive",
    "read_recipe",
    "same_plan",
    "say_length",
    "shipped_books",
    "spoken",
    "task_plan_schema",
    "task_plan_schema_text",
    "usual_places",
]
