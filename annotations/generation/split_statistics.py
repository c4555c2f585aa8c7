"""What the parts of a split hold, and what they share."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

from django.db.models import Count

from annotations.language.corpus import (
    MOST_COMPARISONS,
    Leak,
    NearDuplicates,
    Part,
    SplitItem,
    comparisons,
    near_duplicates,
    shared,
)
from annotations.language.texts import LanguageError
from annotations.models import Example, Split
from annotations.models.splits import Source

KEPT_SPLITS = 64


@dataclass(frozen=True, slots=True)
class PartCounts:
    """Pairs of one source by part, and how many different forms they have."""

    source: str
    train: int
    validation: int
    test: int
    forms: int

    @property
    def total(self) -> int:
        return self.train + self.validation + self.test


def counts_of(splits: Iterable[Split]) -> dict[int, list[PartCounts]]:
    """Return key → the counts of each source that a split has. Two queries for all splits."""
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
                sizes[split.pk].get((source, Part.TRAIN), 0),
                sizes[split.pk].get((source, Part.VALIDATION), 0),
                sizes[split.pk].get((source, Part.TEST), 0),
                forms[split.pk, source],
            )
            for source in Source
            if (split.pk, source) in forms
        ]
        for split in splits
    }


def counts_of_planned(examples: Sequence[Example]) -> list[PartCounts]:
    """Return the counts of examples that are not stored."""
    sizes = Counter((example.source, example.part) for example in examples)
    forms = Counter(source for source, _ in {(each.source, each.logical_form) for each in examples})
    return [
        PartCounts(
            source,
            sizes[source, Part.TRAIN],
            sizes[source, Part.VALIDATION],
            sizes[source, Part.TEST],
            forms[source],
        )
        for source in Source
        if forms[source]
    ]


def leakage_of(split: Split) -> Sequence[Leak]:
    """Return what validation and test share with training, both sources together.

    One query, and none for a split that was asked about lately: it never changes.
    """
    return _leakage_of(split.pk, split.content_hash)


@lru_cache(maxsize=KEPT_SPLITS)
def _leakage_of(key: int, content_hash: str) -> Sequence[Leak]:
    parts = _items_by_part(Split(pk=key))
    train = parts.pop(Part.TRAIN, [])
    return tuple(leak for part, items in parts.items() for leak in shared(part, items, train))


def near_duplicates_of(split: Split, limit: int | None = MOST_COMPARISONS) -> list[NearDuplicates]:
    """Return the near duplicates of validation and of test in training, both sources together. One query.

    Raises LanguageError where that takes more than ``limit`` comparisons of two utterances.
    """
    parts = _items_by_part(split)
    train = parts.pop(Part.TRAIN, [])
    needed = sum(comparisons(items, train) for items in parts.values())
    if limit is not None and needed > limit:
        raise LanguageError(
            f"comparing all utterances with training takes {needed:,} comparisons",
            hint=f"run manage.py leakage {split.world.name} {split.name}",
        )
    return [near_duplicates(part, items, train) for part, items in parts.items()]


def _items_by_part(split: Split) -> dict[str, list[SplitItem]]:
    """Return part → its examples, in the order train, validation, test; without parts that are empty."""
    rows = split.examples.order_by("pk").values_list(
        "part", "source", "utterance", "source_command", "logical_form"
    )
    parts: dict[str, list[SplitItem]] = {part: [] for part in Part}
    for part, *texts in rows.iterator(chunk_size=5000):
        parts[part].append(SplitItem(*texts))
    return {part: items for part, items in parts.items() if items}
