"""Taking files in, and expanding what they say: at once, or as a job where it takes long."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render

from annotations.background.requesting import keep_report
from annotations.exchange.competition_import import CompetitionReport
from annotations.exchange.import_jobs import (
    start_competition_import,
    start_generator_import,
    start_pairs_import,
)
from annotations.exchange.import_reports import ImportReport, PairsReport
from annotations.generation.generating import GenerationReport, start_generation
from annotations.generation.language_size import language_size
from annotations.language.grammar import readable
from annotations.language.templates import DEFAULT_LIMIT, SampleNote
from annotations.language.texts import LanguageError
from annotations.models import Duty, Job, JobKind, World
from annotations.people.access import READ_AND_WRITE, WRITE, PageRequest, WorldRequest, world_view
from annotations.people.allowances import may_take_long, takes_files
from annotations.people.audit_log import note
from annotations.web.forms import posted
from annotations.web.worlds.exports import exports_of
from annotations.web.worlds.generation_forms import GenerationForm
from annotations.web.worlds.import_forms import CompetitionForm, ImportForm, PairsForm, uploads_of


@takes_files
@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.MANAGE, does="import files")
def import_files(request: WorldRequest, world: World) -> HttpResponse:
    """List what everybody may export. Import the uploaded files of a generator, all of them or nothing."""
    initial = {"keeps_others": "part" in request.GET}
    form = ImportForm(posted(request), request.FILES or None, initial=initial)
    if form.is_bound and form.is_valid():
        try:
            files = uploads_of(world, form)
            choices = form.cleaned_data["brings_back"], form.cleaned_data["encoding"]
            started = start_generator_import(world, files, request.user, *choices)
        except LanguageError as error:
            form.add_error("files", str(error))
        else:
            return _done(request, world, JobKind.IMPORT_GENERATOR, started)
    exports = exports_of(world, request.duties)
    return _page(request, "annotations/worlds/import.html", form, exports=exports)


@takes_files
@world_view(Duty.MANAGE, READ_AND_WRITE, does="import a competition")
def import_competition_files(request: WorldRequest, world: World) -> HttpResponse:
    """Import the folder of a competition, all of it or nothing."""
    form = CompetitionForm(posted(request), request.FILES or None)
    if form.is_bound and form.is_valid():
        values = form.cleaned_data
        try:
            started = start_competition_import(world, values.pop("files"), request.user, **values)
        except LanguageError as error:
            form.add_error("files", str(error))
        else:
            return _done(request, world, JobKind.IMPORT_COMPETITION, started)
    return _page(request, "annotations/worlds/import_competition.html", form)


@takes_files
@world_view(Duty.MANAGE, READ_AND_WRITE, does="import pairs")
def import_pair_files(request: WorldRequest, world: World) -> HttpResponse:
    """Import the uploaded pairs of a published corpus as frozen splits and paraphrases."""
    form = PairsForm(posted(request), request.FILES or None)
    if form.is_bound and form.is_valid():
        values = form.cleaned_data
        choices = values["brings_back"], values["encoding"], values["notation"]
        try:
            started = start_pairs_import(
                world, values["name"], values["archive"], request.user, *choices
            )
        except LanguageError as error:
            form.add_error("archive", str(error))
        else:
            return _done(request, world, JobKind.IMPORT_PAIRS, started)
    return _page(request, "annotations/worlds/import_pairs.html", form)


def _done(
    request: WorldRequest,
    world: World,
    kind: JobKind,
    started: Job | ImportReport | CompetitionReport | PairsReport,
) -> HttpResponse:
    """Show the job, or the report as that of a job, so that it can be reloaded and found again."""
    if not isinstance(started, Job):
        started = keep_report(kind, world.name, request.user, {}, started.as_json())
        if started.failure:
            note(request, started.failure)
    return redirect("job", pk=started.pk)


def _page(request: PageRequest, template: str, form: Any, **context: Any) -> HttpResponse:
    context["form"] = form
    return render(request, template, context, status=422 if form.errors else 200)


@may_take_long
@world_view(Duty.ANNOTATE, WRITE, does="generate commands")
def generate(request: WorldRequest, world: World) -> HttpResponse:
    """Make commands and forms of the templates, as many as the last time."""
    try:
        started = start_generation(world, request.user)
    except LanguageError as error:
        messages.error(request, f"Nothing was generated: {error}")
        return redirect("templates", world=world.name)
    return _generated(request, world, started)


@may_take_long
@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="generate commands")
def generation(request: WorldRequest, world: World) -> HttpResponse:
    """Say how many commands the templates can make, and make all of them or a sample."""
    initial = GenerationForm.initial_of(SampleNote.from_json(world.sample))
    form = GenerationForm(posted(request), initial=initial)
    if form.is_bound and form.is_valid():
        try:
            started = start_generation(world, request.user, form.request)
        except LanguageError as error:
            form.add_error(None, f"Nothing was generated: {error}")
        else:
            return _generated(request, world, started)
    context: dict[str, Any] = {"form": form, "limit": DEFAULT_LIMIT}
    try:
        size = language_size(world)
        context |= {"size": readable(size), "is_too_large": size > DEFAULT_LIMIT}
    except LanguageError as error:
        context["problems"] = [error.problem]
    status = 422 if form.errors else 200
    return render(request, "annotations/worlds/generation.html", context, status=status)


def _generated(
    request: WorldRequest, world: World, started: Job | GenerationReport
) -> HttpResponse:
    """Say what was generated, or show the job that does it."""
    if isinstance(started, Job):
        return redirect("job", pk=started.pk)
    made, changes = started.columns[-1], started.changes
    messages.success(
        request,
        f"{made.commands:,} commands with {made.forms:,} logical forms: "
        f"{changes.added:,} rows added, {changes.changed:,} changed, {changes.removed:,} removed, "
        f"{changes.moved:,} moved.",
    )
    return redirect("commands", world=world.name)
