"""Semantic templates: listed, checked while they are written, saved version by version."""

from __future__ import annotations

from collections import defaultdict

from django.contrib import messages
from django.db.models import Count
from django.http import HttpRequest, HttpResponse, JsonResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.access import READ_AND_WRITE, WRITE, world_view
from annotations.checking import Checked, check_template
from annotations.editing import Overtaken, add_template, change_template
from annotations.filters import TemplateFilters
from annotations.forms import TemplateForm, posted
from annotations.listing import Listing, Sort
from annotations.models import Duty, SemanticTemplate, StoredProblem, TaskCategory, World
from annotations.models.problems import Subject

SORTS = {
    "position": Sort("Task category", "position"),
    "pattern": Sort("Pattern", "pattern"),
    "commands": Sort("Commands kept", "n_commands", is_number=True),
    "status": Sort("Status", "status"),
}


@world_view(Duty.VIEW)
def templates(request: HttpRequest, world: World) -> HttpResponse:
    """All templates with what the checker says of each."""
    rows = SemanticTemplate.objects.filter(grammar__world=world)
    rows = rows.annotate(n_commands=Count("commands"))
    listing = Listing(request, TemplateFilters, rows, SORTS)
    problems = list(world.problems.filter(subject=Subject.TEMPLATES))
    remarks = by_place(problems)
    context = {
        "listing": listing,
        "rows": [(row, remarks.get((row.source, row.line), ())) for row in listing.rows],
        "problems": problems,
    }
    return render(request, "annotations/templates.html", context)


def by_place(problems: list[StoredProblem]) -> dict[tuple[str, int], list[StoredProblem]]:
    found = defaultdict(list)
    for problem in problems:
        found[problem.source, problem.line].append(problem)
    return found


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def template_new(request: HttpRequest, world: World) -> HttpResponse:
    """A new template."""
    form = TemplateForm(world, posted(request))
    if request.method == "POST" and form.is_valid():
        made = add_template(
            by=request.user, category=form.cleaned_data["task_category"], **sides(form)
        )
        messages.success(request, "Saved. Generate commands to see it in the tables.")
        return redirect("template", world=world.name, pk=made.pk)
    context = {"form": form, "checked": checked_of(world, form)}
    return render(request, "annotations/template.html", context)


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def template(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """One template: what it says, makes and lacks; annotators change it."""
    row = get_object_or_404(
        SemanticTemplate.objects.select_related("author"), grammar__world=world, pk=pk
    )
    form = TemplateForm(world, posted(request), initial=initial_of(world, row))
    form.fields["task_category"].disabled = True
    context = {"row": row, "form": form}
    if request.method == "POST" and form.is_valid():
        try:
            change_template(
                row, by=request.user, version=form.cleaned_data["version"] or 0, **sides(form)
            )
        except Overtaken as clash:
            context["clash"] = clash
            form.data = {**form.data.dict(), "version": clash.current.version}
        else:
            messages.success(request, f"Saved version {row.version}.")
            return redirect("template", world=world.name, pk=pk)
    context["checked"] = checked_of(world, form)
    status = 409 if "clash" in context else 200
    return render(request, "annotations/template.html", context, status=status)


def initial_of(world: World, row: SemanticTemplate) -> dict[str, object]:
    category = TaskCategory.objects.filter(grammar__world=world, name=row.task_category).first()
    names = ("pattern", "form", "status", "version")
    return {"task_category": category, **{name: getattr(row, name) for name in names}}


def sides(form: TemplateForm) -> dict[str, str]:
    """What the person wrote and chose, without the rest of the form."""
    return {name: form.cleaned_data[name] for name in ("pattern", "form", "status")}


def checked_of(world: World, form: TemplateForm) -> Checked | None:
    """What the checker says of the form's present content; None while it is empty."""
    pattern, logical_form = form["pattern"].value(), form["form"].value()
    if not pattern or not logical_form:
        return None
    categories = form.fields["task_category"].queryset
    chosen = form["task_category"].value()
    key = chosen.pk if isinstance(chosen, TaskCategory) else chosen
    category = categories.filter(pk=key).first() if str(key).isdigit() else None
    return check_template(world, category or categories.last(), pattern, logical_form)


@world_view(Duty.ANNOTATE, WRITE)
def template_check(request: HttpRequest, world: World) -> JsonResponse:
    """What the editor asks while somebody types."""
    checked = checked_of(world, TemplateForm(world, request.POST))
    return JsonResponse(checked.as_json() if checked else {"problems": []})


@world_view(Duty.ANNOTATE, WRITE)
def template_preview(request: HttpRequest, world: World) -> HttpResponse:
    """What the typed template says and makes."""
    checked = checked_of(world, TemplateForm(world, request.POST))
    return render(request, "annotations/_template_preview.html", {"checked": checked})
