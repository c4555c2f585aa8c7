"""Ask for the open slots of a form: a pure state machine of frozen states.

ASKING → CONFIRMING → DONE, and CANCELLED from anywhere. A reply gives a new state and changes
nothing; a state holds only texts, numbers and frozen values, and can be converted to JSON and back.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any

from annotations.language.forms import Form, Unknown, read_form, to_corpus
from annotations.language.grounding.anonymizer import Anonymized, Anonymizer
from annotations.language.grounding.deanonymizer import Slot, deanonymize, fill_all
from annotations.language.grounding.questions import noun_for, question_for
from annotations.language.ontology import Ontology
from annotations.language.predicates import Predicate, gloss

PATIENCE = 3  # answers that do not fit before the dialogue gives up
_YES = frozenset(
    ["yes", "y", "yeah", "yep", "ok", "okay", "sure", "correct", "right", "please", "confirm"]
)
_NO = frozenset(["no", "n", "nope", "wrong", "incorrect"])
_STOP = frozenset(("stop", "cancel", "never mind", "nevermind", "quit", "abort"))


class Phase(StrEnum):
    """ASKING for ``State.asked``, CONFIRMING the whole form, or finished: DONE or CANCELLED."""

    ASKING = "asking"
    CONFIRMING = "confirming"
    DONE = "done"
    CANCELLED = "cancelled"


@dataclass(frozen=True, slots=True)
class State:
    """The state of a dialogue. ``prompt`` is what to say next; ``misses`` counts answers that do not fit."""

    phase: Phase
    form: Form
    slots: tuple[Slot, ...]
    prompt: str = ""
    misses: int = 0

    @property
    def asked(self) -> Slot | None:
        """The slot that the dialogue asks for; None unless ASKING."""
        still_open = (slot for slot in self.slots if slot.value is None)
        return next(still_open, None) if self.phase is Phase.ASKING else None

    @property
    def is_over(self) -> bool:
        return self.phase in (Phase.DONE, Phase.CANCELLED)

    def as_json(self) -> dict[str, Any]:
        """Return a value of plain types that ``from_json`` can read."""
        slots = [
            {name: getattr(slot, name) for name in Slot.__dataclass_fields__} for slot in self.slots
        ]
        return {
            "phase": str(self.phase),
            "form": to_corpus(self.form),
            "slots": slots,
            "prompt": self.prompt,
            "misses": self.misses,
        }

    @classmethod
    def from_json(cls, value: Mapping[str, Any]) -> State:
        """Return the state that ``value`` was made from."""
        slots = tuple(
            Slot(
                **{
                    **slot,
                    **{name: tuple(slot[name]) for name in ("path", "candidates", "phrases")},
                }
            )
            for slot in value["slots"]
        )
        phase, form = Phase(value["phase"]), read_form(value["form"])
        return cls(phase, form, slots, value["prompt"], value["misses"])


@dataclass(frozen=True)
class Dialogue:
    """What a dialogue knows: the entities, and how to say predicates."""

    ontology: Ontology
    predicates: Mapping[str, Predicate]
    anonymizer: Anonymizer = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "anonymizer", Anonymizer(self.ontology))

    def begin(self, form: Form, heard: Anonymized) -> State:
        """Return the first state for a form and the utterance that it was parsed from."""
        if isinstance(form, Unknown):
            sorry = "I do not understand that. Please say it another way."
            return State(Phase.CANCELLED, form, (), sorry)
        deanonymized = deanonymize(form, heard, self.ontology)
        return self._asking(State(Phase.ASKING, deanonymized.form, deanonymized.slots))

    def reply(self, state: State, answer: str) -> State:
        """Return the state after an answer; a dialogue that is over stays as it is."""
        said = " ".join(answer.casefold().strip(" .!?\t\n").split())
        if state.is_over:
            return state
        if said in _STOP:
            return replace(state, phase=Phase.CANCELLED, prompt="I will not do it.")
        if state.phase is Phase.CONFIRMING:
            return self._confirm(state, said)
        return self._answer(state, answer)

    def _answer(self, state: State, answer: str) -> State:
        slot = state.asked
        value = self._value(slot, answer) if slot else None
        if slot is None or value is None:
            return self._miss(
                state, f"I do not know any {noun_for(slot)} called “{answer.strip()}”. "
            )
        return self._asking(_fill(state, slot, value))

    def _confirm(self, state: State, said: str) -> State:
        first = said.partition(" ")[0].strip(",")
        if first in _YES:
            return replace(state, phase=Phase.DONE, prompt="I will do it.")
        if first in _NO:
            again = "Then please say it another way."
            return replace(state, phase=Phase.CANCELLED, prompt=again)
        return self._miss(state, "Please say yes or no. ")

    def _miss(self, state: State, sorry: str) -> State:
        missed = replace(state, misses=state.misses + 1)
        if missed.misses >= PATIENCE:
            return replace(missed, phase=Phase.CANCELLED, prompt="I give up. Please start again.")
        return replace(missed, prompt=sorry + self._prompt(missed))

    def _asking(self, state: State) -> State:
        """Ask for the next open slot, or for confirmation if none is left."""
        is_full = all(slot.value is not None for slot in state.slots)
        phase = Phase.CONFIRMING if is_full else Phase.ASKING
        asking = replace(state, phase=phase, misses=0)
        return replace(asking, prompt=self._prompt(asking))

    def _prompt(self, state: State) -> str:
        slot = state.asked
        if slot is not None:
            return question_for(slot, state.form, self.predicates)
        words = re.sub(r"\bme\b", "you", gloss(state.form, self.predicates))
        return f"Shall I {words}?"

    def _value(self, slot: Slot, answer: str) -> str | None:
        """Return what an answer names: an entity of the slot's class, or any text for an UNKNOWN."""
        spans = self.anonymizer.anonymize(answer).spans
        fitting = [span.value for span in spans if slot.entity_class in ("", span.entity_class)]
        if fitting:
            return fitting[0] if len(set(fitting)) == 1 else None
        text = " ".join(answer.split())
        is_known = bool(self.ontology.of_class(slot.entity_class))
        return text if text and not is_known else None


def _fill(state: State, slot: Slot, value: str) -> State:
    """Fill a slot; an ambiguous slot that is left with one of the named values takes it."""
    slots = []
    for other in state.slots:
        if other.path == slot.path:
            other = replace(other, value=value, likely=None)
        elif other.is_ambiguous and other.token == slot.token:
            left = tuple(each for each in other.candidates if each != value)
            likely = other.likely if other.likely in left else None
            last = left[0] if len(left) == 1 else None
            other = replace(other, candidates=left, value=last, likely=None if last else likely)
        slots.append(other)
    filled = fill_all(state.form, tuple(slots))
    return replace(state, form=filled.form, slots=filled.slots)
