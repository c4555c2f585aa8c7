"""What an utterance says about the slots of any form: worked out once for all the forms that a parser gives."""

from __future__ import annotations

from annotations.language.grounding.alternatives import are_alike, find_alternatives
from annotations.language.grounding.anonymizer import Anonymized, Span
from annotations.language.grounding.assignment import Mention
from annotations.language.grounding.roles import Context, context_of, words_of
from annotations.language.grounding.unknown_phrases import unknown_phrases
from annotations.language.ontology import Ontology

_Members = tuple[list[Span], tuple[str, ...]]


class Heard:
    """The mentions of an utterance, and the ``phrases`` that may name an entity (``unknown_phrases``)."""

    def __init__(self, anonymized: Anonymized, ontology: Ontology) -> None:
        self.phrases = unknown_phrases(anonymized, ontology)
        self._spans = anonymized.spans
        self._contexts = _contexts(anonymized)
        self._joined = find_alternatives(anonymized)
        self._mentions: dict[tuple[str, frozenset[str] | None], tuple[Mention, ...]] = {}

    def spans(self, entity_class: str) -> list[Span]:
        """Return the spans of a class."""
        return [span for span in self._spans if span.entity_class == entity_class]

    def mentions(self, entity_class: str, others: frozenset[str] | None) -> tuple[Mention, ...]:
        """Return the mentions of a class with their contexts in the anonymized utterance.

        What "or" joins is one mention, in the place of the first one of the class. ``others`` are the classes of other
        slots of the form, which take members of theirs; None where "or" joins nothing in this form.
        """
        key = entity_class, others if self._joined else None
        if key not in self._mentions:
            self._mentions[key] = tuple(self._find_mentions(*key))
        return self._mentions[key]

    def _find_mentions(self, entity_class: str, others: frozenset[str] | None) -> list[Mention]:
        mentions: list[Mention] = []
        seen: list[Span] = []
        for number, span in enumerate(self._spans):
            if span.entity_class != entity_class or span in seen:
                continue
            members, phrases = self._members(number, others)
            seen += members
            values = tuple(dict.fromkeys(each.value for each in members))
            is_choice = len(values) + len(phrases) > 1
            entities = tuple(each for member in members for each in (member.entity, *member.others))
            mentions.append(
                Mention(
                    span.value,
                    self._contexts[number],
                    entities,
                    values if is_choice else (),
                    phrases if is_choice else (),
                )
            )
        return mentions

    def _members(self, number: int, others: frozenset[str] | None) -> _Members:
        """Return the spans and the unknown words of which one is meant where span ``number`` stands."""
        span = self._spans[number]
        group = next((each for each in self._joined if number in each.spans), None)
        if group is None or others is None:
            return [span], ()

        def fits(other: Span) -> bool:
            is_mine = other.entity_class == span.entity_class
            is_free = other.entity_class not in others
            return is_mine or (is_free and are_alike(other.entity_class, span.entity_class))

        spans = [self._spans[each] for each in group.spans]
        return [each for each in spans if fits(each)], group.phrases


def _contexts(anonymized: Anonymized) -> list[Context]:
    """Return how each span stands in the anonymized utterance."""
    words: list[str] = []
    places: list[int] = []
    end = 0
    for span in anonymized.spans:
        words += words_of(anonymized.original[end : span.start])
        places.append(len(words))
        words.append(f"<{span.entity_class}>")
        end = span.end
    words += words_of(anonymized.original[end:])
    return [context_of(words, place) for place in places]
