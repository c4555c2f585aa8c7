"""How well two people agree on the utterances that both have labelled, and where they do not."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass

from django.db.models import Q

from annotations.language.corpus import Agreement, Distances, measure
from annotations.language.forms import (
    UNKNOWN,
    Constant,
    FormDistances,
    head_predicate,
    read_template_form,
)
from annotations.models import Assignment, WorkItem, World
from annotations.models.corpus import Verdict
from annotations.models.counting import count_of

MOST_ITEMS = 1000  # the newest, so that the page answers at once
MOST_FORMS = 100  # distinct ones between which distances are computed
MOST_ROWS = 20  # of each table


@dataclass(frozen=True, slots=True)
class DoubleLabel:
    """What two people said of one utterance: the form, or the verdict where it is none.

    ``is_settled`` unless somebody is still asked which of the two is right, and must not see them here.
    """

    title: str
    answers: tuple[str, ...]
    task_category: str
    is_settled: bool = True

    @property
    def heads(self) -> frozenset[str]:
        return frozenset(head_of(answer) for answer in self.answers)


@dataclass(frozen=True, slots=True)
class AgreementSlice:
    """Agreement on a part of the items, such as those of one task category."""

    name: str
    agreement: Agreement


@dataclass(frozen=True, slots=True)
class Disagreement:
    """Two answers that were given to the same utterances, how often, and one of these."""

    first: str
    second: str
    count: int
    example: str


def double_labels(world: World) -> list[DoubleLabel]:
    """Return the newest items that two people have labelled, at most ``MOST_ITEMS``."""
    done = count_of(Assignment.objects.filter(label__isnull=False), "item")
    items = WorkItem.objects.filter(world=world, people__gt=1, closed_at__isnull=False)
    is_settled = Q(followed_by=None) | ~Q(followed_by__closed_at=None)
    annotated = items.annotate(done=done, is_settled=Q(is_settled))  # type: ignore[no-redef]  # declared for readers
    counted = annotated.filter(done__gt=1)
    keys = list(counted.order_by("-pk")[:MOST_ITEMS])
    answers: dict[int, list[str]] = defaultdict(list)
    rows = Assignment.objects.done().filter(item__in=keys, label__isnull=False)
    for key, verdict, form in rows.order_by("pk").values_list(
        "item", "label__verdict", "label__form"
    ):
        answers[key].append(form if verdict == Verdict.FORM else verdict)
    categories = categories_of(world, {form for given in answers.values() for form in given})
    labels = []
    for item in keys:
        given = tuple(answers[item.pk])
        known = (categories[answer] for answer in given if categories.get(answer))
        category = next(known, "without a category")
        labels.append(DoubleLabel(item.title, given, category, item.is_settled))
    return labels


def categories_of(world: World, forms: set[str]) -> dict[str, str]:
    """Return the task category of each form that a command has."""
    rows = world.logical_forms.filter(text__in=list(forms)[:MOST_ITEMS])
    return dict(rows.values_list("text", "task_category"))


def head_of(answer: str) -> str:
    """Return the outermost predicate of a form; the verdict itself where it is none."""
    return answer if answer in Verdict.values else head_predicate(read_template_form(answer))


@dataclass(frozen=True, slots=True)
class AgreementReport:
    """Everything that the page of agreement shows.

    ``is_capped`` where there are more items than the newest ``MOST_ITEMS``; ``has_distances`` where α
    counts a small difference of two forms less than a large one (it compares all pairs of forms, so
    that with very many of them it only tells equal from different). ``unsettled`` items count in
    ``overall`` alone: whoever settles them must not see here what was answered.
    """

    overall: Agreement
    by_category: list[AgreementSlice]
    by_head: list[AgreementSlice]
    disagreements: list[Disagreement]
    is_capped: bool
    has_distances: bool
    unsettled: int


def report_agreement(world: World) -> AgreementReport:
    """Measure how well two people agree in ``world``."""
    labels = double_labels(world)
    answers = {answer for label in labels for answer in label.answers}
    has_distances = len(answers) <= MOST_FORMS
    distances = form_distances(FormDistances()) if has_distances else None
    settled = [label for label in labels if label.is_settled]
    return AgreementReport(
        measure([label.answers for label in labels], distances),
        _slices(((label.task_category, label) for label in settled), distances),
        _slices(((head, label) for label in settled for head in label.heads), distances),
        disagreements(settled),
        len(labels) == MOST_ITEMS,
        has_distances,
        len(labels) - len(settled),
    )


def form_distances(known: FormDistances) -> Distances:
    """Return what gives the distances of answers; a verdict has nothing in common with a form."""

    def distances(answers: Sequence[Hashable]) -> list[list[float]]:
        verdicts = {each: Constant(each) for each in Verdict.values} | {Verdict.UNKNOWN: UNKNOWN}
        return known.matrix(
            [verdicts.get(each) or read_template_form(each) for each in map(str, answers)]
        )

    return distances


def _slices(
    named: Iterable[tuple[str, DoubleLabel]], distances: Distances | None
) -> list[AgreementSlice]:
    """Return the agreement on the items of each name, the largest first."""
    groups: dict[str, list[tuple[str, ...]]] = defaultdict(list)
    for name, label in named:
        groups[name].append(label.answers)
    largest = sorted(groups.items(), key=lambda group: (-len(group[1]), group[0]))
    return [
        AgreementSlice(name, measure(answers, distances)) for name, answers in largest[:MOST_ROWS]
    ]


def disagreements(labels: Sequence[DoubleLabel]) -> list[Disagreement]:
    """Return the pairs of answers that differ, the most frequent first."""
    counts: Counter[tuple[str, ...]] = Counter()
    examples: dict[tuple[str, ...], str] = {}
    for label in labels:
        pair = tuple(sorted(set(label.answers)))
        if len(pair) == 2:
            counts[pair] += 1
            examples.setdefault(pair, label.title)
    return [
        Disagreement(first, second, count, examples[first, second])
        for (first, second), count in counts.most_common(MOST_ROWS)
    ]
