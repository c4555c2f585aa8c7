"""What a worker finds out about the answers of a run. ``parser_service.reviews`` alone writes these rows."""

from __future__ import annotations

from django.db import models
from django.utils import timezone

from annotations.models import Example
from annotations.models.short_texts import ShortTextField
from annotations.models.splits import part_choices
from parser_service.models.runs import TrainingRun


class Expectation(models.TextChoices):
    """What a probe must be answered with; nothing is known to be right for an open one."""

    SAME = "same", "the form of its base"
    CHANGED = "changed", "another form, as the grammar says"
    UNKNOWN = "unknown", "UNKNOWN"
    OPEN = "open", "not known"


def expectation_choices() -> list[tuple[str, str]]:
    return Expectation.choices


class RunAnalysis(models.Model):
    """The analyses of one run on one part that are too slow for a page, as JSON.

    ``findings`` maps the name of an analysis to its plain values; ``version`` is that of the code which made
    them, so that older ones are made again.
    """

    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="analyses")
    part = models.CharField(max_length=12, choices=part_choices)
    version = models.PositiveSmallIntegerField()
    findings = models.JSONField(default=dict)
    made_at = models.DateTimeField(default=timezone.now)

    class Meta:
        ordering = ["run", "part"]
        constraints = [models.UniqueConstraint(fields=["run", "part"], name="analysed_once")]

    def __str__(self) -> str:
        return f"analysis of run {self.run_id} on {self.part}"


class Probe(models.Model):
    """A text that a run is asked beyond the examples of its split.

    ``kind`` is a ``ProbeKind`` of ``parser_service.analysis.probe_texts``, or an ``EditKind`` of
    ``parser_service.analysis.edit``: then ``old`` words of its ``base`` are replaced by ``new`` ones.
    ``expected_form`` is canonical corpus text, empty for an open probe.
    """

    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="probes")
    position = models.PositiveIntegerField()
    kind = models.CharField(max_length=20)
    base = models.ForeignKey(
        Example, null=True, blank=True, on_delete=models.CASCADE, related_name="probes"
    )
    utterance = models.TextField(blank=True)
    old = ShortTextField(max_length=300, blank=True)
    new = ShortTextField(max_length=300, blank=True)
    expectation = models.CharField(max_length=8, choices=expectation_choices)
    expected_form = models.TextField(blank=True)

    class Meta:
        ordering = ["position"]
        constraints = [models.UniqueConstraint(fields=["run", "position"], name="probe_position")]
        indexes = [models.Index(fields=["run", "kind"])]

    def __str__(self) -> str:
        return self.utterance


class ProbeAnswer(models.Model):
    """The first answer of the probe's run. ``is_expected`` is None for an open probe."""

    probe = models.OneToOneField(Probe, on_delete=models.CASCADE, related_name="answer")
    logical_form = models.TextField(blank=True)
    score = models.FloatField()
    is_expected = models.BooleanField(null=True)

    class Meta:
        ordering = ["probe"]

    def __str__(self) -> str:
        return self.logical_form
