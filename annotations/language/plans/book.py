"""A recipe book: the primitives of a team's robot and the recipes that use them; the books that ship."""

from __future__ import annotations

import re
import tomllib
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path
from types import MappingProxyType

from annotations.language.plans.behavior_tree import node_name
from annotations.language.plans.plan import ASK
from annotations.language.plans.planning import argument_names
from annotations.language.plans.reading import read_primitive, read_recipe
from annotations.language.plans.rows import (
    AFTER_COMMANDS,
    ActionPattern,
    Call,
    Name,
    Primitive,
    Recipe,
)
from annotations.language.plans.values import KINDS
from annotations.language.texts import (
    LanguageError,
    Position,
    Problem,
    Severity,
    error_at,
    say_count,
    warning_at,
)

DEFAULT_BOOK = "primitives"
_NUMBER = re.compile(r"_\d+$")  # of a second argument of the same name
_FOLDER = Path(__file__).parent / "books"


@dataclass(frozen=True)
class RecipeBook:
    """Primitives and recipes in the order of their rows.

    ``proposed`` are those that nobody has taken yet, for actions that no recipe covers.
    """

    primitives: tuple[Primitive, ...] = ()
    recipes: tuple[Recipe, ...] = ()
    proposed: RecipeBook | None = field(default=None, compare=False)

    def primitive(self, name: str) -> Primitive | None:
        """Return the primitive of a name; None if there is none."""
        return self._by_name.get(name)

    def of_actions(self, actions: Collection[str]) -> RecipeBook:
        """Return what is about some actions: their recipes, those that every world has, and the primitives called."""
        wanted = {*actions, ASK, AFTER_COMMANDS}
        recipes = tuple(each for each in self.recipes if each.pattern.action in wanted)
        called = {call.primitive for each in recipes for call in each.calls}
        return RecipeBook(tuple(each for each in self.primitives if each.name in called), recipes)

    def recipes_of(self, action: str) -> Sequence[Recipe]:
        """Return the recipes of an action that can be used: those without an error."""
        return self._usable.get(action, ())

    @property
    def after_commands(self) -> Sequence[Call]:
        """What the robot does when all commands are done, such as going back to the operator."""
        recipes = self.recipes_of(AFTER_COMMANDS)
        return recipes[0].calls if recipes else ()

    @cached_property
    def _by_name(self) -> Mapping[str, Primitive]:
        return {each.name: each for each in reversed(self.primitives)}

    @cached_property
    def _usable(self) -> Mapping[str, Sequence[Recipe]]:
        recipes: dict[str, list[Recipe]] = {}
        for each in self.recipes:
            if not any(self._call_problems(each)):
                recipes.setdefault(each.pattern.action, []).append(each)
        return recipes

    def problems(
        self,
        actions: Collection[str] | None = None,
        classes: Collection[str] = (),
        arguments: Mapping[str, Collection[str]] = MappingProxyType({}),
    ) -> tuple[Problem, ...]:
        """Return what is wrong with the rows as a whole: an error for what cannot work, else a warning.

        Args:
            actions: the actions of the world's forms, if known; a recipe of another one is never used.
            classes: the tokens of the world's entity classes, which arguments can be restricted to.
            arguments: what plans call the arguments of the world's actions.
        """
        return (*self._primitive_problems(), *self._recipe_problems(actions, classes, arguments))

    def _primitive_problems(self) -> Iterator[Problem]:
        seen: set[str] = set()
        for each in self.primitives:
            if each.name in seen:
                yield error_at(each.position, f"“{each.name}” is there twice", "remove one row")
            seen.add(each.name)
        yield from self._node_problems()
        used = {call.primitive for recipe in self.recipes for call in recipe.calls}
        for each in self.primitives:
            if each.name not in used:
                yield warning_at(
                    each.position, f"no recipe uses {each.name}", "use it, or remove it"
                )

    def _node_problems(self) -> Iterator[Problem]:
        """Yield an error for each primitive that a behaviour tree could not tell from another one."""
        nodes: defaultdict[str, list[str]] = defaultdict(list)
        for name in self._by_name:
            nodes[node_name(name)].append(name)
        for each in self.primitives:
            node = node_name(each.name)
            others = " and ".join(name for name in nodes[node] if name != each.name)
            if others:
                message = (
                    f"“{each.name}” is the node {node} of a behaviour tree, and so is {others}"
                )
                yield error_at(each.position, message, "choose another name")

    def _recipe_problems(
        self,
        actions: Collection[str] | None,
        classes: Collection[str],
        arguments: Mapping[str, Collection[str]],
    ) -> Iterator[Problem]:
        shapes = set()
        for recipe in self.recipes:
            if recipe.pattern.shape() in shapes:
                message = f"“{recipe.pattern}” has a recipe already"
                yield error_at(recipe.position, message, "remove one of the two")
            shapes.add(recipe.pattern.shape())
            known = None if actions is None else {*actions, AFTER_COMMANDS}
            if known is not None and recipe.pattern.action not in known:
                message = f"no form has the action {recipe.pattern.action}"
                yield warning_at(recipe.position, message, "check its spelling")
            yield from _argument_problems(recipe, arguments)
            for kind in _kinds(recipe):
                if classes and kind not in KINDS and kind not in classes:
                    hint = f"use a class of the world, or {', '.join(sorted(KINDS))}"
                    yield warning_at(recipe.position, f"no value is a “{kind}”", hint)
            yield from self._call_problems(recipe)

    def _call_problems(self, recipe: Recipe) -> Iterator[Problem]:
        results: set[str] = set()
        for call in recipe.calls:
            primitive = self.primitive(call.primitive)
            if primitive is None:
                names = ", ".join(each.name for each in self.primitives)
                hint = f"the book has {names}" if names else "add a row for it"
                yield error_at(call.position, f"there is no primitive {call.primitive}", hint)
                continue
            needed = sum(not each.is_optional for each in primitive.parameters)
            if not needed <= len(call.arguments) <= len(primitive.parameters):
                message = (
                    f"“{call.primitive}” does not take {say_count(len(call.arguments), 'argument')}"
                )
                yield error_at(call.position, message, f"its row is {primitive}")
            if call.result and not primitive.gives_result:
                message = f"“{call.primitive}” gives no result"
                yield error_at(call.position, message, "only a primitive that learns gives one")
            for argument in call.arguments:
                if isinstance(argument, Name) and argument.part and argument.name in results:
                    message = f"“{argument.name}” is a result, which has no {argument.part}"
                    yield error_at(argument.position, message, "use the result as it is")
            results |= {call.result} - {""}


def read_book(
    primitives: str, recipes: str, source: str = ""
) -> tuple[RecipeBook, tuple[Problem, ...]]:
    """Read a book from two texts with a row a line; ``#`` starts a line that is a comment.

    Args:
        primitives: rows of primitives.
        recipes: rows of recipes.
        source: what positions name; ``primitives`` and ``recipes`` if it is empty.

    Returns:
        The book of the rows that can be read, and the problems of the others and of the book.
    """
    problems: list[Problem] = []
    read_primitives: list[Primitive] = []
    read_recipes: list[Recipe] = []
    for text, position in _rows(primitives, source or "primitives"):
        try:
            read_primitives.append(read_primitive(text, position))
        except LanguageError as error:
            problems.append(error.problem)
    for text, position in _rows(recipes, source or "recipes"):
        try:
            read_recipes.append(read_recipe(text, position))
        except LanguageError as error:
            problems.append(error.problem)
    book = RecipeBook(tuple(read_primitives), tuple(read_recipes))
    return book, (*problems, *book.problems())


@dataclass(frozen=True)
class ShippedBook:
    """A book that comes with the program; a world starts with a copy of its rows."""

    name: str
    title: str
    description: str
    book: RecipeBook


@cache
def shipped_books() -> dict[str, ShippedBook]:
    """Return the books that ship by name, ``DEFAULT_BOOK`` first."""
    books = {}
    for path in sorted(_FOLDER.glob("*.toml"), key=lambda path: path.stem != DEFAULT_BOOK):
        values = tomllib.loads(path.read_text(encoding="utf-8"))
        book, problems = read_book(values["primitives"], values["recipes"], path.name)
        errors = [each for each in problems if each.severity is Severity.ERROR]
        if errors:
            first = errors[0]
            raise LanguageError(first.message, first.position, first.hint)
        books[path.stem] = ShippedBook(path.stem, values["title"], values["description"], book)
    return books


def default_book() -> RecipeBook:
    """Return the book that a new world starts with."""
    return shipped_books()[DEFAULT_BOOK].book


def _rows(text: str, source: str) -> Iterator[tuple[str, Position]]:
    for number, line in enumerate(text.splitlines(), start=1):
        row = line.strip()
        if row and not row.startswith("#"):
            yield row, Position(source, number, line.index(row) + 1)


def _argument_problems(
    recipe: Recipe, arguments: Mapping[str, Collection[str]]
) -> Iterator[Problem]:
    """Yield a warning for each argument that no plan has, so that the recipe is never used."""
    for pattern in _patterns(recipe):
        if pattern.action == ASK:
            continue
        known = dict.fromkeys((*argument_names(pattern.action), *arguments.get(pattern.action, ())))
        for each in pattern.parameters:
            name = _NUMBER.sub("", each.name)
            if name not in known and each.name not in known and (known or name != "argument"):
                said = ", ".join(known) or "argument_1, argument_2 and so on"
                message = f"no plan has an argument “{each.name}” of {pattern.action}"
                yield warning_at(recipe.position, message, f"plans have {said}")


def _kinds(recipe: Recipe) -> Iterator[str]:
    for pattern in _patterns(recipe):
        yield from (each.kind for each in pattern.parameters if each.kind)


def _patterns(recipe: Recipe) -> Iterator[ActionPattern]:
    """Yield the action of a recipe, and those that stand in the place of its arguments."""
    patterns = [recipe.pattern]
    while patterns:
        pattern = patterns.pop()
        yield pattern
        patterns += [each.action for each in pattern.parameters if each.action]
