"""The beginning of a template for a command that has no form yet."""

from __future__ import annotations

from hashlib import sha256
from typing import Any

from django.http import HttpRequest

from annotations.models import TaskCategory, World
from annotations.suggesting import MOST_COMMAND, suggest_forms, suggest_pattern


def suggestions_for_command(request: HttpRequest, world: World) -> dict[str, Any]:
    """Return what the page of a new template shows for the command that its address names; else nothing.

    ``initial`` are the values that its fields begin with; the form is left to the writer where it would be a
    guess. ``draft`` names the place of the draft, so that one of
    another command is not filled in.
    """
    command = " ".join(request.GET.get("command", "").replace("\0", "").split())[:MOST_COMMAND]
    if not command:
        return {}
    about = {"command": command, "draft": sha256(command.encode()).hexdigest()[:12]}
    if request.method == "POST":
        return about
    categories = TaskCategory.objects.filter(grammar__world=world)
    named = categories.filter(name=request.GET.get("task_category", "").replace("\0", ""))
    category = named.first() or categories.last()
    pattern = suggest_pattern(world, category, command)
    suggestions = suggest_forms(world, category, pattern)
    likely = [each.text for each in suggestions if not each.is_guess]
    first = likely[0] if likely else ""
    initial = {"task_category": category, "pattern": pattern, "form": first}
    shown = {"suggestions": suggestions, "chosen": first, "is_first": True}
    return {**about, **shown, "initial": initial}
