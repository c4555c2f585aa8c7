"""Template filters: where the form of an answer is from and what its score means, in plain words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from django import template

from parser_service.models import Prediction, TrainingRun
from parser_service.parsers.interface import TRAINING, ScoreKind
from parser_service.parsers.registry import parsers

register = template.Library()

# How a form that is not a training pair's came about.
ORIGINS = {
    "validation": "taken from a validation pair",
    "grammar": "taken from the annotated grammar",
    "geca": "made by recombining training pairs",
    "exchange": "made by exchanging a description",
    "drop": "made by leaving out a description",
    "add": "made by adding a description",
    "transplant": "made with a description of another form",
    "retype": "made by changing the kind of an argument",
    "substitution": "made by substitution of a declared description",
    "unseen": "made with a predicate that training lacks",
    "written": "written by the language model",
    "composed": "put together from actions of training",
    "refusal": "given because no form was probable enough",
}
PARTS = {
    "similarity": "Share of common words",
    "neighbours": "Neighbours with this form",
    "alone": "Probability beside no other form",
    "log_probability": "Log-probability of its tokens",
    "tokens": "Tokens written",
    "cut": "Tokens of the utterance not read",
    "examples": "Fits the nearest example",
    "glosses": "Fits its English sentence",
    "slots": "Slots and entities that do not match",
    "support": "Ways in which it can be made",
    "novelty": "Is a known form, or a new one",
    "others": "How well other forms fit",
}
SCORE_KINDS = {
    ScoreKind.PROBABILITY: "probability",
    ScoreKind.LOG_PROBABILITY: "log-probability",
    ScoreKind.SIMILARITY: "similarity",
}


@dataclass(frozen=True, slots=True)
class ScorePart:
    """One part of the scores of several answers; None for an answer without it."""

    name: str
    values: tuple[float | None, ...]
    is_count: bool


@register.filter
def seen_in_training(count: int | None) -> str:
    """Say how often training had a form; nothing where that is not known."""
    if count is None:
        return ""
    if count == 0:
        return "not seen in training"
    return "seen once in training" if count == 1 else f"seen {count:,} times in training"


@register.filter
def origin_in_words(prediction: Prediction) -> str:
    """Say where the form of an answer is from; nothing for one of a training pair or of unknown origin."""
    if prediction.origin in ("", TRAINING):
        return ""
    return ORIGINS.get(prediction.origin, f"made by {prediction.origin}")


@register.filter
def score_kind_in_words(run: TrainingRun) -> str:
    """Say what the scores of a run are: ``log-probability``; ``only an order`` where they mean no more."""
    kind = run.score_kind
    return SCORE_KINDS[ScoreKind(kind)] if kind else "only an order"


@register.filter
def cut_in_words(parser: str) -> str:
    """Say how much of the utterance the parser read, for an answer to its beginning alone."""
    most = parsers()[parser].most_subwords if parser in parsers() else 0
    read = f"It was read to the {most}th subword" if most else "Its beginning was read"
    return f"This utterance is longer than the parser reads. {read}; the rest had no part in the answer."


@register.filter
def parts_of_scores(predictions: Sequence[Prediction]) -> list[ScorePart]:
    """Return the parts of the scores of ``predictions``, in the order of the parser."""
    names = dict.fromkeys(name for each in predictions for name in each.score_parts)
    ordered = [name for name in PARTS if name in names]
    ordered += [name for name in names if name not in PARTS]
    parts = []
    for name in ordered:
        values = tuple(each.score_parts.get(name) for each in predictions)
        title = PARTS.get(name, name.replace("_", " ").capitalize())
        is_count = all(isinstance(value, int) for value in values if value is not None)
        parts.append(ScorePart(title, values, is_count))
    return parts
