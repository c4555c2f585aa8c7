"""Verb: propose a category for each error of a run."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence

from annotations.background.progress import Progress
from annotations.language.forms import read_form, read_or_none
from annotations.rows.synchronise import batches
from parser_service.analysis.category_proposals import Proposals, propose_category
from parser_service.analysis.error_evidence import ErrorEvidence, RunEvidence
from parser_service.analysis.structure import OF_DIFFERENCES
from parser_service.models import Review, TrainingRun
from parser_service.results.selecting import select
from parser_service.reviews.error_evidence import ErrorEvidences, evidence_of_run
from parser_service.reviews.first_answers import FirstAnswer, read_answers, read_earlier_errors
from parser_service.reviews.world_categories import ensure_categories

BATCH = 500


def propose_for_run(run: TrainingRun, attractors: frozenset[str], progress: Progress) -> int:
    """Store a proposed review of each wrong first answer of ``run``, in place of earlier proposals.

    Each batch is a transaction, so that a repetition after a stop makes what is missing, and pages have
    a proposal for each error meanwhile.

    Args:
        attractors: canonical texts of the forms that attract unlike inputs.

    Returns:
        How many proposals there are now.

    Raises:
        What ``progress`` raises to stop it.
    """
    progress.report(0, "reading the errors")
    answers = read_answers(run, progress.check)
    maker = _Maker(run, attractors, answers)
    errors = [at for at, each in enumerate(answers) if not each.is_right]
    done, last = 0, 0
    for some in batches(errors, BATCH):
        progress.report(done / len(errors), "proposing error categories")
        rows = list(maker.make(some))
        with progress.writing():
            # Earlier proposals go as far as these reach.
            earlier = run.reviews.proposed().filter(
                example__gt=last, example__lte=rows[-1].example_id
            )
            earlier.delete()
            Review.objects.bulk_create(rows)
        done, last = done + len(rows), rows[-1].example_id
    with progress.writing():
        run.reviews.proposed().filter(example__gt=last).delete()
    return done


class _Maker:
    """Makes the rows of one run. Errors with the same two forms and the same evidence share their work."""

    def __init__(
        self, run: TrainingRun, attractors: frozenset[str], answers: Sequence[FirstAnswer]
    ) -> None:
        self._run, self._answers = run, answers
        self._categories = ensure_categories(run.world)
        self._of_run: RunEvidence = evidence_of_run(run, attractors)
        self._of_errors = ErrorEvidences(run, answers)
        self._slices: list[tuple[str, str, frozenset[int]]] = []  # code, name, keys of its errors
        for code, category in self._categories.items():
            if category.slice is not None:
                rows = select(run, category.slice.query).filter(is_exact_match=False).order_by()
                keys = frozenset(rows.values_list("example_id", flat=True))
                self._slices.append((code, category.slice.name, keys))
        self._earlier = read_earlier_errors(run)
        self._known: dict[Hashable, Proposals] = {}

    def make(self, errors: Sequence[int]) -> Iterator[Review]:
        """Yield an unsaved proposal for each of the answers with these numbers."""
        for at in errors:
            answered = self._answers[at]
            is_new = None
            if self._earlier is not None:
                is_new = (answered.utterance, answered.label) not in self._earlier
            code, reason = self._choose(answered, self._propose(answered, self._of_errors.of(at)))
            yield Review(
                run=self._run,
                example_id=answered.example,
                category=self._categories.get(code),
                is_proposed=True,
                is_new=is_new,
                answer=answered.answer,
                reason=reason,
            )

    def _propose(self, answered: FirstAnswer, evidence: ErrorEvidence) -> Proposals:
        forms = answered.label, answered.answer
        if evidence.is_of_this_text:
            return self._propose_for(*forms, evidence)
        key = *forms, evidence.named, evidence.spoken_for, evidence.agreeing, evidence.is_familiar
        if key not in self._known:
            self._known[key] = self._propose_for(*forms, evidence)
        return self._known[key]

    def _propose_for(self, label: str, answer: str, evidence: ErrorEvidence) -> Proposals:
        return propose_category(read_form(label), read_or_none(answer), self._of_run, evidence)

    def _choose(self, answered: FirstAnswer, proposals: Proposals) -> tuple[str, str]:
        """Return code and reason of the first proposal whose category the world has, or of the first one.

        A category's slice that has the error counts more than the difference of the forms alone.
        """
        each_in_turn = (proposals.first, *proposals.runners_up)
        known = (each for each in each_in_turn if each.category in self._categories)
        chosen = next(known, proposals.first)
        if chosen.category in OF_DIFFERENCES:
            for code, name, examples in self._slices:
                if answered.example in examples:
                    return code, f"It is in the slice “{name}”. {chosen.reason}"
        return chosen.category, chosen.reason
