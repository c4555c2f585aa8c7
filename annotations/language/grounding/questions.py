"""Ask for a slot in words, and give open slots as data."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from annotations.language.forms import Form
from annotations.language.grounding.deanonymizer import Deanonymized, Slot, filled
from annotations.language.grounding.roles import SlotPath
from annotations.language.predicates import Predicate, gloss
from annotations.language.symbols import DEFAULT_CLASSES, EntityClasses

BLANK = "___"
MOST_OFFERED = 4  # entities of the ontology that a question lists


def say_with_blank(
    path: SlotPath,
    form: Form,
    predicates: Mapping[str, Predicate],
    classes: EntityClasses = DEFAULT_CLASSES,
) -> str:
    """Return the English sentence of a form with a blank in the place of the slot at ``path``."""
    return gloss(filled(form, path, BLANK), predicates, classes)


def question_for(
    slot: Slot,
    form: Form,
    predicates: Mapping[str, Predicate],
    sentence: str | None = None,
    classes: EntityClasses = DEFAULT_CLASSES,
) -> str:
    """Return the question for an open slot: what is missing, where, and what there is to choose from.

    An unknown word of the utterance is asked about itself: "Which object is “flurb”?". What the
    utterance joins with "or" is offered whole, unknown words in quotation marks. ``sentence`` is that of
    ``say_with_blank``; made from the form if there is none.
    """
    noun = noun_for(slot, classes)
    if slot.phrases and not slot.is_named:
        asked = f"Which {noun} is {_or(tuple(f'“{phrase}”' for phrase in slot.phrases))}?"
    else:
        if sentence is None:
            sentence = say_with_blank(slot.path, form, predicates, classes)
        asked = f"Which {noun} is {BLANK} in “{sentence}”?"
    choices = choices_of(slot)
    if slot.is_choice:
        choices += tuple(f"“{phrase}”" for phrase in slot.phrases)
    offered = _or(choices) if slot.is_named or len(choices) <= MOST_OFFERED else ""
    return f"{asked} {offered[:1].upper()}{offered[1:]}?" if offered else asked


def choices_of(slot: Slot) -> tuple[str, ...]:
    """Return the values that a slot can have, the most likely one first."""
    likely = (slot.likely,) if slot.likely is not None else ()
    return tuple(dict.fromkeys((*likely, *slot.candidates)))


def noun_for(slot: Slot | None, classes: EntityClasses = DEFAULT_CLASSES) -> str:
    """Return the word for what a slot takes."""
    if slot is None or not slot.entity_class:
        return "place or thing"
    return classes.noun(slot.entity_class)


def open_slots_as_json(
    deanonymized: Deanonymized,
    predicates: Mapping[str, Predicate],
    sentence_of: Callable[[Slot], str] | None = None,
    classes: EntityClasses = DEFAULT_CLASSES,
) -> list[dict[str, Any]]:
    """Return the slots to ask about as plain data, with their questions.

    ``likely`` is null unless the utterance names several values; ``choices`` are the values to choose
    from, the likely one first; ``phrases`` the unknown words of the utterance that may be meant.
    ``sentence_of`` gives what ``say_with_blank`` says of a slot, where that is known already.
    """
    return [
        {
            "path": list(slot.path),
            "token": slot.token,
            "entity_class": slot.entity_class,
            "question": question_for(
                slot,
                deanonymized.form,
                predicates,
                sentence_of(slot) if sentence_of else None,
                classes,
            ),
            "is_named": slot.is_named,
            "likely": slot.likely,
            "choices": list(choices_of(slot)),
            "phrases": list(slot.phrases),
        }
        for slot in deanonymized.open_slots
    ]


def _or(values: tuple[str, ...]) -> str:
    """Return ``the desk, the bar or the sofa``, in the order given."""
    *others, last = values or ("",)
    return f"{', '.join(others)} or {last}" if others else last
