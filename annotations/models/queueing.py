"""What people are asked next: the work queue, and labels in doubt.

``annotations.labelling`` alone writes the queue, and ``annotations.labelling`` what audits find.
"""

from __future__ import annotations

from datetime import timedelta
from typing import TYPE_CHECKING

from django.db import models
from django.db.models import F, Q
from django.utils import timezone

from annotations.language.forms import UNKNOWN, canonical_text
from annotations.models.corpus import (
    MOST_CHARACTERS,
    Label,
    Paraphrase,
    ParaphraseStatus,
    Utterance,
    UtteranceStatus,
)
from annotations.models.description import SemanticTemplate
from annotations.models.people import User
from annotations.models.short_texts import ShortTextField
from annotations.models.worlds import DUTIES, Duty, Membership, World

LEASE = timedelta(minutes=30)
LONGEST_REASON = 300
LONGEST_TITLE = 500
DRAWS = 10_000


class FindingStatus(models.TextChoices):
    """What became of a finding. An excluded pair stays out of new splits."""

    OPEN = "open"
    KEPT = "kept"
    CORRECTED = "corrected"
    EXCLUDED = "excluded"


REVIEWER = "reviewer"  # a reason that a person gives; an audit neither makes nor removes it


def finding_status_choices() -> list[tuple[str, str]]:
    return FindingStatus.choices


def decision_choices() -> list[tuple[str, str]]:
    return [each for each in FindingStatus.choices if each[0] != FindingStatus.OPEN]


def audit_reason_choices() -> list[tuple[str, str]]:
    from annotations.language.corpus import Reason

    return [
        (REVIEWER, "a reviewer"),
        (Reason.COMMAND.value, "its command"),
        (Reason.WORD.value, "a word"),
        (Reason.PARSER.value, "a parser"),
    ]


class AuditFindingQuerySet(models.QuerySet["AuditFinding"]):
    def open(self) -> AuditFindingQuerySet:
        """Return those that wait: nobody has decided, and the label is still the one audited."""
        of_paraphrase = Q(
            paraphrase__status=ParaphraseStatus.ACCEPTED, paraphrase__logical_form=F("form")
        )
        of_utterance = Q(
            utterance__status=UtteranceStatus.LABELLED,
            utterance__logical_form=F("form"),
            utterance__deleted_at__isnull=True,
        )
        return self.filter(of_paraphrase | of_utterance, status=FindingStatus.OPEN)

    def decided(self) -> AuditFindingQuerySet:
        return self.exclude(status=FindingStatus.OPEN)

    def confirmed(self) -> AuditFindingQuerySet:
        """Return those whose label was wrong, as somebody has decided."""
        return self.filter(status__in=(FindingStatus.CORRECTED, FindingStatus.EXCLUDED))

    def with_status(self, status: str) -> AuditFindingQuerySet:
        """Return those of one status; open ones only while they wait for somebody."""
        return self.open() if status == FindingStatus.OPEN else self.filter(status=status)

    def by_reviewers(self) -> AuditFindingQuerySet:
        """Return those that a person has made, or agrees with."""
        return self.with_reason(REVIEWER)

    def with_reason(self, reason: str) -> AuditFindingQuerySet:
        reasons = AuditReason.objects.filter(finding=models.OuterRef("pk"), reason=reason)
        return self.filter(models.Exists(reasons))


class AuditFinding(models.Model):
    """A pair whose label may be wrong: of a paraphrase or of an utterance; exactly one of them is set.

    ``text`` is what somebody said, ``anonymized_text`` the same with class tokens. Forms are canonical
    corpus text with class tokens: ``form`` the label that was audited, ``suggested_form`` the one that
    most reasons offer, ``decided_form`` the label after the decision (empty where the pair was excluded).
    ``source_command`` is the command that the pair rewrites, empty where it is not known. ``rank``
    counts from 1, the most suspect label of its audit; ``score`` is the sum of the best scores of its reasons.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="audit_findings")
    paraphrase = models.ForeignKey(
        Paraphrase, null=True, blank=True, on_delete=models.CASCADE, related_name="audit_findings"
    )
    utterance = models.ForeignKey(
        Utterance, null=True, blank=True, on_delete=models.CASCADE, related_name="audit_findings"
    )
    text = models.TextField()
    anonymized_text = models.TextField()
    source_command = models.TextField(blank=True)
    form = models.TextField()
    suggested_form = models.TextField()
    decided_form = models.TextField(blank=True)
    status = models.CharField(
        max_length=12, choices=finding_status_choices, default=FindingStatus.OPEN
    )
    rank = models.PositiveIntegerField()
    score = models.FloatField()
    found_at = models.DateTimeField(default=timezone.now)

    objects = AuditFindingQuerySet.as_manager()

    class Meta:
        ordering = ["rank", "id"]
        constraints = [
            models.UniqueConstraint(
                fields=[name],
                condition=Q(status="open"),
                name=f"one_open_finding_of_{name}",
            )
            for name in ("paraphrase", "utterance")
        ]
        indexes = [
            models.Index(fields=["world", "status", "rank"]),
            models.Index(fields=["world", "rank", "id"], name="findings_in_order"),
        ]

    def __str__(self) -> str:
        return self.text

    @property
    def subject(self) -> Paraphrase | Utterance:
        subject = self.utterance or self.paraphrase
        assert subject is not None  # one of them is set
        return subject

    @property
    def is_open(self) -> bool:
        return self.status == FindingStatus.OPEN

    @property
    def doubts(self) -> list[str]:
        """What speaks against the label, each kind of reason once, as lists show it."""
        kinds = dict.fromkeys(each.reason for each in self.reasons.all())
        labels = dict(audit_reason_choices())
        return [labels[kind] for kind in kinds]

    @property
    def offers_form(self) -> bool:
        """Whether the label can be replaced by the suggestion: UNKNOWN is none."""
        return self.suggested_form != canonical_text(UNKNOWN)

    @property
    def decision(self) -> AuditDecision | None:
        """The decision that counts: the last one that was not taken back."""
        return self.decisions.valid().order_by("-pk").first()


class AuditReason(models.Model):
    """One thing that speaks against a label: ``score`` is how strongly, above 0 and up to 1.

    ``suggested_form`` is UNKNOWN where a reviewer does not say what the label should be.
    """

    finding = models.ForeignKey(AuditFinding, on_delete=models.CASCADE, related_name="reasons")
    reason = models.CharField(max_length=12, choices=audit_reason_choices)
    sentence = models.TextField()
    suggested_form = models.TextField()
    score = models.FloatField()

    class Meta:
        ordering = ["id"]

    def __str__(self) -> str:
        return self.sentence


class AuditDecisionQuerySet(models.QuerySet["AuditDecision"]):
    def valid(self) -> AuditDecisionQuerySet:
        """Leave out those that were taken back."""
        return self.filter(taken_back_at__isnull=True)


class AuditDecision(models.Model):
    """What one person decided about a finding; every decision is a row, taken back or not.

    ``label`` is the answer that it gave an utterance, ``version`` the one that it made of a paraphrase;
    both are empty where the label was kept.
    """

    finding = models.ForeignKey(AuditFinding, on_delete=models.CASCADE, related_name="decisions")
    decision = models.CharField(max_length=12, choices=decision_choices)
    form = models.TextField(blank=True)
    reason = models.CharField(max_length=MOST_CHARACTERS, blank=True)
    decided_by = models.ForeignKey(
        User, null=True, blank=True, on_delete=models.SET_NULL, related_name="audit_decisions"
    )
    decided_at = models.DateTimeField(default=timezone.now)
    taken_back_at = models.DateTimeField(null=True, blank=True)
    label = models.OneToOneField(
        Label, null=True, blank=True, on_delete=models.SET_NULL, related_name="audit_decision"
    )
    version = models.PositiveIntegerField(null=True, blank=True)

    objects = AuditDecisionQuerySet.as_manager()

    class Meta:
        ordering = ["id"]
        indexes = [models.Index(fields=["decided_by", "-id"])]

    def __str__(self) -> str:
        return f"{self.decision} by {self.decided_by}"


class WorkKind(models.TextChoices):
    """Why something is to be done, the most urgent first."""

    ADJUDICATION = "adjudication", "labels differ"
    REQUESTED = "requested", "asked by a reviewer"
    DISPUTED = "disputed", "disputed"
    AUDIT = "audit", "audit"
    DISAGREEMENT = "disagreement", "parsers disagree"
    LOW_CONFIDENCE = "low_confidence", "low confidence"
    UNLABELLED = "unlabelled", "unlabelled"


# What is done on pages of its own, by reviewers too. Everything else about an utterance is to label it.
DONE_ELSEWHERE = (WorkKind.ADJUDICATION, WorkKind.AUDIT)

# Items with a higher number are given first.
PRIORITIES = {kind: 10 * (len(WorkKind) - place) for place, kind in enumerate(WorkKind)}


class Outcome(models.TextChoices):
    """What became of an item in the hands of one person. Returned and expired ones are free again."""

    HELD = "held"
    DONE = "done"
    SKIPPED = "skipped"
    RETURNED = "returned"
    EXPIRED = "expired"


OCCUPYING = (Outcome.HELD, Outcome.DONE)
FREE_AGAIN = (Outcome.RETURNED, Outcome.EXPIRED)


def work_kind_choices() -> list[tuple[str, str]]:
    return WorkKind.choices


def outcome_choices() -> list[tuple[str, str]]:
    return Outcome.choices


class WorkItemQuerySet(models.QuerySet["WorkItem"]):
    def present(self) -> WorkItemQuerySet:
        """Leave out the items about utterances that are deleted."""
        return self.filter(utterance__deleted_at__isnull=True)

    def open(self) -> WorkItemQuerySet:
        return self.filter(closed_at__isnull=True)

    def free(self) -> WorkItemQuerySet:
        """Return the open items that somebody can still take."""
        return self.open().filter(places__gt=0)

    def untouched(self) -> WorkItemQuerySet:
        """Return the open items that nobody has had yet."""
        assignments = Assignment.objects.filter(item=models.OuterRef("pk"))
        return self.open().exclude(models.Exists(assignments))

    def taken(self) -> WorkItemQuerySet:
        """Return the open items that somebody has now."""
        held = Assignment.objects.held().filter(item=models.OuterRef("pk"))
        return self.open().filter(models.Exists(held))

    def of_person(self, person: int) -> WorkItemQuerySet:
        """Return the items that the account with this key has or has done."""
        assignments = Assignment.objects.filter(
            person=person, outcome__in=OCCUPYING, item=models.OuterRef("pk")
        )
        return self.filter(models.Exists(assignments))

    def takeable_by(self, person: User) -> WorkItemQuerySet:
        """Leave out what ``person`` has or had, and what follows from an item that they did."""
        theirs = Assignment.objects.filter(person=person, item=models.OuterRef("pk"))
        return self.free().not_answered_by(person).exclude(models.Exists(theirs))

    def not_answered_by(self, person: User) -> WorkItemQuerySet:
        """Leave out what ``person`` did, and what follows from an item that they did: others are asked."""
        done = Assignment.objects.done().filter(person=person)
        return self.exclude(
            models.Exists(done.filter(item=models.OuterRef("pk")))
            | models.Exists(done.filter(item=models.OuterRef("follows")))
        )

    def for_two(self) -> WorkItemQuerySet:
        """Return those that two people do independently of each other."""
        return self.filter(people__gt=1)

    def skipped_by(self, person: User) -> WorkItemQuerySet:
        """Return the free items that ``person`` has skipped: others are asked, and they may have them once more."""
        theirs = Assignment.objects.skipped().filter(person=person)  # few, beside all that is free
        rows = self.present().free().not_answered_by(person)
        return rows.filter(pk__in=theirs.values("item"))

    def returned_by(self, person: User) -> WorkItemQuerySet:
        """Return the free items that ``person`` gave back or kept too long, and may have once more."""
        theirs = Assignment.objects.filter(person=person, outcome__in=FREE_AGAIN)
        return self.free().filter(models.Exists(theirs.filter(item=models.OuterRef("pk"))))


class WorkItem(models.Model):
    """Something to do about an utterance, a template or a paraphrase; exactly one of them is set.

    ``people`` are to do it independently of each other, and ``places`` of them are free. ``draw``, below
    ``DRAWS``, depends on the subject alone and decides whether two people get it. ``follows`` is the
    item whose labels this one compares or disputes; whoever did that one does not get this one.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="work_items")
    kind = models.CharField(max_length=20, choices=work_kind_choices)
    reason = ShortTextField(max_length=LONGEST_REASON)
    title = ShortTextField(max_length=LONGEST_TITLE)
    utterance = models.ForeignKey(
        Utterance, null=True, blank=True, on_delete=models.CASCADE, related_name="work_items"
    )
    template = models.ForeignKey(
        SemanticTemplate, null=True, blank=True, on_delete=models.CASCADE, related_name="work_items"
    )
    paraphrase = models.ForeignKey(
        Paraphrase, null=True, blank=True, on_delete=models.CASCADE, related_name="work_items"
    )
    follows = models.OneToOneField(
        "self", null=True, blank=True, on_delete=models.SET_NULL, related_name="followed_by"
    )
    priority = models.PositiveSmallIntegerField()
    people = models.PositiveSmallIntegerField(default=1)
    places = models.PositiveSmallIntegerField(default=1)
    draw = models.PositiveSmallIntegerField(default=0)
    created_by = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)
    created_at = models.DateTimeField(default=timezone.now)
    closed_at = models.DateTimeField(null=True, blank=True)

    if TYPE_CHECKING:
        # Where a query annotates them.
        occupied: int
        is_settled: bool

    objects = WorkItemQuerySet.as_manager()

    class Meta:
        ordering = ["-priority", "id"]
        constraints = [
            models.UniqueConstraint(
                fields=["kind", name],
                condition=models.Q(closed_at__isnull=True),
                name=f"one_open_item_of_{name}",
            )
            for name in ("utterance", "template", "paraphrase")
        ]
        indexes = [
            models.Index(
                fields=["world", "-priority", "id"],
                condition=models.Q(closed_at__isnull=True, places__gt=0),
                name="free_work_items",
            ),
            models.Index(
                fields=["world", "priority", "id"],
                condition=models.Q(closed_at__isnull=True),
                name="open_work_items",
            ),
            models.Index(fields=["world", "-id"], name="work_items_of_world"),
            models.Index(
                fields=["world", "-id"],
                condition=models.Q(closed_at__isnull=False, people__gt=1),
                name="double_work_items",
            ),
        ]

    def __str__(self) -> str:
        return f"{self.get_kind_display()}: {self.title}"

    @property
    def is_open(self) -> bool:
        return self.closed_at is None

    @property
    def subject(self) -> Utterance | SemanticTemplate | Paraphrase:
        subject = self.utterance or self.template or self.paraphrase
        assert subject is not None  # one of them is set
        return subject

    @property
    def is_outdated(self) -> bool:
        """Whether nobody has to say any more what the utterance means, or whether the label is right."""
        if self.utterance and self.utterance.deleted_at:
            return True
        if self.kind == WorkKind.AUDIT and not self.template_id:
            return self.open_finding is None
        is_unlabelled = self.utterance and self.utterance.status == UtteranceStatus.UNLABELLED
        return self.kind == WorkKind.UNLABELLED and not is_unlabelled

    @property
    def open_finding(self) -> AuditFinding | None:
        """What an audit says against the label of the pair, while nobody has decided; None for other kinds."""
        pair = self.utterance or self.paraphrase
        if self.kind != WorkKind.AUDIT or pair is None or self.template_id:
            return None
        return pair.audit_findings.open().first()

    @property
    def is_for_two(self) -> bool:
        return self.people > 1


class AssignmentQuerySet(models.QuerySet["Assignment"]):
    def held(self) -> AssignmentQuerySet:
        return self.filter(outcome=Outcome.HELD)

    def expired(self) -> AssignmentQuerySet:
        """Return those held beyond the lease, or by somebody who may not do such work."""
        is_over = models.Q(leased_until__lt=timezone.now()) | ~may_be_done()
        return self.held().filter(is_over)

    def orphaned(self) -> AssignmentQuerySet:
        """Return those held by somebody who may not do such work (any more): the account was deleted or
        closed, or has no role in the world that does it."""
        return self.held().exclude(may_be_done())

    def release(self) -> None:
        """Return those that are held, so that others can take their places. Call in a transaction."""
        items = WorkItem.objects.select_for_update().filter(
            pk__in=list(self.values_list("item", flat=True))
        )
        for item in items.order_by("pk"):
            keys = self.filter(item=item).values_list("pk", flat=True)
            held = Assignment.objects.held().filter(pk__in=list(keys))
            if count := held.update(outcome=Outcome.RETURNED, leased_until=None):
                item.places += count
                item.save(update_fields=["places"])

    def done(self) -> AssignmentQuerySet:
        return self.filter(outcome=Outcome.DONE)

    def skipped(self) -> AssignmentQuerySet:
        return self.filter(outcome=Outcome.SKIPPED)


def may_be_done() -> models.Q:
    """Whether the person of an assignment may do such work: annotators do all, reviewers compare and audit."""
    roles = Membership.objects.filter(
        world=models.OuterRef("item__world"), user=models.OuterRef("person")
    )
    annotating, reviewing = (
        models.Exists(roles.filter(role__in=[role for role in DUTIES if duty in DUTIES[role]]))
        for duty in (Duty.ANNOTATE, Duty.REVIEW)
    )
    has_role = annotating | (models.Q(item__kind__in=DONE_ELSEWHERE) & models.Q(reviewing))
    return models.Q(person__is_active=True) & (models.Q(person__is_superuser=True) | has_role)


class Assignment(models.Model):
    """One person does, or has done, an item. ``leased_until`` is None where an admin assigned it without end.

    ``label`` is what the person answered, for an utterance; nobody else who does the item sees it
    before the item is closed.
    """

    item = models.ForeignKey(WorkItem, on_delete=models.CASCADE, related_name="assignments")
    person = models.ForeignKey(
        User, null=True, on_delete=models.SET_NULL, related_name="assignments"
    )
    assigned_by = models.ForeignKey(
        User, null=True, blank=True, on_delete=models.SET_NULL, related_name="assignments_given"
    )
    outcome = models.CharField(max_length=12, choices=outcome_choices, default=Outcome.HELD)
    label = models.OneToOneField(
        Label, null=True, blank=True, on_delete=models.SET_NULL, related_name="assignment"
    )
    leased_until = models.DateTimeField(null=True, blank=True)
    taken_at = models.DateTimeField(default=timezone.now)
    done_at = models.DateTimeField(null=True, blank=True)

    objects = AssignmentQuerySet.as_manager()

    class Meta:
        ordering = ["id"]
        constraints = [
            models.UniqueConstraint(fields=["item", "person"], name="one_part_of_an_item")
        ]
        indexes = [
            models.Index(fields=["person", "outcome"]),
            models.Index(
                fields=["leased_until"], condition=models.Q(outcome="held"), name="held_leases"
            ),
            models.Index(fields=["done_at"]),
        ]

    def __str__(self) -> str:
        return f"{self.item_id}: {self.outcome} by {self.person}"


class WorkShare(models.Model):
    """How many of a hundred items of one kind two people do independently of each other."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="work_shares")
    kind = models.CharField(max_length=20, choices=work_kind_choices)
    percent = models.PositiveSmallIntegerField(default=0)

    class Meta:
        constraints = [models.UniqueConstraint(fields=["world", "kind"], name="one_share_of_kind")]

    def __str__(self) -> str:
        return f"{self.percent} % of {self.get_kind_display()}"
