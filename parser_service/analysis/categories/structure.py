"""What an answer has wrong, from the difference between the label and the answer alone."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
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
    head_predicate,
    predicates,
    to_reading,
)
from parser_service.analysis.categories.error_categories import ErrorCategory

# Three kinds of change at once are more than a slip in one place.
_KINDS_OF_A_WRONG_STRUCTURE = 3
_BOTH_MEAN_THE_SAME = (
    "Label and answer mean the same; only the conjunctions are written differently."
)


@dataclass(frozen=True, slots=True)
class Proposal:
    """An error category and a sentence that says why."""

    category: ErrorCategory
    reason: str


@lru_cache(maxsize=1 << 14)
def read_structure(gold: Form, predicted: Form) -> tuple[Proposal, ...]:
    """Return what the difference of two forms suggests, the most likely first; at least one.

    A different head predicate comes first. Otherwise the kind with the most changes does; of as many,
    predicates before constraints before arguments.
    """
    left, right = _flatten(gold), _flatten(predicted)
    if equivalent(left, right):
        return (Proposal(ErrorCategory.WRONG_STRUCTURE, _BOTH_MEAN_THE_SAME),)
    head = _compare_heads(left, right)
    if head is not None and UNKNOWN in (left, right):
        return (head,)
    by_category: defaultdict[ErrorCategory, list[str]] = defaultdict(list)
    for each in _changes(diff_unordered(left, right), None):
        by_category[each.category].append(each.reason)
    ranked = sorted(
        by_category, key=lambda kind: (-len(by_category[kind]), OF_DIFFERENCES.index(kind))
    )
    proposals = {kind: Proposal(kind, " ".join(by_category[kind])) for kind in ranked}
    if len(proposals) >= _KINDS_OF_A_WRONG_STRUCTURE:
        reason = f"{len(proposals)} kinds of things differ between the label and the answer."
        whole = Proposal(ErrorCategory.WRONG_STRUCTURE, reason)
        proposals = {ErrorCategory.WRONG_STRUCTURE: whole} | proposals
    if head is not None:
        proposals = {head.category: head} | proposals | {head.category: head}
    return tuple(proposals.values())


# What the difference of two forms suggests by itself, in the order of equal counts.
OF_DIFFERENCES = (
    ErrorCategory.WRONG_PREDICATE,
    ErrorCategory.MISSING_CONSTRAINT,
    ErrorCategory.EXTRA_CONSTRAINT,
    ErrorCategory.WRONG_ARGUMENT,
    ErrorCategory.WRONG_STRUCTURE,
)


def _flatten(form: Form) -> Form:
    """Write every conjunction below a λ as several bodies."""
    if isinstance(form, Application):
        return replace(form, arguments=tuple(map(_flatten, form.arguments)))
    if not isinstance(form, Lambda):
        return form
    bodies: list[Form] = []
    for body in map(_flatten, form.bodies):
        is_conjunction = isinstance(body, Application) and body.predicate == "and"
        bodies += body.arguments if is_conjunction and isinstance(body, Application) else (body,)
    return replace(form, bodies=tuple(bodies))


def _compare_heads(gold: Form, predicted: Form) -> Proposal | None:
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
        return Proposal(ErrorCategory.WRONG_STRUCTURE, reason)
    elif said in predicates(predicted):
        reason = f"The answer says {answered} around the label's {said}."
        return Proposal(ErrorCategory.WRONG_STRUCTURE, reason)
    else:
        reason = f"The answer says {answered} instead of {said}."
    return Proposal(ErrorCategory.WRONG_PREDICATE, reason)


def _changes(node: Difference, parent: Difference | None, place: int = 0) -> Iterator[Proposal]:
    """Yield each change below a pair of nodes; ``place`` is the argument of the parent, from 1."""
    if node.left is None or node.right is None:
        yield _missing_or_extra(node, parent, place)
        return
    if node.change is Change.CHANGED:
        yield _exchanged(node.left, node.right, parent, place)
    for number, child in enumerate(node.children, start=1):
        yield from _changes(child, node, number)


def _missing_or_extra(node: Difference, parent: Difference | None, place: int) -> Proposal:
    form, is_missing = (node.right, False) if node.left is None else (node.left, True)
    verb = "lacks" if is_missing else "adds"
    assert form is not None
    if parent is None or not isinstance(parent.left, Application):
        category = (
            ErrorCategory.MISSING_CONSTRAINT if is_missing else ErrorCategory.EXTRA_CONSTRAINT
        )
        return Proposal(category, f"The answer {verb} the constraint {to_reading(form)}.")
    predicate = parent.left.predicate
    if isinstance(form, Application):
        reason = f"The answer {verb} the part {to_reading(form)} of {predicate}."
        return Proposal(ErrorCategory.WRONG_STRUCTURE, reason)
    reason = f"The answer {verb} argument {place} of {predicate}, {to_reading(form)}."
    return Proposal(ErrorCategory.WRONG_ARGUMENT, reason)


def _exchanged(left: Form, right: Form, parent: Difference | None, place: int) -> Proposal:
    if isinstance(left, Application) and isinstance(right, Application):
        reason = f"The answer says {right.predicate} instead of {left.predicate}."
        return Proposal(ErrorCategory.WRONG_PREDICATE, reason)
    texts = f"{to_reading(right)} instead of {to_reading(left)}"
    is_argument = parent is not None and isinstance(parent.left, Application)
    fillers = Constant | Variable | Unknown | Lambda
    if is_argument and isinstance(left, fillers) and isinstance(right, fillers):
        assert parent is not None and isinstance(parent.left, Application)
        reason = f"The answer gives {parent.left.predicate} {texts} as argument {place}."
        return Proposal(ErrorCategory.WRONG_ARGUMENT, reason)
    return Proposal(ErrorCategory.WRONG_STRUCTURE, f"The answer has {texts}.")
