from annotations.models.corpus import Command, LogicalForm, Paraphrase
from annotations.models.grammar import Grammar, Production, TaskCategory
from annotations.models.ontology import Entity, Ontology
from annotations.models.people import ApiToken, User
from annotations.models.predicates import Predicate
from annotations.models.problems import StoredProblem
from annotations.models.splits import Example, Split
from annotations.models.templates import SemanticTemplate
from annotations.models.worlds import Duty, Membership, World

__all__ = [
    "ApiToken",
    "Command",
    "Duty",
    "Entity",
    "Example",
    "Grammar",
    "LogicalForm",
    "Membership",
    "Ontology",
    "Paraphrase",
    "Predicate",
    "Production",
    "SemanticTemplate",
    "Split",
    "StoredProblem",
    "TaskCategory",
    "User",
    "World",
]
