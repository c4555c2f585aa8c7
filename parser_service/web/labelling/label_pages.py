"""Labelling: one utterance at a time, by one key where a candidate is right."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.contrib import messages
from django.http import HttpResponse, JsonResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.template.loader import render_to_string
from django.urls import reverse
from django.views.decorators.cache import never_cache

from annotations.labelling.collecting import collect
from annotations.labelling.entity_spans import mend_span
from annotations.labelling.form_check import check_label
from annotations.labelling.giving import ItemFilter, next_item, skipped_items
from annotations.labelling.item_answers import (
    answer,
    answer_waiting,
    assignment_in,
    take_answer_back,
)
from annotations.labelling.label_queue import last_labels, next_utterance, progress_of
from annotations.language.texts import Refusal, find_words
from annotations.models import Duty, Entity, Label, Origin, Utterance, Verdict, World
from annotations.people.access import NOTHING, WRITE, WorldRequest, world_view
from annotations.showing.keys import keys_for
from annotations.showing.listing import Listing
from annotations.showing.own_entities import OwnEntities
from annotations.showing.paging import number_in
from annotations.web.corpus.corpus_filters import UtteranceFilters
from annotations.web.corpus.utterance_pages import SORTS
from parser_service.labelling.label_candidates import PERSON, awaited_parser, candidates_for

MOST_ENTITIES = 1_000  # offered where somebody says what words name
MOST_WITHOUT = 50
PAGE_KEYS = keys_for(
    *("digit", "edit", "unknown", "skip", "dispute", "mend", "undo", "candidates", "guidelines")
)


@never_cache
@world_view(Duty.ANNOTATE)
def label_page(request: WorldRequest, world: World) -> HttpResponse:
    """Show the next utterance that the filters of the URL leave, or the one that it names."""
    listing = _listing(request, world)
    row = _find_asked(request, world, listing)
    entities = Entity.objects.filter(ontology__world=world).order_by("entity_class", "text")
    names = entities.values_list("text", "entity_class").distinct()[:MOST_ENTITIES]
    context = {
        "listing": listing,
        "page_keys": PAGE_KEYS,
        "entities": [f"{text} ({entity_class})" for text, entity_class in names],
        **_strip(request, world),
        **_item(request, row),
    }
    return render(request, "parser_service/labelling/label.html", context)


@never_cache
@world_view(Duty.ANNOTATE)
def label_item(request: WorldRequest, world: World) -> HttpResponse:
    """Return the next utterance alone; ``without`` are the keys of those that the page has already.

    A page that waits for a parser asks with ``waiting`` whether the candidates of its utterance have come: 204 before.
    """
    row = _find_asked(request, world, _listing(request, world))
    if "waiting" in request.GET and row is not None:
        if awaited_parser(row):
            return HttpResponse(status=HTTPStatus.NO_CONTENT)
        context = {"has_come": row.proposals.exclude(source=PERSON).exists()}
        return render(request, "parser_service/labelling/_label_waits.html", context)
    return render(request, "parser_service/labelling/_label_item.html", _item(request, row))


@world_view(Duty.ANNOTATE, WRITE, does="label")
def label_answer(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Store an answer. 409 if the utterance has changed meanwhile, 422 if the answer is not valid."""
    row = get_object_or_404(world.utterances, pk=pk)
    sent = request.POST
    verdict = sent.get("verdict") or (Verdict.FORM if sent.get("form") else "")
    version, seconds = _number(sent.get("version")), _number(sent.get("seconds"))
    form, reason = sent.get("form", ""), sent.get("reason", "")
    try:
        answer(row, verdict, form, request.user, int(version or 0), seconds, reason)
    except Refusal as refusal:
        return _reply(request, world, row, str(refusal), status_of(refusal))
    return _reply(request, world, row)


@world_view(Duty.ANNOTATE, WRITE, does="take a label back")
def label_take_back(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Undo an answer of this person, and show its utterance again."""
    stored = get_object_or_404(Label.objects.of_world(world), pk=pk)
    try:
        row = take_answer_back(stored, request.user)
    except Refusal as refusal:
        return _reply(request, world, stored.utterance, str(refusal), HTTPStatus.CONFLICT)
    return _reply(request, world, row, stays=True)


@world_view(Duty.ANNOTATE, WRITE, does="send an utterance to be labelled")
def label_send(request: WorldRequest, world: World) -> HttpResponse:
    """Add the utterance of a review, unless the world has it, and open it for labelling."""
    text = " ".join(request.POST.get("text", "").split())
    collected = collect(world, [text], Origin.REVIEW, request.user)
    row = world.utterances.filter(text=text).first() if not collected.problems else None
    if row is None:
        messages.error(request, " ".join(map(str, collected.problems)) or "There is no text.")
        return redirect("utterances_new", world=world.name)
    return redirect(f"{reverse('label', kwargs={'world': world.name})}?utterance={row.pk}")


@world_view(Duty.ANNOTATE, WRITE, does=NOTHING)
def label_check(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Say what is wrong with a form while somebody writes it."""
    row = get_object_or_404(world.utterances, pk=pk)
    return JsonResponse(check_label(world, row.anonymized_text, request.POST.get("form", "")))


@world_view(Duty.ANNOTATE, WRITE, does="correct what names an entity")
def label_mend(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Say which words of an utterance name which entity; the words become an alias of it."""
    row = get_object_or_404(world.utterances, pk=pk)
    words, name = request.POST.get("words", "").strip(), request.POST.get("entity", "")
    place = find_words(words, row.text)
    try:
        text, _, entity_class = name.strip().removesuffix(")").rpartition(" (")
        rows = Entity.objects.filter(ontology__world=world, entity_class=entity_class)
        entity = rows.filter(text=text).first() if "\0" not in name else None
        if entity is None:
            raise Refusal(
                "Choose an entity of this world from the list.",
                "unknown_entity",
                HTTPStatus.UNPROCESSABLE_ENTITY,
            )
        if place is None:
            raise Refusal(
                f"The utterance does not have the words “{words[:60]}”.",
                "words_not_in_utterance",
                HTTPStatus.UNPROCESSABLE_ENTITY,
            )
        version = int(_number(request.POST.get("version")) or 0)
        row = mend_span(row, *place, entity, request.user, version)
    except Refusal as refusal:
        return _reply(request, world, row, str(refusal), status_of(refusal))
    return _reply(request, world, row, stays=True)


def status_of(refusal: Refusal) -> int:
    """Return the status of a fragment: a form that is not valid is 422, as on every page."""
    is_conflict = refusal.status == HTTPStatus.CONFLICT
    return HTTPStatus.CONFLICT if is_conflict else HTTPStatus.UNPROCESSABLE_ENTITY


def _listing(request: WorldRequest, world: World) -> Listing:
    return Listing(request, UtteranceFilters, world.utterances.all(), SORTS)


def _find_asked(request: WorldRequest, world: World, listing: Listing) -> Utterance | None:
    """Return the utterance that the URL names; without a filter the next one of the person's queue.

    Raises Http404 for one of another world.
    """
    if name := request.GET.get("utterance", ""):
        return get_object_or_404(world.utterances.select_related("world"), pk=number_in(name))
    keys = request.GET.get("without", "").split(",")[:MOST_WITHOUT]
    without = list(filter(None, map(number_in, keys)))
    if not listing.chips:
        part = next_item(request.user, world, ItemFilter(labels_only=True, without=without))
        return part.item.utterance if part else None
    rows: Any = listing.matching
    if not request.GET.get("status"):
        rows = rows.unlabelled()
    return next_utterance(rows, request.user, without)


def _item(request: WorldRequest, row: Utterance | None) -> dict[str, Any]:
    """Return the context of the utterance; ``part`` says why the queue asks for it, ``given`` is what
    the person has answered where others are still asked. Without one, how many they have skipped."""
    if row is None:
        skipped = skipped_items(request.user, request.world, ItemFilter(labels_only=True))
        return {"row": None, "n_skipped": skipped.count()}
    part = assignment_in(row, request.user)
    given = None if part else answer_waiting(row, request.user)
    return {
        "row": row,
        "own": OwnEntities.of_utterance(row),
        "candidates": candidates_for(row),
        "awaited": awaited_parser(row),
        "part": part,
        "given": given,
    }


def _strip(request: WorldRequest, world: World) -> dict[str, Any]:
    """Return the context of the strip above: progress, and the person's last answers."""
    return {
        "progress": progress_of(world, request.user),
        "last": last_labels(world, request.user),
    }


def _reply(
    request: WorldRequest,
    world: World,
    row: Utterance,
    refusal: str = "",
    status: int = 200,
    stays: bool = False,
) -> HttpResponse:
    """Answer the page's script in JSON; without a script, go on to the next utterance, or stay at this one."""
    if "application/json" in request.headers.get("Accept", ""):
        strip = render_to_string(
            "parser_service/labelling/_label_strip.html", _strip(request, world), request=request
        )
        values = {"strip": strip, "utterance": row.pk, "text": row.text, "refusal": refusal}
        return JsonResponse(values, status=status)
    if refusal:
        messages.error(request, refusal)
    response = redirect("label", world=world.name)
    if refusal or stays:
        response["Location"] += f"?utterance={row.pk}"
    return response


def _number(text: str | None) -> float | None:
    """Read a number from a form; None if it is not one."""
    try:
        value = float(text or "")
    except ValueError:
        return None
    return value if 0 <= value < 2**31 else None
