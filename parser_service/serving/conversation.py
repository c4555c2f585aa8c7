"""Start a dialogue about an utterance, take answers, and keep what the person agreed to as a label."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from http import HTTPStatus
from typing import Any

from django.db import transaction

from annotations.labelling import item_answers
from annotations.labelling.collecting import collect
from annotations.language.forms import UNKNOWN, canonical_text, read_form
from annotations.language.plans import DialogueManager, DialogueState, Phase, Reaction, reaction_of
from annotations.language.texts import LanguageError, Refusal, normalise_line
from annotations.models import Origin, User, Utterance, UtteranceStatus, Verdict, World
from annotations.models.corpus import MOST_CHARACTERS
from parser_service.models import Dialogue
from parser_service.serving.entity_offers import offer
from parser_service.serving.parser_client import client
from parser_service.serving.preparing import WorldLanguage, require_utterance

MOST_TURNS = 60  # of a transcript; a dialogue ends long before
Parsed = Mapping[str, Any]
Ask = Callable[[str, str], Parsed]


class AnsweredMeanwhile(Refusal):
    """Another answer to the same question came first."""

    code = "dialogue_answered_meanwhile"
    status = HTTPStatus.CONFLICT

    def __init__(self) -> None:
        super().__init__("Somebody has answered this meanwhile. Look at it again.")


def ask_parser(world: str, utterance: str) -> Parsed:
    """Return what the promoted parser of a world answers. Raises ParserAway or ParserRefused.

    It is asked for several candidates: the first is the one that fits the entities of the utterance best, of those
    that are about equally good.
    """
    return client().parse(world, utterance)


def start(world: World, utterance: str, by: User, ask: Ask = ask_parser) -> Dialogue:
    """Start a dialogue about ``utterance``.

    Raises Refusal for what is no utterance, and what ``ask`` raises.
    """
    text = normalise_line(require_utterance(utterance))
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
    said = normalise_line(answer.replace("\0", " "))[:MOST_CHARACTERS]
    before = DialogueState.from_json(row.state)
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
            raise AnsweredMeanwhile
        for each in after.offers[len(before.offers) :]:
            offer(row.world, each, utterance)
    row.refresh_from_db()
    return row


def keep(row: Dialogue, by: User) -> Utterance:
    """Store the utterance of a dialogue with the form that the person agreed to, as a label of ``by``.

    An utterance that the world has already keeps the label that it has. Raises Refusal
    for a dialogue without an agreed form, and what ``annotations.labelling.label`` raises.
    """
    state = state_of(row)
    if state.phase is not Phase.DONE:
        raise Refusal(
            "Nobody has agreed to a form in this dialogue, so there is none to keep.",
            "no_agreed_form",
            HTTPStatus.CONFLICT,
        )
    with transaction.atomic():
        collected = collect(row.world, [row.utterance], Origin.DIALOGUE, by)
        if collected.problems:
            raise Refusal(str(collected.problems[0]), "text_refused", HTTPStatus.CONFLICT)
        utterance = Utterance.objects.get(world=row.world, text=row.utterance)
        if utterance.status == UtteranceStatus.UNLABELLED:
            item_answers.answer(
                utterance, Verdict.FORM, canonical_text(state.parsed), by, utterance.version
            )
        row.kept_as = utterance
        row.save(update_fields=["kept_as"])
    utterance.refresh_from_db()
    return utterance


def state_of(row: Dialogue) -> DialogueState:
    """Return the state of a dialogue as a value."""
    return DialogueState.from_json(row.state)


def _machine_of(world: World) -> DialogueManager:
    language = WorldLanguage.of(world)
    return DialogueManager(language.ontology, language.predicates, language.evidence)


def _begin(
    machine: DialogueManager, parsed: Parsed, text: str, before: DialogueState | None = None
) -> DialogueState:
    """Return the first state for what a parser answered; it is checked where the parser abstains."""
    heard = machine.anonymizer.anonymize(text)
    candidates = parsed.get("candidates") or [{}]
    is_sure = not parsed.get("is_unknown", False)
    try:
        form = read_form(candidates[0].get("form", ""))
    except LanguageError:
        form = UNKNOWN
    return machine.begin(form, heard, is_sure, before, candidates[0].get("values", ()))


def _turn(who: str, text: str) -> dict[str, str]:
    return {"who": who, "text": text}
