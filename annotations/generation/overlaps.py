"""Verb: count which forms and commands of a split's validation part its training part has."""

from __future__ import annotations

from collections import Counter

from django.db.models import Count

from annotations.language.corpus import Overlap, Part, overlap_of, together
from annotations.models import Split
from annotations.models.splits import Source


def form_counts(split: Split) -> Counter[tuple[str, str, str]]:
    """Count the pairs of a split by part, source and logical form. One query."""
    rows = split.examples.order_by().values_list("part", "source", "logical_form")
    return Counter({tuple(place): count for *place, count in rows.annotate(Count("pk"))})


def overlaps_of(
    split: Split, counts: Counter[tuple[str, str, str]] | None = None
) -> dict[str, Overlap]:
    """Return what the validation part asks of each source, beside the training part.

    ``counts`` are those of ``form_counts``. Two queries, one where they are given.
    """
    counts = form_counts(split) if counts is None else counts
    taught: Counter[str] = Counter()
    asked: dict[str, Counter[str]] = {}
    for (part, source, form), count in counts.items():
        if part == Part.TRAIN:
            taught[form] += count
        elif part == Part.VALIDATION:
            asked.setdefault(source, Counter())[form] += count
    new = _new_commands(split)
    return {source: overlap_of(forms, taught, new[source]) for source, forms in asked.items()}


def new_form_share(split: Split) -> float:
    """Return the share of the validation part, all sources together, whose forms no training pair has: of its forms
    or of its pairs, whichever is larger. Two queries."""
    return together(overlaps_of(split).values()).new_form_share


def _new_commands(split: Split) -> Counter[str]:
    """Count, by source, the validation pairs that rewrite a command which no training pair has or rewrites. A generated
    pair rewrites none, nor does a text of which nobody knows a command."""
    learned = split.examples.filter(part=Part.TRAIN).order_by().values("source_command")
    rows = split.examples.filter(part=Part.VALIDATION).exclude(source=Source.GENERATED)
    rows = rows.exclude(source_command="").exclude(source_command__in=learned).order_by()
    return Counter(dict(rows.values_list("source").annotate(Count("pk"))))
