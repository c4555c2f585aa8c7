"""Pages of a list by keyset: none is skipped, none shown twice, whatever the order."""

from __future__ import annotations

import pytest
from django.db.models import Count

from annotations.models import Command, LogicalForm
from annotations.showing.paging import page_of


@pytest.fixture
def commands(world):
    form = LogicalForm.objects.create(world=world, text="f", head_predicate="go", depth=1, length=3)
    for number in range(23):
        Command.objects.create(
            world=world,
            logical_form=form,
            anonymized_text=f"c{number * 7 % 23:02}",
            length=number % 3,
            position=number,
        )
    return Command.objects.filter(world=world)


def forwards(rows, order, size):
    page = page_of(rows, order, size=size)
    pages = [page.rows]
    while page.after:
        page = page_of(rows, order, after=page.after, size=size)
        pages.append(page.rows)
    return pages, page


@pytest.mark.parametrize("order", ["position", "-position", "length", "-length", "anonymized_text"])
@pytest.mark.parametrize("size", [1, 5, 23, 50])
def test_the_pages_together_are_the_list(commands, order, size):
    sign = "-" if order.startswith("-") else ""
    pages, _ = forwards(commands, order, size)
    assert [row for page in pages for row in page] == list(commands.order_by(order, f"{sign}pk"))


@pytest.mark.parametrize("order", ["position", "-length"])
def test_going_back_shows_the_same_pages(commands, order):
    pages, page = forwards(commands, order, 5)
    back = [page.rows]
    while page.before:
        page = page_of(commands, order, before=page.before, size=5)
        back.insert(0, page.rows)
    assert back == pages


def test_the_first_page_has_none_before_and_the_last_none_after(commands):
    _, last = forwards(commands, "position", 5)
    assert page_of(commands, "position", size=5).before == ""
    assert last.after == "" and last.before


def test_what_a_query_counts_can_be_an_order(world, commands):
    other = LogicalForm.objects.create(
        world=world, text="g", head_predicate="go", depth=1, length=3
    )
    rows = LogicalForm.objects.filter(world=world).annotate(n=Count("commands"))
    first = page_of(rows, "-n", size=1)
    assert page_of(rows, "-n", after=first.after, size=1).rows == [other]


UNREADABLE = ["", "x", "[]", "[1]", '["a", 1]', "{}", "null", '[1, "x"]']
HOSTILE = [
    "[null, 1]",
    "[1e400, 1]",
    "[1, 1e400]",
    "[NaN, 1]",
    f"[{2**70}, 1]",
    f"[1, {2**70}]",
    "[" * 1500,
    "[" + "9" * 5000 + ", 1]",
]


@pytest.mark.parametrize("text", ['["\\u0000", 1]', '["\\ud800", 1]', "[null, 1]"])
def test_a_cursor_with_a_text_that_no_database_takes_is_taken_as_none(commands, text):
    assert page_of(commands, "anonymized_text", after=text, size=5).rows[0].position == 0


@pytest.mark.parametrize("cursor", [*UNREADABLE, *HOSTILE], ids=lambda text: text[:20])
def test_a_cursor_that_does_not_read_is_taken_as_none(commands, cursor):
    assert page_of(commands, "position", after=cursor, size=5).rows[0].position == 0


def test_a_page_costs_one_query(commands, django_assert_num_queries):
    with django_assert_num_queries(1):
        page_of(commands, "position", size=5)
