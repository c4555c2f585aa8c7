"""The examples of a frozen split, as parsers read them."""

from __future__ import annotations

from collections.abc import Iterable

from annotations.models import Example, Split
from parser_service.parsers.conditions import TrainSources
from parser_service.parsers.interface import Pair


def pairs_of(split: Split, part: str, train_sources: str) -> list[Pair]:
    """Return the pairs of ``part`` from ``train_sources``, in the order of the split."""
    sources = TrainSources(train_sources).sources
    return as_pairs(split.examples.filter(part=part, source__in=sources))


def as_pairs(examples: Iterable[Example]) -> list[Pair]:
    """Return one pair per example, in their order."""
    return [
        Pair(example.utterance, example.logical_form, example.source, example.task_category)
        for example in examples
    ]
