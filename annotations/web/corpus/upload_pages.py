"""Uploads of utterances: what one would store, the list of them, undone and redone as a whole."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from django import forms
from django.contrib import messages
from django.http import Http404, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse

from annotations.labelling.taking_back import StillUsed, brought_by, why_not
from annotations.labelling.upload_reading import FORMAT_NAMES, TABLES
from annotations.labelling.utterance_uploads import (
    NotNow,
    Preview,
    ReadingChoices,
    count_labelled,
    preview,
    redo,
    store,
    undo,
)
from annotations.language.texts import ENCODINGS, LanguageError, say_count
from annotations.models import Duty, Upload, World
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.people.allowances import may_take_long
from annotations.showing.filtering import PageFilters, Search
from annotations.showing.listing import Listing, Sort, render_list
from annotations.web.editing.undo import say_with_undo

HEADS = (("", "as recognised"), ("yes", "names of columns"), ("no", "a row like the others"))
SORTS = {"newest": Sort("When", "-id"), "file": Sort("File", "file_name")}


class ChoicesForm(forms.Form):
    """How an upload is to be read, where it was recognised wrongly."""

    format = forms.ChoiceField(
        required=False, choices=[("", "as recognised"), *FORMAT_NAMES.items()]
    )
    column = forms.CharField(
        label="Column with the utterances", required=False, strip=False, widget=forms.Select
    )  # which columns there are is known once it is read
    has_head = forms.ChoiceField(label="The first row is", required=False, choices=HEADS)
    encoding = forms.ChoiceField(
        required=False, choices=[("", "as recognised"), *ENCODINGS.items()]
    )
    as_labels = forms.BooleanField(label="Store the forms as labels of mine", required=False)

    @property
    def choices(self) -> ReadingChoices:
        """The choices that were made. An unknown value counts as no choice."""
        self.is_valid()
        given = self.cleaned_data
        head = {"yes": True, "no": False}.get(given.get("has_head", ""))
        return ReadingChoices(
            format=given.get("format", ""),
            column=given.get("column", ""),
            encoding=given.get("encoding", ""),
            has_head=head,
            as_labels=bool(given.get("as_labels")),
        )

    def fit(self, shown: Preview, can_label: bool) -> None:
        """Offer the formats, columns and encodings that fit the upload."""
        names = shown.sheet.columns
        data: Any = self.data
        self.data = data = data.copy()
        data["column"] = shown.sheet.column
        self.fields["column"].widget.choices = [(name, name) for name in names]
        if len(names) < 2:
            del self.fields["column"]
        if shown.sheet.format not in TABLES:
            del self.fields["has_head"]
        if not (can_label and shown.sheet.form_column):
            del self.fields["as_labels"]


class UploadFilters(PageFilters):
    q = Search("file_name")


@world_view(Duty.VIEW)
def uploads(request: WorldRequest, world: World) -> HttpResponse:
    """List what was uploaded, the newest first."""
    rows = world.uploads.stored().select_related("created_by", "undone_by").defer("content")
    listing = Listing(request, UploadFilters, rows, SORTS)
    return render_list(request, "annotations/corpus/uploads.html", {"listing": listing})


@may_take_long
@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="store an upload")
def upload(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show what an upload would store, or what it has stored; a POST stores it."""
    row = _upload(world, pk)
    if row.stored_at is not None:
        return render(request, "annotations/corpus/upload.html", {"row": row})
    if row.created_by != request.user:
        raise Http404("Somebody else is looking at this upload before they store it.")
    form = ChoicesForm(request.POST if request.method == "POST" else request.GET)
    chosen = form.choices
    can_label = Duty.MANAGE in request.duties
    allowed = replace(chosen, as_labels=chosen.as_labels and can_label)
    try:
        shown = preview(world, bytes(row.content), row.file_name, allowed)
    except LanguageError as error:
        context = {"row": row, "form": form, "errors": [error.problem]}
        return render(request, "annotations/corpus/upload_preview.html", context, status=422)
    if request.method == "POST" and shown.can_be_stored:
        return _store(request, world, row, shown)
    form.fit(shown, can_label)
    context = {"row": row, "form": form, "shown": shown}
    status = 422 if request.method == "POST" else 200
    return render(request, "annotations/corpus/upload_preview.html", context, status=status)


def _store(request: WorldRequest, world: World, row: Upload, shown: Preview) -> HttpResponse:
    added = store(world, shown, row, request.user).added
    sentence = f"{say_count(added, 'utterance')} added from {row}."
    if shown.forms or shown.n_bad_forms:
        sentence += f" {say_count(len(shown.forms or {}), 'label')} of yours with them"
        if shown.n_bad_forms:
            sentence += f"; {say_count(shown.n_bad_forms, 'form')} cannot be read"
        sentence += "."
    say_with_undo(request, sentence, _address("upload_undo", world, row))
    query = f"?upload={row.pk}"
    return redirect(f"{reverse('utterances', kwargs={'world': world.name})}{query}")


@may_take_long
@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="undo an upload")
def upload_undo(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Delete the utterances of an upload. Ask first about those answered since, and about what came with it."""
    row = _upload(world, pk)
    n_labelled = count_labelled(row) if row.stored_at and not row.undone_at else 0
    choice = request.POST.get("labelled", "")
    brought = "" if row.undone_at else brought_by(row).counts
    of_world = request.POST.get("world", "")
    asks = n_labelled and choice not in ("keep", "delete")
    if request.method != "POST" or asks or (brought and of_world not in ("keep", "delete")):
        context: dict[str, Any] = {"row": row, "n_labelled": n_labelled, "brought": brought}
        context["still_used"] = why_not(row) if brought else ""
        context["n_present"] = row.utterances.count()
        return render(request, "annotations/corpus/upload_undo.html", context)
    try:
        deleted = undo(
            *(row, request.user), with_labelled=choice == "delete", with_world=of_world == "delete"
        )
    except (NotNow, StillUsed) as error:
        messages.error(request, str(error))
    else:
        sentence = f"Undone: {say_count(deleted, 'utterance')} of {row} deleted."
        say_with_undo(request, sentence, _address("upload_redo", world, row))
    return redirect("uploads", world=world.name)


@may_take_long
@world_view(Duty.ANNOTATE, WRITE, does="store an undone upload again")
def upload_redo(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Restore the utterances of an upload that was undone."""
    row = _upload(world, pk)
    try:
        restored, n_taken = redo(row, request.user)
    except NotNow as error:
        messages.error(request, str(error))
    else:
        sentence = f"{say_count(restored, 'utterance')} of {row} restored."
        if n_taken:
            sentence += f" {n_taken:,} stay deleted: their texts were added again."
        say_with_undo(request, sentence, _address("upload_undo", world, row))
    return redirect("uploads", world=world.name)


def _upload(world: World, pk: int) -> Upload:
    return get_object_or_404(world.uploads.select_related("created_by", "undone_by"), pk=pk)


def _address(name: str, world: World, row: Upload) -> str:
    return reverse(name, kwargs={"world": world.name, "pk": row.pk})
