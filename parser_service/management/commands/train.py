"""``train PARSER --world W --split N``: a run in the foreground, or one for each of several seeds."""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Mapping
from typing import Any

from django.core.management.base import CommandError, CommandParser

from annotations.language.corpus import Criterion
from annotations.management.base import RefusedReport, ReportingCommand, find_split, find_world
from annotations.models.background import Status
from annotations.people.audit_log import record_command
from parser_service.management.options import read_hyperparameters, read_sources
from parser_service.models import TrainingRun
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.registry import parsers
from parser_service.results.run_figures import report_run, report_seeds, with_reach
from parser_service.runs import lifecycle, run_requests
from parser_service.runs.train_run import train

LOOK_EVERY = 1.0


class Command(ReportingCommand):
    help = (
        "Train and evaluate a parser in the foreground, with the code of the workers. Identical runs "
        "are reused. The exit status is 1 where the run fails."
    )

    def add_options(self, parser: CommandParser) -> None:
        parser.add_argument("parser", choices=parsers())
        parser.add_argument("--world", required=True)
        parser.add_argument("--split", required=True, help="name of a frozen or imported split")
        parser.add_argument(
            "--criterion",
            choices=[criterion.value for criterion in Criterion],
            default=Criterion.COMMAND,
            help="which of the splits of this name (default: command)",
        )
        parser.add_argument("--sources", default="gen,para", help="gen, para or gen,para")
        parser.add_argument(
            "--protocol",
            choices=list(Protocol),
            help="default: the one that knows least of those the parser has",
        )
        parser.add_argument(
            "--share",
            type=float,
            default=1.0,
            help="share of the training pairs to learn from, such as 0.25. The seed draws them; a smaller "
            "share is part of a larger one (default: 1, all of them)",
        )
        parser.add_argument("--seed", type=int, default=0)
        parser.add_argument(
            "--seeds",
            type=int,
            default=1,
            metavar="N",
            help="number of runs: one per seed, counting up from --seed. The report has each of them "
            "and the mean and spread of their accuracies, with the 95 %% interval",
        )
        parser.add_argument(
            "--config", nargs="*", default=[], metavar="KEY=VALUE", help="hyperparameters"
        )

    def report(self, *, parser: str, world: str, **options: Any) -> Mapping[str, Any]:
        home = find_world(world)
        seeds = run_requests.seeds_from(options["seed"], options["seeds"])
        asked = {
            "split": find_split(home, options["split"], options["criterion"]),
            "parser": parser,
            "config": read_hyperparameters(parser, options["config"]),
            "protocol": options["protocol"] or parsers()[parser].protocols[0],
            "train_sources": read_sources(options["sources"]),
            "train_share": options["share"],
        }
        # Each is requested when its turn comes: nothing stays in the queue where this is interrupted.
        runs = []
        for seed in seeds:
            run, _ = run_requests.request(home, seed=seed, send=False, anywhere=True, **asked)
            self._carry_out(run)
            runs.append(run)
        record_command("start a run", ", ".join(f"run {run.pk}" for run in runs), home)
        report = report_run(runs[0]) if len(runs) == 1 else report_seeds(runs)
        failed = [run for run in runs if run.status != Status.SUCCEEDED]
        if failed:
            sentences = [run.failure or f"Run {run.pk} is {run.status}." for run in failed]
            raise RefusedReport(report, list(dict.fromkeys(sentences)))
        return report

    def describe(self, report: Mapping[str, Any]) -> str:
        lines = [super().describe(report)]
        for mean in report.get("means", ()):
            where, share = _where(mean), with_reach(mean["mean"], mean["interval"])
            spread = (
                "" if mean["spread"] is None else f", standard deviation {100 * mean['spread']:.1f}"
            )
            lines.append(f"  {where}: {share} over {mean['n_seeds']} seeds{spread}")
        for mean in report["harmonic_means"]:
            share = with_reach(mean["harmonic_mean"], mean["interval"])
            both = f"unseen {100 * mean['unseen']:.1f}, known {100 * mean['known']:.1f}"
            lines.append(f"  {_where(mean)}, harmonic mean: {share} ({both})")
        return "\n".join(lines)

    def _carry_out(self, run: TrainingRun) -> None:
        """Train the run here, or wait for the worker that has it."""
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
                raise CommandError(f"Run {run.pk} continues without this command.") from None
            lifecycle.acknowledge_cancel(run)
            raise CommandError(f"Run {run.pk} was cancelled.") from None


def _where(figure: Mapping[str, Any]) -> str:
    return f"{figure['test_source']}, {figure['part']}"
