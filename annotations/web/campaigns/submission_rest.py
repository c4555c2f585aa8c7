"""What contributors have submitted, with pseudonyms alone, and deciding about it."""

from __future__ import annotations

from typing import Any

from django.db.models import Exists, OuterRef, QuerySet
from django.http import StreamingHttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.campaigns.campaign_files import submission_table
from annotations.campaigns.moderation import (
    MOST_AT_ONCE,
    accept,
    accept_with_doubt,
    accept_with_form,
    mend,
    reject,
    take_back_moderation,
)
from annotations.exchange.split_export import SplitFormat
from annotations.language.texts import MAX_FORM
from annotations.models import Contributor, Duty, Scope, Submission
from annotations.models.campaigns import SubmissionKind
from annotations.models.corpus import MOST_CHARACTERS
from annotations.models.queueing import LONGEST_REASON
from annotations.people.allowances import may_take_long
from annotations.showing.paging import LARGEST_INTEGER
from annotations.web.campaigns.submission_filters import SubmissionFilters
from annotations.web.rest.fields import Fields
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import RowsViewSet
from annotations.web.rest.streaming import attachment

DECISIONS = {"accept": accept, "reject": reject}


class SubmissionSerializer(serializers.ModelSerializer[Submission]):
    """What a contributor wrote: ``prompt`` is what they read, empty for a command of their own."""

    campaign = serializers.CharField(source="contributor.campaign.name")
    contributor = serializers.CharField(source="contributor.pseudonym")
    by = serializers.CharField(source="contributor.kind")
    prompt = serializers.CharField(source="prompt.shown", default="")
    logical_form = serializers.CharField(source="prompt.logical_form", default="")
    grounded_form = serializers.CharField(source="prompt.grounded_form", default="")
    paraphrase = serializers.IntegerField(source="paraphrase_id", allow_null=True)
    utterance = serializers.IntegerField(source="utterance_id", allow_null=True)

    class Meta:
        model = Submission
        fields = [
            *(
                "id",
                "campaign",
                "contributor",
                "by",
                "kind",
                "prompt",
                "text",
                "raw",
                "logical_form",
            ),
            *("grounded_form", "flags", "seconds", "was_pasted", "answered_at", "status"),
            *("decided_at", "paraphrase", "utterance"),
        ]


class NewDecisions(Fields):
    """What becomes of some submissions. Those about which somebody has decided are left as they are."""

    ids = serializers.ListField(
        child=serializers.IntegerField(min_value=1, max_value=LARGEST_INTEGER),
        min_length=1,
        max_length=MOST_AT_ONCE,
    )
    decision = serializers.ChoiceField(choices=sorted(DECISIONS))


class DecidedSerializer(serializers.Serializer[Any]):
    """How many submissions were decided about."""

    decided = serializers.IntegerField()


class MendedText(Fields):
    """The text without its typing errors."""

    text = serializers.CharField(max_length=MOST_CHARACTERS)


class OtherForm(Fields):
    """The form of what a rewrite asks for, with class tokens, in any notation."""

    form = serializers.CharField(max_length=MAX_FORM)


class DoubtedLabel(Fields):
    """What a rewrite may mean instead."""

    reason = serializers.CharField(max_length=LONGEST_REASON)


class SubmissionViewSet(RowsViewSet):
    """What contributors have submitted."""

    model = Submission
    serializer_class = SubmissionSerializer
    filterset_class = SubmissionFilters
    duties = dict.fromkeys(
        ("list", "retrieve", "export", "decide", "take_back", "mend", "with_form", "with_doubt"),
        Duty.REVIEW,
    )
    scopes = dict.fromkeys(("list", "retrieve", "export"), Scope.READ)
    sorts = {"id": "pk", "newest": "-pk"}

    def rows(self) -> QuerySet[Submission]:
        theirs = Contributor.objects.filter(pk=OuterRef("contributor"), campaign__world=self.world)
        rows = Submission.objects.filter(Exists(theirs)).answered()
        related = ("contributor__campaign", "prompt")
        return rows.exclude(kind=SubmissionKind.CHECK).select_related(*related)

    @extend_schema(
        operation_id="submissions_export",
        filters=True,
        responses={(200, "text/csv"): OpenApiTypes.STR},
    )
    @may_take_long
    @action(detail=False, pagination_class=None, content_negotiation_class=AnyType)
    def export(self, request: ApiRequest, **kwargs: object) -> StreamingHttpResponse:
        """Streams the submissions that the filters leave as CSV, with pseudonyms alone."""
        pieces = submission_table(self.filter_queryset(self.get_queryset()))
        return attachment(pieces, SplitFormat.CSV, f"{self.world.name}-submissions.csv")

    @extend_schema(request=NewDecisions, responses={200: DecidedSerializer})
    @action(detail=False, methods=["post"])
    def decide(self, request: ApiRequest, **kwargs: object) -> Response:
        """Accepts or rejects submissions that nobody has decided about."""
        sent = self.read(NewDecisions)
        rows = list(self.rows().filter(pk__in=sent["ids"]))
        return Response({"decided": DECISIONS[sent["decision"]](rows, request.user)})

    @extend_schema(request=None, responses={200: SubmissionSerializer})
    @action(detail=True, methods=["post"], url_path="take-back")
    def take_back(self, request: ApiRequest, **kwargs: object) -> Response:
        """Undoes a decision: the submission waits again, and what was made of it goes."""
        take_back_moderation(self.get_object(), request.user)
        return self.show(self.get_object())

    @extend_schema(request=MendedText, responses={200: SubmissionSerializer})
    @action(detail=True, methods=["post"])
    def mend(self, request: ApiRequest, **kwargs: object) -> Response:
        """Corrects a typing error; ``raw`` keeps what was written."""
        mend(self.get_object(), self.read(MendedText)["text"])
        return self.show(self.get_object())

    @extend_schema(request=OtherForm, responses={200: SubmissionSerializer})
    @action(detail=True, methods=["post"], url_path="accept-with-form")
    def with_form(self, request: ApiRequest, **kwargs: object) -> Response:
        """Accepts a rewrite that asks for something else than its prompt, with that form."""
        accept_with_form(self.get_object(), self.read(OtherForm)["form"], request.user)
        return self.show(self.get_object())

    @extend_schema(request=DoubtedLabel, responses={200: SubmissionSerializer})
    @action(detail=True, methods=["post"], url_path="accept-with-doubt")
    def with_doubt(self, request: ApiRequest, **kwargs: object) -> Response:
        """Accepts a rewrite and sends its label to the audit."""
        accept_with_doubt(self.get_object(), self.read(DoubtedLabel)["reason"], request.user)
        return self.show(self.get_object())
