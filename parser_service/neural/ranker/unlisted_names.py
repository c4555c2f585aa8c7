"""Which entity an utterance means in words that the ontology does not have.

All members of a closed class are known, so an utterance means one of them, or none: "with their right arm in the
air" is raising the right arm. The encoder compares every few words of the utterance with the members and their
aliases. Of other classes, a misspelt name is mended; of people it is not, since nobody is sure who else there is.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence

import torch

from annotations.language.corpus import MisspeltNames
from annotations.language.world import Ontology
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.parsers.interface import Check, keep_going

MOST_WORDS = 6  # of an utterance that are compared together
MOST_SPANS = 400  # of an utterance; those of a longer one are not compared
# The least cosine with which words mean a member. Of 39 pairs of a sentence and a class that were tried, those that
# mean a member had 0.74 and more, the others 0.59 and less.
LEAST_LIKENESS = 0.65
_WORD = re.compile(r"[^\W_]+(?:['’][^\W_]+)?")


class UnlistedNames:
    """Finds entities of an ontology in words of people: members of closed classes by likeness, others misspelt."""

    def __init__(self, ontology: Ontology) -> None:
        self._spelled: dict[str, list[tuple[str, str]]] = {}
        for each in ontology.classes:
            if each.is_closed:
                self._spelled[each.token] = [
                    (spelling, entity.text)
                    for entity in ontology.of_class(each.token)
                    for spelling in (entity.text, *entity.aliases)
                ]
        self._spelled = {token: spelled for token, spelled in self._spelled.items() if spelled}
        self._names = {
            each.token: ontology.texts_of(each.token)
            for each in ontology.classes
            if each.has_plurals and ontology.texts_of(each.token)
        }
        self._misspelt = MisspeltNames()

    @property
    def tokens(self) -> frozenset[str]:
        """The classes of which it finds entities."""
        return frozenset((*self._spelled, *self._names))

    def find(
        self,
        encoder: SentenceEncoder,
        utterance: str,
        classes: Collection[str],
        check: Check = keep_going,
    ) -> Mapping[str, str]:
        """Return the text of the entity that the utterance means, for those of ``classes`` of which it means one."""
        found = {
            token: name
            for token in classes
            if token in self._names
            and (name := self._misspelt.find(utterance, self._names[token])) is not None
        }
        words = _WORD.findall(utterance)
        spans = list(dict.fromkeys(_spans(words)))
        wanted = [each for each in classes if each in self._spelled]
        if not wanted or not spans or len(spans) > MOST_SPANS:
            return found
        vectors = encoder.vectors(spans, check)  # [spans, width]
        for token in wanted:
            spellings, texts = zip(*self._spelled[token], strict=True)
            likeness = (vectors @ encoder.vectors(spellings, check).T).amax(0)  # [spellings]
            best = int(torch.argmax(likeness))
            if float(likeness[best]) >= LEAST_LIKENESS:
                found[token] = texts[best]
        return found


def _spans(words: Sequence[str]) -> list[str]:
    return [
        " ".join(words[first:last])
        for first in range(len(words))
        for last in range(first + 1, min(len(words), first + MOST_WORDS) + 1)
    ]
