"""A list as a page shows it: filtered, sorted and paged by its URL."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from django.db.models import QuerySet
from django.http import HttpRequest, QueryDict
from django_filters import FilterSet

from annotations.paging import PAGE_SIZE, Page, page_of

PLACE = ("after", "before")


@dataclass(frozen=True, slots=True)
class Chip:
    """One active filter: what it says, and where the list is without it."""

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
    """What a list may be sorted by: the column's title and the field (never null) behind it."""

    title: str
    field: str
    is_number: bool = False


class Listing:
    """``rows`` under the filters, order and place that the URL of ``request`` asks for.

    ``sorts`` are by the names that the URL may use; the first is the order without a choice.
    """

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
        self.sorts = sorts
        self.size = size

    @property
    def form(self) -> Any:
        """The filters as a form; filling it reads the URL."""
        return self.filterset.form

    @cached_property
    def matching(self) -> QuerySet[Any]:
        """All rows that pass the filters."""
        return self.filterset.qs

    @cached_property
    def total(self) -> int:
        return self.matching.count()

    @cached_property
    def page(self) -> Page:
        after, before = self.query.get("after", ""), self.query.get("before", "")
        return page_of(self.matching, self.order, after, before, self.size)

    @property
    def rows(self) -> Sequence[Any]:
        return self.page.rows

    @property
    def order(self) -> str:
        field = self.sorts[self.sort_name].field
        if not self.is_descending:
            return field
        return field[1:] if field.startswith("-") else f"-{field}"

    @property
    def sort_name(self) -> str:
        name = self.query.get("sort", "").lstrip("-")
        return name if name in self.sorts else next(iter(self.sorts))

    @property
    def is_descending(self) -> bool:
        return self.query.get("sort", "") == f"-{self.sort_name}"

    @cached_property
    def columns(self) -> dict[str, Column]:
        """For each sort the head of its column: a click sorts by it, or turns its order round."""
        return {name: self._column(name, sort) for name, sort in self.sorts.items()}

    def _column(self, name: str, sort: Sort) -> Column:
        is_current = name == self.sort_name
        turned = f"-{name}" if is_current and not self.is_descending else name
        is_down = self.order.startswith("-")
        direction = ("descending" if is_down else "ascending") if is_current else ""
        return Column(sort.title, self.url(sort=turned), direction, sort.is_number)

    @property
    def summary(self) -> str:
        """How many rows there are, in a few words."""
        shown, total = len(self.rows), self.total
        return f"{total:,}" if shown == total else f"{shown:,} of {total:,}"

    @property
    def clear_url(self) -> str:
        """The list without any filter."""
        return "?"

    @property
    def next_url(self) -> str:
        return self.url(after=self.page.after) if self.page.after else ""

    @property
    def previous_url(self) -> str:
        return self.url(before=self.page.before) if self.page.before else ""

    @property
    def has_unknown_filters(self) -> bool:
        """Whether the URL asks for something that no filter knows; the list leaves that out."""
        return not self.form.is_valid()

    @cached_property
    def chips(self) -> list[Chip]:
        """The filters that are active, each with the way to drop it."""
        self.form.is_valid()  # fills cleaned_data with what is valid
        values = self.form.cleaned_data
        return [
            Chip(
                str(self.form.fields[name].label), self._label(name, value), self.url(**{name: ""})
            )
            for name, value in values.items()
            if value not in (None, "", [])
        ]

    def _label(self, name: str, value: Any) -> str:
        choices = dict(getattr(self.form.fields[name], "choices", ()))
        return str(choices.get(value, value))

    def url(self, **changes: str) -> str:
        """The same list with some of its parameters changed (empty: dropped), from its first page."""
        query = QueryDict(mutable=True)
        query.update({k: v for k, v in self.query.items() if k not in PLACE and v})
        for name, value in changes.items():
            query[name] = value
        kept = QueryDict(mutable=True)
        kept.update({name: value for name, value in query.items() if value})
        return f"?{kept.urlencode(safe='/')}"
