"""A language model as a contributor of a campaign, for programs."""

from __future__ import annotations

from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework.response import Response

from annotations.models import Campaign, Duty
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import WorldRoute
from annotations.web.worlds.job_rest import JobSerializer, accepted
from parser_service.labelling.model_contributor import request_paraphrases
from parser_service.web.labelling.model_forms import (
    ModelForm,
)


class NewModelRewrites(FormFields):
    """Which model is asked for rewrites, and with what."""

    class Meta:
        form = ModelForm
        fields = tuple(ModelForm.base_fields)
        begins = True


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
