"""A language model as a contributor of a campaign, for programs."""

from __future__ import annotations

from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.language.corpus import INSTRUCTIONS, LONGEST_INSTRUCTIONS
from annotations.models import Campaign, Duty
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import WorldRoute
from annotations.web.worlds.job_rest import JobSerializer, accepted
from parser_service.labelling.model_contributor import request_paraphrases
from parser_service.parsers.model_server.protocol import MOST_NAME
from parser_service.web.labelling.model_forms import (
    LARGEST_SEED,
    MOST_REQUESTS,
    MOST_WORDINGS,
    ModelForm,
)


class NewModelRewrites(Fields):
    """Which model is asked for rewrites, and with what."""

    model = serializers.CharField(max_length=MOST_NAME)
    wordings = serializers.IntegerField(min_value=1, max_value=MOST_WORDINGS, default=3)
    budget = serializers.IntegerField(min_value=1, max_value=MOST_REQUESTS, default=500)
    temperature = serializers.FloatField(min_value=0, max_value=2, default=0.8)
    seed = serializers.IntegerField(min_value=0, max_value=LARGEST_SEED, default=0)
    instructions = serializers.CharField(
        max_length=LONGEST_INSTRUCTIONS, default=INSTRUCTIONS, trim_whitespace=False
    )


class ModelRewrites(WorldRoute):
    """Lets a language model rewrite the prompts of a campaign."""

    http_method_names = ["post", "options"]
    model = Campaign
    duties = {"POST": Duty.MANAGE}

    @extend_schema(request=NewModelRewrites, responses={202: JobSerializer})
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        campaign = get_object_or_404(self.world.campaigns, pk=self.kwargs["pk"])
        form = ModelForm(self.read(NewModelRewrites))
        if not form.is_valid():
            raise refusal_of_form(form)
        job, _ = request_paraphrases(campaign, form.settings(), request.user)
        return accepted(request, job)
