"""Campaigns of a world: what admins launch, follow, close, and whom they forget."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from django.contrib import messages
from django.db.models import Min, QuerySet
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache

from annotations.campaigns.campaign_files import MOST_TASKS
from annotations.campaigns.changing import CampaignChanged, change_campaign
from annotations.campaigns.closing import close, forget, renew_link, reopen, revoke_link
from annotations.campaigns.crowd_jobs import start_results_import
from annotations.campaigns.launching_job import MOST_SHOWN, start_launch, start_preview
from annotations.campaigns.progress import progress_of
from annotations.language.texts import LanguageError, Refusal, say_count
from annotations.models import Campaign, CampaignPrompt, Contributor, Duty, Job, World
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.people.allowances import may_take_long, takes_files
from annotations.people.audit_log import note
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.paging import number_in
from annotations.web.campaigns.campaign_forms import (
    TEN_TASKS,
    CampaignChangeForm,
    CampaignFilters,
    CampaignForm,
    ContributorFilters,
    ResultsForm,
    values_of,
)
from annotations.web.campaigns.campaign_links import link_of
from annotations.web.forms import posted, sentence_of

SORTS = {"newest": Sort("Launched", "-created_at"), "name": Sort("Campaign", "name")}
CONTRIBUTOR_SORTS = {"began": Sort("Began", "-began_at")}
# What a button does, and what is said afterwards.
STEPS: dict[str, tuple[Callable[[Campaign], None], str]] = {
    "close": (close, "Closed. Nobody can begin any more; who has begun may finish within a day."),
    "open": (reopen, "Open again."),
    "revoke": (revoke_link, "The link leads nowhere now, also for those who have begun."),
    "renew": (renew_link, "This campaign has a new link. The old one leads nowhere."),
}


@world_view(Duty.MANAGE)
def campaigns(request: WorldRequest, world: World) -> HttpResponse:
    """List the campaigns, each with how much has come in."""
    listing = Listing(request, CampaignFilters, world.campaigns.counted(), SORTS)
    return render_list(request, "annotations/campaigns/campaigns.html", {"listing": listing})


@may_take_long
@world_view(Duty.MANAGE, READ_AND_WRITE, does="launch a campaign")
def campaign_new(request: WorldRequest, world: World) -> HttpResponse:
    """Show the form that launches a campaign; its other button only previews the prompts.

    The address may choose ``task_categories`` and ``target_per_form`` beforehand. A POST of ``ten_tasks`` alone
    launches the form as it is, with as many prompts as ten people rewrite. A world has one such campaign, however
    often the button is pressed.
    """
    is_quick = "ten_tasks" in request.POST
    if is_quick and world.campaigns.exists():
        return _already_there(request, world)
    initial: dict[str, Any] = {"name": f"Campaign {world.campaigns.count() + 1}"}
    initial["task_categories"] = request.GET.getlist("task_categories")
    if target := number_in(request.GET.get("target_per_form", "")):
        initial["target_per_form"] = target
    form = CampaignForm(world, posted(request), initial=initial)
    if is_quick:
        form = CampaignForm.of_ten_tasks(
            world, "Campaign 1"
        )  # pressed twice, the second finds the name taken
    context: dict[str, Any] = {"form": form}
    if form.is_bound and form.is_valid():
        choice = form.choice
        if is_quick:
            choice = replace(choice, most_prompts=TEN_TASKS * form.cleaned_data["task_size"])
        try:
            started: Job | Campaign | dict[str, Any]
            if is_quick or "launch" in request.POST:
                started = start_launch(world, form.values, choice, request.user)
                note(request, form.cleaned_data["name"])
            else:
                started = start_preview(world, choice, request.user)
            if isinstance(started, Job):
                return redirect("job", pk=started.pk)
            if isinstance(started, Campaign):
                messages.success(request, "Launched. Send the link to whoever shall contribute.")
                return redirect("campaign_page", world=world.name, pk=started.pk)
            context["report"] = started
        except LanguageError as error:
            form.add_error(None, sentence_of(error))
        except Refusal as refusal:
            is_taken = refusal.code == "name_taken"
            if is_quick and is_taken:
                return _already_there(request, world)
            form.add_error("name" if is_taken else None, refusal.message)
    status = 422 if form.errors else 200
    return render(request, "annotations/campaigns/campaign_new.html", context, status=status)


def _already_there(request: WorldRequest, world: World) -> HttpResponse:
    """Lead whoever presses the button of ten tasks once more to what the first press made."""
    messages.info(request, "This world has a campaign already. Its page has the link.")
    return redirect("campaigns", world=world.name)


@takes_files
@world_view(Duty.MANAGE, READ_AND_WRITE, does="check crowd results")
def campaign_results(request: WorldRequest, world: World) -> HttpResponse:
    """Take the results of a crowd market; a job checks them, and asks before it imports them."""
    initial = {"campaign": request.GET.get("campaign", "")}
    form = ResultsForm(world, posted(request), request.FILES or None, initial=initial)
    if form.is_bound and form.is_valid():
        sent = form.cleaned_data
        values = form.chosen, sent["name"], sent["encoding"]
        try:
            job = start_results_import(world, sent["file"], request.user, *values)
        except Refusal as refusal:
            form.add_error("name", refusal.message)
        else:
            note(request, sent["name"] or str(form.chosen))
            return redirect("job", pk=job.pk)
    status = 422 if form.errors else 200
    context = {"form": form}
    return render(request, "annotations/campaigns/campaign_results.html", context, status=status)


@never_cache
@world_view(Duty.MANAGE)
def campaign_page(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one campaign: its link, how far it is, and who contributes."""
    row = get_object_or_404(world.campaigns.select_related("world"), pk=pk)
    listing = Listing(request, ContributorFilters, row.contributors.counted(), CONTRIBUTOR_SORTS)
    context = {
        "campaign": row,
        "link": link_of(request, row),
        "progress": progress_of(row),
        "prompts": one_of_each(row)[:MOST_SHOWN],
        "listing": listing,
        "most_tasks": MOST_TASKS,
    }
    return render_list(request, "annotations/campaigns/campaign_page.html", context)


@world_view(Duty.MANAGE, READ_AND_WRITE, does="change a campaign")
def campaign_edit(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show the form with the texts, the end and the payment of a campaign; a POST saves them as its next version."""
    row = get_object_or_404(world.campaigns.select_related("world"), pk=pk)
    form = CampaignChangeForm(row, posted(request))
    context: dict[str, Any] = {"campaign": row, "form": form}
    status = 422 if form.errors else 200
    if form.is_bound and form.is_valid():
        try:
            changed = change_campaign(row, form.values, form.cleaned_data["version"])
        except CampaignChanged as clash:
            # What they wrote stays in the form, which is now about the present version.
            context |= {"clash": clash.message, "others": others_of(form, clash.current)}
            form.data = {**request.POST.dict(), "version": clash.current.version}
            status = clash.status
        except Refusal as refusal:
            form.add_error("consent", refusal.message)
            status = refusal.status
        else:
            if changed:
                note(request, f"{row.name}: {', '.join(changed)}")
            said = f"Saved as version {row.version + 1}." if changed else "Nothing has changed."
            messages.success(request, said)
            return redirect("campaign_page", world=world.name, pk=pk)
    return render(request, "annotations/campaigns/campaign_edit.html", context, status=status)


def others_of(form: CampaignChangeForm, current: Campaign) -> list[tuple[str, object]]:
    """Return the label and the stored value of each field that the form would change in ``current``."""
    stored = {**values_of(current), "ends_at": current.ends_at}
    return [
        (str(form[name].label), stored[name])
        for name, value in form.values.items()
        if stored[name] != value
    ]


def one_of_each(campaign: Campaign) -> QuerySet[CampaignPrompt]:
    """Return the first prompt of each form."""
    rows = campaign.prompts.filter(check_words="").order_by()
    first = rows.values("logical_form").annotate(first=Min("pk")).values("first")
    return campaign.prompts.filter(pk__in=first)


@world_view(Duty.MANAGE)
def campaign_state(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show how far a campaign is: the part of its page that is loaded again and again."""
    row = get_object_or_404(world.campaigns.select_related("world"), pk=pk)
    context = {"campaign": row, "progress": progress_of(row)}
    return render(request, "annotations/campaigns/_campaign_state.html", context)


@world_view(Duty.MANAGE, WRITE, does="close or open a campaign")
def campaign_act(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Close a campaign, open it again, revoke its link or make another: as ``step`` says."""
    row = get_object_or_404(world.campaigns, pk=pk)
    step = request.POST.get("step", "")
    if step in STEPS:
        act, said = STEPS[step]
        try:
            act(row)
        except Refusal as refusal:
            messages.error(request, refusal.message)
        else:
            note(request, f"{row.name}: {step}")
            messages.success(request, said)
    else:
        messages.error(request, "There is no such step.")
    return redirect("campaign_page", world=world.name, pk=pk)


@world_view(Duty.MANAGE, READ_AND_WRITE, does="forget a contributor")
def contributor_forget(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Ask whether to delete a contributor with what they wrote, which cannot be undone; a POST does it."""
    rows = Contributor.objects.filter(campaign__world=world).select_related("campaign")
    row = get_object_or_404(rows, pk=pk)
    if request.method != "POST":
        return render(request, "annotations/campaigns/contributor_forget.html", {"row": row})
    count = forget(row)
    note(request, row.campaign.name)
    messages.success(request, f"{row.pseudonym} is forgotten; {say_count(count, 'text')} went too.")
    return redirect("campaign_page", world=world.name, pk=row.campaign_id)
