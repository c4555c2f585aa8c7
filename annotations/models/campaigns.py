"""Paraphrases by link: campaigns, the prompts that they show, who contributes, and what they submit.

``annotations.campaigns`` alone writes these rows. Models are in an order in which each refers to earlier ones; what
somebody submits becomes a ``Paraphrase`` or an ``Utterance`` when a moderator accepts it.
"""

from __future__ import annotations

import secrets
from datetime import datetime, timedelta

from django.db import models
from django.db.models import Count
from django.utils import timezone

from annotations.models.counting import count_of
from annotations.models.people import User
from annotations.models.worlds import World

MOST_CHARACTERS_OF_TEXT = 8_000  # of a text that contributors read
LONGEST_CAMPAIGN_NAME = 60
LONGEST_PSEUDONYM = 32
MOST_PLACES = 400  # of a task
SECONDS_FOR_A_PLACE = 30  # about what people take; docs/guides/campaigns.md
# Who has begun may finish for so long after a campaign was closed or its time was up.
GRACE = timedelta(days=1)


class Wording(models.TextChoices):
    """How a prompt is put: as the generated command, or as the English of its form, which primes less."""

    COMMAND = "command"
    ENGLISH = "english"


class Balance(models.TextChoices):
    """What gets equally many prompts: each form, or each line of the templates. A form may have many lines."""

    FORMS = "forms"
    LINES = "lines"


class ContributorKind(models.TextChoices):
    """Where the submissions come from: by link, from a language model, or in a file of results."""

    PERSON = "person"
    MODEL = "model"
    FILE = "file"


class SubmissionKind(models.TextChoices):
    """A rewrite of a prompt, a planted check, or a command of the contributor's own."""

    REWRITE = "rewrite"
    CHECK = "check"
    FREE = "free"


class SubmissionStatus(models.TextChoices):
    """What a moderator decided."""

    PENDING = "pending"
    ACCEPTED = "accepted"
    REJECTED = "rejected"


def wording_choices() -> list[tuple[str, str]]:
    return Wording.choices


def balance_choices() -> list[tuple[str, str]]:
    return Balance.choices


def contributor_kind_choices() -> list[tuple[str, str]]:
    return ContributorKind.choices


def submission_kind_choices() -> list[tuple[str, str]]:
    return SubmissionKind.choices


def submission_status_choices() -> list[tuple[str, str]]:
    return SubmissionStatus.choices


def new_key() -> str:
    """Return the secret part of a link: 128 random bits."""
    return secrets.token_urlsafe(16)


class CampaignQuerySet(models.QuerySet["Campaign"]):
    def for_key(self, key: str) -> Campaign | None:
        """Return the campaign whose link holds ``key``, also one that is over; None where no link holds it."""
        rows = self.filter(world__deletion_requested_at__isnull=True).select_related("world")
        return None if not key or "\0" in key else rows.filter(key=key).first()

    def counted(self) -> CampaignQuerySet:
        """Return each with ``people`` who have begun, ``finished`` ones, and their ``answers``."""
        people = Contributor.objects.filter(kind=ContributorKind.PERSON)
        answered = Submission.objects.answered()
        return self.annotate(
            people=count_of(people, "campaign", Count("pseudonym", distinct=True)),
            finished=count_of(people.filter(finished_at__isnull=False), "campaign"),
            answers=count_of(answered, "contributor__campaign"),
        )


class Campaign(models.Model):
    """A task that is offered by a public link: rewrite commands in your own words.

    ``introduction``, ``examples``, ``consent`` and ``thanks`` are Markdown. ``balance`` says what gets equally many
    prompts. ``task_size`` prompts and
    ``free_commands`` commands of their own make a task; a form has enough with ``target_per_form``
    paraphrases. ``taboo_words`` says how many of a form's most used words are shown as not to be used;
    ``check_every`` plants a check among so many prompts (0: none). It ends when it is closed, at ``ends_at``,
    or with ``most_submissions``. At most ``most_per_hour`` tasks are begun by the link. ``price`` is what a task costs,
    in ``currency``. ``run_by``, ``contact`` and ``minutes`` stand beside the consent. A crowd market sends who comes
    and for what as ``worker_parameter`` and ``assignment_parameter``; if these are empty, by known names.
    Its pages may frame this one if they are of ``frame_origins``, separated by blanks. Who answers no to
    ``screening_question`` gets ``screened_out_code`` and ``screened_out_url``, and no task.
    ``key`` is the secret part of the link; it is empty where the link was revoked. ``version``
    counts from 1 how often its texts, its end and its payment were changed.
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="campaigns")
    name = models.CharField(max_length=LONGEST_CAMPAIGN_NAME)
    introduction = models.TextField(blank=True, max_length=MOST_CHARACTERS_OF_TEXT)
    examples = models.TextField(blank=True, max_length=MOST_CHARACTERS_OF_TEXT)
    consent = models.TextField(blank=True, max_length=MOST_CHARACTERS_OF_TEXT)
    thanks = models.TextField(blank=True, max_length=MOST_CHARACTERS_OF_TEXT)
    allows_model_help = models.BooleanField(default=False)
    allows_retake = models.BooleanField(default=False)
    wording = models.CharField(max_length=8, choices=wording_choices, default=Wording.COMMAND)
    balance = models.CharField(
        max_length=5, choices=balance_choices, default=Balance.FORMS, db_default=Balance.FORMS
    )
    task_size = models.PositiveSmallIntegerField(default=12)
    free_commands = models.PositiveSmallIntegerField(default=2)
    target_per_form = models.PositiveSmallIntegerField(default=10)
    taboo_words = models.PositiveSmallIntegerField(default=0)
    check_every = models.PositiveSmallIntegerField(default=0)
    price = models.DecimalField(max_digits=7, decimal_places=2, null=True, blank=True)
    currency = models.CharField(max_length=8, blank=True)
    completion_code = models.CharField(max_length=40, blank=True)
    return_url = models.URLField(max_length=500, blank=True)
    run_by = models.CharField(max_length=200, blank=True, default="", db_default="")
    contact = models.CharField(max_length=200, blank=True, default="", db_default="")
    minutes = models.PositiveSmallIntegerField(null=True, blank=True)
    worker_parameter = models.CharField(max_length=40, blank=True, default="", db_default="")
    assignment_parameter = models.CharField(max_length=40, blank=True, default="", db_default="")
    frame_origins = models.CharField(max_length=500, blank=True, default="", db_default="")
    screening_question = models.CharField(max_length=300, blank=True, default="", db_default="")
    screened_out_code = models.CharField(max_length=40, blank=True, default="", db_default="")
    screened_out_url = models.URLField(max_length=500, blank=True, default="", db_default="")
    ends_at = models.DateTimeField(null=True, blank=True)
    most_submissions = models.PositiveIntegerField(null=True, blank=True)
    most_per_hour = models.PositiveIntegerField(default=1_000)
    key = models.CharField(max_length=40, blank=True, default=new_key, db_index=True)
    seed = models.PositiveIntegerField(default=0)
    created_by = models.ForeignKey(
        User, null=True, blank=True, on_delete=models.SET_NULL, related_name="campaigns"
    )
    created_at = models.DateTimeField(default=timezone.now)
    closed_at = models.DateTimeField(null=True, blank=True)
    version = models.PositiveIntegerField(default=1)

    objects = CampaignQuerySet.as_manager()

    class Meta:
        ordering = ["-id"]
        constraints = [
            models.UniqueConstraint(
                fields=["world", "name"],
                name="campaign_name",
                violation_error_message="This world has a campaign of that name.",
            )
        ]

    def __str__(self) -> str:
        return self.name

    @property
    def ended_at(self) -> datetime | None:
        """When it was closed, or its time was up; None before. How much was submitted is not looked at."""
        now = timezone.now()
        ends = [each for each in (self.closed_at, self.ends_at) if each is not None and each <= now]
        return min(ends, default=None)

    @property
    def is_over(self) -> bool:
        """Whether nobody can begin any more."""
        return self.ended_at is not None

    @property
    def checks(self) -> int:
        """How many planted checks a task has."""
        return self.task_size // self.check_every if self.check_every else 0

    @property
    def expected_minutes(self) -> int:
        """About how long a task takes."""
        places = self.task_size + self.checks + self.free_commands
        return self.minutes or max(1, round(places * SECONDS_FOR_A_PLACE / 60))

    @property
    def grace_ends_at(self) -> datetime | None:
        """Until when those who have begun may finish; None while it is open."""
        return None if self.ended_at is None else self.ended_at + GRACE

    @property
    def is_locked(self) -> bool:
        """Whether nobody can write any more, also of those who have begun."""
        return self.grace_ends_at is not None and self.grace_ends_at <= timezone.now()


class CampaignPrompt(models.Model):
    """A grounded command that contributors rewrite.

    ``logical_form`` is canonical and anonymized, ``grounded_form`` the same with the entities of ``prompt``; ``line``
    is the pattern of the template that gave it.
    ``shown`` is what contributors read. ``entities`` are what a rewrite has to keep: rows of
    ``{"text", "aliases", "is_described"}``. ``check_words`` are the words that a planted check asks for; it has
    no form.
    """

    campaign = models.ForeignKey(Campaign, on_delete=models.CASCADE, related_name="prompts")
    command = models.ForeignKey(
        "annotations.Command",
        null=True,
        blank=True,
        on_delete=models.SET_NULL,
        related_name="campaign_prompts",
    )
    command_text = models.TextField(blank=True)
    task_category = models.CharField(max_length=60, blank=True)
    logical_form = models.TextField(blank=True)
    prompt = models.TextField()
    grounded_form = models.TextField(blank=True)
    line = models.TextField(blank=True, default="", db_default="")
    shown = models.TextField()
    entities = models.JSONField(default=list, blank=True)
    check_words = models.CharField(max_length=100, blank=True)
    position = models.PositiveIntegerField()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["campaign", "position"], name="campaign_prompt_place")
        ]

    def __str__(self) -> str:
        return self.prompt


class ContributorQuerySet(models.QuerySet["Contributor"]):
    def counted(self) -> ContributorQuerySet:
        """Return each with the number of their ``answers``, and of those that are ``flagged``."""
        answered = Submission.objects.answered()
        return self.annotate(
            answers=count_of(answered, "contributor"),
            flagged=count_of(answered.exclude(flags=[]), "contributor"),
        )


class Contributor(models.Model):
    """Somebody who does a task of a campaign, known by a pseudonym alone.

    ``pseudonym`` is a keyed hash of the device or of a crowd market's id; ``attempt`` counts from 1 where a
    campaign allows to begin again. ``had_model_help`` is what they said at the end, None before. ``settings``
    are those of a model: its name, the version of the instructions, temperature and seed; of somebody in a file
    of results, ``assignment`` is a keyed hash by which what they did is not imported twice. ``saves`` counts what was
    saved in the minute that began at ``saves_since``.
    """

    campaign = models.ForeignKey(Campaign, on_delete=models.CASCADE, related_name="contributors")
    kind = models.CharField(
        max_length=8, choices=contributor_kind_choices, default=ContributorKind.PERSON
    )
    pseudonym = models.CharField(max_length=LONGEST_PSEUDONYM)
    attempt = models.PositiveSmallIntegerField(default=1)
    consented_at = models.DateTimeField(null=True, blank=True)
    had_model_help = models.BooleanField(null=True, blank=True)
    settings = models.JSONField(default=dict, blank=True)
    began_at = models.DateTimeField(default=timezone.now)
    finished_at = models.DateTimeField(null=True, blank=True)
    saves = models.PositiveIntegerField(default=0)
    saves_since = models.DateTimeField(null=True, blank=True)

    objects = ContributorQuerySet.as_manager()

    class Meta:
        ordering = ["id"]
        constraints = [
            models.UniqueConstraint(
                fields=["campaign", "pseudonym", "attempt"], name="contributor_once"
            )
        ]
        indexes = [
            models.Index(fields=["campaign", "began_at"]),
            models.Index(fields=["campaign", "kind"], name="contributors_of_kind"),
        ]

    def __str__(self) -> str:
        return self.pseudonym

    @property
    def is_finished(self) -> bool:
        return self.finished_at is not None


class SubmissionQuerySet(models.QuerySet["Submission"]):
    def answered(self) -> SubmissionQuerySet:
        return self.exclude(text="")

    def awaiting_moderation(self) -> SubmissionQuerySet:
        """Return what was answered and nobody has decided about; checks need no decision."""
        return (
            self.answered()
            .filter(status=SubmissionStatus.PENDING)
            .exclude(kind=SubmissionKind.CHECK)
        )


class Submission(models.Model):
    """One place of a contributor's task, and what they wrote there; ``text`` is empty until then.

    ``raw`` is the reply of a model that the text was read from. ``browser`` is the one that it was written in: a random
    number, without which nobody is shown the text on a public page. ``seconds`` is how long the prompt was looked
    at. ``flags`` are rows of ``{"code", "evidence"}``; ``read_by_run`` is the number of the run that was last asked
    what the text means. What was accepted is a ``paraphrase``, or, as a free command, an ``utterance``.
    """

    contributor = models.ForeignKey(
        Contributor, on_delete=models.CASCADE, related_name="submissions"
    )
    position = models.PositiveIntegerField()
    kind = models.CharField(
        max_length=8, choices=submission_kind_choices, default=SubmissionKind.REWRITE
    )
    prompt = models.ForeignKey(
        CampaignPrompt, null=True, blank=True, on_delete=models.CASCADE, related_name="submissions"
    )
    text = models.TextField(blank=True)
    raw = models.TextField(blank=True)
    browser = models.CharField(max_length=32, blank=True, default="", db_default="")
    seconds = models.FloatField(null=True, blank=True)
    was_pasted = models.BooleanField(default=False)
    flags = models.JSONField(default=list, blank=True)
    read_by_run = models.PositiveBigIntegerField(null=True, blank=True)
    given_at = models.DateTimeField(default=timezone.now)
    answered_at = models.DateTimeField(null=True, blank=True)
    status = models.CharField(
        max_length=10, choices=submission_status_choices, default=SubmissionStatus.PENDING
    )
    decided_by = models.ForeignKey(
        User, null=True, blank=True, on_delete=models.SET_NULL, related_name="moderated_submissions"
    )
    decided_at = models.DateTimeField(null=True, blank=True)
    paraphrase = models.OneToOneField(
        "annotations.Paraphrase",
        null=True,
        blank=True,
        on_delete=models.SET_NULL,
        related_name="submission",
    )
    utterance = models.OneToOneField(
        "annotations.Utterance",
        null=True,
        blank=True,
        on_delete=models.SET_NULL,
        related_name="submission",
    )

    objects = SubmissionQuerySet.as_manager()

    class Meta:
        ordering = ["contributor", "position"]
        constraints = [
            models.UniqueConstraint(fields=["contributor", "position"], name="submission_place")
        ]
        indexes = [
            models.Index(fields=["prompt", "given_at"]),
            models.Index(fields=["status", "id"]),
        ]

    def __str__(self) -> str:
        return self.text or f"place {self.position}"
