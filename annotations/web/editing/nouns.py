"""Kinds of rows that people list, add, change and undo, each declared once.

From a ``Noun`` come its pages with their addresses; its routes read what is sent by the same form (``noun_rest``). A
page that is more than its noun is written out beside the declaration.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any
from urllib.parse import urlencode

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import Http404, HttpResponse
from django.shortcuts import redirect, render
from django.urls import URLPattern, path, reverse
from django_filters import FilterSet

from annotations.editing.edits import Overtaken
from annotations.editing.once_keys import made_before
from annotations.language.texts import Problem
from annotations.models import Duty, World
from annotations.people.access import (
    NOTHING,
    READ_AND_WRITE,
    WRITE,
    PageRequest,
    View,
    WorldRequest,
    world_view,
)
from annotations.rows.row_kinds import EditableKind, kind_of_model
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.paging import number_in
from annotations.web.editing.merge_pages import merge_page, save_edit
from annotations.web.editing.noun_forms import NounForm
from annotations.web.forms import posted


class Noun:
    """One kind of editable row: its form, its list and its pages.

    The templates get ``row`` (none for a new one), ``form``, ``query`` (names the row in the address of the preview)
    and what ``context`` adds.
    """

    form: type[NounForm]
    template: str  # of a row, and of a new one
    new_template = ""  # where that differs
    preview_template = ""
    list_template = ""
    filters: type[FilterSet]
    sorts: Mapping[str, Sort]
    page_size = 200

    @cached_property
    def kind(self) -> EditableKind:
        return kind_of_model(self.form.model)

    def addresses(self, at: str) -> list[URLPattern]:
        """Return the addresses of the pages below ``at``, such as ``predicates/``."""
        name, pages = self.kind.name, [("new/", self.new_page, "_new")]
        if self.preview_template:
            pages.append(("preview/", self.preview_page, "_preview"))
        pages.append(("<int:pk>/", self.row_page, ""))
        found = [path(f"{at}{below}", page, name=f"{name}{end}") for below, page, end in pages]
        if self.list_template:
            found.append(path(at, self.list_page, name=self.kind.list_page))
        return found

    # What a noun may add.

    def title_of(self, row: Any) -> str:
        """Return what the row is called in a sentence."""
        return str(row)

    def context(
        self, request: WorldRequest, world: World, row: Any | None, form: Any
    ) -> Mapping[str, Any]:
        """Return what the page of a row, or of a new one, shows beside the form."""
        return {}

    def list_context(self, world: World, listing: Listing) -> Mapping[str, Any]:
        """Return what the list shows beside its rows."""
        return {}

    def preview(self, request: WorldRequest, world: World, form: Any) -> Mapping[str, Any]:
        """Return what the preview of a typed row shows."""
        return {}

    def merging(self, world: World, row: Any) -> Mapping[str, Any]:
        """Return what the page of a clash needs to check and complete the fields."""
        return {}

    def asked(self, request: WorldRequest, world: World) -> Mapping[str, Any]:
        """Return what the fields of a new row begin with."""
        return {}

    def alike(self, row: Any) -> Mapping[str, str]:
        """Return what the address of the next new row says after this one: what it is likely to begin with."""
        return {}

    def missing(self, request: WorldRequest, world: World) -> HttpResponse | None:
        """Return the page that says what a world lacks before it can have such a row; None where it lacks nothing."""
        return None

    # The pages.

    @cached_property
    def list_page(self) -> View:
        @world_view(Duty.VIEW)
        def page(request: WorldRequest, world: World) -> HttpResponse:
            rows = self.kind.rows_of(world)
            listing = Listing(request, self.filters, rows, self.sorts, size=self.page_size)
            context = {"listing": listing, **self.list_context(world, listing)}
            return render_list(request, self.list_template, context)

        return page

    @cached_property
    def row_page(self) -> View:
        @world_view(
            Duty.VIEW,
            READ_AND_WRITE,
            write_duty=self.kind.write_duty,
            does=f"change {self.kind.singular}",
        )
        def page(request: WorldRequest, world: World, pk: int) -> HttpResponse:
            row, is_there = self.kind.row_or_last_known(world, pk)
            if not is_there and request.method != "POST":
                return redirect("history", world=world.name, kind=self.kind.name, pk=pk)
            form = self.form(world, row, posted(request))
            if request.method == "POST" and form.is_valid():
                remarks = form.remarks
                try:
                    row = save_edit(request, row, form, form.values)
                except Overtaken as clash:
                    more = self.merging(world, row)
                    return merge_page(request, row, form, clash, self.form.shown, **more)
                except ValidationError as error:
                    form.add_error(None, error)
                else:
                    tell_saved(request, f"Saved as version {row.version}.", remarks)
                    return redirect(self.kind.name, world=world.name, pk=pk)
            return self._shown(request, world, row, form)

        return page

    @cached_property
    def new_page(self) -> View:
        @world_view(self.kind.write_duty, READ_AND_WRITE, does=f"new {self.kind.singular}")
        def page(request: WorldRequest, world: World) -> HttpResponse:
            if lacking := self.missing(request, world):
                return lacking
            form = self.form(world, None, posted(request), initial=self.asked(request, world))
            if request.method == "POST" and form.is_valid() and self._is_new(request, form):
                remarks = form.remarks
                try:
                    row = form.store(request.user, form.cleaned_data["once"])
                except ValidationError as error:
                    form.add_error(form.key, form.repeated or error.messages)
                else:
                    tell_saved(request, f"Added {self.title_of(row)}.", remarks)
                    if "next" in request.POST:
                        again = reverse(f"{self.kind.name}_new", args=[world.name])
                        return redirect(f"{again}?{urlencode(self.alike(row))}")
                    return redirect(self.kind.name, world=world.name, pk=row.pk)
            return self._shown(request, world, None, form)

        return page

    @cached_property
    def preview_page(self) -> View:
        @world_view(self.kind.write_duty, WRITE, does=NOTHING)
        def page(request: WorldRequest, world: World) -> HttpResponse:
            row = self.row_in(request, world)
            context = self.preview(request, world, self.form(world, row, request.POST))
            return render(request, self.preview_template, dict(context))

        return page

    def row_in(self, request: WorldRequest, world: World) -> Any | None:
        """Return the row that the address names, for checks and previews; None for a new one. Raises Http404."""
        key = request.GET.get("row", "")
        row = self.kind.rows_of(world).filter(pk=number_in(key)).first()
        if key and row is None:
            raise Http404(f"No such {self.kind.singular}.")
        return row

    def _is_new(self, request: WorldRequest, form: NounForm) -> bool:
        """Return whether the row is new, or the same form was sent twice. Otherwise add an error to the form."""
        if not form.repeated or made_before(request.user, form.cleaned_data["once"]):
            return True
        form.add_error(form.key, form.repeated)
        return False

    def _shown(
        self, request: WorldRequest, world: World, row: Any | None, form: NounForm
    ) -> HttpResponse:
        context = {
            "row": row,
            "form": form,
            "query": f"?row={row.pk}" if row else "",
            **self.context(request, world, row, form),
        }
        template = self.template if row else self.new_template or self.template
        return render(request, template, context)


def tell_saved(request: PageRequest, sentence: str, problems: Sequence[Problem]) -> None:
    """Tell the reader that it was saved, with the checker's problems."""
    if not problems:
        messages.success(request, sentence)
        return
    remarks = " ".join(f"{each.message[:1].upper()}{each.message[1:]}." for each in problems)
    messages.warning(request, f"{sentence} {remarks}")
