"""Frozen copies of the corpus: a later edit never changes a past result."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

from django.db import models

from annotations.language.forms import depth, head_predicate, read_form
from annotations.language.texts import LanguageError
from annotations.models.people import User
from annotations.models.worlds import World

HEAD_LENGTH = 80  # of the name of a predicate, as in ``LogicalForm``


if TYPE_CHECKING:
    from annotations.language.templates import SampleNote

    PlainField = models.Field[Any, Any]
    PlainIntegerField = models.PositiveIntegerField[Any, Any]
    PlainCharField = models.CharField[Any, Any]
else:  # Django's fields take no type arguments at run time
    PlainField = models.Field
    PlainIntegerField = models.PositiveIntegerField
    PlainCharField = models.CharField


class DerivedField(PlainField):
    """Takes its value from the row's method ``derive_NAME`` whenever the row is written.

    Bulk creation and ``annotations.rows.staging`` write it too; an archive of a world leaves it out.
    """

    is_derived = True

    def pre_save(self, model_instance: models.Model, add: bool) -> Any:
        value = getattr(model_instance, f"derive_{self.attname}")()
        setattr(model_instance, self.attname, value)
        return value

    def deconstruct(self) -> Any:
        """Describe the plain field, since the rows of migrations have no methods."""
        name, _, args, kwargs = super().deconstruct()
        plain = next(each for each in type(self).__mro__ if each.__module__ != __name__)
        return name, f"django.db.models.{plain.__name__}", args, kwargs


class DerivedIntegerField(DerivedField, PlainIntegerField):
    """A derived whole number."""


class DerivedCharField(DerivedField, PlainCharField):
    """A derived text."""


class Source(models.TextChoices):
    """Who said an example: the grammar, somebody who rewrote a command, a language model that rewrote one, or
    somebody to whom no command was shown."""

    GENERATED = "generated"
    PARAPHRASED = "paraphrased"
    MODEL = "model"
    SAID = "said"


def criterion_choices() -> list[tuple[str, str]]:
    from annotations.language.corpus import Criterion

    return [(each.value, each.replace("_", " ").title()) for each in Criterion]


def part_choices() -> list[tuple[str, str]]:
    from annotations.language.corpus import Part

    return [(each.value, each.title()) for each in Part]


def source_choices() -> list[tuple[str, str]]:
    return Source.choices


class SplitQuerySet(models.QuerySet["Split"]):
    def named(self, name: str, criterion: str = "command") -> Split | None:
        """Return the split ``name``, or ``name-criterion`` where one name stands for several criteria."""
        splits = {
            split.name: split for split in self.filter(name__in=[name, f"{name}-{criterion}"])
        }
        return splits.get(name) or splits.get(f"{name}-{criterion}")


class Split(models.Model):
    """``content_hash`` is the SHA-256 of all examples; ``seed`` is null for an imported split.

    ``proportions`` are the shares of train, validation and test that were asked for, fractions of 1; empty
    where nobody asked for any. ``tests_on_models`` says that what language models wrote is in validation and test
    too. ``sample`` is a ``SampleNote`` as JSON where the commands were a sample then, else empty. ``follows`` is
    the split that this one freezes anew. ``figures`` say as JSON what the parts hold and share
    (``annotations.generation.split_statistics``).
    """

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="splits")
    name = models.SlugField(max_length=80)
    criterion = models.CharField(max_length=20, choices=criterion_choices)
    seed = models.PositiveBigIntegerField(null=True, blank=True)
    proportions = models.JSONField(default=list, blank=True)
    tests_on_models = models.BooleanField(default=False, db_default=False)
    sample = models.JSONField(default=dict, blank=True, editable=False)
    follows = models.ForeignKey(
        "self", null=True, blank=True, on_delete=models.SET_NULL, related_name="followed_by"
    )
    content_hash = models.CharField(max_length=64)
    figures = models.JSONField(default=dict, blank=True, editable=False)
    created_by = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)
    created_at = models.DateTimeField(auto_now_add=True)

    objects = SplitQuerySet.as_manager()

    class Meta:
        ordering = ["-created_at", "-id"]
        constraints = [models.UniqueConstraint(fields=["world", "name"], name="split_name")]

    def __str__(self) -> str:
        return self.name

    @property
    def sample_note(self) -> SampleNote | None:
        """What to say of the commands; None where they were all that the templates made."""
        from annotations.language.templates import SampleNote

        return SampleNote.from_json(self.sample)


class ExampleQuerySet(models.QuerySet["Example"]):
    def of(self, part: str, source: str | None = None) -> ExampleQuerySet:
        chosen = self.filter(part=part)
        return chosen.filter(source=source) if source else chosen


class Example(models.Model):
    """An utterance with its form (canonical corpus text), at its ``position`` in the part's file.

    ``written_form`` is the form as the file wrote it where that is not the canonical text, so that an
    export gives the file back. ``head_predicate`` (``UNKNOWN`` for a form without any) and ``depth`` are
    those of the form, empty and 0 for a text that is no form; ``word_count`` counts what spaces separate.
    """

    split = models.ForeignKey(Split, on_delete=models.CASCADE, related_name="examples")
    position = models.PositiveIntegerField()
    part = models.CharField(max_length=12, choices=part_choices)
    source = models.CharField(max_length=12, choices=source_choices)
    utterance = models.TextField()
    source_command = models.TextField(blank=True)
    task_category = models.CharField(max_length=60, blank=True)
    logical_form = models.TextField()
    written_form = models.TextField(blank=True)
    grounded_form = models.TextField(blank=True)
    head_predicate = DerivedCharField(
        max_length=HEAD_LENGTH, blank=True, default="", editable=False
    )
    depth = DerivedIntegerField(default=0, editable=False)
    word_count = DerivedIntegerField(default=0, editable=False)

    objects = ExampleQuerySet.as_manager()

    class Meta:
        ordering = ["source", "part", "position"]
        constraints = [
            models.UniqueConstraint(
                fields=["split", "source", "part", "position"], name="example_position"
            )
        ]

    def __str__(self) -> str:
        return self.utterance

    def derive_head_predicate(self) -> str:
        return shape_of(self.logical_form)[0]

    def derive_depth(self) -> int:
        return shape_of(self.logical_form)[1]

    def derive_word_count(self) -> int:
        return len(self.utterance.split())


@lru_cache(maxsize=4096)
def shape_of(text: str) -> tuple[str, int]:
    """Return the head predicate and the depth of a form; ``("", 0)`` for a text that is no form."""
    try:
        form = read_form(text)
    except LanguageError:
        return "", 0
    return head_predicate(form)[:HEAD_LENGTH], depth(form)
