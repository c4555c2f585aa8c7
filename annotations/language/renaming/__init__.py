"""Rename nonterminals, predicates and entities in texts that name them. The rest of a text stays as it is written."""

from __future__ import annotations

from annotations.language.renaming.entities import (
    CLASS_OF_ATTRIBUTE,
    EntityName,
    rename_in_attributes,
    rename_in_conditions,
    rename_in_grounded_form,
    rename_in_template,
    rename_in_utterance,
)
from annotations.language.renaming.names import (
    require_entity_name,
    require_nonterminal,
    require_predicate,
)
from annotations.language.renaming.nonterminals import (
    rename_nonterminal_in_form,
    rename_nonterminal_in_pattern,
)
from annotations.language.renaming.predicates import rename_predicate

__all__ = [
    "CLASS_OF_ATTRIBUTE",
    "EntityName",
    "rename_in_attributes",
    "rename_in_conditions",
    "rename_in_grounded_form",
    "rename_in_template",
    "rename_in_utterance",
    "rename_nonterminal_in_form",
    "rename_nonterminal_in_pattern",
    "rename_predicate",
    "require_entity_name",
    "require_nonterminal",
    "require_predicate",
]
