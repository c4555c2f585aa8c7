"""Frozen splits and their examples."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any, ClassVar

from django.db.models import QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.api.once import once
from annotations.api.problems import refusal_of_form
from annotations.api.reading import Fields
from annotations.api.routes import RowRoute, RowsRoute
from annotations.forms import SplitForm
from annotations.language.corpus import DEFAULT_PROPORTIONS, Criterion
from annotations.lists.filters import ExampleFilters, SplitFilters
from annotations.models import Duty, Example, Split
from annotations.models.splits import criterion_choices
from annotations.splits.freezing import freeze_split
from annotations.splits.renewing import freeze_anew
from annotations.splits.split_statistics import counts_of


class PartCountSerializer(serializers.Serializer):
    """How many pairs of a source each part has, and how many different forms all of them."""

    source = serializers.CharField()
    train = serializers.IntegerField()
    validation = serializers.IntegerField()
    test = serializers.IntegerField()
    forms = serializers.IntegerField()


class SplitSerializer(serializers.ModelSerializer):
    """A copy of texts that nothing changes. ``content_hash`` is the SHA-256 of all its examples."""

    counts = serializers.SerializerMethodField()
    proportions = serializers.ListField(child=serializers.FloatField())
    follows = serializers.IntegerField(source="follows_id", allow_null=True)
    created_by = serializers.CharField(source="created_by.username", default=None)

    class Meta:
        model = Split
        fields = [
            *("id", "name", "criterion", "seed", "proportions", "counts", "content_hash"),
            *("follows", "created_by", "created_at"),
        ]

    def get_counts(self, row: Split) -> PartCountSerializer(many=True):
        counts = self.context["counts"][row.pk]
        return PartCountSerializer(counts, many=True).data


class NewSplit(Fields):
    """``proportions`` are the shares of train, validation and test, which sum to 1."""

    name = serializers.SlugField(max_length=80)
    criterion = serializers.ChoiceField(choices=criterion_choices(), default=Criterion.COMMAND)
    seed = serializers.IntegerField(min_value=0, max_value=2**32 - 1, default=0)
    proportions = serializers.ListField(
        child=serializers.FloatField(min_value=0, max_value=1),
        min_length=3,
        max_length=3,
        default=list(DEFAULT_PROPORTIONS),
    )


class SplitNoun:
    model = Split
    serializer_class = SplitSerializer

    def rows(self) -> QuerySet[Split]:
        return self.world.splits.select_related("created_by", "world")

    def get_serializer(self, rows: Any = None, **options: Any) -> serializers.BaseSerializer[Any]:
        serializer = super().get_serializer(rows, **options)
        if rows is not None:
            serializer.context["counts"] = counts_of(rows if options.get("many") else [rows])
        return serializer


class Splits(SplitNoun, RowsRoute):
    """Lists the splits, and freezes one from the corpus of today."""

    filterset_class = SplitFilters
    sorts = {"created": "-created_at", "name": "name", "id": "pk"}
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.ANNOTATE}

    @extend_schema(request=NewSplit)
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        sent = self.read(NewSplit)
        shares = dict(zip(SplitForm.SHARES, sent.pop("proportions"), strict=True))
        form = SplitForm({**sent, **{part: 100 * share for part, share in shares.items()}})
        if not form.is_valid():
            raise refusal_of_form(form)
        frozen = freeze_split(self.world, sent["name"], by=request.user, **form.choice)
        return frozen_response(self, frozen)


class OneSplit(SplitNoun, RowRoute):
    """Shows a split."""


class RenewSplit(SplitNoun, RowRoute):
    """Freezes a split anew from the corpus of today; the old one stays as it was."""

    http_method_names = ["post", "options"]
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.ANNOTATE}

    @extend_schema(request=None, responses={201: SplitSerializer})
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        return frozen_response(self, freeze_anew(self.get_object(), request.user))


def frozen_response(view: Any, split: Split) -> Response:
    """Answer with a split that was just frozen, and where it is."""
    response = Response(view.get_serializer(split).data, status=HTTPStatus.CREATED)
    path = f"/api/v1/worlds/{view.world.name}/splits/{split.pk}/"
    response["Location"] = view.request.build_absolute_uri(path)
    return response


class ExampleSerializer(serializers.ModelSerializer):
    """An utterance with its form, as it was when the split was frozen."""

    class Meta:
        model = Example
        fields = [
            *("id", "position", "part", "source", "utterance", "source_command"),
            *("task_category", "logical_form", "grounded_form"),
        ]


class Examples(RowsRoute):
    """Lists the examples of a split."""

    model = Example
    serializer_class = ExampleSerializer
    filterset_class = ExampleFilters
    sorts = {"id": "pk", "utterance": "utterance"}

    def rows(self) -> QuerySet[Example]:
        split = get_object_or_404(Split, world=self.world, pk=self.kwargs["pk"])
        return split.examples.all()
