"""Propose an error category for a wrong answer and say why."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from annotations.language.forms import Form, canonical_text
from parser_service.analysis.error_categories import ErrorCategory
from parser_service.analysis.error_evidence import NOTHING_MORE, ErrorEvidence, RunEvidence
from parser_service.analysis.evidence_rules import RULES, ErrorCase
from parser_service.analysis.structure import CategoryProposal, read_structure


@dataclass(frozen=True, slots=True)
class Proposals:
    """The category to propose, and others that have a reason too, the likelier first."""

    first: CategoryProposal
    runners_up: tuple[CategoryProposal, ...]


def propose_category(
    gold: Form,
    predicted: Form | None,
    run: RunEvidence | None = None,
    error: ErrorEvidence = NOTHING_MORE,
) -> Proposals:
    """Propose the category of a wrong answer. Equal arguments give equal proposals.

    Evidence that explains the answer by itself comes first, in the order of ``RULES``: the audit suggests
    just this answer, it is another label of the same text, and so on. What differs between the two
    forms comes next, where the label is corrected as far as its utterance says, and evidence that only
    fits comes last. No category is proposed twice.

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
        explained, fitting = [CategoryProposal(ErrorCategory.ILL_FORMED, reason)], []
        differences: tuple[CategoryProposal, ...] = ()
    else:
        if _canonical(gold) == _canonical(predicted):
            raise ValueError("The answer is right: it equals the label.")
        case = ErrorCase(gold, predicted, run or RunEvidence(), error)
        read = [each for rule in RULES for each in rule(case)]
        said = case.label_as_said()
        is_corrected = said is not gold and _canonical(said) != _canonical(predicted)
        differences = read_structure(said if is_corrected else gold, predicted)
        explained = [proposal for proposal, is_enough in read if is_enough]
        fitting = [proposal for proposal, is_enough in read if not is_enough]
    by_category: dict[ErrorCategory, CategoryProposal] = {}
    for proposal in (*explained, *differences, *fitting):
        by_category.setdefault(proposal.category, proposal)
    first, *others = by_category.values()
    return Proposals(first, tuple(others))


@lru_cache(maxsize=1 << 14)
def _canonical(form: Form) -> str:
    return canonical_text(form)
