"""The label audit: what speaks against labels, the most suspect first, and what people decide about each."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.db.models import Q
from django.http import HttpResponse, JsonResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache
from django_htmx.http import reselect, reswap, retarget

from annotations.labelling.form_check import check_label
from annotations.labelling.giving import NotForThem, kinds_for
from annotations.labelling.label_answers import AnsweredMeanwhile, NoLongerYours
from annotations.labelling.label_decisions import DecidedMeanwhile, decide, take_back_decision
from annotations.language.texts import Refusal
from annotations.models import (
    AuditDecision,
    AuditFinding,
    Duty,
    FindingStatus,
    JobKind,
    WorkKind,
    World,
)
from annotations.people.access import NOTHING, WRITE, WorldRequest, world_view
from annotations.rows.occurrences import examples_of_pair
from annotations.showing.keys import keys_for
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.own_entities import OwnEntities
from annotations.showing.paging import number_in
from annotations.web.labelling.queueing_filters import AuditFindingFilters
from parser_service.labelling.audit_job import request_audit
from parser_service.labelling.precision import precision_of
from parser_service.web.labelling.audit_forms import AuditForm

SORTS = {"rank": Sort("No.", "rank", is_number=True), "text": Sort("Utterance", "text")}
LAST_SHOWN = 5
MOST_SPLITS = 10
PAGE_KEYS = keys_for("next", "previous", "digit", "accept", "reject", "edit", "note", "undo")


@never_cache
@world_view(Duty.VIEW)
def audit(request: WorldRequest, world: World) -> HttpResponse:
    """List the labels in doubt, and show one of them: the first, or the one that the URL names."""
    rows = world.audit_findings.prefetch_related("reasons")
    listing = Listing(request, AuditFindingFilters, rows, SORTS)
    finding: AuditFinding | None
    if name := request.GET.get("finding", ""):
        finding = get_object_or_404(world.audit_findings, pk=number_in(name))
    else:
        finding = next(iter(listing.rows), None)
    decisions = AuditDecision.objects.valid().filter(finding__world=world, decided_by=request.user)
    context = {
        "listing": listing,
        "last": decisions.select_related("finding").order_by("-pk")[:LAST_SHOWN],
        "precision": precision_of(world),
        "job": world.jobs.filter(kind=JobKind.AUDIT).first(),
        "audit_form": AuditForm(),
        "page_keys": PAGE_KEYS,
        **_context_of(request, finding),
    }
    return render_list(request, "parser_service/labelling/audit.html", context)


@never_cache
@world_view(Duty.VIEW)
def audit_item(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Return one finding alone, for the page that lists them; without a script, that page."""
    finding = get_object_or_404(world.audit_findings, pk=pk)
    if not request.htmx:
        return _to(request, world, finding)
    return render(
        request, "parser_service/labelling/_audit_finding.html", _context_of(request, finding)
    )


@world_view(Duty.REVIEW, WRITE, does="start a label audit")
def audit_start(request: WorldRequest, world: World) -> HttpResponse:
    """Start an audit of the labels, or show the one that is queued or running."""
    form = AuditForm(request.POST)
    if not form.is_valid():
        problems = " ".join(
            f"{name}: {' '.join(map(str, each))}" for name, each in form.errors.items()
        )
        messages.error(request, f"The audit was not started. {problems}")
        return redirect("audit", world=world.name)
    return redirect("job", pk=request_audit(world, request.user, form.cleaned_data).pk)


@world_view(Duty.VIEW, WRITE, does="decide about a label")
def audit_decide(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Keep, correct or exclude, and go on to the next label of the list."""
    finding = get_object_or_404(world.audit_findings, pk=pk)
    sent = request.POST
    form, reason = sent.get("form", ""), sent.get("reason", "")
    try:
        decide(finding, sent.get("decision", ""), request.user, form, reason)
    except Refusal as refusal:
        is_over = isinstance(
            refusal, AnsweredMeanwhile | DecidedMeanwhile | NoLongerYours | NotForThem
        )
        if is_over or not request.htmx:
            messages.error(request, str(refusal))
            return _to(request, world, finding)
        # What the reviewer wrote stays on the page.
        shown = {"sentence": str(refusal)}
        response = render(
            request, "parser_service/labelling/_audit_problem.html", shown, status=422
        )
        return reswap(retarget(reselect(response, "#audit-problem"), "#audit-problem"), "outerHTML")
    listing = Listing(request, AuditFindingFilters, world.audit_findings.all(), SORTS)
    rows = listing.matching.exclude(pk=pk).order_by("rank", "pk")
    beyond = rows.filter(Q(rank__gt=finding.rank) | Q(rank=finding.rank, pk__gt=pk))
    return _to(request, world, beyond.first() or rows.first())


@world_view(Duty.VIEW, WRITE, does="take a decision back")
def audit_take_back(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Undo a decision of this person, and show its label again."""
    made = get_object_or_404(AuditDecision.objects.filter(finding__world=world), pk=pk)
    try:
        take_back_decision(made, request.user)
    except Refusal as refusal:
        messages.error(request, str(refusal))
    return _to(request, world, made.finding)


@world_view(Duty.VIEW, WRITE, does=NOTHING)
def audit_check(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Say what is wrong with a form while somebody writes it."""
    finding = get_object_or_404(world.audit_findings, pk=pk)
    text, form = finding.anonymized_text, request.POST.get("form", "")
    return JsonResponse(check_label(world, text, form, may_be_unknown=True))


def _context_of(request: WorldRequest, finding: AuditFinding | None) -> dict[str, Any]:
    """Return the context of one finding; ``state`` holds the filters of the list, for its forms."""
    state = request.GET.copy()
    state.pop("finding", None)
    may_decide = WorkKind.AUDIT in kinds_for(request.user, request.world)
    context = {"finding": finding, "state": state.urlencode(), "may_decide": may_decide}
    if finding is None:
        return context
    examples = examples_of_pair(finding.world_id, finding.text, finding.form)
    is_open = AuditFinding.objects.open().filter(pk=finding.pk).exists()
    return {
        **context,
        "own": own_entities(finding),
        "reasons": finding.reasons.all(),
        "examples": examples[:MOST_SPLITS],
        "decision": finding.decision,
        "may_decide": may_decide and is_open,
        "is_outdated": finding.status == FindingStatus.OPEN and not is_open,
    }


def own_entities(finding: AuditFinding) -> OwnEntities:
    """Return what the pair of a finding names."""
    if finding.utterance:
        return OwnEntities.of_utterance(finding.utterance)
    assert finding.paraphrase is not None  # a finding has one of the two
    return OwnEntities.of_pair(finding.world, finding.paraphrase)


def _to(request: WorldRequest, world: World, finding: AuditFinding | None) -> HttpResponse:
    """Go to ``finding`` in the list that the filters of the URL leave."""
    query = request.GET.copy()
    query.pop("finding", None)
    if finding is not None:
        query["finding"] = str(finding.pk)
    address = reverse("audit", kwargs={"world": world.name})
    return redirect(f"{address}?{query.urlencode()}" if query else address)
