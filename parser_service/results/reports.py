"""Runs and their figures as one JSON-ready mapping, for scripts; and the order of the figures."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from parser_service.analysis.seeds import over_seeds
from parser_service.models import Evaluation, TrainingRun
from parser_service.parsers.conditions import TEST_SOURCES


def order_of(score: Evaluation) -> tuple[str, int]:
    """Return a sort key: by part, then by source in the order of ``TEST_SOURCES``."""
    return score.part, list(TEST_SOURCES).index(score.test_source)


def report_run(run: TrainingRun) -> dict[str, Any]:
    """Report a run and its figures, accuracies as fractions of 1."""
    return {
        "run": run.pk,
        "status": run.status,
        "failure": run.failure,
        "parser": run.parser,
        "version": run.parser_version,
        "configuration": run.config,
        "protocol": run.protocol,
        "split": run.split.name,
        "criterion": run.split.criterion,
        "train_sources": run.train_sources,
        "train_share": run.train_share,
        "train_pairs": run.train_pairs,
        "seed": run.seed,
        "attempts": run.attempt,
        "parameters": run.parameters,
        "seconds_trained": round(run.seconds_trained, 2),
        "evaluations": [_report_figures(evaluation) for evaluation in run.evaluations.all()],
    }


def report_seeds(runs: Sequence[TrainingRun]) -> dict[str, Any]:
    """Report runs that differ by their seed, and for each test source and part the mean and spread (the
    sample standard deviation) of their accuracies, over those that succeeded."""
    scores = defaultdict(list)
    for run in runs:
        for score in run.evaluations.all():
            scores[score.test_source, score.part].append(score.accuracy)
    means = [
        {"test_source": test_source, "part": part, **asdict(over_seeds(accuracies))}
        for (test_source, part), accuracies in scores.items()
    ]
    return {
        "parser": runs[0].parser,
        "seeds": [run.seed for run in runs],
        "means": means,
        "runs": [report_run(run) for run in runs],
    }


def _report_figures(evaluation: Evaluation) -> dict[str, Any]:
    return {
        "test_source": evaluation.test_source,
        "part": evaluation.part,
        "count": evaluation.count,
        "correct": evaluation.correct,
        "accuracy": evaluation.accuracy,
        "interval": [evaluation.interval_low, evaluation.interval_high],
        "equivalent": evaluation.equivalent,
        "well_formed": evaluation.well_formed,
    }
