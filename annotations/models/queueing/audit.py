"""What a label audit finds, and what people decide about it. ``annotations.auditing`` alone writes it."""

from __future__ import annotations

from django.db import models
from django.db.models import F, Q
from django.utils import timezone

from annotations.language.auditing import Reason
from annotations.language.forms import UNKNOWN, canonical_text
from annotations.models.corpus import (
    MOST_CHARACTERS,
    Label,
    Paraphrase,
    ParaphraseStatus,
    Utterance,
    UtteranceStatus,
)
from annotations.models.people import User
from annotations.models.worlds import World


class FindingStatus(models.TextChoices):
    """What became of a finding. An excluded pair stays out of new splits."""

    OPEN = "open"
    KEPT = "kept"
    CORRECTED = "corrected"
    EXCLUDED = "excluded"


REVIEWER = "reviewer"  # a reason that a person gives; an audit neither makes nor removes it
REASON_LABELS = {
    REVIEWER: "a reviewer",
    Reason.COMMAND: "its command",
    Reason.WORD: "a word",
    Reason.PARSER: "a parser",
}


def finding_status_choices() -> list[tuple[str, str]]:
    return FindingStatus.choices


def decision_choices() -> list[tuple[str, str]]:
    return [each for each in FindingStatus.choices if each[0] != FindingStatus.OPEN]


def audit_reason_choices() -> list[tuple[str, str]]:
    return [(str(reason), label) for reason, label in REASON_LABELS.items()]


class AuditFindingQuerySet(models.QuerySet["AuditFinding"]):
    def open(self) -> AuditFindingQuerySet:
        """Return those that wait: nobody has decided, and the label is still the one audited."""
        of_paraphrase = Q(
            paraphrase__status=ParaphraseStatus.ACCEPTED, paraphrase__logical_form=F("form")
        )
        of_utterance = Q(
            utterance__status=UtteranceStatus.LABELLED, utterance__logical_form=F("form")
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
        indexes = [models.Index(fields=["world", "status", "rank"])]

    def __str__(self) -> str:
        return self.text

    @property
    def subject(self) -> Paraphrase | Utterance:
        return self.utterance or self.paraphrase

    @property
    def is_open(self) -> bool:
        return self.status == FindingStatus.OPEN

    @property
    def doubts(self) -> list[str]:
        """What speaks against the label, each kind of reason once, as lists show it."""
        kinds = dict.fromkeys(each.reason for each in self.reasons.all())
        return [REASON_LABELS[kind] for kind in kinds]

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
