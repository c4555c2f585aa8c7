"""The playground: type an utterance, and see what a robot gets. The parse server answers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from django.http import HttpResponse, QueryDict
from django.shortcuts import render
from django.urls import reverse
from django.views.decorators.cache import never_cache
from django_htmx.http import replace_url

from annotations.generation.example_commands import example_commands
from annotations.language.plans import MOST_COMMANDS
from annotations.language.texts import Refusal
from annotations.models import Duty, Entity, World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.people.access import NOTHING, WRITE, WorldRequest, world_view
from annotations.rows.from_rows import ready_templates
from annotations.showing.keys import keys_for
from annotations.showing.paging import number_in
from parser_service.analysis.probe_texts import PAPER_PROBES
from parser_service.labelling.wrong_answer_reports import report_wrong, say_parser
from parser_service.models import TrainingRun
from parser_service.parsers.interface import ScoreKind
from parser_service.parsers.registry import ORACLE
from parser_service.runs.promoting import promoted_run
from parser_service.serving.answering import answering_parts
from parser_service.serving.default_runs import opening_run
from parser_service.serving.parser_client import ParserAway, ParserRefused, client
from parser_service.web.serving.beside_pages import address_of, beside, text_of
from parser_service.web.serving.curl_commands import curl_command
from parser_service.web.serving.heard_pieces import heard_pieces

MOST_OFFERED = 50  # runs
OWN_EXAMPLES = 3  # as many as there are keys for, beside the texts of the paper
PAGE_KEYS = keys_for("digit")
LEAST_SHARE = 0.0005  # of 1: what is less would be shown as 0.0 %


@world_view(Duty.VIEW)
def playground(request: WorldRequest, world: World) -> HttpResponse:
    """Show the text and the part that the address names; the answer comes when the page has loaded.

    The field ``run`` names what answers alone: a run, or the grammar oracle. Without it the world answers.
    """
    parts, promoted = answering_parts(world), promoted_run(world)
    shown = beside(request.GET, world)
    run, parser = _alone_in(request.GET)
    runs = world.runs.succeeded().select_related("split").order_by("-pk")[:MOST_OFFERED]
    others = [each for each in runs if each != promoted]
    opening = None if parts else opening_run(world)
    example = shown.get("example")
    text = text_of(request.GET) or (example.utterance if example else "")
    context = {
        "text": text,
        "parts": parts,
        "has_templates": ready_templates(world).exists(),
        "runs": [promoted, *others] if promoted else others,
        "chosen": parser or run or (opening.pk if opening else ""),
        "examples": _examples(world),
        "most_text": MOST_CHARACTERS,
        "page_keys": PAGE_KEYS,
        "asks_beside": bool(text and shown.get("chosen_beside")),
        **shown,
        **_asking(world),
    }
    return render(request, "parser_service/serving/playground.html", context)


@never_cache
@world_view(Duty.VIEW, WRITE, does=NOTHING)
def playground_ask(request: WorldRequest, world: World) -> HttpResponse:
    """Ask the parse server about the text, and show its answer."""
    text, (run, parser) = text_of(request.POST), _alone_in(request.POST)
    named = {name: value for name, value in (("run", run), ("parser", parser)) if value}
    context = {"text": text, "is_beside": "beside" in request.POST, **_asking(world)}
    if text:
        try:
            answer = client().parse(world.name, text, run=run, parser=parser)
            context |= {
                "answer": answer,
                "curl": curl_command(request, world, "parse", {"utterance": text, **named}),
                "pieces": heard_pieces(answer),
                "candidates": offered_candidates(answer),
                "most_together": MOST_COMMANDS,
            }
        except ParserAway as error:
            context["away"] = error.message
        except ParserRefused as error:
            context["refused"] = error.message
    response = render(request, "parser_service/serving/_playground_answer.html", context)
    return replace_url(response, address_of(request.POST, world))


@world_view(Duty.VIEW, WRITE, does="report a wrong answer")
def playground_wrong(request: WorldRequest, world: World) -> HttpResponse:
    """Send an utterance that was answered wrongly to the work queue, with the right form if one is given."""
    sent = request.POST
    run = TrainingRun.objects.filter(world=world, pk=number_in(sent.get("run", ""))).first()
    context: dict[str, Any] = {
        "text": text_of(sent),
        "run": run.pk if run else "",
        "parser": sent.get("parser", ""),
        "right_form": sent.get("right_form", ""),
        "answered": sent.get("answered", ""),
        "reason": sent.get("reason", ""),
    }
    given = context["right_form"].replace("\0", "").strip()
    is_changed = given.split() != context["answered"].split()
    try:
        context["sent"] = report_wrong(
            world,
            context["text"],
            say_parser(run, sent.get("parser", "")),
            request.user,
            given if is_changed else "",
            context["reason"],
        )
    except Refusal as error:
        context["refused"] = str(error)
    status = 422 if "refused" in context else 200
    return render(request, "parser_service/serving/_playground_wrong.html", context, status=status)


def _asking(world: World) -> dict[str, Any]:
    """Return what the answer needs to ask for itself again."""
    ask_url = reverse("playground_ask", kwargs={"world": world.name})
    return {"form": "playground-form", "ask_url": ask_url}


def _examples(world: World) -> list[tuple[str, list[tuple[int, str]]]]:
    """Return texts to try with the digits that take them, by what they are; commands of the world come first."""
    own, paper = example_commands(world, OWN_EXAMPLES), _paper_texts(world)
    groups = (
        ("Commands of this world", enumerate(own, start=1)),
        ("Texts of the paper", enumerate(paper, start=len(own) + 1)),
    )
    return [(legend, numbered) for legend, texts in groups if (numbered := list(texts))]


def _paper_texts(world: World) -> list[str]:
    """Return the texts of the paper that name something of this world; of others none is understood here."""
    texts = [probe.text for probe in PAPER_PROBES]
    words = {word for text in texts for word in text.split()}
    names = Entity.objects.filter(ontology__world=world, text__in=words).values_list(
        "text", flat=True
    )
    known = set(names)
    return [text for text in texts if known.intersection(text.split())]


@dataclass(frozen=True, slots=True)
class OfferedCandidates:
    """The candidates of an answer with the share of 1 that their bars have, None for a score that is none: those that
    are ``offered``, and those that are not, each with the reason."""

    offered: tuple[tuple[Mapping[str, Any], float | None], ...]
    left_out: tuple[tuple[Mapping[str, Any], str], ...]


def offered_candidates(answer: Mapping[str, Any]) -> OfferedCandidates:
    """Leave out what is no form, and what would stand there with 0.0 %; the best form stays whatever its score."""
    offered: list[tuple[Mapping[str, Any], float | None]] = []
    left_out: list[tuple[Mapping[str, Any], str]] = []
    for candidate in answer["candidates"]:
        share = _share(candidate["score"], answer["score_kind"])
        if not candidate["is_well_formed"]:
            left_out.append((candidate, "It is no form."))
        elif offered and share is not None and share < LEAST_SHARE:
            left_out.append((candidate, f"It has less than {100 * LEAST_SHARE:g} %."))
        else:
            offered.append((candidate, share))
    return OfferedCandidates(tuple(offered), tuple(left_out))


def _share(score: float, kind: str) -> float | None:
    if kind == ScoreKind.LOG_PROBABILITY:
        return math.exp(min(score, 0.0))
    return min(max(score, 0.0), 1.0) if kind else None


def _alone_in(query: QueryDict) -> tuple[int | None, str]:
    """Return the run that is to answer alone, and the parser that needs none; neither where the world answers."""
    alone = query.get("run", "")
    return (None, ORACLE) if alone == ORACLE else (number_in(alone) or None, "")
