"""What describes a world: ontology, predicates, grammar, templates, and what the checker says of them."""

from __future__ import annotations

from annotations.models.description.grammar import Grammar, Production, TaskCategory
from annotations.models.description.ontology import Entity, Ontology, entity_class_choices
from annotations.models.description.predicates import Predicate, predicate_kind_choices
from annotations.models.description.problems import StoredProblem, Subject, subject_choices
from annotations.models.description.templates import (
    SemanticTemplate,
    TemplateStatus,
    template_status_choices,
)

__all__ = [
    "Entity",
    "Grammar",
    "Ontology",
    "Predicate",
    "Production",
    "SemanticTemplate",
    "StoredProblem",
    "Subject",
    "TaskCategory",
    "TemplateStatus",
    "entity_class_choices",
    "predicate_kind_choices",
    "subject_choices",
    "template_status_choices",
]
