"""What people ask of a robot that is none of its commands, for parsers to learn when to answer UNKNOWN."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from random import Random

from annotations.language.texts import other_request_groups
from annotations.language.world import Predicate

COMMAND = "{command}"  # stands for a command of the world in a text
_DRAWS = 3  # of a text with a command, each with another one


@dataclass(frozen=True, slots=True)
class OtherRequest:
    """One kind of request. ``gloss`` says it; ``texts`` are examples, with class tokens and ``COMMAND``."""

    gloss: str
    texts: tuple[str, ...]

    def examples(self, commands: Sequence[str], random: Random) -> tuple[str, ...]:
        """Return the texts, with some of ``commands`` in them."""
        drawn: dict[str, None] = {}
        for text in self.texts:
            if COMMAND not in text:
                drawn[text] = None
            elif commands:
                drawn |= {_with_commands(text, commands, random): None for _ in range(_DRAWS)}
        return tuple(drawn)


def other_requests(predicates: Mapping[str, Predicate]) -> tuple[OtherRequest, ...]:
    """Return the kinds of requests that are no command of a world with these ``predicates``."""
    return tuple(
        OtherRequest(group.gloss, group.texts)
        for group in other_request_groups()
        if predicates.keys().isdisjoint(group.actions)
    )


def _with_commands(text: str, commands: Sequence[str], random: Random) -> str:
    while COMMAND in text:
        text = text.replace(COMMAND, random.choice(commands), 1)
    return text
