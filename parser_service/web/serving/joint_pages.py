"""Type up to three commands, and see one plan that does them all."""

from __future__ import annotations

from typing import Any
from urllib.parse import urlencode

from django.http import HttpResponse, QueryDict
from django.shortcuts import render
from django.urls import reverse
from django.views.decorators.cache import never_cache
from django_htmx.http import replace_url

from annotations.language.plans import MOST_COMMANDS, JointPlan, say_length
from annotations.language.texts import Refusal
from annotations.models import Duty, World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.people.access import NOTHING, WRITE, WorldRequest, world_view
from parser_service.serving.joint_answers import commands_in, plan_together
from parser_service.serving.parser_client import ParserAway
from parser_service.web.serving.curl_commands import curl_command

MOST_TEXT = MOST_COMMANDS * MOST_CHARACTERS  # of a field, which may hold all commands
TOGETHER = "utterance"  # the field for all of them
FIELDS = [TOGETHER, *(f"command{number}" for number in range(1, MOST_COMMANDS + 1))]


@world_view(Duty.VIEW)
def joint_plan(request: WorldRequest, world: World) -> HttpResponse:
    """Show the commands that the address names; the plan comes when the page has loaded."""
    utterance = _text_of(request.GET, TOGETHER)
    commands = [(name, _text_of(request.GET, name)) for name in FIELDS[1:]]
    is_one_by_one = any(text for _, text in commands)
    context = {
        "utterance": utterance,
        "commands": commands,
        "has_text": bool(utterance) or is_one_by_one,
        "asked": "both" if utterance and is_one_by_one else TOGETHER if utterance else "commands",
        "most_text": MOST_TEXT,
        **_asking(world),
    }
    return render(request, "parser_service/serving/joint_plan.html", context)


@never_cache
@world_view(Duty.VIEW, WRITE, does=NOTHING)
def joint_plan_ask(request: WorldRequest, world: World) -> HttpResponse:
    """Ask the parse server about the commands, and show one plan of them."""
    texts = {name: text for name in FIELDS if (text := _text_of(request.POST, name))}
    context: dict[str, Any] = {"has_text": bool(texts), **_asking(world)}
    if texts:
        try:
            # One field may hold all of them.
            utterances = [each for text in texts.values() for each in commands_in(world, text)]
            answer = plan_together(world, utterances)
            curl = curl_command(request, world, "joint-plan", {"utterances": utterances})
            context |= {"answer": answer.as_json(), "walk": _walk_of(answer.plan), "curl": curl}
        except ParserAway as error:
            context["away"] = error.message
        except Refusal as error:
            context["refused"] = error.message
    response = render(request, "parser_service/serving/_joint_plan_answer.html", context)
    address = reverse("joint_plan", kwargs={"world": world.name})
    return replace_url(response, f"{address}?{urlencode(texts)}" if texts else address)


def _walk_of(plan: JointPlan) -> str:
    """Return how long the walk is, and how long it would be without a joint plan."""
    joint, in_turn = (say_length(each, plan.unit) for each in (plan.length, plan.length_before))
    back = ", with the way back" if plan.ends_at else ""
    return f"Walk: {joint}{back}; one after the other: {in_turn}."


def _asking(world: World) -> dict[str, Any]:
    """Return what the answer needs to ask for itself again."""
    return {
        "form": "joint-form",
        "ask_url": reverse("joint_plan_ask", kwargs={"world": world.name}),
    }


def _text_of(query: QueryDict, name: str) -> str:
    return " ".join(query.get(name, "").replace("\0", "").split())[:MOST_TEXT]
