"""The utterances of a world: the list, one with all answers to it, and a page that adds some."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.db.models import Exists, OuterRef
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.utils import timezone
from django.utils.dateparse import parse_datetime

from annotations.generation.example_commands import example_commands
from annotations.labelling.upload_reading import MOST_BYTES, UploadFormat
from annotations.labelling.utterance_deletion import delete_utterances, restore_utterances
from annotations.labelling.utterance_uploads import (
    Preview,
    content_of,
    keep_waiting,
    preview,
    store,
)
from annotations.language.texts import LanguageError, normalise_line, say_count
from annotations.models import Duty, Label, Upload, Utterance, World
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.people.allowances import may_take_long, takes_files
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.own_entities import OwnEntities
from annotations.showing.paging import number_in
from annotations.web.corpus.corpus_filters import UtteranceFilters
from annotations.web.editing.undo import say_with_undo
from annotations.web.forms import posted

MOST_DELETED = 5_000  # utterances at once
SHOWN = 20

SORTS = {
    "number": Sort("No.", "id", is_number=True),
    "text": Sort("Utterance", "text"),
    "status": Sort("Status", "status"),
}


class UtterancesForm(forms.Form):
    """Utterances to label: pasted, or in a file of any format that ``annotations.labelling`` reads."""

    text = forms.CharField(
        label="Utterances",
        required=False,
        max_length=MOST_BYTES,
        widget=forms.Textarea(attrs={"rows": 10}),
        help_text="One a line. JSON and rows of a table are shown first as they would be read.",
    )
    file = forms.FileField(
        label="Or a file",
        required=False,
        allow_empty_file=True,
        help_text="Plain text, CSV, TSV, JSON or JSON Lines, such as the exports of doccano and Label Studio. "
        "You see what is read before anything is stored.",
    )

    def __init__(self, world: World, *args: Any, **options: Any):
        super().__init__(*args, **options)
        if examples := example_commands(world, 1):
            self.fields["text"].widget.attrs["placeholder"] = examples[0]

    def clean_file(self) -> Any:
        file = self.cleaned_data["file"]
        if file is not None and file.size > MOST_BYTES:
            raise forms.ValidationError(
                f"The file has {file.size:,} bytes; {MOST_BYTES:,} is the limit. Send it in parts."
            )
        return file

    def clean(self) -> dict[str, Any]:
        cleaned = self.cleaned_data
        text = cleaned.get("text", "").strip()
        if not self.errors and not text and not cleaned["file"]:
            self.add_error("text", "Write an utterance, or choose a file that has some.")
        if not self.errors and text and cleaned["file"]:
            self.add_error("file", "Send the text or the file, one after the other.")
        return cleaned

    @property
    def data_sent(self) -> bytes:
        """What was pasted, or what the file holds. Raises LanguageError for an archive without one file."""
        file = self.cleaned_data["file"]
        return content_of(file) if file else self.cleaned_data["text"].encode()

    @property
    def file_name(self) -> str:
        """The name of the file; empty for what was pasted."""
        file = self.cleaned_data["file"]
        return normalise_line(file.name) if file else ""


@world_view(Duty.VIEW)
def utterances(request: WorldRequest, world: World) -> HttpResponse:
    """List what people said, with the form that it has."""
    rows = world.utterances.select_related("created_by")
    listing = Listing(request, UtteranceFilters, rows, SORTS)
    return render_list(request, "annotations/corpus/utterances.html", {"listing": listing})


@world_view(Duty.VIEW)
def utterance(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one utterance, its form and every answer to it that the reader may see, taken back or not."""
    row = get_object_or_404(world.utterances.select_related("created_by"), pk=pk)
    accepted = row.accepted_label
    labels = row.labels.visible_to(request.user).select_related("annotator").order_by("-pk")
    own = OwnEntities.of_utterance(row)
    context = {"row": row, "own": own, "labels": labels, "accepted": accepted}
    return render(request, "annotations/corpus/utterance.html", context)


@takes_files
@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="add utterances")
def utterances_new(request: WorldRequest, world: World) -> HttpResponse:
    """Take utterances in. Pasted lines are stored at once, all or none; a file or a table is shown first."""
    form = UtterancesForm(world, posted(request), request.FILES or None)
    context: dict[str, Any] = {"form": form}
    if form.is_bound and form.is_valid():
        name = form.file_name
        try:
            data = form.data_sent
            shown = preview(world, data, name)
        except LanguageError as error:
            form.add_error("file" if name else "text", str(error))
        else:
            if name or shown.sheet.format is not UploadFormat.TEXT:
                row = keep_waiting(world, data, name, request.user)
                return redirect("upload", world=world.name, pk=row.pk)
            if shown.problems or shown.refusal:
                context["problems"] = shown.problems or (shown.refusal,)
            else:
                return _store_pasted(request, world, shown)
    is_refused = bool(form.is_bound and (form.errors or context.get("problems")))
    return render(
        request,
        "annotations/corpus/utterances_new.html",
        context,
        status=422 if is_refused else 200,
    )


def _store_pasted(request: WorldRequest, world: World, shown: Preview) -> HttpResponse:
    upload = Upload()
    added = store(world, shown, upload, request.user).added
    others = shown.n_known + shown.n_repeated
    sentence = f"{say_count(added, 'utterance')} added."
    if others:
        sentence += f" {others:,} {'was' if others == 1 else 'were'} here already or came twice."
    if not added:
        messages.success(request, sentence)
        return redirect("utterances_new", world=world.name)
    undo = reverse("upload_undo", kwargs={"world": world.name, "pk": upload.pk})
    say_with_undo(request, sentence, undo)
    return redirect("label", world=world.name)


@may_take_long
@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="delete utterances")
def utterances_delete(request: WorldRequest, world: World) -> HttpResponse:
    """Say which utterances would be deleted: the ticked ones, or all that the filters leave.

    A POST deletes them, if their number is still its ``total``.
    """
    keys = [number_in(each) for each in request.GET.getlist("row") if each]
    rows = Listing(request, UtteranceFilters, world.utterances.all(), SORTS).matching
    if keys:
        rows = rows.filter(pk__in=keys[:MOST_DELETED])
    total = rows[: MOST_DELETED + 1].count()
    is_too_many = total > MOST_DELETED
    if request.method == "POST" and request.POST.get("total") != str(total):
        messages.warning(request, "The list has changed since you opened it. Look at it again.")
    elif request.method == "POST" and not is_too_many:
        at = timezone.now()
        n_deleted = delete_utterances(list(rows.values_list("pk", flat=True)), request.user, at)
        undo = reverse("utterances_restore", kwargs={"world": world.name})
        say_with_undo(
            request, f"{say_count(n_deleted, 'utterance')} deleted.", undo, at=at.isoformat()
        )
        return redirect("utterances", world=world.name)
    answers = Label.objects.valid().filter(utterance=OuterRef("pk"))
    context = {
        "rows": rows[:SHOWN],
        "total": total,
        "n_labelled": 0 if is_too_many else rows.filter(Exists(answers)).count(),
        "most": MOST_DELETED,
        "is_too_many": is_too_many,
    }
    return render(request, "annotations/corpus/utterances_delete.html", context)


@may_take_long
@world_view(Duty.ANNOTATE, WRITE, does="restore utterances")
def utterances_restore(request: WorldRequest, world: World) -> HttpResponse:
    """Restore the utterances that were deleted together, at the time that was sent as ``at``."""
    try:
        at = parse_datetime(request.POST.get("at", "")[:40])
    except ValueError:
        at = None
    rows = Utterance.with_deleted.filter(world=world, deleted_at=at if at and at.tzinfo else None)
    n_restored, n_taken = restore_utterances(rows, request.user)
    sentence = f"{say_count(n_restored, 'utterance')} restored."
    if n_taken:
        sentence += f" {n_taken:,} stay deleted: their texts were added again."
    messages.success(request, sentence)
    return redirect("utterances", world=world.name)
