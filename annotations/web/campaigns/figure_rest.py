"""Figures of paraphrases, for programs."""

from __future__ import annotations

from typing import Any

from django.core.exceptions import ObjectDoesNotExist
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.exceptions import ValidationError
from rest_framework.response import Response

from annotations.campaigns.contributor_figures import ContributorFigures, contributors_of
from annotations.campaigns.paraphrase_figures import (
    EDIT_BINS,
    JACCARD_BINS,
    MOST_WANTED,
    ParaphraseFigures,
    ParaphrasesBy,
    figures_of,
    form_counts,
    target_of,
)
from annotations.models import Campaign, Contributor, Duty, Paraphrase, Scope
from annotations.web.rest.fields import Fields
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import Figures

MOST_ROWS = 1_000  # of an answer
CAMPAIGN = OpenApiParameter("campaign", OpenApiTypes.INT, description="Those of a campaign alone.")
TARGET = OpenApiParameter("target", OpenApiTypes.INT, description="Paraphrases per form.")


class PointSerializer(serializers.Serializer[Any]):
    paraphrases = serializers.IntegerField()
    words = serializers.IntegerField()


class ParaphrasesBySerializer(serializers.Serializer[Any]):
    """The paraphrases of people, or of models. ``edits`` and ``jaccard`` are means, null without any; their counts
    go with ``edit_bins`` and ``jaccard_bins``. ``words`` are different ones; ``sample_words`` how many ``sample``
    paraphrases have on average, null where one side has none. ``growth`` is in order of arrival."""

    count = serializers.IntegerField()
    edits = serializers.FloatField(allow_null=True)
    jaccard = serializers.FloatField(allow_null=True)
    edit_counts = serializers.ListField(child=serializers.IntegerField())
    jaccard_counts = serializers.ListField(child=serializers.IntegerField())
    words = serializers.IntegerField()
    sample_words = serializers.FloatField(allow_null=True)
    growth = PointSerializer(many=True)


class PublishedMeansSerializer(serializers.Serializer[Any]):
    """Means of the corpus of the paper."""

    count = serializers.IntegerField()
    edits = serializers.FloatField()
    jaccard = serializers.FloatField()


class CategoryCountSerializer(serializers.Serializer[Any]):
    """Paraphrases of the forms of a task category; ``short`` of its forms have fewer than the target."""

    name = serializers.CharField()
    forms = serializers.IntegerField()
    short = serializers.IntegerField()
    people = serializers.IntegerField()
    models = serializers.IntegerField()


class ParaphraseFiguresSerializer(serializers.Serializer[Any]):
    """Figures of the accepted paraphrases. Bins are given by where they start; the last of ``edit_bins`` is open."""

    people = ParaphrasesBySerializer()
    models = ParaphrasesBySerializer()
    published = PublishedMeansSerializer()
    categories = CategoryCountSerializer(many=True)
    target = serializers.IntegerField()
    sample = serializers.IntegerField()
    edit_bins = serializers.ListField(child=serializers.FloatField())
    jaccard_bins = serializers.ListField(child=serializers.FloatField())


class FormCountSerializer(serializers.Serializer[Any]):
    """The accepted paraphrases of a form, and how many it ``lacks`` of the target."""

    form = serializers.CharField()
    task_category = serializers.CharField()
    people = serializers.IntegerField()
    models = serializers.IntegerField()
    lacks = serializers.IntegerField()


class FormCountsSerializer(serializers.Serializer[Any]):
    """``count`` forms, the first of which are in ``results``: those that lack most."""

    count = serializers.IntegerField()
    target = serializers.IntegerField()
    results = FormCountSerializer(many=True)


class PaceSerializer(serializers.Serializer[Any]):
    """Seconds a rewrite: the median and the quartiles around it."""

    lower = serializers.FloatField()
    median = serializers.FloatField()
    upper = serializers.FloatField()


class ContributorCountSerializer(serializers.Serializer[Any]):
    """What a contributor has answered. ``acceptance`` is that of those decided, with its 95 % ``interval``; null
    before a decision. ``pace`` is null where nobody measured it."""

    id = serializers.IntegerField(source="contributor.pk")
    pseudonym = serializers.CharField(source="contributor.pseudonym")
    kind = serializers.CharField(source="contributor.kind")
    campaign = serializers.IntegerField(source="contributor.campaign_id")
    answers = serializers.IntegerField()
    flagged = serializers.IntegerField()
    accepted = serializers.IntegerField()
    decided = serializers.IntegerField()
    acceptance = serializers.FloatField(allow_null=True)
    interval = serializers.ListField(child=serializers.FloatField(), allow_null=True)
    pace = PaceSerializer(allow_null=True)


class ContributorCountsSerializer(serializers.Serializer[Any]):
    """``count`` contributors, the first of which are in ``results``: those flagged most."""

    count = serializers.IntegerField()
    results = ContributorCountSerializer(many=True)


class CampaignQuery(Fields):
    campaign = serializers.IntegerField(min_value=1, max_value=2**63 - 1, default=None)


class FormCountQuery(CampaignQuery):
    target = serializers.IntegerField(min_value=1, max_value=MOST_WANTED, default=None)


class OfCampaign(Figures):
    """What may be narrowed to a campaign."""

    query: type[CampaignQuery] = CampaignQuery

    def asked(self) -> dict[str, Any]:
        """Return the parameters of the address, ``campaign`` as its row. Raises ValidationError."""
        sent = self.query(data=self.request.query_params)
        sent.is_valid(raise_exception=True)
        asked = dict(sent.validated_data)
        try:
            key = asked["campaign"]
            asked["campaign"] = key and self.world.campaigns.get(pk=key)
        except ObjectDoesNotExist:
            raise ValidationError({"campaign": ["There is no such campaign."]}) from None
        return asked


class FiguresOfWorld(OfCampaign):
    """Shows how many paraphrases there are, their distances and their vocabulary, people and models apart."""

    model = Paraphrase

    @extend_schema(
        operation_id="paraphrase_figures",
        parameters=[CAMPAIGN],
        responses={200: ParaphraseFiguresSerializer},
    )
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        figures = figures_of(self.world, self.asked()["campaign"])
        return Response(ParaphraseFiguresSerializer(_as_shown(figures)).data)


class FormCounts(OfCampaign):
    """Lists the forms with their paraphrases, those that lack most first."""

    model = Campaign
    query = FormCountQuery

    @extend_schema(
        operation_id="paraphrase_forms",
        parameters=[CAMPAIGN, TARGET],
        responses={200: FormCountsSerializer},
    )
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        asked = self.asked()
        target = asked["target"] or target_of(asked["campaign"])
        rows = form_counts(self.world, asked["campaign"], target)
        answer = {"count": len(rows), "target": target, "results": rows[:MOST_ROWS]}
        return Response(FormCountsSerializer(answer).data)


class ContributorCounts(OfCampaign):
    """Lists who has contributed, by pseudonyms, with pace, acceptance and flags."""

    model = Contributor
    duties = {"GET": Duty.REVIEW}
    scopes = {"GET": Scope.READ}

    @extend_schema(
        operation_id="paraphrase_contributors",
        parameters=[CAMPAIGN],
        responses={200: ContributorCountsSerializer},
    )
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        rows: list[ContributorFigures] = contributors_of(self.world, self.asked()["campaign"])
        answer = {"count": len(rows), "results": rows[:MOST_ROWS]}
        return Response(ContributorCountsSerializer(answer).data)


def _as_shown(figures: ParaphraseFigures) -> dict[str, Any]:
    return {
        **{
            name: getattr(figures, name) for name in ("published", "categories", "target", "sample")
        },
        "people": _side(figures, figures.people),
        "models": _side(figures, figures.models),
        "edit_bins": EDIT_BINS.starts,
        "jaccard_bins": JACCARD_BINS.starts,
    }


def _side(figures: ParaphraseFigures, side: ParaphrasesBy) -> dict[str, Any]:
    """Return one side with the growth of its vocabulary at some points alone."""
    names = ("count", "edits", "jaccard", "edit_counts", "jaccard_counts", "words", "sample_words")
    growth = [
        {"paraphrases": at, "words": side.growth[at - 1]}
        for at in figures.growth_at
        if at <= side.count
    ]
    return {**{name: getattr(side, name) for name in names}, "growth": growth}
