"""Ask for what a command leaves open: a pure state machine of frozen states (Walker et al. 2019, §3.3).

CHECKING → ASKING ⇄ LEARNING → CONFIRMING → DONE; REPHRASING waits for another utterance, and
CANCELLED follows from anywhere. A reply gives a new state and changes nothing. Every reply brings the dialogue
closer to an end: it fills a slot, uses up patience or an attempt, or moves to a phase further down (``progress``).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from annotations.language.dialogue.answers import (
    Reaction,
    known_values,
    reaction_of,
    unknown_words,
)
from annotations.language.dialogue.states import Offer, Phase, State
from annotations.language.forms import Form, Unknown
from annotations.language.grounding import (
    Anonymized,
    Anonymizer,
    Evidence,
    Slot,
    deanonymize,
    fill_all,
    noun_for,
    question_for,
)
from annotations.language.ontology import Ontology
from annotations.language.predicates import Predicate, gloss

PATIENCE = 3  # answers that do not fit before the dialogue gives up
ATTEMPTS = 3  # utterances that lead nowhere before the dialogue gives up
_ORDER = (Phase.CHECKING, Phase.ASKING, Phase.LEARNING, Phase.CONFIRMING, Phase.REPHRASING)
_GIVE_UP = "I give up. Please start again."


@dataclass(frozen=True)
class Dialogue:
    """What a dialogue knows: the entities, how to say predicates, and which words go where."""

    ontology: Ontology
    predicates: Mapping[str, Predicate]
    evidence: Evidence | None = None
    anonymizer: Anonymizer = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "anonymizer", Anonymizer(self.ontology))

    def begin(
        self, form: Form, heard: Anonymized, is_sure: bool = True, before: State | None = None
    ) -> State:
        """Return the first state for an utterance and the form that a parser gave for it.

        Args:
            form: the form with class tokens, or UNKNOWN.
            heard: the utterance.
            is_sure: whether the parser is; if not, the form is checked first.
            before: the state that was REPHRASING, if this utterance is its answer.
        """
        attempts, offers = (before.attempts, before.offers) if before else (0, ())
        if isinstance(form, Unknown):
            asked = State(Phase.REPHRASING, attempts=attempts, offers=offers)
            return _rephrase(asked, "I do not understand that.")
        given = deanonymize(form, heard, self.ontology, self.evidence)
        state = State(
            Phase.CHECKING, form, given.form, given.slots, attempts=attempts, offers=offers
        )
        return state_with_prompt(self, state) if not is_sure else self._ask(state)

    def reply(self, state: State, answer: str) -> State:
        """Return the state after an answer; a dialogue that is over stays as it is.

        While REPHRASING, only an answer that stops or says nothing is for here; any other one is an utterance to
        be parsed and given to ``begin``.
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

    def _decide(self, state: State, reaction: Reaction) -> State:
        """Take a yes or a no to the whole form."""
        if reaction is Reaction.NO:
            return _rephrase(state, "Then I got it wrong.")
        if reaction is not Reaction.YES:
            return self._miss(state, "Please say yes or no. ")
        if state.phase is Phase.CHECKING:
            return self._ask(state)
        return replace(state, phase=Phase.DONE, prompt="I will do it.")

    def _answer(self, state: State, answer: str, reaction: Reaction) -> State:
        """Take the value of the slot that was asked for."""
        slot = state.asked
        assert slot is not None
        values = known_values(answer, slot, self.anonymizer)
        if len(values) == 1:
            return self._fill(state, slot, values[0], _alias(slot, values[0]))
        if len(values) > 1:
            return self._miss(state, f"Please name one {noun_for(slot)}. ")
        if reaction in (Reaction.YES, Reaction.EITHER) and slot.likely is not None:
            return self._fill(state, slot, slot.likely)
        is_new = reaction is Reaction.NEW and slot.phrases
        word = slot.phrases[0] if is_new else unknown_words(answer)
        is_no_word = reaction in (Reaction.YES, Reaction.NO) and len(word.split()) == 1
        if not word or is_no_word or reaction is Reaction.EITHER:
            return self._miss(state, "")
        return self._take_word(state, slot, word, is_new=bool(is_new))

    def _take_word(self, state: State, slot: Slot, word: str, is_new: bool) -> State:
        """Take words that name no entity: as they are for an UNKNOWN, else as something to learn."""
        if not slot.entity_class:
            return self._fill(state, slot, word)
        learnt = _learnt(state, slot, word)
        if learnt is not None:
            return self._fill(state, slot, learnt)
        if self.anonymizer.anonymize(word).spans:
            return self._miss(state, f"“{word}” is no {noun_for(slot)}. ")
        is_said_twice = word.casefold() in {phrase.casefold() for phrase in slot.phrases}
        if is_new or is_said_twice:
            return self._fill(state, slot, word, Offer(slot.entity_class, word))
        return state_with_prompt(self, replace(state, phase=Phase.LEARNING, word=word))

    def _learn(self, state: State, reaction: Reaction) -> State:
        slot = state.asked
        assert slot is not None
        if reaction in (Reaction.YES, Reaction.NEW):
            return self._fill(state, slot, state.word, Offer(slot.entity_class, state.word))
        if reaction is Reaction.NO:
            return self._miss(replace(state, phase=Phase.ASKING, word=""), "")
        return self._miss(state, "Please say yes or no. ")

    def _fill(self, state: State, slot: Slot, value: str, offer: Offer | None = None) -> State:
        """Fill a slot; an ambiguous slot that is left with one of the named values takes it.

        The unknown words that this settles are no choice for any other slot.
        """
        settled = _settled_phrases(slot, value)
        slots = tuple(_without(settled, _after(other, slot, value)) for other in state.slots)
        offers = state.offers
        if offer is not None and offer not in offers:
            offers = (*offers, offer)
        given = fill_all(state.form, slots)
        filled = replace(state, form=given.form, slots=given.slots, offers=offers)
        return self._ask(replace(filled, word="", misses=0))

    def _ask(self, state: State) -> State:
        """Ask for the next open slot, or for confirmation if none is left."""
        is_full = all(slot.value is not None for slot in state.slots)
        phase = Phase.CONFIRMING if is_full else Phase.ASKING
        return state_with_prompt(self, replace(state, phase=phase))

    def _miss(self, state: State, sorry: str) -> State:
        missed = replace(state, misses=state.misses + 1)
        if missed.misses >= PATIENCE:
            return replace(missed, phase=Phase.CANCELLED, prompt=_GIVE_UP)
        return state_with_prompt(self, missed, sorry)


def state_with_prompt(dialogue: Dialogue, state: State, sorry: str = "") -> State:
    """Return the state with what to say in it."""
    return replace(state, prompt=f"{sorry}{_prompt(dialogue, state)}")


def progress(state: State) -> tuple[int, int, int, int]:
    """Return how far a dialogue is from its end; every reply makes it smaller, or ends the dialogue.

    Attempts left, open slots, patience left, and the place of the phase.
    """
    open_slots = sum(slot.value is None for slot in state.slots)
    phase = len(_ORDER) - _ORDER.index(state.phase) if state.phase in _ORDER else 0
    return ATTEMPTS - state.attempts, open_slots, PATIENCE - state.misses, phase


def _prompt(dialogue: Dialogue, state: State) -> str:
    if state.phase is Phase.REPHRASING:
        return "Please say it another way."
    slot = state.asked
    if slot is None:
        words = re.sub(r"\bme\b", "you", gloss(state.form, dialogue.predicates))
        check = f"Did you mean: {gloss(state.form, dialogue.predicates)}?"
        return check if state.phase is Phase.CHECKING else f"Shall I {words}?"
    if state.phase is Phase.LEARNING:
        return f"I do not know any {noun_for(slot)} called “{state.word}”. Shall I learn it?"
    question = question_for(slot, state.form, dialogue.predicates)
    if slot.phrases and slot.entity_class and not slot.is_named:
        return f"{question} Name one that I know, or say “new”."
    return question


def _rephrase(state: State, why: str) -> State:
    """Ask for another utterance, as often as there are attempts."""
    tried = replace(state, attempts=state.attempts + 1, slots=(), misses=0)
    if tried.attempts >= ATTEMPTS:
        return replace(tried, phase=Phase.CANCELLED, prompt=_GIVE_UP)
    return replace(tried, phase=Phase.REPHRASING, prompt=f"{why} Please say it another way.")


def _alias(slot: Slot, value: str) -> Offer | None:
    """Return the word of the utterance as another word for the entity that it turned out to be."""
    if slot.is_named or not slot.entity_class or len(slot.phrases) != 1:
        return None
    return Offer(slot.entity_class, value, slot.phrases[0])


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


def _learnt(state: State, slot: Slot, word: str) -> str | None:
    """Return the entity that a word stands for since an earlier answer; None if there is none."""
    for offer in state.offers:
        said = offer.alias or offer.text
        if offer.entity_class == slot.entity_class and said.casefold() == word.casefold():
            return offer.text
    return None


def _settled_phrases(slot: Slot, value: str) -> frozenset[str]:
    """Return the unknown words that are accounted for once ``slot`` has its value.

    They are the value itself, the only word that the question was about, and all that "or" joins.
    """
    if slot.is_choice or len(slot.phrases) == 1:
        return frozenset(slot.phrases)
    return frozenset(phrase for phrase in slot.phrases if phrase.casefold() == value.casefold())


def _without(settled: frozenset[str], slot: Slot) -> Slot:
    """Return a slot that is still open without the unknown words that others settle."""
    if slot.value is not None or slot.is_choice:
        return slot
    return replace(slot, phrases=tuple(each for each in slot.phrases if each not in settled))
