"""Verbs: look at what an upload would store, store it, undo it as a whole and redo it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import timedelta
from http import HTTPStatus

from django.core.exceptions import ValidationError
from django.db import transaction
from django.db.models import Exists, OuterRef
from django.utils import timezone

from annotations.exchange.archives import is_archive
from annotations.exchange.source_files import UploadedFile, read_files, read_one_file
from annotations.labelling.collecting import (
    MOST_AT_ONCE,
    CollectedTexts,
    collect,
    find_known,
    read_text,
)
from annotations.labelling.foreign_formats import join_brat
from annotations.labelling.form_check import canonical_label
from annotations.labelling.taking_back import bring_again, take_back
from annotations.labelling.upload_reading import (
    FORMAT_NAMES,
    MOST_BYTES,
    MOST_PROBLEMS,
    TABLES,
    Sheet,
    UploadFormat,
    decode_upload,
    read_upload,
)
from annotations.labelling.utterance_deletion import delete_utterances, restore_utterances
from annotations.language.texts import (
    ENCODINGS,
    LanguageError,
    Position,
    Problem,
    Refusal,
    TextChanges,
    error_at,
)
from annotations.models import Label, Origin, Upload, User, Utterance, World
from annotations.models.corpus import MOST_CHARACTERS_OF_NAME

SHOWN = 10  # rows of a preview
KEPT_WAITING = timedelta(days=1)  # before an upload that nobody stores is forgotten


class NotNow(Refusal):
    """An upload cannot be undone or redone; a sentence says why."""

    code = "not_now"
    status = HTTPStatus.CONFLICT


@dataclass(frozen=True, slots=True)
class ReadingChoices:
    """How somebody says an upload is to be read; what is empty is recognised.

    ``as_labels``: the forms become answers of who stores it.
    """

    format: str = ""
    column: str = ""
    encoding: str = ""
    has_head: bool | None = None
    as_labels: bool = False


@dataclass(frozen=True, slots=True)
class ShownText:
    """A row of a preview: ``text`` as it would be stored; ``was_cleaned`` where that is not as it was sent."""

    line: int
    text: str
    state: str
    was_cleaned: bool = False


@dataclass(frozen=True)
class Preview:
    """What an upload would store, before it does.

    ``texts`` are the utterances that the world does not have, ``forms`` those of them that have one.
    ``n_known`` texts are here already, ``n_repeated`` came twice, ``n_empty`` rows have none, ``n_cleaned``
    lost invisible characters, ``n_bad_forms`` forms cannot be read. ``problems`` are the rows that cannot be
    stored, of ``n_problems``. ``first`` are ten rows. ``refusal`` says why nothing can be stored.
    """

    sheet: Sheet
    encoding: str = "utf-8"
    texts: tuple[str, ...] = ()
    forms: Mapping[str, str] | None = None
    n_known: int = 0
    n_repeated: int = 0
    n_empty: int = 0
    n_cleaned: int = 0
    n_bad_forms: int = 0
    problems: tuple[Problem, ...] = ()
    n_problems: int = 0
    first: tuple[ShownText, ...] = ()
    refusal: Problem | None = None

    @property
    def n_new(self) -> int:
        return len(self.texts)

    @property
    def format_name(self) -> str:
        return FORMAT_NAMES[self.sheet.format]

    @property
    def encoding_name(self) -> str:
        return ENCODINGS[self.encoding]

    @property
    def can_be_stored(self) -> bool:
        return self.refusal is None and bool(self.texts)


def content_of(file: UploadedFile) -> bytes:
    """Return the content of a file that was sent, or of the only one in an archive.

    A brat collection in an archive becomes JSON Lines. Raises LanguageError.
    """
    if is_archive(file):
        files = read_files([file], _is_of_brat, MOST_BYTES).files
        if any(path.endswith(".ann") for path in files):
            texts = {
                path: decode_upload(data, path)[0] if data.strip() else ""
                for path, data in files.items()
            }
            rows = [{"text": each.text, "form": each.form} for each in join_brat(texts)]
            return "\n".join(json.dumps(row) for row in rows if row["text"]).encode()
    return read_one_file(file, bool, MOST_BYTES)


def _is_of_brat(path: str) -> bool:
    return path.endswith((".ann", ".txt"))


def preview(
    world: World, data: bytes, file_name: str, choices: ReadingChoices = ReadingChoices()
) -> Preview:
    """Say what ``store`` would do with an upload. Nothing is changed.

    Raises LanguageError, with its place, for what cannot be read at all.
    """
    text, encoding = decode_upload(data, file_name, choices.encoding)
    sheet = read_upload(text, file_name, choices.format, choices.has_head)
    if choices.column:
        sheet = sheet.with_column(choices.column)
    problems = list(sheet.problems)
    said: list[tuple[int, str, bool, str]] = []  # line, text, whether it was cleaned, its form
    n_empty = 0
    for record in sheet.records:
        given = record.values.get(sheet.column, "")
        text, problem = read_text(given, Position(file_name, record.line))
        if problem:
            problems.append(problem)
        elif not text:
            n_empty += 1
        else:
            was_cleaned = bool(TextChanges.of(given))
            said.append((record.line, text, was_cleaned, record.values.get(sheet.form_column, "")))
    known = find_known(world, [text for _, text, _, _ in said])
    new: dict[str, str] = {}
    rows: list[ShownText] = []
    for line, text, was_cleaned, form in said:
        state = "known" if text in known else "repeated" if text in new else "new"
        if state == "new":
            new[text] = form
        rows.append(ShownText(line, text, state, was_cleaned))
    forms = (
        {text: _canonical(form) for text, form in new.items() if form.strip()}
        if choices.as_labels
        else {}
    )
    refusal = None
    if len(new) > MOST_AT_ONCE:
        hint = f"{MOST_AT_ONCE:,} is the limit; send the file in parts"
        refusal = error_at(Position(file_name), f"there are {len(new):,} new utterances", hint)
    return Preview(
        sheet,
        encoding,
        texts=tuple(new),
        forms={text: form for text, form in forms.items() if form},
        n_known=sum(row.state == "known" for row in rows),
        n_repeated=sum(row.state == "repeated" for row in rows),
        n_empty=n_empty,
        n_cleaned=sum(row.was_cleaned for row in rows),
        n_bad_forms=sum(not form for form in forms.values()),
        problems=tuple(problems[:MOST_PROBLEMS]),
        n_problems=len(problems),
        first=tuple(rows[:SHOWN]),
        refusal=refusal,
    )


def _canonical(form: str) -> str:
    """Return a form as labels have it; empty where it is none."""
    try:
        return canonical_label(form)
    except LanguageError:
        return ""


def keep_waiting(world: World, data: bytes, file_name: str, by: User) -> Upload:
    """Keep what somebody sent until they have looked at it and store it.

    It goes when they send another one, or after a day when anybody does.
    """
    Upload.objects.waiting().filter(created_at__lt=timezone.now() - KEPT_WAITING).delete()
    world.uploads.waiting().filter(created_by=by).delete()  # they have chosen another one
    return Upload.objects.create(
        world=world, file_name=file_name[-MOST_CHARACTERS_OF_NAME:], content=data, created_by=by
    )


def store(world: World, shown: Preview, upload: Upload, by: User) -> CollectedTexts:
    """Store what a preview has shown, as one upload. ``upload`` may be unsaved."""
    upload.world, upload.created_by = world, by
    upload.format, upload.column = shown.sheet.format, shown.sheet.column
    origin = Origin.UPLOADED if upload.file_name else Origin.PASTED
    return collect(world, shown.texts, origin, by, upload, shown.forms)


def count_labelled(upload: Upload) -> int:
    """Return how many utterances of an upload somebody has answered since, and not taken back."""
    answers = Label.objects.valid().filter(
        created_at__gt=upload.stored_at, utterance=OuterRef("pk")
    )
    return upload.utterances.filter(Exists(answers)).count()


def undo(upload: Upload, by: User, with_labelled: bool, with_world: bool = False) -> int:
    """Delete the utterances of an upload. Those that somebody has answered since stay, unless ``with_labelled``.

    What else came with it stays, unless ``with_world``. Returns how many utterances were deleted. Raises NotNow where
    it is undone already, or not stored, and StillUsed where something depends on what came with it.
    """
    with transaction.atomic():
        stored = Upload.objects.select_for_update().get(pk=upload.pk)
        if stored.stored_at is None or stored.undone_at is not None:
            raise NotNow(
                "This upload is undone already."
                if stored.stored_at
                else "This upload is not stored yet."
            )
        if with_world:
            take_back(stored, by)
        rows = stored.utterances.all()
        if not with_labelled:
            answers = Label.objects.valid().filter(created_at__gt=stored.stored_at)
            rows = rows.exclude(Exists(answers.filter(utterance=OuterRef("pk"))))
        stored.undone_at, stored.undone_by = timezone.now(), by
        stored.save(update_fields=["undone_at", "undone_by"])
        return delete_utterances(list(rows.values_list("pk", flat=True)), by, stored.undone_at)


def redo(upload: Upload, by: User) -> tuple[int, int]:
    """Restore what ``undo`` deleted, and what came with it.

    Returns how many utterances came back, and how many stay deleted because their texts are here again.
    Raises NotNow where it is not undone, or where another row says the same as one that came with it.
    """
    with transaction.atomic():
        stored = Upload.objects.select_for_update().get(pk=upload.pk)
        if stored.undone_at is None:
            raise NotNow("This upload is not undone.")
        try:
            bring_again(stored, by)
        except ValidationError as error:
            raise NotNow(f"Not restored. {' '.join(error.messages)}") from error
        rows = Utterance.with_deleted.filter(upload=stored, deleted_at=stored.undone_at)
        n_restored, n_taken = restore_utterances(rows, by)
        stored.undone_at = stored.undone_by = None
        stored.save(update_fields=["undone_at", "undone_by"])
        return n_restored, n_taken


def structure_of(texts: Sequence[str]) -> str:
    """Return the format of texts that are the lines of a file; empty where they are what people say.

    Raises LanguageError where they are the lines of something else, such as a grammar.
    """
    sheet = read_upload("\n".join(texts[:1_000]))
    is_surely_table = sheet.format in TABLES and sheet.has_head and sheet.is_column_sure
    is_other = sheet.format in (UploadFormat.JSON, UploadFormat.JSONL, UploadFormat.PAIRS)
    return sheet.format if is_other or is_surely_table else ""
