"""Commands and their forms, paraphrases, and utterances with the labels and forms that they get."""

from __future__ import annotations

from django.db import models
from django.utils import timezone

from annotations.models.campaigns import Contributor, ContributorKind
from annotations.models.description import SemanticTemplate
from annotations.models.editing import Editable
from annotations.models.people import User
from annotations.models.short_texts import ShortTextField
from annotations.models.worlds import World

MOST_CHARACTERS = 500  # of an utterance, and of a reason
MOST_CHARACTERS_OF_NAME = 200  # of a file, and of a column in it


class LogicalForm(models.Model):
    """One meaning: ``text`` is canonical corpus notation. ``length`` counts tokens."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="logical_forms")
    text = models.TextField()
    head_predicate = models.CharField(max_length=80)
    depth = models.PositiveIntegerField()
    length = models.PositiveIntegerField()
    task_category = models.CharField(max_length=60, blank=True)

    class Meta:
        ordering = ["id"]
        constraints = [models.UniqueConstraint(fields=["world", "text"], name="form_text")]

    def __str__(self) -> str:
        return self.text


class Command(models.Model):
    """A generated, anonymized command; it belongs to the first task category that produces it."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="commands")
    template = models.ForeignKey(
        SemanticTemplate, null=True, on_delete=models.SET_NULL, related_name="commands"
    )
    logical_form = models.ForeignKey(LogicalForm, on_delete=models.CASCADE, related_name="commands")
    anonymized_text = models.TextField()
    length = models.PositiveIntegerField()
    task_category = models.CharField(max_length=60)
    is_in_grammar = models.BooleanField(default=True)
    position = models.PositiveIntegerField()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["world", "anonymized_text"], name="command_text")
        ]
        indexes = [
            models.Index(fields=["world", "task_category", "position"]),
            models.Index(fields=["world", "position", "id"], name="commands_in_order"),
        ]

    def __str__(self) -> str:
        return self.anonymized_text


class ParaphraseStatus(models.TextChoices):
    """What is accepted goes into new splits. An accepted one is excluded where its label is wrong."""

    PENDING = "pending"
    ACCEPTED = "accepted"
    REJECTED = "rejected"
    EXCLUDED = "excluded"


def paraphrase_status_choices() -> list[tuple[str, str]]:
    return ParaphraseStatus.choices


class ParaphraseQuerySet(models.QuerySet["Paraphrase"]):
    def accepted(self) -> ParaphraseQuerySet:
        return self.filter(status=ParaphraseStatus.ACCEPTED)


class Paraphrase(Editable):
    """``utterance`` is how somebody said the grounded ``prompt``; the forms are canonical corpus text.

    ``command`` is the generated command behind the prompt where it is known. Where that is gone,
    ``command_text`` says what it was, so that it is known again when templates make it again; it is
    empty otherwise. ``contributor`` wrote it for a campaign; None where it came in a file. Distances are to the prompt:
    ``edit_distance`` in characters (Levenshtein), ``jaccard_distance`` over words, in 0–1.
    """

    edited_fields = ("prompt", "utterance", "grounded_form", "logical_form", "status")
    fields_beside = ("edit_distance", "jaccard_distance")

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="paraphrases")
    command = models.ForeignKey(
        Command, null=True, on_delete=models.SET_NULL, related_name="paraphrases"
    )
    command_text = models.TextField(blank=True, default="", db_default="", editable=False)
    prompt = models.TextField()
    utterance = models.TextField()
    grounded_form = models.TextField()
    logical_form = models.TextField()
    edit_distance = models.PositiveIntegerField()
    jaccard_distance = models.FloatField()
    status = models.CharField(
        max_length=20, choices=paraphrase_status_choices, default=ParaphraseStatus.ACCEPTED
    )
    contributor = models.ForeignKey(
        Contributor,
        null=True,
        blank=True,
        on_delete=models.SET_NULL,
        related_name="paraphrases",
    )
    position = models.PositiveIntegerField()

    objects = ParaphraseQuerySet.as_manager()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["world", "position"], name="paraphrase_position")
        ]
        indexes = [
            models.Index(fields=["world", "logical_form", "position"], name="paraphrases_of_form"),
        ]

    def __str__(self) -> str:
        return self.utterance

    @property
    def is_by_model(self) -> bool:
        """Whether a language model wrote it."""
        return self.contributor is not None and self.contributor.kind == ContributorKind.MODEL


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


class UploadQuerySet(models.QuerySet["Upload"]):
    def stored(self) -> UploadQuerySet:
        """Return those that have added utterances; the others are only looked at so far."""
        return self.filter(stored_at__isnull=False)

    def waiting(self) -> UploadQuerySet:
        return self.filter(stored_at__isnull=True)


class Upload(models.Model):
    """What one person sent at once: a file, or a pasted text. It is stored, undone and redone as a whole.

    ``content`` is what was sent until it is stored, and empty then. ``format`` and ``column`` say how it
    was read. ``added`` counts the utterances that it brought.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="uploads")
    file_name = models.CharField(max_length=MOST_CHARACTERS_OF_NAME, blank=True)
    content = models.BinaryField(default=bytes, blank=True)
    format = models.CharField(max_length=12, blank=True)
    column = ShortTextField(max_length=MOST_CHARACTERS_OF_NAME, blank=True)
    added = models.PositiveIntegerField(default=0)
    created_by = models.ForeignKey(
        User, null=True, blank=True, on_delete=models.SET_NULL, related_name="uploads"
    )
    created_at = models.DateTimeField(default=timezone.now)
    stored_at = models.DateTimeField(null=True, blank=True)
    undone_at = models.DateTimeField(null=True, blank=True)
    undone_by = models.ForeignKey(
        User, null=True, blank=True, on_delete=models.SET_NULL, related_name="uploads_undone"
    )

    objects = UploadQuerySet.as_manager()

    class Meta:
        ordering = ["-id"]

    def __str__(self) -> str:
        return self.file_name or "pasted text"


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


UtteranceManager = models.Manager.from_queryset(UtteranceQuerySet)


class PresentUtterances(UtteranceManager["Utterance"]):
    """The utterances that are not deleted: what every list, queue, split and export reads."""

    def get_queryset(self) -> UtteranceQuerySet:
        utterances = super().get_queryset()
        assert isinstance(utterances, UtteranceQuerySet)
        return utterances.filter(deleted_at__isnull=True)


class Utterance(Editable):
    """A text that gets a logical form from people; its world has it once.

    A deleted one keeps its row, so that its answers come back with it; only ``with_deleted`` shows it.

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
    upload = models.ForeignKey(
        Upload, null=True, blank=True, on_delete=models.SET_NULL, related_name="utterances"
    )
    created_by = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)
    created_at = models.DateTimeField(default=timezone.now)
    deleted_at = models.DateTimeField(null=True, blank=True, editable=False)

    objects = PresentUtterances()
    with_deleted = UtteranceQuerySet.as_manager()

    class Meta:
        ordering = ["id"]
        constraints = [
            models.UniqueConstraint(
                fields=["world", "text"],
                condition=models.Q(deleted_at__isnull=True),
                name="utterance_text",
            )
        ]
        indexes = [models.Index(fields=["world", "status", "id"])]

    def __str__(self) -> str:
        return self.text

    @property
    def accepted_label(self) -> Label | None:
        """The answer that decides its status and form: the one accepted last. None where there is none."""
        return self.labels.accepted().order_by("-accepted_at", "-id").first()


class LabelQuerySet(models.QuerySet["Label"]):
    def of_world(self, world: World) -> LabelQuerySet:
        """Return the answers to the utterances of ``world`` that are not deleted."""
        return self.filter(utterance__world=world, utterance__deleted_at__isnull=True)

    def valid(self) -> LabelQuerySet:
        """Leave out those that were taken back."""
        return self.filter(taken_back_at__isnull=True)

    def accepted(self) -> LabelQuerySet:
        return self.valid().filter(accepted_at__isnull=False)

    def visible_to(self, reader: User) -> LabelQuerySet:
        """Leave out what others have answered and somebody may still be asked: the one place for this rule.

        People answer independently of each other, so that an answer is hidden from everybody but its author
        until it counts, or until nobody is asked about the utterance. Who compares two answers sees them.
        """
        counts = models.Q(accepted_at__isnull=False, taken_back_at__isnull=True)
        utterance = Utterance.objects.filter(pk=models.OuterRef("utterance"))
        several = models.Q(work_items__people__gt=1) | models.Q(work_items__kind="adjudication")
        is_asked = models.Exists(utterance.filter(several, work_items__closed_at__isnull=True))
        is_unlabelled = models.Q(utterance__status=UtteranceStatus.UNLABELLED)
        compared = Label.objects.filter(
            pk=models.OuterRef("pk"),
            assignment__item__followed_by__assignments__person=reader,
            assignment__item__followed_by__assignments__outcome="held",
        )
        return self.filter(
            models.Q(annotator=reader)
            | counts
            | models.Exists(compared)
            | ~(is_unlabelled | models.Q(is_asked))
        )


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
    def counts(self) -> bool:
        """Whether it was accepted and not taken back."""
        return self.accepted_at is not None and self.taken_back_at is None

    def says(self, verdict: str, form: str, reason: str) -> bool:
        """Return whether this is that answer; ``form`` is canonical corpus text."""
        return (self.verdict, self.form, self.reason) == (verdict, form, " ".join(reason.split()))


class ProposedForm(models.Model):
    """``source`` is the parser's name and ``run`` the number of its run; ``rank`` counts from 1;
    ``form`` is canonical corpus text; scores compare within one parser only."""

    source = models.CharField(max_length=60)
    run = models.PositiveBigIntegerField()
    rank = models.PositiveSmallIntegerField()
    form = models.TextField()
    score = models.FloatField()

    class Meta:
        abstract = True

    def __str__(self) -> str:
        return self.form


class Proposal(ProposedForm):
    """A form that a trained parser answers to an utterance."""

    utterance = models.ForeignKey(Utterance, on_delete=models.CASCADE, related_name="proposals")

    class Meta:
        ordering = ["utterance", "rank"]
        constraints = [
            models.UniqueConstraint(fields=["utterance", "source", "rank"], name="proposal_rank")
        ]


class CommandProposal(ProposedForm):
    """A form that a trained parser answers to an anonymized command, which has none yet."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="command_proposals")
    command = models.CharField(max_length=MOST_CHARACTERS)

    class Meta:
        ordering = ["command", "rank"]
        constraints = [
            models.UniqueConstraint(
                fields=["world", "command", "rank"], name="command_proposal_rank"
            )
        ]
