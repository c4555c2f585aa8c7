"""Read what a person answers: yes, no, stop, an entity, or words for one that nobody knows."""

from __future__ import annotations

import re
from enum import StrEnum

from annotations.language.english import BOUNDARIES, DETERMINERS
from annotations.language.errors import LanguageError, Position
from annotations.language.forms import Constant
from annotations.language.grounding import Anonymizer, Slot
from annotations.language.limits import require_writable

MOST_CHARACTERS = 80  # of words that name an entity
_MOST_WORDS = 6
_YES = frozenset(
    (
        "yes", "y", "yeah", "yep", "ok", "okay", "sure", "correct", "right", "please", "confirm", "exactly",
    )
)  # fmt: skip
_NO = frozenset(["no", "n", "nope", "wrong", "incorrect", "false"])
_STOP = frozenset(("stop", "cancel", "never mind", "nevermind", "quit", "abort"))
_NEW = re.compile(
    r"(?:it is |it's |its |that is |that's )?(?:a |an )?new(?: one| thing| object| place| person)?"
)
_OPENINGS = frozenset(["it", "is", "it's", "its", "i", "mean", "that", "that's"])
_ENDS = " .!?,;:\t\n\r\"'“”"


class Reaction(StrEnum):
    """What an answer says, apart from entities."""

    YES = "yes"
    NO = "no"
    STOP = "stop"
    NEW = "new"
    OTHER = "other"


def reaction_of(answer: str) -> Reaction:
    """Return whether an answer agrees, disagrees, stops or says that something is new."""
    said = " ".join(answer.casefold().strip(_ENDS).split())
    if said in _STOP:
        return Reaction.STOP
    if _NEW.fullmatch(said):
        return Reaction.NEW
    first = said.partition(" ")[0].strip(_ENDS)
    if first in _YES:
        return Reaction.YES
    return Reaction.NO if first in _NO else Reaction.OTHER


def known_values(answer: str, slot: Slot, anonymizer: Anonymizer) -> tuple[str, ...]:
    """Return the entities of the slot's class that an answer names; of any class for an UNKNOWN."""
    spans = anonymizer.anonymize(answer).spans
    fitting = (span.value for span in spans if slot.entity_class in ("", span.entity_class))
    return tuple(dict.fromkeys(fitting))


def unknown_words(answer: str) -> str:
    """Return the words of an answer that may name something new, without what leads to them.

    ``it is the red flurb.`` names ``red flurb``. Empty where they cannot be a name: none, too many, a
    class token, a character that cannot be stored.
    """
    words = answer.strip(_ENDS).split()
    while words and words[0].casefold() in (_OPENINGS | DETERMINERS | BOUNDARIES):
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
