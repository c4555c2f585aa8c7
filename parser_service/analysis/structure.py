"""What an answer has wrong, from the difference between the label and the answer alone."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from annotations.language.forms import (
    UNKNOWN,
    Application,
    Change,
    Constant,
    Difference,
    Form,
    Lambda,
    Unknown,
    Variable,
    diff_unordered,
    equivalent,
    flatten_conjunctions,
    head_predicate,
    predicates,
    to_reading,
)
from parser_service.analysis.error_categories import ErrorCategory

_BOTH_MEAN_THE_SAME = (
    "Label and answer mean the same; only the conjunctions are written differently."
)


@dataclass(frozen=True, slots=True)
class CategoryProposal:
    """An error category and a sentence that says why."""

    category: ErrorCategory
    reason: str


@lru_cache(maxsize=1 << 14)
def read_structure(gold: Form, predicted: Form) -> tuple[CategoryProposal, ...]:
    """Return what the difference of two forms suggests, the most likely first; at least one.

    A different head predicate comes first, and then predicates that only the label has where there are
    some that only the answer has: one was taken for the other, whatever else changed with it. Otherwise
    the kind with the most changes comes first; of as many, constraints before structure before arguments.
    """
    left, right = flatten_conjunctions(gold), flatten_conjunctions(predicted)
    if equivalent(left, right):
        return (CategoryProposal(ErrorCategory.WRONG_STRUCTURE, _BOTH_MEAN_THE_SAME),)
    head = _compare_heads(left, right)
    if head is not None and UNKNOWN in (left, right):
        return (head,)
    by_category: defaultdict[ErrorCategory, list[str]] = defaultdict(list)
    for each in _changes(diff_unordered(left, right), None):
        by_category[each.category].append(each.reason)
    ranked = sorted(
        by_category, key=lambda kind: (-len(by_category[kind]), OF_DIFFERENCES.index(kind))
    )
    proposals = {
        kind: CategoryProposal(kind, " ".join(dict.fromkeys(by_category[kind]))) for kind in ranked
    }
    exchange = _compare_predicates(left, right)
    if exchange is not None:
        proposals = {exchange.category: exchange} | proposals
    if head is not None:
        proposals = {head.category: head} | proposals | {head.category: head}
    return tuple(proposals.values())


# What the difference of two forms suggests by itself, in the order of equal counts.
OF_DIFFERENCES = (
    ErrorCategory.WRONG_PREDICATE,
    ErrorCategory.MISSING_CONSTRAINT,
    ErrorCategory.EXTRA_CONSTRAINT,
    ErrorCategory.WRONG_STRUCTURE,
    ErrorCategory.WRONG_ARGUMENT,
)


def _compare_heads(gold: Form, predicted: Form) -> CategoryProposal | None:
    """Return what follows from different outermost predicates; None where they are equal."""
    said, answered = head_predicate(gold), head_predicate(predicted)
    if said == answered:
        return None
    if isinstance(predicted, Unknown):
        reason = f"The answer is UNKNOWN, the label says {said}."
    elif isinstance(gold, Unknown):
        reason = f"The label is UNKNOWN, the answer says {answered}."
    elif answered in predicates(gold):
        reason = f"The answer says {answered} alone, which is only a part of the label's {said}."
        return CategoryProposal(ErrorCategory.WRONG_STRUCTURE, reason)
    elif said in predicates(predicted):
        reason = f"The answer says {answered} around the label's {said}."
        return CategoryProposal(ErrorCategory.WRONG_STRUCTURE, reason)
    else:
        reason = f"The answer says {answered} instead of {said}."
    return CategoryProposal(ErrorCategory.WRONG_PREDICATE, reason)


def _compare_predicates(gold: Form, predicted: Form) -> CategoryProposal | None:
    """Return what follows from predicates that only one of the forms has; None where it is not both of them."""
    said, answered = (dict.fromkeys(predicates(form)) for form in (gold, predicted))
    only_said = [name for name in said if name not in answered]
    only_answered = [name for name in answered if name not in said]
    if not only_said or not only_answered:
        return None
    reason = f"The answer says {' and '.join(only_answered)} instead of {' and '.join(only_said)}."
    return CategoryProposal(ErrorCategory.WRONG_PREDICATE, reason)


def _changes(
    node: Difference, parent: Difference | None, place: int = 0
) -> Iterator[CategoryProposal]:
    """Yield each change below a pair of nodes; ``place`` is the argument of the parent, from 1."""
    if node.left is None or node.right is None:
        yield _missing_or_extra(node, parent, place)
        return
    if node.change is Change.CHANGED:
        yield _exchanged(node.left, node.right, parent, place)
    for number, child in enumerate(node.children, start=1):
        yield from _changes(child, node, number)


def _missing_or_extra(node: Difference, parent: Difference | None, place: int) -> CategoryProposal:
    form, is_missing = (node.right, False) if node.left is None else (node.left, True)
    verb = "lacks" if is_missing else "adds"
    assert form is not None
    if parent is None or not isinstance(parent.left, Application):
        category = (
            ErrorCategory.MISSING_CONSTRAINT if is_missing else ErrorCategory.EXTRA_CONSTRAINT
        )
        return CategoryProposal(category, f"The answer {verb} the constraint {to_reading(form)}.")
    predicate = parent.left.predicate
    if isinstance(form, Application):
        reason = f"The answer {verb} the part {to_reading(form)} of {predicate}."
        return CategoryProposal(ErrorCategory.WRONG_STRUCTURE, reason)
    reason = f"The answer {verb} argument {place} of {predicate}, {to_reading(form)}."
    return CategoryProposal(ErrorCategory.WRONG_ARGUMENT, reason)


def _exchanged(left: Form, right: Form, parent: Difference | None, place: int) -> CategoryProposal:
    if isinstance(left, Application) and isinstance(right, Application):
        reason = f"The answer says {right.predicate} instead of {left.predicate}."
        return CategoryProposal(ErrorCategory.WRONG_PREDICATE, reason)
    texts = f"{to_reading(right)} instead of {to_reading(left)}"
    is_argument = parent is not None and isinstance(parent.left, Application)
    fillers = Constant | Variable | Unknown | Lambda
    if is_argument and (isinstance(left, fillers) or isinstance(right, fillers)):
        assert parent is not None and isinstance(parent.left, Application)
        reason = f"The answer gives {parent.left.predicate} {texts} as argument {place}."
        return CategoryProposal(ErrorCategory.WRONG_ARGUMENT, reason)
    return CategoryProposal(ErrorCategory.WRONG_STRUCTURE, f"The answer has {texts}.")
