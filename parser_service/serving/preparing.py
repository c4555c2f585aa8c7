"""What a parser is given for an utterance that somebody typed or said, or for JSON lines with one in each."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property, lru_cache, partial
from itertools import islice
from random import Random
from typing import Self

from annotations.language.forms import DEFAULT_CLASSES, EntityClasses, Form, Symbols, Text, Wildcard
from annotations.language.grammar import anonymized
from annotations.language.grounding import Anonymizer, Evidence
from annotations.language.plans import (
    ActionName,
    Lookup,
    NearCommands,
    RecipeBook,
    UsualPlaces,
    WordUse,
    default_book,
    usual_places,
    with_proposals,
)
from annotations.language.templates import TaskCategory, spread_derivations
from annotations.language.texts import LanguageError, Refusal, has_half_character, normalise
from annotations.language.world import Ontology, Predicate
from annotations.models import World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.rows.from_rows import ontology_of, predicates_of, recipe_book_of, task_categories
from parser_service.serving.action_naming import names_of

MOST_CANDIDATES = 20
MOST_ALTERNATIVES = 20  # of a recogniser
# What the grammar tells about which words of an utterance go where:
MOST_OF_A_TEMPLATE = 25  # commands; more of one template say nothing new
MOST_COMMANDS = 4_000
REMEMBERED_WORLDS = 8


@dataclass(frozen=True)
class LearnedUse:
    """What some derivations of a grammar tell, each thing found out when it is first asked for: to derive them
    takes seconds, and a plan of forms needs none."""

    derive: Callable[[], tuple[tuple[Symbols, Form], ...]] = tuple
    predicates: Mapping[str, Predicate] = field(default_factory=dict)
    classes: EntityClasses = DEFAULT_CLASSES

    @cached_property
    def derivations(self) -> tuple[tuple[Symbols, Form], ...]:
        """Some commands with their forms."""
        return self.derive()

    @cached_property
    def evidence(self) -> Evidence:
        """Which mention fills which slot."""
        return Evidence(self.derivations)

    @cached_property
    def use(self) -> WordUse:
        """Which words name which predicate, and lead to which slot."""
        return WordUse.of(self.derivations, self.predicates, self.classes)

    @cached_property
    def near(self) -> NearCommands:
        """Finds the commands that are near to what was said."""
        return NearCommands(_as_command(symbols) for symbols, _ in self.derivations)


@dataclass(frozen=True, slots=True)
class WorldLanguage:
    """What the texts and forms of a world are read with, as it was at one moment."""

    ontology: Ontology
    predicates: Mapping[str, Predicate]
    anonymizer: Anonymizer
    lookup: Lookup
    action_names: Mapping[str, ActionName]
    recipes: RecipeBook = field(default_factory=default_book)
    usual: UsualPlaces = field(default_factory=dict)  # where things are of which nobody says it
    learned: LearnedUse = field(default_factory=LearnedUse)

    @property
    def evidence(self) -> Evidence:
        """Which mention fills which slot."""
        return self.learned.evidence

    @property
    def use(self) -> WordUse:
        """Which words lead where."""
        return self.learned.use

    @property
    def near(self) -> NearCommands:
        """Finds the commands that are near to what was said."""
        return self.learned.near

    @classmethod
    def of(cls, world: World) -> Self:
        """Read the language of ``world`` from the database."""
        ontology, predicates = ontology_of(world), predicates_of(world)
        lookup = Lookup(ontology, predicates)
        return cls(
            ontology,
            predicates,
            Anonymizer(ontology),
            lookup,
            names_of(world),
            with_proposals(recipe_book_of(world), predicates),
            usual_places(ontology, lookup),
            learned_use(world),
        )


def numbered_lines(body: bytes) -> list[tuple[int, bytes]]:
    """Return the lines that are not empty, numbered from 1."""
    return [(number, line) for number, line in enumerate(body.splitlines(), 1) if line.strip()]


def require_utterance(text: object) -> str:
    """Return the utterance that ``text`` is, normalised. Raises Refusal where it is none."""
    if not isinstance(text, str):
        raise Refusal("There is no utterance: send a text.", "no_utterance")
    # A longer one is not even normalised; composing the letters of a shorter one may make it longer.
    utterance = normalise(text) if len(text) <= MOST_CHARACTERS else text
    if len(utterance) > MOST_CHARACTERS:
        raise Refusal(
            f"The utterance has {len(utterance):,} characters; at most {MOST_CHARACTERS} are parsed.",
            "utterance_too_long",
        )
    if not utterance.strip():
        raise Refusal("There is no utterance: send a text.", "no_utterance")
    if "\0" in utterance:
        raise Refusal(
            "The utterance holds a character that cannot be written (NUL).", "utterance_unwritable"
        )
    if has_half_character(utterance):
        raise Refusal(
            "The utterance holds half a character, a lone surrogate such as \\ud83d.",
            "utterance_unwritable",
        )
    return utterance


def require_beam(beam: object) -> int:
    """Return ``beam`` where it is a number of candidates. Raises Refusal."""
    if not isinstance(beam, int) or isinstance(beam, bool) or not 1 <= beam <= MOST_CANDIDATES:
        raise Refusal(
            f"beam has to be a whole number from 1 to {MOST_CANDIDATES}.", "beam_out_of_range"
        )
    return beam


def learned_use(world: World) -> LearnedUse:
    """Return what the grammar of ``world`` tells about words and roles, kept until the world changes."""
    # Another database, such as a restored one, may have another world with the same key and revision.
    now = World.objects.values_list("pk", "created_at", "revision").get(pk=world.pk)
    return _learn(*now)


@lru_cache(maxsize=REMEMBERED_WORLDS)
def _learn(pk: int, created_at: datetime, revision: int) -> LearnedUse:
    world = World.objects.get(pk=pk)
    derive = partial(_derive, world)
    return LearnedUse(derive, predicates_of(world), ontology_of(world).classes)


def _derive(world: World) -> tuple[tuple[Symbols, Form], ...]:
    try:
        return derive(task_categories(world))
    except LanguageError:  # a grammar that cannot be read says nothing; its page says why
        return ()


def derive(categories: Iterable[TaskCategory]) -> tuple[tuple[Symbols, Form], ...]:
    """Return some commands of each template with their forms. Raises LanguageError where a grammar has a cycle."""
    return tuple(islice(_derivations(categories), MOST_COMMANDS))


def _derivations(categories: Iterable[TaskCategory]) -> Iterator[tuple[Symbols, Form]]:
    for category in categories:
        drawn = spread_derivations(category, MOST_OF_A_TEMPLATE, Random(0))
        yield from ((each.symbols, each.form) for each in drawn)


def _as_command(symbols: Symbols) -> str:
    leaves = (each for each in symbols if isinstance(each, Text | Wildcard))
    return " ".join(word for leaf in leaves for word in anonymized(leaf))
