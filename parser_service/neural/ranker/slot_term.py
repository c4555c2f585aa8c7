"""How well the slots of a form fit the entities that an utterance names."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from functools import lru_cache

import torch
from torch import Tensor

from annotations.language.english import OPEN_CATEGORIES
from annotations.language.forms import CLASS_TOKEN
from annotations.language.grounding import Anonymizer, Span
from annotations.language.ontology import Ontology
from annotations.language.symbols import ENTITY_CLASSES

_PLACE = {name: place for place, name in enumerate(ENTITY_CLASSES)}
_MOST_READINGS = 8
# These words mean a category that is left open (FORMATS: ``{category?}`` is "objects") or things of no
# category, so they may count as one or not.
_OPEN_CATEGORY = re.compile(rf"\b(?:{'|'.join(map(re.escape, OPEN_CATEGORIES))})\b", re.IGNORECASE)
Counts = tuple[int, ...]  # by ENTITY_CLASSES


class SlotTerm:
    """Minus the number of slots too many or too few, by entity class.

    The ontology finds the entities; class tokens count as entities of their class. A word that may be
    of two classes ("drink" is any object of a category, or the category) counts as what fits better.
    """

    def __init__(self, forms: Sequence[str], ontology: Ontology):
        counts = torch.tensor([_count_tokens(form) for form in forms])  # [forms, classes]
        # Many forms have the same slots. [kinds of form, classes] and [forms]
        self._kinds, self._kind_of = counts.unique(dim=0, return_inverse=True)
        self._anonymizer = Anonymizer(ontology)
        self._readings = lru_cache(maxsize=100_000)(self._read)

    def scores(self, utterances: Sequence[str]) -> Tensor:
        """Return scores [utterances, forms]; 0 where all slots fit."""
        rows = []
        for utterance in utterances:
            readings = torch.tensor(self._readings(utterance))  # [readings, classes]
            misfit = (self._kinds[None] - readings[:, None]).abs().sum(-1)  # [readings, kinds]
            rows.append(-misfit.min(0).values)
        return torch.stack(rows).float()[:, self._kind_of]

    def _read(self, utterance: str) -> tuple[Counts, ...]:
        """Count the entities by class, once for each way to understand the words."""
        readings = [_count_tokens(utterance)]
        for span in self._anonymizer.anonymize(utterance).spans:
            grown = [_with_one(each, name) for each in readings for name in _classes(span)]
            readings = list(dict.fromkeys(grown))[:_MOST_READINGS]
        for _ in _OPEN_CATEGORY.findall(utterance):
            readings += [_with_one(each, "category") for each in readings]
        return tuple(dict.fromkeys(readings))[:_MOST_READINGS]


def _count_tokens(text: str) -> Counts:
    counts = Counter(name.rstrip("0123456789") for name in CLASS_TOKEN.findall(text))
    return tuple(counts[name] for name in ENTITY_CLASSES)


def _with_one(counts: Counts, name: str) -> Counts:
    at = _PLACE[name]
    return (*counts[:at], counts[at] + 1, *counts[at + 1 :])


def _classes(span: Span) -> list[str]:
    """Return the classes that the words of a span may be of."""
    entities = (span.entity, *span.others)
    names = [span.entity_class, *(entity.entity_class for entity in entities)]
    return [name for name in dict.fromkeys(names) if name in _PLACE]
