"""Find the most likely assignment of the mentions of one class to the slots of that class."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations, zip_longest

from annotations.language.grounding.role_evidence import Evidence
from annotations.language.grounding.roles import Context, SlotRole
from annotations.language.world import Entity

# Log odds by which the best assignment of a slot has to win to be certain: 20 to 1.
MARGIN = 3.0
_MOST_ASSIGNMENTS = 5_040  # seven mentions in seven slots
MOST_TOGETHER = 12  # mentions or slots of one class that are compared
_IN_ORDER = 0.5  # log odds of mentions in the order of the slots, where the grammar does not say


@dataclass(frozen=True, slots=True)
class Mention:
    """A value that an utterance names, how it stands there, and the entities it may be.

    ``alternatives`` are the values that the utterance joins with "or", this one included, of which one is
    meant; ``phrases`` are unknown words among them. Both are empty for a value that stands for itself.
    """

    value: str
    context: Context
    entities: tuple[Entity, ...]
    alternatives: tuple[str, ...] = ()
    phrases: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SlotChoice:
    """The most likely mention for a slot; None if the utterance has none for it. ``margin`` is in log odds."""

    mention: Mention | None
    margin: float

    @property
    def is_certain(self) -> bool:
        return self.mention is not None and self.margin >= MARGIN


_Values = tuple[str | None, ...]


def assign(
    form: str,
    entity_class: str,
    roles: Sequence[SlotRole],
    mentions: Sequence[Mention],
    evidence: Evidence,
) -> tuple[SlotChoice, ...]:
    """Return the most likely mention for each slot of a class, and how clearly it wins.

    Args:
        form: the canonical text of the form with class tokens.
        entity_class: the class of all slots and mentions.
        roles: the roles of the slots, in the order of the form.
        mentions: what the utterance names, in its order.

    The best assignment is the one with the highest sum of scores. The margin of a slot is the distance
    to the best assignment that gives it another value. With more assignments than can be compared,
    mentions and slots go together in order, and nothing is certain. Nothing is certain either if the
    utterance names more values than the form has slots, and the grammar has no such command.
    """
    if not mentions:
        return tuple(SlotChoice(None, math.inf) for _ in roles)
    fewer, more = sorted((len(roles), len(mentions)))
    if more > MOST_TOGETHER or math.perm(more, fewer) > _MOST_ASSIGNMENTS:
        return tuple(
            SlotChoice(each, 0.0) for each, _ in zip_longest(mentions[: len(roles)], roles)
        )
    first = {each.value: each for each in reversed(mentions)}
    if len(roles) <= 1 and len(first) == 1:
        return tuple(SlotChoice(each, math.inf) for each, _ in zip(mentions, roles, strict=False))
    orders = evidence.orders(form, entity_class, len(first))
    scores = _scores(roles, mentions, evidence, orders)
    best = max(scores, key=scores.__getitem__)
    is_too_much = len(first) > len(roles) and not orders
    choices = []
    for place, value in enumerate(best):
        rivals = (score for values, score in scores.items() if values[place] != value)
        margin = 0.0 if is_too_much else scores[best] - max(rivals, default=-math.inf)
        choices.append(SlotChoice(None if value is None else first[value], margin))
    return tuple(choices)


def _scores(
    roles: Sequence[SlotRole],
    mentions: Sequence[Mention],
    evidence: Evidence,
    orders: Mapping[tuple[int, ...], int],
) -> Mapping[_Values, float]:
    """Return the score of every assignment; of two that give the same values the better one counts."""
    points = [
        [
            evidence.score(each.context, role) + evidence.fit(each.entities, role)
            for each in mentions
        ]
        for role in roles
    ]
    scores: dict[_Values, float] = {}
    for places, prior in _assignments(len(roles), mentions, orders):
        total = prior + sum(
            points[slot][place] for slot, place in enumerate(places) if place is not None
        )
        values = tuple(None if place is None else mentions[place].value for place in places)
        scores[values] = max(total, scores.get(values, -math.inf))
    return scores


def _assignments(
    slots: int, mentions: Sequence[Mention], orders: Mapping[tuple[int, ...], int]
) -> Iterator[tuple[tuple[int | None, ...], float]]:
    """Yield mentions for the slots, each with its prior log odds.

    Where the grammar has the form with as many values, it says which slots have the same one.
    """
    first = {each.value: place for place, each in reversed([*enumerate(mentions)])}
    turns = sorted(first.values())
    if orders:
        patterns: set[tuple[int, ...]] = set()
        for order in orders:  # and those with the same slots sharing a value
            ranks = sorted(set(order))
            for chosen in permutations(range(len(turns)), len(ranks)):
                value_of = dict(zip(ranks, chosen, strict=True))
                patterns.add(tuple(value_of[rank] for rank in order))
        total = sum(orders.values()) + len(patterns) / 2
        for pattern in patterns:
            share = (orders.get(pattern, 0) + 0.5) / total
            yield tuple(turns[rank] for rank in pattern), math.log(share)
        return
    for places in _injections(slots, len(mentions)):
        used = [place for place in places if place is not None]
        yield places, _IN_ORDER if used == sorted(used) else 0.0


def _injections(slots: int, mentions: int) -> Iterable[tuple[int | None, ...]]:
    """Yield every way to give as many slots as possible a mention of their own."""
    if mentions >= slots:
        yield from permutations(range(mentions), slots)
        return
    for chosen in permutations(range(slots), mentions):
        places: list[int | None] = [None] * slots
        for mention, slot in enumerate(chosen):
            places[slot] = mention
        yield tuple(places)
