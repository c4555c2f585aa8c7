"""Create a world, empty or from an archive, and download one."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse, StreamingHttpResponse
from django.shortcuts import redirect, render

from annotations.forms import WorldForm, posted
from annotations.jobs.starting import start_world_import
from annotations.language.errors import LanguageError
from annotations.models import Duty, Job, World
from annotations.people.access import READ_AND_WRITE, site_view, world_view
from annotations.upload_forms import WorldArchiveForm
from annotations.world_archive import archive_name, world_archive


@site_view(READ_AND_WRITE)
def world_new(request: HttpRequest) -> HttpResponse:
    """Create an empty world; its files are imported next."""
    form = WorldForm(posted(request))
    if form.is_bound and form.is_valid() and (created := form.create()):
        return redirect("import", world=created.name)
    return render(request, "annotations/world_new.html", {"form": form})


@site_view(READ_AND_WRITE)
def world_import(request: HttpRequest) -> HttpResponse:
    """Create a world from the archive of another one."""
    form = WorldArchiveForm(posted(request), request.FILES or None)
    if form.is_bound and form.is_valid():
        name = form.cleaned_data["name"]
        try:
            started = start_world_import(name, form.cleaned_data["archive"], request.user)
        except LanguageError as error:
            form.add_error("archive", str(error))
        else:
            if isinstance(started, Job):
                return redirect("job", pk=started.pk)
            rows = sum(started.rows.values())
            messages.success(request, f"Imported {name} with {rows:,} rows.")
            return redirect("world", world=name)
    status = 422 if form.errors else 200
    return render(request, "annotations/world_import.html", {"form": form}, status=status)


@world_view(Duty.VIEW)
def download(request: HttpRequest, world: World) -> StreamingHttpResponse:
    """Download the whole world as one archive, packed while it is sent."""
    answer = StreamingHttpResponse(world_archive(world), content_type="application/zip")
    answer["Content-Disposition"] = f'attachment; filename="{archive_name(world)}"'
    return answer
