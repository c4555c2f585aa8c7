"""One word, one meaning: what pages, REST, commands and documents say, held against docs/reference/words.md."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path

import pytest
from django.core.management import get_commands, load_command_class

from annotations.language.texts import article, looks_plural
from parser_service.parsers.registry import parsers
from tests.filled_world import leave_traces
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.policy import POLICY

ROOT = Path(__file__).resolve().parents[3]
WORDS = ROOT / "docs" / "reference" / "words.md"
PAGES = sorted(
    {rule.name for rule in POLICY if rule.method == "get" and not rule.name.startswith("api:")}
)
OWN_APPS = ("annotations", "parser_service", "gpsr_site")
# What programs read, and what people wrote.
QUOTED = {"script", "style", "template", "code", "pre", "kbd", "textarea", "q"}
INLINE = {"a", "abbr", "b", "em", "i", "mark", "small", "span", "strong", "sup", "time"}
TOLD = ("title", "aria-label", "placeholder", "alt")
VOID = {"input", "meta", "link", "br", "img", "source", "hr", "wbr", "col", "path", "line"}


def unsaid() -> list[str]:
    """Return the words of the table "Not said"."""
    _, _, section = WORDS.read_text(encoding="utf-8").partition("## Not said")
    rows = re.findall(r"^\| ([^|]+) \|", section, re.MULTILINE)
    assert rows[:2] == ["not", "---"] and len(rows) > 5
    return rows[2:]


UNSAID = re.compile(rf"\b(?:{'|'.join(map(re.escape, unsaid()))})s?\b", re.IGNORECASE)
# Names in the registry, but not those of files; "linear" and "ranker" are words too.
REGISTERED = re.compile(
    rf"(?<![\w/-])(?:{'|'.join(sorted(parsers().keys() - {'linear', 'ranker'}, reverse=True))})(?![\w-]|\.md)"
)


class Texts(HTMLParser):
    """What a page says to its reader, a line for each block; what is quoted stands as "…"."""

    def __init__(self) -> None:
        super().__init__()
        self.said: list[str] = []
        self.quoted: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        told = [value for name, value in attrs if name in TOLD and value]
        if tag in QUOTED or (self.quoted and tag == self.quoted[-1]):
            self.said.append("…" if not self.quoted else "")
            self.quoted.append(tag)
        elif not self.quoted:
            self.said += [f"\n{each}\n" for each in told]
            self.said.append("" if tag in INLINE else "\n")

    def handle_endtag(self, tag: str) -> None:
        if self.quoted and tag == self.quoted[-1]:
            self.quoted.pop()
        elif not self.quoted and tag not in INLINE:
            self.said.append("\n")

    def handle_data(self, data: str) -> None:
        if not self.quoted:
            self.said.append(re.sub(r"\s+", " ", data))

    @property
    def lines(self) -> set[str]:
        lines = (" ".join(line.split()) for line in "".join(self.said).splitlines())
        return {line for line in lines if line}


@pytest.fixture
def pages(sample, client_as, logged_in_people) -> Iterator[tuple[str, set[str]]]:
    """Every page that a superuser reads, in a world that people have worked in, with its lines."""
    leave_traces(sample.world, *(logged_in_people[who][0] for who in ("annotator", "admin")))
    return lines_of_pages(sample, client_as("superuser"))


def lines_of_pages(sample, client) -> Iterator[tuple[str, set[str]]]:
    for name in PAGES:
        answer = client.get(address(name, sample))
        if "text/html" in answer.get("Content-Type", ""):
            texts = Texts()
            texts.feed(answer.getvalue().decode())
            yield name, texts.lines


def wrong_articles(line: str) -> list[str]:
    """Return what has "a" before a vowel, or "an" before a consonant."""
    pairs = re.findall(r"(?<![\w'’.-])([Aa]n?) ([A-Za-z][\w-]+)", line)
    return [f"{said} {noun}" for said, noun in pairs if said.lower() != article(noun)]


def wrong_plurals(line: str) -> list[str]:
    """Return what is one and is said of many."""
    ones = re.findall(r"(?<![\w.,:–-])1 ([a-z]{2,})\b", line)
    return [f"1 {noun}" for noun in ones if looks_plural(noun)]


def test_pages_use_each_word_in_one_meaning(pages):
    faults = {}
    for name, lines in pages:
        for line in lines:
            found = [*UNSAID.findall(line), *REGISTERED.findall(line)]
            if found := [*found, *wrong_articles(line), *wrong_plurals(line)]:
                faults[name, line] = found
    assert faults == {}


def test_templates_say_none_of_these_words_in_any_state():
    faults = []
    for path in sorted((ROOT / "templates").rglob("*.html")):
        text = re.sub(
            r"{%.*?%}|{{.*?}}|{#.*?#}", "…", path.read_text(encoding="utf-8"), flags=re.DOTALL
        )
        said = UNSAID.findall(re.sub(r' (?:class|id)="[^"]*"', "", text))
        faults += [(str(path.relative_to(ROOT)), word) for word in said]
    assert faults == []


def test_rest_says_none_of_these_words(client_as):
    schema = client_as("superuser").get("/api/v1/schema/?format=json").content.decode()
    assert UNSAID.findall(schema.replace("_", " ")) == []


def test_commands_say_none_of_these_words():
    for name, app in get_commands().items():
        if isinstance(app, str) and app in OWN_APPS:
            parser = load_command_class(app, name).create_parser("manage.py", name)
            assert UNSAID.findall(parser.format_help()) == [], name


def test_documents_say_none_of_these_words():
    faults = []
    for path in (*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md"):
        text = path.read_text(encoding="utf-8")
        if path == WORDS:
            text = text.partition("## Not said")[0]
        said = UNSAID.findall(re.sub(r"`[^`\n]*`", "…", text))
        faults += [(str(path.relative_to(ROOT)), word) for word in said]
    assert faults == []


def test_what_is_wrong_is_found():
    assert wrong_articles("374 with a object, an unit and a utterance; an hour") == [
        *("a object", "an unit", "a utterance")
    ]
    assert wrong_plurals("1 commands of 1 class, 21 forms and 1.1 shares") == ["1 commands"]
    assert UNSAID.search("27 Remarks") and not UNSAID.search("remarkable")
    assert REGISTERED.search("run 1: knn") and not REGISTERED.search("Nearest neighbour, Seq2seq")
