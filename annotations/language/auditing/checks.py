"""The checks of an audit: against the command, against a parser, against the words."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from annotations.language.auditing.findings import WEAK, Finding, LabelledPair, Reason
from annotations.language.auditing.words import contradictions
from annotations.language.errors import LanguageError
from annotations.language.forms import (
    Form,
    Unknown,
    canonical_text,
    equivalent,
    flatten_conjunctions,
    read_form,
)


@dataclass(frozen=True, slots=True)
class Answer:
    """A canonical form and its score, which can be compared with those of the same parser."""

    form: str
    score: float


def check_commands(pairs: Iterable[LabelledPair]) -> Iterator[Finding]:
    """Yield the pairs whose label is not the form of the command behind them.

    It is weak evidence where both mean the same, or where that form is UNKNOWN.
    """
    for pair in pairs:
        if pair.command_form and pair.command_form != pair.form:
            what, score = _say_difference(pair)
            sentence = f"The command behind it, “{pair.source_command}”, {what}."
            yield Finding(pair, Reason.COMMAND, sentence, pair.command_form, score)


def check_answers(
    pairs: Iterable[LabelledPair], answers: Mapping[str, Sequence[Answer]], parser: str
) -> list[Finding]:
    """Return the pairs for which the parser called ``parser`` prefers another form to the label.

    Args:
        answers: the candidates of the parser for a pair, best first, by the key of the pair. The
            parser must not have seen the pair. A pair without candidates is passed over, and so is one
            whose best candidate means the same as the label.

    The score is the share of these findings whose best form is ahead of the label by no more than
    this one's; a label that is not among the candidates is behind by the whole range of the scores.
    """
    leads = [
        (pair, tops[0], _lead(pair, tops)) for pair in pairs if (tops := answers.get(pair.key))
    ]
    ahead = [
        (pair, top, lead)
        for pair, top, lead in leads
        if lead > 0 and not _mean_the_same(pair.form, top.form)
    ]
    ordered = sorted(lead for _, _, lead in ahead)
    sentence = f"{parser}, which did not see it, answers with another form."
    return [
        Finding(pair, Reason.PARSER, sentence, top.form, bisect_right(ordered, lead) / len(ordered))
        for pair, top, lead in ahead
    ]


def check_words(pairs: Iterable[LabelledPair]) -> Iterator[Finding]:
    """Yield the pairs with a word, or a word of the command behind them, that contradicts the label.

    A label that cannot be read is passed over.
    """
    for pair in pairs:
        form = _read(pair.form)
        if form is None:
            continue
        for where, text in (("It", pair.utterance), ("The command behind it", pair.source_command)):
            for each in contradictions(text, form):
                sentence = f"{where} says “{each.word}”, the form says “{each.predicate}”."
                suggested = canonical_text(each.corrected(form))
                yield Finding(pair, Reason.WORD, sentence, suggested, each.strength)


def _say_difference(pair: LabelledPair) -> tuple[str, float]:
    if isinstance(_read(pair.command_form), Unknown):
        return "has no form (UNKNOWN)", WEAK
    if _mean_the_same(pair.form, pair.command_form):
        return "writes the same meaning in another way", WEAK
    return "has another form", 1.0


@lru_cache(maxsize=4096)
def _mean_the_same(first: str, second: str) -> bool:
    """Return whether two texts are one form but for the order and the notation of conjunctions."""
    one, other = _read(first), _read(second)
    return (
        one is not None
        and other is not None
        and equivalent(flatten_conjunctions(one), flatten_conjunctions(other))
    )


def _lead(pair: LabelledPair, answers: Sequence[Answer]) -> float:
    """Return by how much the best answer is ahead of the label; 0 where the label is as good."""
    of_label = [answer.score for answer in answers if answer.form == pair.form]
    lowest = min(answers[-1].score, 0.0)
    return answers[0].score - max(of_label, default=lowest)


@lru_cache(maxsize=4096)
def _read(text: str) -> Form | None:
    try:
        return read_form(text)
    except LanguageError:
        return None
