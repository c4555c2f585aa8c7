"""Prepare an utterance for a grammar: the lattices of what it can be read as, the strictest one first.

1. The words as they are: a command of the grammar.
2. The longest names of entities, left to right, as class tokens: what ``Anonymizer`` makes of it.
3. Everything: all names of entities, also where they overlap; words and names without their case, accents,
   signs and spaces, and names in the plural; "a" for "an"; "this person" and a repeated name for "them"; a comma
   of the grammar that nobody wrote; and paths that pass over punctuation and courtesy.

What the third one reads otherwise than it is written costs something, so that the closest reading is the best.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from annotations.language.forms import ANTECEDENTS, CLASS_TOKEN, PERSON, THING, kind_of_class
from annotations.language.grammar import Arc, Lattice
from annotations.language.grounding.anonymizer import (
    Anonymized,
    Anonymizer,
    Likeness,
    Reading,
    Span,
    readings_of,
)
from annotations.language.grounding.heard_changes import (
    HeardChange,
    ReadWords,
    changes_between,
    fold,
    spoken_words,
    tokens_of,
)
from annotations.language.texts import (
    COURTESY_ANYWHERE,
    COURTESY_CLOSINGS,
    COURTESY_OPENINGS,
    DETERMINERS,
    PERSON_WORDS,
    REFERENCES,
    THING_WORDS,
)
from annotations.language.world import Ontology

_HYPHENS = frozenset("-‐‑–")
_ARTICLES = {"a": "an", "an": "a"}
# Costs of reading something otherwise than it is written.
FOLDED, SKIPPED = 1, 2
LONGEST_NAME = 8  # words
MOST_NAMESAKES = 20  # entities that one name is looked for in
MOST_SIGNS = 2  # next to each other in a name
MOST_SKIPPED = 24  # signs and words next to each other
DIGITS = "0123456789"


@dataclass(frozen=True, slots=True)
class HeardLattice:
    """A lattice, the entities for which its numbered arcs stand with the names by which they were called, and why its
    arcs change what they do.

    ``tokens`` says which characters of the utterance lie between a place and the next one; it is empty where the
    lattice reads words as they are.
    """

    lattice: Lattice
    spans: tuple[Span, ...] = ()
    tokens: tuple[tuple[int, int], ...] = ()
    utterance: str = ""
    names: tuple[str, ...] = ()
    changes: tuple[HeardChange, ...] = ()

    def heard(self, path: Sequence[Arc]) -> tuple[HeardChange, ...]:
        """Return what is read otherwise than it was said on a path from the first place to the last one, in order."""
        if not self.tokens:
            return ()
        read: list[ReadWords] = []
        words: list[str] = []
        reasons: list[HeardChange] = []
        for arc in path:
            words.append(self.names[arc.number] if arc.number >= 0 else arc.word)
            reasons += (self.changes[number] for number in arc.changes)
            # Two arcs may share a token, as "what" and "is" do "what's".
            if (
                not 0 < arc.end < len(self.tokens)
                or self.tokens[arc.end - 1] != self.tokens[arc.end]
            ):
                is_last = arc.end == len(self.tokens)
                end = len(self.utterance) if is_last else self.tokens[arc.end][0]
                read.append(ReadWords(end, " ".join(words), tuple(reasons)))
                words, reasons = [], []
        return changes_between(self.utterance, read)

    def values(self, arcs: Sequence[int | None]) -> tuple[str | None, ...]:
        """Return the entity of each arc, None for an arc that stands for none."""
        return tuple(None if number is None else self.spans[number].value for number in arcs)


class UtteranceReader:
    """Makes the lattices of utterances.

    Args:
        ontology: the entities that an utterance can name.
        vocabulary: the words and class tokens of the grammar; no other word gets an arc of the third lattice.
    """

    def __init__(self, ontology: Ontology, vocabulary: Collection[str]) -> None:
        self.anonymizer = Anonymizer(ontology)
        self._ontology = ontology
        self._vocabulary = frozenset(vocabulary)

    def lattices(self, utterance: str) -> Iterator[HeardLattice]:
        """Yield the lattices of an utterance that is normalised; stop at the first one that the grammar derives."""
        yield HeardLattice(Lattice.of_words(_words(utterance)))
        heard = self.anonymizer.anonymize(utterance)
        if heard.spans:
            yield _longest(heard)
        yield Everything(self, utterance).heard()

    @cached_property
    def names(self) -> dict[str, tuple[Name, ...]]:
        """Folded words, joined → the names that they may be."""
        found: defaultdict[str, list[Name]] = defaultdict(list)
        for entity in self._ontology.entities:
            for words, reading in readings_of(entity, self._ontology.classes):
                if key := "".join(fold(each) for each in spoken_words(words)):
                    found[key].append(Name(words, reading))
        return {key: tuple(dict.fromkeys(names))[:MOST_NAMESAKES] for key, names in found.items()}

    @cached_property
    def words(self) -> dict[str, tuple[str, ...]]:
        """Folded word → the words of the grammar that it may be."""
        found: defaultdict[str, list[str]] = defaultdict(list)
        for word in sorted(self._vocabulary):
            if word.startswith("<"):
                continue  # people say no class tokens
            found[fold(word)].append(word)
        return {folded: tuple(each) for folded, each in found.items()}

    def has(self, word: str) -> bool:
        """Whether the grammar has a word or a class token."""
        return word in self._vocabulary


def _words(text: str) -> list[str]:
    return text.replace(",", " , ").split()


@dataclass(frozen=True, slots=True)
class Name:
    """How an entity is called."""

    spelling: str
    reading: Reading

    def cost(self, said: str) -> int:
        """Return what it costs to hear the name in ``said``."""
        is_inflected = self.reading.likeness >= Likeness.INFLECTED
        return (0 if said == self.spelling.casefold() else FOLDED) + (FOLDED if is_inflected else 0)

    def rank(self, said: str) -> tuple[int, Likeness]:
        """The names of the lowest rank are meant: at equal cost, that of an entity itself before an alias."""
        return self.cost(said), self.reading.likeness


def _longest(heard: Anonymized) -> HeardLattice:
    """Return the one path that has the longest names as class tokens."""
    arcs: list[Arc] = []
    end = 0

    def add(words: Sequence[str], number: int = -1) -> None:
        for word in words:
            arcs.append(Arc(len(arcs), len(arcs) + 1, word, 0, number))

    for number, span in enumerate(heard.spans):
        # A token that is joined to what stands beside it is no word of its own.
        add(_words(heard.original[end : span.start]))
        add([span.token], number)
        end = span.end
    add(_words(heard.original[end:]))
    if [arc.word for arc in arcs] != _words(heard.text):
        return HeardLattice(Lattice.of_words(_words(heard.text)))
    return HeardLattice(Lattice(arcs, len(arcs)), heard.spans)


def _is_same(one: Span, other: Span) -> bool:
    return (one.entity_class, one.value) == (other.entity_class, other.value)


def _folded(phrases: Sequence[str]) -> list[list[str]]:
    return [[fold(word) for word in phrase.split()] for phrase in phrases]


_OPENINGS, _CLOSINGS = _folded(COURTESY_OPENINGS), _folded(COURTESY_CLOSINGS)
_ANYWHERE = _folded(COURTESY_ANYWHERE)
# Nouns for somebody or something that is described rather than named.
_DESCRIBED = {
    PERSON: PERSON_WORDS.difference(REFERENCES["them"]),
    THING: THING_WORDS.difference(REFERENCES["it"]),
}
_REFERENCES = {word: _folded(phrases) for word, phrases in REFERENCES.items()}


class Skip(NamedTuple):
    """A range of tokens that may be passed over, what that costs, and the numbers of the changes that it is."""

    start: int
    stop: int
    cost: int
    changes: tuple[int, ...] = ()


class Everything:
    """Collects the arcs of the third lattice. Places are between tokens."""

    def __init__(self, reader: UtteranceReader, utterance: str) -> None:
        self.reader = reader
        self.utterance = utterance
        self.tokens = tokens_of(utterance)
        self.texts = [utterance[start:end] for start, end in self.tokens]
        self.folded = [fold(text) for text in self.texts]
        self.spans: list[Span] = []
        self.names: list[str] = []  # of the spans, as they were called
        self.changes: dict[HeardChange, int] = {}

    def heard(self) -> HeardLattice:
        named = list(self._entity_arcs())
        arcs = [*self._word_arcs(), *named, *self._commas(), *self._references()]
        arcs += self._repetitions(named)
        end = len(self.tokens)
        lattice = Lattice(skipping(arcs, self.skips(), end), end)
        return self._made(lattice, tuple(self.tokens))

    def _made(self, lattice: Lattice, tokens: tuple[tuple[int, int], ...]) -> HeardLattice:
        spans, names, changes = tuple(self.spans), tuple(self.names), tuple(self.changes)
        return HeardLattice(lattice, spans, tokens, self.utterance, names, changes)

    def _change(self, kind: str, start: int, stop: int, heard: str) -> tuple[int, ...]:
        """Return the number of a change of the tokens from ``start`` to ``stop``."""
        if start < stop:
            first, last = self.tokens[start][0], self.tokens[stop - 1][1]
        else:
            first = last = (
                self.tokens[start][0] if start < len(self.tokens) else len(self.utterance)
            )
        change = HeardChange(kind, first, last, self.utterance[first:last], heard)
        return (self.changes.setdefault(change, len(self.changes)),)

    def _is_word(self, place: int) -> bool:
        return self.texts[place][0].isalnum()

    def _word_arcs(self) -> Iterator[Arc]:
        for place, (text, folded) in enumerate(zip(self.texts, self.folded, strict=True)):
            costs: dict[str, int] = {}
            if match := CLASS_TOKEN.fullmatch(text):
                costs[f"<{match[1].rstrip(DIGITS)}>"] = 0
            if self.reader.has(text):
                costs[text] = 0
            # A capital at the beginning of a sentence is no other word.
            for word in self.reader.words.get(folded, ()):
                costs.setdefault(word, 0 if word == text.casefold() else FOLDED)
            if folded in _ARTICLES:
                for word in self.reader.words.get(_ARTICLES[folded], ()):
                    costs.setdefault(word, FOLDED)
            for word, cost in costs.items():
                if self.reader.has(word):
                    yield Arc(place, place + 1, word, cost)
            yield from self._hyphenated(place)

    def _hyphenated(self, place: int) -> Iterator[Arc]:
        """Yield the words of the grammar with a hyphen that several tokens are: "t-shirt", "t shirt"."""
        joined, end = "", place
        while end < len(self.texts) and end - place < 5:
            if self._is_word(end):
                joined += self.folded[end]
            elif self.texts[end] not in _HYPHENS:
                return
            end += 1
            if end - place > 1:
                for word in self.reader.words.get(joined, ()):
                    if not _HYPHENS.isdisjoint(word):
                        yield Arc(place, end, word, FOLDED)

    def _commas(self) -> Iterator[Arc]:
        """Yield the commas that may be written nowhere: nobody says them."""
        if self.reader.has(","):
            for place in range(1, len(self.tokens)):
                yield Arc(place, place, ",", FOLDED)

    def _references(self) -> Iterator[Arc]:
        """Yield the words of the grammar for somebody or something said before: "him" may be its "them"."""
        for reference, phrases in _REFERENCES.items():
            for start, end in (each for phrase in phrases for each in self._places_of(phrase)):
                yield from self._reference(reference, start, end)

    def _reference(self, reference: str, start: int, end: int) -> Iterator[Arc]:
        """Yield the words of the grammar that mean the same as ``it`` or ``them``."""
        for word in {phrase for phrase in REFERENCES[reference] if " " not in phrase}:
            if self.reader.has(word) and self.folded[start:end] != [fold(word)]:
                yield Arc(start, end, word, FOLDED)

    def _repetitions(self, named: Sequence[Arc]) -> Iterator[Arc]:
        """Yield references for what is named again: "find Jane and follow Jane", "take the tea and bring the tea".

        It has to be the last that was named or described of its kind, as with a reference.
        """
        for arc in named:
            again = self.spans[arc.number]
            kind = kind_of_class(again.entity_class)
            for reference, kinds in ANTECEDENTS.items():
                if kind not in kinds:
                    continue
                before = [
                    each
                    for each in named
                    if each.end <= arc.start
                    and kind_of_class(self.spans[each.number].entity_class) in kinds
                ]
                last = max(before, key=lambda each: (each.end, -each.start), default=None)
                if last is None or not _is_same(self.spans[last.number], again):
                    continue
                if _DESCRIBED[kinds[0]].isdisjoint(self.folded[last.end : arc.start]):
                    is_after_article = self.folded[arc.start - 1] in DETERMINERS
                    yield from self._reference(reference, arc.start - is_after_article, arc.end)

    def _entity_arcs(self) -> Iterator[Arc]:
        for key, start, end in self._names_said():
            yield from self._named(key, start, end)

    def _names_said(self) -> Iterator[tuple[str, int, int]]:
        """Yield the names of the world that were said as they are, with their first and next token."""
        for start in range(len(self.tokens)):
            if not self._is_word(start):
                continue
            key, words, signs = "", 0, 0
            for end in range(start, len(self.tokens)):
                if self._is_word(end):
                    key, words, signs = key + self.folded[end], words + 1, 0
                else:
                    signs += 1
                if words > LONGEST_NAME or signs > MOST_SIGNS or self.texts[end].startswith("<"):
                    break
                # Signs at the end may be part of the name: C++.
                if key in self.reader.names:
                    yield key, start, end + 1

    def _named(self, key: str, start: int, end: int) -> Iterator[Arc]:
        names = self.reader.names[key]
        first, last = self.tokens[start][0], self.tokens[end - 1][1]
        said = self.utterance[first:last].casefold()
        is_word = self._is_word(end - 1)
        by_class: defaultdict[str, list[Name]] = defaultdict(list)
        for name in names:
            # A sign at the end belongs to a name that is written so, and to no other.
            if is_word or name.spelling.casefold() == said:
                by_class[name.reading.entity_class].append(name)
        for entity_class, called in by_class.items():
            token = f"<{entity_class}>"
            if self.reader.has(token):
                least = min(name.rank(said) for name in called)
                closest = [name for name in called if name.rank(said) == least]
                yield from self._arcs_for(closest, token, (start, end), (first, last), least[0])

    def _arcs_for(
        self,
        called: Sequence[Name],
        token: str,
        places: tuple[int, int],
        characters: tuple[int, int],
        cost: int,
        changes: tuple[int, ...] = (),
    ) -> Iterator[Arc]:
        """Yield an arc for each value that the words can mean."""
        for value in dict.fromkeys(each.reading.value for each in called):
            same = [each for each in called if each.reading.value == value]
            others = tuple(each.reading.entity for each in same[1:])
            arc = Arc(*places, token, cost, len(self.spans), changes)
            first = same[0].reading
            self.names.append(same[0].spelling)
            self.spans.append(
                Span(
                    *(*characters, token, first.entity_class, first.entity, value),
                    others,
                    first.likeness,
                )
            )
            yield arc

    def skips(self) -> list[Skip]:
        """Return what may be passed over. It costs by its signs and words, so that passing over less is cheaper."""
        return [
            Skip(
                *(start, stop, SKIPPED * (stop - start)),
                # A sign alone is no change.
                self._change("courtesy", start, stop, "") if self._is_word(start) else (),
            )
            for start, stop in self._skipped()
        ]

    def _skipped(self) -> list[tuple[int, int]]:
        """Return the ranges of tokens that may be passed over, as first and next place."""
        skipped = [
            (place, place + 1)
            for place, text in enumerate(self.texts)
            if not self._is_word(place) and not text.startswith("<")
        ]
        for phrase in _ANYWHERE:
            skipped += self._places_of(phrase)
        # Openings and closings follow one another from the two ends.
        skipped += self._chain(_OPENINGS)
        skipped += self._chain_back(_CLOSINGS)
        # The number of a list: "1. bring me the tea", "(2) follow Bo".
        number = next((place for place in range(len(self.texts)) if self._is_word(place)), 0)
        after = self.texts[number + 1 : number + 2]
        if after and self.texts[number].isdecimal() and not after[0][0].isalnum():
            skipped.append((number, number + 1))
        return sorted(set(skipped))

    def _places_of(
        self, words: Sequence[str], starts: Collection[int] | None = None
    ) -> Iterator[tuple[int, int]]:
        for start in range(len(self.texts)) if starts is None else starts:
            if self.folded[start : start + len(words)] == words:
                yield start, start + len(words)

    def _possible(self, phrases: Sequence[list[str]]) -> list[list[str]]:
        """Return the phrases whose first word was said: few of hundreds."""
        return [phrase for phrase in phrases if phrase[0] in self.folded]

    def _chain(self, phrases: Sequence[list[str]]) -> Iterator[tuple[int, int]]:
        waiting, seen = [0], {0}
        phrases = self._possible(phrases)
        while waiting:
            place = waiting.pop()
            ranges = [each for phrase in phrases for each in self._places_of(phrase, (place,))]
            yield from ranges
            after = [end for _, end in ranges]
            if place < len(self.texts) and not self._is_word(place):
                after.append(place + 1)
            most = min(len(self.texts), MOST_SKIPPED)
            waiting += [end for end in after if end not in seen and end < most]
            seen.update(after)

    def _chain_back(self, phrases: Sequence[list[str]]) -> Iterator[tuple[int, int]]:
        waiting, seen = [len(self.texts)], {len(self.texts)}
        phrases = self._possible(phrases)
        while waiting:
            end = waiting.pop()
            starts = []
            for phrase in phrases:
                start = end - len(phrase)
                if start >= 0 and [*self._places_of(phrase, (start,))]:
                    yield start, end
                    starts.append(start)
            if end and not self._is_word(end - 1):
                starts.append(end - 1)
            least = max(0, len(self.texts) - MOST_SKIPPED)
            waiting += [start for start in starts if start not in seen and start > least]
            seen.update(starts)


def skipping(arcs: Sequence[Arc], skips: Sequence[Skip], end: int) -> Iterator[Arc]:
    """Yield the arcs, and for each the arcs that pass over what may be skipped before it, or after it at the end.

    At most ``MOST_SKIPPED`` tokens are passed over together, which keeps the number of arcs in proportion to the
    utterance.
    """
    before: dict[int, dict[int, tuple[int, tuple[int, ...]]]] = {
        place: {place: (0, ())} for place in range(end + 1)
    }
    for skip in sorted(skips, key=lambda each: each.stop):
        for first, (cost, changes) in list(before[skip.start].items()):
            total = cost + skip.cost
            if skip.stop - first > MOST_SKIPPED:
                continue
            if first not in before[skip.stop] or total < before[skip.stop][first][0]:
                before[skip.stop][first] = total, changes + skip.changes
    for arc in arcs:
        endings: dict[int, tuple[int, tuple[int, ...]]] = {arc.end: (0, ())}
        if end != arc.end and arc.end in before[end]:
            endings[end] = before[end][arc.end]
        for first, (cost, passed) in before[arc.start].items():
            for last, (more, later) in endings.items():
                changes = passed + arc.changes + later
                yield Arc(first, last, arc.word, arc.cost + cost + more, arc.number, changes)
