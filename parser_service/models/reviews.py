"""What reviewers say about wrong answers. ``parser_service.reviews`` alone writes these rows."""

from __future__ import annotations

from django.db import models
from django.db.models.functions import Lower
from django.utils import timezone

from annotations.models import Example, User, World
from parser_service.models.runs import TrainingRun

LONGEST_SLICE_NAME = 80


class Slice(models.Model):
    """A saved filter over predictions. ``query`` is the filter as a page's address has it."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="slices")
    name = models.CharField(max_length=LONGEST_SLICE_NAME)
    query = models.TextField(blank=True)
    created_by = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)
    created_at = models.DateTimeField(default=timezone.now)

    class Meta:
        ordering = ["name"]
        constraints = [models.UniqueConstraint(fields=["world", "name"], name="slice_name")]

    def __str__(self) -> str:
        return self.name


class ErrorCategory(models.Model):
    """A kind of error. Those with a ``code`` of ``parser_service.analysis`` are proposed by
    the machine; every one of them can be proposed by its ``slice``, to all errors in it."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="error_categories")
    code = models.SlugField(max_length=40)
    name = models.CharField(max_length=60)
    description = models.CharField(max_length=300, blank=True)
    position = models.PositiveSmallIntegerField()
    slice = models.ForeignKey(
        Slice, null=True, blank=True, on_delete=models.SET_NULL, related_name="error_categories"
    )

    class Meta:
        ordering = ["position", "id"]
        constraints = [
            models.UniqueConstraint(fields=["world", "code"], name="error_category_code"),
            models.UniqueConstraint("world", Lower("name"), name="error_category_name"),
        ]

    def __str__(self) -> str:
        return self.name


class ReviewQuerySet(models.QuerySet["Review"]):
    def by_people(self) -> ReviewQuerySet:
        return self.filter(is_proposed=False)

    def proposed(self) -> ReviewQuerySet:
        """Return the machine's proposals."""
        return self.filter(is_proposed=True)


class Review(models.Model):
    """Why the first answer of a run to an example is wrong, as one reviewer or the machine says.

    ``answer`` is the form that was reviewed, so that a later answer is not taken for it. A proposal has no
    reviewer and says in ``reason`` what it goes by; ``category`` is None for a note alone. ``is_new`` of a
    proposal says whether no earlier run of the same parser was wrong there; None where there is no earlier
    run, and in reviews of people.
    """

    run = models.ForeignKey(TrainingRun, on_delete=models.CASCADE, related_name="reviews")
    example = models.ForeignKey(Example, on_delete=models.CASCADE, related_name="reviews")
    category = models.ForeignKey(
        ErrorCategory, null=True, blank=True, on_delete=models.CASCADE, related_name="reviews"
    )
    reviewer = models.ForeignKey(
        User, null=True, blank=True, on_delete=models.SET_NULL, related_name="reviews"
    )
    is_proposed = models.BooleanField(default=False)
    is_new = models.BooleanField(null=True, blank=True)
    answer = models.TextField(blank=True)
    note = models.TextField(blank=True)
    reason = models.TextField(blank=True)
    created_at = models.DateTimeField(default=timezone.now)
    changed_at = models.DateTimeField(auto_now=True)

    objects = ReviewQuerySet.as_manager()

    class Meta:
        ordering = ["id"]
        constraints = [
            models.UniqueConstraint(
                fields=["run", "example", "reviewer"],
                condition=models.Q(is_proposed=False),
                name="one_review_of_each_reviewer",
            ),
            models.UniqueConstraint(
                fields=["run", "example"],
                condition=models.Q(is_proposed=True),
                name="one_proposed_review",
            ),
        ]
        indexes = [models.Index(fields=["run", "is_proposed", "category"])]

    def __str__(self) -> str:
        return f"{self.category or 'note'} by {self.reviewer or 'the machine'}"
