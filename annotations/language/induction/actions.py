"""What a command does: the name of a predicate and the roles of its slots, as far as its words say them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from annotations.language.induction.rules import Words, is_slot, says_something
from annotations.language.texts import DETERMINERS, MAX_PREDICATE, PLACE_PREPOSITIONS

DIRECT = ""  # the role of what no preposition introduces
ROLE_WORDS = PLACE_PREPOSITIONS | frozenset(
    (
        *("for", "with", "of", "about", "through", "onto", "until", "and", "or"),
        *(
            "along",
            "after",
            "before",
            "against",
            "around",
            "across",
            "during",
            "between",
            "towards",
        ),
    )
)
# Behind a verb they belong to it: "turn off the lamp", but "go to the shed".
# and some of them may stand behind its object: "turn the lamp off".
SHIFTING_PARTICLES = frozenset(("on", "off", "up", "down", "out", "away", "over", "back"))
_PARTICLES = SHIFTING_PARTICLES | {"for", "after"}
_MOST_WORDS = 4  # of a name


@dataclass(frozen=True, slots=True)
class Action:
    """``name`` is made of the words that say something; ``roles`` has the preposition of each slot, in order.

    Two slots of one role are told apart by a number: ``from``, ``from 2``.
    """

    name: str
    roles: tuple[str, ...]


def read_action(words: Words) -> Action:
    """Return what the words of one command do: ``turn off the <lamp>`` is ``turn_off`` with a DIRECT slot."""
    named: list[str] = []
    roles: list[str] = []
    preposition = DIRECT
    for place, word in enumerate(words):
        plain = word.lower()
        if is_slot(word):
            number = sum(each.partition(" ")[0] == preposition for each in roles)
            roles.append(f"{preposition} {number + 1}" if number else preposition)
            preposition = DIRECT
        elif plain in DETERMINERS or plain == ",":
            continue
        elif place == 1 and plain in _PARTICLES:
            named.append(plain)
        elif plain in ROLE_WORDS and _introduces_slot(words, place):
            preposition = plain
        elif not place or says_something(word):
            named.append(plain)
            preposition = DIRECT
    name = "_".join(filter(None, (re.sub(r"\W+", "", each) for each in named[:_MOST_WORDS])))
    return Action(name[:MAX_PREDICATE] or "do", tuple(roles))


def _introduces_slot(words: Words, place: int) -> bool:
    """Return whether nothing but determiners stands between a preposition and the next slot."""
    behind = next((each for each in words[place + 1 :] if each.lower() not in DETERMINERS), "")
    return is_slot(behind)


@dataclass
class ArgumentOrder:
    """The roles of one predicate in the order of its arguments: those that some commands leave out come last."""

    name: str
    roles: list[str] = field(default_factory=list)
    used: list[frozenset[str]] = field(default_factory=list)

    def takes(self, roles: frozenset[str]) -> bool:
        """Return whether commands with these roles fit: of any two, one says all that the other says."""
        return all(roles <= other or other <= roles for other in self.used)

    def add(self, roles: Sequence[str]) -> None:
        self.used.append(frozenset(roles))
        self.roles += (role for role in roles if role not in self.roles)


def orders_of(
    actions: Iterable[Action], known: Iterable[ArgumentOrder] = ()
) -> dict[Action, ArgumentOrder]:
    """Return for each action the predicate that it is, and the order of its arguments.

    Commands of one name are one predicate as long as their roles are nested: ``bring the <tool>`` and ``bring the
    <tool> to the <place>``. What would take another place in the order is a predicate with a longer name:
    ``bring_from``. ``known`` are those that the world has.
    """
    orders: dict[str, list[ArgumentOrder]] = {}
    for order in known:
        orders.setdefault(order.name, []).append(order)
    chosen: dict[Action, ArgumentOrder] = {}
    for action in sorted(dict.fromkeys(actions), key=lambda each: len(each.roles)):
        candidates = orders.setdefault(action.name, [])
        fitting = [each for each in candidates if each.takes(frozenset(action.roles))]
        if not fitting:
            fitting = [ArgumentOrder(_longer_name(action, candidates))]
            candidates += fitting
        fitting[0].add(_directs_first(action.roles))
        chosen[action] = fitting[0]
    return chosen


def _directs_first(roles: Iterable[str]) -> list[str]:
    return sorted(roles, key=lambda role: role.partition(" ")[0] != DIRECT)


def _longer_name(action: Action, others: Sequence[ArgumentOrder]) -> str:
    if not others:
        return action.name
    return "_".join((action.name, *_words_of(action.roles, others[0].roles)))


def _words_of(roles: Iterable[str], usual: Sequence[str]) -> Iterator[str]:
    for role in dict.fromkeys(role.replace(" ", "_") for role in roles if role):
        if role not in usual or len(usual) > 1:
            yield role
