"""One key has one meaning on all pages, and pages take their keys from the one table."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from annotations.showing.keys import EVERYWHERE, IN_EDITORS, KEYS, OF_PAGES, keys_for

HOUSE = Path(__file__).resolve().parents[3]
TEMPLATES = sorted((HOUSE / "templates").rglob("*.html"))
SCRIPTS = sorted((HOUSE / "static" / "src").glob("*.js"))
NAMED = re.compile(r'data-(?:page-)?action="(\w+)"')
ASKED = re.compile(r'(?:action ===|actionOf\(event\) [!=]==) "(\w+)"')


def test_no_key_has_two_meanings():
    keys = [key for each in (*EVERYWHERE, *OF_PAGES, *IN_EDITORS) for key in each.keys]
    assert len(keys) == len(set(keys))


def test_no_meaning_has_two_names():
    rows = (*EVERYWHERE, *OF_PAGES, *IN_EDITORS)
    assert len(KEYS) == len(rows) == len({each.meaning for each in rows})


@pytest.mark.parametrize("action", ["next", "accept", "reject", "undo"])
def test_each_page_that_decides_about_one_thing_after_the_other_has_the_same_keys(action):
    from annotations.web.campaigns import submission_pages
    from parser_service.web.labelling import audit_pages
    from parser_service.web.reviews import review_pages

    pages = (submission_pages, audit_pages) if action == "reject" else ()
    for page in pages or (submission_pages, audit_pages, review_pages):
        assert KEYS[action] in page.PAGE_KEYS


def test_what_pages_and_scripts_name_stands_in_the_table():
    named = {name for path in TEMPLATES for name in NAMED.findall(path.read_text())}
    asked = {name for path in SCRIPTS for name in ASKED.findall(path.read_text())}
    assert named and asked
    assert (named | asked) - KEYS.keys() == set()


def test_no_template_writes_a_letter_that_the_table_has():
    written = re.compile(r"<kbd[^>]*>[a-z]</kbd>|aria-keyshortcuts=\"[a-z]\"")
    assert [path.name for path in TEMPLATES if written.search(path.read_text())] == []


def test_an_action_without_a_key_is_not_listed():
    with pytest.raises(KeyError):
        keys_for("next", "dance")
