"""Campaigns, who contributes to them, and what they submit. People are known by pseudonyms alone."""

from __future__ import annotations

from collections.abc import Callable
from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from django.http import StreamingHttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.campaigns.campaign_files import MOST_TASKS, accepted_triples, task_file
from annotations.campaigns.changing import (
    ABOUT,
    CHANGEABLE,
    END,
    MARKET,
    TEXTS,
    change_campaign,
)
from annotations.campaigns.closing import close, forget, renew_link, reopen, revoke_link
from annotations.campaigns.crowd_jobs import start_results_import
from annotations.campaigns.launching_job import start_launch
from annotations.campaigns.progress import progress_of
from annotations.exchange.split_export import SplitFormat
from annotations.language.texts import ENCODINGS
from annotations.models import Campaign, Contributor, Duty, Job, Scope
from annotations.models.campaigns import (
    LONGEST_CAMPAIGN_NAME,
    Balance,
    balance_choices,
)
from annotations.people.allowances import may_take_long, takes_files
from annotations.people.audit_log import note
from annotations.web.campaigns.campaign_forms import (
    CampaignChangeForm,
    CampaignFilters,
    CampaignForm,
    ContributorQuery,
    ResultsForm,
    values_of,
)
from annotations.web.campaigns.campaign_links import link_of
from annotations.web.rest.fields import LineField
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.idempotency import once
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.parsing import FilesParser
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import RowsViewSet
from annotations.web.rest.streaming import attachment
from annotations.web.worlds.job_rest import JobSerializer, accepted, address_of_job

READ_BY_ADMINS = dict.fromkeys(("list", "retrieve"), Duty.MANAGE)
READ_SCOPES = dict.fromkeys(("list", "retrieve"), Scope.READ)


class CampaignSerializer(serializers.ModelSerializer[Campaign]):
    """A task that people do by a public ``link``, which is empty where it was revoked."""

    link = serializers.SerializerMethodField()
    is_over = serializers.BooleanField()
    grace_ends_at = serializers.DateTimeField(
        allow_null=True, help_text="until when those who have begun may finish"
    )
    people = serializers.IntegerField()
    finished = serializers.IntegerField()
    answers = serializers.IntegerField()
    created_by = serializers.CharField(source="created_by.username", default=None)

    class Meta:
        model = Campaign
        fields = [
            *("id", "name", "link", "is_over", "wording", "balance", "task_size", "free_commands"),
            *("target_per_form", "taboo_words", "check_every", "seed", *CampaignForm.MAY),
            *(*CHANGEABLE, "people", "finished", "answers", "created_by"),
            *("created_at", "closed_at", "grace_ends_at", "version"),
        ]

    def get_link(self, row: Campaign) -> str:
        return link_of(self.context["request"], row)


class OfMarket(FormFields):
    """What a crowd market and its people want to know; nothing of it is needed."""

    class Meta:
        form = CampaignForm
        fields = (*ABOUT, *MARKET)


class NewCampaign(OfMarket):
    """What people are asked. Without ``task_categories`` all commands are drawn from; texts are Markdown."""

    task_categories = serializers.ListField(child=LineField(max_length=60), default=list)
    balance = serializers.ChoiceField(
        choices=balance_choices(),
        default=Balance.FORMS,
        help_text="What gets ``prompts_per_form`` prompts, and equally many contributors.",
    )

    class Meta:
        form = CampaignForm
        fields = (
            *("name", *CampaignForm.TASK, *CampaignForm.WHAT, *CampaignForm.MAY),
            *END,
            *TEXTS,
        )
        begins = True


class CampaignChange(OfMarket):
    """What may be changed after the launch. The consent stays once somebody has agreed to it."""

    class Meta:
        form = CampaignForm
        fields = (*END, *TEXTS)


class TaskQuery(serializers.Serializer[Any]):
    """How many tasks a file has."""

    tasks = serializers.IntegerField(min_value=1, max_value=MOST_TASKS, default=100)


class ImportedResults(serializers.Serializer[Any]):
    """Results of a crowd market: of ``campaign``, or of a new one called ``name``, made of the prompts in the file."""

    file = serializers.FileField(help_text="A table, or a zip archive with one.")
    campaign = serializers.IntegerField(required=False)
    name = serializers.CharField(max_length=LONGEST_CAMPAIGN_NAME, required=False)
    encoding = serializers.ChoiceField(
        choices=list(ENCODINGS), required=False, help_text="Recognised where it is not told."
    )


class CheckedResultsSerializer(serializers.Serializer[Any]):
    """The job that checks the results. Where it waits for an answer, POST to its ``answer/`` or ``cancel/``."""

    job = JobSerializer()


class ProgressOfCampaignSerializer(serializers.Serializer[Any]):
    """How far a campaign is. ``seconds_left`` is until all forms are reached at this rate; null where nothing
    comes in, or nothing is missing. ``cost`` is that of the tasks that were finished; null without a price."""

    forms = serializers.IntegerField()
    reached = serializers.IntegerField()
    missing = serializers.IntegerField()
    rewrites = serializers.IntegerField()
    accepted = serializers.IntegerField()
    waiting = serializers.IntegerField()
    people = serializers.IntegerField()
    finished = serializers.IntegerField()
    per_hour = serializers.FloatField()
    seconds_left = serializers.FloatField(allow_null=True)
    cost = serializers.DecimalField(12, 2, allow_null=True)


class CampaignViewSet(RowsViewSet):
    """The campaigns."""

    model = Campaign
    serializer_class = CampaignSerializer
    filterset_class = CampaignFilters
    STEPS = ("close", "reopen", "revoke_link", "renew_link")
    FILES = ("tasks", "triples")
    CHANGES = ("create", "partial_update", "results", "progress", *FILES, *STEPS)
    duties = {**READ_BY_ADMINS, **dict.fromkeys(CHANGES, Duty.MANAGE)}
    conditional = ("partial_update",)
    scopes = {**READ_SCOPES, **dict.fromkeys(("progress", *FILES), Scope.READ)}
    sorts = {"newest": "-created_at", "name": "name", "id": "pk"}

    def rows(self) -> QuerySet[Campaign]:
        return self.world.campaigns.counted().select_related("created_by", "world")

    @extend_schema(request=NewCampaign, responses={201: CampaignSerializer, 202: JobSerializer})
    @may_take_long
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Launches a campaign: draws its prompts, by a job (202) where that takes long. Then it is open."""
        form = CampaignForm(self.world, self.read(NewCampaign))
        if not form.is_valid():
            raise refusal_of_form(form)
        started = start_launch(self.world, form.values, form.choice, request.user)
        note(request, form.cleaned_data["name"])
        if isinstance(started, Job):
            return accepted(request, started)
        response = self.show(self.rows().get(pk=started.pk), HTTPStatus.CREATED)
        response["Location"] = request.build_absolute_uri(f"{request.path}{started.pk}/")
        return response

    @extend_schema(request=CampaignChange, responses={200: CampaignSerializer})
    def partial_update(self, request: ApiRequest, **kwargs: object) -> Response:
        """Changes texts, end and payment; prompts and the size of a task stay."""
        with self.matching() as row:
            sent = self.read(CampaignChange, partial=True)
            form = CampaignChangeForm(row, {**values_of(row), **sent})
            if not form.is_valid():
                raise refusal_of_form(form)
            changed = change_campaign(row, form.values, row.version)
        if changed:
            note(request, f"{row.name}: {', '.join(changed)}")
        return self.show(self.get_object())

    @extend_schema(responses={200: ProgressOfCampaignSerializer})
    @action(detail=True)
    def progress(self, request: ApiRequest, **kwargs: object) -> Response:
        """Counts what has come in: forms reached, pace, time left, cost."""
        return Response(ProgressOfCampaignSerializer(progress_of(self.get_object())).data)

    @extend_schema(parameters=[TaskQuery], responses={(200, "text/csv"): OpenApiTypes.STR})
    @may_take_long
    @action(detail=True, pagination_class=None, content_negotiation_class=AnyType)
    def tasks(self, request: ApiRequest, **kwargs: object) -> StreamingHttpResponse:
        """Streams a file of tasks for a crowd market, a row each: forms with fewest submissions first."""
        query = TaskQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        row = self.get_object()
        pieces = task_file(row, query.validated_data["tasks"])
        return attachment(pieces, SplitFormat.CSV, f"{self.world.name}-campaign-{row.pk}-tasks.csv")

    @extend_schema(responses={(200, "text/plain"): OpenApiTypes.STR})
    @may_take_long
    @action(detail=True, pagination_class=None, content_negotiation_class=AnyType)
    def triples(self, request: ApiRequest, **kwargs: object) -> StreamingHttpResponse:
        """Streams the accepted rewrites as triples: paraphrase, prompt, grounded form."""
        row = self.get_object()
        pieces = accepted_triples(row)
        name = f"{self.world.name}-campaign-{row.pk}-paraphrasings.txt"
        return attachment(pieces, SplitFormat.TXT, name)

    @extend_schema(
        request={"multipart/form-data": ImportedResults}, responses={202: CheckedResultsSerializer}
    )
    @takes_files
    @action(detail=False, methods=["post"], parser_classes=[FilesParser])
    @once
    def results(self, request: ApiRequest, **kwargs: object) -> Response:
        """Checks the results of a crowd market, by a job that then waits for an answer. Nothing is imported before."""
        form = ResultsForm(self.world, request.data, request.FILES)
        if not form.is_valid():
            raise refusal_of_form(form)
        sent, campaign = form.cleaned_data, form.chosen
        values = campaign, sent["name"], sent["encoding"]
        job = start_results_import(self.world, sent["file"], request.user, *values)
        note(request, sent["name"] or str(campaign))
        location = {"Location": address_of_job(request, job)}
        done = CheckedResultsSerializer({"job": job}).data
        return Response(done, status=HTTPStatus.ACCEPTED, headers=location)

    @extend_schema(request=None, responses={200: CampaignSerializer})
    @action(detail=True, methods=["post"])
    def close(self, request: ApiRequest, **kwargs: object) -> Response:
        """Closes a campaign: nobody can begin any more, and who has begun may finish until ``grace_ends_at``."""
        return self._do(close)

    @extend_schema(request=None, responses={200: CampaignSerializer})
    @action(detail=True, methods=["post"])
    def reopen(self, request: ApiRequest, **kwargs: object) -> Response:
        """Opens a closed campaign again."""
        return self._do(reopen)

    @extend_schema(request=None, responses={200: CampaignSerializer})
    @action(detail=True, methods=["post"], url_path="revoke-link")
    def revoke_link(self, request: ApiRequest, **kwargs: object) -> Response:
        """Lets the link lead nowhere."""
        return self._do(revoke_link)

    @extend_schema(request=None, responses={200: CampaignSerializer})
    @action(detail=True, methods=["post"], url_path="renew-link")
    def renew_link(self, request: ApiRequest, **kwargs: object) -> Response:
        """Makes another link, in place of the one before."""
        return self._do(renew_link)

    def _do(self, verb: Callable[[Campaign], None]) -> Response:
        row = self.get_object()
        verb(row)
        note(self.request, row.name)
        return self.show(self.get_object())


class ContributorSerializer(serializers.ModelSerializer[Contributor]):
    """Somebody who did a task, by a pseudonym; ``settings`` are those of a language model."""

    campaign = serializers.IntegerField(source="campaign_id")
    answers = serializers.IntegerField()
    flagged = serializers.IntegerField()

    class Meta:
        model = Contributor
        fields = [
            *("id", "campaign", "kind", "pseudonym", "attempt", "consented_at"),
            *("had_model_help", "settings", "began_at", "finished_at", "answers", "flagged"),
        ]


class ContributorViewSet(RowsViewSet):
    """Who contributes to the campaigns."""

    model = Contributor
    serializer_class = ContributorSerializer
    filterset_class = ContributorQuery
    duties = {**READ_BY_ADMINS, "forget": Duty.MANAGE}
    scopes = READ_SCOPES
    sorts = {"began": "-began_at", "id": "pk"}

    def rows(self) -> QuerySet[Contributor]:
        return Contributor.objects.filter(campaign__world=self.world).counted()

    @extend_schema(request=None, responses={204: None})
    @action(detail=True, methods=["post"])
    def forget(self, request: ApiRequest, **kwargs: object) -> Response:
        """Deletes a contributor with all that they wrote, because they ask for it."""
        row = self.get_object()
        forget(row)
        note(request, row.campaign.name)
        return Response(status=HTTPStatus.NO_CONTENT)
