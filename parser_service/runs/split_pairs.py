"""The examples of a frozen split, as parsers read them."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from annotations.language.corpus import Criterion, Part, SplitItem, draw_share, hold_out_known
from annotations.language.texts import normalise
from annotations.models import Example, Split
from parser_service.parsers.conditions import sources_of
from parser_service.parsers.interface import Pair


def pairs_of(split: Split, part: str, train_sources: str) -> list[Pair]:
    """Return the pairs of ``part`` from ``train_sources``, in the order of the split."""
    sources = sources_of(train_sources)
    return as_pairs(split.examples.filter(part=part, source__in=sources))


def training_pairs(
    split: Split,
    train_sources: str,
    share: float = 1.0,
    seed: int = 0,
    without: Collection[int] = (),
) -> list[Pair]:
    """Return the ``share``, above 0 and up to 1, of the training pairs that ``seed`` draws, in the order
    of the split.

    They are drawn by what the split's criterion keeps together. A smaller share is part of every
    larger one of the same seed. ``without`` are the keys of examples that are held out.
    """
    sources = sources_of(train_sources)
    examples = list(split.examples.filter(part=Part.TRAIN, source__in=sources))
    left = [each for each in examples if each.pk not in without]
    if share == 1:
        return as_pairs(left)
    drawn = draw_share([item_of(each) for each in left], Criterion(split.criterion), share, seed)
    return as_pairs(each for each, is_drawn in zip(left, drawn, strict=True) if is_drawn)


def known_examples(split: Split, seed: int) -> list[Example]:
    """Return the training examples that a run with ``seed`` holds out to be asked for known forms; none
    unless the split is by form."""
    if split.criterion != Criterion.LOGICAL_FORM:
        return []
    examples = list(split.examples.filter(part=Part.TRAIN))
    held_out = hold_out_known([item_of(each) for each in examples], f"{split.content_hash}:{seed}")
    return [each for each, is_held_out in zip(examples, held_out, strict=True) if is_held_out]


def cluster_of(example: Example | SplitItem, criterion: str) -> str:
    """Return what examples share that are right or wrong together: the form where a split is by form, else
    the source command."""
    by_form = criterion == Criterion.LOGICAL_FORM
    return item_of(example).key(Criterion.LOGICAL_FORM if by_form else Criterion.SOURCE_COMMAND)


def item_of(example: Example | SplitItem) -> SplitItem:
    texts = (example.source, example.utterance, example.source_command, example.logical_form)
    return SplitItem(*texts)


def as_pairs(examples: Iterable[Example]) -> list[Pair]:
    """Return one pair per example, in their order; parsers read their utterances normalised."""
    return [
        Pair(
            normalise(example.utterance),
            example.logical_form,
            example.source,
            example.task_category,
        )
        for example in examples
    ]
