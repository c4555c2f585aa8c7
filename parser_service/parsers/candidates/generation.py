"""The candidate forms that a protocol allows, from all steps together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from annotations.language.grounding import Anonymizer
from annotations.language.ontology import Ontology
from annotations.language.predicates import infer_signatures
from parser_service.parsers.candidates.closure import close, read_forms
from parser_service.parsers.candidates.geca import geca
from parser_service.parsers.candidates.grammar_forms import grammar_forms
from parser_service.parsers.candidates.pool import SURE, CandidateForm, Made, Pool
from parser_service.parsers.candidates.substitution import substitute
from parser_service.parsers.candidates.unseen import unseen
from parser_service.parsers.interface import Knowledge, Pair

MOST_CANDIDATES = 800


@dataclass(frozen=True, slots=True)
class GeneratedForms:
    """The forms of the training pairs, and new ones made from them or from what is known.

    ``counts`` is the number of forms by the step that made them, unlikely ones included; ``commands``
    are those of the grammar by form.
    """

    training: tuple[str, ...]
    new: tuple[CandidateForm, ...] = ()
    counts: Mapping[str, int] = field(default_factory=dict)
    commands: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __str__(self) -> str:
        made = ", ".join(f"{step} {count:,}" for step, count in self.counts.items())
        return (
            f"{len(self.training)} forms of the training pairs and {len(self.new)} new ones to "
            f"choose from; forms made by step: {made or 'none'}."
        )


def generate_candidates(
    pairs: Sequence[Pair], knowledge: Knowledge, is_open: bool = True
) -> GeneratedForms:
    """Return the forms that a parser trained on ``pairs`` chooses from: those of the pairs alone unless
    ``is_open``.

    *strict* infers signatures from the forms of the pairs. *domain* uses the declared ones, and so
    reaches predicates that no pair has. *grammar* takes all forms of its templates and makes no
    others. Forms that only one kind of change arrives at are left out.
    """
    training = _forms(pairs)
    if not is_open:
        return GeneratedForms(training)
    pool = reach(pairs, knowledge)
    candidates = list(pool.candidates())
    known = set(training)
    new = [each for each in candidates if each.form not in known and each.support >= SURE]
    return GeneratedForms(
        training,
        tuple(new[:MOST_CANDIDATES]),
        pool.counts(),
        {each.form: each.commands for each in candidates} if knowledge.grammar is not None else {},
    )


def _forms(pairs: Sequence[Pair]) -> tuple[str, ...]:
    return tuple(sorted({pair.form for pair in pairs}))


def reach(pairs: Sequence[Pair], knowledge: Knowledge) -> Pool:
    """Return all forms that the steps arrive at, unlikely ones and those of ``pairs`` included."""
    pool = Pool()
    pool.add(_make_forms(pairs, _forms(pairs), knowledge))
    return pool


def _make_forms(
    pairs: Sequence[Pair], training: Sequence[str], knowledge: Knowledge
) -> Iterator[Made]:
    if knowledge.grammar is not None:
        yield from grammar_forms(knowledge.grammar)
        return
    yield from geca(_anonymize(pairs, knowledge.ontology))
    if knowledge.predicates is None:
        yield from close(training, infer_signatures(read_forms(training)))
        return
    yield from close(training, knowledge.predicates)
    yield from substitute(training, knowledge.predicates)
    yield from unseen(training, knowledge.predicates)


def _anonymize(pairs: Sequence[Pair], ontology: Ontology | None) -> Sequence[Pair]:
    """Put class tokens for known entities: then more commands differ in one thing only."""
    if ontology is None:
        return pairs
    anonymizer = Anonymizer(ontology)
    return [replace(pair, utterance=anonymizer.anonymize(pair.utterance).command) for pair in pairs]
