"""Verb: make a world from its archive. It is hidden until all its rows are there."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from secrets import token_hex
from typing import IO, Any

from django.conf import settings
from django.db import IntegrityError, models, transaction
from django.utils import timezone

from annotations.background.progress import UNWATCHED, Progress
from annotations.exchange.archive_tables import ArchiveTable, tables
from annotations.exchange.archives import MANIFEST, open_archive, read_lines
from annotations.exchange.class_checks import check_classes, check_token
from annotations.exchange.row_checks import check_book_row, check_row, parse_object
from annotations.exchange.row_texts import equal_row, normalise_columns
from annotations.exchange.target_world import require_world_name
from annotations.exchange.world_deletion import delete_world
from annotations.exchange.world_manifest import WorldManifest, read_manifest
from annotations.generation.class_uses import count_uses
from annotations.generation.freezing import content_hash_of
from annotations.generation.split_statistics import store_figures
from annotations.language.forms import DEFAULT_CLASSES, EntityClasses
from annotations.language.texts import (
    LanguageError,
    Position,
    Problem,
    Refusal,
    TextChanges,
    normalise_json,
    say_changes,
)
from annotations.models import (
    Assignment,
    EntityClass,
    Grammar,
    Membership,
    Ontology,
    Primitive,
    Recipe,
    Split,
    User,
    World,
)
from annotations.models.worlds import Role
from annotations.rows.column_values import from_json
from annotations.rows.from_rows import annotated_categories, classes_of, predicates_of
from annotations.rows.rows_in_words import rows_in_words
from annotations.rows.stored_problems import as_json
from annotations.rows.synchronise import BATCH, batches

LONGEST_LINE = 1_000_000


@dataclass(frozen=True, slots=True)
class ImportedWorld:
    """``rows`` counts what was made, by table. ``problems`` are warnings for rows whose texts were normalised."""

    world: str
    rows: Mapping[str, int]
    problems: tuple[Problem, ...] = ()

    def as_json(self) -> dict[str, Any]:
        return {
            "world": self.world,
            "rows": dict(self.rows),
            "problems": [as_json(problem) for problem in self.problems],
        }


def import_world(
    name: str,
    source: Path | IO[bytes],
    by: User | None = None,
    progress: Progress = UNWATCHED,
    hidden_name: str = "",
) -> ImportedWorld:
    """Make the world ``name`` from an archive that ``world_archive`` wrote; all of it or nothing.

    Nobody sees the world before it is complete, and nobody waits for it: its rows are written in
    short transactions. Rows keep their order and what they refer to; accounts are found by their
    names, and a row of an account that is not here has none. Texts are normalised, but not those of
    frozen splits, whose hash is of the texts as they are. ``by`` becomes the admin of the world.
    ``hidden_name`` is what the world is called until then.

    Raises:
        LanguageError: a sentence for whatever is wrong with the name or the archive.
    """
    require_world_name(name)
    if World.objects.filter(name=name).exists():
        raise _name_taken(name)
    label = source.name if isinstance(source, Path) else getattr(source, "name", "") or "archive"
    bounds = settings.ARCHIVE_MAX_FILES, settings.ARCHIVE_MAX_BYTES
    with open_archive(source, Path(label).name, *bounds) as archive:
        manifest = read_manifest(archive, Path(label).name)
        world = World.objects.create(
            name=hidden_name or f"importing-{token_hex(8)}", deletion_requested_at=timezone.now()
        )
        if manifest.has_grammar:
            Grammar.objects.create(world=world)
        if manifest.has_ontology:
            Ontology.objects.create(world=world)
        World.objects.filter(pk=world.pk).update(**manifest.world_values)
        try:
            # The archive has those that a world starts with.
            for kind in manifest.rows.keys() & {"entity_classes", "primitives", "recipes"}:
                getattr(world, kind).all().delete()
            loader = _Loader(archive, manifest, world, progress)
            rows = loader.load()
            _check_world(world)
            imported = ImportedWorld(name, rows, tuple(loader.warnings))
            with progress.writing():
                _publish(world, name, by)
                progress.conclude(imported.as_json())
        except BaseException:
            delete_world(world)
            raise
    return imported


def _name_taken(name: str) -> LanguageError:
    return LanguageError(
        f"there is a world “{name}” already", hint="choose another name, or delete that world first"
    )


def _publish(world: World, name: str, by: User | None) -> None:
    """Give the world its name and show it. Raises LanguageError where the name was taken meanwhile."""
    try:
        with transaction.atomic():
            World.objects.filter(pk=world.pk).update(name=name, deletion_requested_at=None)
            if by is not None:
                Membership.objects.create(world=world, user=by, role=Role.ADMIN)
            Assignment.objects.orphaned().filter(item__world=world).release()
    except IntegrityError as error:
        raise _name_taken(name) from error


def _check_world(world: World) -> None:
    """Store what the rows use without saying so. Raises LanguageError where pages and parsers could not read a text."""
    for category in annotated_categories(world):
        category.value.grammar.require_finite()  # its $Main may be still to be written
    predicates_of(world)
    for row in EntityClass.objects.missing_of_household(world):
        if any(count_uses(row).values()):
            row.save()
    for split in Split.objects.filter(world=world):
        if content_hash_of(split) != split.content_hash:
            raise LanguageError(f"the pairs of the split {split} are not those that were frozen")
        store_figures(split)


class _Loader:
    """Stores the rows of an archive below a world, table by table."""

    def __init__(
        self, archive: zipfile.ZipFile, manifest: WorldManifest, world: World, progress: Progress
    ) -> None:
        self._archive = archive
        self._manifest = manifest
        self._world = world
        self._progress = progress
        self._keys: dict[str, list[int]] = {}
        self._people = dict(User.objects.values_list("username", "pk"))
        self._links: list[tuple[models.Model, str, Any]] = []
        self._done = 0
        self._changed: list[tuple[Position, TextChanges]] = []  # lines of the table that is read
        self.warnings: list[Problem] = []

    @cached_property
    def _stored_classes(self) -> EntityClasses:
        """The classes of the entities, once their table has been read, which is the first.

        Worlds used those of a household without a row of their own, until ``_check_world`` stored them.
        """
        return DEFAULT_CLASSES.with_rows(classes_of(self._world))

    def load(self) -> dict[str, int]:
        """Store the rows of all tables; return how many by table. Raises LanguageError."""
        description, changes = normalise_json(self._manifest.world_values["description"])
        self.warnings += say_changes([(Position(MANIFEST), changes)] if changes else [])
        World.objects.filter(pk=self._world.pk).update(description=description)
        for table in tables():
            self._changed = []
            keys = self._keys[table.name] = []
            if table.name not in self._manifest.rows:
                continue
            for rows in batches(self._rows(table), BATCH):
                self._store(table, rows, Position(table.path, len(keys) + 1))
                self._progress.check()
                self._done += len(rows)
                total = max(1, sum(self._manifest.rows.values()))
                message = f"storing {rows_in_words(table.model)}"
                self._progress.report(min(1.0, self._done / total), message)
            announced = self._manifest.rows[table.name]
            if len(keys) != announced:
                raise LanguageError(
                    f"there are {len(keys):,} rows, and world.json announces {announced:,}",
                    Position(table.path, len(keys) + 1),
                )
            self.warnings += say_changes(self._changed)
        return {name: len(keys) for name, keys in self._keys.items()}

    def _store(self, table: ArchiveTable, rows: list[models.Model], place: Position) -> None:
        """Store rows, then write their references to earlier rows of the same table."""
        try:
            with transaction.atomic():
                table.model._default_manager.bulk_create(rows)
        except IntegrityError as error:
            with transaction.atomic():
                raise self._clash(table, rows, place) from error
        self._keys[table.name] += [row.pk for row in rows]
        for row, name, number in self._links:
            setattr(row, f"{name}_id", self._key(number, table.name, True, Position(table.path)))
        self._links.clear()
        if names := [name for name, other in table.references.items() if other == table.name]:
            table.model._default_manager.bulk_update(rows, names)

    def _clash(
        self, table: ArchiveTable, rows: list[models.Model], place: Position
    ) -> LanguageError:
        """Return what to say of ``rows``, which the database refuses. Those before the refused one are stored."""
        keys = list(self._keys[table.name])
        for number, row in enumerate(rows):
            here = Position(place.source, place.line + number)
            if other := equal_row(row):
                earlier = keys.index(other.pk) + 1
                changed = {place.line for place, _ in self._changed}
                is_by_us = not changed.isdisjoint({earlier, here.line})
                why = " now that what does not show is left out" if is_by_us else ""
                return LanguageError(
                    f"the rows in lines {earlier:,} and {here.line:,} are the same{why}: “{str(row)[:60]}”",
                    here,
                    "change or delete one of the two in the world that was downloaded, and download it again",
                )
            try:
                with transaction.atomic():
                    row.save(force_insert=True)
            except IntegrityError:
                return LanguageError("this row cannot stand beside the rows before it", here)
            keys.append(row.pk)
        return LanguageError("these rows cannot stand beside each other", place)

    def _rows(self, table: ArchiveTable) -> Iterator[models.Model]:
        path = self._manifest.prefix + table.path
        lines = read_lines(self._archive, path, LONGEST_LINE)
        for number, line in enumerate(lines, start=1):
            place = Position(table.path, number)
            values = parse_object(line, place)
            check_row(table, values, place)
            if table.name == "entity_classes":
                check_token(values["token"], place)
            elif table.model in (Primitive, Recipe):
                check_book_row(table.model, values, place)
            else:
                check_classes(table.name, values, self._stored_classes, place)
            yield self._row(table, self._normalise(table, values, place), place)

    def _normalise(
        self, table: ArchiveTable, values: dict[str, Any], place: Position
    ) -> dict[str, Any]:
        """Return the values with the texts of their columns normalised, and note what that changed.

        Raises:
            LanguageError: they cannot be stored then.
        """
        if table.keeps_texts:
            return values
        written = {each.name: values[each.name] for each in table.columns if each.name in values}
        try:
            read, changes = normalise_columns(table, written)
        except Refusal as error:
            raise LanguageError(error.message, place) from error
        if read == written:
            return values
        if changes:
            self._changed.append((place, changes))
        read = {**values, **read}
        check_row(table, read, place)
        return read

    def _row(self, table: ArchiveTable, values: dict[str, Any], place: Position) -> models.Model:
        columns = [each for each in table.columns if each.name in values]
        row = table.model(**{each.name: from_json(each, values[each.name]) for each in columns})
        if table.owner:
            owner = (
                self._world if table.owner == "world" else getattr(self._world, table.owner, None)
            )
            if owner is None:
                raise LanguageError(f"world.json says that there is no {table.owner}", place)
            setattr(row, table.owner, owner)
        for name, other in table.references.items():
            if other == table.name:
                self._links.append((row, name, values.get(name)))
                continue
            is_optional = table.model._meta.get_field(name).null
            setattr(row, f"{name}_id", self._key(values.get(name), other, is_optional, place))
        for name in table.people:
            setattr(row, f"{name}_id", self._people.get(values.get(name) or ""))
        if table.subjects:
            other = table.subjects[values["kind"]]
            name = "subject"
            setattr(row, name, self._key(values[name], other, True, place))
        return row

    def _key(self, number: Any, other: str, is_optional: bool, place: Position) -> int | None:
        keys = self._keys[other]
        if number is None and is_optional:
            return None
        if type(number) is not int or not 0 <= number < len(keys):
            raise LanguageError(
                f"the row refers to number {number} of {other}, which is not there", place
            )
        return keys[number]
