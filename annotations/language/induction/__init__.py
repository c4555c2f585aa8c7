"""Induce a world from what people say: read marked commands, propose what they mean, generalise with care."""

from __future__ import annotations

from annotations.language.induction.additions import (
    categories_with,
    category_of,
    marked,
    new_classes,
    new_entities,
    new_predicates,
    new_productions,
    with_proposal,
)
from annotations.language.induction.analogies import Derived, derive
from annotations.language.induction.classes import MarkedClass, folded
from annotations.language.induction.clauses import clauses_of, names_all
from annotations.language.induction.lengthening import Change, Edit, StoredTemplates, with_changes
from annotations.language.induction.marked_lines import (
    EXAMPLE,
    MOST_CHARACTERS,
    MOST_LINES,
    Example,
    Mark,
    read_example,
    read_examples,
    text_of,
    with_english,
)
from annotations.language.induction.offers import Offer, OfferKind
from annotations.language.induction.proposal import (
    CATEGORY,
    Doubt,
    KnownWorld,
    Proposal,
    ProposedPredicate,
    ProposedTemplate,
    propose,
    with_class_named,
    with_predicate_named,
)
from annotations.language.induction.rules import Rule, is_slot
from annotations.language.induction.synonyms import Synonyms, find_synonyms
