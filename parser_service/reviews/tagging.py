"""Verbs: say why an answer is wrong, add a note, take either back."""

from __future__ import annotations

from annotations.language.texts import Refusal
from annotations.models import Example, User
from parser_service.models import ErrorCategory, Prediction, Review, TrainingRun

LONGEST_NOTE = 2_000


def tag(run: TrainingRun, example: Example, category: ErrorCategory, by: User) -> Review:
    """Store that the first answer of ``run`` to ``example`` is an error of ``category``.

    A reviewer has one review of each answer: another category replaces the one before, the note stays.

    Raises Refusal where there is no answer, it is right, or the category is another world's.
    """
    if category.world_id != run.world_id:
        raise Refusal("This error category belongs to another world.", "category_of_another_world")
    if _answer_of(run, example).is_exact_match:
        raise Refusal("This answer is right, so there is no error to tag.", "answer_is_right")
    return _change(run, example, by, category=category)


def accept(run: TrainingRun, example: Example, by: User) -> Review:
    """Tag the answer with the category that the machine proposes.

    Raises Refusal where it proposes none, and as ``tag`` does.
    """
    proposal = run.reviews.proposed().filter(example=example).select_related("category").first()
    if proposal is None or proposal.category is None:
        raise Refusal("There is no proposal to accept. Choose a category.", "no_proposal")
    return tag(run, example, proposal.category, by)


def write_note(run: TrainingRun, example: Example, note: str, by: User) -> Review | None:
    """Store a note on an answer, right or wrong; an empty one is removed. Return the review that is left.

    Raises Refusal where there is no answer, or the note is too long.
    """
    text = note.replace("\0", "").strip()
    if len(text) > LONGEST_NOTE:
        raise Refusal(
            f"The note has {len(text):,} characters; {LONGEST_NOTE:,} is the limit. Shorten it.",
            "note_too_long",
        )
    _answer_of(run, example)
    return _settle(_change(run, example, by, note=text))


def take_back_review(run: TrainingRun, example: Example, by: User) -> Review | None:
    """Remove the tag that ``by`` gave; a note of theirs stays. Return the review that is left.

    Raises Refusal where they have tagged nothing here.
    """
    own = Review.objects.by_people().filter(run=run, example=example, reviewer=by)
    if not own.filter(category__isnull=False).exists():
        raise Refusal(
            "You have not tagged this answer, so there is nothing to take back.", "not_tagged"
        )
    return _settle(_change(run, example, by, category=None))


def _answer_of(run: TrainingRun, example: Example) -> Prediction:
    answer = run.predictions.best().filter(example=example).first()
    if answer is None:
        raise Refusal(f"Run {run.pk} has no answer to this example.", "no_answer")
    return answer


def _change(run: TrainingRun, example: Example, by: User, **values: object) -> Review:
    """Store ``values`` in the review of ``by``, with the answer that they are about."""
    answer = _answer_of(run, example).logical_form
    return Review.objects.update_or_create(
        run=run,
        example=example,
        reviewer=by,
        is_proposed=False,
        defaults={**values, "answer": answer},
    )[0]


def _settle(review: Review) -> Review | None:
    """Remove a review that says nothing any more."""
    if review.category_id or review.note:
        return review
    review.delete()
    return None
