"""Runs and their figures as one JSON-ready mapping, for scripts; and the order of the figures."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from annotations.language.corpus import KNOWN
from parser_service.analysis.scores import over_seeds
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.evaluations import ShownScore, reach_of, shown_scores
from parser_service.parsers.conditions import TEST_SOURCES
from parser_service.results.measures import Measure, interval_of, is_known
from parser_service.results.seed_figures import figure_of

KNOWN_FORMS = "Pairs held out of the training part, by whole source commands, whose logical forms stay in training"


def order_of(score: Evaluation) -> tuple[bool, str, int]:
    """Return a sort key: by part, known forms last, then by source in the order of ``TEST_SOURCES``."""
    return score.part == KNOWN, score.part, list(TEST_SOURCES).index(score.test_source)


def scores_by_form(run: TrainingRun) -> list[ShownScore]:
    """Return the scores of a run by form, each on unseen and on known forms, in order; none for a split by something
    else."""
    shown = shown_scores(run.evaluations.all(), run.split.criterion).values()
    of_forms = (each for each in shown if each.is_by_form)
    return sorted(of_forms, key=lambda each: order_of(each.score))


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
        "evaluations": [_report_score(score) for score in run.evaluations.all()],
        "harmonic_means": harmonic_means([run]),
    }


def _report_score(score: Evaluation) -> dict[str, Any]:
    """Report a score by every measure, those that compare answers with their 95 % intervals; the plan's are None
    where plans were not compared."""
    is_compared = is_known(score, Measure.SAME_PLAN)
    return {
        "test_source": score.test_source,
        "part": score.part,
        "count": score.count,
        "correct": score.correct,
        "accuracy": score.accuracy,
        "interval": list(interval_of(score, Measure.EXACT)),
        "equivalent": score.equivalent,
        "equivalent_interval": list(interval_of(score, Measure.EQUIVALENT)),
        "same_plan": score.same_plan,
        "same_plan_interval": list(interval_of(score, Measure.SAME_PLAN)) if is_compared else None,
        "well_formed": score.well_formed,
    }


def report_seeds(runs: Sequence[TrainingRun]) -> dict[str, Any]:
    """Report runs that differ by their seed. For each test source and part there are the mean accuracy of those
    that succeeded, its spread (the sample standard deviation) and its 95 % interval."""
    scores = _scores(runs)
    means = [
        {
            "test_source": test_source,
            "part": part,
            **asdict(over_seeds([score.accuracy for score in of_part])),
            "interval": list(figure_of(of_part, Measure.EXACT).interval),
        }
        for (test_source, part), of_part in scores.items()
    ]
    return {
        "parser": runs[0].parser,
        "seeds": [run.seed for run in runs],
        "means": means,
        "harmonic_means": harmonic_means(runs),
        "runs": [report_run(run) for run in runs],
    }


def harmonic_means(runs: Sequence[TrainingRun]) -> list[dict[str, Any]]:
    """Report the harmonic mean of accuracy on unseen and on known forms, over runs that differ by their seed, with
    its 95 % interval; nothing for a split that is not by form, and where known forms were not held out."""
    scores = _scores(runs)
    reported = []
    for (test_source, part), of_part in scores.items():
        known = scores.get((test_source, KNOWN), [])
        if part == KNOWN or [each.run_id for each in known] != [each.run_id for each in of_part]:
            continue
        figure = figure_of(of_part, Measure.EXACT, known=known)
        unseen, of_known = (each.percent / 100 for each in figure.parts)
        reported.append(
            {
                **{"test_source": test_source, "part": part, "unseen": unseen, "known": of_known},
                **{"harmonic_mean": figure.over_seeds.mean, "interval": list(figure.interval)},
            }
        )
    return reported


def _scores(runs: Sequence[TrainingRun]) -> dict[tuple[str, str], list[Evaluation]]:
    """Return the scores by test source and part, in the order of the runs."""
    scores = defaultdict(list)
    for run in runs:
        for score in run.evaluations.all():
            scores[score.test_source, score.part].append(score)
    return dict(scores)


def with_reach(share: float, interval: Sequence[float]) -> str:
    """Return a share in percent with how far its 95 % interval reaches, as ``50.0 ± 7.1 %``."""
    percent, low, high = (100 * number for number in (share, *interval))
    return f"{percent:.1f} ± {reach_of(percent, low, high):.1f} %"
