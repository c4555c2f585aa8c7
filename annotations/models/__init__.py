from annotations.models.audit import AuditDecision, AuditFinding, AuditReason, FindingStatus
from annotations.models.audit_entries import AuditEntry
from annotations.models.comments import Comment, EarlierText, Notice
from annotations.models.corpus import Command, LogicalForm, Paraphrase
from annotations.models.drafts import Draft
from annotations.models.editable import Editable
from annotations.models.grammar import Grammar, Production, TaskCategory
from annotations.models.invitations import Invitation
from annotations.models.jobs import Job, JobKind
from annotations.models.ontology import Entity, Ontology
from annotations.models.people import ApiToken, Scope, User
from annotations.models.predicates import Predicate
from annotations.models.problems import StoredProblem
from annotations.models.proposals import CommandProposal, Proposal
from annotations.models.sessions import LogInSession
from annotations.models.splits import Example, Split
from annotations.models.templates import SemanticTemplate
from annotations.models.utterances import (
    Label,
    Origin,
    Utterance,
    UtteranceStatus,
    Verdict,
)
from annotations.models.work_items import Assignment, WorkItem, WorkKind, WorkShare
from annotations.models.worlds import Duty, Membership, World

__all__ = [
    "ApiToken",
    "Assignment",
    "AuditDecision",
    "AuditEntry",
    "AuditFinding",
    "AuditReason",
    "Command",
    "CommandProposal",
    "Comment",
    "Draft",
    "Duty",
    "EarlierText",
    "Editable",
    "Entity",
    "Example",
    "FindingStatus",
    "Grammar",
    "Invitation",
    "Job",
    "JobKind",
    "Label",
    "LogInSession",
    "LogicalForm",
    "Membership",
    "Notice",
    "Ontology",
    "Origin",
    "Paraphrase",
    "Predicate",
    "Production",
    "Proposal",
    "Scope",
    "SemanticTemplate",
    "Split",
    "StoredProblem",
    "TaskCategory",
    "User",
    "Utterance",
    "UtteranceStatus",
    "Verdict",
    "WorkItem",
    "WorkKind",
    "WorkShare",
    "World",
]
