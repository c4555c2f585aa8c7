"""Start a dialogue about an utterance, and take answers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from django.db import transaction

from annotations.language.dialogue import Dialogue as Machine
from annotations.language.dialogue import Phase, Reaction, State, reaction_of
from annotations.language.errors import LanguageError
from annotations.language.forms import UNKNOWN, Form, read_form
from annotations.models import User, World
from annotations.models.corpus import MOST_CHARACTERS
from parser_service.conversing.offering import offer
from parser_service.models import Dialogue
from parser_service.serving.client import client
from parser_service.serving.preparing import WorldLanguage, require_utterance

MOST_TURNS = 60  # of a transcript; a dialogue ends long before
Parsed = Mapping[str, Any]
Ask = Callable[[str, str], Parsed]


class AnsweredMeanwhile(Exception):
    """Another answer to the same question came first; a sentence says so."""


def ask_parser(world: str, utterance: str) -> Parsed:
    """Return what the promoted parser of a world answers. Raises ParserAway or ParserRefused."""
    return client().parse(world, utterance, beam=1)


def start(world: World, utterance: str, by: User, ask: Ask = ask_parser) -> Dialogue:
    """Start a dialogue about ``utterance``.

    Raises ValueError, a sentence, for what is no utterance, and what ``ask`` raises.
    """
    text = " ".join(require_utterance(utterance).split())
    parsed = ask(world.name, text)
    state = _begin(_machine_of(world), parsed, text)
    transcript = [_turn("person", text), _turn("robot", state.prompt)]
    return Dialogue.objects.create(
        world=world,
        utterance=text,
        state=state.as_json(),
        phase=str(state.phase),
        transcript=transcript,
        run_id=parsed.get("run"),
        started_by=by,
    )


def reply(row: Dialogue, answer: str, ask: Ask = ask_parser) -> Dialogue:
    """Take an answer and return the dialogue after it; one that is over stays as it is.

    An answer to a request to say it another way is parsed. What was named and is not in the ontology is
    offered for it. Raises as ``start`` does, and AnsweredMeanwhile where another answer came first.
    """
    if row.is_over:
        return row
    said = " ".join(answer.replace("\0", " ").split())[:MOST_CHARACTERS]
    before = State.from_json(row.state)
    machine = _machine_of(row.world)
    utterance, run = row.utterance, row.run_id
    is_utterance = said and reaction_of(said) is not Reaction.STOP
    if before.phase is Phase.REPHRASING and is_utterance:
        parsed = ask(row.world.name, said)
        after = _begin(machine, parsed, said, before)
        utterance, run = said, parsed.get("run")
    else:
        after = machine.reply(before, said)
    turns = [*row.transcript, _turn("person", said), _turn("robot", after.prompt)]
    values = {
        "utterance": utterance,
        "run_id": run,
        "state": after.as_json(),
        "phase": str(after.phase),
        "transcript": turns[-MOST_TURNS:],
        "version": row.version + 1,
    }
    with transaction.atomic():
        if not Dialogue.objects.filter(pk=row.pk, version=row.version).update(**values):
            raise AnsweredMeanwhile("Somebody has answered this meanwhile. Look at it again.")
        for each in after.offers[len(before.offers) :]:
            offer(row.world, each, utterance)
    row.refresh_from_db()
    return row


def state_of(row: Dialogue) -> State:
    """Return the state of a dialogue as a value."""
    return State.from_json(row.state)


def _machine_of(world: World) -> Machine:
    language = WorldLanguage.of(world)
    return Machine(language.ontology, language.predicates, language.evidence)


def _begin(machine: Machine, parsed: Parsed, text: str, before: State | None = None) -> State:
    """Return the first state for what a parser answered; it is checked where the parser abstains."""
    heard = machine.anonymizer.anonymize(text)
    candidates = parsed.get("candidates") or [{}]
    is_sure = not parsed.get("is_unknown", False)
    return machine.begin(_form_of(candidates[0].get("form", "")), heard, is_sure, before)


def _form_of(text: str) -> Form:
    try:
        return read_form(text)
    except LanguageError:
        return UNKNOWN


def _turn(who: str, text: str) -> dict[str, str]:
    return {"who": who, "text": text}
