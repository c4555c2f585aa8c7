"""Induce a world from what people say: read marked commands, propose what they mean, generalise with care."""

from __future__ import annotations

from annotations.language.induction.analogies import Derived, derive
from annotations.language.induction.classes import MarkedClass, folded
from annotations.language.induction.marked_lines import (
    EXAMPLE,
    MOST_CHARACTERS,
    MOST_LINES,
    Example,
    Mark,
    read_example,
    read_examples,
)
from annotations.language.induction.offers import Offer, OfferKind
from annotations.language.induction.proposal import (
    Doubt,
    KnownWorld,
    Proposal,
    ProposedPredicate,
    ProposedTemplate,
    propose,
    with_class_named,
    with_predicate_named,
)
from annotations.language.induction.rules import Rule
from annotations.language.induction.synonyms import Synonyms, find_synonyms
