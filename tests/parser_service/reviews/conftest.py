"""Runs whose errors people review."""

from __future__ import annotations

import pytest

from annotations.background.progress import UNWATCHED
from parser_service.models import ErrorCategory, TrainingRun
from parser_service.reviews.category_proposals import propose_for_run
from parser_service.reviews.world_categories import ensure_categories


@pytest.fixture
def run(sample) -> TrainingRun:
    """The run of the sample world: three of twelve answers are right, and each error has a proposal."""
    propose_for_run(sample.run, frozenset(), UNWATCHED)
    return sample.run


@pytest.fixture
def wrong(run):
    """An example that the run has wrong."""
    return run.predictions.filter(is_exact_match=False).order_by("example_id").first().example


@pytest.fixture
def right(run):
    """An example that the run has right."""
    return run.predictions.filter(is_exact_match=True).first().example


@pytest.fixture
def categories(run) -> dict[str, ErrorCategory]:
    return ensure_categories(run.world)
