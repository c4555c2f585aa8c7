"""What stopped an utterance that was not understood: words and names that nobody knows, and commands that are near."""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator
from heapq import nsmallest

from rapidfuzz.distance import OSA
from rapidfuzz.process import extractOne

from annotations.language.forms import (
    PERSON_CLASS,
)
from annotations.language.grounding import Anonymized
from annotations.language.plans.qualifying import Objection
from annotations.language.texts import ENGLISH_WORDS
from annotations.language.world import Ontology

UNKNOWN_WORD, UNKNOWN_NAME = "unknown_word", "unknown_name"
MOST_NAMED = 3  # unknown words that are said; more say nothing new
LEAST_ALIKE = 0.2  # share of what the words of two commands tell that makes one near the other
MOST_ALIKE = 0.6  # share of the words that two of the commands that are offered have in common
MOST_COMPARED = 50
_SPELT_ALIKE = 0.75
_WORD = re.compile(r"<\w+>|\w+(?:['’]\w+)*")
_TOKEN = re.compile(r"<\w+>")
_ENDINGS = re.compile(r"(?:'s|ies|es|s|ing|ed|d|er|ly|n't)$")
_FEWEST_LETTERS = 3  # that are left of a word without its ending


class StoppingWords:
    """Finds the words of utterances that a world and its language do not know.

    Args:
        vocabulary: the words of the commands, in lower case. Without any, as in a world without a grammar, nobody can
            tell which words are known, and none is found.
    """

    def __init__(self, ontology: Ontology, vocabulary: Collection[str]) -> None:
        self._has_vocabulary = bool(vocabulary)
        self._has_names = bool(ontology.of_class(PERSON_CLASS))
        self._known = {*vocabulary, *ENGLISH_WORDS, *_words_of_entities(ontology)}
        self._stems = {_stem(word) for word in self._known}

    def in_(self, heard: Anonymized) -> tuple[Objection, ...]:
        """Return the unknown words of an utterance, the first ``MOST_NAMED``; those next to each other together.

        Those with a capital inside the utterance are a name. Takes linear time.
        """
        found: list[Objection] = []
        if not self._has_vocabulary:
            return ()
        for start, end in _unknown(heard, self._known, self._stems):
            said = heard.original[start:end]
            is_inside = heard.original[:start].strip() != ""
            if is_inside and said[0].isupper() and not said.isupper() and self._has_names:
                found.append(Objection(UNKNOWN_NAME, f"Nobody here is called {said}.", start, end))
            else:
                found.append(Objection(UNKNOWN_WORD, f"I do not know “{said}”.", start, end))
            if len(found) == MOST_NAMED:
                break
        return tuple(found)


def _unknown(heard: Anonymized, known: set[str], stems: set[str]) -> Iterator[tuple[int, int]]:
    """Yield where words stand that nobody knows, those next to each other as one."""
    begin, last = None, 0
    gaps, end = [], 0
    for span in heard.spans:
        gaps.append((end, span.start))
        end = span.end
    for start, stop in (*gaps, (end, len(heard.original))):
        for match in _WORD.finditer(heard.original, start, stop):
            word = _fold(match[0])
            is_known = word in known or _stem(word) in stems or word.isdigit() or word[0] == "<"
            is_next = begin is not None and heard.original[last : match.start()].isspace()
            if begin is not None and (is_known or not is_next):
                yield begin, last
                begin = None
            if not is_known:
                begin, last = match.start() if begin is None else begin, match.end()
        if begin is not None:
            yield begin, last
            begin = None


def _fold(word: str) -> str:
    return word.casefold().replace("’", "'")


def _words(text: str) -> list[str]:
    return [_fold(word) for word in _WORD.findall(text)]


def _share(command: str, other: str) -> float:
    words, others = set(command.split()), set(other.split())
    return len(words & others) / len(words | others)


def _stem(word: str) -> str:
    stem = _ENDINGS.sub("", word)
    return stem if len(stem) >= _FEWEST_LETTERS else word


def _words_of_entities(ontology: Ontology) -> Iterator[str]:
    for entity in ontology.entities:
        for text in (entity.text, *entity.aliases):
            yield from _words(text)


def with_entities(command: str, heard: Anonymized, ontology: Ontology) -> str:
    """Return a command with an entity for each class token: what the utterance names of its class, else the first of
    the world."""
    named: defaultdict[str, list[str]] = defaultdict(list)
    for span in heard.spans:
        named[span.entity_class].append(span.value)

    def fill(match: re.Match[str]) -> str:
        entity_class = match[0].strip("<>").rstrip("0123456789")
        values = named[entity_class] or [each.text for each in ontology.of_class(entity_class)[:1]]
        return (values.pop(0) if len(values) > 1 else values[0]) if values else match[0]

    return _TOKEN.sub(fill, command).replace(" ,", ",")


class NearCommands:
    """Finds the commands that an utterance is near, by the words that they share.

    Args:
        commands: with class tokens, ``bring me the <object>``.
    """

    def __init__(self, commands: Iterable[str]) -> None:
        self._commands = list(dict.fromkeys(commands))
        self._with_word: defaultdict[str, list[int]] = defaultdict(list)
        for number, command in enumerate(self._commands):
            for word in dict.fromkeys(_words(command)):
                self._with_word[word].append(number)
        self._weights = {
            word: math.log(1 + len(self._commands) / len(mine))
            for word, mine in self._with_word.items()
        }
        self._total = [
            sum(self._weights[word] for word in dict.fromkeys(_words(command)))
            for command in self._commands
        ]

    def nearest(self, heard: Anonymized, most: int = 3) -> tuple[str, ...]:
        """Return up to ``most`` commands, the nearest one first; none where nothing is near.

        A word that no command has counts as the one that is spelt alike. Linear in the words and the commands.
        """
        # In the order in which they were said: sums of weights, and so the answer, are the same in each process.
        words = dict.fromkeys(map(self._read, _words(heard.command)))
        shared: defaultdict[int, float] = defaultdict(float)
        for word in words:
            for number in self._with_word.get(word, ()):
                shared[number] += self._weights[word]
        unknown = max(self._weights.values(), default=0.0)
        mine = sum(self._weights.get(word, unknown) for word in words)
        likeness = {
            number: weight / (mine + self._total[number] - weight)
            for number, weight in shared.items()
        }
        near = (each for each in likeness if likeness[each] >= LEAST_ALIKE)
        best = nsmallest(
            MOST_COMPARED, near, key=lambda each: (-likeness[each], len(self._commands[each]), each)
        )
        chosen: list[str] = []
        for number in best:
            command = self._commands[number]
            if len(chosen) < most and all(_share(command, each) <= MOST_ALIKE for each in chosen):
                chosen.append(command)
        return tuple(chosen)

    def _read(self, word: str) -> str:
        if word in self._weights or len(word) <= _FEWEST_LETTERS:
            return word
        alike = extractOne(
            word, self._weights.keys(), scorer=OSA.normalized_similarity, score_cutoff=_SPELT_ALIKE
        )
        return alike[0] if alike else word
