"""What a world has, for a proposal that extends it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from datetime import datetime
from functools import lru_cache
from random import Random

from annotations.language.forms import (
    Application,
    Form,
    Symbols,
    Text,
    Wildcard,
    with_leaves,
)
from annotations.language.induction import CATEGORY, KnownWorld, Rule, StoredTemplates, folded
from annotations.language.templates import spread_derivations
from annotations.models import Entity, Production, World
from annotations.rows.from_rows import predicates_of, task_categories

COMMANDS_OF_A_TEMPLATE = 10  # that say which words name a predicate and lead to its arguments
REMEMBERED_WORLDS = 4


def known_world_of(world: World, category: str = CATEGORY) -> KnownWorld:
    """Return what ``world`` has; new templates go to a task category, which it may lack.

    Raises LanguageError where a stored text cannot be read.
    """
    rows = Entity.objects.filter(ontology__world=world).order_by("-position")
    texts = {
        folded(name): token
        for token, text, aliases in rows.values_list("entity_class", "text", "aliases")
        for name in (*aliases, text)
    }
    # Another database, such as a restored one, may have another world with the same key and revision.
    now = World.objects.values_list("pk", "created_at", "revision").get(pk=world.pk)
    rules, stored = _commands(*now)
    names = Production.objects.filter(grammar__world=world).values_list("nonterminal", flat=True)
    return KnownWorld(texts, predicates_of(world), rules, frozenset(names), stored, category)


@lru_cache(maxsize=REMEMBERED_WORLDS)
def _commands(
    pk: int, created_at: datetime, revision: int
) -> tuple[tuple[Rule, ...], StoredTemplates | None]:
    categories = task_categories(World.objects.get(pk=pk))
    rules: dict[Rule, None] = {}
    for category in categories:
        for each in spread_derivations(category, COMMANDS_OF_A_TEMPLATE, Random(0)):
            if isinstance(each.form, Application):
                rules |= dict.fromkeys(_rules(each.symbols, each.form))
    return tuple(rules), StoredTemplates(categories) if categories else None


def _rules(symbols: Symbols, form: Form) -> Iterator[Rule]:
    """Yield the rule of a derivation; none where its form has a slot that no word says, or says twice."""
    words: list[str] = []
    numbers: dict[tuple[str, int | None], Wildcard] = {}
    for symbol in symbols:
        if isinstance(symbol, Wildcard) and symbol.entity_class:
            if symbol.identity in numbers:
                return
            slot = Wildcard(symbol.entity_class, id=len(numbers) + 1)
            numbers[symbol.identity] = slot
        if isinstance(symbol, Wildcard | Text):
            word = symbol.value if isinstance(symbol, Text) else symbol.token
            words += [word] if word else []

    def numbered(leaf: Form) -> Form:
        return numbers[leaf.identity] if isinstance(leaf, Wildcard) else leaf

    with suppress(KeyError):
        yield Rule(tuple(words), with_leaves(form, numbered))
