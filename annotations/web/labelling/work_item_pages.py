"""The work queue: what to do next and why, who does what, and what an admin decides about it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.contrib import messages
from django.db.models import Prefetch
from django.http import Http404, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache

from annotations.labelling.enqueuing import ASKABLE, ask_about, set_share, shares_of
from annotations.labelling.finishing import finish, give_back, skip
from annotations.labelling.giving import (
    NotForThem,
    assign,
    assign_first,
    held_item,
    next_item,
    next_skipped,
    skipped_items,
    take,
    withdraw,
)
from annotations.labelling.item_answers import answer, labels_to_compare
from annotations.labelling.label_answers import NoLongerYours
from annotations.labelling.label_decisions import end_item
from annotations.labelling.queue_progress import open_by_kind
from annotations.language.texts import Refusal, say_count
from annotations.models import Assignment, Duty, WorkItem, WorkKind, World
from annotations.models.queueing import OCCUPYING
from annotations.people.access import (
    NOTHING,
    READ_AND_WRITE,
    WRITE,
    WorldRequest,
    demand,
    world_view,
)
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.own_entities import OwnEntities
from annotations.web.editing.undo import say_with_undo
from annotations.web.forms import posted
from annotations.web.labelling.queueing_filters import WorkItemFilters
from annotations.web.labelling.work_item_forms import (
    MOST_ASSIGNED,
    AskForm,
    AssignForm,
    AssignManyForm,
    SettleForm,
    SharesForm,
)

SORTS = {
    "urgency": Sort("Why", "-priority"),
    "title": Sort("What", "title"),
    "created": Sort("Added", "id"),
}


def shown_parts() -> Prefetch[Any]:
    """Return the people who have an item or have done it, for lists."""
    parts = Assignment.objects.filter(outcome__in=OCCUPYING)
    return Prefetch("assignments", parts.select_related("person"), "parts")


@never_cache
@world_view(Duty.VIEW)
def queue(request: WorldRequest, world: World) -> HttpResponse:
    """Show the reader's current item and the list of all items."""
    listing = Listing(
        request, WorkItemFilters, world.work_items.present().prefetch_related(shown_parts()), SORTS
    )
    held = held_item(request.user, world)
    n_skipped = 0 if held else skipped_items(request.user, world).count()
    context = {
        "listing": listing,
        "held": held,
        "n_skipped": n_skipped,
        "page": page_of(held.item) if held else "",
        "waiting": open_by_kind(world),
        "assign_form": AssignManyForm(world, auto_id="assign_%s"),  # a filter is called person too
    }
    return render_list(request, "annotations/labelling/queue.html", context)


@world_view(Duty.VIEW, WRITE, does=NOTHING)
def queue_next(request: WorldRequest, world: World) -> HttpResponse:
    """Assign the next item to the reader, and open its page: with ``skipped`` one that they have skipped."""
    give = next_skipped if "skipped" in request.POST else next_item
    assignment = give(request.user, world)
    if assignment is None:
        messages.info(request, "There is nothing that you can do now. Look again later.")
        return redirect("queue", world=world.name)
    return redirect(page_of(assignment.item))


@never_cache
@world_view(Duty.VIEW)
def queue_item(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one item: why it is there, who does it, and two labels beside each other if they differ."""
    return _item_page(request, _item_of(world, pk))


def _item_of(world: World, pk: int) -> WorkItem:
    return get_object_or_404(
        world.work_items.present().select_related("utterance", "follows"), pk=pk
    )


def _item_page(
    request: WorldRequest, item: WorkItem, form: SettleForm | None = None, status: int = 200
) -> HttpResponse:
    parts = item.assignments.select_related("person", "label")
    mine = parts.held().filter(person=request.user).first()
    labels = labels_to_compare(item, request.user)
    context = {
        "item": item,
        "parts": parts,
        "mine": mine,
        "page": page_of(item),
        "labels": labels,
        "own": OwnEntities.of_utterance(item.utterance) if labels and item.utterance else None,
        "form": form or (SettleForm(labels) if mine and labels else None),
        "assign_form": AssignForm(item.world),
    }
    return render(request, "annotations/labelling/queue_item.html", context, status=status)


def page_of(item: WorkItem) -> str:
    """Return the URL of the page on which an item is done."""
    world = item.world.name
    if finding := item.open_finding:
        return reverse("audit", args=[world]) + f"?finding={finding.pk}"
    if item.kind == WorkKind.ADJUDICATION or item.subject is None:
        return reverse("queue_item", args=[world, item.pk])
    if item.utterance_id:
        return reverse("label", args=[world]) + f"?utterance={item.utterance_id}"
    if item.template_id:
        return reverse("template", args=[world, item.template_id])
    return reverse("paraphrase", args=[world, item.paraphrase_id])


@world_view(Duty.VIEW, WRITE, does="settle two labels")
def queue_settle(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Decide between two labels, with one of them or with another answer."""
    item = _item_of(world, pk)
    form = SettleForm(labels_to_compare(item, request.user), request.POST)
    if not item.assignments.held().filter(person=request.user).exists():
        messages.error(request, "Take this item first; somebody else may be at it.")
        return redirect("queue_item", world=world.name, pk=pk)
    if not form.is_valid():
        return _item_page(request, item, form, status=422)
    try:
        utterance = item.utterance
        assert utterance is not None  # else there is nothing to settle
        answer(utterance, by=request.user, version=utterance.version, **form.decision)
    except Refusal as error:
        messages.error(request, str(error))
        return redirect("queue_item", world=world.name, pk=pk)
    messages.success(request, f"Settled: {item.title[:80]}")
    return redirect("queue", world=world.name)


def _finish(part: Assignment) -> None:
    """Finish an item. A label in doubt is kept as it is; an utterance is finished only by labelling it."""
    if end_item(part):
        return
    if part.item.utterance_id:
        raise NotForThem("Label the utterance; that ends this item.")
    finish(part)


@world_view(Duty.REVIEW, WRITE, does="ask for a look")
def queue_ask(request: WorldRequest, world: World, kind: str, pk: int) -> HttpResponse:
    """Ask for a look at an utterance, a template or a paraphrase, with a reason."""
    if kind not in ASKABLE:
        raise Http404("Nobody can be asked about that.")
    subject = get_object_or_404(ASKABLE[kind](world), pk=pk)
    form = AskForm(request.POST)
    if not form.is_valid():
        messages.error(request, "Say in a few words what is to be looked at.")
    elif ask_about(world, subject, form.cleaned_data["reason"], request.user):
        messages.success(request, "In the queue: the next annotator who is free gets it.")
    else:
        messages.info(request, "Somebody is asked about this already.")
    return redirect(kind, world=world.name, pk=pk)


# What the person who holds an item does with it, and what is said then.
STEPS: dict[str, tuple[Callable[[Assignment], object], str]] = {
    "give_back": (give_back, "Given back. Others can take it now."),
    "skip": (
        skip,
        "Skipped. Others can take it now; it waits for you among those that you skipped.",
    ),
    "done": (_finish, "Done."),
}


@world_view(Duty.VIEW, WRITE, does="work on an item")
def queue_act(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Take an item, give it back, skip it or end it; admins give it to somebody or withdraw it."""
    item = _item_of(world, pk)
    step = request.POST.get("step", "")
    try:
        if step == "take":
            take(request.user, item)
            return redirect(page_of(item))
        sentence = _act(request, item, step)
        if step == "skip":
            act = reverse("queue_act", kwargs={"world": world.name, "pk": pk})
            say_with_undo(request, sentence, act, step="take")
        else:
            messages.success(request, sentence)
    except (NotForThem, NoLongerYours) as error:
        messages.error(request, str(error))
    return redirect("queue_item", world=world.name, pk=pk)


def _act(request: WorldRequest, item: WorkItem, step: str) -> str:
    """Carry out a step of an admin, or of the person who holds the item. Return a sentence about it."""
    if step in ("assign", "withdraw"):
        demand(request, Duty.MANAGE)
        if step == "assign":
            form = AssignForm(item.world, request.POST)
            if not form.is_valid():
                raise NotForThem("Choose a person of this world.")
            person = form.cleaned_data["person"]
            assign(item, person, by=request.user)
            return f"{person} has this now."
        for assignment in item.assignments.held():
            withdraw(assignment)
        return "Withdrawn. Others can take it now."
    held = item.assignments.held().filter(person=request.user).first()
    if held is None or step not in STEPS:
        raise NoLongerYours("This is not yours now. Take it first.")
    verb, sentence = STEPS[step]
    verb(held)
    return sentence


@world_view(Duty.MANAGE, WRITE, does="assign an item")
def queue_assign(request: WorldRequest, world: World) -> HttpResponse:
    """Give somebody the first free items of the list that the filters of the URL leave."""
    form = AssignManyForm(world, request.POST)
    if not form.is_valid():
        messages.error(request, f"Choose a person and 1 to {MOST_ASSIGNED} items.")
        return _back_to_list(request, world)
    person, count = form.cleaned_data["person"], form.cleaned_data["count"]
    rows = WorkItemFilters(request.GET, queryset=world.work_items.present(), request=request).qs
    given = assign_first(rows, person, count, request.user)
    messages.success(request, f"{person} has {say_count(given, 'more item')} now.")
    return _back_to_list(request, world)


def _back_to_list(request: WorldRequest, world: World) -> HttpResponse:
    response = redirect("queue", world=world.name)
    if query := request.GET.urlencode():
        response["Location"] += f"?{query}"
    return response


@world_view(Duty.MANAGE, READ_AND_WRITE, does="set shares")
def queue_settings(request: WorldRequest, world: World) -> HttpResponse:
    """Set the share of items, by kind, that two people do independently."""
    form = SharesForm(posted(request), initial=shares_of(world))
    if request.method == "POST" and form.is_valid():
        for kind, percent in form.cleaned_data.items():
            set_share(world, WorkKind(kind), percent)
        messages.success(request, "Saved. Items that nobody has taken yet follow it too.")
        return redirect("queue_settings", world=world.name)
    return render(request, "annotations/labelling/queue_settings.html", {"form": form})
