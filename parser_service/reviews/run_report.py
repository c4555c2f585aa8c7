"""The report of one run on one part of its split."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

from annotations.generation.split_statistics import figures_of
from annotations.language.corpus import KNOWN, Part
from parser_service.models import TrainingRun
from parser_service.parsers.registry import parsers, title_of
from parser_service.results.addresses import Addresses
from parser_service.results.breakdown import break_down, break_down_by_slices
from parser_service.results.compared import Compared, compare_on
from parser_service.results.run_figures import KNOWN_FORMS, order_of, scores_by_form
from parser_service.results.selecting import filters_of
from parser_service.results.slot_confusions import slot_rows
from parser_service.results.table_parts import marked
from parser_service.reviews.charts import Bar, Line, draw_bars, draw_lines
from parser_service.reviews.document import Section, write_document
from parser_service.reviews.run_report_rows import (
    MOST_WRONG,
    attractor_tables,
    count_reviews,
    count_wrong,
    edit_rows,
    examples_by_category,
    refusal_curves,
    wrong_answers,
)
from parser_service.reviews.stored_findings import findings_of

MOST_CONFUSIONS = 15


def run_report(run: TrainingRun, part: str) -> Iterator[str]:
    """Yield the report of ``run``, which has answers on ``part``, as pieces of one HTML file."""
    report = _RunReport(run, part)
    title = f"{marked(title_of(run.parser), run.parser)}, run {run.pk}"
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
    def findings(self) -> dict[str, Any]:
        """What a worker has found out about the answers, as far as it is."""
        return findings_of(self.run, self.part)

    @cached_property
    def compared(self) -> Compared:
        return compare_on(self.run.world, [self.run], self.part, filters_of(self.run.world, ""))

    @property
    def sections(self) -> list[Section]:
        """The sections for which there is something to say."""
        sections = [
            Section("configuration", "Configuration", "configuration", self.configuration),
            Section("accuracy", "Accuracy", "accuracy", self.accuracy),
        ]
        if self.run.epochs.exists():
            sections.append(Section("training", "Training", "training", self.training))
        sections += [
            Section("slices", f"Slices of the {self.part} part", "slices", self.slices),
            Section("confusions", "Confusions", "confusions", self.confusions),
        ]
        if self.run.reviews.exists():
            sections.append(Section("categories", "Kinds of errors", "categories", self.categories))
        of_findings = {
            "attractors": Section(
                "attractors", "Unexpected defaults", "attractors", self.attractors
            ),
            "risk_coverage": Section("refusing", "Refusing to answer", "refusing", self.refusing),
            "sensitivity": Section(
                "sensitivity", "Changes of the utterance", "sensitivity", self.sensitivity
            ),
        }
        sections += [section for name, section in of_findings.items() if name in self.findings]
        sections.append(
            Section("wrong", "Wrong answers", "wrong_answers", self.wrong, self.wrong_rows)
        )
        return sections

    def configuration(self) -> dict[str, Any]:
        entry = parsers().get(self.run.parser)
        return {
            "description": entry.description if entry else "",
            "changed": dict(self.run.changed_hyperparameters()),
            "counts": figures_of(self.run.split).counts,
            "checkpoints": self.run.checkpoints.all(),
        }

    def accuracy(self) -> dict[str, Any]:
        scores = sorted(self.run.evaluations.all(), key=order_of)
        by_form = scores_by_form(self.run)
        unseen = ", unseen forms" if by_form else ""
        bars = [
            Bar(
                f"{shown.score.part}, {shown.score.test_source}, harmonic mean",
                *(shown.accuracy, *shown.interval),
            )
            for shown in by_form
            if not shown.alone
        ]
        bars += [
            Bar(
                f"{score.part}{' forms' if score.part == KNOWN else unseen}, {score.test_source}",
                score.accuracy,
                score.interval_low,
                score.interval_high,
            )
            for score in scores
        ]
        return {
            "scores": scores,
            "by_form": by_form,
            "known_forms": KNOWN_FORMS,
            "chart": draw_bars("Exact match by part and source", bars),
        }

    def training(self) -> dict[str, Any]:
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

    def slices(self) -> dict[str, Any]:
        addresses = Addresses(self.run.world, (self.run,), self.part)
        tables = break_down(self.compared, addresses)
        saved = break_down_by_slices(self.compared, addresses)
        return {
            "tables": [*tables, saved] if saved.rows else tables,
            "names": ["Exact match"],
            "count": self.compared.count,
            "measure": self.compared.measure,
        }

    def confusions(self) -> dict[str, Any]:
        heads = self.compared.confusion(0).errors() if self.compared.count else []
        slots = slot_rows(self.run.world, self.run, self.part)
        return {
            "heads": heads[:MOST_CONFUSIONS],
            "n_heads": len(heads),
            "slots": None if slots is None else slots[:MOST_CONFUSIONS],
            "n_slots": len(slots or ()),
        }

    def categories(self) -> dict[str, Any]:
        counts = count_reviews(self.run, self.part)
        categories = [each.category for each in counts]
        return {
            "counts": counts,
            "examples": examples_by_category(self.run, self.part, categories),
        }

    def attractors(self) -> dict[str, Any]:
        return {"tables": attractor_tables(self.findings["attractors"])}

    def refusing(self) -> dict[str, Any]:
        curves = self.findings["risk_coverage"]
        return {"curves": curves, "chart": refusal_curves(curves)}

    def sensitivity(self) -> dict[str, Any]:
        return {
            "rows": edit_rows(self.findings["sensitivity"]),
            "words": self.findings.get("deciding_words"),
            "pairs": self.findings.get("pairs"),
        }

    def wrong(self) -> dict[str, Any]:
        count = count_wrong(self.run, self.part)
        return {"count": count, "shown": min(count, MOST_WRONG)}

    def wrong_rows(self) -> Iterator[Any]:
        return wrong_answers(self.run, self.part)
