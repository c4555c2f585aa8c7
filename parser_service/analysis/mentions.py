"""The words of an utterance: which name an entity or its class, and which do not."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from annotations.language.forms import CLASS_TOKEN, Constant, Form, walk
from annotations.language.grounding import Anonymizer
from annotations.language.texts import article

_WORD = re.compile(r"<\w+>|[\w'’]+")


@dataclass(frozen=True, slots=True)
class UtteranceToken:
    """``text[start:end]`` of an utterance. ``entity_class`` is empty for a plain word; ``value`` is the text of the
    entity that is named, empty for a plain word and for a class token."""

    text: str
    start: int
    end: int
    entity_class: str = ""
    value: str = ""

    @property
    def word(self) -> str:
        """The word as anonymized commands have it."""
        return f"<{self.entity_class}>" if self.entity_class else self.text.lower()

    @property
    def is_exact(self) -> bool:
        """Whether an entity is named by its very text, neither a plural nor an alias."""
        return bool(self.value) and self.text.casefold() == self.value.casefold()


@dataclass(frozen=True, slots=True)
class TokenizedUtterance:
    """An utterance and its mentions, in order and apart from each other."""

    text: str
    mentions: tuple[UtteranceToken, ...]

    def of_class(self, entity_class: str) -> tuple[UtteranceToken, ...]:
        return tuple(each for each in self.mentions if each.entity_class == entity_class)

    def replace(self, mention: UtteranceToken, new: str) -> str:
        """Return the text with ``new`` in place of a mention; an article before it fits the new word."""
        before, after = self.text[: mention.start], self.text[mention.end :]
        said = re.search(r"\b(an?)(\s+)$", before, re.IGNORECASE)
        if said is not None and new[:1].isalpha():
            fitting = said[1][0] + article(new)[1:]
            before = before[: said.start()] + fitting + said[2]
        return before + new + after


def read_utterance(text: str, anonymizer: Anonymizer) -> TokenizedUtterance:
    """Return the words of an utterance; the names of entities are one mention each."""
    spans = anonymizer.anonymize(text).spans
    mentions = [
        UtteranceToken(
            text[span.start : span.end], span.start, span.end, span.entity_class, span.value
        )
        for span in spans
    ]
    taken = [(span.start, span.end) for span in spans]
    for match in _WORD.finditer(text):
        if not any(start < match.end() and match.start() < end for start, end in taken):
            token = CLASS_TOKEN.fullmatch(match[0])
            entity_class = token[1].rstrip("0123456789") if token else ""
            mentions.append(UtteranceToken(match[0], match.start(), match.end(), entity_class))
    return TokenizedUtterance(text, tuple(sorted(mentions, key=lambda each: each.start)))


def constants(form: Form) -> list[Constant]:
    """Return the constants of a form, in order."""
    return [node for node in walk(form) if isinstance(node, Constant)]


def is_named(mention: UtteranceToken, form: Form) -> bool:
    """Return whether a form says a mention's entity itself, and not only its class."""
    value = mention.value.casefold()
    return bool(value) and any(str(each.value).casefold() == value for each in constants(form))


def constant_of(
    mention: UtteranceToken, utterance: TokenizedUtterance, form: Form
) -> Constant | None:
    """Return the constant of a form that a mention became: the entity, or else the token of its class.

    None where it cannot be told: the utterance or the form has several of the kind, or none.
    """
    if is_named(mention, form):
        rivals: Sequence[UtteranceToken] = [
            each for each in utterance.mentions if each.value.casefold() == mention.value.casefold()
        ]
        value = mention.value.casefold()
        candidates = [each for each in constants(form) if str(each.value).casefold() == value]
    else:
        rivals = utterance.of_class(mention.entity_class)
        candidates = [each for each in constants(form) if each.token_class == mention.entity_class]
    return candidates[0] if len(rivals) == len(candidates) == 1 else None
