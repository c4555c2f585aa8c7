"""``train PARSER --world W --split N``: a run in the foreground, or one for each of several seeds."""

from __future__ import annotations

import os
import socket
import time
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from django.core.management.base import CommandError, CommandParser

from annotations.management.base import Refused, ReportingCommand, find_split, find_world
from annotations.models import World
from annotations.models.splits import Criterion
from parser_service import lifecycle, requesting
from parser_service.analysis.seeds import over_seeds
from parser_service.management.options import read_hyperparameters, read_sources
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.runs import Protocol, Status
from parser_service.parsers.registry import PARSERS
from parser_service.training import train

LOOK_EVERY = 1.0


class Command(ReportingCommand):
    help = (
        "Trains and evaluates a parser here and now, with the code of the workers. What has been "
        "trained already is not trained again. Exit status 1 where the run fails."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("parser", choices=PARSERS)
        parser.add_argument("--world", required=True)
        parser.add_argument("--split", required=True, help="name of a frozen or imported split")
        parser.add_argument(
            "--criterion",
            choices=Criterion.values,
            default=Criterion.COMMAND,
            help="which of the splits of this name (default: command)",
        )
        parser.add_argument("--sources", default="gen,para", help="gen, para or gen,para")
        parser.add_argument(
            "--protocol", choices=Protocol.values, help="default: the least that the parser has"
        )
        parser.add_argument("--seed", type=int, default=0)
        parser.add_argument(
            "--seeds",
            type=int,
            default=1,
            metavar="N",
            help="train N times, one after the other, with the seeds from --seed up; reports each run "
            "and the mean and spread of the accuracies",
        )
        parser.add_argument(
            "--config", nargs="*", default=[], metavar="KEY=VALUE", help="hyperparameters"
        )

    def report(self, *, parser: str, world: str, **options: Any) -> Mapping[str, Any]:
        found = find_world(world)
        seeds = requesting.seeds_from(options["seed"], options["seeds"])
        asked = {
            "split": find_split(found, options["split"], options["criterion"]),
            "parser": parser,
            "config": read_hyperparameters(parser, options["config"]),
            "protocol": options["protocol"] or PARSERS[parser].protocols[0],
            "train_sources": read_sources(options["sources"]),
        }
        # Each is asked for when its turn comes: nothing stays in the queue where this is interrupted.
        runs = [self._trained(found, seed, asked) for seed in seeds]
        report = as_report(runs[0]) if len(runs) == 1 else as_report_of_seeds(runs)
        failed = [run for run in runs if run.status != Status.SUCCEEDED]
        if failed:
            sentences = [run.failure or f"Run {run.pk} is {run.status}." for run in failed]
            raise Refused(report, list(dict.fromkeys(sentences)))
        return report

    def describe(self, report: Mapping[str, Any]) -> str:
        lines = [super().describe(report)]
        for each in report.get("means", ()):
            spread = "" if each["spread"] is None else f" ± {100 * each['spread']:.1f}"
            where = f"{each['test_source']}, {each['part']}"
            lines.append(
                f"  {where}: {100 * each['mean']:.1f}{spread} % over {each['n_seeds']} seeds"
            )
        return "\n".join(lines)

    def _trained(self, world: World, seed: int, asked: Mapping[str, Any]) -> TrainingRun:
        run, _ = requesting.request(world, seed=seed, send=False, **asked)
        self._carry_out(run)
        return run

    def _carry_out(self, run: TrainingRun) -> None:
        """Trains the run here, or waits for the worker that has it."""
        name = f"foreground-{os.getpid()}@{socket.gethostname()}"
        try:
            while not run.is_ended:
                if claimed := lifecycle.claim(name, run.queue, run):
                    train(claimed, tell=self.stderr.write)
                else:
                    time.sleep(LOOK_EVERY)
                    lifecycle.requeue_expired()
                run.refresh_from_db()
        except KeyboardInterrupt:
            run.refresh_from_db()
            if run.worker != name:
                raise CommandError(f"Run {run.pk} goes on without this command.") from None
            lifecycle.acknowledge_cancel(run)
            raise CommandError(f"Run {run.pk} was cancelled.") from None


def as_report(run: TrainingRun) -> dict[str, Any]:
    """A run and its figures, accuracies as fractions of 1."""
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
        "seed": run.seed,
        "attempts": run.attempt,
        "parameters": run.parameters,
        "seconds_trained": round(run.seconds_trained, 2),
        "evaluations": [_figures(evaluation) for evaluation in run.evaluations.all()],
    }


def as_report_of_seeds(runs: Sequence[TrainingRun]) -> dict[str, Any]:
    """Runs that differ by their seed, and for each test source and part the mean of their accuracies
    and its spread (the sample standard deviation), over those that succeeded."""
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
        "runs": [as_report(run) for run in runs],
    }


def _figures(evaluation: Evaluation) -> dict[str, Any]:
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
