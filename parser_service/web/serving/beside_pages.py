"""Runs beside each other on Parse: somebody edits an utterance and sees each answer change."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode

from django.http import HttpResponse, QueryDict
from django.shortcuts import redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache
from django_htmx.http import replace_url

from annotations.models import Duty, Example, World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.people.access import NOTHING, WRITE, WorldRequest, world_view
from annotations.showing.form_presentation import form_of
from annotations.showing.own_entities import OwnEntities
from annotations.showing.paging import number_in
from parser_service.models import TrainingRun, Tryout
from parser_service.reviews.tryout_answers import MOST_TEXT, ask, request_answers
from parser_service.serving.default_runs import opening_run
from parser_service.web.runs.asked_runs import MOST_RUNS, asked_runs, runs_to_choose

MOST_OFFERED = 30
USUAL = "usual"


@dataclass(frozen=True, slots=True)
class TriedAnswer:
    """What a run answers to the text; ``before`` is its form for the text before, None where not known.

    ``answers`` is None while the run has not answered; ``problem`` says why it cannot.
    """

    run: TrainingRun
    answers: list[dict[str, Any]] | None
    problem: str
    before: str | None

    @property
    def form(self) -> str:
        return self.answers[0]["form"] if self.answers else ""

    @property
    def further(self) -> list[dict[str, Any]]:
        """The other candidates that are forms, each with its number."""
        others = enumerate((self.answers or [])[1:], start=2)
        return [{**each, "number": number} for number, each in others if form_of(each["form"])]

    @property
    def n_malformed(self) -> int:
        """How many of the other candidates are no forms."""
        return len((self.answers or [])[1:]) - len(self.further)

    @property
    def is_cut(self) -> bool:
        """Whether the answer is to the beginning of the text alone."""
        return any(each.get("is_cut") for each in self.answers or ())

    @property
    def has_changed(self) -> bool:
        return self.answers is not None and self.before not in (None, self.form)


@world_view(Duty.VIEW)
def tryout(request: WorldRequest, world: World) -> HttpResponse:
    """Lead an old address to Parse, which shows the same runs beside each other."""
    query = request.GET.copy()
    query.setlist("beside", query.pop("run", []) or [USUAL])
    return redirect(f"{reverse('playground', kwargs={'world': world.name})}?{query.urlencode()}")


def beside(query: QueryDict, world: World) -> dict[str, Any]:
    """Return the context of the runs that answer beside each other: those that the address names, or the usual ones
    for ``beside=usual``. Without either nothing is asked, and the list of runs is not read."""
    key = number_in(query.get("example", ""))
    example = Example.objects.filter(split__world=world, pk=key).first() if key else None
    if not ("beside" in query or example):
        return {"is_beside": False}
    chosen = asked_runs(query, world, "beside") or _usual_runs(world)
    return {
        "is_beside": True,
        "example": example,
        "own": OwnEntities.of_pair(world, example) if example else None,
        "chosen_beside": chosen,
        "choices": list(dict.fromkeys([*chosen, *runs_to_choose(world, MOST_OFFERED)])),
        "most_runs": MOST_RUNS,
    }


@never_cache
@world_view(Duty.VIEW, WRITE, does=NOTHING)
def beside_ask(request: WorldRequest, world: World) -> HttpResponse:
    """Ask the chosen runs about the text, and show what they have answered.

    With ``waiting`` in the URL nothing new is asked: the page looks for answers that were not there yet.
    """
    text, runs = text_of(request.POST), asked_runs(request.POST, world, "beside")
    if "waiting" in request.GET:
        row = Tryout.objects.filter(world=world, person=request.user).first()
        if row is not None:
            request_answers(row)  # the job may have ended before it saw the text
    else:
        row = ask(world, request.user, text[:MOST_TEXT], runs) if text and runs else None
    context = {
        "tryout": row,
        "answers": _answers_of(row, world) if row else [],
        "text": text,
        "own": OwnEntities.in_text(world, row.text) if row else None,
    }
    response = render(request, "parser_service/serving/_beside_answers.html", context)
    if "waiting" in request.GET:
        return response
    return replace_url(response, address_of(request.POST, world))


def address_of(query: QueryDict, world: World) -> str:
    """Return the address of Parse that asks the same again."""
    asked = {
        "text": text_of(query),
        "run": query.get("run", ""),
        "beside": [key for key in query.getlist("beside") if key],
        "example": query.get("example", ""),
    }
    address = reverse("playground", kwargs={"world": world.name})
    named = urlencode({name: value for name, value in asked.items() if value}, doseq=True)
    return f"{address}?{named}" if named else address


def text_of(query: QueryDict) -> str:
    """Return the text that is asked about, in one line."""
    return " ".join(query.get("text", "").replace("\0", "").split())[:MOST_CHARACTERS]


def _answers_of(row: Tryout, world: World) -> list[TriedAnswer]:
    runs = world.runs.select_related("split").in_bulk(row.runs)
    before = row.before.get("answers", {})
    shown = []
    for key in row.runs:
        found = row.answers.get(str(key), {})
        earlier = before.get(str(key), {}).get("answers")
        if key in runs:
            shown.append(
                TriedAnswer(
                    run=runs[key],
                    answers=found.get("answers"),
                    problem=found.get("problem", ""),
                    before=None if earlier is None else (earlier or [{"form": ""}])[0]["form"],
                )
            )
    return shown


def _usual_runs(world: World) -> list[TrainingRun]:
    """Return the run that pages open on, and the newest ones of other parsers on its split."""
    opening = opening_run(world)
    if opening is None:
        return []
    runs = {opening.parser: opening}
    for run in world.runs.succeeded().filter(split=opening.split_id).order_by("-pk"):
        runs.setdefault(run.parser, run)
    return list(runs.values())[:MOST_RUNS]
