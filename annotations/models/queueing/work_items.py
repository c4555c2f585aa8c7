"""The work queue: what to do next and why, and who does it. ``annotations.queueing`` alone writes it."""

from __future__ import annotations

from datetime import timedelta

from django.db import models
from django.utils import timezone

from annotations.models.corpus import Label, Paraphrase, Utterance, UtteranceStatus
from annotations.models.description import SemanticTemplate
from annotations.models.people import User
from annotations.models.queueing.audit import AuditFinding
from annotations.models.worlds import World

LEASE = timedelta(minutes=30)
LONGEST_REASON = 300
LONGEST_TITLE = 500
DRAWS = 10_000


class WorkKind(models.TextChoices):
    """Why something is to be done, the most urgent first."""

    ADJUDICATION = "adjudication", "labels differ"
    REQUESTED = "requested", "asked by a reviewer"
    DISPUTED = "disputed", "disputed"
    AUDIT = "audit", "audit"
    DISAGREEMENT = "disagreement", "parsers disagree"
    LOW_CONFIDENCE = "low_confidence", "low confidence"
    UNLABELLED = "unlabelled", "unlabelled"


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
    def open(self) -> WorkItemQuerySet:
        return self.filter(closed_at__isnull=True)

    def free(self) -> WorkItemQuerySet:
        """Return the open items that somebody can still take."""
        return self.open().filter(places__gt=0)

    def untouched(self) -> WorkItemQuerySet:
        """Return the open items that nobody has had yet."""
        parts = Assignment.objects.filter(item=models.OuterRef("pk"))
        return self.open().exclude(models.Exists(parts))

    def taken(self) -> WorkItemQuerySet:
        """Return the open items that somebody has now."""
        held = Assignment.objects.held().filter(item=models.OuterRef("pk"))
        return self.open().filter(models.Exists(held))

    def of_person(self, person: int) -> WorkItemQuerySet:
        """Return the items that the account with this key has or has done."""
        parts = Assignment.objects.filter(
            person=person, outcome__in=OCCUPYING, item=models.OuterRef("pk")
        )
        return self.filter(models.Exists(parts))

    def takeable_by(self, person: User) -> WorkItemQuerySet:
        """Leave out what ``person`` has or had, and what follows from an item that they did."""
        theirs = Assignment.objects.filter(person=person)
        return self.free().exclude(
            models.Exists(theirs.filter(item=models.OuterRef("pk")))
            | models.Exists(theirs.filter(item=models.OuterRef("follows"), outcome=Outcome.DONE))
        )

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
    reason = models.CharField(max_length=LONGEST_REASON)
    title = models.CharField(max_length=LONGEST_TITLE)
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
            models.Index(fields=["world", "-id"], name="work_items_of_world"),
        ]

    def __str__(self) -> str:
        return f"{self.get_kind_display()}: {self.title}"

    @property
    def is_open(self) -> bool:
        return self.closed_at is None

    @property
    def subject(self) -> Utterance | SemanticTemplate | Paraphrase:
        return self.utterance or self.template or self.paraphrase

    @property
    def is_outdated(self) -> bool:
        """Whether nobody has to say any more what the utterance means, or whether the label is right."""
        if self.kind == WorkKind.AUDIT and not self.template_id:
            return self.open_finding is None
        is_unlabelled = self.utterance and self.utterance.status == UtteranceStatus.UNLABELLED
        return self.kind == WorkKind.UNLABELLED and not is_unlabelled

    @property
    def open_finding(self) -> AuditFinding | None:
        """What an audit says against the label of the pair, while nobody has decided; None for other kinds."""
        if self.kind != WorkKind.AUDIT or self.subject is None or self.template_id:
            return None
        return self.subject.audit_findings.open().first()

    @property
    def is_for_two(self) -> bool:
        return self.people > 1


class AssignmentQuerySet(models.QuerySet["Assignment"]):
    def held(self) -> AssignmentQuerySet:
        return self.filter(outcome=Outcome.HELD)

    def expired(self) -> AssignmentQuerySet:
        """Return those held beyond the lease, or by an account that was deleted."""
        is_over = models.Q(leased_until__lt=timezone.now()) | models.Q(person__isnull=True)
        return self.held().filter(is_over)

    def done(self) -> AssignmentQuerySet:
        return self.filter(outcome=Outcome.DONE)

    def skipped(self) -> AssignmentQuerySet:
        return self.filter(outcome=Outcome.SKIPPED)


class Assignment(models.Model):
    """One person's part in an item. ``leased_until`` is None where an admin assigned it without end.

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
