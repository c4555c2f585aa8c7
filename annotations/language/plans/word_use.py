"""How the words of a language are used: which predicates they always go with, and which words lead to which slot.

Learned from derivations, which say for each command which words it has and which mention fills which slot. A word that
always goes with a predicate, or with one of a few, names it: "escort" is ``guide``, "smallest" is ``smallest``. What
stands before a mention tells its role (``RoleCounts``): the preposition, the kind of thing named last, and the action
named last.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from random import Random

from annotations.language.corpus import Rewording
from annotations.language.forms import (
    DEFAULT_CLASSES,
    PERSON_PREDICATES,
    EntityClasses,
    Form,
    Symbols,
    canonical_text,
    predicates,
    read_form,
)
from annotations.language.grounding import (
    RoleCounts,
    SlotPath,
    SlotRole,
    are_alike,
    as_pair,
    class_of,
    context_of,
    role_of,
    tokens_of,
    words_of,
)
from annotations.language.texts import (
    BOUNDARIES,
    COURTESY_WORDS,
    DETERMINERS,
    LIGHT_WORDS,
    NEAR_SYNONYMS,
    NO_COMMAND_WORDS,
    NUMBERS,
    PERSON_WORDS,
    PLACE_PREPOSITIONS,
    PREDICATE_WORDS,
    THING_WORDS,
    sample_commands,
)
from annotations.language.world import ArgumentKind, Predicate, PredicateKind, is_entity_kind

NOTHING: Mapping[str, Predicate] = {}

_REWORDINGS = 2  # of each form
_FEWEST = 3  # commands with a word, before it names anything
_MOST_MEANINGS = 3  # predicates of which a word names one
_MOST_COMMON = 0.75  # a predicate that so many of all commands have is named by no word
# Log odds below which what a language never says tells no more: people say it otherwise.
_LEAST = {"cue": -5.0, "near": -2.0, "action": -2.0}
_MOST_BY_ORDER = 1.5  # log odds: people put parts of a command in any order
_NAMES_NOTHING = frozenset(
    (
        *BOUNDARIES,
        *DETERMINERS,
        *PERSON_WORDS,
        *THING_WORDS,
        *PLACE_PREPOSITIONS,
        *COURTESY_WORDS,
        *LIGHT_WORDS,
        *NO_COMMAND_WORDS,
        *NUMBERS,
        "not",
    )
)


@dataclass(frozen=True, slots=True)
class Place:
    """How a mention stands in its command: what is said before it (``Context``), the action named last, and which
    mention it is."""

    cue: str
    neighbour: str
    action: str
    number: int

    @property
    def features(self) -> dict[str, str]:
        """What tells the role of the mention, by name."""
        return {"cue": self.cue, "near": self.neighbour, "action": self.action}


@dataclass(frozen=True, slots=True)
class Role(SlotRole):
    """The way to a slot: ``exact`` from its action on, whichever step that is; ``whole`` with the step."""

    whole: str = field(default="", compare=False)


class WordUse:
    """What the commands of a language, and English, tell about words and roles.

    Args:
        pairs: the words of commands and their forms, with the same numbered tokens on both sides.
        declared: the predicates of the world, which say what is an action.
    """

    def __init__(
        self,
        pairs: Sequence[tuple[Sequence[str], Form]] = (),
        declared: Mapping[str, Predicate] = NOTHING,
    ) -> None:
        self._actions = frozenset(name for name, each in declared.items() if each.is_action)
        self._named = _meanings(pairs, declared)
        self.vocabulary = frozenset(word for words, _ in pairs for word in words)
        self._counts = RoleCounts()
        self._orders: Counter[tuple[str, str]] = Counter()
        self._roles_of: defaultdict[str, set[tuple[Role, str]]] = defaultdict(set)
        self._without_person: set[str] = set()  # predicates and classes
        samples = [(words_of(text), read_form(form)) for text, form in sample_commands()]
        for words, form in (*samples, *pairs):
            self._learn(words, form)

    @classmethod
    def of(
        cls,
        derivations: Iterable[tuple[Symbols, Form]],
        declared: Mapping[str, Predicate],
        classes: EntityClasses = DEFAULT_CLASSES,
    ) -> WordUse:
        """Learn from the derivations of a grammar, and from rewordings of their forms.

        Args:
            derivations: symbols of commands and their forms, with the same wildcards on both sides.
        """
        random, rewording = Random(0), Rewording(declared, classes)
        pairs: list[tuple[Sequence[str], Form]] = [as_pair(*each) for each in derivations]
        for text, form in {canonical_text(form): form for _, form in pairs}.items():
            said = dict.fromkeys(rewording.say(text, random) for _ in range(_REWORDINGS))
            pairs += [(words_of(each), form) for each in said]
        return cls(pairs, declared)

    def named_by(self, word: str) -> frozenset[str]:
        """Return the predicates of which a word names one; empty for one that names none."""
        return self._named.get(word, frozenset())

    def places(self, words: Sequence[str]) -> list[Place | None]:
        """Return for each word how it stands, None for what is no mention."""
        places: list[Place | None] = []
        action, number = "", 0
        for at, word in enumerate(words):
            if class_of(word):
                context = context_of(words, at)
                places.append(Place(context.cue, context.neighbour, action, number))
                number += 1
                continue
            places.append(None)
            if self._actions.intersection(self.named_by(word)):
                action = " ".join(sorted(self._named[word]))
        return places

    def score(self, place: Place, role: Role, whichever_action: bool = False) -> float:
        """Return the log odds that a mention in this place has this role; ``whichever_action`` is named before it."""
        features = place.features
        if whichever_action:
            del features["action"]
        return sum(
            max(_LEAST[name], self._counts.log_odds(name, value, role))
            for name, value in features.items()
        )

    def order(self, first: Role, second: Role) -> float:
        """Return the log odds that what has the ``first`` role is named before what has the second."""
        before = self._orders[first.whole, second.whole] + 1
        after = self._orders[second.whole, first.whole] + 1
        return max(-_MOST_BY_ORDER, min(_MOST_BY_ORDER, math.log(before / after)))

    def rivals(self, role: Role, entity_class: str, actions: Iterable[str]) -> set[Role]:
        """Return the other roles that mentions of such a class have in some actions."""
        return {
            other
            for action in actions
            for other, mine in self._roles_of.get(action, ())
            if other != role and are_alike(mine, entity_class)
        }

    def is_action(self, name: str) -> bool:
        """Return whether a predicate is something to do."""
        return name in self._actions

    def is_of_people(self, name: str) -> bool:
        """Return whether a predicate, or an entity of a class, describes people alone."""
        return name not in self._without_person

    def _learn(self, words: Sequence[str], form: Form) -> None:
        used = predicates(form)
        if PERSON_PREDICATES.isdisjoint(used):
            self._without_person.update(used, filter(None, map(class_of, words)))
        places = self.places(words)
        roles: dict[str, Role] = {}
        for path, token in tokens_of(form):
            if token not in words or token in roles:
                continue
            roles[token] = role = role_at(form, path)
            place = places[words.index(token)]
            assert place is not None
            self._roles_of[role.exact.split(".")[0]].add((role, class_of(token)))
            self._counts.add(place.features, role)
        said = [roles[word] for word in dict.fromkeys(words) if word in roles]
        for at, first in enumerate(said):
            self._orders.update((first.whole, second.whole) for second in said[at + 1 :])


def role_at(form: Form, path: SlotPath) -> Role:
    """Return the role of the slot at ``path``, whichever step of a sequence it is in."""
    role = role_of(form, path)
    parts = role.exact.split("/")
    if parts[0].startswith("sequence"):
        parts = parts[1:]
    return Role("/".join(parts), role.similar, role.exact)


def _meanings(
    pairs: Sequence[tuple[Sequence[str], Form]], declared: Mapping[str, Predicate]
) -> Mapping[str, frozenset[str]]:
    """Return the predicates of which each word names one: all commands with the word have one of these, and most other
    commands have none. Sets of commands are the bits of a number.
    """
    with_word: defaultdict[str, int] = defaultdict(int)
    with_predicate: tuple[defaultdict[str, int], defaultdict[str, int]]
    with_predicate = defaultdict(int), defaultdict(int)  # descriptions, actions
    for number, (words, form) in enumerate(pairs):
        for word in set(words) - _NAMES_NOTHING:
            if word.isalpha():
                with_word[word] |= 1 << number
        for name in predicates(form):
            if name in declared and declared[name].kind is not PredicateKind.SEQUENCE:
                kind = declared[name].is_action
                if kind or not _has_slot(declared[name]):
                    with_predicate[kind][name] |= 1 << number
    most = _MOST_COMMON * len(pairs)
    meanings = {}
    for word, commands in with_word.items():
        if commands.bit_count() < _FEWEST:
            continue
        covers = (_cover(commands, kind, len(pairs)) for kind in with_predicate)
        found = [
            (rounds, common, names) for rounds, common, names in covers if names and common <= most
        ]
        if found:
            meanings[word] = frozenset(min(found)[2])
    for name, words in PREDICATE_WORDS.items():
        for word in words:
            if name not in declared:  # a class of entities may have them, such as poses
                meanings.pop(word, None)
                continue
            commands = with_word.get(word, 0)
            asked = {
                each
                for each, mine in with_predicate[False].items()
                if commands & mine and _is_asked(declared[each])  # "are they lying or standing"
            }
            meanings[word] = frozenset(_alike(name) | asked)
    return meanings


def _alike(name: str) -> set[str]:
    return {name}.union(*(group for group in NEAR_SYNONYMS if name in group))


def _with_all(commands: int, predicates: Mapping[str, int]) -> list[str]:
    return [name for name, mine in predicates.items() if not commands & ~mine]


def _is_asked(predicate: Predicate) -> bool:
    """Return whether a description has a value that is asked for: ``(pose $2 $1)``."""
    return any(list(each.arguments) == [ArgumentKind.VARIABLE] * 2 for each in predicate.signatures)


def _has_slot(predicate: Predicate) -> bool:
    """Return whether a description takes an entity, which says by itself what is described."""
    return any(is_entity_kind(kind) for each in predicate.signatures for kind in each.arguments)


def _cover(
    commands: int, predicates: Mapping[str, int], number: int
) -> tuple[int, int, tuple[str, ...]]:
    """Return the fewest predicates one of which each of ``commands`` has, and how many commands have one of them at
    all; none where there are more than ``_MOST_MEANINGS``. Greedy, rare predicates first."""
    names: list[str] = []
    left, common, rounds = commands, 0, 0

    def merit(name: str) -> float:
        covered = (left & predicates[name]).bit_count()
        return covered * math.log(2 * number / predicates[name].bit_count())

    while left and rounds < _MOST_MEANINGS:
        rounds += 1
        best = max(sorted(predicates), key=merit, default="")
        if not best or not left & predicates[best]:
            return _MOST_MEANINGS + 1, 0, ()
        # Which of several predicates that go with all of them the word names, the commands do not say.
        names += [best] if left & ~predicates[best] else _with_all(left, predicates)
        for name in names:
            common |= predicates[name]
        left &= ~predicates[best]
    if left:
        return _MOST_MEANINGS + 1, 0, ()
    return rounds, common.bit_count(), tuple(sorted(set(names)))
