"""Taking files in, and expanding what they say: at once, or as a job where it takes long."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.core.files.uploadedfile import SimpleUploadedFile
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render

from annotations.exporting.completing import complete
from annotations.forms import posted
from annotations.importing.uploads import files_of
from annotations.jobs.starting import start_generation, start_generator_import, start_pairs_import
from annotations.language.errors import LanguageError
from annotations.models import Duty, Job, JobKind, World
from annotations.people.access import READ_AND_WRITE, WRITE, world_view
from annotations.report_presentation import shown_report
from annotations.upload_forms import ImportForm, PairsForm


@world_view(Duty.MANAGE, READ_AND_WRITE)
def import_files(request: HttpRequest, world: World) -> HttpResponse:
    """Import the uploaded files of a generator, all of them or nothing."""
    initial = {"keeps_others": "part" in request.GET}
    form = ImportForm(posted(request), request.FILES or None, initial=initial)
    report = None
    if form.is_bound and form.is_valid():
        try:
            files, brings_back = uploads_of(world, form), form.cleaned_data["brings_back"]
            started = start_generator_import(world, files, request.user, brings_back)
        except LanguageError as error:
            form.add_error("files", str(error))
        else:
            if isinstance(started, Job):
                return redirect("job", pk=started.pk)
            report = shown_report(JobKind.IMPORT_GENERATOR, started.as_json())
            world.refresh_from_db()
    return _page(request, "annotations/import.html", form, report)


def uploads_of(world: World, form: ImportForm) -> list[Any]:
    """Return the files to import: those that were sent, complete with those of the world if asked for."""
    sent = form.cleaned_data["files"]
    if not form.cleaned_data["keeps_others"]:
        return sent
    files = complete(world, files_of(sent))
    return [SimpleUploadedFile(name, data) for name, data in files.items()]


@world_view(Duty.MANAGE, READ_AND_WRITE)
def import_pair_files(request: HttpRequest, world: World) -> HttpResponse:
    """Import the uploaded pairs of a published corpus as frozen splits and paraphrases."""
    form = PairsForm(posted(request), request.FILES or None)
    report = None
    if form.is_bound and form.is_valid():
        values = form.cleaned_data
        name, archive, brings_back = values["name"], values["archive"], values["brings_back"]
        try:
            started = start_pairs_import(world, name, archive, request.user, brings_back)
        except LanguageError as error:
            form.add_error("archive", str(error))
        else:
            if isinstance(started, Job):
                return redirect("job", pk=started.pk)
            report = shown_report(JobKind.IMPORT_PAIRS, started.as_json())
    return _page(request, "annotations/import_pairs.html", form, report)


def _page(
    request: HttpRequest, template: str, form: Any, report: dict[str, Any] | None
) -> HttpResponse:
    is_refused = bool(form.errors) or bool(report and report["is_refused"])
    context = {"form": form, **(report or {})}
    return render(request, template, context, status=422 if is_refused else 200)


@world_view(Duty.ANNOTATE, WRITE)
def generate(request: HttpRequest, world: World) -> HttpResponse:
    """Expand all templates into commands and forms."""
    try:
        started = start_generation(world, request.user)
    except LanguageError as error:
        messages.error(request, f"Nothing was generated: {error}")
        return redirect("templates", world=world.name)
    if isinstance(started, Job):
        return redirect("job", pk=started.pk)
    made, changes = started.columns[-1], started.changes
    messages.success(
        request,
        f"{made.commands:,} commands with {made.forms:,} logical forms: "
        f"{changes.added:,} rows added, {changes.changed:,} changed, {changes.removed:,} removed, "
        f"{changes.moved:,} only moved.",
    )
    return redirect("commands", world=world.name)
