"""What each kind of evidence suggests about one wrong answer."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from annotations.language.forms import (
    Constant,
    Form,
    Unknown,
    canonical_text,
    equivalent,
    flatten_conjunctions,
    head_predicate,
    predicates,
    to_reading,
    walk,
)
from parser_service.analysis.categories.error_categories import ErrorCategory
from parser_service.analysis.categories.evidence import ErrorEvidence, RunEvidence
from parser_service.analysis.categories.neighbours import furthest
from parser_service.analysis.categories.structure import Proposal
from parser_service.analysis.categories.what_is_said import (
    SENTENCES,
    classes_in,
    left_out_of_label,
    unsaid_in_label,
    without_classes,
)


@dataclass(frozen=True, slots=True)
class Case:
    """One wrong answer and what is known of it. ``label_as_said`` is what the label should be as far as its
    utterance and surer evidence than a parser say."""

    gold: Form
    predicted: Form
    run: RunEvidence
    error: ErrorEvidence

    def label_as_said(self) -> Form:
        audit, named = self.error.audit, self.error.named
        if audit is not None and audit.is_sure and audit.suggested is not None:
            return audit.suggested
        if named is None:
            return self.gold
        unsaid = unsaid_in_label(self.gold, self.predicted, named)
        return without_classes(flatten_conjunctions(self.gold), unsaid) if unsaid else self.gold


Readings = Iterator[tuple[Proposal, bool]]
"""What a kind of evidence suggests, and whether it explains the answer by itself."""


def _read_audit(case: Case) -> Readings:
    audit = case.error.audit
    if audit is not None:
        is_enough = audit.suggested is not None and equivalent(audit.suggested, case.predicted)
        addition = " The answer is what the audit suggests." if is_enough else ""
        yield Proposal(ErrorCategory.WRONG_GOLD_LABEL, audit.sentence + addition), is_enough


def _read_other_labels(case: Case) -> Readings:
    others = [each for each in case.error.other_golds if not equivalent(each, case.gold)]
    category = ErrorCategory.AMBIGUOUS_UTTERANCE
    if any(equivalent(each, case.predicted) for each in others):
        yield Proposal(category, "The same text is also labelled with just this answer."), True
    elif others:
        reason = f"The same text is also labelled {to_reading(others[0])}."
        yield Proposal(category, reason), False


def _read_alike_texts(case: Case) -> Readings:
    alike = case.error.alike_golds
    if any(_is_the_same(each, case.predicted) for each in alike):
        reason = "In training the same text with other names is labelled with just this answer."
        yield Proposal(ErrorCategory.AMBIGUOUS_UTTERANCE, reason), True


def _read_names(case: Case) -> Readings:
    """Compare what the utterance names with what the label and the answer have places for."""
    named, category = case.error.named, ErrorCategory.WRONG_GOLD_LABEL
    if named is None:
        return
    if isinstance(case.gold, Unknown):
        yield from _read_unknown_label(case, named)
    elif unsaid := unsaid_in_label(case.gold, case.predicted, named):
        reason = f"The label has a place for a {_list(unsaid)}, but the utterance names none."
        yield Proposal(category, reason), _is_the_same(case.label_as_said(), case.predicted)
    elif left_out := left_out_of_label(case.gold, case.predicted, named):
        without = without_classes(flatten_conjunctions(case.predicted), left_out)
        reason = f"The utterance names a {_list(left_out)}, which the label leaves out."
        yield Proposal(category, reason), _is_the_same(case.gold, without)


def _read_unknown_label(case: Case, named: tuple[str, ...]) -> Readings:
    classes = classes_in(case.predicted)
    if classes and classes == tuple(each for each in named if each not in SENTENCES):
        reason = (
            "The label is UNKNOWN, yet the answer has a place for all that the utterance names."
        )
        yield Proposal(ErrorCategory.WRONG_GOLD_LABEL, reason), True
    elif made_up := frozenset(classes) - set(named):
        reason = (
            f"The label is UNKNOWN, and the answer has a place for a {_list(made_up)} that the "
            "utterance does not name."
        )
        yield Proposal(ErrorCategory.UNEXPECTED_DEFAULT, reason), True


def _read_words(case: Case) -> Readings:
    word = case.error.spoken_for
    if word is not None:
        reason = (
            f"In training “{word.word}” goes with what the answer says ({word.with_answer} pairs), not "
            f"with what the label says ({word.with_label})."
        )
        yield Proposal(ErrorCategory.WRONG_GOLD_LABEL, reason), True


def _read_other_parsers(case: Case) -> Readings:
    """Other parsers that agree speak against the label, unless the answer has what the utterance does not name."""
    error = case.error
    classes = frozenset(classes_in(case.predicted))
    adds = classes - set(classes if error.named is None else error.named)
    if error.agreeing and not adds and not _is_the_same(case.gold, case.predicted):
        reason = f"{' and '.join(error.agreeing)} answered the same, and training has the label."
        yield Proposal(ErrorCategory.WRONG_GOLD_LABEL, reason), True


def _read_world(case: Case) -> Readings:
    """Look for predicates and classes that the world does not have, in the answer and then in the label."""
    for form, side in ((case.predicted, "answer"), (case.gold, "label")):
        unknown = [*_unknown_predicates(form, case.run), *_unknown_classes(form, case.run)]
        if unknown:
            reason = f"The {side} needs {unknown[0]}, which the world does not have."
            yield Proposal(ErrorCategory.OUTSIDE_ONTOLOGY, reason), True
            return


def _read_attractors(case: Case) -> Readings:
    category = ErrorCategory.UNEXPECTED_DEFAULT
    heads_differ = head_predicate(case.gold) != head_predicate(case.predicted)
    if case.run.attractors and canonical_text(case.predicted) in case.run.attractors:
        reason = f"Many unlike utterances get the answer {to_reading(case.predicted)}."
        yield Proposal(category, reason), heads_differ and not case.error.is_familiar
    elif isinstance(case.gold, Unknown):
        yield Proposal(category, "The label is UNKNOWN, yet the answer is a form."), False


def _read_neighbours(case: Case) -> Readings:
    neighbour = furthest(case.gold, case.predicted, case.error.neighbours)
    if neighbour is not None:
        answer = "no form" if neighbour.answer is None else to_reading(neighbour.answer)
        reason = f"One edit away, “{neighbour.utterance}” gets {answer}."
        is_drastic = neighbour.answer is not None and (
            head_predicate(neighbour.answer) != head_predicate(case.predicted)
            and head_predicate(neighbour.gold) == head_predicate(case.gold)
        )
        yield Proposal(ErrorCategory.OVERLY_SENSITIVE, reason), is_drastic


READERS: tuple[Callable[[Case], Readings], ...] = (
    _read_audit,
    _read_other_labels,
    _read_names,
    _read_alike_texts,
    _read_words,
    _read_other_parsers,
    _read_world,
    _read_attractors,
    _read_neighbours,
)
"""The surer evidence first."""


def _list(classes: frozenset[str]) -> str:
    return " and a ".join(sorted(classes))


def _is_the_same(first: Form, second: Form) -> bool:
    return equivalent(flatten_conjunctions(first), flatten_conjunctions(second))


def _unknown_predicates(form: Form, run: RunEvidence) -> Iterator[str]:
    for name in predicates(form):
        if run.predicates is not None and name not in run.predicates:
            yield f"the predicate {name}"


def _unknown_classes(form: Form, run: RunEvidence) -> Iterator[str]:
    for node in walk(form):
        entity_class = node.token_class if isinstance(node, Constant) else ""
        if run.entity_classes is not None and entity_class not in {"", *run.entity_classes}:
            yield f"the class {entity_class}"
