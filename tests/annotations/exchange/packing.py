"""Archives of worlds for tests: packed, taken apart and put together again."""

from __future__ import annotations

import io
import json
import zipfile
import zlib

from django.db.models import ForeignKey

from annotations.editing.commenting import SUBJECTS
from annotations.exchange.archive_tables import tables
from annotations.exchange.world_export import world_archive
from annotations.exchange.world_import import import_world
from annotations.models import Comment, World


def pack(world: World) -> io.BytesIO:
    """The archive of ``world`` as a file."""
    return io.BytesIO(b"".join(world_archive(world)))


def same_again(world: World) -> World:
    """The world that an import of the archive of ``world`` makes; asserts that it is the same."""
    import_world("again", pack(world))
    again = World.objects.get(name="again")
    assert everything_of(again) == everything_of(world)
    return again


def members_of(archive: io.BytesIO) -> dict[str, bytes]:
    with zipfile.ZipFile(archive) as file:
        return {name: file.read(name) for name in file.namelist()}


def pack_members(members: dict[str, bytes], is_consistent: bool = True) -> io.BytesIO:
    """An archive of these files; where it is to be consistent, world.json has their checksums."""
    members = dict(members)
    if is_consistent:
        manifest = json.loads(members["world.json"])
        manifest["files"] = {
            name: zlib.crc32(data) for name, data in members.items() if name != "world.json"
        }
        members["world.json"] = json.dumps(manifest).encode()
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as file:
        for name, data in members.items():
            file.writestr(name, data)
    target.seek(0)
    return target


def everything_of(world: World) -> dict[str, list[dict]]:
    """All rows of all models below ``world`` but ids and timestamps; a reference is a row's number."""
    numbers: dict[type, dict[int, int]] = {}
    contents: dict[str, list[dict]] = {}
    for table in tables():
        rows = list(table.model.objects.filter(**{table.world_path: world}).order_by("pk"))
        numbers[table.model] = {row.pk: number for number, row in enumerate(rows)}
        apart = {"id", "created_at", "world", "grammar", "ontology", *table.left_out}
        contents[table.name] = [_values(row, numbers, apart) for row in rows]
    world.refresh_from_db()
    kept = ("description", "revision", "generated_revision")
    contents["world"] = [{name: getattr(world, name) for name in kept}]
    contents["parts"] = [
        {"grammar": hasattr(world, "grammar"), "ontology": hasattr(world, "ontology")}
    ]
    return contents


def _values(row, numbers, apart) -> dict:
    values = {}
    for field in row._meta.concrete_fields:
        value = getattr(row, field.attname)
        if field.name in apart:
            continue
        if isinstance(field, ForeignKey) and field.related_model in numbers and value is not None:
            value = numbers[field.related_model][value]
        if field.name == "subject" and isinstance(row, Comment):
            value = numbers[SUBJECTS[row.kind].model].get(value)
        values[field.name] = value
    return values
