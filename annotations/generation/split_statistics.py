"""What the parts of a split hold, and what they share."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Self

from annotations.language.corpus import (
    MOST_COMPARISONS,
    FormOverlap,
    Leak,
    NearDuplicates,
    Overlap,
    Part,
    SplitItem,
    comparisons,
    near_duplicates,
    overlap_of,
    shared,
    together,
)
from annotations.language.texts import LanguageError
from annotations.models import Example, Split
from annotations.models.splits import Source

COLUMNS = ("part", "source", "utterance", "source_command", "logical_form")


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


@dataclass(frozen=True, slots=True)
class SplitFigures:
    """The figures of a split, which never change and are stored with it.

    Attributes:
        counts: of each source that it has.
        leaks: what validation and test share with training, all sources together.
        overlaps: by source what its validation part asks for, beside the training part.
    """

    counts: tuple[PartCounts, ...]
    leaks: tuple[Leak, ...]
    overlaps: Mapping[str, Overlap]

    @property
    def new_form_share(self) -> float:
        """The share of the validation part, all sources together, whose forms no training pair has: of its forms
        or of its pairs, whichever is larger."""
        return together(self.overlaps.values()).new_form_share

    def as_json(self) -> dict[str, Any]:
        """Return what ``from_json`` reads. Forms that as many pairs have are one row: what is stored stays small."""
        return {
            "counts": [asdict(each) for each in self.counts],
            "leaks": [asdict(each) for each in self.leaks],
            "overlaps": {
                source: {
                    "forms": [
                        [form.asked, form.taught, times]
                        for form, times in Counter(overlap.forms).items()
                    ],
                    "new_commands": overlap.new_commands,
                }
                for source, overlap in self.overlaps.items()
            },
        }

    @classmethod
    def from_json(cls, stored: Mapping[str, Any]) -> Self:
        return cls(
            tuple(PartCounts(**each) for each in stored["counts"]),
            tuple(Leak(**each) for each in stored["leaks"]),
            {
                source: Overlap(
                    tuple(
                        FormOverlap(asked, taught)
                        for asked, taught, times in overlap["forms"]
                        for _ in range(times)
                    ),
                    overlap["new_commands"],
                )
                for source, overlap in stored["overlaps"].items()
            },
        )


def figures_of(split: Split) -> SplitFigures:
    """Return the figures that are stored with ``split``; while it has none, its examples are counted."""
    return SplitFigures.from_json(split.figures) if split.figures else _counted(split)


def store_figures(split: Any) -> None:
    """Count the examples of ``split`` and store its figures. Migrations call it with rows of theirs."""
    split.figures = _counted(split).as_json()
    split.save(update_fields=["figures"])


def _counted(split: Any) -> SplitFigures:
    rows = split.examples.order_by("pk").values_list(*COLUMNS)
    return count_examples(rows.iterator(chunk_size=5000))


def figures_of_planned(examples: Iterable[Example]) -> SplitFigures:
    """Return the figures of examples that are not stored."""
    return count_examples(tuple(getattr(each, name) for name in COLUMNS) for each in examples)


def count_examples(rows: Iterable[Sequence[str]]) -> SplitFigures:
    """Return the figures of examples, each the texts of ``COLUMNS``."""
    parts: dict[str, list[SplitItem]] = {part: [] for part in Part}
    for part, *texts in rows:
        parts[part].append(SplitItem(*texts))
    sizes = Counter((item.source, part) for part, items in parts.items() for item in items)
    pairs = {(item.source, item.logical_form) for items in parts.values() for item in items}
    forms = Counter(source for source, _ in pairs)
    train = parts[Part.TRAIN]
    return SplitFigures(
        tuple(
            PartCounts(
                source,
                sizes[source, Part.TRAIN],
                sizes[source, Part.VALIDATION],
                sizes[source, Part.TEST],
                forms[source],
            )
            for source in Source
            if forms[source]
        ),
        tuple(
            leak
            for part, items in parts.items()
            if part != Part.TRAIN
            for leak in shared(part, items, train)
        ),
        _overlaps(train, parts[Part.VALIDATION]),
    )


def _overlaps(train: Sequence[SplitItem], validation: Sequence[SplitItem]) -> dict[str, Overlap]:
    """Return by source what ``validation`` asks for, beside ``train``.

    New commands are those that no training pair has or rewrites. A generated pair rewrites none, nor does a text of
    which nobody knows a command.
    """
    taught = Counter(item.logical_form for item in train)
    learned = {"", *(item.source_command for item in train)}
    asked: dict[str, Counter[str]] = {}
    new: Counter[str] = Counter()
    for item in validation:
        asked.setdefault(item.source, Counter())[item.logical_form] += 1
        if item.source != Source.GENERATED and item.source_command not in learned:
            new[item.source] += 1
    return {source: overlap_of(forms, taught, new[source]) for source, forms in asked.items()}


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
            hint=f"run gpsr-workbench manage leakage {split.world.name} {split.name}",
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
