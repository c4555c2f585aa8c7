"""The forms that a ranker chooses among, and the examples that it has of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Self

from annotations.language.anonymizer import Anonymizer
from annotations.language.ontology import Ontology
from parser_service.parsers.candidates.gathering import gather
from parser_service.parsers.candidates.glosses import glosses
from parser_service.parsers.interface import Knowledge, Pair

MOST_SUPPORT = 4  # kinds of step, above which more of them say no more


@dataclass(frozen=True, slots=True)
class RankedExample:
    """An utterance and the number of its form; ``pattern`` has class tokens for its entities, as far
    as any are known."""

    utterance: str
    form: int
    pattern: str


@dataclass(frozen=True, slots=True)
class RankedForms:
    """Known forms first, then new ones; each with its gloss.

    ``support`` says of each new form how many kinds of step arrive at it. ``examples`` are the
    numbers of the forms that the examples have: the known ones have some, and all where the grammar
    has commands for them.
    """

    forms: tuple[str, ...]
    glosses: tuple[str, ...]
    known: int
    support: tuple[int, ...]
    examples: tuple[int, ...]

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> Self:
        """What ``written`` gave."""
        return cls(
            tuple(values["forms"]),
            tuple(values["glosses"]),
            values["known"],
            tuple(values["support"]),
            tuple(values["examples"]),
        )

    def written(self) -> dict[str, Any]:
        """The same as JSON."""
        return asdict(self)


def collect(
    pairs: Sequence[Pair], knowledge: Knowledge, is_open: bool
) -> tuple[RankedForms, list[RankedExample], str]:
    """The forms to choose among, the examples to learn from, and a line for the log.

    Where the grammar is known, its commands that are in no pair are examples as well; one that a
    pair reads otherwise keeps the form of the pair.
    """
    gathered = gather(pairs, knowledge, is_open)
    forms = (*gathered.training, *(each.form for each in gathered.new))
    number = {form: at for at, form in enumerate(forms)}
    meant = [(pair.utterance, pair.form) for pair in pairs]
    said = {utterance for utterance, _ in meant}
    meant += [
        (command, form)
        for form, commands in gathered.commands.items()
        for command in commands
        if command not in said
    ]
    anonymizer = Anonymizer(knowledge.ontology or Ontology(()))
    examples = [
        RankedExample(utterance, number[form], anonymizer.anonymize(utterance).text)
        for utterance, form in meant
    ]
    ranked = RankedForms(
        forms,
        tuple(glosses(forms, knowledge.predicates)),
        len(gathered.training),
        tuple(min(each.support, MOST_SUPPORT) for each in gathered.new),
        tuple(each.form for each in examples),
    )
    return ranked, examples, str(gathered)
