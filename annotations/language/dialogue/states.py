"""The state of a dialogue: frozen, and convertible to plain data and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Any

from annotations.language.forms import UNKNOWN, Form, read_form, to_corpus
from annotations.language.grounding import Slot


class Phase(StrEnum):
    """What the dialogue waits for, or how it ended.

    CHECKING: a yes to a form that the parser is not sure of. ASKING: a value for ``State.asked``.
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


@dataclass(frozen=True, slots=True)
class Offer:
    """An entity that somebody named and the ontology does not have, or another word (``alias``) for one that it has."""

    entity_class: str
    text: str
    alias: str = ""


@dataclass(frozen=True, slots=True)
class State:
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
    def from_json(cls, value: Mapping[str, Any]) -> State:
        """Return the state that ``value`` was made from."""
        return cls(
            Phase(value["phase"]),
            read_form(value["parsed"]),
            read_form(value["form"]),
            tuple(map(_slot, value["slots"])),
            value["prompt"],
            value["misses"],
            value["attempts"],
            value["word"],
            tuple(Offer(**offer) for offer in value["offers"]),
        )


def _slot(value: Mapping[str, Any]) -> Slot:
    lists = {name: tuple(value[name]) for name in ("path", "candidates", "phrases")}
    return Slot(**{**value, **lists})
