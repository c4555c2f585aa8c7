"""What the grammar of a world tells about which words of an utterance go where."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from itertools import islice

from annotations.language.errors import LanguageError
from annotations.language.forms import Form
from annotations.language.grammar import Budget, TooManyCombinations
from annotations.language.grounding import Evidence
from annotations.language.symbols import Symbols
from annotations.language.templates import TemplateExpander
from annotations.models import World
from annotations.rows.from_rows import task_categories

MOST_OF_A_TEMPLATE = 40  # commands; more of one template say nothing new
MOST_COMMANDS = 4_000
STEPS = 200_000  # of the expansion of one template
REMEMBERED_WORLDS = 8


def evidence_of(world: World) -> Evidence:
    """Return the evidence of the grammar of ``world``, kept until the grammar changes."""
    return _evidence(world.pk, World.objects.values_list("revision", flat=True).get(pk=world.pk))


@lru_cache(maxsize=REMEMBERED_WORLDS)
def _evidence(world: int, revision: int) -> Evidence:
    try:
        pairs = list(islice(_derivations(World.objects.get(pk=world)), MOST_COMMANDS))
    except LanguageError:  # a grammar that cannot be read says nothing; its page says why
        pairs = []
    return Evidence(pairs)


def _derivations(world: World) -> Iterator[tuple[Symbols, Form]]:
    """Yield some commands of each template with their forms. A template that cannot be expanded has none."""
    for category in task_categories(world):
        expander = TemplateExpander(category.grammar)
        for template in category.templates:
            try:
                some = islice(
                    expander.derivations(template, budget=Budget(STEPS)), MOST_OF_A_TEMPLATE
                )
                yield from [(each.symbols, each.form) for each in some]
            except (LanguageError, TooManyCombinations):
                continue
