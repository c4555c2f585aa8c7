"""Propose an error category for a wrong answer and say why."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from annotations.language.forms import (
    Constant,
    Form,
    Unknown,
    canonical_text,
    equivalent,
    head_predicate,
    predicates,
    read_form,
    to_reading,
    walk,
)
from parser_service.analysis.categories.error_categories import ErrorCategory
from parser_service.analysis.categories.evidence import NOTHING_MORE, ErrorEvidence, RunEvidence
from parser_service.analysis.categories.neighbours import furthest
from parser_service.analysis.categories.structure import Proposal, read_structure
from parser_service.analysis.reading import read_or_none


@dataclass(frozen=True, slots=True)
class Proposals:
    """The category to propose, and others that have a reason too, the likelier first."""

    first: Proposal
    runners_up: tuple[Proposal, ...]


def propose_category(
    gold: Form,
    predicted: Form | None,
    run: RunEvidence | None = None,
    error: ErrorEvidence = NOTHING_MORE,
) -> Proposals:
    """Propose the category of a wrong answer. Equal arguments give equal proposals.

    Evidence that explains the answer by itself comes first, in the order of ``_READERS``: the audit suggests
    just this answer, it is another label of the same text, and so on. What differs between the two
    forms comes next, and evidence that only fits comes last. No category is proposed twice.

    Args:
        gold: the label.
        predicted: the answer; None where the parser's text is not a form, or it gave none.
        run: what is known of the run and its world.
        error: what is known of this utterance.

    Raises:
        ValueError: the answer is the label.
    """
    if predicted is None:
        reason = "The parser's text is not a logical form, or there is none."
        explained, fitting = [Proposal(ErrorCategory.ILL_FORMED, reason)], []
        differences: tuple[Proposal, ...] = ()
    else:
        if canonical_text(gold) == canonical_text(predicted):
            raise ValueError("The answer is right: it equals the label.")
        differences = read_structure(gold, predicted)
        case = _Case(gold, predicted, run or RunEvidence(), error)
        read = [each for reader in _READERS for each in reader(case)]
        explained = [proposal for proposal, is_enough in read if is_enough]
        fitting = [proposal for proposal, is_enough in read if not is_enough]
    by_category: dict[ErrorCategory, Proposal] = {}
    for proposal in (*explained, *differences, *fitting):
        by_category.setdefault(proposal.category, proposal)
    first, *others = by_category.values()
    return Proposals(first, tuple(others))


def propose_categories(
    gold: Sequence[str], predicted: Sequence[str], run: RunEvidence | None = None
) -> list[Proposals | None]:
    """Propose a category for many answers by what is known of the run; equal errors share their proposals.

    Args:
        gold: the labels as text, [examples].
        predicted: the answers as text, which need not be forms: [examples].
        run: what is known of the run and its world.

    Returns:
        Proposals, None where the answer is right: [examples].

    Raises:
        LanguageError: a label is not a form.
        ValueError: there are not as many answers as labels.
    """
    by_pair: dict[tuple[str, str], Proposals | None] = {}
    for pair in dict.fromkeys(zip(gold, predicted, strict=True)):
        label, answer = read_form(pair[0]), read_or_none(pair[1])
        is_right = answer is not None and canonical_text(label) == canonical_text(answer)
        by_pair[pair] = None if is_right else propose_category(label, answer, run)
    return [by_pair[pair] for pair in zip(gold, predicted, strict=True)]


@dataclass(frozen=True, slots=True)
class _Case:
    gold: Form
    predicted: Form
    run: RunEvidence
    error: ErrorEvidence


# What a kind of evidence suggests, and whether it explains the answer by itself.
_Readings = Iterator[tuple[Proposal, bool]]


def _read_audit(case: _Case) -> _Readings:
    audit = case.error.audit
    if audit is not None:
        is_enough = audit.suggested is not None and equivalent(audit.suggested, case.predicted)
        addition = " The answer is what the audit suggests." if is_enough else ""
        yield Proposal(ErrorCategory.WRONG_GOLD_LABEL, audit.sentence + addition), is_enough


def _read_other_labels(case: _Case) -> _Readings:
    others = [each for each in case.error.other_golds if not equivalent(each, case.gold)]
    category = ErrorCategory.AMBIGUOUS_UTTERANCE
    if any(equivalent(each, case.predicted) for each in others):
        yield Proposal(category, "The same text is also labelled with just this answer."), True
    elif others:
        reason = f"The same text is also labelled {to_reading(others[0])}."
        yield Proposal(category, reason), False


def _read_world(case: _Case) -> _Readings:
    """Look for predicates and classes that the world does not have, in the answer and then in the label."""
    for form, side in ((case.predicted, "answer"), (case.gold, "label")):
        unknown = [*_unknown_predicates(form, case.run), *_unknown_classes(form, case.run)]
        if unknown:
            reason = f"The {side} needs {unknown[0]}, which the world does not have."
            yield Proposal(ErrorCategory.OUTSIDE_ONTOLOGY, reason), True
            return


def _read_attractors(case: _Case) -> _Readings:
    category = ErrorCategory.UNEXPECTED_DEFAULT
    heads_differ = head_predicate(case.gold) != head_predicate(case.predicted)
    if canonical_text(case.predicted) in case.run.attractors:
        reason = f"Many unlike utterances get the answer {to_reading(case.predicted)}."
        yield Proposal(category, reason), heads_differ
    elif isinstance(case.gold, Unknown):
        yield Proposal(category, "The label is UNKNOWN, yet the answer is a form."), False


def _read_neighbours(case: _Case) -> _Readings:
    neighbour = furthest(case.gold, case.predicted, case.error.neighbours)
    if neighbour is not None:
        answer = "no form" if neighbour.answer is None else to_reading(neighbour.answer)
        reason = f"One edit away, “{neighbour.utterance}” gets {answer}."
        is_drastic = neighbour.answer is not None and (
            head_predicate(neighbour.answer) != head_predicate(case.predicted)
            and head_predicate(neighbour.gold) == head_predicate(case.gold)
        )
        yield Proposal(ErrorCategory.OVERLY_SENSITIVE, reason), is_drastic


_READERS: tuple[Callable[[_Case], _Readings], ...] = (
    _read_audit,
    _read_other_labels,
    _read_world,
    _read_attractors,
    _read_neighbours,
)


def _unknown_predicates(form: Form, run: RunEvidence) -> Iterator[str]:
    for name in predicates(form):
        if run.predicates is not None and name not in run.predicates:
            yield f"the predicate {name}"


def _unknown_classes(form: Form, run: RunEvidence) -> Iterator[str]:
    for node in walk(form):
        entity_class = node.token_class if isinstance(node, Constant) else ""
        if run.entity_classes is not None and entity_class not in {"", *run.entity_classes}:
            yield f"the class {entity_class}"
