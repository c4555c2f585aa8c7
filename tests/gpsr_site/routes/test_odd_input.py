"""Whatever somebody writes into an address or a form, the answer is never an error of the server.

The routes, filters, orders and fields are asked of the site itself, so that new ones are tried too.
"""

from __future__ import annotations

import json
import re
from urllib.parse import quote

import pytest
from django.db import connection
from django.urls import get_resolver

from annotations.showing.listing import Listing
from annotations.showing.paging import page_of, read_cursor
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import ALL_ROUTES
from tests.gpsr_site.routes.policy import POLICY
from tests.gpsr_site.routes.rules import undone
from tests.sample_world import SampleWorld

FORM = "application/x-www-form-urlencoded"
SURROGATE = b"\xed\xa0\x80"
# One of each kind; a kind is what one reader of a value may fail on.
ODD_VALUES = [
    "",
    "[null,1]",
    "1e400",
    "NaN",
    "a\0b",
    SURROGATE,
    b"\xff\xfe",
    "[" * 1500,
    "(" * 1500,
    "{" * 1500,
    "²",
    "9" * 5000,
    str(2**63),
    str(-(2**63) - 1),
    "-1",
    "1.5",
    "{}",
    "a" * 20_000,
    "\u202e💩 % ' OR 1=1 -- ../../etc/passwd",
]
# Tried in each field of a form by itself, while the others hold what they should.
WORST_VALUES = ["a\0b", SURROGATE, "²", str(2**63), "[" * 1500, "1e400"]
# What another database than SQLite may take otherwise; the rest never comes as far as a database.
if connection.vendor != "sqlite":
    ODD_VALUES = ["a\0b", SURROGATE, "NaN", "9" * 5000, str(2**31), str(2**63), "a" * 20_000]
    WORST_VALUES = ["a\0b", SURROGATE, str(2**63)]
FILE_FIELDS = {
    **{"import": b"files", "import_pairs": b"archive", "world_import": b"archive"},
    **{"import_competition": b"files", "utterances_new": b"file", "api:upload-list": b"file"},
    **{"api:import": b"files", "api:import-pairs": b"archive", "api:import-world": b"archive"},
    "api:import-competition": b"files",
}
CURSORS = [
    *("[null,1]", "[1e400,1]", "[1,1e400]", '["\\u0000",1]', '["\\ud800",1]', "[[1],1]", "[{},1]"),
    *("[true,1]", "[1,null]", "[1,true]", "[1.5,1]", '["²",1]', "[" * 1500 + "]" * 1500, "[-1,-1]"),
    *(
        f"[{2**63},1]",
        f"[1,{2**63}]",
        f"[1,{2**64}]",
        f'["{"9" * 5000}",1]',
        '["nan",1]',
        "[NaN,1]",
    ),
    *('["",1]', '["a",1]', "[1,1]", '[1,"1"]', f"[{'9' * 5000},1]", "[Infinity,1]", '["1e400",1]'),
]
# What views read of an address beside their filters.
OTHER_PARAMETERS = (
    "sort",
    "after",
    "before",
    "parser",
    "split",
    "part",
    "show",
    "as",
    "source",
    "q",
    "utterance",
    "without",
    "page",
    "command",
    *("run", "example", "from", "focus"),
)
LARGE_KEYS = [2**31, 2**63 - 1, 2**63, 2**64, int("9" * 400)]

GET_ROUTES = sorted({rule.name for rule in POLICY if rule.method == "get"} - {"admin:index"})
POST_ROUTES = sorted({rule.name for rule in POLICY if rule.method == "post"} - {"logout"})


def in_query(parameters: dict[str, str | bytes]) -> str:
    return "&".join(f"{quote(name)}={quote(value)}" for name, value in parameters.items())


def joined(path: str, query: str) -> str:
    return f"{path}{'&' if '?' in path else '?'}{query}"


@pytest.fixture
def root(client_as):
    return client_as("superuser")


def check(answer, what: object) -> None:
    assert answer.status_code < 500, f"{answer.status_code} for {str(what)[:300]}"
    if answer.streaming:
        b"".join(answer.streaming_content)


def filters_and_orders(answer) -> tuple[set[str], list[str]]:
    """The parameters of the list on a page, and the orders it can be in."""
    listing = (answer.context or {}).get("listing") if answer.context else None
    if listing is None:
        return set(), []
    return set(listing.form.fields), list(getattr(listing, "sorts", ()))


def test_odd_values_in_an_address(sample: SampleWorld, client_as, subtests):
    for name in GET_ROUTES:
        with subtests.test(name), undone():
            ask_with_odd_values(client_as("superuser"), address(name, sample))


def ask_with_odd_values(root, path: str) -> None:
    answer = root.get(path)
    if answer.status_code == 405:
        return
    filters, orders = filters_and_orders(answer)
    parameters = sorted({*filters, *OTHER_PARAMETERS})
    alone = {"hx-request": "true"} if orders else {}  # a list without the frame around it
    for value in ODD_VALUES if orders else WORST_VALUES:
        query = in_query(dict.fromkeys(parameters, value))
        check(root.get(joined(path, query), headers=alone), query)
    check(root.get(joined(path, f"{query}&{query}")), "twice")
    if orders:
        page = in_query({"sort": orders[-1], "before": CURSORS[-1]})
        check(root.get(joined(path, page), headers=alone), page)
        listing = answer.context["listing"]
        if isinstance(listing, Listing):  # others are paged by number
            check_cursors(listing)


def check_cursors(listing) -> None:
    """Ask the rows of a list for the page beside each cursor that can be read, in each order."""
    for sort in listing.sorts.values():
        for number, cursor in enumerate(CURSORS):
            if read_cursor(listing.matching.model, sort.field, cursor):
                beside = {("after", "before")[number % 2]: cursor}
                page_of(listing.matching, sort.field, size=2, **beside)


def test_keys_that_no_row_can_have(sample: SampleWorld, root, subtests):
    for name in (each for each in GET_ROUTES if "<int:" in ALL_ROUTES[each]):
        for key in LARGE_KEYS:
            path = re.sub(r"/\d+/", f"/{key}/", address(name, sample))
            with subtests.test(name, key=key), undone():
                assert root.get(path).status_code in (404, 405)


def test_names_of_worlds_that_cannot_be(sample: SampleWorld, root):
    for name in ("a" * 5000, "9" * 5000, "-", "_"):
        assert root.get(f"/w/{name}/").status_code == 404


def fields_of(root, path: str) -> dict[str, object]:
    """The fields of the form at an address with what they hold; none where it shows no form."""
    answer = root.get(path)
    form = (answer.context or {}).get("form") if answer.context else None
    if form is None or not hasattr(form, "fields"):
        return {}
    return {
        form.add_prefix(name): "" if (value := form[name].value()) is None else value
        for name in form.fields
    }


# What is sent to routes whose form stands on the page of another.
FIELDS_ELSEWHERE = {
    "template_check": ("task_category", "pattern", "form", "status"),
    "template_preview": ("task_category", "pattern", "form", "status", "seed"),
    "delete_row": ("version",),
    "template_consequences": ("task_category", "pattern", "form", "status"),
    "predicate_preview": ("name", "kind", "signatures", "gloss"),
    "production_check": ("nonterminal", "expansion", "source"),
    "production_preview": ("nonterminal", "expansion", "source"),
    "member": ("roles", "remove"),
    "invite": ("invite-note", "invite-roles", "invite-places", "invite-days"),
    "token_new": ("name", "scope", "days"),
    "join": ("username", "password1", "password2"),
    "label_answer": ("verdict", "form", "version", "seconds", "reason"),
    "label_check": ("form",),
    "label_send": ("text",),
    "label_mend": ("words", "entity", "version"),
    "example_send": ("reason", "next"),
    "predictions_send": ("reason", "next"),
    "paraphrase_label": ("form", "version"),
    "paraphrase_check": ("form",),
    "paraphrase_runs_start": ("parser",),
    "queue_assign": ("person", "count"),
    "queue_ask": ("reason",),
    "queue_act": ("step", "person"),
    "queue_settle": ("choice", "form"),
    "submission_decide": ("decision", "text", "form", "reason"),
    "submissions_decide": ("decision", "row"),
    "submissions_take_back": ("at",),
    "campaign": ("agrees",),
    "campaign_place": ("text", "shown", "pasted", "advised"),
    "campaign_check": ("text",),
    "campaign_done": ("helped",),
    "login": ("username", "password", "next"),
}


def test_odd_values_in_a_form(sample: SampleWorld, client_as, monkeypatch, subtests):
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
    for name in POST_ROUTES:
        person = "anonymous" if name in ("login", "join") else "superuser"
        with subtests.test(name), undone():
            post_odd_values(client_as(person), name, address(name, sample))


def post_odd_values(root, name: str, path: str) -> None:
    usual = fields_of(root, path) or dict.fromkeys(FIELDS_ELSEWHERE.get(name, ()), "")
    sent = {key: str(each) for key, each in usual.items() if isinstance(each, str | int | float)}
    refused = set()
    for value in ODD_VALUES if usual else [""]:
        answer = root.post(path, in_query({**sent, **dict.fromkeys(usual, value)}), FORM)
        check(answer, value)
        refused |= {(field, value) for field in fields_refused(answer)}
    for field in usual:
        passing = [value for value in WORST_VALUES if (field, value) not in refused]
        # What a field refuses goes no further, whichever value it was: one of them is enough.
        stopped = [value for value in WORST_VALUES if (field, value) in refused][:1]
        for value in passing + stopped:
            check(root.post(path, in_query({**sent, field: value}), FORM), (field, value))


def fields_refused(answer) -> set[str]:
    """The fields of the form on a page whose values are refused."""
    form = (answer.context or {}).get("form") if answer.context else None
    return {form.add_prefix(name) for name in getattr(form, "errors", ()) if name in form.fields}


ODD_FILES = [b"", b"\0" * 100, b"PK\x03\x04" + b"\xff" * 50, b"[" * 5000]
ODD_NAMES = [b"a.xml", b"x.zip", b"common_rules.txt", b"a" * 300, SURROGATE + b".txt", b"..", b"\0"]


@pytest.mark.parametrize("name", ODD_NAMES, ids=range(len(ODD_NAMES)))
def test_odd_files(name, sample: SampleWorld, root):
    for data in ODD_FILES:
        for route, field in FILE_FIELDS.items():
            part = b'Content-Disposition: form-data; name="%s"; filename="%s"' % (field, name)
            body = b"--x\r\n%s\r\n\r\n%s\r\n--x--\r\n" % (part, data)
            kind = "multipart/form-data; boundary=x"
            check(root.post(address(route, sample), body, content_type=kind), (route, name, data))


BODIES = [
    ("application/json", b"{"),
    ("multipart/form-data; boundary=x", b"\xff"),
    ("a\0/b", b"{"),
]
# What alone reads JSON can fail on.
JSON_BODIES = [
    ("application/json", b"[" * 2000),
    ("application/json", b"\xff"),
    ("application/json", json.dumps({"a": "\ud800"}).encode()),
    ("text/plain", b"{"),
]
JSON_ROUTES = [name for name in POST_ROUTES if name.startswith("api:") or name == "draft"]


@pytest.mark.parametrize(("kind", "body"), BODIES, ids=range(len(BODIES)))
def test_odd_bodies_of_any_kind(kind, body, sample: SampleWorld, root):
    for name in POST_ROUTES:
        check(root.post(address(name, sample), body, content_type=kind), (name, kind, body))


@pytest.mark.parametrize(("kind", "body"), JSON_BODIES, ids=range(len(JSON_BODIES)))
def test_odd_bodies_where_json_is_read(kind, body, sample: SampleWorld, root):
    for name in JSON_ROUTES:
        check(root.post(address(name, sample), body, content_type=kind), (name, kind, body))


@pytest.mark.parametrize(
    "header", ["", "Bearer", "Bearer \xff", "Bearer " + "a" * 5000, "Basic Og=="]
)
def test_odd_headers(header, sample: SampleWorld, client):
    path = address("api:split-export", sample)
    check(client.get(path, headers={"authorization": header}), header)
    check(client.get("/", headers={"cookie": f"sessionid={header}; csrftoken={header}"}), header)
    check(client.get("/", headers={"x-forwarded-for": header, "referer": header}), header)


def test_every_route_that_takes_something_is_tried():
    names = {name for name, _ in ALL_ROUTES.items()}
    assert names - {"admin:index", "logout"} <= {*GET_ROUTES, *POST_ROUTES}
    assert get_resolver().url_patterns
