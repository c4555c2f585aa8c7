"""What is stored, one module a room. Models are imported from here; choices, limits and query sets from the
module of their room.
"""

from annotations.models.background import Job, JobKind
from annotations.models.campaigns import Campaign, CampaignPrompt, Contributor, Submission
from annotations.models.corpus import (
    Command,
    CommandProposal,
    Label,
    LogicalForm,
    Origin,
    Paraphrase,
    Proposal,
    Upload,
    Utterance,
    UtteranceStatus,
    Verdict,
)
from annotations.models.description import (
    Entity,
    EntityClass,
    Grammar,
    Guidelines,
    Ontology,
    Predicate,
    Primitive,
    Production,
    Recipe,
    SemanticTemplate,
    StoredProblem,
    TaskCategory,
)
from annotations.models.editing import Comment, Draft, EarlierText, Editable, Notice
from annotations.models.people import ApiToken, LogInSession, Scope, User
from annotations.models.queueing import (
    Assignment,
    AuditDecision,
    AuditFinding,
    AuditReason,
    FindingStatus,
    WorkItem,
    WorkKind,
    WorkShare,
)
from annotations.models.splits import Example, Split
from annotations.models.worlds import AuditEntry, Duty, Invitation, Membership, World
