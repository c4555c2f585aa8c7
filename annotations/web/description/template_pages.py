"""Semantic templates: listed, suggested for a command, checked as one types, saved version by version."""

from __future__ import annotations

from hashlib import sha256
from typing import Any
from urllib.parse import urlencode

from django.contrib import messages
from django.db.models import Count, Q
from django.db.models.functions import Length
from django.http import HttpResponse, JsonResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.utils.cache import patch_cache_control
from django.utils.html import format_html, format_html_join
from django.views.decorators.http import condition

from annotations.editing.edits import Overtaken, add
from annotations.generation.assistance import assist, completion_tag, completions_of
from annotations.generation.suggesting import (
    MOST_COMMAND,
    commands_of,
    duplicate_of,
    say_with_entities,
    suggest_forms,
    suggest_nearest,
    suggest_pattern,
)
from annotations.generation.template_check import (
    CheckedTemplate,
    check_template,
    recall_check,
    samples_of,
)
from annotations.generation.uncovered import next_uncovered
from annotations.generation.world_consequences import WorldConsequences, consequences
from annotations.language.forms import head_predicate, places_in_form, places_in_pattern
from annotations.language.texts import say_count
from annotations.models import Duty, SemanticTemplate, StoredProblem, TaskCategory, User, World
from annotations.models.description import ProblemSubject, TemplateStatus
from annotations.people.access import (
    NOTHING,
    READ_AND_WRITE,
    WRITE,
    PageRequest,
    WorldRequest,
    world_view,
)
from annotations.rows.row_kinds import KINDS
from annotations.showing.form_presentation import form_of
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.paging import number_in
from annotations.web.description.description_filters import TemplateFilters
from annotations.web.description.template_forms import (
    TemplateForm,
    change_to,
    consequences_of_form,
)
from annotations.web.editing.consequence_presentation import groups_of
from annotations.web.editing.merge_pages import merge_page, save_edit
from annotations.web.forms import posted

SORTS = {
    "position": Sort("Task category", "position"),
    "pattern": Sort("Pattern", "pattern"),
    "commands": Sort("Commands", "n_commands", is_number=True),
    "status": Sort("Status", "status"),
}


# Shown above an empty editor, and looked at for them.
EXAMPLES, MOST_EXAMPLES = 3, 100


@world_view(Duty.VIEW)
def templates(request: WorldRequest, world: World) -> HttpResponse:
    """List all templates with what the checker says of each."""
    rows = SemanticTemplate.objects.filter(grammar__world=world)
    listing = Listing(request, TemplateFilters, rows.annotate(n_commands=Count("commands")), SORTS)
    context = {
        "listing": listing,
        "problems": problems_beside_rows(world),
    }
    return render_list(request, "annotations/description/templates.html", context)


def problems_beside_rows(world: World) -> list[StoredProblem]:
    """Return the problems of template files that belong to no template.

    The list shows the others in the rows of their templates.
    """
    rows = SemanticTemplate.objects.filter(grammar__world=world)
    places = set(rows.values_list("source", "line"))
    problems = world.problems.filter(subject=ProblemSubject.TEMPLATES)
    return [each for each in problems if (each.source, each.line) not in places]


def has_written(world: World, user: User) -> bool:
    """Return whether ``user`` is the last author of a template here."""
    return SemanticTemplate.objects.filter(grammar__world=world, author=user).exists()


def example_templates(world: World) -> list[SemanticTemplate]:
    """Return a few short templates with different predicates, as examples for a beginner.

    Templates that name one slot on both sides come first. None has ``UNKNOWN`` in its form.
    """
    rows = SemanticTemplate.objects.filter(
        grammar__world=world, status=TemplateStatus.READY, problems=[]
    )
    known = rows.exclude(form__contains="UNKNOWN").order_by(Length("form"), "position")
    by_predicate: dict[str, SemanticTemplate] = {}
    for row in sorted(known[:MOST_EXAMPLES], key=lambda row: not has_shared_slot(row)):
        form = form_of(row.form)
        if form is not None:
            by_predicate.setdefault(head_predicate(form), row)
    return list(by_predicate.values())[:EXAMPLES]


def has_shared_slot(row: SemanticTemplate) -> bool:
    """Return whether the pattern and the form name one slot that stands for the same value."""
    sides = (places_in_pattern(row.pattern), places_in_form(row.form))
    in_pattern, in_form = ({place.key for place in side} - {None} for side in sides)
    return bool(in_pattern & in_form)


@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="new template")
def template_new(request: WorldRequest, world: World) -> HttpResponse:
    """Write a new template."""
    suggested = suggestions_for_command(request, world)
    form = TemplateForm(world, None, posted(request), initial=suggested.get("initial"))
    if request.method == "POST" and form.is_valid():
        category = form.chosen_category
        change = change_to(None, category, form.values) if category else None
        expected = consequences(world, change) if change else WorldConsequences()
        row = form.store(request.user, form.cleaned_data["once"])
        tell_saved(request, row, "Saved.", expected)
        return redirect(page_after(request, row))
    checked = form.checked or checked_of(world, form)
    context = {
        "form": form,
        "checked": checked,
        "samples": checked and samples_of(world, checked),
        "examples": example_templates(world),
        "is_first_template": not has_written(world, request.user),
        **suggested,
    }
    return render(request, "annotations/description/template.html", context)


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE, does="change template")
def template(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one template: what it means, its commands and its problems. Annotators change it."""
    row, is_there = KINDS["template"].row_or_last_known(world, pk)
    if not is_there and request.method != "POST":
        return redirect("history", world=world.name, kind="template", pk=pk)
    form = TemplateForm(world, row, posted(request))
    context = {"row": row, "form": form, "n_commands": row.commands.count()}
    context["duplicate"] = None if form.is_bound else duplicate_of(world, row)
    if request.method == "POST" and form.is_valid():
        values = form.values
        expected = consequences(world, change_to(row, form.cleaned_data["task_category"], values))
        try:
            row = save_edit(request, row, form, values)
        except Overtaken as clash:
            urls = {
                "check_url": reverse("template_check", args=[world.name]),
                "completion_url": reverse("template_completion", args=[world.name, 0]),
            }
            return merge_page(request, row, form, clash, TemplateForm.shown, **urls)
        tell_saved(request, row, f"Saved as version {row.version}.", expected)
        return redirect(page_after(request, row))
    if request.GET.get("nearest") and Duty.ANNOTATE in request.duties:
        context["nearest"] = suggest_nearest(world, row)
    if (
        not form.is_bound and row.status == TemplateStatus.DRAFT
    ):  # a draft may make too much to look at
        context["checked"] = recall_check(world, row)
    else:
        context["checked"] = checked = form.checked or checked_of(world, form)
        context["samples"] = checked and samples_of(world, checked)
    return render(request, "annotations/description/template.html", context)


def page_after(request: WorldRequest, row: SemanticTemplate) -> str:
    """Return the address after a save: of the template, or with "next" of a new one for the next command.

    That is the next command without a form, behind the one in the address. Without one it is the page of coverage.
    """
    world = row.grammar.world
    if "next" not in request.POST:
        return reverse("template", args=[world.name, row.pk])
    made = commands_of(row) if row.status == TemplateStatus.READY else frozenset()
    following = next_uncovered(world, row.task_category, command_in(request), made)
    if following is None:
        return reverse("uncovered", args=[world.name])
    query = {"task_category": following.task_category, "command": following.text}
    return f"{reverse('template_new', args=[world.name])}?{urlencode(query)}"


def command_in(request: WorldRequest) -> str:
    """Return the command that the address names, with single blanks; empty without one."""
    return " ".join(request.GET.get("command", "").replace("\0", "").split())[:MOST_COMMAND]


def tell_saved(
    request: PageRequest, row: SemanticTemplate, sentence: str, expected: WorldConsequences
) -> None:
    """Tell the reader that the template was saved, what changed, and how many problems it has."""
    is_elsewhere = "next" in request.POST  # the next page is not that of the template
    if is_elsewhere:
        url = reverse("template", args=[row.grammar.world.name, row.pk])
        sentence = format_html('Saved <a href="{}">the template</a>.', url)
    parts = [format_html("{} {}", sentence, what_came_of_it(row, expected))]
    count = len(row.problems)
    if count:
        found, where = say_count(count, "problem"), "" if is_elsewhere else ", listed below"
        parts.append(format_html("The checker sees {} in it{}.", found, where))
    level = messages.WARNING if count else messages.SUCCESS
    messages.add_message(request, level, format_html_join(" ", "{}", ((part,) for part in parts)))


def what_came_of_it(row: SemanticTemplate, expected: WorldConsequences) -> str:
    """Say how the commands changed, with a link to them, or to the job that updates them."""
    world = World.objects.get(grammar=row.grammar_id)
    if world.commands_are_stale:
        jobs = reverse("jobs", kwargs={"world": world.name})
        return format_html('The commands follow in a <a href="{}">job</a>.', jobs)
    if expected.trouble or not row.commands.exists():
        return "" if expected.trouble else expected.sentence
    commands = reverse("commands", kwargs={"world": world.name})
    link = format_html('<a href="{}?template={}">See its commands</a>', commands, row.pk)
    return format_html("{} {}.", expected.sentence, link)


def checked_of(world: World, form: TemplateForm) -> CheckedTemplate | None:
    """Check the form's present content. Return None while a side is empty."""
    typed = typed_in(form)
    return check_template(world, *typed) if typed else None


def typed_in(form: TemplateForm) -> tuple[TaskCategory | None, str, str] | None:
    """Return the task category, the pattern and the logical form as typed; None while one is empty."""
    pattern, logical_form = form["pattern"].value(), form["form"].value()
    if not pattern or not logical_form:
        return None
    # Browsers send the line breaks of a field as two characters, and count them as one.
    return form.chosen_category, *(text.replace("\r\n", "\n") for text in (pattern, logical_form))


@world_view(Duty.ANNOTATE, WRITE, does=NOTHING)
def template_check(request: WorldRequest, world: World) -> JsonResponse:
    """Check what is typed, for the editor."""
    typed = typed_in(TemplateForm(world, None, request.POST))
    return JsonResponse(assist(world, *typed) if typed else {"problems": []})


@world_view(Duty.ANNOTATE)
def template_completion(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Return the completions for templates of a task category. A browser may send the tag that it has."""
    category = get_object_or_404(TaskCategory, grammar__world=world, pk=pk)

    @condition(etag_func=lambda request: f'W/"{completion_tag(category)}"')
    def answer(request: PageRequest) -> HttpResponse:
        return JsonResponse(completions_of(category))

    response = answer(request)
    patch_cache_control(response, private=True, no_cache=True)
    return response


@world_view(Duty.ANNOTATE, WRITE, does=NOTHING)
def template_preview(request: WorldRequest, world: World) -> HttpResponse:
    """Preview what the typed template means, with samples of its commands."""
    checked = checked_of(world, TemplateForm(world, None, request.POST))
    seed = number_in(request.POST.get("seed", ""))
    context = {"checked": checked, "samples": checked and samples_of(world, checked, seed)}
    return render(request, "annotations/description/_template_preview.html", context)


@world_view(Duty.ANNOTATE, WRITE, does=NOTHING)
def template_consequences(request: WorldRequest, world: World) -> HttpResponse:
    """Preview what saving the typed template would change. ``template`` names the stored one."""
    key = request.GET.get("template", "")
    rows = SemanticTemplate.objects.filter(grammar__world=world)
    row = get_object_or_404(rows, pk=number_in(key)) if key else None
    expected = consequences_of_form(TemplateForm(world, row, request.POST))
    context = {"expected": expected, "groups": groups_of(expected) if expected else []}
    return render(request, "annotations/_change_consequences.html", context)


@world_view(Duty.ANNOTATE, WRITE, does="copy a template")
def template_duplicate(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Copy a template as a draft, to be changed into another one."""
    row = get_object_or_404(SemanticTemplate, grammar__world=world, pk=pk)
    names = ("grammar", "source", "task_category", "pattern", "form", "problems")
    values = {name: getattr(row, name) for name in names}
    copy = add(SemanticTemplate(status=TemplateStatus.DRAFT, **values), request.user)
    messages.success(request, "This is a copy. It makes no commands until its status is Ready.")
    return redirect("template", world=world.name, pk=copy.pk)


def suggestions_for_command(request: WorldRequest, world: World) -> dict[str, Any]:
    """Return the context of the page of a new template for the command in its URL; empty without one.

    ``initial`` are the values that its fields begin with. The form is filled in where the first suggestion is
    sure, and left to the writer elsewhere. ``draft`` names the place of the draft of what is typed, so that one
    of another command is not filled in.
    """
    command = command_in(request)
    if not command:
        return {}
    about = {
        "command": command,
        "covering": covering_template(world, command),
        "draft": sha256(command.encode()).hexdigest()[:12],
    }
    if request.method == "POST":
        return about
    categories = TaskCategory.objects.filter(grammar__world=world)
    named = categories.filter(name=request.GET.get("task_category", "").replace("\0", ""))
    category = named.first() or categories.last()
    if category is None:  # a world without a grammar
        return about
    pattern = suggest_pattern(world, category, command)
    suggestions = suggest_forms(world, category, pattern)
    example, suggestions = say_with_entities(world, category, pattern, command, suggestions)
    first = suggestions[0].text if suggestions and suggestions[0].is_sure else ""
    initial = {"task_category": category, "pattern": pattern, "form": first}
    shown = {"suggestions": suggestions, "example": example, "chosen": first, "is_first": True}
    return {**about, **shown, "initial": initial}


def covering_template(world: World, command: str) -> SemanticTemplate | None:
    """Return a template that makes ``command`` or has it as its pattern; None if there is none."""
    rows = SemanticTemplate.objects.filter(grammar__world=world)
    return rows.filter(Q(commands__anonymized_text=command) | Q(pattern=command)).first()
