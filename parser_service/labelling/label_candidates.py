"""Puts the forms of all sources into one short list."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain, zip_longest

from annotations.labelling.form_check import canonical_label
from annotations.language.texts import LanguageError, Refusal
from annotations.models import JobKind, Utterance, UtteranceStatus
from parser_service.labelling.known_forms import derived_forms, nearest_forms
from parser_service.parsers.interface import Candidate
from parser_service.parsers.registry import title_of
from parser_service.serving.default_runs import best_run

MOST_CANDIDATES = 9  # one for each of the keys 1 to 9
NOW, GRAMMAR, NEIGHBOUR = "the answer now", "grammar", "nearest utterance"
PERSON = "somebody who tried it"  # the source of a form that a person gave for a wrong answer


@dataclass(frozen=True, slots=True)
class LabelCandidate:
    """A form in canonical corpus text, and which sources give it, the first one first."""

    form: str
    sources: tuple[str, ...]


def candidates_for(utterance: Utterance) -> tuple[LabelCandidate, ...]:
    """Return up to nine forms for ``utterance``, each once, the most likely first.

    The form that it has comes first, then what a person gave for a wrong answer and what the grammar
    derives, which is certain for a generated command; the trained parser and the neighbours take turns
    behind it.
    """
    text, world = utterance.anonymized_text, utterance.world
    rows = [row for row in utterance.proposals.order_by("rank") if is_label(row.form)]
    proposed = [(row.form, title_of(row.source)) for row in rows if row.source != PERSON]
    nearest = nearest_forms(world, text, MOST_CANDIDATES)
    ranked = chain(
        [(utterance.logical_form, NOW)] if utterance.logical_form else [],
        [(row.form, PERSON) for row in rows if row.source == PERSON],
        _from(GRAMMAR, derived_forms(world, text, MOST_CANDIDATES)),
        chain.from_iterable(zip_longest(proposed, _from(NEIGHBOUR, nearest))),
    )
    sources: dict[str, list[str]] = {}
    for form, source in filter(None, ranked):
        if is_label(form):
            sources.setdefault(form, []).append(source)
    first = list(sources.items())[:MOST_CANDIDATES]
    return tuple(LabelCandidate(form, tuple(dict.fromkeys(names))) for form, names in first)


def awaited_parser(utterance: Utterance) -> str:
    """Return the title of the parser whose answer to ``utterance`` a worker is to store; empty where none comes."""
    jobs = utterance.world.jobs.active().filter(kind=JobKind.PROPOSE)
    if utterance.status != UtteranceStatus.UNLABELLED or not jobs.exists():
        return ""
    try:
        run = best_run(utterance.world)
    except Refusal:
        return ""  # there is no parser
    is_answered = utterance.proposals.filter(run=run.pk).exists()
    return "" if is_answered else title_of(run.parser)


def is_label(form: str) -> bool:
    """Return whether ``form`` is one that an utterance can be labelled with; parsers write others too."""
    try:
        return canonical_label(form) == form
    except LanguageError:
        return False


def _from(source: str, candidates: Iterable[Candidate]) -> list[tuple[str, str]]:
    return [(candidate.form, source) for candidate in candidates]
