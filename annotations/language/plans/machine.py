"""Ask for what a command leaves open: a pure state machine of frozen states (Walker et al. 2019, §3.3).

CHECKING → ASKING ⇄ LEARNING → CONFIRMING → DONE; REPHRASING waits for another utterance, and
CANCELLED follows from anywhere. A reply gives a new state and changes nothing. Every reply brings the dialogue
closer to an end: it fills a slot, uses up patience or an attempt, or moves to a phase further down (``progress``).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from enum import StrEnum
from typing import Any

from annotations.language.forms import UNKNOWN, Form, Unknown, read_form, to_corpus
from annotations.language.grounding import (
    NOT_UNDERSTOOD,
    Anonymized,
    Anonymizer,
    Evidence,
    Slot,
    deanonymize,
    fill_all,
    named_entities,
    noun_for,
    question_for,
)
from annotations.language.plans.reactions import Reaction, known_values, reaction_of, unknown_words
from annotations.language.world import Ontology, Predicate, gloss

PATIENCE = 3  # answers that do not fit before the dialogue gives up
ATTEMPTS = 3  # utterances that lead nowhere before the dialogue gives up
_GIVE_UP = "I give up. Please start again."
_ANOTHER_WAY = "Please say it another way."
_TUPLES_OF_SLOTS = ("path", "candidates", "phrases")  # lists in JSON


class Phase(StrEnum):
    """What the dialogue waits for, or how it ended.

    CHECKING: a yes to a form that the parser is not sure of. ASKING: a value for ``DialogueState.asked``.
    LEARNING: a yes to an entity that nobody knows. CONFIRMING: a yes to the whole form.
    REPHRASING: another utterance. DONE and CANCELLED are ends.
    """

    CHECKING = "checking"
    ASKING = "asking"
    LEARNING = "learning"
    CONFIRMING = "confirming"
    REPHRASING = "rephrasing"
    DONE = "done"
    CANCELLED = "cancelled"


_ORDER = (Phase.CHECKING, Phase.ASKING, Phase.LEARNING, Phase.CONFIRMING, Phase.REPHRASING)


@dataclass(frozen=True, slots=True)
class Offer:
    """An entity that somebody named and the ontology does not have, or another word (``alias``) for one that it has."""

    entity_class: str
    text: str
    alias: str = ""


@dataclass(frozen=True, slots=True)
class DialogueState:
    """Where a dialogue is. ``prompt`` is what to say next.

    ``parsed`` is the form of the parser, with class tokens; ``form`` has the values so far. ``misses``
    counts answers that do not fit, ``attempts`` utterances that led nowhere. ``word`` is what the answer named
    while LEARNING.
    """

    phase: Phase
    parsed: Form = UNKNOWN
    form: Form = UNKNOWN
    slots: tuple[Slot, ...] = ()
    prompt: str = ""
    misses: int = 0
    attempts: int = 0
    word: str = ""
    offers: tuple[Offer, ...] = ()

    @property
    def asked(self) -> Slot | None:
        """The slot that the dialogue asks for; None unless ASKING or LEARNING."""
        still_open = (slot for slot in self.slots if slot.value is None)
        is_asking = self.phase in (Phase.ASKING, Phase.LEARNING)
        return next(still_open, None) if is_asking else None

    @property
    def is_over(self) -> bool:
        return self.phase in (Phase.DONE, Phase.CANCELLED)

    def as_json(self) -> dict[str, Any]:
        """Return a value of plain types that ``from_json`` can read."""
        return {
            "phase": str(self.phase),
            "parsed": to_corpus(self.parsed),
            "form": to_corpus(self.form),
            "slots": [asdict(slot) for slot in self.slots],
            "prompt": self.prompt,
            "misses": self.misses,
            "attempts": self.attempts,
            "word": self.word,
            "offers": [asdict(offer) for offer in self.offers],
        }

    @classmethod
    def from_json(cls, value: Mapping[str, Any]) -> DialogueState:
        """Return the state that ``value`` was made from."""
        return cls(
            Phase(value["phase"]),
            read_form(value["parsed"]),
            read_form(value["form"]),
            tuple(
                Slot(**{**each, **{name: tuple(each[name]) for name in _TUPLES_OF_SLOTS}})
                for each in value["slots"]
            ),
            value["prompt"],
            value["misses"],
            value["attempts"],
            value["word"],
            tuple(Offer(**offer) for offer in value["offers"]),
        )


@dataclass(frozen=True)
class DialogueManager:
    """What a dialogue knows: the entities, how to say predicates, and which words go where."""

    ontology: Ontology
    predicates: Mapping[str, Predicate]
    evidence: Evidence | None = None
    anonymizer: Anonymizer = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "anonymizer", Anonymizer(self.ontology))

    def begin(
        self,
        form: Form,
        heard: Anonymized,
        is_sure: bool = True,
        before: DialogueState | None = None,
        values: Sequence[str | None] = (),
    ) -> DialogueState:
        """Return the first state for an utterance and the form that a parser gave for it.

        Args:
            form: the form with class tokens, or UNKNOWN.
            heard: the utterance.
            is_sure: whether the parser is; if not, the form is checked first.
            before: the state that was REPHRASING, if this utterance is its answer.
            values: the entities of the class tokens of the form that the parser says itself (``deanonymize``).
        """
        attempts, offers = (before.attempts, before.offers) if before else (0, ())
        if isinstance(form, Unknown):
            asked = DialogueState(Phase.REPHRASING, attempts=attempts, offers=offers)
            return _rephrase(asked, NOT_UNDERSTOOD)
        given = deanonymize(form, heard, self.ontology, self.evidence, values)
        state = DialogueState(
            Phase.CHECKING, form, given.form, given.slots, attempts=attempts, offers=offers
        )
        return state_with_prompt(self, state) if not is_sure else self._ask(state)

    def reply(self, state: DialogueState, answer: str) -> DialogueState:
        """Return the state after an answer; a dialogue that is over stays as it is.

        While REPHRASING, give it only answers that stop or say nothing. Parse any other answer as an utterance
        and give it to ``begin``.
        """
        if state.is_over:
            return state
        reaction = reaction_of(answer)
        if reaction is Reaction.STOP:
            return replace(state, phase=Phase.CANCELLED, prompt="I will not do it.")
        if state.phase in (Phase.CHECKING, Phase.CONFIRMING):
            return self._decide(state, reaction)
        if state.phase is Phase.LEARNING:
            return self._learn(state, reaction)
        if state.phase is Phase.REPHRASING:
            return self._miss(state, "")
        return self._answer(state, answer, reaction)

    def _decide(self, state: DialogueState, reaction: Reaction) -> DialogueState:
        """Take a yes or a no to the whole form."""
        if reaction is Reaction.NO:
            return _rephrase(state, f"Then I got it wrong. {_ANOTHER_WAY}")
        if reaction is not Reaction.YES:
            return self._miss(state, "Please say yes or no. ")
        if state.phase is Phase.CHECKING:
            return self._ask(state)
        return replace(state, phase=Phase.DONE, prompt="I will do it.")

    def _answer(self, state: DialogueState, answer: str, reaction: Reaction) -> DialogueState:
        """Take the value of the slot that was asked for."""
        slot = state.asked
        assert slot is not None
        values = known_values(answer, slot, self.anonymizer)
        if len(values) == 1:
            # The word of the utterance is another one for the entity that it turned out to be.
            is_alias = not slot.is_named and slot.entity_class and len(slot.phrases) == 1
            alias = Offer(slot.entity_class, values[0], slot.phrases[0]) if is_alias else None
            return self._fill(state, slot, values[0], alias)
        if len(values) > 1:
            return self._miss(state, f"Please name one {noun_for(slot, self.ontology.classes)}. ")
        if reaction in (Reaction.YES, Reaction.EITHER) and slot.likely is not None:
            return self._fill(state, slot, slot.likely)
        is_new = reaction is Reaction.NEW and slot.phrases
        word = slot.phrases[0] if is_new else unknown_words(answer)
        is_no_word = reaction in (Reaction.YES, Reaction.NO) and len(word.split()) == 1
        if not word or is_no_word or reaction is Reaction.EITHER:
            return self._miss(state, "")
        if not slot.entity_class:
            return self._fill(state, slot, word)
        offers = (each for each in state.offers if each.entity_class == slot.entity_class)
        words = ((each.alias or each.text, each.text) for each in offers)
        learnt = next((text for said, text in words if said.casefold() == word.casefold()), None)
        if learnt is not None:
            return self._fill(state, slot, learnt)
        if self.anonymizer.anonymize(word).spans:
            return self._miss(state, f"“{word}” is no {noun_for(slot, self.ontology.classes)}. ")
        is_said_twice = word.casefold() in {phrase.casefold() for phrase in slot.phrases}
        if is_new or is_said_twice:
            return self._fill(state, slot, word, Offer(slot.entity_class, word))
        return state_with_prompt(self, replace(state, phase=Phase.LEARNING, word=word))

    def _learn(self, state: DialogueState, reaction: Reaction) -> DialogueState:
        slot = state.asked
        assert slot is not None
        if reaction in (Reaction.YES, Reaction.NEW):
            return self._fill(state, slot, state.word, Offer(slot.entity_class, state.word))
        if reaction is Reaction.NO:
            return self._miss(replace(state, phase=Phase.ASKING, word=""), "")
        return self._miss(state, "Please say yes or no. ")

    def _fill(
        self, state: DialogueState, slot: Slot, value: str, offer: Offer | None = None
    ) -> DialogueState:
        """Fill a slot; an ambiguous slot that is left with one of the named values takes it.

        The unknown words that this settles are no choice for any other slot.
        """
        if slot.is_choice or len(slot.phrases) == 1:
            settled = frozenset(slot.phrases)
        else:
            settled = frozenset(
                phrase for phrase in slot.phrases if phrase.casefold() == value.casefold()
            )
        slots: list[Slot] = []
        for other in state.slots:
            left = _after(other, slot, value)
            if left.value is None and not left.is_choice:
                phrases = tuple(each for each in left.phrases if each not in settled)
                left = replace(left, phrases=phrases)
            slots.append(left)
        offers = state.offers
        if offer is not None and offer not in offers:
            offers = (*offers, offer)
        given = fill_all(state.form, tuple(slots))
        filled = replace(state, form=given.form, slots=given.slots, offers=offers)
        return self._ask(replace(filled, word="", misses=0))

    def _ask(self, state: DialogueState) -> DialogueState:
        """Ask for the next open slot, or for confirmation if none is left."""
        is_full = all(slot.value is not None for slot in state.slots)
        phase = Phase.CONFIRMING if is_full else Phase.ASKING
        return state_with_prompt(self, replace(state, phase=phase))

    def _miss(self, state: DialogueState, sorry: str) -> DialogueState:
        missed = replace(state, misses=state.misses + 1)
        if missed.misses >= PATIENCE:
            return replace(missed, phase=Phase.CANCELLED, prompt=_GIVE_UP)
        return state_with_prompt(self, missed, sorry)


def state_with_prompt(
    dialogue: DialogueManager, state: DialogueState, sorry: str = ""
) -> DialogueState:
    """Return the state with what to say in it."""
    slot, classes = state.asked, dialogue.ontology.classes
    if state.phase is Phase.REPHRASING:
        prompt = _ANOTHER_WAY
    elif slot is None:
        named = dialogue.ontology.class_of_text
        said = gloss(state.form, dialogue.predicates, classes, named)
        prompt = f"Did you mean: {said}?" if state.phase is Phase.CHECKING else shall_i(said)
    elif state.phase is Phase.LEARNING:
        prompt = (
            f"I do not know any {noun_for(slot, classes)} called “{state.word}”. Shall I learn it?"
        )
    else:
        named = named_entities(state.slots)
        prompt = question_for(slot, state.form, dialogue.predicates, classes=classes, named=named)
        if slot.phrases and slot.entity_class and not slot.is_named:
            prompt = f"{prompt} Name one that I know, or say “new”."
    return replace(state, prompt=sorry + prompt)


def shall_i(said: str) -> str:
    """Return the question whether to do what the English of a form says."""
    return f"Shall I {as_robot_says(said)}?"


def as_robot_says(said: str) -> str:
    """Return what somebody asks of the robot, as the robot says it of itself: "bring me" is "bring you"."""
    return re.sub(r"\bme\b", "you", said)


def progress(state: DialogueState) -> tuple[int, int, int, int]:
    """Return how far a dialogue is from its end; every reply makes it smaller, or ends the dialogue.

    Attempts left, open slots, patience left, and the place of the phase.
    """
    open_slots = sum(slot.value is None for slot in state.slots)
    phase = len(_ORDER) - _ORDER.index(state.phase) if state.phase in _ORDER else 0
    return ATTEMPTS - state.attempts, open_slots, PATIENCE - state.misses, phase


def _rephrase(state: DialogueState, prompt: str) -> DialogueState:
    """Ask for another utterance, as often as there are attempts."""
    tried = replace(state, attempts=state.attempts + 1, slots=(), misses=0)
    if tried.attempts >= ATTEMPTS:
        return replace(tried, phase=Phase.CANCELLED, prompt=_GIVE_UP)
    return replace(tried, phase=Phase.REPHRASING, prompt=prompt)


def _after(other: Slot, slot: Slot, value: str) -> Slot:
    """Return what a slot becomes when ``slot`` gets its value.

    Slots that wait for the same choice get the same value; others that the utterance names
    something for are left with what is not taken.
    """
    if other.path == slot.path:
        return replace(other, value=value, likely=None)
    if slot.is_choice or other.is_choice:
        is_same = (slot.candidates, slot.phrases) == (other.candidates, other.phrases)
        is_waiting = slot.is_choice and other.is_choice and other.value is None
        return replace(other, value=value, likely=None) if is_same and is_waiting else other
    if not (other.is_ambiguous and other.token == slot.token):
        return other
    left = tuple(each for each in other.candidates if each != value)
    if len(left) == 1:
        return replace(other, candidates=left, value=left[0], likely=None)
    return replace(other, candidates=left, likely=other.likely if other.likely in left else None)
