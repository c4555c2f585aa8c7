"""What is wrong with a row of a recipe book, and what it does for a command of its world."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import reduce
from operator import or_
from typing import TypeAlias

from django.db.models import Exists, OuterRef, Q, Subquery

from annotations.language.forms import CLASS_TOKEN, read_form, to_corpus
from annotations.language.grounding import Anonymizer, deanonymize
from annotations.language.plans import (
    Lookup,
    Plan,
    RecipeBook,
    TaskPlan,
    apply_recipes,
    arguments_by_action,
    make_plan,
    plan_key,
    read_primitive,
    read_recipe,
    spoken,
    usual_places,
)
from annotations.language.texts import LanguageError, Position, Problem, error_at, say_count
from annotations.language.world import Ontology, gloss
from annotations.models import Command, Primitive, Recipe, World
from annotations.rows.from_rows import classes_of, ontology_of, predicates_of

FIELD = "text"  # what positions in the row call it
MOST_TRIED = 60  # forms that are looked at for examples
MOST_OFFERED = 8  # of them to choose from

BookRow: TypeAlias = Primitive | Recipe
RowModel: TypeAlias = type[Primitive] | type[Recipe]


@dataclass(frozen=True, slots=True)
class RecipeExample:
    """A command of the world with entities in it, its form, and what the robot does."""

    command: str
    english: str
    form: str
    task_plan: TaskPlan
    spoken: str


@dataclass(frozen=True, slots=True)
class CheckedRow:
    """What the checker says of a row; positions are those in its text.

    ``commands`` are anonymized commands of the world that use the row; the ``example`` is of the ``chosen`` one.
    """

    problems: tuple[Problem, ...]
    commands: tuple[str, ...] = ()
    chosen: str = ""
    example: RecipeExample | None = None

    @property
    def error(self) -> Problem | None:
        """The first thing that keeps the row from being stored."""
        return next((each for each in self.problems if each.is_error), None)


def check_row(
    world: World, model: RowModel, text: str, replaced: BookRow | None = None
) -> CheckedRow:
    """Return what is wrong with a row that has this text, as a new one or in place of ``replaced``."""
    try:
        book = _book_with(world, model, text, replaced)
    except LanguageError as error:
        return CheckedRow((error.problem,))
    actions = {*world.predicates.filter(kind="action").values_list("name", flat=True)}
    arguments = arguments_by_action(predicates_of(world))
    found = book.problems(actions or None, classes_of(world).tokens, arguments)
    problems = [each for each in found if each.position.source == FIELD]
    if replaced is not None:
        known = set(_book_with(world, model, replaced.text, replaced).problems())
        broken = [each for each in found if each.is_error and each not in known]
        elsewhere = [each for each in broken if each.position.source != FIELD]
        if elsewhere:
            rows = say_count(len({each.position.source for each in elsewhere}), "recipe")
            message = f"{rows} would not work any more: {elsewhere[0].message}"
            problems.append(error_at(Position(FIELD), message, "change the recipes first"))
    return CheckedRow(tuple(problems))


def try_row(
    world: World,
    model: RowModel,
    text: str,
    replaced: BookRow | None = None,
    command: str = "",
) -> CheckedRow:
    """Return what ``check_row`` does, with an example: of ``command`` if that uses the row, else of another."""
    checked = check_row(world, model, text, replaced)
    if checked.error:
        return checked
    examples = _Examples(world, _book_with(world, model, text, replaced))
    # Those that a robot can do without asking anybody come first.
    users = sorted(examples.using(_without(examples.book, model)), key=lambda each: not each[2])
    forms = {name: form for name, form, _ in users[:MOST_OFFERED]}
    if not forms:
        return checked
    commands = tuple(forms)
    chosen = command if command in commands else commands[0]
    return CheckedRow(checked.problems, commands, chosen, examples.of(chosen, forms[chosen]))


def problems_by_row(world: World) -> Mapping[tuple[str, int], list[Problem]]:
    """Return (kind, key) → what is wrong with the row. What can be read is checked against all the rest."""
    problems: dict[tuple[str, int], list[Problem]] = defaultdict(list)
    readable: dict[str, list[object]] = {}
    for kind, rows, read in (
        ("primitive", world.primitives.all(), read_primitive),
        ("recipe", world.recipes.all(), read_recipe),
    ):
        readable[kind] = []
        for row in rows:
            try:
                readable[kind].append(read(row.text, Position(f"{kind} {row.pk}")))
            except LanguageError as error:
                problems[kind, row.pk].append(error.problem)
    book = RecipeBook(tuple(readable["primitive"]), tuple(readable["recipe"]))  # type: ignore[arg-type]  # by kind
    arguments = arguments_by_action(predicates_of(world))
    for problem in book.problems(classes=classes_of(world).tokens, arguments=arguments):
        kind, key = problem.position.source.split()
        problems[kind, int(key)].append(problem)
    return problems


def users_of(row: Primitive) -> list[Recipe]:
    """Return the recipes that use a primitive."""
    return [
        recipe
        for recipe in row.world.recipes.filter(text__contains=row.name)
        if any(call.primitive == row.name for call in read_recipe(recipe.text).calls)
    ]


def why_primitive_is_kept(row: Primitive) -> str:
    """Return a sentence that says why the primitive cannot be deleted; empty where it can."""
    count = len(users_of(row))
    if not count:
        return ""
    return (
        f"{say_count(count, 'recipe')} of this world use {row.name}. Change or delete them first."
    )


def _book_with(world: World, model: RowModel, text: str, replaced: BookRow | None) -> RecipeBook:
    """Return the book of the world with the text as its last row, whose positions name ``FIELD``.

    Those of the other rows name their keys. Raises LanguageError where a text cannot be read.
    """
    place = Position(FIELD)
    primitives = tuple(
        read_primitive(row.text, Position(str(row.pk)))
        for row in world.primitives.all()
        if row != replaced
    )
    recipes = tuple(
        read_recipe(row.text, Position(str(row.pk)))
        for row in world.recipes.all()
        if row != replaced
    )
    if model is Primitive:
        return RecipeBook((*primitives, read_primitive(text, place)), recipes)
    return RecipeBook(primitives, (*recipes, read_recipe(text, place)))


def _without(book: RecipeBook, model: RowModel) -> RecipeBook:
    """Return the book without its last row of this kind."""
    if model is Primitive:
        return RecipeBook(book.primitives[:-1], book.recipes)
    return RecipeBook(book.primitives, book.recipes[:-1])


class _Examples:
    """Commands of a world with entities in them, and their plans by a book."""

    def __init__(self, world: World, book: RecipeBook) -> None:
        self.book = book
        self._world = world
        self._ontology = ontology_of(world)
        self._predicates = predicates_of(world)
        self._lookup = Lookup(self._ontology, self._predicates)
        self._anonymizer = Anonymizer(self._ontology)
        self._usual = usual_places(self._ontology, self._lookup)

    def using(self, other: RecipeBook) -> Iterator[tuple[str, str, bool]]:
        """Yield the commands whose task plans are others with the book ``other``, with their forms, and whether a
        robot can do them."""
        for command, form in self._commands(self._actions(other)):
            _, plan, _ = self._grounded(command, form)
            task_plan = self._apply(plan, self.book)
            if plan_key(task_plan) != plan_key(self._apply(plan, other)):
                yield command, form, task_plan.is_executable

    def of(self, command: str, form: str) -> RecipeExample:
        """Return the example of a command, which has this form."""
        said, plan, grounded = self._grounded(command, form)
        task_plan = self._apply(plan, self.book)
        ontology = self._ontology
        named = ontology.class_of_text
        english = gloss(read_form(grounded), self._predicates, ontology.classes, named)
        return RecipeExample(said, english, grounded, task_plan, spoken(task_plan))

    def _apply(self, plan: Plan, book: RecipeBook) -> TaskPlan:
        return apply_recipes(plan, book, self._usual)

    def _actions(self, other: RecipeBook) -> set[str]:
        """Return the actions whose recipes can be done otherwise with the book ``other``."""
        if self.book.recipes != other.recipes:
            return {self.book.recipes[-1].pattern.action}
        name = self.book.primitives[-1].name
        return {
            each.pattern.action
            for each in self.book.recipes
            if any(call.primitive == name for call in each.calls)
        }

    def _commands(self, actions: set[str]) -> Iterator[tuple[str, str]]:
        """Yield commands, each of another form, whose forms have one of the actions; short ones first."""
        if not actions:
            return
        has_one = reduce(or_, (Q(text__contains=f"( {action} ") for action in sorted(actions)))
        of_form = Command.objects.filter(logical_form=OuterRef("pk")).order_by("length", "position")
        forms = self._world.logical_forms.filter(has_one).order_by("length", "pk")
        said = forms.filter(Exists(of_form)).annotate(
            command=Subquery(of_form.values("anonymized_text")[:1])
        )
        yield from said.values_list("command", "text")[:MOST_TRIED]

    def _grounded(self, command: str, form: str) -> tuple[str, Plan, str]:
        """Return a command with entities of the ontology in it, its plan, and its form with them."""
        said = _with_entities(command, self._ontology)
        given = deanonymize(read_form(form), self._anonymizer.anonymize(said), self._ontology)
        plan = make_plan(given.form, self._ontology, self._predicates, lookup=self._lookup)
        return said, plan, to_corpus(given.form)


def _with_entities(command: str, ontology: Ontology) -> str:
    """Return a command with an entity in place of each class token, no entity twice while there are others."""
    used: dict[str, int] = defaultdict(int)
    words = []
    for word in command.split():
        match = CLASS_TOKEN.fullmatch(word)
        entities = ontology.of_class(match[1].rstrip("0123456789")) if match else ()
        if match and entities:
            word = entities[used[match[1]] % len(entities)].text
            used[match[1]] += 1
        words.append(word)
    return " ".join(words)
