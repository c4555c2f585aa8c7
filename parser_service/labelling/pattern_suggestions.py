"""Forms for the pattern of a template: from other templates, and from what parsers answer to its command."""

from __future__ import annotations

from dataclasses import dataclass

from annotations.generation.suggesting import (
    ParserAnswer,
    SuggestedForm,
    add_answers,
    command_for,
    say_with_entities,
    suggest_forms,
)
from annotations.labelling.proposal_requests import last_request, request_answer
from annotations.language.texts import Refusal
from annotations.models import TaskCategory, User, World
from parser_service.labelling.known_forms import nearest_forms
from parser_service.labelling.label_candidates import NEIGHBOUR
from parser_service.parsers.registry import title_of
from parser_service.serving.default_runs import best_run

MOST_NEIGHBOURS = 3


@dataclass(frozen=True, slots=True)
class PatternSuggestions:
    """Forms for a pattern, the most likely first, and the command that parsers are asked about.

    The forms are said with the entities of ``example``, a command of the pattern; with classes where that is empty.
    ``waits_for`` is the title of the parser that a worker asks; ``reason`` says why it gives no form.
    """

    forms: tuple[SuggestedForm, ...] = ()
    command: str = ""
    example: str = ""
    waits_for: str = ""
    reason: str = ""


@dataclass(frozen=True, slots=True)
class _Answer:
    """What one parser answers, ranked; or that a worker asks it, or why there is no answer."""

    answers: tuple[ParserAnswer, ...] = ()
    waits_for: str = ""
    reason: str = ""


def suggest_with_parsers(
    world: World, category: TaskCategory | None, pattern: str, wanted: str, by: User | None
) -> PatternSuggestions:
    """Suggest forms for ``pattern``, among them those of the best parser and of the nearest utterance.

    Args:
        wanted: the command that the pattern was written for, where it makes that.
        by: who asks a worker for the answer of the best parser if it is not there; None asks nobody.
    """
    forms = suggest_forms(world, category, pattern)
    command = command_for(category, pattern, wanted) if category else ""
    if category is None or not command:
        return PatternSuggestions(tuple(forms))
    best = _answer_of_best(world, command, by)
    nearest = tuple(
        ParserAnswer(NEIGHBOUR, each.score, each.form)
        for each in nearest_forms(world, command, MOST_NEIGHBOURS)
    )
    both = add_answers(world, category, pattern, forms, [best.answers, nearest])
    example, both = say_with_entities(world, category, pattern, command, both)
    is_used = any(each in best.answers for form in both for each in form.answers)
    does_not_fit = bool(best.answers) and not is_used
    reason = f"{best.answers[0].parser} gives no form that fits." if does_not_fit else best.reason
    return PatternSuggestions(tuple(both), command, example, best.waits_for, reason)


def _answer_of_best(world: World, command: str, by: User | None) -> _Answer:
    """Return what the best parser of the world answers to the command, as far as it is known."""
    try:
        run = best_run(world)
    except Refusal:
        return _Answer()  # there is no parser
    title = title_of(run.parser)
    rows = world.command_proposals.filter(command=command, run=run.pk).order_by("rank")
    if rows:
        return _Answer(tuple(ParserAnswer(title, row.score, row.form) for row in rows))
    job = last_request(world, command, run.pk)
    if job is None:
        if by is None:
            return _Answer()
        job = request_answer(world, command, run.pk, by)
    if not job.is_ended:
        return _Answer(waits_for=title)
    return _Answer(reason=job.failure or f"{title} answers no well-formed form.")
