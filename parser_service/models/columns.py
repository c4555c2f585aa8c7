"""Answers and examples as compressed columns, so that a page can count a million of them. ``parser_service.results``
alone writes these rows; they can be made again from the predictions and examples that they copy."""

from __future__ import annotations

from django.db import models

from annotations.models import Split
from annotations.models.splits import part_choices
from parser_service.models.runs import TrainingRun


class ExampleColumns(models.Model):
    """The examples of one part of a split, in the order of their keys. ``data`` is NumPy's archive of arrays."""

    split = models.ForeignKey(Split, on_delete=models.CASCADE, related_name="columns")
    part = models.CharField(max_length=12, choices=part_choices)
    data = models.BinaryField()

    class Meta:
        ordering = ["split", "part"]
        constraints = [
            models.UniqueConstraint(fields=["split", "part"], name="example_columns_once")
        ]

    def __str__(self) -> str:
        return f"columns of the {self.part} part of split {self.split_id}"


class AnswerColumns(models.Model):
    """The first answers of a run to the same examples, in the same order."""

    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="columns")
    part = models.CharField(max_length=12, choices=part_choices)
    data = models.BinaryField()

    class Meta:
        ordering = ["run", "part"]
        constraints = [models.UniqueConstraint(fields=["run", "part"], name="answer_columns_once")]

    def __str__(self) -> str:
        return f"columns of run {self.run_id} on {self.part}"
