"""``world.json``: what an archive is, and whether its files are those that were written."""

from __future__ import annotations

import zipfile
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, TypeGuard

from django.db.models import Field

from annotations.exchange.archive_tables import FORMAT, VERSION, WORLD_FIELDS, tables
from annotations.exchange.archives import MANIFEST, manifests_in, read_member
from annotations.exchange.row_checks import check_value, parse_object
from annotations.language.texts import LanguageError, Position
from annotations.models import World

MOST_BYTES = 1_000_000


@dataclass(frozen=True)
class WorldManifest:
    """``rows`` by table; ``prefix`` is the folder in which the archive keeps everything, or nothing."""

    prefix: str
    rows: Mapping[str, int]
    has_grammar: bool
    has_ontology: bool
    world_values: Mapping[str, Any]


def read_manifest(archive: zipfile.ZipFile, name: str) -> WorldManifest:
    """Return the manifest of the archive called ``name``.

    Raises:
        LanguageError: it is missing, is of another format or version, lacks something, or a file is
            missing or was changed.
    """
    manifests = manifests_in(archive)
    if not manifests:
        raise LanguageError(
            f"the archive holds no world: {MANIFEST} is missing",
            Position(name),
            "choose the archive of a whole world; the files of a generator have a page of their own",
        )
    # Some programs pack a folder rather than what is in it.
    prefix = min(manifests, key=len).removesuffix(MANIFEST)
    data = read_member(archive, archive.getinfo(prefix + MANIFEST), MOST_BYTES)
    place = Position(MANIFEST)
    values = parse_object(data, place)
    if values.get("format") != FORMAT:
        raise LanguageError("this does not describe a world", place, f"“format” has to be {FORMAT}")
    if values.get("version") != VERSION:
        raise LanguageError(
            f"the archive has version {str(values.get('version'))[:20]} of the format, and this "
            f"installation reads version {VERSION}",
            place,
            "update the older of the two installations",
        )
    values.setdefault("sample", {})  # archives of earlier releases do not have it
    for field in WORLD_FIELDS:
        column = World._meta.get_field(field)
        assert isinstance(column, Field)
        check_value(column, values.get(field), place)
    rows, files = values.get("rows"), values.get("files")
    for key in ("has_grammar", "has_ontology"):
        if not isinstance(values.get(key), bool):
            raise LanguageError(f"{key} is neither true nor false", place)
    if not _is_counts(rows) or not _is_counts(files):
        raise LanguageError("“rows” and “files” do not give a number for each name", place)
    _refuse_changed_files(archive, prefix, rows.keys(), files)
    return WorldManifest(
        prefix,
        {table.name: rows[table.name] for table in tables() if table.name in rows},
        values["has_grammar"],
        values["has_ontology"],
        {field: values[field] for field in WORLD_FIELDS},
    )


def _is_counts(value: Any) -> TypeGuard[dict[str, int]]:
    return isinstance(value, dict) and all(
        type(each) is int and each >= 0 for each in value.values()
    )


def _refuse_changed_files(
    archive: zipfile.ZipFile, prefix: str, announced: Collection[str], files: Mapping[str, int]
) -> None:
    """``announced`` are the tables that the archive has: an older one lacks some of today's."""
    members = {member.filename: member for member in archive.infolist()}
    for path in {table.path for table in tables() if table.name in announced} | files.keys():
        member = members.get(prefix + path)
        if member is None or path not in files:
            raise LanguageError("this file is missing from the archive", Position(path))
        if files[path] != member.CRC:
            raise LanguageError(
                "this file was changed after the download",
                Position(path),
                "import the files of generator/ as a generator to bring changes in",
            )
