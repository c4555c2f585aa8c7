"""Commands of a world with things of its ontology in them, drawn at random under a seed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import islice
from random import Random

from annotations.language.forms import canonical_text
from annotations.language.grounding import Grounded, ground
from annotations.language.templates import (
    Derivation,
    Expansion,
    RankedGrammar,
    RankedTemplate,
    TaskCategory,
    generate,
)
from annotations.language.texts import LanguageError
from annotations.language.world import Ontology
from annotations.models import World
from annotations.rows.from_rows import annotated_categories, ontology_of

# All derivations of a template with more are not kept.
MOST_EXPANDED = 20_000


def grounded_pairs(world: World, count: int, seed: int = 0) -> list[tuple[str, str]]:
    """Return ``count`` pairs of a grounded command and its canonical form.

    Every anonymized command has its turn before one comes again. A command for which the ontology
    has no value is left out. The same world, count and seed give the same pairs.

    Raises:
        LanguageError: the world makes no command, or none that its ontology can ground.
    """
    categories, expansions = commands_to_ground(world)
    if not expansions:
        raise LanguageError(f"the world {world} makes no command", hint="import templates first")
    drawn = _draw(categories, expansions, ontology_of(world), Random(seed))
    return list(islice(drawn, count))


def commands_to_ground(
    world: World,
) -> tuple[tuple[TaskCategory, ...], tuple[Expansion, ...]]:
    """Return the task categories of ``world`` and its commands: those that are stored, where they are a sample.

    Raises:
        LanguageError: the world makes too many commands, or a stored text cannot be read.
    """
    annotated = annotated_categories(world)
    categories = tuple(each.value for each in annotated)
    if not world.sample_request.size:
        return categories, generate(categories).expansions
    places = {
        (each.value.name, row.pk): index
        for each in annotated
        for index, row in enumerate(each.template_rows)
    }
    columns = (
        "anonymized_text",
        "logical_form__text",
        "task_category",
        "template",
        "is_in_grammar",
    )
    stored = world.commands.order_by("position").values_list(*columns)
    return categories, tuple(
        Expansion(command, form, name, places[name, template], in_grammar)
        for command, form, name, template, in_grammar in stored
        if (name, template) in places
    )


def _draw(
    categories: Sequence[TaskCategory],
    expansions: Sequence[Expansion],
    ontology: Ontology,
    random: Random,
) -> Iterator[tuple[str, str]]:
    """Yield pairs without end, as long as a round over all commands gives any."""
    sources = {category.name: GroundedCommands(category) for category in categories}
    while True:
        failure: LanguageError | None = None
        given = 0
        for expansion in random.sample(expansions, len(expansions)):
            try:
                grounded = sources[expansion.task_category].draw(expansion, ontology, random)
            except LanguageError as error:
                failure = error
                continue
            given += 1
            yield grounded.text, canonical_text(grounded.form)
        if not given and failure is not None:
            raise failure


class GroundedCommands:
    """The commands of one category with entities in them.

    Derivations are expanded a template at a time; where it has more than ``MOST_EXPANDED`` commands, one at a time.
    """

    def __init__(self, category: TaskCategory) -> None:
        self._category = category
        self._ranked = RankedGrammar(category.grammar, category.lines)
        self._templates: dict[int, RankedTemplate] = {}
        self._by_text: dict[int, dict[str, list[Derivation]]] = {}

    def draw(self, expansion: Expansion, ontology: Ontology, random: Random) -> Grounded:
        """Ground the command of ``expansion`` by one of its derivations.

        Raises:
            LanguageError: the ontology has no value, or too few, for what is asked.
        """
        derivation = random.choice(self._derivations_of(expansion))
        return ground(derivation.symbols, derivation.form, ontology, random)

    def _derivations_of(self, expansion: Expansion) -> list[Derivation]:
        index = expansion.template_index
        template = self._category.templates[index]
        if index not in self._templates:
            self._templates[index] = self._ranked.template(template)
        ranked = self._templates[index]
        if ranked.size > MOST_EXPANDED:
            words = tuple(expansion.command.split())
            derivation = next(ranked.derivations_of(words, expansion.form_text), None)
            if derivation is None:
                raise LanguageError(
                    f"no template makes “{expansion.command}” with its form any more",
                    hint="generate the commands anew",
                )
            return ranked.intact(derivation, index)
        if index not in self._by_text:
            by_text: dict[str, list[Derivation]] = defaultdict(list)
            for each in self._ranked.expander.derivations(template, index):
                by_text[each.anonymized_text].append(each)
            self._by_text[index] = by_text
        return self._by_text[index][expansion.command]
