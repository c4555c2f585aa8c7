"""Words of an utterance that contradict a predicate of its form."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import permutations

from annotations.language.english import CONTRASTS, NEAR_SYNONYMS, NEGATIONS, PREDICATE_WORDS
from annotations.language.forms import Application, Form, Lambda, predicates

OPPOSITE, NEARLY_THE_SAME = 1.0, 0.5  # how strong a word is as evidence
NEGATED_WITHIN = 3  # words between a negation and what it negates, at most


@dataclass(frozen=True, slots=True)
class Contradiction:
    """``word`` of a text says ``said``, where the form has ``predicate``; ``strength`` is 0 to 1."""

    predicate: str
    said: str
    word: str
    strength: float

    def corrected(self, form: Form) -> Form:
        """Return the form with the predicate that the text says."""
        if isinstance(form, Lambda):
            return replace(form, bodies=tuple(map(self.corrected, form.bodies)))
        if isinstance(form, Application):
            name = self.said if form.predicate == self.predicate else form.predicate
            return Application(name, tuple(map(self.corrected, form.arguments)))
        return form


def contradictions(text: str, form: Form) -> Iterator[Contradiction]:
    """Yield what the words of ``text`` contradict, each predicate of the form once at most.

    Nothing is said about a predicate whose own words are in the text too, nor by a word after a
    negation, nor by one that another predicate of the form explains.
    """
    used = set(predicates(form))
    contradicted = set()
    for predicate, other in _CONTRASTING:
        if predicate not in used or other in used or predicate in contradicted:
            continue
        match = _WORDS[other].search(text)
        if match and not _WORDS[predicate].search(text) and not _is_negated(text[: match.start()]):
            contradicted.add(predicate)
            strength = NEARLY_THE_SAME if {predicate, other} in _ALIKE else OPPOSITE
            yield Contradiction(predicate, other, match[0], strength)


def _is_negated(before: str) -> bool:
    last = re.findall(r"[\w'’]+", before.casefold().replace("’", "'"))[-NEGATED_WITHIN:]
    return not NEGATIONS.isdisjoint(last)


_ALIKE = [set(names) for names in NEAR_SYNONYMS]
_CONTRASTING = [pair for group in CONTRASTS for pair in permutations(group, 2)]
_WORDS = {
    name: re.compile(rf"\b(?:{'|'.join(map(re.escape, words))})\b", re.IGNORECASE)
    for name, words in PREDICATE_WORDS.items()
}
