"""What every page shows around its content: rail, breadcrumb, tabs and the state of the workers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any
from urllib.parse import unquote

from django.conf import settings
from django.contrib.auth.models import AnonymousUser
from django.http import HttpRequest
from django.urls import reverse
from django.utils.functional import SimpleLazyObject

from annotations.language.texts import say_count
from annotations.models import Duty, Notice, User, World
from gpsr_site.overview.counts import LARGE, Counts, counts_of
from gpsr_site.overview.workers import workers_now
from gpsr_site.pages.rail import GROUPS, RailEntry, way_to

MOST_UNREAD = 99  # the top bar says that there are more
CLOSED_NOTICE = "closed_notice"  # the cookie that names the notice which the reader has closed
LAST_WORLD = "last_world"  # the cookie that names the world of the last page: static/src/last-world.js writes it


@dataclass(frozen=True, slots=True)
class RailLink:
    """A ``RailEntry`` as the rail or a row of tabs draws it; ``dot`` says what waits there, and ``counted`` how long
    ago ``count`` was counted, where that is minutes."""

    label: str
    url: str
    count: int | None
    dot: str
    is_current: bool
    counted: str = ""


@dataclass(frozen=True, slots=True)
class RailGroup:
    """The links below one heading of the rail."""

    heading: str
    links: list[RailLink]


@dataclass(frozen=True, slots=True)
class Crumb:
    """A step of the breadcrumb above the page."""

    label: str
    url: str


def frame(request: HttpRequest) -> dict[str, Any]:
    """Return the context of every page. What costs a query is looked up where a template reads it, once."""
    user = request.user
    return {
        "sso": settings.SSO_NAME,
        "worlds": World.objects.visible_to(user),
        "worker": SimpleLazyObject(workers_now),
        "closed_notice": unquote(request.COOKIES.get(CLOSED_NOTICE, "")),
        "unread": SimpleLazyObject(lambda: _count_unread(user) if user.is_authenticated else 0),
        **_frame_of_world(request),
    }


def _count_unread(user: User) -> int:
    """Count no further than the top bar says: more would be joined with all comments."""
    return Notice.objects.of(user).unread().order_by()[: MOST_UNREAD + 1].count()


def _frame_of_world(request: HttpRequest) -> dict[str, Any]:
    """Return what stands around a page of a world. Outside of any world the rail is that of the last one."""
    world: World | None = getattr(request, "world", None)
    duties: frozenset[Duty] = getattr(request, "duties", frozenset())
    can = {duty.value: duty in duties for duty in Duty}
    if world is None:
        last: Any = SimpleLazyObject(lambda: _last_world(request))
        rail = SimpleLazyObject(lambda: _rail_of_last(last, request.user) if last else [])
        nothing: dict[str, Any] = {key: [] for key in ("tabs", "views", "trail")}
        return {
            **{"world": None, "rail_world": last, "can": can, "rail": rail},
            **{**nothing, "page_name": ""},
        }
    # One count for the rail and the tabs, once one of them is drawn.
    counts: Any = SimpleLazyObject(lambda: getattr(request, "counts", None) or counts_of(world))
    page, way = _way_of(request)
    here = way[-1] if way and way[-1].page == page else None
    return {
        "world": world,
        "rail_world": world,
        "can": can,
        "rail": SimpleLazyObject(lambda: _rail(world, counts, duties, way)),
        "tabs": SimpleLazyObject(lambda: _tabs(world, counts, duties, way[:2]) if here else []),
        "views": SimpleLazyObject(lambda: _tabs(world, counts, duties, way[1:]) if here else []),
        "trail": [
            Crumb(entry.label, _url_of(world, entry.page_for(duties)))
            for entry in way
            if entry is not here
        ],
        "page_name": way[-1].label if way else "",
    }


def _last_world(request: HttpRequest) -> World | None:
    """Return the world that the reader saw last; None where there is none, or they may no longer see it."""
    name = request.COOKIES.get(LAST_WORLD)
    return World.objects.visible_to(request.user).filter(name=name).first() if name else None


def _rail_of_last(world: World, user: User | AnonymousUser) -> list[RailGroup]:
    duties = world.duties_of(user) if user.is_authenticated else frozenset()
    return _rail(world, counts_of(world), duties, ())


def _way_of(request: HttpRequest) -> tuple[str, tuple[RailEntry, ...]]:
    """Return the URL name of the page and the entries on the way to it."""
    match = request.resolver_match
    if match is None or match.url_name is None:
        return "", ()
    # A page about any kind of row belongs to the list of that kind.
    return match.url_name, way_to(match.kwargs.get("kind", match.url_name))


def _rail(
    world: World, counts: Counts, duties: frozenset[Duty], way: tuple[RailEntry, ...]
) -> list[RailGroup]:
    return [
        RailGroup(
            group.heading,
            [_link(entry, world, counts, duties, entry in way) for entry in group.entries],
        )
        for group in GROUPS
    ]


def _tabs(
    world: World, counts: Counts, duties: frozenset[Duty], way: tuple[RailEntry, ...]
) -> list[RailLink]:
    """Return the tabs of the first entry of ``way``, of which the last is current. An entry whose page bears its
    name is the first of them; one without tabs has no row."""
    if not way:
        return []
    entry, here = way[0], way[-1]
    tabs = [tab for tab in entry.tabs if tab.duty in duties]
    if tabs and entry.has_page and entry.duty in duties:
        # What waits on the entry's own page alone.
        tabs.insert(0, replace(entry, tabs=()))
    return [_link(tab, world, counts, duties, tab.page == here.page) for tab in tabs]


def _link(
    entry: RailEntry, world: World, counts: Counts, duties: frozenset[Duty], is_current: bool
) -> RailLink:
    minutes = int(counts.age / 60) if entry.count in LARGE else 0
    return RailLink(
        label=entry.label,
        url=_url_of(world, entry.page_for(duties)),
        count=getattr(counts, entry.count) if entry.count else None,
        dot=entry.sentence(counts),
        is_current=is_current,
        counted=f"counted {say_count(minutes, 'minute')} ago" if minutes else "",
    )


def _url_of(world: World, entry: RailEntry) -> str:
    return reverse(entry.page, kwargs={"world": world.name}) + entry.query
