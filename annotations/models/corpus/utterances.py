"""Utterances that people gave a robot, and the answers of those who label them."""

from __future__ import annotations

from django.db import models
from django.utils import timezone

from annotations.models.editing import Editable
from annotations.models.people import User
from annotations.models.worlds import World

MOST_CHARACTERS = 500  # of an utterance, and of a reason


class Origin(models.TextChoices):
    """Where an utterance comes from."""

    PASTED = "pasted"
    UPLOADED = "uploaded"
    CONTRIBUTOR = "contributor"
    DIALOGUE = "dialogue"
    REVIEW = "review"
    PARAPHRASE = "paraphrase"


class UtteranceStatus(models.TextChoices):
    """What is known of an utterance; UNKNOWN: no form of this world says what it means."""

    UNLABELLED = "unlabelled"
    LABELLED = "labelled"
    UNKNOWN = "unknown"
    DISPUTED = "disputed"
    EXCLUDED = "excluded"


class Verdict(models.TextChoices):
    """What somebody answers about an utterance. A skip leaves it to others; what is excluded is no command."""

    FORM = "form"
    UNKNOWN = "unknown"
    SKIP = "skip"
    DISPUTE = "dispute"
    EXCLUDE = "exclude"


def origin_choices() -> list[tuple[str, str]]:
    return Origin.choices


def utterance_status_choices() -> list[tuple[str, str]]:
    return UtteranceStatus.choices


def verdict_choices() -> list[tuple[str, str]]:
    return Verdict.choices


class UtteranceQuerySet(models.QuerySet["Utterance"]):
    def unlabelled(self) -> UtteranceQuerySet:
        return self.filter(status=UtteranceStatus.UNLABELLED)

    def labelled(self) -> UtteranceQuerySet:
        """Return those with an accepted form."""
        return self.filter(status=UtteranceStatus.LABELLED)

    def unanswered_by(self, user: User) -> UtteranceQuerySet:
        """Leave out those that ``user`` has answered, or skipped, and not taken back."""
        answers = Label.objects.valid().filter(utterance=models.OuterRef("pk"), annotator=user)
        return self.exclude(models.Exists(answers))


class Utterance(Editable):
    """A text that gets a logical form from people; its world has it once.

    ``anonymized_text`` has class tokens for the entities that the text names. ``spans`` says where:
    rows of [start, end, class, entity], positions counted in characters of ``text``.
    ``logical_form`` is canonical corpus text with class tokens; it is the accepted label's, and empty
    without one.
    """

    edited_fields = ("text", "anonymized_text", "spans", "status", "logical_form")

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="utterances")
    text = models.CharField(max_length=MOST_CHARACTERS)
    anonymized_text = models.TextField()
    spans = models.JSONField(default=list, blank=True)
    origin = models.CharField(max_length=20, choices=origin_choices, default=Origin.PASTED)
    status = models.CharField(
        max_length=20, choices=utterance_status_choices, default=UtteranceStatus.UNLABELLED
    )
    logical_form = models.TextField(blank=True)
    created_by = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)
    created_at = models.DateTimeField(default=timezone.now)

    objects = UtteranceQuerySet.as_manager()

    class Meta:
        ordering = ["id"]
        constraints = [models.UniqueConstraint(fields=["world", "text"], name="utterance_text")]
        indexes = [models.Index(fields=["world", "status", "id"])]

    def __str__(self) -> str:
        return self.text

    @property
    def accepted_label(self) -> Label | None:
        """The answer that decides its status and form: the one accepted last. None where there is none."""
        return self.labels.accepted().order_by("-accepted_at", "-id").first()


class LabelQuerySet(models.QuerySet["Label"]):
    def valid(self) -> LabelQuerySet:
        """Leave out those that were taken back."""
        return self.filter(taken_back_at__isnull=True)

    def accepted(self) -> LabelQuerySet:
        return self.valid().filter(accepted_at__isnull=False)


class Label(models.Model):
    """One person's answer about one utterance; every answer is a row.

    ``form`` is canonical corpus text where the verdict is a form; ``reason`` says why it is disputed.
    ``seconds`` is how long the person looked at it. Of the answers that were accepted and not taken
    back, the one accepted last decides; a blind answer is not accepted before somebody compares it.
    """

    utterance = models.ForeignKey(Utterance, on_delete=models.CASCADE, related_name="labels")
    annotator = models.ForeignKey(
        User, null=True, blank=True, on_delete=models.SET_NULL, related_name="labels"
    )
    verdict = models.CharField(max_length=12, choices=verdict_choices)
    form = models.TextField(blank=True)
    reason = models.CharField(max_length=MOST_CHARACTERS, blank=True)
    seconds = models.FloatField(null=True, blank=True)
    created_at = models.DateTimeField(default=timezone.now)
    accepted_at = models.DateTimeField(null=True, blank=True)
    taken_back_at = models.DateTimeField(null=True, blank=True)

    objects = LabelQuerySet.as_manager()

    class Meta:
        ordering = ["id"]
        indexes = [models.Index(fields=["annotator", "-id"])]

    def __str__(self) -> str:
        return f"{self.verdict} by {self.annotator}"

    @property
    def answer(self) -> tuple[str, str]:
        """What two people agree on when they agree."""
        return self.verdict, self.form
