"""The slots of forms: how well entities of an utterance fit them, and entities in place of class tokens."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from random import Random
from re import Match

import torch
from torch import Tensor

from annotations.language.forms import CLASS_TOKEN, Constant, read_or_none, walk
from annotations.language.grounding import QUESTION_WORD, Anonymizer
from annotations.language.plans import says_number
from annotations.language.texts import ANY_OBJECT, OPEN_CATEGORIES
from annotations.language.world import Ontology
from parser_service.parsers.remembering import remembered

_MOST_READINGS = 8
# These words mean a category that is left open (``{category?}`` says "objects") or things of no
# category, so they may count as one or not.
_OPEN_CATEGORY = re.compile(rf"\b(?:{'|'.join(map(re.escape, OPEN_CATEGORIES))})\b", re.IGNORECASE)
_OBFUSCATED = 0.15  # share of object slots said by their category, as ``{object?}`` says them
Counts = tuple[int, ...]  # by class, in the order of the ontology


class SlotTerm:
    """Minus the number of slots too many or too few, by entity class.

    The ontology finds the entities; class tokens count as entities of their class. A word that may be
    of two classes ("drink" is any object of a category, or the category) counts as what fits better.
    """

    def __init__(self, forms: Sequence[str], ontology: Ontology):
        self._classes = ontology.classes
        counts = torch.tensor([self._count_tokens(form) for form in forms])  # [forms, classes]
        # Many forms have the same slots. [kinds of form, classes] and [forms]
        self._kinds, self._kind_of = torch.unique(counts, dim=0, return_inverse=True)
        self._anonymizer = Anonymizer(ontology)
        self._classes_of: defaultdict[str, set[str]] = defaultdict(set)
        for entity in ontology.entities:
            for text in (entity.text, *entity.aliases):
                self._classes_of[text.casefold()].add(entity.entity_class)

    def scores(self, utterances: Sequence[str]) -> Tensor:
        """Return scores [utterances, forms]; 0 where all slots fit."""
        return torch.stack([self._score(self._read(each)) for each in utterances])

    def _score(self, readings: Sequence[Counts]) -> Tensor:
        """Return scores [forms] for the best of the readings of an utterance."""
        read = torch.tensor(readings)  # [readings, classes]
        misfit = (self._kinds[None] - read[:, None]).abs().sum(-1).amin(0)  # [kinds]
        scores: Tensor = -misfit.float()[self._kind_of]
        return scores

    def named(self, utterance: str) -> frozenset[str]:
        """Return the classes of which an utterance names an entity, by its words or by a class token."""
        spans = self._anonymizer.anonymize(utterance).spans
        tokens = {name.rstrip("0123456789") for name in CLASS_TOKEN.findall(utterance)}
        return frozenset((*tokens, *(span.entity_class for span in spans)))

    def scores_with(self, utterance: str, classes: Iterable[str]) -> Tensor:
        """Return the scores [forms] of an utterance that names one more entity of each of ``classes``."""
        readings = self._read(utterance)
        for name in classes:
            readings = tuple(self._with_one(counts, name) for counts in readings)
        return self._score(readings)

    def asks_for_more(self, utterance: str, form: str) -> bool:
        """Return whether an utterance names an entity that ``form`` has no slot for, or a number of things where
        it has none.

        The words of a closed class may say something else: what lies on the table is in no pose.
        """
        heard = self._anonymizer.anonymize(utterance)
        if says_number(heard) and not _has_number(form):
            return True
        free = Counter(name.rstrip("0123456789") for name in CLASS_TOKEN.findall(form))
        named: dict[str, frozenset[str]] = {}
        for span in heard.spans:
            entities = (span.entity, *span.others)
            classes = {span.entity_class, *(each.entity_class for each in entities)}
            classes |= self._classes_of.get(utterance[span.start : span.end].casefold(), set())
            if not any(map(self._classes.is_closed, classes)):
                named[span.value] = frozenset(classes)
        for wanted in sorted(named.values(), key=len):
            slot = next((each for each in sorted(wanted) if free[each]), None)
            if slot is None:
                return True
            free[slot] -= 1
        return False

    @remembered(100_000)
    def _read(self, utterance: str) -> tuple[Counts, ...]:
        """Count the entities by class, once for each way to understand the words."""
        readings = [self._count_tokens(utterance)]
        for span in self._anonymizer.anonymize(utterance).spans:
            entities = (span.entity, *span.others)
            names = dict.fromkeys([span.entity_class, *(each.entity_class for each in entities)])
            classes = [name for name in names if name in self._classes]  # that its words may be of
            grown = [self._with_one(counts, name) for counts in readings for name in classes]
            readings = list(dict.fromkeys(grown))[:_MOST_READINGS]
        for _ in _OPEN_CATEGORY.findall(utterance):
            readings += [self._with_one(each, "category") for each in readings]
        return tuple(dict.fromkeys(readings))[:_MOST_READINGS]

    def _count_tokens(self, text: str) -> Counts:
        counts = Counter(name.rstrip("0123456789") for name in CLASS_TOKEN.findall(text))
        return tuple(counts[name] for name in self._classes.tokens)

    def _with_one(self, counts: Counts, name: str) -> Counts:
        at = self._classes.place(name)
        return (*counts[:at], counts[at] + 1, *counts[at + 1 :])


def _has_number(form: str) -> bool:
    read = read_or_none(form)
    return read is not None and any(
        isinstance(each, Constant) and isinstance(each.value, int) for each in walk(read)
    )


class SlotFiller:
    """Draws an entity of the right class for each class token of a text."""

    def __init__(self, ontology: Ontology):
        self._ontology = ontology
        self._singulars = tuple(ontology.singulars.values())

    def fill(self, text: str, random: Random) -> str:
        """Return ``text`` with entities: ``bring me the <object>`` with an object. A class without entities
        keeps its token."""

        def draw(token: Match[str]) -> str:
            entity_class = token[1].rstrip("0123456789")
            if entity_class == "question":
                return QUESTION_WORD
            if entity_class == "object" and self._singulars and random.random() < _OBFUSCATED:
                return random.choice(self._singulars)
            entities = self._ontology.of_class(entity_class)
            if not entities:
                return token[0]
            name = random.choice(entities).text
            if entity_class == "category":
                return random.choice((ANY_OBJECT, name, self._ontology.singular(name)))
            return name

        return CLASS_TOKEN.sub(draw, text)
