"""Create a world, empty or from an archive; rename and describe one; download one, whole or a part; delete one."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.core.exceptions import ValidationError
from django.db import transaction
from django.http import HttpResponse, StreamingHttpResponse
from django.http.response import HttpResponseBase
from django.shortcuts import redirect, render

from annotations.exchange.world_deletion import count_below, start_deletion
from annotations.exchange.world_import_job import start_world_import
from annotations.language.texts import LanguageError
from annotations.models import Duty, Job, World
from annotations.people.access import (
    READ_AND_WRITE,
    PageRequest,
    WorldRequest,
    demand_site_admin,
    plain_view,
    site_view,
    world_view,
)
from annotations.people.allowances import may_take_long, takes_files
from annotations.people.audit_log import note
from annotations.rows.rows_in_words import rows_in_words
from annotations.showing.listing import MOST_COUNTED
from annotations.web.forms import posted
from annotations.web.sent_texts import MOST_NAMED
from annotations.web.worlds.downloads import archive_of, file_of
from annotations.web.worlds.import_forms import WorldArchiveForm
from annotations.web.worlds.world_forms import DESCRIBES, EXAMPLES, NewWorldForm, WorldEditForm

MOST_DIGITS = 19  # of a key that the database takes


class NameForm(forms.Form):
    """The name of the world, typed once more."""

    name = forms.CharField(
        label="Name of the world",
        max_length=60,
        widget=forms.TextInput(attrs={"autocomplete": "off", "autocapitalize": "none"}),
    )

    def __init__(self, world: World, *args: Any) -> None:
        super().__init__(*args)
        self.world = world

    def clean_name(self) -> str:
        name = self.cleaned_data["name"]
        if name != self.world.name:
            raise ValidationError(f"Type {self.world.name} to delete it.")
        return str(name)


@site_view(READ_AND_WRITE, does="create a world")
def world_new(request: PageRequest) -> HttpResponse:
    """Create a world, empty or with what comes with this project."""
    form = NewWorldForm(posted(request))
    if form.is_bound and form.is_valid() and (created := form.create(request.user)):
        if (job := form.load(created, request.user)) is not None:
            return redirect("job", pk=job.pk)
        begins_by_example = form.cleaned_data["starts_with"] == EXAMPLES
        return redirect("by_example" if begins_by_example else "world", world=created.name)
    return render(request, "annotations/worlds/world_new.html", {"form": form})


@takes_files
@site_view(READ_AND_WRITE, does="import a world")
def world_import(request: PageRequest) -> HttpResponse:
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
            if started.problems:
                messages.warning(request, "; ".join(map(str, started.problems[:MOST_NAMED])))
            return redirect("world", world=name)
    status = 422 if form.errors else 200
    return render(request, "annotations/worlds/world_import.html", {"form": form}, status=status)


@may_take_long
@world_view(Duty.VIEW)
def download(request: WorldRequest, world: World) -> StreamingHttpResponse:
    """Download the whole world as one archive, packed while it is sent."""
    return archive_of(world, request.user)


@may_take_long
@world_view(Duty.VIEW)
def download_part(request: WorldRequest, world: World, part: str) -> HttpResponse:
    """Download a part of a world."""
    return file_of(world, part)


@plain_view(READ_AND_WRITE, does=DESCRIBES)
def world_edit(request: PageRequest, world: str) -> HttpResponseBase:
    """Rename a world, and describe it; also from a page that was opened before another admin renamed it."""
    key = request.POST.get("world", "")
    if request.method == "POST" and key.isdecimal() and len(key) < MOST_DIGITS:
        renamed = World.objects.visible_to(request.user).filter(pk=int(key)).first()
        world = renamed.name if renamed else world
    return _edit_world(request, world=world)


@world_view(Duty.MANAGE, READ_AND_WRITE, does=DESCRIBES)
def _edit_world(request: WorldRequest, world: World) -> HttpResponse:
    with transaction.atomic():
        # The frame goes on showing ``world``; of two admins who save at once, one is first.
        stored = World.objects.hold().get(pk=world.pk)
        before = stored.name
        form = WorldEditForm(stored, request.user, posted(request))
        is_saved = form.is_bound and form.is_valid() and form.change()
    if is_saved:
        now = form.cleaned_data["name"]
        if now != before:
            note(request, f"{before} is called {now} now")
        messages.success(request, f"Saved {now}.")
        return redirect("world_edit", world=now)
    status = 422 if form.errors else 200
    return render(request, "annotations/worlds/world_edit.html", {"form": form}, status=status)


@world_view(Duty.MANAGE, READ_AND_WRITE, does="delete the world")
def world_delete(request: WorldRequest, world: World) -> HttpResponse:
    """Preview the deletion of a world, and delete it when its name has been typed."""
    demand_site_admin(request)
    form = NameForm(world, request.POST if request.method == "POST" else None)
    if form.is_bound and form.is_valid():
        name, started = world.name, start_deletion(world, request.user)
        if isinstance(started, Job):
            return redirect("job", pk=started.pk)
        messages.success(request, f"Deleted {name} with {started:,} rows.")
        return redirect("home")
    below = count_below(world, MOST_COUNTED + 1).items()
    counts = [(rows_in_words(model), count) for model, count in below if count]
    context = {"form": form, "counts": sorted(counts, key=lambda each: -each[1])}
    return render(request, "annotations/worlds/world_delete.html", context)
