"""The report of one run on one part of its split."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

from annotations.models.splits import Part
from annotations.splits.split_statistics import counts_of
from parser_service.analysis.confusions import confuse_heads, confuse_slots
from parser_service.models import TrainingRun
from parser_service.parsers.registry import PARSERS
from parser_service.reporting.answers import Answers
from parser_service.reporting.charts import Bar, Line, draw_bars, draw_lines
from parser_service.reporting.document import Section, write_document
from parser_service.reporting.slices import slice_tables
from parser_service.reporting.wrong_answers import MOST_WRONG, count_wrong, wrong_answers
from parser_service.results.reports import order_of

MOST_CONFUSIONS = 15


def run_report(run: TrainingRun, part: str) -> Iterator[str]:
    """Yield the report of ``run``, which has answers on ``part``, as pieces of one HTML file."""
    report = _RunReport(run, part)
    entry = PARSERS.get(run.parser)
    title = f"{entry.title if entry else run.parser}, run {run.pk}"
    about = {"run": run, "world": run.world, "part": part}
    yield from write_document(title, about, report.sections)


def part_of(run: TrainingRun, asked: str = "") -> str | None:
    """Return the part that a report is about: the one asked for where the run was tested on it, else the
    validation part, else the test part; None before any test."""
    tested = {each.part for each in run.evaluations.all()}
    return next((part for part in (asked, *Part) if part in tested), None)


class _RunReport:
    def __init__(self, run: TrainingRun, part: str) -> None:
        self.run, self.part = run, part

    @cached_property
    def answers(self) -> Answers:
        return Answers(self.run, self.part)

    @property
    def sections(self) -> list[Section]:
        sections = [
            Section("configuration", "Configuration", "configuration", self._configuration),
            Section("accuracy", "Accuracy", "accuracy", self._accuracy),
        ]
        if self.run.epochs.exists():
            sections.append(Section("training", "Training", "training", self._training))
        sections += [
            Section("slices", f"Slices of the {self.part} part", "slices", self._slices),
            Section("confusions", "Confusions", "confusions", self._confusions),
            Section(
                "wrong",
                "Wrong answers",
                "wrong_answers",
                self._wrong,
                rows=lambda: wrong_answers(self.run, self.part),
            ),
        ]
        return sections

    def _configuration(self) -> dict[str, Any]:
        entry = PARSERS.get(self.run.parser)
        return {
            "description": entry.description if entry else "",
            "changed": dict(self.run.changed_hyperparameters()),
            "counts": counts_of([self.run.split])[self.run.split_id],
            "checkpoints": self.run.checkpoints.all(),
        }

    def _accuracy(self) -> dict[str, Any]:
        scores = sorted(self.run.evaluations.all(), key=order_of)
        bars = [
            Bar(
                f"{each.part}, {each.test_source}",
                each.accuracy,
                each.interval_low,
                each.interval_high,
            )
            for each in scores
        ]
        return {"scores": scores, "chart": draw_bars("Exact match by part and source", bars)}

    def _training(self) -> dict[str, Any]:
        epochs = list(self.run.epochs.all())
        numbers = [each.epoch for each in epochs]
        losses = [
            Line("training", numbers, [each.train_loss for each in epochs]),
            Line("validation", numbers, [each.validation_loss for each in epochs]),
        ]
        accuracy = [
            None if each.validation_accuracy is None else 100 * each.validation_accuracy
            for each in epochs
        ]
        return {
            "epochs": epochs,
            "losses": draw_lines("Loss by epoch", losses, "epoch", "loss"),
            "accuracy": draw_lines(
                "Exact match on the validation part by epoch",
                [Line("validation", numbers, accuracy)],
                "epoch",
                "exact match, %",
            ),
        }

    def _slices(self) -> dict[str, Any]:
        return {"tables": slice_tables([self.answers]), "names": ["Exact match"]}

    def _confusions(self) -> dict[str, Any]:
        labels, answers = self.answers.labels, self.answers.answers
        slots = [row for row in confuse_slots(labels, answers) if row.is_error]
        heads = confuse_heads(labels, answers).errors()
        return {
            "heads": heads[:MOST_CONFUSIONS],
            "n_heads": len(heads),
            "slots": slots[:MOST_CONFUSIONS],
            "n_slots": len(slots),
        }

    def _wrong(self) -> dict[str, Any]:
        count = count_wrong(self.run, self.part)
        return {"count": count, "shown": min(count, MOST_WRONG)}
