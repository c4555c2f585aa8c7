"""Cut an utterance that holds several commands into its commands.

A grammar tells which parts of an utterance are commands: *islands*. Those that do not overlap, hold no end of a
sentence, and cover most words are taken, the fewest of them. What lies between two of them is an announcement or a
joint, whatever its wording ("my second wish is", "once that's done"), and is dropped, unless it may be a command
itself: what names an entity or begins like a command is a piece of its own that was not understood.

Where there is no grammar, only a parser can tell: a cut is tried at signs and at the joints of ``english``, and the
parser judges the pieces (``cut_at_joints``).
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import compress, groupby, pairwise
from typing import NamedTuple

from annotations.language.plans.qualifying import Qualified, holds_in
from annotations.language.texts import (
    ARTICLES,
    BOUNDARIES,
    CHOOSING_WORDS,
    COMMAND_NOUNS,
    COURTESY_CLOSINGS,
    COURTESY_OPENINGS,
    DETERMINERS,
    FINISHED_WORDS,
    HEARD_CLOSINGS,
    JOINT_OPENINGS,
    JOINTS,
    NEGATIONS,
    NO_COMMAND_WORDS,
    NUMBERS,
    PLACE_PREPOSITIONS,
    PRONOUNS,
    SEQUENCE_NOUNS,
    SEQUENCE_WORDS,
    TELLING_WORDS,
    YES_WORDS,
)

MOST_COMMANDS = 3  # as many as a referee gives at once
MOST_JOINTS = 16  # in an utterance, so at most 153 pieces; one with more is not cut

Judge = Callable[[Sequence[str]], Sequence[float | None]]
"""Returns for each piece how well it is understood as one command; None for one that is not."""


@dataclass(frozen=True, slots=True)
class Piece:
    """A part of an utterance: its characters ``start`` to ``end``, and whether it is understood as one command."""

    start: int
    end: int
    text: str
    is_understood: bool


@dataclass(frozen=True, slots=True)
class Islands:
    """What a grammar finds in an utterance. Places are characters of it.

    ``spans`` are what it derives as one command, ``names`` the entities that are named. ``beginnings`` are words
    that its commands begin with, in lower case.
    """

    spans: frozenset[tuple[int, int]] = frozenset()
    names: frozenset[tuple[int, int]] = frozenset()
    beginnings: frozenset[str] = frozenset()

    def union(self, other: Islands) -> Islands:
        return Islands(
            self.spans | other.spans,
            self.names | other.names,
            self.beginnings | other.beginnings,
        )

    def without(self, spans: Collection[tuple[int, int]]) -> Islands:
        return replace(self, spans=self.spans.difference(spans))


def cut(utterance: str, islands: Islands, judge: Judge | None = None) -> tuple[Piece, ...]:
    """Return the commands of an utterance, in its order, and what may be one and is not understood.

    What is forbidden, has a condition or is taken back is not understood. An utterance with a single island comes
    back whole, and is not understood, unless the rest only counts ("Command one: ...") or is held back: it may be
    one command in other words, or said of something else.

    Args:
        islands: what the grammar finds.
        judge: is asked about what the grammar does not derive; not about what is held back.
    """
    # People also end a sentence inside a command: "Go to the galley. Then find the cup and bring it to me."
    for is_across in (False, True):
        pieces = _Cut(utterance, islands, is_across).pieces(None)
        if all(each.is_understood for each in pieces):
            return pieces
    return _Cut(utterance, islands, False).pieces(judge)


_WORD = re.compile(r"\w+(?:['’-]\w+)*")
_CONTRACTED = re.compile(r"(?<!^let)['’](?:s|re|ve|ll|d|m)$")
_SENTENCE_END = re.compile(r"[.!?…](?=\s|$)|[;\n]")
_NUMBERED = re.compile(r"no\.?\s*\d", re.IGNORECASE)  # "task no. 2" forbids nothing
_SIGN = re.compile(r"[^\w\s'’]")
_AROUND = " \t\n.,;:!?"


class _Range(NamedTuple):
    """Words ``first`` to ``last``, the latter not included. ``is_command``: an island.

    What begins before word ``reach`` is part of it.
    """

    first: int
    last: int
    is_command: bool = False
    is_held: bool = False
    reach: int = 0


class _Cut:
    """One way to cut an utterance. Ranges are of its words."""

    def __init__(self, utterance: str, islands: Islands, is_across: bool) -> None:
        self.utterance = utterance
        self.islands = islands
        self.words = [match.span() for match in _WORD.finditer(utterance)]
        # "Here's" counts as "here".
        self.said = [_CONTRACTED.sub("", utterance[slice(*word)].casefold()) for word in self.words]
        self.is_across = is_across
        self.places: dict[tuple[int, int], tuple[int, int]] = {}

    def pieces(self, judge: Judge | None) -> tuple[Piece, ...]:
        if not self.words:
            return ()
        held = self._held()
        chosen = self._choose(held)
        ranges = sorted([*chosen, *held])
        ranges = self._joined(sorted([*ranges, *self._unknown(ranges)]))
        islands = [each.first for each in chosen]
        rests = {each for each in ranges if self._is_rest(each, islands)}
        n_commands = len(ranges) - len(rests) - sum(each.is_held for each in ranges)
        is_one = n_commands < 2 and len(ranges) < 2 and not self._is_counted(ranges)
        if n_commands < 2 and rests:
            is_one = not (islands and self._are_apart(rests)) or self._is_whole(judge)
        if is_one:
            ranges = [_Range(0, len(self.words), is_held=bool(held))]
        elif judge:
            ranges = self._judge_sentences(ranges, rests, judge)
        return tuple(piece for each in ranges for piece in self._as_pieces(each, judge))

    def _is_rest(self, words: _Range, islands: Sequence[int]) -> bool:
        """Whether no island is in a range, and no reason not to take it for a part of the command beside it."""
        has_island = bisect_left(islands, words.first) < bisect_left(islands, words.last)
        return not (has_island or words.is_held or words.reach)

    def _is_whole(self, judge: Judge | None) -> bool:
        """Whether a parser understands all words as one command."""
        text = self.utterance[self.words[0][0] : self.words[-1][1]]
        return judge is not None and judge([text])[0] is not None

    def _are_apart(self, rests: Iterable[_Range]) -> bool:
        """Whether what is not understood begins like a command of its own, behind a joint or in another sentence."""
        return all(
            (each.first in (0, *self.ends) or self.said[each.first - 1] in _CONJUNCTIONS)
            and self._is_parted(each.first)
            and self._is_parted(each.last)
            for each in rests
        )

    def _judge_sentences(
        self, ranges: Sequence[_Range], rests: Collection[_Range], judge: Judge
    ) -> list[_Range]:
        """Join what a sentence holds where it is one command in other words: "go to the galley and fetch some tea"."""
        groups = [
            list(group) for _, group in groupby(ranges, lambda each: self._sentence(each.first))
        ]
        asked = [
            len(each) > 1
            and not any(one.is_held for one in each)
            and any(one in rests for one in each)
            for each in groups
        ]
        texts = [
            self.utterance[self.words[each[0].first][0] : self.words[each[-1].last - 1][1]]
            for each in groups
        ]
        scores = iter(judge(list(compress(texts, asked))) if any(asked) else ())
        judged: list[_Range] = []
        for group, is_asked in zip(groups, asked, strict=True):
            if is_asked and next(scores) is not None:
                first, last = group[0].first, group[-1].last
                self.places[first, last] = self.words[first][0], self.words[last - 1][1]
                group = [_Range(first, last, is_command=True)]
            judged += group
        return judged

    # Sentences and signs

    @cached_property
    def starts(self) -> list[int]:
        return [start for start, _ in self.words]

    @cached_property
    def ends(self) -> list[int]:
        """The words after which a sentence ends, none of them inside a name."""
        places = [match.start() for match in _SENTENCE_END.finditer(self.utterance)]
        inside = {
            place
            for start, end in self.islands.names
            for place in places[bisect_left(places, start) : bisect_left(places, end)]
        }
        last = (bisect_left(self.starts, place) for place in places if place not in inside)
        return sorted({each for each in last if 0 < each < len(self.words)} | {len(self.words)})

    @cached_property
    def named(self) -> frozenset[int]:
        """The words that name entities."""
        return frozenset(
            word
            for start, end in self.islands.names
            for word in range(bisect_left(self.starts, start), bisect_left(self.starts, end))
        )

    def _sentence(self, word: int) -> tuple[int, int]:
        """Return the first word of the sentence of a word, and that of the next sentence."""
        number = bisect_right(self.ends, word)
        return (self.ends[number - 1] if number else 0), self.ends[number]

    def _is_parted(self, word: int) -> bool:
        """Whether a sign or a joint stands between a word and the one before."""
        if word in (0, len(self.words)):
            return True
        beside = self.said[word - 1 : word + 1]
        if not CHOOSING_WORDS.isdisjoint(beside) or beside[1] == "but":
            return False  # of two things one is meant; or it restricts the one before
        between = self.utterance[self.words[word - 1][1] : self.words[word][0]]
        return bool(_SIGN.search(between)) or "\n" in between or not _PARTING.isdisjoint(beside)

    # Islands

    def _held(self) -> list[_Range]:
        """Return what is held back: from the words that do so to the end of the sentence, or all of it."""
        ranges: list[_Range] = []
        for held in holds_in(self.utterance):
            if _NUMBERED.match(self.utterance, held.start):
                continue
            word = bisect_right(self.starts, held.start) - 1
            first, last = self._sentence(word)
            if held.code == Qualified.FORBIDDEN:
                first = next(each for each in range(word, -1, -1) if self._is_parted(each))
            if held.code == Qualified.TAKEN_BACK and first:
                first, _ = self._sentence(first - 1)
            ranges.append(_Range(first, last, is_held=True))
        return _merged(ranges)

    def _choose(self, held: Sequence[_Range]) -> list[_Range]:
        """Return the islands that cover most words, and are fewest. Takes linear time in words and islands."""
        ending: dict[int, list[tuple[int, int]]] = {}
        for start, end in self.islands.spans:
            first = bisect_left(self.starts, start)
            last = bisect_left(self.starts, end)
            if first < last and (self.is_across or not self._holds_end(first, last)):
                self.places[first, last] = max(start, self.starts[first]), end
                ending.setdefault(last, []).append((first, last))
        blocked = [False] * len(self.words)
        for each in held:
            blocked[each.first : each.last] = [True] * (each.last - each.first)
        free = 0  # the first word from which on none is blocked
        best: list[tuple[int, int, tuple[int, int] | None]] = [(0, 0, None)]
        for place in range(1, len(self.words) + 1):
            if blocked[place - 1]:
                free = place
            best.append((*best[place - 1][:2], None))
            for first, last in ending.get(place, ()):
                if first >= free:
                    covered, fewer, _ = best[first]
                    option = covered + last - first, fewer - 1, (first, last)
                    best[place] = max(best[place], option, key=lambda each: each[:2])
        chosen: list[_Range] = []
        place = len(self.words)
        while place:
            taken = best[place][2]
            if taken:
                chosen.append(_Range(*taken, is_command=True))
            place = taken[0] if taken else place - 1
        return chosen[::-1]

    def _holds_end(self, first: int, last: int) -> bool:
        return self._sentence(first)[1] < last

    # What lies between

    def _unknown(self, ranges: Sequence[_Range]) -> Iterator[_Range]:
        """Yield what lies between and may be a command, sentence by sentence."""
        first = 0
        for stop in (*ranges, _Range(len(self.words), len(self.words))):
            while first < stop.first:
                last = min(self._sentence(first)[1], stop.first)
                reach = self._reach(first, last)
                if reach or self._may_be_command(first, last):
                    yield _Range(first, last, reach=reach)
                first = last
            first = stop.last

    def _reach(self, first: int, last: int) -> int:
        """Return up to where what follows is told or asked rather than ordered, or has a condition; 0: nowhere."""
        said = self.said[first:last]
        is_attached = not self._is_parted(last)
        is_told = not TELLING_WORDS.isdisjoint(said) and said[-2:] != ["you", "to"]
        is_told = is_told and is_attached and COMMAND_NOUNS.isdisjoint(said)
        is_asked = is_attached and self._is_parted(first) and said[0] in _QUESTIONS
        if is_told or is_asked or said[-1] in TELLING_WORDS:
            return self._sentence(first)[1]
        opening = next((each for each in said if each not in _PARTING), "")
        is_timed = opening in _WHEN and (_DONE_WORDS | _COUNTING).isdisjoint(said)
        if is_timed or (
            opening in _SUBORDINATING and not self.named.isdisjoint(range(first, last))
        ):
            return min(last + 1, self._sentence(first)[1])
        return 0

    def _may_be_command(self, first: int, last: int) -> bool:
        """Whether words between two islands say something that must not be passed over."""
        if not self.named.isdisjoint(range(first, last)):
            return True
        said = self.said[first:last]
        if not CHOOSING_WORDS.isdisjoint(said):
            return True
        negated = (
            each in NEGATIONS and not after.isdecimal() for each, after in pairwise([*said, ""])
        )
        if not self._is_parted(last) and any(negated):
            return True
        if not self._is_parted(first):
            # "for my grandmother", "three times": it goes on with the island before.
            follows = next((each for each in said if not self._is_function(each)), None)
            is_described = said[0] in _GOING_ON and said[1:2] and said[1] in _DEFINITE
            is_end = last in self.ends or said[-1] in _CONJUNCTIONS
            is_end = is_end and said[0] not in _PREDICATING
            if follows and follows not in _COUNTING_NOUNS and (is_described or is_end):
                return True
        if not COMMAND_NOUNS.isdisjoint(said):
            return False
        parts = [first, *filter(self._is_parted, range(first + 1, last)), last]
        return any(self._begins_command(first, *part) for part in pairwise(parts))

    def _is_function(self, word: str) -> bool:
        return word in _FUNCTION or word.isdecimal() or len(word) == 1

    def _begins_command(self, begin: int, first: int, last: int) -> bool:
        """Whether words begin as a command does: by a word of the grammar, or "turn off the lights".

        ``begin`` is the first word of what is not understood, of which they are a part.
        """
        while first < last and self.said[first] in _FUNCTION:
            if self.said[first] not in _BEFORE_COMMAND:
                return False
            first += 1
        if first == last or self.said[first] in NUMBERS:
            return False
        rest = self.said[first + 1 : last]
        if "you" in rest[:3]:
            return False  # "let me tell you": nobody asks a robot to tell itself
        # "Find Ann and walk after her", "… and wait": whatever the verb. "Once you've managed it" is told.
        is_told = not _TOLD.isdisjoint(self.said[begin:first])
        if not is_told and " ".join(self.said[first:last]) not in HEARD_CLOSINGS:
            is_last = last in self.ends and self.said[first - 1] in _CONJUNCTIONS
            if is_last or not _REFERRING.isdisjoint(rest):
                return True
        if self.said[first] in self.islands.beginnings:
            return any(each not in _FUNCTION | _COUNTING for each in rest)
        objects = rest[1:] if rest[:1] and rest[0] in BOUNDARIES - _DEFINITE else rest
        has_object = objects[:1] and objects[0] in _DEFINITE and len(objects) > 1
        return bool(has_object) and self._is_parted(last) and objects[1] not in _COUNTING

    def _joined(self, ranges: Sequence[_Range]) -> list[_Range]:
        """Join what is not understood with the island that it is part of: no sign or joint parts them."""
        joined: list[_Range] = []
        for each in ranges:
            before = joined[-1] if joined else None
            if (
                before
                and (before.last == each.first or each.first < before.reach)
                and not (before.is_command and each.is_command)
                and (
                    (before.is_held and each.is_held)
                    or each.first < before.reach
                    or not self._is_parted(each.first)
                )
            ):
                is_held = before.is_held or each.is_held
                reach = max(before.reach, each.reach)
                joined[-1] = _Range(before.first, each.last, is_held=is_held, reach=reach)
            else:
                joined.append(each)
        return joined

    def _is_counted(self, ranges: Sequence[_Range]) -> bool:
        """Whether the one island is all that is said, but for words that count commands before it."""
        if not (ranges and ranges[0].is_command and ranges[0].last == len(self.words)):
            return False
        before = self.said[: ranges[0].first]
        is_plain = all(each in _FUNCTION | _COUNTING or each.isdecimal() for each in before)
        return is_plain and (
            not before or any(each in _COUNTING or each.isdecimal() for each in before)
        )

    # Pieces

    def _as_pieces(self, words: _Range, judge: Judge | None) -> Iterator[Piece]:
        if words.is_command:
            start, end = self.places[words.first, words.last]
            yield self._piece(start, end, True)
            return
        start, end = self.words[words.first][0], self.words[words.last - 1][1]
        if words.is_held:
            yield self._piece(start, end, False)
            return
        if words.first or words.last < len(self.words):
            if opening := _OPENING.match(self.utterance, start, end):
                start = opening.end()
            last = words.last
            while last > words.first + 1 and self.said[last - 1] in _PARTING:
                last -= 1
            end = min(end, self.words[last - 1][1])
        for each in cut_at_joints(self.utterance[start:end], judge):
            yield self._piece(start + each.start, start + each.end, each.is_understood)

    def _piece(self, start: int, end: int, is_understood: bool) -> Piece:
        end -= len(self.utterance[start:end]) - len(self.utterance[start:end].rstrip(_AROUND))
        return Piece(start, end, self.utterance[start:end], is_understood)


def _merged(ranges: Iterable[_Range]) -> list[_Range]:
    """Return ranges that are held back, those that overlap as one."""
    merged: list[_Range] = []
    for each in sorted(ranges):
        if merged and each.first < merged[-1].last:
            each = each._replace(first=merged[-1].first, last=max(each.last, merged.pop().last))
        merged.append(each)
    return merged


def _words_of(phrases: Iterable[str]) -> frozenset[str]:
    return frozenset(word for phrase in phrases for word in phrase.split())


_PARTING = frozenset(each for each in JOINTS if " " not in each).difference(SEQUENCE_WORDS)
_CONJUNCTIONS = _PARTING & BOUNDARIES
_COUNTING_NOUNS = COMMAND_NOUNS | SEQUENCE_WORDS | SEQUENCE_NOUNS
_COUNTING = _COUNTING_NOUNS | set(NUMBERS)
# What may stand before the verb of a command.
_BEFORE_COMMAND = (
    _words_of((*COURTESY_OPENINGS, *COURTESY_CLOSINGS, *JOINTS)) | SEQUENCE_WORDS | {"but", "to"}
)
_FUNCTION = (
    BOUNDARIES | DETERMINERS | NO_COMMAND_WORDS | YES_WORDS | _BEFORE_COMMAND
    | {"be", "been", "only", "just"}
) - COMMAND_NOUNS  # fmt: skip
_GOING_ON = PLACE_PREPOSITIONS | {"for", "with", "without", "of", "about", "that", "which", "who"}
_DEFINITE = DETERMINERS - (ARTICLES - {"the"}) - {"this", "that", "any"}
_REFERRING = frozenset(each for forms in PRONOUNS.values() for each in forms.values())
_PREDICATING = frozenset({"is", "are", "was", "will", "would", "should", "has"})  # "... is my wish"
_QUESTIONS = NO_COMMAND_WORDS & {"did", "does", "has", "is", "are"}
_WHEN = frozenset({"when", "once", "while", "until", "till"})
_TOLD = _WHEN | {"i", "we", "you", "to"}
_SUBORDINATING = frozenset({"after", "before", "should"})
# "When you are done", "once that is finished", "once more" speak of the command before.
_DONE_WORDS = frozenset(FINISHED_WORDS) | {"you", "that", "this", "all", "everything", "more"}


# Without a grammar


def last_clause(utterance: str, names: Collection[tuple[int, int]] = ()) -> Piece | None:
    """Return the clause that is said last behind a conjunction, with a verb of its own; None where there is none.

    "Bring me the cup and polish it" has one, "bring me the cup and a plate" and "… and that is all" have none.

    Args:
        names: where entities are named, as characters. No clause begins inside one: "salt and pepper".
    """
    said = _Cut(utterance, Islands(names=frozenset(names)), False)
    last = len(said.words)
    for first in range(last - 1, 0, -1):
        if said.said[first - 1] in _CONJUNCTIONS and first - 1 not in said.named:
            if not said._begins_command(first, first, last):
                return None
            start, end = said.words[first][0], said.words[-1][1]
            return Piece(start, end, utterance[start:end], False)
    return None


def without_clause(utterance: str, clause: Piece) -> str:
    """Return what is said before a ``last_clause``, without the joint."""
    before = utterance[: clause.start].split()
    while before and before[-1].strip(_AROUND).casefold() in _PARTING:
        before.pop()
    return " ".join(before).rstrip(_AROUND)


def _phrases(phrases: Iterable[str]) -> str:
    return "|".join(re.escape(each) for each in sorted(phrases, key=len, reverse=True))


# Possessive, and only from where blanks or signs begin: linear for every text.
_SIGNS = r"(?<![\s.;:,!?])\s*+[.;:,!?]++\s++"
_WORDS = rf"(?:(?:{_phrases(JOINTS)})\b(?:,?\s++))"
_NUMBER = r"(?:\(?[1-9][.)]\s++)"
_JOINT = re.compile(
    rf"(?:{_SIGNS}(?:{_WORDS}|{_NUMBER})*+|(?<!\s)\s++(?:{_WORDS}|{_NUMBER})++)", re.IGNORECASE
)
_OPENING = re.compile(
    rf"\s*+(?:(?:{_phrases((*JOINT_OPENINGS, *JOINTS))})\b[\s,:.]*+|{_NUMBER})++", re.IGNORECASE
)


_MISSED = -1e6  # nats, for a piece that is not understood
_END = re.compile(r"[.;!?]\s+|\n+")
_ITEM = re.compile(r"(?<!\S)\(?([1-9])[.)]\s")  # of a list


def sentences(utterance: str) -> tuple[Piece, ...]:
    """Return the sentences of an utterance, or the items of a numbered list; none of signs alone."""
    numbers = list(_ITEM.finditer(utterance))
    is_list = [int(each[1]) for each in numbers] == list(range(1, len(numbers) + 1))
    if numbers and is_list and not utterance[: numbers[0].start()].strip():
        starts = [each.end() for each in numbers]
        ends = [*(each.start() for each in numbers[1:]), len(utterance)]
    else:
        marks = list(_END.finditer(utterance))
        starts = [0, *(each.end() for each in marks)]
        ends = [*(each.start() for each in marks), len(utterance)]
    found = []
    for start, end in zip(starts, ends, strict=True):
        text = utterance[start:end].strip(_AROUND)
        if text:
            begin = utterance.index(text, start)
            found.append(Piece(begin, begin + len(text), text, False))
    return tuple(found)


def cut_at_joints(
    utterance: str, judge: Judge | None, most: int = MOST_COMMANDS
) -> tuple[Piece, ...]:
    """Return the commands of an utterance by a parser alone, as a world without a grammar has it.

    An utterance that ``judge`` understands as it is, is one command. Of the cuts all of whose pieces are understood,
    the one with the fewest counts, and of these the one with the highest sum. Where there is none, what stands between
    two joints may be a piece that is not understood. Where nothing is, the utterance comes back as one piece.
    """
    whole = Piece(0, len(utterance), utterance, False)
    if judge is None:
        return (whole,)
    [score] = judge([utterance])
    if score is not None:
        return (replace(whole, is_understood=True),)
    opening = _OPENING.match(utterance)
    starts, ends = [opening.end() if opening else 0], []
    for joint in _JOINT.finditer(utterance, starts[0]):
        ends.append(joint.start())
        starts.append(joint.end())
    ends.append(len(utterance))
    if len(ends) > MOST_JOINTS + 1:
        return (whole,)
    places = [(first, last) for first in range(len(starts)) for last in range(first, len(ends))]
    pieces = {
        (first, last): Piece(starts[first], starts[first] + len(text), text, True)
        for first, last in places
        if (text := utterance[starts[first] : ends[last]].rstrip(_AROUND))
    }
    judged = judge([each.text for each in pieces.values()])
    scores = dict(zip(pieces, judged, strict=True))
    best = _best_path(scores, len(ends), most)
    if not best and any(score is not None for score in judged):
        missed = {p: _MISSED for p in pieces if p[0] == p[1] and scores[p] is None}
        best = _best_path({**scores, **missed}, len(ends), most)
    return tuple(replace(pieces[p], is_understood=scores[p] is not None) for p in best) or (whole,)


def _best_path(
    scores: dict[tuple[int, int], float | None], number: int, most: int
) -> tuple[tuple[int, int], ...]:
    """Return the fewest pieces from the first joint to the last, with the highest sum; none where there are none."""
    reached: dict[int, tuple[float, tuple[tuple[int, int], ...]]] = {0: (0.0, ())}
    for _ in range(most):
        further: dict[int, tuple[float, tuple[tuple[int, int], ...]]] = {}
        for first, (total, path) in reached.items():
            for last in range(first, number):
                score = scores.get((first, last))
                if score is None:
                    continue
                found = total + score, (*path, (first, last))
                if last + 1 not in further or found[0] > further[last + 1][0]:
                    further[last + 1] = found
        if number in further:
            return further[number][1]
        reached = further
    return ()
