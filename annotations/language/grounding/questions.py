"""Ask for a slot in words, and give open slots as data."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from annotations.language.forms import DEFAULT_CLASSES, EntityClasses, Form
from annotations.language.grounding.deanonymizer import Deanonymized, Slot
from annotations.language.world import Predicate, ask_for

NOT_UNDERSTOOD = "I did not understand that. What shall I do?"
MOST_OFFERED = 4  # entities of the ontology that a question lists


def named_entities(slots: Iterable[Slot]) -> dict[str, str]:
    """Return the entities that fill slots with their classes, but none that is of two classes."""
    classes: defaultdict[str, set[str]] = defaultdict(set)
    for slot in slots:
        if slot.filler is not None and slot.entity_class:
            classes[slot.filler].add(slot.entity_class)
    return {text: of_text.pop() for text, of_text in classes.items() if len(of_text) == 1}


def question_for(
    slot: Slot,
    form: Form,
    predicates: Mapping[str, Predicate],
    asked: str | None = None,
    classes: EntityClasses = DEFAULT_CLASSES,
    named: Mapping[str, str] | None = None,
) -> str:
    """Return the question for an open slot, as a person would ask it, and what there is to choose from.

    An unknown word of the utterance is asked about itself: "Which object do you mean by “flurb”?". What the
    utterance joins with "or" is offered whole, unknown words in quotation marks.

    Args:
        asked: what ``ask_for`` says of the slot; made from the form if it is not known.
        named: the classes of texts of the form that name entities.
    """
    if slot.phrases and not slot.is_named:
        what = f"Which {noun_for(slot, classes)}" if slot.entity_class else "What"
        asked = f"{what} do you mean by {_or(tuple(f'“{phrase}”' for phrase in slot.phrases))}?"
    elif asked is None:
        asked = ask_for(form, slot.path, slot.entity_class, predicates, classes, named)
    offered = _offered(slot)
    return f"{asked} {offered[:1].upper()}{offered[1:]}?" if offered else asked


def is_asked_plainly(slot: Slot) -> bool:
    """Return whether the question for a slot is what ``ask_for`` says, whatever the utterance was."""
    return not (slot.phrases and not slot.is_named) and not _offered(slot)


def _offered(slot: Slot) -> str:
    """Return what a question lists to choose from; empty where that is nothing or too much."""
    choices = choices_of(slot)
    if slot.is_choice:
        choices += tuple(f"“{phrase}”" for phrase in slot.phrases)
    return _or(choices) if slot.is_named or len(choices) <= MOST_OFFERED else ""


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
    asked_for: Callable[[Slot], str] | None = None,
    classes: EntityClasses = DEFAULT_CLASSES,
) -> list[dict[str, Any]]:
    """Return the slots to ask about as plain data, with their questions.

    ``likely`` is null unless the utterance names several values; ``choices`` are the values to choose
    from, the likely one first; ``phrases`` the unknown words of the utterance that may be meant.
    ``asked_for`` gives what ``ask_for`` says of a slot, where that is known already.
    """
    named = named_entities(deanonymized.slots)
    return [
        {
            "path": list(slot.path),
            "token": slot.token,
            "entity_class": slot.entity_class,
            "question": question_for(
                slot,
                deanonymized.form,
                predicates,
                asked_for(slot) if asked_for else None,
                classes,
                named,
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
