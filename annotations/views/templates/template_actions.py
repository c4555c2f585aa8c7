"""What is done with a template other than writing it."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect

from annotations.editing.edits import add
from annotations.models import Duty, SemanticTemplate, World
from annotations.models.description import TemplateStatus
from annotations.people.access import WRITE, world_view


@world_view(Duty.ANNOTATE, WRITE)
def template_duplicate(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Make a draft with the same pattern and form, to be changed into something else."""
    row = get_object_or_404(SemanticTemplate, grammar__world=world, pk=pk)
    names = ("grammar", "source", "task_category", "pattern", "form", "problems")
    values = {name: getattr(row, name) for name in names}
    copy = add(SemanticTemplate(status=TemplateStatus.DRAFT, **values), request.user)
    messages.success(request, "This is a copy. It makes no commands until its status is Ready.")
    return redirect("template", world=world.name, pk=copy.pk)
