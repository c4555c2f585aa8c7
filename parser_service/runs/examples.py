"""The examples of a frozen split, as parsers read them."""

from __future__ import annotations

from collections.abc import Iterable

from annotations.language.corpus import Criterion, SplitItem, draw_share
from annotations.models import Example, Split
from annotations.models.splits import Part
from parser_service.parsers.conditions import TrainSources
from parser_service.parsers.interface import Pair


def pairs_of(split: Split, part: str, train_sources: str) -> list[Pair]:
    """Return the pairs of ``part`` from ``train_sources``, in the order of the split."""
    sources = TrainSources(train_sources).sources
    return as_pairs(split.examples.filter(part=part, source__in=sources))


def training_pairs(
    split: Split, train_sources: str, share: float = 1.0, seed: int = 0
) -> list[Pair]:
    """Return the ``share``, above 0 and up to 1, of the training pairs that ``seed`` draws, in the order
    of the split.

    They are drawn by what the split's criterion keeps together. A smaller share is part of every
    larger one of the same seed.
    """
    if share == 1:
        return pairs_of(split, Part.TRAIN, train_sources)
    sources = TrainSources(train_sources).sources
    examples = list(split.examples.filter(part=Part.TRAIN, source__in=sources))
    items = [
        SplitItem(each.source, each.utterance, each.source_command, each.logical_form)
        for each in examples
    ]
    drawn = draw_share(items, Criterion(split.criterion), share, seed)
    return as_pairs(each for each, is_drawn in zip(examples, drawn, strict=True) if is_drawn)


def as_pairs(examples: Iterable[Example]) -> list[Pair]:
    """Return one pair per example, in their order."""
    return [
        Pair(example.utterance, example.logical_form, example.source, example.task_category)
        for example in examples
    ]
