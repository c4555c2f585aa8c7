"""Deleting a world, which only administrators of the site may do."""

from __future__ import annotations

from django import forms
from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render

from annotations.jobs.starting import start_deletion
from annotations.models import Duty, Job, World
from annotations.people.access import READ_AND_WRITE, demand_site_admin, world_view
from annotations.worlds.world_deletion import count_below


class NameForm(forms.Form):
    """The name of the world, typed once more."""

    name = forms.CharField(
        label="Name of the world",
        max_length=60,
        widget=forms.TextInput(attrs={"autocomplete": "off", "autocapitalize": "none"}),
    )

    def __init__(self, world: World, *args: object) -> None:
        super().__init__(*args)
        self.world = world

    def clean_name(self) -> str:
        name = self.cleaned_data["name"]
        if name != self.world.name:
            raise ValidationError(f"Type {self.world.name} to delete it.")
        return name


@world_view(Duty.MANAGE, READ_AND_WRITE)
def world_delete(request: HttpRequest, world: World) -> HttpResponse:
    """Show what would go, and delete the world when its name has been typed."""
    demand_site_admin(request)
    form = NameForm(world, request.POST if request.method == "POST" else None)
    if form.is_bound and form.is_valid():
        name, started = world.name, start_deletion(world, request.user)
        if isinstance(started, Job):
            return redirect("job", pk=started.pk)
        messages.success(request, f"Deleted {name} with {started:,} rows.")
        return redirect("home")
    counts = [
        (model._meta.verbose_name_plural, count) for model, count in count_below(world).items()
    ]
    context = {"form": form, "counts": sorted(counts, key=lambda each: -each[1])}
    return render(request, "annotations/world_delete.html", context)
