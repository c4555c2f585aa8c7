"""Forms suggested for the pattern that somebody types, those of parsers among them."""

from __future__ import annotations

from django.http import HttpResponse
from django.shortcuts import render

from annotations.generation.suggesting import MOST_COMMAND
from annotations.models import Duty, World
from annotations.people.access import NOTHING, WRITE, WorldRequest, world_view
from annotations.web.description.template_forms import TemplateForm
from parser_service.labelling.pattern_suggestions import suggest_with_parsers


@world_view(Duty.ANNOTATE, WRITE, does=NOTHING)
def template_suggestions(request: WorldRequest, world: World) -> HttpResponse:
    """Suggest forms for the typed pattern, which was written for ``command``.

    A page that waits for a parser asks again with ``waiting``: it gets nothing new before the answer is
    there, and nobody is asked about what was typed meanwhile.
    """
    form = TemplateForm(world, None, request.POST)
    pattern = (form["pattern"].value() or "").strip()
    command = request.GET.get("command", "").replace("\0", "")[:MOST_COMMAND]
    is_waiting = "waiting" in request.GET
    by = None if is_waiting else request.user
    suggested = suggest_with_parsers(world, form.chosen_category, pattern, command, by)
    if is_waiting and suggested.waits_for:
        return HttpResponse(status=204)  # htmx leaves the page as it is
    context = {
        "suggested": suggested,
        "suggestions": suggested.forms,
        "example": suggested.example,
        "command": command,
        "chosen": form["form"].value(),
        "has_pattern": bool(pattern),
    }
    return render(request, "annotations/description/_suggested_forms.html", context)
