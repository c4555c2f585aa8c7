"""Lists as pages show them: filtered, sorted and paged by the URL."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import Any

from django.core.paginator import Paginator
from django.db.models import QuerySet
from django.http import HttpRequest, HttpResponse, QueryDict
from django.shortcuts import render
from django.utils.cache import patch_vary_headers
from django_filters import FilterSet

from annotations.people.access import PageRequest
from annotations.showing.paging import PAGE_SIZE, Page, opposite, page_of

PLACE = ("after", "before", "page", "finding")
MOST_COUNTED = (
    10_000  # rows of a stored list; a page says that there are more, and reads no further
)


@dataclass(frozen=True, slots=True)
class Chip:
    """An active filter: its label and value, and the URL of the list without it."""

    label: str
    value: str
    remove_url: str


@dataclass(frozen=True, slots=True)
class Column:
    """The head of a sortable column: ``direction`` is empty, ``ascending`` or ``descending``."""

    title: str
    url: str
    direction: str
    is_number: bool


@dataclass(frozen=True, slots=True)
class Sort:
    """Something to sort a list by: the column's title and the field behind it, which is never null."""

    title: str
    field: str
    is_number: bool = False


class FilteredList:
    """What all lists have in common: filters and an order that stand in the URL, and links to the same list with
    others.

    ``form`` holds the filters, bound to the URL; those called ``further`` stand behind a button. ``sorts``
    are the orders by the names that the URL may use; the first is the default.
    """

    query: QueryDict
    form: Any
    further: Sequence[str] = ()
    sorts: Mapping[str, Sort]

    @property
    def first_fields(self) -> list[Any]:
        """The fields of the filters that are always shown."""
        return [field for field in self.form if field.name not in self.further]

    @property
    def further_fields(self) -> list[Any]:
        """The fields behind the button."""
        return [field for field in self.form if field.name in self.further]

    @property
    def n_further(self) -> int:
        """How many of the filters behind the button are set."""
        self.form.is_valid()
        values = self.form.cleaned_data
        return sum(values.get(name) not in (None, "", []) for name in self.further)

    @property
    def clear_url(self) -> str:
        """The list without any filter."""
        return "?"

    @property
    def has_unknown_filters(self) -> bool:
        """Whether the URL has a value that its filter does not know; the list ignores it."""
        return not self.form.is_valid()

    @cached_property
    def chips(self) -> list[Chip]:
        """The active filters, each with the URL that removes it."""
        self.form.is_valid()  # fills cleaned_data with what is valid
        chips: list[Chip] = []
        for name, value in self.form.cleaned_data.items():
            if value not in (None, "", []):
                field = self.form.fields[name]
                label = dict(getattr(field, "choices", ())).get(value, value)
                chips.append(Chip(str(field.label), str(label), self.url(**{name: ""})))
        return chips

    def url(self, **changes: str) -> str:
        """Return the URL of the first page of this list with ``changes``; an empty value is removed."""
        query = QueryDict(mutable=True)
        for name, values in self.query.lists():
            if name not in PLACE:
                query.setlist(name, values)
        for name, value in changes.items():
            query[name] = value
        given = QueryDict(mutable=True)
        for name, values in query.lists():
            if some := [value for value in values if value]:
                given.setlist(name, some)
        return f"?{given.urlencode(safe='/')}"

    @property
    def order(self) -> str:
        field = self.sorts[self.sort_name].field
        return opposite(field) if self.is_descending else field

    @property
    def sort_name(self) -> str:
        name = self.query.get("sort", "").lstrip("-")
        return name if name in self.sorts else next(iter(self.sorts))

    @property
    def is_descending(self) -> bool:
        return self.query.get("sort", "") == f"-{self.sort_name}"

    @cached_property
    def columns(self) -> dict[str, Column]:
        """The head of the column of each sort: a click sorts by it, or reverses the order."""
        columns: dict[str, Column] = {}
        current = "descending" if self.order.startswith("-") else "ascending"
        for name, sort in self.sorts.items():
            is_current = name == self.sort_name
            url = self.url(sort=f"-{name}" if is_current and not self.is_descending else name)
            columns[name] = Column(sort.title, url, current if is_current else "", sort.is_number)
        return columns


class Listing(FilteredList):
    """``rows`` under the filters, order and page that the URL of ``request`` asks for."""

    def __init__(
        self,
        request: HttpRequest,
        filters: type[FilterSet],
        rows: QuerySet[Any],
        sorts: Mapping[str, Sort],
        size: int = PAGE_SIZE,
        **options: Any,
    ):
        self.query = request.GET
        self.filterset = filters(request.GET, queryset=rows, request=request, **options)
        self.further = getattr(filters, "further", ())
        self.sorts = sorts
        self.size = size

    @property
    def form(self) -> Any:
        """The filters as a form, filled from the URL."""
        return self.filterset.form

    @cached_property
    def matching(self) -> QuerySet[Any]:
        """All rows that pass the filters."""
        rows: QuerySet[Any] = self.filterset.qs
        return rows

    @cached_property
    def total(self) -> int:
        """How many rows pass the filters, and one more than ``MOST_COUNTED`` where there are more than that."""
        return count_some(self.matching)

    @cached_property
    def page(self) -> Page:
        after, before = self.query.get("after", ""), self.query.get("before", "")
        return page_of(self.matching, self.order, after, before, self.size)

    @property
    def rows(self) -> Sequence[Any]:
        return self.page.rows

    @property
    def summary(self) -> str:
        """How many rows are shown and how many there are, such as ``50 of 1,211``."""
        shown, total = len(self.rows), self.total
        return f"{total:,}" if shown == total else f"{shown:,} of {say_total(total)}"

    @property
    def next_url(self) -> str:
        return self.url(after=self.page.after) if self.page.after else ""

    @property
    def previous_url(self) -> str:
        return self.url(before=self.page.before) if self.page.before else ""


class NumberedPages(FilteredList):
    """A list that was computed rather than stored, filtered already and paged by number.

    Args:
        form: the filters, bound to the query of ``request``.
        sorts: the orders, by attributes of the rows; without any the rows stay as they are.
    """

    def __init__(
        self,
        request: HttpRequest,
        form: Any,
        computed: Sequence[Any],
        size: int = PAGE_SIZE,
        sorts: Mapping[str, Sort] | None = None,
    ) -> None:
        self.query = request.GET
        self.form = form
        self.sorts = sorts or {}
        if sorts:
            # Equal rows keep their order.
            field = self.order
            by_field = attrgetter(field.lstrip("-"))
            computed = sorted(computed, key=by_field, reverse=field.startswith("-"))
        self.paginator = Paginator(computed, size)
        self.page = self.paginator.get_page(self.query.get("page"))

    @property
    def total(self) -> int:
        return self.paginator.count

    @property
    def rows(self) -> Sequence[Any]:
        rows = self.page.object_list
        assert isinstance(rows, Sequence)  # a slice of what was computed
        return rows

    @property
    def summary(self) -> str:
        """Which rows are shown and how many there are, such as ``51–100 of 1,211``."""
        first, last = self.page.start_index(), self.page.end_index()
        return f"{first:,}–{last:,} of {self.total:,}"

    @property
    def next_url(self) -> str:
        has_next = self.page.has_next()
        return self.url(page=str(self.page.next_page_number())) if has_next else ""

    @property
    def previous_url(self) -> str:
        has_previous = self.page.has_previous()
        return self.url(page=str(self.page.previous_page_number())) if has_previous else ""


def count_some(rows: QuerySet[Any]) -> int:
    """Count rows, and read no further than one more than ``MOST_COUNTED``."""
    return rows.order_by()[: MOST_COUNTED + 1].count()


def say_total(total: int) -> str:
    """Return the ``total`` of a list in words: ``1,211`` or ``over 10,000``."""
    return f"{total:,}" if total <= MOST_COUNTED else f"over {MOST_COUNTED:,}"


def render_list(request: PageRequest, template: str, context: dict[str, Any]) -> HttpResponse:
    """Render a page with a list; htmx, which replaces the list alone, gets it without the frame.

    The template extends the one that ``base`` names.
    """
    base = "_fragment.html" if request.htmx else "base.html"
    response = render(request, template, {**context, "base": base})
    patch_vary_headers(response, ["HX-Request"])  # so that no cache gives one for the other
    return response
