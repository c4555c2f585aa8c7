"""What a reviewer sees of one example: its label, and what each run makes of it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from annotations.models import Command, Example, Paraphrase, User
from annotations.rows.occurrences import command_of_example, paraphrase_of_example
from parser_service.models import Prediction, Review, TrainingRun
from parser_service.parsers.registry import parsers
from parser_service.reviews.earlier import tags_of_example_before


@dataclass(frozen=True, slots=True)
class CaseAnswer:
    """What one run makes of the example, and what was said about it.

    ``candidates`` are its beam, best first; empty where the run was not asked. ``tags`` are the reviews of
    people that have a category, ``notes`` those with a note, ``own`` that of the reader, ``earlier`` what
    people said of earlier runs.
    """

    run: TrainingRun
    candidates: tuple[Prediction, ...]
    proposal: Review | None
    reviews: tuple[Review, ...]
    own: Review | None
    earlier: tuple[Review, ...]

    @property
    def title(self) -> str:
        entry = parsers().get(self.run.parser)
        return entry.title if entry else self.run.parser

    @property
    def first(self) -> Prediction | None:
        return self.candidates[0] if self.candidates else None

    @property
    def is_wrong(self) -> bool:
        return self.first is not None and not self.first.is_exact_match

    @property
    def tags(self) -> list[Review]:
        return [each for each in self.reviews if each.category_id]

    @property
    def notes(self) -> list[Review]:
        return [each for each in self.reviews if each.note]


@dataclass(frozen=True, slots=True)
class ReviewCase:
    """An example with the answers of the runs that are compared, in their order, and what is behind it."""

    example: Example
    answers: tuple[CaseAnswer, ...]
    command: Command | None
    paraphrase: Paraphrase | None

    @property
    def label_in_training(self) -> int | None:
        """How often training had the label, where a run knows it."""
        firsts = (each.first.label_in_training for each in self.answers if each.first)
        return next((count for count in firsts if count is not None), None)

    @property
    def first_to_read(self) -> int:
        """The key of the first run that is wrong, or of the first run."""
        wrong = (each.run.pk for each in self.answers if each.is_wrong)
        return next(wrong, self.answers[0].run.pk)

    @property
    def offered(self) -> dict[str, str]:
        """The forms that runs answer instead of the label, and who does: what the label might be."""
        titles: dict[str, list[str]] = defaultdict(list)
        for answer in self.answers:
            if answer.first is not None and answer.is_wrong and answer.first.is_well_formed:
                titles[answer.first.logical_form].append(f"{answer.title}, run {answer.run.pk}")
        return {form: " and ".join(names) for form, names in titles.items()}


def read_case(runs: Sequence[TrainingRun], example: Example, reader: User) -> ReviewCase:
    """Return what ``runs``, of one split, make of ``example``, and what people said about it."""
    candidates: dict[int, list[Prediction]] = defaultdict(list)
    asked = Prediction.objects.filter(run__in=runs, example=example).order_by("rank")
    for each in asked:
        candidates[each.run_id].append(each)
    reviews: dict[int, list[Review]] = defaultdict(list)
    rows = Review.objects.filter(run__in=runs, example=example)
    for review in rows.select_related("category", "reviewer"):
        reviews[review.run_id].append(review)
    answers = []
    for run in runs:
        beam, of_run = tuple(candidates[run.pk]), reviews[run.pk]
        people = tuple(each for each in of_run if not each.is_proposed)
        is_wrong = bool(beam) and not beam[0].is_exact_match
        answers.append(
            CaseAnswer(
                run=run,
                candidates=beam,
                proposal=next((each for each in of_run if each.is_proposed), None),
                reviews=people,
                own=next((each for each in people if each.reviewer_id == reader.pk), None),
                earlier=tuple(tags_of_example_before(run, example)) if is_wrong else (),
            )
        )
    return ReviewCase(
        example, tuple(answers), command_of_example(example), paraphrase_of_example(example)
    )
