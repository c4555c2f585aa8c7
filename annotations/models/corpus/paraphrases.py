"""How people say commands."""

from __future__ import annotations

from django.db import models

from annotations.models.corpus.commands import Command
from annotations.models.editing import Editable
from annotations.models.worlds import World


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
    empty otherwise. Distances are to the prompt:
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
    position = models.PositiveIntegerField()

    objects = ParaphraseQuerySet.as_manager()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["world", "position"], name="paraphrase_position")
        ]

    def __str__(self) -> str:
        return self.utterance
