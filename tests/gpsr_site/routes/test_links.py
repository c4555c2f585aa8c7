"""Nobody is led to what they may not do: every link and every form of a page answers whoever sees it."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from urllib.parse import urljoin, urlsplit

import pytest
from django.urls import Resolver404, resolve

from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import API_ROUTES
from tests.gpsr_site.routes.policy import NO, POLICY, YES

NO_PAGE = ("/static/", "/docs/")
READ = {rule.name: rule for rule in POLICY if rule.method == "get"}
SENT = {rule.name: rule for rule in POLICY if rule.method == "post"}
# The word of a button that leads to a page on which something is written or chosen.
DOES = re.compile(r"(Add|New|Invite|Write|Make|Paste|Change)\b|(Upload|Import files)$")


class Links(HTMLParser):
    """The links of a page with their words, and where its forms are sent."""

    def __init__(self) -> None:
        super().__init__()
        self.links: dict[str, str] = {}
        self.forms: set[str] = set()
        self._open: list[str] | None = None
        self._href = ""
        self.has_main_form = False
        self._is_in_main = False

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        if tag == "main":
            self._is_in_main = True
        if tag == "a" and values.get("href"):
            self._href, self._open = values["href"], []
        if tag == "form" and values.get("method") == "post":
            self.forms.add(values.get("action") or "")
            self.has_main_form |= self._is_in_main

    def handle_endtag(self, tag):
        if tag == "main":
            self._is_in_main = False
        if tag == "a" and self._open is not None:
            self.links[self._href] = " ".join(" ".join(self._open).split())
            self._open = None

    def handle_data(self, data):
        if self._open is not None:
            self._open.append(data)


def read(page: bytes) -> Links:
    links = Links()
    links.feed(page.decode())
    return links


def route_of(path: str) -> str:
    """Return the name of the route at a path of this site; empty for none."""
    try:
        match = resolve(path)
    except Resolver404:
        return ""
    return match.view_name


def pages_of(person: str, sample) -> list[str]:
    documents = {"documents", "document", "document_image"}
    names = {name for name, rule in READ.items() if getattr(rule, person) == YES} - documents
    return [address(name, sample) for name in sorted(names - set(API_ROUTES))]


@pytest.mark.parametrize("person", ["annotator", "reviewer"])
def test_no_page_leads_to_what_its_reader_may_not_do(person, sample, client_as):
    client = client_as(person)
    refused, empty, seen = set(), set(), set()
    for page in pages_of(person, sample):
        answer = client.get(page)
        if answer.has_header("Content-Disposition") or "text/html" not in answer["Content-Type"]:
            continue
        found = read(answer.content)
        for href, words in found.links.items():
            path = urlsplit(urljoin(page, href)).path
            name = route_of(path)
            if urlsplit(href).netloc or path.startswith(NO_PAGE) or name not in READ:
                continue
            if getattr(READ[name], person) == NO:
                refused.add((page, words, path))
            elif DOES.match(words) and (name, words) not in seen and name not in API_ROUTES:
                seen.add((name, words))
                if not read(client.get(urljoin(page, href)).content).has_main_form:
                    empty.add((page, words, path))
        for action in found.forms:
            name = route_of(urlsplit(urljoin(page, action)).path)
            if name in SENT and getattr(SENT[name], person) == NO:
                refused.add((page, "form", action or page))
    assert not refused, "links and forms that refuse whoever uses them"
    assert not empty, "links that promise a form which is not there"
