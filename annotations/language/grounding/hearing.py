"""Hear commands through the noise of recognisers and hurried people.

A fourth lattice, for what the three of ``UtteranceReader`` do not give: everything that they read, and costlier arcs
that pass over fillers, repetitions and what was corrected, that put in or take out articles, write out contractions,
join and split words, and read words as near ones. The language judges: the cheapest path that it derives tells which
of these changes are made, so no text is changed that is understood as it is.

Words that make another request of a command (``KEPT_WORDS``, numbers) are never passed over nor read as others, and a
name of the world is never read as another name.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from annotations.language.grammar import Arc, Lattice
from annotations.language.grounding.anonymizer import Reading, readings_of
from annotations.language.grounding.heard_changes import (
    HeardChange,
    ReadWords,
    applied,
    changes_between,
    fold,
    spoken_words,
)
from annotations.language.grounding.utterance_lattice import (
    SKIPPED,
    Everything,
    HeardLattice,
    Name,
    Skip,
    UtteranceReader,
    skipping,
)
from annotations.language.texts import (
    ARTICLES,
    BOUNDARIES,
    CALLS,
    CONTRACTIONS,
    COURTESY_ANYWHERE,
    COURTESY_CLOSINGS,
    COURTESY_OPENINGS,
    DETERMINERS,
    FILLERS,
    HEARD_ANYWHERE,
    HEARD_CLOSINGS,
    HEARD_OPENINGS,
    KEPT_WORDS,
    LIKE_CONTRACTIONS,
    NUMBERS,
    OPEN_WORDS,
    PLACE_PREPOSITIONS,
    POSSESSIVES,
    REPAIRS,
    SOUNDS,
    SYNONYMS,
    Near,
    NearWords,
    is_common,
)

# Costs, beside those of near words.
FILLER, REPEATED, REPAIRED = 1, 1, 4  # more than what passing over costs
ARTICLE, CONTRACTED, JOINED, COUNTED, ALIAS = 3, 2, 3, 2, 4
MOST_REPAIRED = 6  # words that a correction takes back
MOST_REPEATED = 4  # words that are said twice
MOST_IN_A_NAME = 3  # changes in one name
MOST_TOKENS = 120  # of an utterance; a longer one is heard as it is
MOST_RIVALS = 4  # names that are equally near
SHORTEST_PART = 2  # letters of each of two words that were taken for one
LONGEST_SPLIT = 40  # letters of such a word
_INNER = 16  # places for the words of one token
_BLANK = " "

_NUMBER_WORDS = {word: str(number) for number, word in enumerate(NUMBERS)}
_WORDS_OF_NUMBERS = {digits: word for word, digits in _NUMBER_WORDS.items()}
_KEPT = KEPT_WORDS | set(NUMBERS[2:])
_FUNCTION_WORDS = BOUNDARIES | DETERMINERS | PLACE_PREPOSITIONS
_LIKE_PREPOSITIONS = frozenset(("two", "2", "four", "4"))
_CUT_OFF = frozenset("-‐‑–—…")
_WORD = re.compile(r"\w")
_APOSTROPHE = re.compile("['’]")


def _phrases(*lists: Iterable[str]) -> tuple[tuple[str, ...], ...]:
    return tuple(
        dict.fromkeys(
            tuple(fold(word) for word in phrase.split()) for each in lists for phrase in each
        )
    )


_SOUNDS = frozenset(map(fold, SOUNDS))
_FILLERS = _phrases(SOUNDS, FILLERS)
_REPAIRS = _phrases(REPAIRS)
_COURTESY = _phrases(COURTESY_OPENINGS, HEARD_OPENINGS)
# Those that begin no command.
_SAFE_OPENINGS = (
    *_phrases(COURTESY_OPENINGS),
    *(each for each in _phrases(HEARD_OPENINGS) if len(each) > 2),
)
_OPENINGS = [list(each) for each in (*_COURTESY, *_FILLERS)]
_CLOSINGS = [list(each) for each in _phrases(COURTESY_CLOSINGS, HEARD_CLOSINGS, SOUNDS)]
_ANYWHERE = _phrases(COURTESY_ANYWHERE, HEARD_ANYWHERE)
_CALLS = frozenset(map(fold, CALLS))
_BARE_REPAIRS = frozenset((("no",), ("better",), ("rather",), ("actually",)))


@dataclass(frozen=True, slots=True)
class HeardText:
    """A text without noise, and what was changed; the places are those of the utterance."""

    text: str
    changes: tuple[HeardChange, ...] = ()


@dataclass(frozen=True, slots=True)
class _Way:
    """A way to read some tokens as a name: what it changes, as first and next token, kind, and what is heard."""

    cost: int = 0
    changes: tuple[tuple[int, int, str, str], ...] = ()
    exact: int = 0  # words of the name that were said so
    is_sure: bool = True

    def then(self, cost: int, *change: tuple[int, int, str, str], is_sure: bool = True) -> _Way:
        return _Way(self.cost + cost, self.changes + change, self.exact, self.is_sure and is_sure)


class HearingReader(UtteranceReader):
    """Makes the lattices of utterances, and a fourth one for those that are noisy.

    Args:
        ontology: the entities that an utterance can name.
        vocabulary: the words and class tokens of the grammar.
    """

    def lattices(self, utterance: str) -> Iterator[HeardLattice]:
        """Yield the lattices of an utterance that is normalised; stop at the first one that the grammar derives.

        The last one is left out where no path leads through it.
        """
        yield from super().lattices(utterance)
        if noisy := _Noisy(self, utterance).heard_noisily():
            yield noisy

    def clean(self, utterance: str) -> HeardText:
        """Return an utterance, normalised, with the changes made that are safe without a grammar.

        Sounds, repetitions, corrections and courtesy are taken out, contractions written out, and a word that is
        none becomes the one name of the world that is nearest.
        """
        return _Noisy(self, utterance).cleaned()

    @cached_property
    def near_words(self) -> NearWords:
        """The words of the grammar."""
        return NearWords(self.words)

    @cached_property
    def near_name_words(self) -> NearWords:
        """The words of names, and names without the blanks in them."""
        return NearWords((*self.names, *(word for tokens in self._called for word in tokens)))

    @cached_property
    def known_words(self) -> frozenset[str]:
        """The words of the grammar and of names."""
        return frozenset(self.words) | {word for tokens in self._called for word in tokens}

    @cached_property
    def trie(self) -> dict[str, Any]:
        """The words of names → the next words. What is under "" are the keys of ``called`` that end there."""
        root: dict[str, Any] = {}
        for tokens in self._called:
            for path in {tokens, ("".join(tokens),)}:
                node = root
                for word in path:
                    node = node.setdefault(word, {})
                node.setdefault("", {})[tokens] = {}
        return root

    def called(self, tokens: tuple[str, ...]) -> tuple[tuple[str, Reading, bool], ...]:
        """Return what is called by the folded words: its name, its reading, and whether by a household synonym."""
        return tuple(self._called[tokens])

    @cached_property
    def _called(self) -> dict[tuple[str, ...], list[tuple[str, Reading, bool]]]:
        called: defaultdict[tuple[str, ...], list[tuple[str, Reading, bool]]] = defaultdict(list)
        names = [
            (words, reading)
            for entity in self._ontology.entities
            for words, reading in readings_of(entity, self._ontology.classes)
        ]
        for words, reading in names:
            if tokens := tuple(fold(each) for each in spoken_words(words)):
                called[tokens].append((words, reading, False))
        known = {"".join(tokens) for tokens in called}
        for words, reading in names:
            for other in _synonyms(tuple(fold(each) for each in spoken_words(words))):
                if "".join(other) not in known:
                    called[other].append((words, reading, True))
        return {tokens: list(dict.fromkeys(each))[:MOST_RIVALS] for tokens, each in called.items()}


def _synonyms(tokens: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    for group in _SYNONYMS:
        for phrase in group:
            size = len(phrase)
            for start in range(len(tokens) - size + 1):
                if tokens[start : start + size] == phrase:
                    for other in group:
                        if other != phrase:
                            yield tokens[:start] + other + tokens[start + size :]


_SYNONYMS = tuple(_phrases(group) for group in SYNONYMS)


class _Noisy(Everything):
    """Collects the arcs of the fourth lattice. Places are between tokens."""

    reader: HearingReader

    def __init__(self, reader: HearingReader, utterance: str) -> None:
        super().__init__(reader, utterance)
        self._split_tokens()
        self._kept = [each in _KEPT or each.isdigit() for each in self.folded]
        # What may be passed over inside a name.
        self._inside: defaultdict[int, list[tuple[int, str, int]]] = defaultdict(list)
        for start, stop, kind, cost in (*self._fillers(), *self._repeated()):
            self._inside[start].append((stop, kind, cost))

    def heard_noisily(self) -> HeardLattice | None:
        """Return the lattice; None where it has no path or the utterance is too long."""
        if not self.tokens or len(self.tokens) > MOST_TOKENS:
            return None
        named = list(self._entity_arcs())
        self._named_at = {(arc.start, arc.end) for arc in named}
        arcs = [*self._word_arcs(), *named, *self._commas(), *self._references()]
        arcs += self._repetitions(named)
        arcs += [*self._near_word_arcs(), *self._near_entity_arcs(), *self._articles()]
        arcs += [
            *self._contractions(),
            *self._joined(),
            *self._left_out_references(),
        ]
        end = len(self.tokens)
        paths = _on_paths(list(skipping(arcs, self.skips(), end)), end)
        if not paths:
            return None
        lattice = Lattice(_spread(paths), end * _INNER)
        places = tuple(token for token in self.tokens for _ in range(_INNER))
        return self._made(lattice, places)

    def cleaned(self) -> HeardText:
        """Return the utterance with its safe changes; as it is where nothing would be left or it is too long."""
        if not self.tokens or len(self.tokens) > MOST_TOKENS:
            return HeardText(self.utterance)
        # Whatever the vocabulary has: what is a name as it was said is no other name.
        self._named_at = {(start, end) for _, start, end in self._names_said()}
        taken: dict[int, ReadWords] = {}
        for start, stop, kind, heard in (*self._removed(), *self._mended()):
            if taken.keys().isdisjoint(range(start, stop)):
                first, last = self.tokens[start][0], self.tokens[stop - 1][1]
                change = HeardChange(kind, first, last, self.utterance[first:last], heard)
                read = ReadWords(last, heard, (change,))
                taken |= dict.fromkeys(range(start, stop), read)
        kept = (
            taken.get(place, ReadWords(end, text))
            for place, ((_, end), text) in enumerate(zip(self.tokens, self.texts, strict=True))
        )
        changes = changes_between(self.utterance, dict.fromkeys(kept))
        text = applied(self.utterance, changes)
        return HeardText(text, changes) if _WORD.search(text) else HeardText(self.utterance)

    def _removed(self) -> Iterator[tuple[int, int, str, str]]:
        """Yield what is taken out of any text."""
        place = 0
        openings = [list(each) for each in _SAFE_OPENINGS]
        while place < len(self.tokens):
            is_passed = not self._is_word(place) or self.folded[place] in _SOUNDS
            stops = [place + 1] if is_passed else []
            for phrase in openings:
                stops += [stop for _, stop in self._places_of(phrase, (place,))]
            if not stops:
                break
            if not is_passed:
                yield place, max(stops), "courtesy", ""
            place = max(stops)
        corrected: dict[int, int] = {}
        for first, last, is_clear in self._markers():
            starts = (
                start
                for start in range(first - 1, max(-1, first - 1 - MOST_REPAIRED), -1)
                if is_clear and last < len(self.tokens) and self._is_begun_again(start, first, last)
            )
            if (start := next(starts, None)) is not None:
                corrected[start] = max(last, corrected.get(start, 0))
        for start, last in corrected.items():
            yield start, last, "repair", ""
        for start, stop, kind, _ in self._repeated():
            yield start, stop, kind, ""
        for place, folded in enumerate(self.folded):
            if folded in _SOUNDS:
                yield place, place + 1, "filler", ""

    def _mended(self) -> Iterator[tuple[int, int, str, str]]:
        """Yield contractions, and words that are none and are near one name alone."""
        for place in range(len(self.tokens)):
            for first, second in self._written_out(place):
                if first in OPEN_WORDS and self.folded[place] not in LIKE_CONTRACTIONS:
                    yield place, place + 1, "contraction", f"{first} {second}"
                    break
        inside = {each for start, stop in self._named_at for each in range(start, stop)}
        for start in range(len(self.tokens)):
            near: dict[tuple[str, str], tuple[int, int, str]] = {}
            for stop, tokens, way in self._walk(start):
                changed = {each for change in way.changes for each in range(*change[:2])}
                if not changed or not changed.isdisjoint(inside):
                    continue
                if any(is_common(self.folded[each]) for each in changed):
                    continue
                for name, reading, is_synonym in self.reader.called(tokens):
                    key = reading.entity_class, reading.value
                    if not is_synonym and way.cost < near.get(key, (10**6,))[0]:
                        near[key] = way.cost, stop, name
            if near:
                cost, stop, name = min(near.values())
                if sum(each[0] == cost for each in near.values()) == 1:
                    kind = "joined" if stop - start > 1 else "spelling"
                    yield start, stop, kind, name

    def _split_tokens(self) -> None:
        """Make two tokens of one that is no word and that two known words are."""
        tokens = []
        known = self.reader.known_words
        for (start, end), folded in zip(self.tokens, self.folded, strict=True):
            cuts = (
                start + cut
                for cut in range(SHORTEST_PART, end - start - SHORTEST_PART + 1)
                if fold(self.utterance[start : start + cut]) in known
                and fold(self.utterance[start + cut : end]) in known
            )
            is_word = folded in known or is_common(folded) or folded in self.reader.names
            is_short = len(folded) == end - start <= LONGEST_SPLIT
            if is_short and not is_word and (cut := next(cuts, None)):
                tokens += [(start, cut), (cut, end)]
            else:
                tokens.append((start, end))
        self.tokens = tokens
        self.texts = [self.utterance[start:end] for start, end in tokens]
        self.folded = [fold(text) for text in self.texts]

    # What is read as another word.

    def _may_be_another(self, place: int) -> bool:
        return self._is_word(place) and not self._kept[place]

    def _near(self, table: NearWords, place: int) -> Iterator[Near]:
        if self._may_be_another(place):
            said = self.folded[place]
            # "bring me the objects" asks for several; "a drinks" for one.
            is_several = said.endswith("s") and {*self.folded[:place][-1:]}.isdisjoint(("a", "an"))
            for near in table.near(said):
                is_one = near.kind == "inflection" and not near.word.endswith("s")
                if not (place and is_several and is_one):
                    yield near
        elif self._is_counting_nothing(place):
            word = _WORDS_OF_NUMBERS.get(self.folded[place], self.folded[place])
            yield from (each for each in table.near(word) if each.kind == "sound")

    def _is_counting_nothing(self, place: int) -> bool:
        """Whether a number is none: "go two the kitchen". Nobody counts before an article."""
        return self.folded[place] in _LIKE_PREPOSITIONS and not (
            {*self.folded[place + 1 : place + 2]}.isdisjoint(DETERMINERS | {"me"})
        )

    def _near_word_arcs(self) -> Iterator[Arc]:
        for place, folded in enumerate(self.folded):
            for near in self._near(self.reader.near_words, place):
                if near.is_sure:
                    yield from self._word(place, place + 1, near.word, near.kind, near.cost)
            number = _NUMBER_WORDS.get(folded) or _WORDS_OF_NUMBERS.get(folded)
            if number:
                yield from self._word(place, place + 1, number, "number", COUNTED)

    def _word(self, start: int, stop: int, folded: str, kind: str, cost: int) -> Iterator[Arc]:
        for word in self.reader.words.get(folded, ()):
            yield Arc(start, stop, word, cost, changes=self._change(kind, start, stop, word))

    def _joined(self) -> Iterator[Arc]:
        """Yield words that were taken for two: "to gether"."""
        for place in range(len(self.tokens) - 1):
            if not (self._may_be_another(place) and self._may_be_another(place + 1)):
                continue
            both = self.folded[place] + self.folded[place + 1]
            if len(both) > len("anyone") or both in self.reader.words:
                yield from self._word(place, place + 2, both, "joined", JOINED)

    def _contractions(self) -> Iterator[Arc]:
        for place in range(len(self.tokens)):
            for words in self._written_out(place):
                yield from self._chain_of(place, words, "contraction", CONTRACTED)

    def _written_out(self, place: int) -> Iterator[tuple[str, str]]:
        """Yield what a contraction stands for."""
        text = self.texts[place].casefold()
        base, *ending = _APOSTROPHE.split(text)
        if text in LIKE_CONTRACTIONS:
            first, second = LIKE_CONTRACTIONS[text].split()
            yield first, second
        if len(ending) == 1 and ending[0] in CONTRACTIONS:
            yield fold(base), CONTRACTIONS[ending[0]]
        for short, long in CONTRACTIONS.items():
            if (
                len(short) < len(text)
                and text.endswith(short)
                and text[: -len(short)] in OPEN_WORDS
            ):
                yield text[: -len(short)], long

    def _chain_of(self, place: int, words: tuple[str, str], kind: str, cost: int) -> Iterator[Arc]:
        """Yield one arc for two words of the grammar; ``_spread`` makes two of it."""
        for first in self.reader.words.get(words[0], ()):
            for second in self.reader.words.get(words[1], ()):
                both = f"{first}{_BLANK}{second}"
                changes = self._change(kind, place, place + 1, both)
                yield Arc(place, place + 1, both, cost, changes=changes)

    # Articles and references.

    def _articles(self) -> Iterator[Arc]:
        """Yield articles that were left out, and others for those that were said."""
        for place, folded in enumerate(self.folded):
            if not self._is_word(place):
                continue
            if folded in DETERMINERS:
                for article in ("the", "a", "an"):
                    if article != folded:
                        yield from self._word(place, place + 1, article, "article", ARTICLE)
            elif folded not in _FUNCTION_WORDS and not (
                place and self.folded[place - 1] in DETERMINERS
            ):
                yield from self._word(place, place, "the", "article", ARTICLE)
                for article in ("a", "an"):
                    yield from self._word(place, place, article, "article", ARTICLE + 1)

    def _left_out_references(self) -> Iterator[Arc]:
        """Yield the "it" that two verbs share: "take and place it"."""
        for place, folded in enumerate(self.folded[:-2]):
            if place and folded == "and" and "it" in self.folded[place + 2 : place + 4]:
                yield from self._word(place, place, "it", "article", ARTICLE)

    # Names.

    def _near_entity_arcs(self) -> Iterator[Arc]:
        for start in range(len(self.tokens)):
            if not self._is_word(start):
                continue
            ways: defaultdict[tuple[int, str], list[tuple[_Way, str, Reading]]] = defaultdict(list)
            for end, tokens, way in self._walk(start):
                is_name = "".join(self.folded[start:end]) in self.reader.names
                for name, reading, is_synonym in self.reader.called(tokens):
                    if is_name and not all(change[2] == "inflection" for change in way.changes):
                        continue
                    if is_name and is_synonym:
                        continue
                    heard = way.then(ALIAS, (start, end, "alias", name)) if is_synonym else way
                    if heard.changes:
                        ways[end, reading.entity_class].append((heard, name, reading))
            for (end, entity_class), found in ways.items():
                if self.reader.has(f"<{entity_class}>"):
                    yield from self._nearest(start, end, found)

    def _nearest(
        self, start: int, end: int, found: Sequence[tuple[_Way, str, Reading]]
    ) -> Iterator[Arc]:
        """Yield an arc for each of the nearest names."""
        least = min(way.cost for way, _, _ in found)
        values: set[str] = set()
        for way, name, reading in found:
            if way.cost > least or reading.value in values or len(values) == MOST_RIVALS:
                continue
            values.add(reading.value)
            changes = tuple(
                number
                for first, stop, kind, heard in way.changes
                for number in self._change(kind, first, stop, _as_written(heard, name))
            )
            token = f"<{reading.entity_class}>"
            characters = self.tokens[start][0], self.tokens[end - 1][1]
            yield from self._arcs_for(
                [Name(name, reading)], token, (start, end), characters, least, changes
            )

    def _walk(self, start: int) -> Iterator[tuple[int, tuple[str, ...], _Way]]:
        """Yield where a name that begins at ``start`` can end, its folded words, and how it is read."""
        best: dict[tuple[int, int], int] = {}
        waiting = [(start, self.reader.trie, _Way())]
        while waiting:
            place, node, way = waiting.pop()
            if len(way.changes) > MOST_IN_A_NAME or best.get((place, id(node)), 10**6) < way.cost:
                continue
            best[place, id(node)] = way.cost
            if place > start and (way.is_sure or way.exact):
                for tokens in node.get("", ()):
                    yield place, tokens, way
            if place < len(self.tokens):
                waiting += self._steps(start, place, node, way)
            if place < len(self.tokens):
                for word in (POSSESSIVES if place > start else ARTICLES) & node.keys():
                    left_out = way.then(ARTICLE, (place, place, "article", word))
                    waiting.append((place, node[word], left_out))

    def _steps(
        self,
        start: int,
        place: int,
        node: dict[str, Any],
        way: _Way,
    ) -> Iterator[tuple[int, dict[str, Any], _Way]]:
        folded = self.folded[place]
        if not self._is_word(place):
            if place > start:
                yield place + 1, node, way.then(SKIPPED)
            return
        if folded in node:
            more = folded not in _FUNCTION_WORDS
            yield place + 1, node[folded], replace(way, exact=way.exact + more)
        for near in self._near(self.reader.near_name_words, place):
            if near.word in node:
                change = (place, place + 1, near.kind, near.word)
                yield (
                    place + 1,
                    node[near.word],
                    way.then(near.cost, change, is_sure=near.is_sure),
                )
        if folded in POSSESSIVES:
            for word in POSSESSIVES & node.keys() - {folded}:
                change = (place, place + 1, "inflection", word)
                yield place + 1, node[word], way.then(ARTICLE, change)
        number = _NUMBER_WORDS.get(folded) or _WORDS_OF_NUMBERS.get(folded)
        if number in node:
            change = (place, place + 1, "number", number)
            yield place + 1, node[number], way.then(COUNTED, change)
        for first, second in self._written_out(place):
            if second in node.get(first, ()):
                change = (place, place + 1, "contraction", f"{first} {second}")
                yield place + 1, node[first][second], way.then(CONTRACTED, change)
        for stop, kind, cost in self._inside.get(place, ()) if place > start else ():
            yield stop, node, way.then(cost, (place, stop, kind, ""))
        if place + 1 < len(self.tokens) and self._may_be_joined(place):
            both = folded + self.folded[place + 1]
            if both in node and place + 2 - start > 1:
                change = (place, place + 2, "joined", both)
                yield place + 2, node[both], way.then(JOINED, change)
            parts = {folded, self.folded[place + 1]}
            is_free = parts.isdisjoint(_FUNCTION_WORDS) and parts.isdisjoint(self.reader.names)
            for near in self.reader.near_name_words.near(both) if is_free else ():
                if near.word in node and near.is_sure and near.kind != "inflection":
                    change = (place, place + 2, "joined", near.word)
                    yield place + 2, node[near.word], way.then(near.cost + JOINED, change)

    def _may_be_joined(self, place: int) -> bool:
        return all(
            self._may_be_another(each) and self.folded[each] not in DETERMINERS | {"and", "me"}
            for each in (place, place + 1)
        )

    # What is passed over.

    def skips(self) -> list[Skip]:
        plain = [
            Skip(place, place + 1, SKIPPED)
            for place, text in enumerate(self.texts)
            if not self._is_word(place) and not text.startswith("<")
        ]
        found = [*self._courtesy(), *self._fillers(), *self._repeated(), *self._repaired()]
        return [
            *plain,
            *(
                Skip(start, stop, cost, self._change(kind, start, stop, ""))
                for start, stop, kind, cost in dict.fromkeys(found)
            ),
        ]

    def _courtesy(self) -> Iterator[tuple[int, int, str, int]]:
        ranges = [*self._chain(_OPENINGS), *self._chain_back(_CLOSINGS), *self._called_by()]
        ranges += [each for phrase in _ANYWHERE for each in self._places_of(list(phrase))]
        for start, stop in ranges:
            is_filler = tuple(self.folded[start:stop]) in _FILLERS
            kind = "filler" if is_filler else "courtesy"
            yield start, stop, kind, SKIPPED * (stop - start)
        for place, folded in enumerate(self.folded):
            if folded in ARTICLES:
                yield place, place + 1, "article", ARTICLE

    def _called_by(self) -> Iterator[tuple[int, int]]:
        """Yield the address of a robot that has some name: "hey Rosie"."""
        for place in range(min(MOST_REPAIRED, len(self.tokens) - 1)):
            name = self.folded[place + 1]
            is_known = name in self.reader.words or name in self.reader.trie
            if self.folded[place] in _CALLS and self._may_be_another(place + 1) and not is_known:
                yield place, place + 2

    def _fillers(self) -> Iterator[tuple[int, int, str, int]]:
        for phrase in _FILLERS:
            for start, stop in self._places_of(list(phrase)):
                yield start, stop, "filler", SKIPPED * (stop - start) + FILLER

    def _repeated(self) -> Iterator[tuple[int, int, str, int]]:
        """Yield words that are said once more right away, whatever sounds and signs are between."""
        words = [
            place
            for place in range(len(self.tokens))
            if self._is_word(place) and self.folded[place] not in _SOUNDS
        ]
        said = [self.folded[place] for place in words]
        for first in range(len(words)):
            for size in range(1, MOST_REPEATED + 1):
                again = first + size
                if again + size <= len(words) and said[first:again] == said[again : again + size]:
                    yield words[first], words[again], "repeated", REPEATED + size
            # A word that was broken off: "kit- kitchen".
            if first + 1 < len(words) and words[first + 1] == words[first] + 2:
                is_broken = self.texts[words[first] + 1] in _CUT_OFF
                if is_broken and said[first + 1].startswith(said[first]):
                    yield words[first], words[first + 1], "repeated", REPEATED

    def _repaired(self) -> Iterator[tuple[int, int, str, int]]:
        """Yield what is corrected, with the words that say so: "the biggest, no,"."""
        for first, last, is_clear in self._markers():
            if last >= len(self.tokens) or not self._is_word(last):
                continue
            if not first:
                yield 0, last, "repair", SKIPPED * last
            for start in range(first - 1, -1, -1):
                if self._kept[start]:
                    break
                if self._is_word(start) and self._is_corrected(start, first, last, is_clear):
                    yield start, last, "repair", REPAIRED + SKIPPED * (last - start)

    def _markers(self) -> Iterator[tuple[int, int, bool]]:
        """Yield the ranges of the words that announce a correction, and whether they can mean nothing else."""
        ranges = {
            (start, stop): phrase
            for phrase in _REPAIRS
            for start, stop in self._places_of(list(phrase))
        }
        between = {
            place
            for place in range(len(self.tokens))
            if not self._is_word(place) or self.folded[place] in _SOUNDS
        }
        starts = {
            start: max(stop for first, stop in ranges if first == start) for start, _ in ranges
        }
        for start, stop in list(ranges):
            first, last = start, stop
            while first and first - 1 in between:
                first -= 1
            while last in between or last in starts:
                last = last + 1 if last in between else starts[last]
            is_clear = ranges[start, stop] not in _BARE_REPAIRS or last - first > 1
            yield first, last, is_clear
        for place in sorted(between):
            if self.texts[place] in _CUT_OFF and 0 < place < len(self.tokens) - 1:
                yield place, place + 1, False

    def _is_corrected(self, start: int, first: int, last: int, is_clear: bool) -> bool:
        """Whether what begins at ``last`` can stand in place of the words from ``start`` to ``first``."""
        words = self.folded[start:first]
        again = self.folded[last]
        if not start and is_clear and again not in _FUNCTION_WORDS:
            return True  # a new beginning
        if first - start > MOST_REPAIRED:
            return False
        if self._is_begun_again(start, first, last):
            return True
        is_name = (start, first) in self._named_at or len(words) == 1
        return is_clear and is_name and words[0] not in _FUNCTION_WORDS

    def _is_begun_again(self, start: int, first: int, last: int) -> bool:
        """Whether what follows a correction begins like the words before it, which are one phrase without a word
        that is kept."""
        words, again = self.folded[start:first], self.folded[last]
        if any(self._kept[start:first]) or sum(word in DETERMINERS for word in words) > 1:
            return False
        kinds = (DETERMINERS, PLACE_PREPOSITIONS, {again})
        return any(words[0] in kind and again in kind for kind in kinds)


def _as_written(heard: str, name: str) -> str:
    """Return a folded word, or all of them together, as they are written in a name."""
    words = {fold(word): word for word in spoken_words(name)}
    return name if heard == "".join(words) else words.get(heard, heard)


def _on_paths(arcs: Sequence[Arc], end: int) -> list[Arc]:
    """Return the arcs that are on a path from the first place to the last one."""
    forward = _reached(0, ((arc.start, arc.end) for arc in sorted(arcs, key=lambda arc: arc.start)))
    if end not in forward:
        return []
    by_end = sorted(arcs, key=lambda arc: -arc.end)
    backward = _reached(end, ((arc.end, arc.start) for arc in by_end))
    return [arc for arc in arcs if arc.start in forward and arc.end in backward]


def _reached(start: int, steps: Iterable[tuple[int, int]]) -> set[int]:
    reached = {start}
    for one, other in steps:
        if one in reached:
            reached.add(other)
    return reached


def _spread(arcs: Iterable[Arc]) -> Iterator[Arc]:
    """Yield the arcs with ``_INNER`` places a token, and two arcs for one that reads two words."""
    used: defaultdict[int, int] = defaultdict(int)
    for arc in arcs:
        start, stop = arc.start * _INNER, arc.end * _INNER
        first, _, second = arc.word.partition(_BLANK)
        if not second:
            yield replace(arc, start=start, end=stop)
            continue
        if used[stop] + 1 >= _INNER:
            continue
        used[stop] += 1
        middle = stop - used[stop]
        yield replace(arc, start=start, end=middle, word=first)
        yield Arc(middle, stop, second)
