"""Propose why an answer is wrong: one error category, its reason, and the runners-up."""

from __future__ import annotations

from parser_service.analysis.categories.category_proposals import (
    Proposals,
    propose_categories,
    propose_category,
)
from parser_service.analysis.categories.error_categories import DESCRIPTIONS, NAMES, ErrorCategory
from parser_service.analysis.categories.error_evidence import (
    NOTHING_MORE,
    ErrorEvidence,
    LabelDoubt,
    Neighbour,
    RunEvidence,
)
from parser_service.analysis.categories.structure import OF_DIFFERENCES
from parser_service.analysis.categories.word_use import SpokenFor, WordUse

__all__ = [
    "DESCRIPTIONS",
    "NAMES",
    "NOTHING_MORE",
    "OF_DIFFERENCES",
    "ErrorCategory",
    "ErrorEvidence",
    "LabelDoubt",
    "Neighbour",
    "Proposals",
    "RunEvidence",
    "SpokenFor",
    "WordUse",
    "propose_categories",
    "propose_category",
]
