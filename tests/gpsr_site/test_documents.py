"""The documents that the site serves, and the links to them on its pages: all lead somewhere."""

from __future__ import annotations

import re
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest
from django.template import Context, Template
from django.urls import resolve, reverse

from gpsr_site.documents import (
    ANCHOR,
    INDEX,
    SHELVES,
    address_of,
    find_document,
    find_image,
    search_documents,
    shelves,
)
from gpsr_site.overview.first_steps import GUIDES

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
FILES = sorted(path.relative_to(DOCS).with_suffix("").as_posix() for path in DOCS.rglob("*.md"))
TEMPLATES = sorted((ROOT / "templates").rglob("*.html"))
TAG = re.compile(r"{% docs (.*?) %}")
LINKS = sorted(
    {target for path in TEMPLATES for target in TAG.findall(path.read_text(encoding="utf-8"))}
    - {"guide_page"}
    | {*GUIDES.values()}
)


class Addresses(HTMLParser):
    """Collects the ids of a page, what it links to and which images it shows."""

    def __init__(self, html: str):
        super().__init__()
        self.ids: list[str] = []
        self.leads_to: list[str] = []
        self.styles: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.ids += [given["id"]] if "id" in given else []
        self.styles += [given["style"]] if "style" in given else []
        self.leads_to += [given[name] for name in ("href", "src") if name in given]


@cache
def parts_of(name: str) -> Addresses:
    document = find_document(name)
    assert document is not None, name
    return Addresses(document.html)


def name_at(address: str) -> str:
    """The name of the document at an address."""
    keys = resolve(address).kwargs
    return f"{keys['shelf']}/{keys['page']}" if keys else INDEX


def test_a_document_has_one_title_and_no_id_twice(subtests):
    for name in FILES:
        with subtests.test(name):
            document = find_document(name)
            assert [each.level for each in document.headings].count(1) == 1
            assert document.headings[0].level == 1 and document.title
            ids = parts_of(name).ids
            assert len(ids) == len(set(ids)) and all(each.startswith(ANCHOR) for each in ids)


def test_what_a_document_links_is_there(subtests):
    for name, target in [(each, target) for each in FILES for target in parts_of(each).leads_to]:
        if target.startswith(("http:", "https:")):
            continue
        with subtests.test(name, target=target):
            address, _, anchor = target.partition("#")
            match = resolve(address)
            if match.url_name == "document_image":
                assert find_image(match.kwargs["name"])
            else:
                assert not anchor or unquote(anchor) in parts_of(name_at(address)).ids


def test_the_policy_of_content_lets_a_document_be_as_it_is():
    """Styles of elements would be refused; numbers are right-aligned by a class."""
    assert not {name: styles for name in FILES if (styles := parts_of(name).styles)}
    assert not [name for name in FILES if "<script" in find_document(name).html]


def test_a_link_of_a_page_names_a_document_and_a_heading(subtests):
    for target in LINKS:
        with subtests.test(target):
            name, _, anchor = target.strip('"').partition("#")
            document = find_document(name)
            assert document is not None and document.shelf in SHELVES.values()
            assert not anchor or document.heading(anchor)


def test_pages_where_people_get_stuck_have_links():
    assert len(LINKS) > 30
    linked = {path.name for path in TEMPLATES if "{% docs" in path.read_text(encoding="utf-8")}
    assert linked >= {
        *("template.html", "grammar.html", "ontology.html", "import.html", "label.html"),
        *("audit.html", "splits.html", "run_new.html", "results.html", "review.html"),
        *("error_categories.html", "playground.html", "robot.html", "accounts.html"),
    }


def rendered(target: str) -> str:
    return Template('{% load documents %}{% docs "' + target + '" %}').render(Context())


def test_a_link_says_what_it_leads_to():
    html = rendered("guides/writing")
    assert html == '<a class="guide" href="/docs/guides/writing/">Guide: Writing templates</a>'
    html = rendered("guides/writing#repairs")
    assert 'href="/docs/guides/writing/#doc-repairs">Guide: Repairs</a>' in html


def test_without_the_document_there_is_no_link(settings, tmp_path):
    assert rendered("guides/nothing") == ""
    settings.DOCS_DIR = tmp_path
    assert rendered("guides/writing") == ""


@pytest.fixture
def nobody(db, client):
    return client


def test_documents_are_read_by_everybody(nobody):
    page = nobody.get(address_of("guides/first-steps"))
    assert page.status_code == 200 and b"A world of your own" in page.content
    assert b"For annotators" in nobody.get(reverse("documents")).content
    image = nobody.get(reverse("document_image", kwargs={"name": "architecture.svg"}))
    assert image["Content-Type"] == "image/svg+xml"
    assert b"<svg" in b"".join(image.streaming_content)


@pytest.mark.parametrize(
    "path",
    [
        "/docs/guides/nothing/",
        "/docs/images/nothing.png",
        "/docs/images/..%2F..%2FREADME.md",
        "/docs/images/../../manage.py",
        "/docs/guides/..%2F..%2FREADME/",
        "/docs/../README/",
        "/docs/images/architecture/",
        "/docs/guides/index/",
        "/docs/images/%00",
    ],
)
def test_nothing_else_is_served(path, nobody, annotator):
    assert nobody.get(path).status_code == 404
    nobody.force_login(annotator)
    assert nobody.get(path).status_code == 404


def test_a_document_that_is_not_there_leads_to_the_list(annotator, client):
    client.force_login(annotator)
    page = client.get("/docs/guides/nothing/")
    assert page.context["where"] == "/docs/"


def test_the_tree_has_every_document_once_in_the_order_of_the_list():
    names = [each.name for documents in shelves().values() for each in documents]
    assert sorted([*names, INDEX]) == FILES
    assert names[0] == "guides/first-steps"
    listed = [target for target in parts_of(INDEX).leads_to if target.startswith("/docs/")]
    assert [address_of(name) for name in names] == listed[1:]  # the introduction links one as well


def test_the_tree_shows_where_one_is(nobody, db):
    page = nobody.get("/docs/guides/splits/").content.decode()
    assert page.count('aria-current="page">Splits</a>') == 1
    assert page.count("<details open>") == 1  # of its shelf


def test_a_search_finds_the_passage_in_any_case_and_leads_to_its_heading():
    first, *_ = search_documents("TREES that")
    assert (first.document.name, first.heading.text) == ("guides/robots", "Trees that try again")
    assert first.word.lower() in ("trees", "that")
    name, _, anchor = first.url.partition("#")
    assert anchor in parts_of(name_at(name)).ids


def test_a_search_takes_all_words_and_nothing_for_none():
    assert search_documents("") == search_documents("  ") == []
    assert search_documents("systemd qqqzzz") == []
    both = search_documents("systemd worker")
    assert both and all(
        "systemd" in f"{each.heading.text}{passage.text}".lower()
        for each in both
        for passage in each.document.passages
        if passage.heading == each.heading
    )


def test_a_word_is_found_as_it_stands_after_letters_that_fold_to_two(tmp_path, settings):
    (tmp_path / "guides").mkdir()
    (tmp_path / "index.md").write_text("# All\n\n[One](guides/one.md)\n")
    (tmp_path / "guides" / "one.md").write_text(
        "# One\n\nDas Weißbier steht im *Schrank* <b>dort</b>.\n"
    )
    settings.DOCS_DIR = tmp_path
    [hit] = search_documents("schrank")
    assert (hit.before, hit.word, hit.after) == ("Das Weißbier steht im ", "Schrank", " dort.")


def test_what_is_searched_for_is_shown_as_text(nobody, db):
    page = nobody.get("/docs/", {"q": "<b>one & [two"}).content.decode()
    assert "&lt;b&gt;one &amp; [two" in page and "<b>one" not in page


def test_every_page_leads_to_the_documents(sample, annotator, client):
    client.force_login(annotator)
    for path in ("/", "/w/home/", "/docs/"):
        assert b'<a href="/docs/"' in client.get(path).content


def test_the_container_has_what_pages_are_made_of():
    lines = (ROOT / "Containerfile").read_text(encoding="utf-8").splitlines()
    assert {"COPY templates ./templates", "COPY docs ./docs"} <= set(lines)
