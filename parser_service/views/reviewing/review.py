"""The review page: one example, what each run makes of it, and what reviewers say about that."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache

from annotations.lists.listing import render_list
from annotations.models import Duty, Example, World
from annotations.people.access import WRITE, world_view
from parser_service.models import TrainingRun
from parser_service.reviewing.cases import read_case
from parser_service.reviewing.categories import ensure_categories
from parser_service.reviewing.doubting import doubt_label
from parser_service.reviewing.tagging import LONGEST_NOTE, accept, tag, take_back, write_note
from parser_service.views.reviewing.review_listing import (
    ReviewListing,
    example_asked,
    number_of,
    runs_asked,
    runs_to_add,
)

# What the first categories are tagged with; later ones are clicked.
CATEGORY_KEYS = "1234567890-="
LONGEST_REASON = 250
KEYS = (
    ("j k", "next example, previous example"),
    ("h l", "answer of the run before, of the run after; ← and → too"),
    ("1 – 9", "tag the answer with this error category; 0, - and = for the next ones"),
    ("Enter", "accept the category that is proposed"),
    ("u", "take your tag back; z too"),
    ("n", "write a note on the answer"),
    ("w", "only where the runs differ, or everywhere again"),
    ("g", "the label is wrong: send it to the work queue"),
    ("q", "open the work queue, once something was sent there"),
    ("a", "choose another run to show beside them"),
    ("t", "show the difference as a tree"),
    ("b", "show all candidates of the answer"),
    ("e", "edit the utterance, and see what each run answers then"),
)


@never_cache
@world_view(Duty.VIEW)
def review(request: HttpRequest, world: World) -> HttpResponse:
    """Show the example that the address names, or the first that its filters leave."""
    runs = runs_asked(request, world)
    if not runs:
        return render_list(request, "parser_service/review.html", {"runs": []})
    listing = ReviewListing(request, runs)
    if start := request.GET.get("from"):
        found = listing.first_from(number_of(start))
        example = str(found) if found else ""
        return redirect(f"{request.path}{listing.url(example=example)}")
    example = example_asked(request, listing, runs[0].split_id)
    context = {
        "runs": runs,
        "listing": listing,
        "removals": [
            (run, listing.url([key for key in listing.runs if key != str(run.pk)]))
            for run in runs
            if len(runs) > 1
        ],
        "addable": runs_to_add(runs),
        "page_keys": KEYS,
        "case": None,
    }
    if example is not None:
        context |= _context_of(request, listing, runs, example)
        context["place"] = listing.place_of(example)
    return render_list(request, "parser_service/review.html", context)


@world_view(Duty.REVIEW, WRITE)
def review_tag(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Tag the answer of one run, accept what is proposed, or take the reader's tag back."""
    sent = request.POST
    steps: dict[str, Callable[..., Any]] = {"accept": accept, "take_back": take_back}

    def change(run: TrainingRun, example: Example) -> None:
        if sent.get("step") in steps:
            steps[sent["step"]](run, example, request.user)
            return
        key = number_of(sent.get("category", ""))
        category = world.error_categories.filter(pk=key).first()
        if category is None:
            raise ValueError("This error category is gone. Reload the page.")
        tag(run, example, category, request.user)

    return _change(request, world, pk, change)


@world_view(Duty.REVIEW, WRITE)
def review_note(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Keep the reader's note on the answer of one run; an empty one is removed."""
    note = request.POST.get("note", "")
    return _change(
        request, world, pk, lambda run, example: write_note(run, example, note, request.user)
    )


@world_view(Duty.REVIEW, WRITE)
def review_doubt(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Send the label of the example to the work queue."""
    sent = request.POST

    def change(run: TrainingRun, example: Example) -> str:
        reason = sent.get("reason", "")[:LONGEST_REASON]
        return doubt_label(example, reason, request.user, sent.get("right", ""))

    return _change(request, world, pk, change)


def _change(
    request: HttpRequest,
    world: World,
    pk: int,
    change: Callable[[TrainingRun, Example], Any],
) -> HttpResponse:
    """Do ``change`` for the run that was sent and the example ``pk``, and show the example again."""
    shown = runs_asked(request, world)
    key = number_of(request.POST.get("run", "")) or (shown[0].pk if shown else 0)
    run = get_object_or_404(TrainingRun.objects.filter(world=world), pk=key)
    example = get_object_or_404(
        Example.objects.select_related("split__world"), split=run.split_id, pk=pk
    )
    problem, said = "", ""
    try:
        outcome = change(run, example)
        said = outcome if isinstance(outcome, str) else ""
    except ValueError as error:
        problem = str(error)
    if not request.htmx:
        return _back(request, world, run, example, problem, said)
    context = _context_of(request, ReviewListing(request, shown), shown, example)
    context |= {"problem": problem, "said": said, "focus": run.pk}
    return render(request, "parser_service/_review_case.html", context)


def _back(
    request: HttpRequest, world: World, run: TrainingRun, example: Example, problem: str, said: str
) -> HttpResponse:
    """Go back to the example, without a script."""
    if problem or said:
        messages.add_message(
            request, messages.ERROR if problem else messages.SUCCESS, problem or said
        )
    runs = runs_asked(request, world)
    address = reverse("review", kwargs={"world": world.name})
    state = ReviewListing(request, runs).url(example=str(example.pk), focus=str(run.pk))
    return redirect(f"{address}{state}")


def _context_of(
    request: HttpRequest, listing: ReviewListing, runs: list[TrainingRun], example: Example
) -> dict[str, Any]:
    """Return what one example is shown with; ``state`` is the list that it is in, for its forms."""
    case = read_case(runs, example, request.user)
    categories = ensure_categories(request.world).values()
    asked = number_of(request.GET.get("focus", ""))
    keys = [run.pk for run in runs]
    address = reverse("review", kwargs={"world": request.world.name})
    return {
        "case": case,
        "here": f"{address}{listing.url(example=str(example.pk))}",
        "listing": listing,
        "state": listing.url(),
        "categories": [
            (each, CATEGORY_KEYS[place] if place < len(CATEGORY_KEYS) else "")
            for place, each in enumerate(categories)
        ],
        "focus": asked if asked in keys else case.first_to_read,
        "longest_note": LONGEST_NOTE,
        "longest_reason": LONGEST_REASON,
    }
