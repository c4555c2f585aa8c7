"""Entities to class tokens and back: what was heard, who has which role, what a text names."""

from __future__ import annotations

from annotations.language.grounding.anonymizer import QUESTION_WORD, Anonymized, Anonymizer, Span
from annotations.language.grounding.deanonymizer import (
    Deanonymized,
    FormSlots,
    Slot,
    deanonymize,
    entities_of,
    fill_all,
    filled,
    ground_like,
    ground_text,
    resolve_slots,
    with_values,
)
from annotations.language.grounding.drawing import may_fill
from annotations.language.grounding.grounding import Grounded, ground
from annotations.language.grounding.heard_changes import HeardChange, applied
from annotations.language.grounding.hearing import HeardText, HearingReader
from annotations.language.grounding.questions import (
    NOT_UNDERSTOOD,
    choices_of,
    is_asked_plainly,
    named_entities,
    noun_for,
    open_slots_as_json,
    question_for,
)
from annotations.language.grounding.role_evidence import Evidence, RoleCounts, as_pair
from annotations.language.grounding.roles import (
    SlotPath,
    SlotRole,
    class_of,
    context_of,
    role_of,
    tokens_of,
    words_of,
)
from annotations.language.grounding.utterance_lattice import HeardLattice, UtteranceReader
from annotations.language.grounding.utterance_mentions import UtteranceMentions, are_alike
