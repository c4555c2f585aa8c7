"""Stream a world as a zip archive: rows are read and packed as they are sent."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterable, Iterator
from typing import Any, cast

from django.db.models import Count, Field

from annotations.exchange.archive_tables import FORMAT, VERSION, WORLD_FIELDS, ArchiveTable, tables
from annotations.exchange.archives import MANIFEST
from annotations.exchange.generator_export import generator_files
from annotations.exchange.pipe import Pipe
from annotations.exchange.split_export import folder_of, pair_lines
from annotations.language.corpus import PART_FILES, TRIPLES_FILE
from annotations.models import Duty, User, World
from annotations.models.corpus import LabelQuerySet
from annotations.rows.column_values import as_json
from annotations.rows.history import what_happened
from annotations.rows.row_kinds import KINDS, EditableKind
from annotations.rows.synchronise import batches

CHUNK = 2000  # rows fetched, and lines packed, at once
README = """A world of GPSR Workbench.

"Import a world" makes the same world again from this archive; it reads world.json and rows/.
generator/ and splits/ hold the same for people and other programs; paraphrases that were rejected or
excluded are in rows/ alone. After a change of the files in generator/, import that folder as the files
of a generator. history/ says who changed what, and when: a line of JSON for each version of a row that
people changed or deleted. A new world begins its own.
"""

# Key of a row → its line number, by the name of the table.
Numbers = dict[str, dict[int, int]]


class ChangedMeanwhile(RuntimeError):
    """A row refers to one that was written before it existed: somebody changed the world meanwhile."""


def archive_name(world: World) -> str:
    """Return what the archive of ``world`` is called."""
    return f"{world.name}-world.zip"


def world_archive(world: World, reader: User | None = None) -> Iterator[bytes]:
    """Yield the archive of ``world`` in pieces, none of them large.

    It lacks what ``reader`` may not see: answers of others, and what contributors of campaigns wrote where the
    reader does not review. For admins of the world, and without a reader, it is complete.

    Raises:
        ChangedMeanwhile: the world was generated or imported anew while it was read.
    """
    world = World.objects.get(pk=world.pk)  # as it is now, whatever the caller read
    blind = reader if reader is not None and not world.allows(reader, Duty.MANAGE) else None
    may_review = reader is None or world.allows(reader, Duty.REVIEW)
    target = Pipe()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        counts: dict[str, int] = {}
        numbers: Numbers = {}
        yield from _member(archive, target, "README.txt", [README])
        for table in tables():
            numbers[table.name] = {}
            lines = _lines(table, world, numbers, blind, may_review)
            yield from _member(archive, target, table.path, lines)
            counts[table.name] = len(numbers[table.name])
        for name, texts in _readable_files(world):
            yield from _member(archive, target, name, texts)
        files = {member.filename: member.CRC for member in archive.infolist()}
        values = {
            "format": FORMAT,
            "version": VERSION,
            "name": world.name,
            **{name: getattr(world, name) for name in WORLD_FIELDS},
            "has_grammar": hasattr(world, "grammar"),
            "has_ontology": hasattr(world, "ontology"),
            "rows": counts,
            "files": files,  # with their checksums, so that a changed one is noticed
        }
        manifest = json.dumps(values, ensure_ascii=False, indent=2) + "\n"
        yield from _member(archive, target, MANIFEST, [manifest])
    yield target.take()


def _member(
    archive: zipfile.ZipFile, target: Pipe, name: str, lines: Iterable[str]
) -> Iterator[bytes]:
    with archive.open(name, "w") as file:
        for some in batches(lines, CHUNK):
            file.write("".join(some).encode())
            yield target.take()


def _lines(
    table: ArchiveTable, world: World, numbers: Numbers, blind: User | None, may_review: bool
) -> Iterator[str]:
    """Yield the rows in the order of their keys. Fills ``numbers`` for the tables that refer to this one.

    ``blind`` must not see all answers: those that they may not see are left out, and so is what refers to one.
    Whoever does not review gets no contributors but models, nor what refers to others.
    """
    rows = table.rows_of(world, may_review).order_by("pk")
    if blind is not None and isinstance(rows, LabelQuerySet):
        rows = rows.visible_to(blind)
    known = numbers[table.name]
    for number, row in enumerate(rows.select_related(*table.people).iterator(chunk_size=CHUNK)):
        known[row.pk] = number
        values = {each.name: as_json(each, getattr(row, each.attname)) for each in table.columns}
        for name, other in table.references.items():
            key = getattr(row, f"{name}_id")
            values[name] = numbers[other].get(key)
            is_hidden = (blind is not None and other == "labels") or (
                not may_review and other == "contributors"
            )
            if key is not None and values[name] is None and not is_hidden:
                raise ChangedMeanwhile(f"{row._meta.verbose_name} {row.pk} refers to a new {name}")
        if table.subjects:
            values["subject"] = numbers[table.subjects[row.kind]].get(row.subject)
        for name in table.people:
            person = getattr(row, name)
            values[name] = person.username if person else None
        yield json.dumps(values, ensure_ascii=False) + "\n"


def _readable_files(world: World) -> Iterator[tuple[str, Iterable[str]]]:
    """Yield path → lines of the files for people: those of the generator, and a pair file for each part."""
    for name, text in generator_files(world).items():
        yield f"generator/{name}", [text]
    triples = world.paraphrases.accepted().values_list("utterance", "prompt", "grounded_form")
    if triples.exists():
        rows = triples.iterator(chunk_size=CHUNK)
        yield f"generator/{TRIPLES_FILE}", ("".join(f"{text}\n" for text in row) for row in rows)
    for split in world.splits.order_by("pk"):
        counted = split.examples.order_by().values_list("source", "part").annotate(Count("pk"))
        for source, part, _ in sorted(counted):
            path = f"splits/{split.name}/{folder_of(split, source)}/{PART_FILES[part]}"
            yield path, pair_lines(split, part, source)
    for kind in KINDS.values():
        entries = kind.entries_of(world).order_by("history_id")
        if entries.exists():
            yield f"history/{kind.plural}.jsonl", _history_lines(kind, entries)


def _history_lines(kind: EditableKind, entries: Any) -> Iterator[str]:
    columns = [
        cast("Field[Any, Any]", kind.model._meta.get_field(name))
        for name in kind.model.edited_fields
    ]
    for entry in entries.iterator(chunk_size=CHUNK):
        values = {
            "row": entry.id,
            "version": entry.version,
            "what": what_happened(entry),
            "by": str(entry.history_user or ""),
            "at": entry.history_date.isoformat(),
            **{each.name: as_json(each, getattr(entry, each.attname)) for each in columns},
        }
        yield json.dumps(values, ensure_ascii=False) + "\n"
