"""What the parts of a split hold, and what they share."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from django.db.models import Count, Q

from annotations.models import Example, Split
from annotations.models.splits import Part, Source


@dataclass(frozen=True, slots=True)
class PartCounts:
    """Pairs of one source by part."""

    source: str
    train: int
    validation: int
    test: int
    forms: int

    @property
    def total(self) -> int:
        return self.train + self.validation + self.test


@dataclass(frozen=True, slots=True)
class Leak:
    """How much of what stands in ``part`` stands in the training part too.

    ``what`` is a plural: utterances, logical forms or source commands. ``pairs`` counts the pairs of
    ``part`` that have such a thing at all, ``shared`` those of them whose thing training has seen.
    """

    part: str
    what: str
    pairs: int
    shared: int

    @property
    def percent(self) -> float:
        return 100 * self.shared / self.pairs if self.pairs else 0.0


def counts_of(splits: Iterable[Split]) -> dict[int, list[PartCounts]]:
    """Key → the counts of each source that a split has. Two queries for all splits."""
    examples = Example.objects.filter(split__in=splits).order_by()
    sizes: dict[int, dict[tuple[str, str], int]] = defaultdict(dict)
    for key, source, part, count in examples.values_list("split_id", "source", "part").annotate(
        Count("pk")
    ):
        sizes[key][source, part] = count
    forms = {
        (key, source): count
        for key, source, count in examples.values_list("split_id", "source").annotate(
            Count("logical_form", distinct=True)
        )
    }
    return {
        split.pk: [
            PartCounts(
                source,
                *(sizes[split.pk].get((source, part), 0) for part in Part),
                forms[split.pk, source],
            )
            for source in Source
            if (split.pk, source) in forms
        ]
        for split in splits
    }


def counts_of_planned(examples: Sequence[Example]) -> list[PartCounts]:
    """The counts of examples that are not stored."""
    sizes = Counter((example.source, example.part) for example in examples)
    forms = Counter(source for source, _ in {(each.source, each.logical_form) for each in examples})
    return [
        PartCounts(source, *(sizes[source, part] for part in Part), forms[source])
        for source in Source
        if forms[source]
    ]


LEAKS = {
    "utterance": "utterances",
    "source_command": "source commands",
    "logical_form": "logical forms",
}


def leakage_of(split: Split) -> list[Leak]:
    """What validation and test share with training, both sources together. A query each."""
    return [
        leak
        for part in (Part.VALIDATION, Part.TEST)
        for field, what in LEAKS.items()
        if (leak := _leak(split, part, field, what)).pairs
    ]


def _leak(split: Split, part: str, field: str, what: str) -> Leak:
    seen = split.examples.of(Part.TRAIN).exclude(**{field: ""}).order_by().values(field)
    shared = Count("pk", filter=Q(**{f"{field}__in": seen}))
    rows = split.examples.of(part).exclude(**{field: ""})
    return Leak(part, what, **rows.aggregate(pairs=Count("pk"), shared=shared))
