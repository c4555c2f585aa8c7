"""A dialogue as plain data: what REST answers, and what the page beside the chat shows."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from annotations.language.forms import to_corpus, to_reading
from annotations.language.grounding import choices_of
from annotations.language.plans import DialogueState, Plan, TaskPlan, make_plan, spoken
from annotations.language.world import gloss
from parser_service.models import Dialogue
from parser_service.serving.conversation import state_of
from parser_service.serving.parse_answers import task_plan_of
from parser_service.serving.preparing import WorldLanguage

MOST_CHOICES = 20


def plan_of(row: Dialogue, language: WorldLanguage) -> Plan:
    """Return the plan of a dialogue as far as it has come."""
    state = state_of(row)
    return make_plan(
        state.form,
        language.ontology,
        language.predicates,
        language.action_names,
        state.slots,
        utterance=row.utterance,
    )


def task_plan_in(row: Dialogue, language: WorldLanguage) -> TaskPlan:
    """Return the same in the primitives of the robot."""
    state = state_of(row)
    return task_plan_of(state.form, language, state.slots, row.utterance)


def as_json(row: Dialogue) -> dict[str, Any]:
    """Return a dialogue with what it asks, its form so far and its plan."""
    state, language = state_of(row), WorldLanguage.of(row.world)
    task_plan = task_plan_in(row, language)
    return {
        "id": row.pk,
        "utterance": row.utterance,
        "phase": row.phase,
        "is_over": row.is_over,
        "prompt": state.prompt,
        "asked": asked_of(state),
        "form": to_corpus(state.parsed),
        "grounded": to_corpus(state.form),
        "reading": to_reading(state.form),
        "english": gloss(
            state.form,
            language.predicates,
            language.ontology.classes,
            language.ontology.class_of_text,
        ),
        "plan": plan_of(row, language).as_json(),
        "task_plan": task_plan.as_json(),
        "spoken": spoken(task_plan),
        "offers": [asdict(offer) for offer in state.offers],
        "transcript": row.transcript,
        "run": row.run_id,
        "kept_as": row.kept_as_id,
        "started_at": row.started_at,
        "version": row.version,
    }


def asked_of(state: DialogueState) -> dict[str, Any] | None:
    """Return what the dialogue asks for: the class and the choices; None where it asks for no slot."""
    slot = state.asked
    if slot is None:
        return None
    return {
        "entity_class": slot.entity_class,
        "choices": list(choices_of(slot))[:MOST_CHOICES],
        "likely": slot.likely,
        "phrases": list(slot.phrases),
    }
