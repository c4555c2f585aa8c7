"""Runs of several seeds, and a split that is taken for the published one."""

from __future__ import annotations

import pytest

from annotations.models import Example, Split
from parser_service.results.published import SIZES, published_accuracy
from tests.sample_world import scored_run


def seeds(sample, *right):
    """Runs of seq2seq with seeds 0, 1, … of which so many answers are right."""
    return [
        scored_run(sample.world, sample.split, "seq2seq", each, seed)
        for seed, each in enumerate(right)
    ]


def equivalents(sample, share=0.5):
    sample.run.evaluations.update(equivalent=share)


@pytest.fixture
def published(sample):
    """The split of the sample as if it were the published one, and the paper's figure of its cell."""
    Split.objects.filter(pk=sample.split.pk).update(seed=None)
    for (source, part), count in SIZES["command"].items():
        there = sample.split.examples.filter(source=source, part=part).count()
        Example.objects.bulk_create(
            Example(
                split=sample.split,
                part=part,
                source=source,
                position=1000 + number,
                utterance="u",
                logical_form="f",
            )
            for number in range(count - there)
        )
    return published_accuracy("knn", ("gen", "gen"), "command")
