"""The audit log: of a world for its admins, of all worlds for the administrators of the site."""

from __future__ import annotations

from django.http import HttpResponse

from annotations.models import Duty, World
from annotations.people.access import PageRequest, WorldRequest, site_view, world_view
from annotations.showing.listing import Listing, Sort, render_list
from annotations.web.people.people_filters import AuditEntryFilters, entries_of

SORTS = {"when": Sort("When", "-id")}


@world_view(Duty.MANAGE)
def audit_log(request: WorldRequest, world: World) -> HttpResponse:
    """List who did what in a world, the newest first."""
    return _render_log(request)


@site_view()
def site_log(request: PageRequest) -> HttpResponse:
    """List who did what anywhere, the newest first."""
    return _render_log(request)


def _render_log(request: PageRequest) -> HttpResponse:
    listing = Listing(request, AuditEntryFilters, entries_of(request), SORTS)
    return render_list(request, "annotations/people/audit_log.html", {"listing": listing})
