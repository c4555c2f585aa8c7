"""The kinds of errors that a reviewer tags, the first two from Walker, Peng and Cakmak (2019)."""

from __future__ import annotations

from enum import StrEnum


class ErrorCategory(StrEnum):
    """Why an answer is wrong. The values are codes for storage."""

    UNEXPECTED_DEFAULT = "unexpected_default"
    OVERLY_SENSITIVE = "overly_sensitive"
    WRONG_PREDICATE = "wrong_predicate"
    WRONG_ARGUMENT = "wrong_argument"
    MISSING_CONSTRAINT = "missing_constraint"
    EXTRA_CONSTRAINT = "extra_constraint"
    WRONG_STRUCTURE = "wrong_structure"
    ILL_FORMED = "ill_formed"
    AMBIGUOUS_UTTERANCE = "ambiguous_utterance"
    WRONG_GOLD_LABEL = "wrong_gold_label"
    OUTSIDE_ONTOLOGY = "outside_ontology"


NAMES = {
    ErrorCategory.UNEXPECTED_DEFAULT: "Unexpected default",
    ErrorCategory.OVERLY_SENSITIVE: "Overly sensitive",
    ErrorCategory.WRONG_PREDICATE: "Wrong predicate",
    ErrorCategory.WRONG_ARGUMENT: "Wrong argument",
    ErrorCategory.MISSING_CONSTRAINT: "Missing constraint",
    ErrorCategory.EXTRA_CONSTRAINT: "Extra constraint",
    ErrorCategory.WRONG_STRUCTURE: "Wrong structure",
    ErrorCategory.ILL_FORMED: "Ill-formed",
    ErrorCategory.AMBIGUOUS_UTTERANCE: "Ambiguous utterance",
    ErrorCategory.WRONG_GOLD_LABEL: "Wrong gold label",
    ErrorCategory.OUTSIDE_ONTOLOGY: "Outside the ontology",
}

DESCRIPTIONS = {
    ErrorCategory.UNEXPECTED_DEFAULT: "Unlike utterances get this same form, as if by default.",
    ErrorCategory.OVERLY_SENSITIVE: "A change of one word leads to a quite different form.",
    ErrorCategory.WRONG_PREDICATE: "A predicate is exchanged for another one.",
    ErrorCategory.WRONG_ARGUMENT: "An argument is exchanged, missing or too many.",
    ErrorCategory.MISSING_CONSTRAINT: "A constraint of the label is not in the answer.",
    ErrorCategory.EXTRA_CONSTRAINT: "The answer has a constraint that the label does not have.",
    ErrorCategory.WRONG_STRUCTURE: "The parts are right, or nearly, but put together differently.",
    ErrorCategory.ILL_FORMED: "The answer is not a logical form.",
    ErrorCategory.AMBIGUOUS_UTTERANCE: "The same text is labelled with several forms.",
    ErrorCategory.WRONG_GOLD_LABEL: "The label is wrong, not the answer.",
    ErrorCategory.OUTSIDE_ONTOLOGY: "It takes a predicate or a class that the world does not have.",
}
