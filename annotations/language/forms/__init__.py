"""Symbols of a grammar and logical forms: read, print, canonicalize and compare them."""

from __future__ import annotations

from annotations.language.forms.canonical import (
    canonical_text,
    canonicalize,
    equivalent,
    flatten_conjunctions,
)
from annotations.language.forms.conjunct_order import ConjunctOrder, conjunctions, head_of, order_of
from annotations.language.forms.cursor import lone_closing_parentheses
from annotations.language.forms.difference import Change, Difference, diff, diff_unordered
from annotations.language.forms.entity_classes import (
    DEFAULT_CLASSES,
    HUES,
    MAX_CLASS_WORDS,
    MAX_TOKEN,
    MOST_CLASSES,
    EntityClass,
    EntityClasses,
    is_token,
    new_hue,
    require_token,
    wildcard_names,
)
from annotations.language.forms.foreign_forms import read_foreign_form
from annotations.language.forms.kind_checks import kinds_in_form, kinds_in_pattern
from annotations.language.forms.logic import (
    TermSpan,
    plain_marks,
    read_form,
    read_or_none,
    read_spans,
    read_template_form,
)
from annotations.language.forms.meanings import (
    ATTRIBUTES,
    KIND_CLASS,
    NAMING,
    NOUN,
    PERSON,
    PERSON_CLASS,
    PERSON_PREDICATES,
    PERSONAL_CLASSES,
    PERSONAL_WORDS,
    PLACE_CLASS,
    PLACE_CLASSES,
    PLACING,
    QUESTION_CLASS,
    ROOM_CLASS,
    SAYING_CLASS,
    TAKEN,
    THING,
    THING_CLASS,
    THINGS,
    kind_of_class,
)
from annotations.language.forms.notations import to_corpus, to_reading, to_template
from annotations.language.forms.printing import print_sequence, print_symbol, print_wildcard
from annotations.language.forms.reader import SymbolReader, read_wildcard
from annotations.language.forms.references import ANTECEDENTS, described_kind, loose_references
from annotations.language.forms.slot_places import (
    SlotPlace,
    places_in_form,
    places_in_pattern,
    slot_key,
    split_head,
)
from annotations.language.forms.symbols import (
    TYPES,
    Choice,
    Combination,
    Comparison,
    Condition,
    Negation,
    Nonterminal,
    Symbol,
    Symbols,
    Text,
    Wildcard,
    walk_symbols,
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
    actions_of,
    children,
    depth,
    free_variables,
    head_predicate,
    predicates,
    size,
    walk,
    with_leaves,
    with_part,
)
from annotations.language.forms.tree_distance import FormDistances
