"""The report of runs beside each other: what the compare page shows, and the answers in which they differ."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from annotations.generation.split_statistics import figures_of
from annotations.models import Example
from annotations.rows.synchronise import batches
from annotations.showing.form_presentation import Pieces, difference, unmarked
from parser_service.models import Prediction
from parser_service.results.addresses import Addresses
from parser_service.results.breakdown import accuracies_of, break_down, break_down_by_slices
from parser_service.results.compared import Compared
from parser_service.results.comparison_tables import pair_rows, win_matrix
from parser_service.results.run_choice import LETTERS
from parser_service.reviews.charts import Bar, draw_bars
from parser_service.reviews.document import Section, write_document

MOST_CONFUSIONS = 10  # of each run
MOST_DIFFERENT = 1_000  # examples on which the runs differ
ROWS_AT_ONCE = 100


@dataclass(frozen=True, slots=True)
class DifferentAnswers:
    """``answers`` has whether each run is right, and its answer in pieces (none where it has no answer)."""

    example: Example
    label: Pieces
    answers: list[tuple[bool, Pieces]]


def comparison_report(
    compared: Compared, names: Sequence[str], chosen: Sequence[tuple[str, str]] = ()
) -> Iterator[str]:
    """Yield the report of ``compared`` runs, on at least one example, as pieces of one HTML file.

    Args:
        names: what sentences call the runs, in their order.
        chosen: label and value of each filter that chooses the examples.
    """
    report = _ComparisonReport(compared, names, chosen)
    runs = ", ".join(str(run.pk) for run in compared.runs)
    lead = (
        f"Trained on {compared.base.split.name} and compared on the {compared.part} part, "
        f"{compared.count:,} examples."
    )
    about = {
        "world": compared.world,
        "part": compared.part,
        "lead": lead,
        "accuracies": report.accuracies,
    }
    yield from write_document(f"Comparison of runs {runs}", about, report.sections)


class _ComparisonReport:
    def __init__(
        self, compared: Compared, names: Sequence[str], chosen: Sequence[tuple[str, str]]
    ) -> None:
        self.compared, self.names, self.chosen = compared, names, chosen
        self.addresses = Addresses(
            compared.world, compared.runs, compared.part, measure=compared.measure
        )

    @cached_property
    def accuracies(self) -> list[Any]:
        """Letter, run and accuracy of each."""
        cells = accuracies_of(self.compared, self.addresses)
        return list(zip(LETTERS, self.compared.runs, cells, strict=False))

    @cached_property
    def different(self) -> list[int]:
        """Return the keys of the examples on which some run is right and another is wrong."""
        right = self.compared.correct.sum(axis=0)
        differ = (right > 0) & (right < len(self.compared.runs))
        keys: list[int] = self.compared.examples.keys[self.compared.chosen][differ].tolist()
        return keys

    @property
    def sections(self) -> list[Section]:
        return [
            Section("runs", "Runs", "compared_runs", self.runs),
            Section("differences", "Is the difference real?", "differences", self.differences),
            Section("slices", "Slices", "slices", self.slices),
            Section("confusions", "Confusions", "compared_confusions", self.confusions),
            Section(
                "answers",
                "Where the runs differ",
                "different_answers",
                self.answers,
                self.answer_rows,
            ),
        ]

    def runs(self) -> dict[str, Any]:
        split = self.compared.base.split
        return {"split": split, "counts": figures_of(split).counts, "chosen": self.chosen}

    def differences(self) -> dict[str, Any]:
        bars = [
            Bar(
                f"{letter}, run {run.pk}",
                *(each / 100 for each in (cell.percent, cell.low, cell.high)),
            )
            for letter, run, cell in self.accuracies
        ]
        return {
            "compared": self.compared,
            "chart": draw_bars(f"{self.compared.measure.in_words.capitalize()} of each run", bars),
            "matrix": win_matrix(self.compared, self.addresses),
            "pairs": pair_rows(self.compared, self.names),
        }

    def slices(self) -> dict[str, Any]:
        tables = break_down(self.compared, self.addresses)
        saved = break_down_by_slices(self.compared, self.addresses)
        return {
            "tables": [*tables, saved] if saved.rows else tables,
            "names": [letter for letter, _, _ in self.accuracies],
            "count": self.compared.count,
            "measure": self.compared.measure,
        }

    def confusions(self) -> dict[str, Any]:
        confusions = []
        for place, (letter, _, _) in enumerate(self.accuracies):
            errors = self.compared.confusion(place).errors()
            confusions.append((letter, errors[:MOST_CONFUSIONS], len(errors)))
        return {"confusions": confusions}

    def answers(self) -> dict[str, Any]:
        count = len(self.different)
        return {"count": count, "shown": min(count, MOST_DIFFERENT)}

    def answer_rows(self) -> Iterator[DifferentAnswers]:
        is_right = self.compared.measure.column
        for keys in batches(self.different[:MOST_DIFFERENT], ROWS_AT_ONCE):
            examples = Example.objects.in_bulk(keys)
            best = Prediction.objects.best().filter(run__in=self.compared.runs, example__in=keys)
            given = {(each.run_id, each.example_id): each for each in best}
            for key in keys:
                label = examples[key].logical_form
                answers = [given[run.pk, key] for run in self.compared.runs]
                yield DifferentAnswers(
                    examples[key],
                    unmarked(label),
                    [
                        (
                            bool(getattr(answer, is_right)),
                            difference(label, answer.logical_form)[1]
                            if answer.logical_form
                            else [],
                        )
                        for answer in answers
                    ],
                )
