"""What reviewers say about the answers of runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import django_filters
from django.db.models import Exists, OuterRef, QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.language.texts import MAX_FORM, Refusal
from annotations.models import Duty, Example, User
from annotations.showing.filtering import Key
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import RowRoute, RowsViewSet
from parser_service.models import Review, TrainingRun
from parser_service.reviews.label_doubts import LONGEST_DOUBT, doubt_label
from parser_service.reviews.tagging import LONGEST_NOTE, accept, tag, take_back_review, write_note
from parser_service.reviews.world_categories import ensure_categories


class ReviewSerializer(serializers.ModelSerializer[Review]):
    """Why an answer is wrong, as one reviewer or the machine says; ``answer`` is what was reviewed."""

    run = serializers.IntegerField(source="run_id")
    example = serializers.IntegerField(source="example_id")
    category = serializers.CharField(source="category.code", default=None, allow_null=True)
    reviewer = serializers.CharField(source="reviewer.username", default=None, allow_null=True)

    class Meta:
        model = Review
        fields = [
            *("id", "run", "example", "category", "note", "answer", "reviewer", "is_proposed"),
            *("is_new", "reason", "created_at", "changed_at"),
        ]


class ReviewQuery(django_filters.FilterSet):
    run = Key("run_id")
    example = Key("example_id")
    category = django_filters.CharFilter("category__code")
    reviewer = django_filters.CharFilter("reviewer__username")

    class Meta:
        model = Review
        fields = ["is_proposed", "is_new"]


class ReviewViewSet(RowsViewSet):
    """What reviewers and the machine say about answers."""

    model = Review
    serializer_class = ReviewSerializer
    filterset_class = ReviewQuery
    sorts = {"id": "pk", "changed": "changed_at"}

    def rows(self) -> QuerySet[Review]:
        # Not by a join, so that a page of them is read in their order, and no further.
        runs = self.world.runs.filter(pk=OuterRef("run"))
        rows = Review.objects.filter(Exists(runs))
        return rows.select_related("category", "reviewer")


@dataclass(frozen=True)
class ReviewedAnswer:
    """The first answer of a run to an example; ``own`` is the caller's review of it."""

    run: TrainingRun
    example: Example
    own: Review | None


class ReviewedAnswerSerializer(serializers.Serializer[Any]):
    """The caller's review of an answer; null where they have said nothing."""

    own = ReviewSerializer(allow_null=True)


class ReviewChange(Fields):
    """``category`` is a code, null to take the tag back; ``accept`` takes what the machine proposes.

    An empty note is removed.
    """

    category = serializers.SlugField(max_length=40, allow_null=True)
    accept = serializers.BooleanField()
    note = serializers.CharField(max_length=LONGEST_NOTE, allow_blank=True)


class AnswerRoute(RowRoute):
    model = Review
    serializer_class = ReviewedAnswerSerializer
    duties = {"PATCH": Duty.REVIEW, "POST": Duty.REVIEW}

    def get_object(self) -> ReviewedAnswer:
        run = get_object_or_404(self.world.runs.all(), pk=self.kwargs["run"])
        examples = Example.objects.select_related("split__world")
        example = get_object_or_404(examples, split=run.split_id, pk=self.kwargs["pk"])
        own = run.reviews.by_people().filter(example=example, reviewer=self.request.user)
        return ReviewedAnswer(run, example, own.select_related("category", "reviewer").first())


class ReviewOfAnswer(AnswerRoute):
    """Shows and changes the caller's review of an answer."""

    conditional = ("PATCH",)

    def hold(self) -> None:
        """Lock the reviewer, since their one review of the answer may not be stored yet."""
        User.objects.select_for_update(no_key=True).get(pk=self.request.user.pk)

    @extend_schema(request=ReviewChange, responses={200: ReviewedAnswerSerializer})
    def patch(self, request: ApiRequest, **kwargs: object) -> Response:
        with self.matching() as answer:
            sent = self.read(ReviewChange, partial=True)
            about = (answer.run, answer.example)
            if sent.get("accept"):
                accept(*about, request.user)
            if sent.get("category"):
                category = ensure_categories(self.world).get(sent["category"])
                if category is None:
                    raise Refusal(
                        f"There is no error category {sent['category']} here.",
                        "unknown_error_category",
                    )
                tag(*about, category, request.user)
            elif "category" in sent:
                take_back_review(*about, request.user)
            if "note" in sent:
                write_note(*about, sent["note"], request.user)
        return self.show(self.get_object())


class DoubtSerializer(Fields):
    """What is wrong with the label, and what it should be, in any notation, if that is known."""

    reason = LineField(max_length=LONGEST_DOUBT)
    right_form = serializers.CharField(max_length=MAX_FORM, default="", allow_blank=True)


class DoubtedSerializer(serializers.Serializer[Any]):
    """What became of it, as a sentence."""

    said = serializers.CharField()


class DoubtLabel(AnswerRoute):
    """Sends the label of an example to the work queue."""

    http_method_names = ["post", "options"]

    @extend_schema(request=DoubtSerializer, responses={200: DoubtedSerializer})
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        example = self.get_object().example
        sent = self.read(DoubtSerializer)
        said = doubt_label(example, sent["reason"], request.user, sent["right_form"])
        return Response({"said": said})
