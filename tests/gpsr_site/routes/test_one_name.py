"""One page, one name: rail, breadcrumb, heading and title call it the same."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from html.parser import HTMLParser

from django.urls import get_resolver

from gpsr_site.pages.rail import all_entries, way_to
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import (
    ALL_ROUTES,
    API_ROUTES,
    ROUTES_OF_WORLDS,
    list_routes,
)
from tests.gpsr_site.routes.policy import POLICY
from tests.gpsr_site.routes.rules import undone

METHODS = sorted({(rule.name, rule.method) for rule in POLICY if rule.name not in API_ROUTES})
# The list of all worlds and what is about no kind of work have no entry in the rail of a world.
WITHOUT_ENTRY = {"search", "search_found", "comment"}
DOCUMENTS = {"documents", "document"}  # their heading is that of the text


def test_no_two_routes_have_one_name():
    """A link by that name would lead to either: the pages of a noun are named by its kind."""
    names = [name for name, _ in list_routes(get_resolver().url_patterns)]
    assert [name for name, count in Counter(names).items() if count > 1] == []


@dataclass
class Names(HTMLParser):
    """What a page calls itself: the texts of its title, headings and breadcrumb, and the entry of the rail."""

    title: str = ""
    headings: list[str] = field(default_factory=list)
    crumbs: list[str] = field(default_factory=list)
    marked: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()
        self.inside: list[tuple[str, dict[str, str | None]]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag in {"input", "meta", "link", "br", "img", "source", "hr", "wbr"}:
            return
        self.inside.append((tag, dict(attrs)))
        if tag == "h1":
            self.headings.append("")
        if tag == "li" and self.is_in("class", "breadcrumb"):
            self.crumbs.append("")
        if tag == "a" and self.is_in("id", "rail") and dict(attrs).get("aria-current") == "page":
            self.marked.append("")

    def handle_endtag(self, tag: str) -> None:
        while self.inside and self.inside.pop()[0] != tag:
            pass

    def handle_data(self, data: str) -> None:
        tags = [tag for tag, _ in self.inside]
        if "svg" in tags or self.is_in("class", "count") or self.is_in("class", "rail-count"):
            return
        if tags[-1:] == ["title"]:
            self.title += data
        elif "h1" in tags:
            self.headings[-1] += data
        elif self.is_in("class", "breadcrumb") and "li" in tags:
            self.crumbs[-1] += data
        elif self.marked and self.is_in("id", "rail") and self.is_in("aria-current", "page"):
            self.marked[-1] += data if not self.is_in("class", "visually-hidden") else ""

    def is_in(self, name: str, value: str) -> bool:
        return any(attributes.get(name) == value for _, attributes in self.inside)


def names_of(answer) -> Names | None:
    """Return the names of a page with the frame; None for parts of pages, files, redirects and refusals."""
    if answer.status_code not in (200, 422) or "text/html" not in answer["Content-Type"]:
        return None
    text = answer.getvalue().decode()
    if 'class="topbar"' not in text:
        return None
    names = Names()
    names.feed(text)
    return names


def plain(text: str) -> str:
    """Without the brackets of class tokens, which a heading shows as chips."""
    return " ".join(text.replace("<", "").replace(">", "").split())


def test_a_page_has_one_name(sample, client_as, subtests):
    for name, method in METHODS:
        with subtests.test(name, method=method), undone():
            names = names_of(getattr(client_as("superuser"), method)(address(name, sample)))
            if names is not None:
                check_names(name, names)


def check_names(page: str, names: Names) -> None:
    called = plain(names.crumbs[-1])
    assert called, names
    if page not in DOCUMENTS:
        assert [plain(heading) for heading in names.headings] == [called], names
    assert plain(names.title).startswith(called), names
    if page in ROUTES_OF_WORLDS - WITHOUT_ENTRY:
        (entry,) = names.marked
        assert plain(entry) in map(plain, names.crumbs), names


def test_a_place_has_the_name_of_its_entry(sample, client_as, subtests):
    for entry in all_entries():
        if entry.has_page:
            with subtests.test(entry.label), undone():
                names = names_of(client_as("superuser").get(address(entry.page, sample)))
                assert plain(names.crumbs[-1]) == entry.label


def test_every_entry_is_the_way_to_its_own_page():
    for entry in all_entries():
        *_, last = way_to(entry.page)
        assert last.page == entry.page and entry.page in ALL_ROUTES
        for page in entry.pages_below:
            assert way_to(page)[-1] is entry and page in ALL_ROUTES


def test_no_place_has_the_name_of_another():
    labels = [entry.label for entry in all_entries()]
    assert len(labels) == len(set(labels))
