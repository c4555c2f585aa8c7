"""The rules of error categories: what each kind of evidence suggests about one wrong answer."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from annotations.language.forms import (
    QUESTION_CLASS,
    SAYING_CLASS,
    Application,
    Constant,
    Form,
    FormDistances,
    Lambda,
    Unknown,
    canonical_text,
    equivalent,
    flatten_conjunctions,
    head_predicate,
    predicates,
    to_reading,
    walk,
)
from annotations.language.texts import article
from parser_service.analysis.error_categories import ErrorCategory
from parser_service.analysis.error_evidence import ErrorEvidence, Neighbour, RunEvidence
from parser_service.analysis.structure import CategoryProposal

Suggestions = Iterator[tuple[CategoryProposal, bool]]
"""What a kind of evidence suggests, and whether it explains the answer by itself."""
# Their entities are whole sentences, which an utterance need not contain.
SENTENCES = frozenset((QUESTION_CLASS, SAYING_CLASS))


@dataclass(frozen=True, slots=True)
class ErrorCase:
    """One wrong answer and what is known of it. ``label_as_said`` is the label that the utterance and evidence
    surer than a parser call for."""

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


def by_audit(case: ErrorCase) -> Suggestions:
    audit = case.error.audit
    if audit is not None:
        is_enough = audit.suggested is not None and equivalent(audit.suggested, case.predicted)
        addition = " The answer is what the audit suggests." if is_enough else ""
        yield CategoryProposal(ErrorCategory.WRONG_GOLD_LABEL, audit.sentence + addition), is_enough


def by_other_labels(case: ErrorCase) -> Suggestions:
    others = [each for each in case.error.other_golds if not equivalent(each, case.gold)]
    category = ErrorCategory.AMBIGUOUS_UTTERANCE
    if any(equivalent(each, case.predicted) for each in others):
        yield (
            CategoryProposal(category, "The same text is also labelled with just this answer."),
            True,
        )
    elif others:
        reason = f"The same text is also labelled {to_reading(others[0])}."
        yield CategoryProposal(category, reason), False


def by_alike_texts(case: ErrorCase) -> Suggestions:
    alike = case.error.alike_golds
    if any(_is_the_same(each, case.predicted) for each in alike):
        reason = "In training the same text with other names is labelled with just this answer."
        yield CategoryProposal(ErrorCategory.AMBIGUOUS_UTTERANCE, reason), True


def by_names(case: ErrorCase) -> Suggestions:
    """Compare what the utterance names with what the label and the answer have places for."""
    named, category = case.error.named, ErrorCategory.WRONG_GOLD_LABEL
    if named is None:
        return
    if isinstance(case.gold, Unknown):
        classes = classes_in(case.predicted)
        if classes and classes == tuple(each for each in named if each not in SENTENCES):
            reason = (
                "The label is UNKNOWN, yet the answer has a place for all that the utterance names."
            )
            yield CategoryProposal(category, reason), True
        elif made_up := frozenset(classes) - set(named):
            reason = (
                f"The label is UNKNOWN, and the answer has a place for {_list(made_up)} that the "
                "utterance does not name."
            )
            yield CategoryProposal(ErrorCategory.UNEXPECTED_DEFAULT, reason), True
    elif unsaid := unsaid_in_label(case.gold, case.predicted, named):
        reason = f"The label has a place for {_list(unsaid)}, but the utterance names none."
        yield CategoryProposal(category, reason), _is_the_same(case.label_as_said(), case.predicted)
    elif left_out := left_out_of_label(case.gold, case.predicted, named):
        without = without_classes(flatten_conjunctions(case.predicted), left_out)
        reason = f"The utterance names {_list(left_out)}, which the label leaves out."
        yield CategoryProposal(category, reason), _is_the_same(case.gold, without)


def by_words(case: ErrorCase) -> Suggestions:
    word = case.error.spoken_for
    if word is not None:
        reason = (
            f"In training “{word.word}” goes with what the answer says ({word.with_answer} pairs), not "
            f"with what the label says ({word.with_label})."
        )
        yield CategoryProposal(ErrorCategory.WRONG_GOLD_LABEL, reason), True


def by_other_parsers(case: ErrorCase) -> Suggestions:
    """Other parsers that agree speak against the label, unless the answer has what the utterance does not name."""
    error = case.error
    classes = frozenset(classes_in(case.predicted))
    adds = classes - set(classes if error.named is None else error.named)
    if error.agreeing and not adds and not _is_the_same(case.gold, case.predicted):
        reason = f"{' and '.join(error.agreeing)} answered the same, and training has the label."
        yield CategoryProposal(ErrorCategory.WRONG_GOLD_LABEL, reason), True


def by_world(case: ErrorCase) -> Suggestions:
    """Look for predicates and classes that the world does not have, in the answer and then in the label."""
    for form, side in ((case.predicted, "answer"), (case.gold, "label")):
        if unknown := next(_outside_world(form, case.run), None):
            reason = f"The {side} needs {unknown}, which the world does not have."
            yield CategoryProposal(ErrorCategory.OUTSIDE_ONTOLOGY, reason), True
            return


def by_attractors(case: ErrorCase) -> Suggestions:
    category = ErrorCategory.UNEXPECTED_DEFAULT
    heads_differ = head_predicate(case.gold) != head_predicate(case.predicted)
    if case.run.attractors and canonical_text(case.predicted) in case.run.attractors:
        reason = f"Many unlike utterances get the answer {to_reading(case.predicted)}."
        yield CategoryProposal(category, reason), heads_differ and not case.error.is_familiar
    elif isinstance(case.gold, Unknown):
        yield CategoryProposal(category, "The label is UNKNOWN, yet the answer is a form."), False


def by_neighbours(case: ErrorCase) -> Suggestions:
    neighbour = furthest(case.gold, case.predicted, case.error.neighbours)
    if neighbour is not None:
        answer = "no form" if neighbour.answer is None else to_reading(neighbour.answer)
        reason = f"One edit away, “{neighbour.utterance}” gets {answer}."
        is_drastic = neighbour.answer is not None and (
            head_predicate(neighbour.answer) != head_predicate(case.predicted)
            and head_predicate(neighbour.gold) == head_predicate(case.gold)
        )
        yield CategoryProposal(ErrorCategory.OVERLY_SENSITIVE, reason), is_drastic


RULES: tuple[Callable[[ErrorCase], Suggestions], ...] = (
    by_audit,
    by_other_labels,
    by_names,
    by_alike_texts,
    by_words,
    by_other_parsers,
    by_world,
    by_attractors,
    by_neighbours,
)
"""The surer evidence first."""


def _list(classes: frozenset[str]) -> str:
    """Return ``a category and an object``."""
    return " and ".join(f"{article(each)} {each}" for each in sorted(classes))


def _is_the_same(first: Form, second: Form) -> bool:
    return equivalent(flatten_conjunctions(first), flatten_conjunctions(second))


def _outside_world(form: Form, run: RunEvidence) -> Iterator[str]:
    """Yield the predicates and the classes of a form that the world does not have."""
    for name in predicates(form):
        if run.predicates is not None and name not in run.predicates:
            yield f"the predicate {name}"
    for node in walk(form):
        entity_class = node.token_class if isinstance(node, Constant) else ""
        if run.entity_classes is not None and entity_class not in {"", *run.entity_classes}:
            yield f"the class {entity_class}"


def furthest(gold: Form, predicted: Form, neighbours: Sequence[Neighbour]) -> Neighbour | None:
    """Return the neighbour whose answer is further from ``predicted`` than its label from ``gold``, the one
    with the largest excess. Of equals it is the first; None where no answer is further."""
    if not neighbours:
        return None

    def excess(neighbour: Neighbour) -> float:
        answers = 1.0
        if neighbour.answer is not None:
            answers = _distance(predicted, neighbour.answer)
        return answers - _distance(gold, neighbour.gold)

    best = max(neighbours, key=excess)
    return best if excess(best) > 0 else None


@lru_cache(maxsize=1 << 16)
def _distance(first: Form, second: Form) -> float:
    return FormDistances().distance(first, second)


@lru_cache(maxsize=1 << 14)
def classes_in(form: Form) -> tuple[str, ...]:
    """Return the class of each place that a form has for an entity which utterances name, sorted."""
    tokens = (node.token_class for node in walk(form) if isinstance(node, Constant))
    return tuple(sorted(token for token in tokens if token and token not in SENTENCES))


def unsaid_in_label(gold: Form, predicted: Form, named: Collection[str]) -> frozenset[str]:
    """Return the classes that the label alone has and the utterance does not name.

    Empty where the answer has such a class too: then names may have been overlooked in the utterance.
    """
    if not set(classes_in(predicted)) <= set(named):
        return frozenset()
    return frozenset(classes_in(gold)) - set(named)


def left_out_of_label(gold: Form, predicted: Form, named: Collection[str]) -> frozenset[str]:
    """Return the classes that the utterance names and the answer has, but not the label."""
    return frozenset(classes_in(predicted)) & set(named) - set(classes_in(gold))


def without_classes(form: Form, classes: Collection[str]) -> Form:
    """Return the form without the constraints about one of the classes; a λ keeps one body at least."""
    if isinstance(form, Application):
        arguments = tuple(without_classes(each, classes) for each in form.arguments)
        return replace(form, arguments=arguments)
    if not isinstance(form, Lambda):
        return form
    bodies = tuple(without_classes(each, classes) for each in form.bodies)
    kept = tuple(each for each in bodies if not is_about(each, classes))
    return replace(form, bodies=kept or bodies)


def is_about(form: Form, classes: Collection[str]) -> bool:
    """Tell whether a constraint has a place for an entity of one of the classes."""
    return isinstance(form, Application) and any(
        isinstance(each, Constant) and each.token_class in classes for each in form.arguments
    )
