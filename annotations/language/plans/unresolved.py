"""Find the steps of a plan that do not ground, with what is known of them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from annotations.language.plans.plan import (
    Described,
    Named,
    OpenArgument,
    OpenValue,
    Referred,
    SaidWords,
    Step,
    StepResult,
    Unresolved,
    Value,
    Words,
)

COMMAND = "command"  # what a question expects in place of a part that says nothing to do


def said_words(phrases: Iterable[str], utterance: str) -> tuple[SaidWords, ...]:
    """Return where an utterance says some phrases; in linear time for each."""
    said = []
    for phrase in phrases:
        words = r"\s+".join(map(re.escape, phrase.split()))
        match = re.search(rf"(?<!\w){words}(?!\w)", utterance, re.IGNORECASE) if words else None
        said.append(SaidWords(phrase, *match.span()) if match else SaidWords(phrase))
    return tuple(said)


@dataclass
class Gaps:
    """What is not settled while a plan is made.

    ``asked``: the number of a question → what its answer settles. ``vague``: the id of a description → what is missing
    in it. Other gaps are the doubts of values.
    """

    asked: dict[int, OpenArgument] = field(default_factory=dict)
    vague: dict[str, OpenArgument] = field(default_factory=dict)

    def unresolved(self, steps: Sequence[Step]) -> Iterator[Unresolved]:
        """Yield the steps that wait for something, in order. A step waits for its own gaps, and for those of what it
        refers to."""
        of_step: dict[int, tuple[OpenArgument, ...]] = {n: (gap,) for n, gap in self.asked.items()}
        for step in steps:
            gap = self.asked.get(step.number)
            if gap is not None:
                if gap.argument == COMMAND:
                    yield Unresolved((step.number,), "", "", "", (), (gap,))
                continue
            found = tuple(
                dict.fromkeys(
                    replace(each, argument=name)
                    for name, value in step.arguments
                    for each in self._in(value, of_step)
                )
            )
            if found:
                of_step[step.number] = found
                known = tuple((name, self._known(value)) for name, value in step.arguments)
                yield Unresolved(
                    (step.number,), step.action, step.predicate, step.text, known, found
                )

    def _in(
        self, value: Value, of_step: Mapping[int, tuple[OpenArgument, ...]]
    ) -> Iterator[OpenArgument]:
        match value:
            case StepResult(number):
                yield from of_step.get(number, ())
            case Referred(_, inner):
                yield from self._in(inner, of_step)
            case Named() | Words():
                if value.doubt is not None:
                    yield value.doubt
            case Described():
                if value.id in self.vague:
                    yield self.vague[value.id]
                for each in _parts(value):
                    yield from self._in(each, of_step)

    def _known(self, value: Value) -> Value:
        """Return a value with ``OpenValue`` for what is not settled of it."""
        match value:
            case StepResult(number) if number in self.asked:
                return OpenValue(self.asked[number].entity_class)
            case Named() | Words() if value.doubt is not None:
                return OpenValue(value.doubt.entity_class)
            case Referred(_, inner):
                known = self._known(inner)
                return (
                    replace(value, value=known) if isinstance(known, Named | Described) else known
                )
            case Described():
                conditions = tuple(
                    replace(each, values=tuple(map(self._known, each.values)))
                    for each in value.conditions
                )
                owner = value.of and self._known(value.of)
                assert owner is None or isinstance(owner, Described)
                return replace(value, conditions=conditions, of=owner)
        return value


def _parts(value: Described) -> Iterator[Value]:
    for condition in value.conditions:
        yield from condition.values
    if value.of is not None:
        yield value.of
