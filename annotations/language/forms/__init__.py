"""Read, print, canonicalize and compare logical forms."""

from __future__ import annotations

from annotations.language.forms.canonical import (
    canonical_text,
    canonicalize,
    equivalent,
    flatten_conjunctions,
)
from annotations.language.forms.conjunct_order import ConjunctOrder, conjunctions, head_of, order_of
from annotations.language.forms.difference import Change, Difference, diff, diff_unordered
from annotations.language.forms.foreign_forms import read_foreign_form
from annotations.language.forms.logic import TermSpan, read_form, read_spans, read_template_form
from annotations.language.forms.notations import to_corpus, to_reading, to_template
from annotations.language.forms.references import (
    ANTECEDENTS,
    PERSON,
    PERSON_PREDICATES,
    THING,
    THINGS,
    described_kind,
    kind_of_class,
    loose_references,
)
from annotations.language.forms.terms import (
    CLASS_TOKEN,
    CONJUNCTION,
    SEQUENCE,
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    Unknown,
    Variable,
    children,
    depth,
    free_variables,
    head_predicate,
    predicates,
    size,
    walk,
    with_part,
)
from annotations.language.forms.tree_distance import FormDistances

__all__ = [
    "ANTECEDENTS",
    "CLASS_TOKEN",
    "CONJUNCTION",
    "PERSON",
    "PERSON_PREDICATES",
    "SEQUENCE",
    "THING",
    "THINGS",
    "UNKNOWN",
    "Application",
    "Change",
    "ConjunctOrder",
    "Constant",
    "Difference",
    "Form",
    "FormDistances",
    "Lambda",
    "Reference",
    "TermSpan",
    "Unknown",
    "Variable",
    "canonical_text",
    "canonicalize",
    "children",
    "conjunctions",
    "depth",
    "described_kind",
    "diff",
    "diff_unordered",
    "equivalent",
    "flatten_conjunctions",
    "free_variables",
    "head_of",
    "head_predicate",
    "kind_of_class",
    "loose_references",
    "order_of",
    "predicates",
    "read_foreign_form",
    "read_form",
    "read_spans",
    "read_template_form",
    "size",
    "to_corpus",
    "to_reading",
    "to_template",
    "walk",
    "with_part",
]
