"""Infer the predicates of a world from its forms, check forms against them, say forms in English."""

from __future__ import annotations

from annotations.language.predicates.gloss_patterns import SUPERLATIVES, pattern_of_name
from annotations.language.predicates.glossing import NAMING
from annotations.language.predicates.predicates import (
    Misuse,
    Predicate,
    PredicateKind,
    ask_for,
    check_form,
    declared_or_inferred,
    find_misuses,
    gloss,
    infer_signatures,
    sample_forms,
)
from annotations.language.predicates.signatures import (
    ArgumentKind,
    Signature,
    admits,
    argument_kind,
    is_entity_kind,
    known_kinds,
    print_signatures,
    read_signatures,
    signature_of,
)
from annotations.language.predicates.standing_in import (
    can_stand_in,
    is_loose,
    texts_of_patterns,
)

__all__ = [
    "NAMING",
    "SUPERLATIVES",
    "ArgumentKind",
    "Misuse",
    "Predicate",
    "PredicateKind",
    "Signature",
    "admits",
    "argument_kind",
    "ask_for",
    "can_stand_in",
    "check_form",
    "declared_or_inferred",
    "find_misuses",
    "gloss",
    "infer_signatures",
    "is_entity_kind",
    "is_loose",
    "known_kinds",
    "pattern_of_name",
    "print_signatures",
    "read_signatures",
    "sample_forms",
    "signature_of",
    "texts_of_patterns",
]
