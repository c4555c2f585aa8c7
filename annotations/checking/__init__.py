"""Checks what people write, while they type and before they delete, and keeps stored problems up to date."""

from annotations.checking.assistance import assist, completion_tag, completions_of, shown_problem
from annotations.checking.deletion_check import check_deletion
from annotations.checking.predicate_check import check_predicate
from annotations.checking.production_check import (
    EXPANSION_FIELD,
    CheckedProduction,
    ProductionEdit,
    assist_production,
    check_production,
    consequences_of_production,
)
from annotations.checking.stored_problems import check_again
from annotations.checking.template_check import Checked, check_template, recall_check
from annotations.checking.template_samples import samples_of

__all__ = [
    "EXPANSION_FIELD",
    "Checked",
    "CheckedProduction",
    "ProductionEdit",
    "assist",
    "assist_production",
    "check_again",
    "check_deletion",
    "check_predicate",
    "check_production",
    "check_template",
    "completion_tag",
    "completions_of",
    "consequences_of_production",
    "recall_check",
    "samples_of",
    "shown_problem",
]
