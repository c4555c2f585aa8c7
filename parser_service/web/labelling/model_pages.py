"""The page on which a language model is asked to contribute to a campaign."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.language.texts import Refusal
from annotations.models import Duty, JobKind, World
from annotations.models.campaigns import ContributorKind
from annotations.people.access import READ_AND_WRITE, WorldRequest, world_view
from annotations.web.forms import posted
from parser_service.labelling.model_contributor import request_paraphrases
from parser_service.parsers.server_address import problem_of, server
from parser_service.web.labelling.model_forms import ModelForm


@world_view(Duty.MANAGE, READ_AND_WRITE, does="ask a language model for paraphrases")
def campaign_model(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Say what a language model is asked with; a POST starts the job."""
    campaign = get_object_or_404(world.campaigns, pk=pk)
    models = campaign.contributors.filter(kind=ContributorKind.MODEL)
    last = models.order_by("-pk").first()
    form = ModelForm(posted(request), initial=last.settings if last else {})
    if request.method == "POST" and form.is_valid():
        try:
            job, is_new = request_paraphrases(campaign, form.settings(), request.user)
        except Refusal as refusal:
            form.add_error(None, refusal.message)
        else:
            if not is_new:
                messages.warning(request, "A model contributes to this campaign already.")
            return redirect("job", pk=job.pk)
    context = {
        "campaign": campaign,
        "form": form,
        "problem": problem_of(server()),
        "models": models,
        "jobs": world.jobs.filter(
            kind=JobKind.PARAPHRASE, arguments__campaign=campaign.pk
        ).select_related("created_by")[:5],
    }
    status = 422 if form.is_bound and form.errors else 200
    return render(request, "parser_service/labelling/model.html", context, status=status)
