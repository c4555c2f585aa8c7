"""Task plans of forms with entities, by the ontology, the predicates and the recipe book of a world."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from annotations.language.forms import Form
from annotations.language.plans import (
    Lookup,
    RecipeBook,
    TaskPlan,
    apply_recipes,
    make_plan,
    with_proposals,
)
from annotations.language.world import Ontology, Predicate
from annotations.models import World
from annotations.rows.from_rows import ontology_of, predicates_of, recipe_book_of


@dataclass(frozen=True)
class TaskPlanner:
    """Plans forms. It holds what a world says, so that planning takes no query."""

    ontology: Ontology
    predicates: Mapping[str, Predicate]
    book: RecipeBook

    @classmethod
    def of(cls, world: World) -> TaskPlanner:
        """Read what planning needs. Raises LanguageError for a stored text that cannot be read."""
        predicates = predicates_of(world)
        book = with_proposals(recipe_book_of(world), predicates)
        return cls(ontology_of(world), predicates, book)

    @cached_property
    def lookup(self) -> Lookup:
        return Lookup(self.ontology, self.predicates)

    def plan(self, form: Form) -> TaskPlan:
        """Return the team's primitives that do what a form with entities says."""
        plan = make_plan(form, self.ontology, self.predicates, lookup=self.lookup)
        return apply_recipes(plan, self.book)
