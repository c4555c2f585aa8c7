"""The audit log: of a world for its admins, of all worlds for the administrators of the site."""

from __future__ import annotations

import django_filters
from django import forms
from django.http import HttpRequest, HttpResponse

from annotations.lists.filtering import PageFilters, Search
from annotations.lists.listing import Listing, Sort, render_list
from annotations.models import AuditEntry, Duty, World
from annotations.people.access import site_view, world_view

SORTS = {"when": Sort("When", "-id")}


def _entries(request: HttpRequest):
    world = getattr(request, "world", None)
    return AuditEntry.objects.filter(world=world) if world else AuditEntry.objects.all()


def who_choices(request: HttpRequest) -> list[tuple[str, str]]:
    """Return everybody who has done something."""
    names = _entries(request).order_by("who_name").values_list("who_name", flat=True).distinct()
    return [(name, name) for name in names]


def what_choices(request: HttpRequest) -> list[tuple[str, str]]:
    """Return all that was done."""
    names = _entries(request).order_by("what").values_list("what", flat=True).distinct()
    return [(name, name) for name in names]


class AuditEntryFilters(PageFilters):
    q = Search("subject", "through")
    who_name = django_filters.ChoiceFilter(label="Who")
    what = django_filters.ChoiceFilter(label="What")
    since = django_filters.DateFilter(
        "at", "date__gte", label="Since", widget=forms.DateInput(attrs={"type": "date"})
    )
    world_choices = {"who_name": who_choices, "what": what_choices}


@world_view(Duty.MANAGE)
def audit_log(request: HttpRequest, world: World) -> HttpResponse:
    """List who did what in a world, the newest first."""
    return _render_log(request)


@site_view()
def site_log(request: HttpRequest) -> HttpResponse:
    """List who did what anywhere, the newest first."""
    return _render_log(request)


def _render_log(request: HttpRequest) -> HttpResponse:
    listing = Listing(request, AuditEntryFilters, _entries(request), SORTS)
    return render_list(request, "annotations/audit_log.html", {"listing": listing})
