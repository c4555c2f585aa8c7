"""Verb: export the words of a world for a speech recogniser, which hears better what it is told to expect."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from django.db import models

from annotations.language.forms import EntityClasses, Symbols, Text, Wildcard, walk_symbols
from annotations.language.templates import TaskCategory
from annotations.language.texts import PRONOUNS, KnownWords, plural, spellings
from annotations.language.world import Entity, Ontology
from annotations.models import World
from annotations.rows.from_rows import ontology_of, task_categories

UNKNOWN_WORD = "[unk]"  # what Vosk answers for words that its list does not have
_WORD = re.compile(r"[^\W_]+(?:['’-][^\W_]+)*")


class VocabularyFormat(models.TextChoices):
    """``txt`` has one phrase a line, as NeMo, sherpa-onnx and the phrase lists of clouds take them; ``jsonl`` says
    the class of each, so that a team can boost classes apart; ``vosk`` is the list of Vosk's recogniser."""

    TXT = "txt"
    JSONL = "jsonl"
    VOSK = "vosk"


class PhraseKind(StrEnum):
    """What a phrase is: the text of an entity, an alias or another number of one, a word of the grammar."""

    NAME = "name"
    ALIAS = "alias"
    INFLECTED = "inflected"
    WORD = "word"


class VocabularyPart(models.TextChoices):
    """``names`` are the phrases of the ontology: what a recogniser misses most. ``words`` are those of the grammar."""

    NAMES = "names"
    WORDS = "words"


@dataclass(frozen=True, slots=True)
class Phrase:
    """Words that people say in this world; ``entity`` is the text of the entity that they name, if they name one."""

    text: str
    kind: PhraseKind
    entity_class: str = ""
    entity: str = ""

    def as_json(self) -> dict[str, Any]:
        return {
            "text": self.text,
            "kind": str(self.kind),
            "entity_class": self.entity_class,
            "entity": self.entity,
        }


def vocabulary_of(world: World, only: str | None = None) -> list[Phrase]:
    """Return the phrases of ``world``: names in the order of the ontology, then words by the alphabet.

    A phrase comes once for each class of entities that it names. A word that is a name of its own comes as that.

    Args:
        only: a ``VocabularyPart``; both without it.

    Raises:
        LanguageError: a stored production or template cannot be read, with its file and line.
    """
    phrases: dict[tuple[str, str], Phrase] = {}
    if only != VocabularyPart.WORDS:
        for each in _phrases_of(ontology_of(world)):
            phrases.setdefault((each.text.casefold(), each.entity_class), each)
    if only != VocabularyPart.NAMES:
        named = {text for text, _ in phrases}
        words = _words_of(task_categories(world))
        phrases |= {(word, ""): Phrase(word, PhraseKind.WORD) for word in sorted(words - named)}
    return list(phrases.values())


def vocabulary_file(world: World, as_: str) -> str:
    """Return how the file of a ``VocabularyFormat`` is called."""
    suffix = "json" if as_ == VocabularyFormat.VOSK else as_
    return f"{world.name}-vocabulary.{suffix}"


def vocabulary_pieces(phrases: Iterable[Phrase], as_: str) -> Iterator[bytes]:
    """Yield the phrases as a file; ``as_`` is a ``VocabularyFormat``."""
    match VocabularyFormat(as_):
        case VocabularyFormat.JSONL:
            for each in phrases:
                yield f"{json.dumps(each.as_json(), ensure_ascii=False)}\n".encode()
        case VocabularyFormat.TXT:
            for text in dict.fromkeys(each.text for each in phrases):
                yield f"{text}\n".encode()
        case VocabularyFormat.VOSK:
            # Its models know words in lower case, without punctuation.
            texts = (" ".join(_WORD.findall(each.text.lower())) for each in phrases)
            listed = [*dict.fromkeys(text for text in texts if text), UNKNOWN_WORD]
            yield f"{json.dumps(listed, ensure_ascii=False)}\n".encode()


def _phrases_of(ontology: Ontology) -> Iterator[Phrase]:
    """Yield the names, then the aliases, then the plurals and singulars of entities: the surer first."""
    names = [*dict.fromkeys((each.entity_class, each.text) for each in ontology.entities)]
    yield from (Phrase(text, PhraseKind.NAME, token, text) for token, text in names)
    for entity in ontology.entities:
        for alias in entity.aliases:
            yield Phrase(alias, PhraseKind.ALIAS, entity.entity_class, entity.text)
    known = KnownWords()
    for entity in ontology.entities:
        for text in _inflected(entity, ontology.classes, known):
            yield Phrase(text, PhraseKind.INFLECTED, entity.entity_class, entity.text)


def _inflected(entity: Entity, classes: EntityClasses, known: KnownWords) -> Iterator[str]:
    """Yield plurals and singulars of an entity that people may say.

    Of the spellings by which utterances are understood, those that are no English are left out: a recogniser would
    listen for them.
    """
    if singular := entity.attribute("singular"):
        yield singular
    if not classes.has_plurals(entity.entity_class):
        return
    for noun in (entity.text, *entity.aliases):
        english = [each for each in spellings(noun) if each.rpartition(" ")[2].lower() in known]
        yield from english or (plural(noun),)


def _words_of(categories: Iterable[TaskCategory]) -> set[str]:
    """Return the fixed words of grammars and templates, in lower case."""
    words: set[str] = set()
    for category in categories:
        for production in category.grammar.productions:
            words |= _fixed_words(production.expansion)
        for template in category.templates:
            words |= _fixed_words(template.pattern)
    return words


def _fixed_words(sequence: Symbols) -> set[str]:
    words: set[str] = set()
    for symbol in walk_symbols(sequence, notes=False):
        if isinstance(symbol, Text):
            words.update(_WORD.findall(symbol.value.lower()))
        elif isinstance(symbol, Wildcard) and symbol.kind == "pron":
            words.update(word for forms in PRONOUNS.values() for word in forms.values())
    return words
