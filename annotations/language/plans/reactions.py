"""Read what a person answers: yes, no, stop, an entity, or words for one that nobody knows."""

from __future__ import annotations

from enum import StrEnum

from annotations.language.forms import Constant
from annotations.language.grounding import Anonymizer, Slot
from annotations.language.texts import (
    ANSWER_OPENINGS,
    BOUNDARIES,
    DETERMINERS,
    IS_EITHER,
    IS_NEW,
    NO_WORDS,
    STOP_WORDS,
    YES_WORDS,
    LanguageError,
    Position,
    require_writable,
)

MOST_CHARACTERS = 80  # of words that name an entity
_MOST_WORDS = 6
_ENDS = " .!?,;:\t\n\r\"'“”"


class Reaction(StrEnum):
    """What an answer says, apart from entities."""

    YES = "yes"
    NO = "no"
    STOP = "stop"
    NEW = "new"
    EITHER = "either"
    OTHER = "other"


def reaction_of(answer: str) -> Reaction:
    """Return whether an answer agrees, disagrees, stops, says that something is new, or leaves the choice."""
    said = " ".join(answer.casefold().strip(_ENDS).split())
    if said in STOP_WORDS:
        return Reaction.STOP
    if IS_NEW.fullmatch(said):
        return Reaction.NEW
    if IS_EITHER.fullmatch(said.replace("’", "'")):
        return Reaction.EITHER
    first = said.partition(" ")[0].strip(_ENDS)
    if first in YES_WORDS:
        return Reaction.YES
    return Reaction.NO if first in NO_WORDS else Reaction.OTHER


def known_values(answer: str, slot: Slot, anonymizer: Anonymizer) -> tuple[str, ...]:
    """Return the entities that an answer names and that fit the slot.

    They are of the slot's class (of any for an UNKNOWN), or among the choices that the utterance leaves.
    """
    spans = anonymizer.anonymize(answer).spans
    fitting = (
        span.value
        for span in spans
        if slot.entity_class in ("", span.entity_class)
        or (slot.is_choice and span.value in slot.candidates)
    )
    return tuple(dict.fromkeys(fitting))


def unknown_words(answer: str) -> str:
    """Return the words of an answer that may name something new, without what leads to them.

    ``it is the red flurb.`` names ``red flurb``. Empty where they cannot be a name: none, too many, a
    class token, a character that cannot be stored.
    """
    words = answer.strip(_ENDS).split()
    while words and words[0].casefold() in (ANSWER_OPENINGS | DETERMINERS | BOUNDARIES):
        words = words[1:]
    text = " ".join(words)
    if not text or len(text) > MOST_CHARACTERS or len(words) > _MOST_WORDS:
        return ""
    try:
        require_writable(text, Position())
    except LanguageError:
        return ""
    constant = Constant(text)
    is_token = bool(constant.token_class) or any(sign in text for sign in "<>{}")
    return "" if is_token or not constant.value else str(constant.value)
