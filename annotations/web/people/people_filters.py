"""What accounts and the audit log may be filtered by. Each name is a parameter of the page's URL."""

from __future__ import annotations

import django_filters
from django import forms
from django.db.models import QuerySet

from annotations.models import AuditEntry
from annotations.people.access import PageRequest
from annotations.showing.filtering import PageFilters, Search


def entries_of(request: PageRequest) -> QuerySet[AuditEntry]:
    """Return the audit log of the page's world, or of the whole site on a page without a world."""
    world = getattr(request, "world", None)
    return AuditEntry.objects.filter(world=world) if world else AuditEntry.objects.all()


def who_choices(request: PageRequest) -> list[tuple[str, str]]:
    """Return the names of all who appear in the audit log."""
    names = entries_of(request).order_by("who_name").values_list("who_name", flat=True).distinct()
    return [(name, name) for name in names]


def what_choices(request: PageRequest) -> list[tuple[str, str]]:
    """Return all actions that appear in the audit log."""
    names = entries_of(request).order_by("what").values_list("what", flat=True).distinct()
    return [(name, name) for name in names]


class AuditEntryFilters(PageFilters):
    q = Search("subject", "through")
    who_name = django_filters.ChoiceFilter(label="Who")
    what = django_filters.ChoiceFilter(label="What")
    since = django_filters.DateFilter(
        "at", "date__gte", label="Since", widget=forms.DateInput(attrs={"type": "date"})
    )
    world_choices = {"who_name": who_choices, "what": what_choices}


class AccountFilters(PageFilters):
    q = Search("username")
    is_active = django_filters.ChoiceFilter(
        label="Account", choices=[("True", "open"), ("False", "closed")]
    )
