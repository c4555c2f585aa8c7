"""All steps together: the candidate forms that a protocol allows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from annotations.language.anonymizer import Anonymizer
from annotations.language.ontology import Ontology
from annotations.language.predicates import infer_signatures
from parser_service.parsers.candidates.closure import close, read_forms
from parser_service.parsers.candidates.geca import geca
from parser_service.parsers.candidates.grammar_forms import grammar_forms
from parser_service.parsers.candidates.inventory import inventory
from parser_service.parsers.candidates.pool import SURE, Candidate, Made, Pool
from parser_service.parsers.candidates.unseen import unseen
from parser_service.parsers.interface import Knowledge, Pair

MOST_CANDIDATES = 800


@dataclass(frozen=True, slots=True)
class Gathered:
    """The forms of the training pairs, and those made from them or from what is known.

    ``counts`` are forms by the step that made them, before the unlikely ones went; ``commands`` are
    those of the grammar by form.
    """

    training: tuple[str, ...]
    new: tuple[Candidate, ...] = ()
    counts: Mapping[str, int] = field(default_factory=dict)
    commands: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __str__(self) -> str:
        made = ", ".join(f"{step} {count:,}" for step, count in self.counts.items())
        return (
            f"{len(self.training)} forms of the training pairs and {len(self.new)} new ones to "
            f"choose among; made were: {made or 'none'}."
        )


def gather(pairs: Sequence[Pair], knowledge: Knowledge, is_open: bool = True) -> Gathered:
    """The candidates for what ``pairs`` teach; the forms of the pairs alone unless ``is_open``.

    *strict* infers signatures from the forms of the pairs; *domain* takes the declared ones, so that
    predicates appear which no pair has; *grammar* has all forms of its templates, and nothing has
    to be made. Candidates that only one kind of change arrives at are left out.
    """
    training = _forms(pairs)
    if not is_open:
        return Gathered(training)
    pool = reach(pairs, knowledge)
    candidates = list(pool.candidates())
    known = set(training)
    new = [each for each in candidates if each.form not in known and each.support >= SURE]
    return Gathered(
        training,
        tuple(new[:MOST_CANDIDATES]),
        pool.counts(),
        {each.form: each.commands for each in candidates} if knowledge.grammar is not None else {},
    )


def _forms(pairs: Sequence[Pair]) -> tuple[str, ...]:
    return tuple(sorted({pair.form for pair in pairs}))


def reach(pairs: Sequence[Pair], knowledge: Knowledge) -> Pool:
    """All forms that the steps arrive at, the unlikely ones and those of ``pairs`` among them."""
    pool = Pool()
    pool.add(_made(pairs, _forms(pairs), knowledge))
    return pool


def _made(pairs: Sequence[Pair], training: Sequence[str], knowledge: Knowledge) -> Iterator[Made]:
    if knowledge.grammar is not None:
        yield from grammar_forms(knowledge.grammar)
        return
    yield from geca(_anonymized(pairs, knowledge.ontology))
    if knowledge.predicates is None:
        yield from close(training, infer_signatures(read_forms(training)))
        return
    yield from close(training, knowledge.predicates)
    yield from inventory(training, knowledge.predicates)
    yield from unseen(training, knowledge.predicates)


def _anonymized(pairs: Sequence[Pair], ontology: Ontology | None) -> Sequence[Pair]:
    """With class tokens for entities, where these are known: more commands then differ in one thing."""
    if ontology is None:
        return pairs
    anonymizer = Anonymizer(ontology)
    return [replace(pair, utterance=anonymizer.anonymize(pair.utterance).command) for pair in pairs]
