"""Frozen splits and their examples, what leaks between their parts, and what has changed since."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.generation.freezing_job import start_freezing, start_renewal
from annotations.generation.renewing import changes_since
from annotations.generation.split_statistics import figures_of, near_duplicates_of
from annotations.language.corpus import DEFAULT_PROPORTIONS, Criterion
from annotations.models import Duty, Example, Job, Split
from annotations.models.splits import criterion_choices
from annotations.people.allowances import may_take_long
from annotations.web.corpus.split_filters import (
    MOST_CHANGES,
    MOST_SHOWN,
    ExampleFilters,
    SplitFilters,
)
from annotations.web.corpus.split_forms import SplitForm
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import Figures, RowsRoute, RowsViewSet
from annotations.web.rest.samples import SampleNoteSerializer
from annotations.web.worlds.job_rest import JobSerializer, accepted


class PartCountSerializer(serializers.Serializer[Any]):
    """How many pairs of a source each part has, and how many different forms all of them."""

    source = serializers.CharField()  # type: ignore[assignment]  # the name of the column
    train = serializers.IntegerField()
    validation = serializers.IntegerField()
    test = serializers.IntegerField()
    forms = serializers.IntegerField()


class SplitSerializer(serializers.ModelSerializer[Split]):
    """A copy of texts that nothing changes. ``content_hash`` is the SHA-256 of all its examples."""

    counts = serializers.SerializerMethodField()
    proportions = serializers.ListField(child=serializers.FloatField())
    follows = serializers.IntegerField(source="follows_id", allow_null=True)
    created_by = serializers.CharField(source="created_by.username", default=None)
    sample = serializers.SerializerMethodField()

    class Meta:
        model = Split
        fields = [
            *("id", "name", "criterion", "seed", "proportions", "counts", "content_hash"),
            *("tests_on_models", "sample", "follows", "created_by", "created_at"),
        ]

    @extend_schema_field(SampleNoteSerializer(allow_null=True))
    def get_sample(self, row: Split) -> Any:
        return row.sample or None

    @extend_schema_field(PartCountSerializer(many=True))
    def get_counts(self, row: Split) -> Any:
        return PartCountSerializer(figures_of(row).counts, many=True).data


class NewSplit(FormFields):
    """``proportions`` are the shares of train, validation and test, which sum to 1. With ``tests_on_models``
    what language models wrote is in validation and test too."""

    criterion = serializers.ChoiceField(choices=criterion_choices(), default=Criterion.COMMAND)
    proportions = serializers.ListField(
        child=serializers.FloatField(min_value=0, max_value=1),
        min_length=3,
        max_length=3,
        default=list(DEFAULT_PROPORTIONS),
    )

    class Meta:
        form = SplitForm
        fields = ("name", "seed", "tests_on_models")
        begins = True


class SplitViewSet(RowsViewSet):
    """The splits."""

    model = Split
    serializer_class = SplitSerializer
    filterset_class = SplitFilters
    duties = dict.fromkeys(("create", "renew"), Duty.ANNOTATE)
    sorts = {"created": "-created_at", "name": "name", "id": "pk"}

    def rows(self) -> QuerySet[Split]:
        return self.world.splits.select_related("created_by", "world")

    @extend_schema(request=NewSplit, responses={201: SplitSerializer, 202: JobSerializer})
    @may_take_long
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Freezes a split from the corpus of today; where that takes long, the answer is a job (202)."""
        sent = self.read(NewSplit)
        shares = dict(zip(SplitForm.SHARES, sent.pop("proportions"), strict=True))
        form = SplitForm({**sent, **{part: 100 * share for part, share in shares.items()}})
        if not form.is_valid():
            raise refusal_of_form(form)
        chosen = {"name": sent["name"], "must_be_new": True, **form.choice}
        return self._started(start_freezing(self.world, request.user, **chosen))

    @extend_schema(request=None, responses={201: SplitSerializer, 202: JobSerializer})
    @may_take_long
    @action(detail=True, methods=["post"])
    @once
    def renew(self, request: ApiRequest, **kwargs: object) -> Response:
        """Freezes a split anew from the corpus of today; the old one stays as it was."""
        return self._started(start_renewal(self.get_object(), request.user))

    def _started(self, started: Job | Split) -> Response:
        """Answer with a split that was just frozen, or the job that freezes it, and where it is."""
        if isinstance(started, Job):
            return accepted(self.request, started)
        path = f"/api/v1/worlds/{self.world.name}/splits/{started.pk}/"
        location = {"Location": self.request.build_absolute_uri(path)}
        shown = self.get_serializer(started).data
        return Response(shown, status=HTTPStatus.CREATED, headers=location)


class ExampleSerializer(serializers.ModelSerializer[Example]):
    """An utterance with its form, as it was when the split was frozen."""

    class Meta:
        model = Example
        fields = [
            *("id", "position", "part", "source", "utterance", "source_command"),
            *("task_category", "logical_form", "grounded_form"),
        ]


class ExamplesOfSplit(RowsRoute):
    """Lists the examples of a split."""

    model = Example
    serializer_class = ExampleSerializer
    filterset_class = ExampleFilters
    sorts = {"id": "pk", "utterance": "utterance"}

    def rows(self) -> QuerySet[Example]:
        split = get_object_or_404(Split, world=self.world, pk=self.kwargs["pk"])
        return split.examples.all()


class FiguresOfSplit(Figures):
    model = Split

    def rows(self) -> QuerySet[Split]:
        return self.world.splits.select_related("world", "follows")

    def figures(self, make: Callable[[Split], Any]) -> Any:
        """Return figures of the split. LanguageError, where they cannot be made, is a 400."""
        return make(get_object_or_404(self.rows(), pk=self.kwargs["pk"]))


class NearDuplicateSerializer(serializers.Serializer[Any]):
    """An utterance and the closest one of training; ``similarity`` is a fraction of 1."""

    utterance = serializers.CharField()
    training = serializers.CharField()
    similarity = serializers.FloatField()


class NearDuplicatesSerializer(serializers.Serializer[Any]):
    """Of a part: ``shared`` of its ``pairs`` training nearly has; the most similar ones are in ``examples``."""

    part = serializers.CharField(source="leak.part")
    pairs = serializers.IntegerField(source="leak.pairs")
    shared = serializers.IntegerField(source="leak.shared")
    examples = serializers.SerializerMethodField()

    @extend_schema_field(NearDuplicateSerializer(many=True))
    def get_examples(self, each: Any) -> list[dict[str, Any]]:
        return [asdict(one) for one in each.duplicates[:MOST_SHOWN]]


class NearDuplicatesTable(serializers.Serializer[Any]):
    results = NearDuplicatesSerializer(many=True)


class NearDuplicatesOfSplit(FiguresOfSplit):
    """Lists utterances of validation and test that training nearly has."""

    @extend_schema(operation_id="near_duplicates", responses={200: NearDuplicatesTable})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        found = self.figures(near_duplicates_of)
        return Response(NearDuplicatesTable({"results": found}).data)


class PartChangesSerializer(serializers.Serializer[Any]):
    """Examples of one part; ``moved`` ones come from another part."""

    part = serializers.CharField()
    added = serializers.IntegerField()
    removed = serializers.IntegerField()
    relabelled = serializers.IntegerField()
    moved = serializers.IntegerField()


class RelabelledSerializer(serializers.Serializer[Any]):
    """An utterance with its label in the split and that of today."""

    utterance = serializers.CharField()
    part = serializers.CharField()
    before = serializers.CharField()
    now = serializers.CharField()


class SplitChangesSerializer(serializers.Serializer[Any]):
    """What ``renew/`` would change; some of the labels that differ are in ``relabelled``."""

    parts = PartChangesSerializer(many=True)
    relabelled = serializers.SerializerMethodField()

    @extend_schema_field(RelabelledSerializer(many=True))
    def get_relabelled(self, changes: Any) -> list[dict[str, Any]]:
        return [asdict(each) for each in changes.relabelled[:MOST_CHANGES]]


class ChangesOfSplit(FiguresOfSplit):
    """Says what freezing a split anew would change."""

    @extend_schema(operation_id="split_changes", responses={200: SplitChangesSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        return Response(SplitChangesSerializer(self.figures(changes_since)).data)
