"""Taking files in, and expanding what they say."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render

from annotations.access import READ_AND_WRITE, WRITE, world_view
from annotations.forms import ImportForm, PairsForm, posted
from annotations.generating import generate_pairs
from annotations.importing import import_generator, import_pairs
from annotations.language.errors import LanguageError
from annotations.models import Duty, World
from annotations.uploads import files_of, unpacked_pairs


@world_view(Duty.MANAGE, READ_AND_WRITE)
def import_files(request: HttpRequest, world: World) -> HttpResponse:
    """Uploads the files of a generator; all of them are taken in, or nothing."""
    form = ImportForm(posted(request), request.FILES or None)
    context = {"form": form}
    if form.is_bound and form.is_valid():
        try:
            files = files_of(form.cleaned_data["files"])
            context["report"] = import_generator(world.name, files, request.user)
        except LanguageError as error:
            form.add_error("files", str(error))
    is_refused = form.errors or ("report" in context and context["report"].is_refused)
    return render(request, "annotations/import.html", context, status=422 if is_refused else 200)


@world_view(Duty.MANAGE, READ_AND_WRITE)
def import_pair_files(request: HttpRequest, world: World) -> HttpResponse:
    """Uploads the pairs of a published corpus; they become frozen splits and paraphrases."""
    form = PairsForm(posted(request), request.FILES or None)
    context = {"form": form}
    if form.is_bound and form.is_valid():
        name, archive = form.cleaned_data["name"], form.cleaned_data["archive"]
        try:
            with unpacked_pairs(archive) as folder:
                context["report"] = import_pairs(world.name, name, folder, request.user)
        except LanguageError as error:
            form.add_error("archive", str(error))
    is_refused = form.errors or ("report" in context and context["report"].is_refused)
    return render(
        request, "annotations/import_pairs.html", context, status=422 if is_refused else 200
    )


@world_view(Duty.ANNOTATE, WRITE)
def generate(request: HttpRequest, world: World) -> HttpResponse:
    """Expands all templates into commands and forms."""
    try:
        report = generate_pairs(world)
    except LanguageError as error:
        messages.error(request, f"Nothing was generated: {error}")
        return redirect("templates", world=world.name)
    made, changes = report.columns[-1], report.changes
    messages.success(
        request,
        f"{made.commands:,} commands with {made.forms:,} logical forms: "
        f"{changes.added:,} rows added, {changes.changed:,} changed, {changes.removed:,} removed.",
    )
    return redirect("commands", world=world.name)
