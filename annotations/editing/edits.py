"""Verbs: add, change, delete and restore a row that people edit. Nobody overwrites what they have not seen.

Each is one transaction that keeps the history of the row and brings up to date what is made from it.
Whoever writes to a version of a row goes through ``hold``, which compares it while nobody else can
write, or holds it and calls ``require_version``: of several writers at once a single one is first.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from http import HTTPStatus
from typing import Any, TypeVar

from django.core.exceptions import ValidationError
from django.db import IntegrityError, models, transaction
from django.db.models import Max

from annotations.editing.drafts import discard_draft_of_new
from annotations.editing.once_keys import made_before, remember
from annotations.generation.up_to_date import start_update
from annotations.generation.world_problems import check_again
from annotations.language.texts import Refusal
from annotations.models import Editable, User, World
from annotations.models.editing import HistoryEntry, Placed
from annotations.rows.history import (
    ADDED,
    CHANGED,
    DELETED,
    RESTORED,
    entry_at,
    history_of,
    keep,
    keep_first,
)
from annotations.rows.row_kinds import kind_of
from annotations.rows.synchronise import BATCH, batches

Row = TypeVar("Row", bound=Editable)


class Overtaken(Refusal):
    """Somebody changed or deleted the row after the reader had opened it; nothing was saved.

    Attributes:
        current: the row as it is now; None where it was deleted.
        base: the history entry of the version that the reader edited; None where it is not known.
        last: the newest entry of its history, which says who was faster; None where there is none.
        sentence: who did what, as the person reads it who was slower.
    """

    code = "overtaken"
    status = HTTPStatus.PRECONDITION_FAILED

    def __init__(
        self,
        current: Editable | None,
        base: HistoryEntry | None,
        last: HistoryEntry | None,
        reader: User,
    ) -> None:
        did = f"saved version {current.version}" if current else "deleted this"
        self.sentence = say_who(last.history_user if last else None, reader, did)
        super().__init__(f"{self.sentence} Compare both below, then save again.")
        self.current = current
        self.base = base
        self.last = last


def say_who(who: User | None, reader: User, did: str) -> str:
    """Return a sentence about who ``did`` something, such as ``deleted this``, before ``reader`` could."""
    if who == reader:
        return f"You {did} in another tab."
    return f"{who or 'Somebody'} has {did} in the meantime."


def add(row: Row, by: User, once: str = "") -> Row:
    """Store an unsaved ``row``, behind the others of its kind where these have a position.

    Args:
        once: the key of the form; the same one again returns the row that it has made.

    Raises ValidationError where there is such a row already.
    """
    with transaction.atomic():
        world = _lock(row.owning_world)
        rows = type(row)._default_manager
        if made := rows.filter(pk=made_before(by, once)).first():
            return made
        row.version = 1
        row.note_editor(by)
        _insert(row)
        keep([row], ADDED, by)
        remember(by, once, row.pk)
        if once:
            discard_draft_of_new(by, world, kind_of(row).name, once)
        _follow(row, world, by)
        return row


def add_many(rows: Sequence[Row], by: User, once: str = "") -> int:
    """Store unsaved ``rows`` of one model and one world, behind the others; all of them or none.

    Returns how many were added: 0 where ``once``, the key of the form, has added them before.
    Raises ValidationError where one of them is there already.
    """
    return add_all([rows], by, once)


def add_all(
    groups: Sequence[Sequence[Editable]], by: User, once: str = "", reason: str = ""
) -> int:
    """Do what ``add_many`` does for rows of several models, a group each, of one world.

    ``reason`` is for their history.
    """
    groups = [rows for rows in groups if rows]
    if not groups:
        return 0
    with transaction.atomic():
        world = _lock(groups[0][0].owning_world)
        if made_before(by, once):
            return 0
        for rows in groups:
            _insert_many(rows, world, by, reason)
        remember(by, once, groups[0][0].pk)
        for rows in groups:
            check_again(world, type(rows[0]))
        if any(row.makes_commands for rows in groups for row in rows):
            _bring_up_to_date(world, by)
        return sum(map(len, groups))


def _insert_many(rows: Sequence[Editable], world: World, by: User, reason: str = "") -> None:
    """Store unsaved rows of one model, behind the others where they have a place."""
    model = type(rows[0])
    last = None
    if isinstance(rows[0], Placed):
        beside = model._default_manager.filter(**{model.world_path: world})
        last = beside.aggregate(last=Max("position"))["last"]
    for position, row in enumerate(rows, start=0 if last is None else last + 1):
        if isinstance(row, Placed):
            row.position = position
        row.version = 1
        row.note_editor(by)
    with _refuse_repeated(model):
        keep(model._default_manager.bulk_create(rows, batch_size=BATCH), ADDED, by, reason)


def change(row: Row, values: Mapping[str, Any], by: User, version: int, again: bool = True) -> Row:
    """Make the next version of ``row``, which ``by`` edited while it was at ``version``.

    Args:
        again: whether the same change may be asked for once more, as by a form that is sent twice; the
            row is found to hold the values then, whatever its version.

    Returns the row as it is stored; at the same version where it holds these values already.
    Raises Overtaken where it is at another version or was deleted, and ValidationError where another
    row says the same; nothing is changed then.
    """
    with transaction.atomic():
        world = _lock_for(row)
        found = type(row)._default_manager.select_for_update().filter(pk=row.pk).first()
        is_same = found is not None and all(
            getattr(found, name) == value for name, value in values.items()
        )
        if found is not None and is_same and again:
            return found
        stored = require_version(row, found, version, by)
        if is_same:
            return stored
        keep_first(type(row), [row.pk])
        did_make_commands = stored.makes_commands
        for name, value in values.items():
            setattr(stored, name, value)
        stored.version += 1
        stored.note_editor(by)
        stored.validate_constraints(exclude={"position"})
        stored.save()
        keep([stored], CHANGED, by)
        _follow(stored, world, by, did_make_commands)
        return stored


def change_many(
    world: World,
    changes: Sequence[tuple[Editable, Mapping[str, Any]]],
    by: User,
    reason: str = "",
) -> None:
    """Make the next version of each row of ``world``, all of them or none; ``reason`` is for their history.

    The rows are as they were read. Raises Overtaken where one has changed since, and ValidationError
    where another row says the same.
    """
    with transaction.atomic():
        _lock(world)
        by_model: dict[type[Editable], list[tuple[Editable, Mapping[str, Any]]]] = {}
        for row, values in changes:
            by_model.setdefault(type(row), []).append((row, values))
        did_make_commands = any(row.makes_commands for row, _ in changes)
        for model, some in by_model.items():
            _change_rows(model, some, by, reason)
        for model in by_model:
            check_again(world, model)
        if did_make_commands:
            _bring_up_to_date(world, by)


def _change_rows(
    model: type[Editable],
    changes: Sequence[tuple[Editable, Mapping[str, Any]]],
    by: User,
    reason: str,
) -> None:
    rows = [row for row, _ in changes]
    for some in batches(rows):
        keys = [row.pk for row in some]
        stored = model._default_manager.select_for_update().in_bulk(keys)
        for row in some:
            require_version(row, stored.get(row.pk), row.version, by)
    keep_first(model, [row.pk for row in rows])
    fields = {"version"}
    for row, values in changes:
        for name, value in values.items():
            setattr(row, name, value)
        row.version += 1
        row.note_editor(by)
        fields |= values.keys()
    fields |= {name for name in ("author", "is_edited") if hasattr(model, name)}
    with _refuse_repeated(model):
        model._default_manager.bulk_update(rows, sorted(fields), batch_size=BATCH)
    keep(rows, CHANGED, by, reason)


def delete_many(
    world: World, groups: Sequence[Sequence[Editable]], by: User, reason: str = ""
) -> None:
    """Delete rows of ``world``, a group for each model, as they were read while the world was held."""
    groups = [rows for rows in groups if rows]
    with transaction.atomic():
        _lock(world)
        for rows in groups:
            model, keys = type(rows[0]), [row.pk for row in rows]
            keep_first(model, keys)
            keep(rows, DELETED, by, reason)
            for some in batches(keys):
                model._default_manager.filter(pk__in=some).delete()
            check_again(world, model)
        if any(row.makes_commands for rows in groups for row in rows):
            _bring_up_to_date(world, by)


def delete(row: Editable, by: User, version: int) -> None:
    """Delete ``row``, which ``by`` saw at ``version``. Its history stays, and ``restore`` brings it back.

    Raises Overtaken where it is at another version or was deleted already.
    """
    with transaction.atomic():
        world = _lock_for(row)
        stored = hold(row, version, by)
        keep_first(type(row), [row.pk])
        keep([stored], DELETED, by)
        type(row)._default_manager.filter(pk=stored.pk).delete()
        _follow(stored, world, by)


def restore(entry: HistoryEntry, by: User) -> Editable:
    """Make a row what the history ``entry`` says, as its next version; a deleted one is stored again.

    Raises ValidationError where another row says the same by now.
    """
    with transaction.atomic():
        row: Editable = entry.instance
        for field in row._meta.concrete_fields:  # what it refers to may be gone
            if isinstance(field, models.ForeignKey) and field.many_to_one and field.null:
                key = getattr(row, field.attname)
                is_there = field.related_model._default_manager.filter(pk=key).exists()
                setattr(row, field.attname, key if is_there else None)
        world = _lock(row.owning_world)
        stored = type(row)._default_manager.select_for_update().filter(pk=row.pk).first()
        if stored is not None:
            names = row.edited_fields + row.fields_beside
            values = {name: getattr(row, name) for name in names}
            return change(stored, values, by, stored.version)
        versions = history_of(type(row)).filter(id=row.pk).aggregate(last=Max("version"))
        row.version = versions["last"] + 1
        row.note_editor(by)
        _insert(row)
        keep([row], ADDED, by, RESTORED)
        _follow(row, world, by)
        return row


def bring_back(row: Row, values: Mapping[str, Any], by: User, version: int) -> Row:
    """Restore a deleted row and change it, in one step; ``version`` is that at which it was deleted.

    Raises Overtaken where somebody else has restored it, and ValidationError as ``restore`` does.
    """
    with transaction.atomic():
        _lock(row.owning_world)
        last = _last_entry(row)
        if last is not None and last.history_type == DELETED and last.version == version:
            version = restore(last, by).version
        return change(row, values, by, version)


def _follow(row: Editable, world: World, by: User, did_make_commands: bool = False) -> None:
    """Bring up to date what is made from ``row``, which was just added, changed or deleted."""
    check_again(world, type(row))
    if did_make_commands or row.makes_commands:
        _bring_up_to_date(world, by)


def _bring_up_to_date(world: World, by: User) -> None:
    """Bring the commands up to date with a change of something that makes them."""
    world.mark_changed()
    start_update(world, by)


def _lock(world: World) -> World:
    """Hold the world: imports and generation lock it too, and positions are counted by one at a time."""
    return World.objects.hold().get(pk=world.pk)


def _lock_for(row: Editable) -> World:
    """Hold what a change of the row bears on: its world where commands are made from it."""
    return _lock(row.owning_world) if row.bears_on_commands else row.owning_world


def hold(row: Row, version: int, by: User) -> Row:
    """Return the row as it is stored, which nobody else changes until the transaction is over.

    Raises Overtaken where it is not at ``version``, which ``by`` has seen, or is gone.
    """
    stored = type(row)._default_manager.select_for_update().filter(pk=row.pk).first()
    return require_version(row, stored, version, by)


def require_version(row: Editable, stored: Row | None, version: int, by: User) -> Row:
    """Return ``stored``, which is held. None is gone.

    Raises Overtaken where it is gone, or not at ``version``, which ``by`` has seen.
    """
    if stored is None or stored.version != version:
        raise Overtaken(stored, entry_at(row, version), _last_entry(row), by)
    return stored


def _last_entry(row: Editable) -> HistoryEntry | None:
    entry: HistoryEntry | None = (
        history_of(type(row)).filter(id=row.pk).order_by("-history_id").first()
    )
    return entry


def _insert(row: Editable) -> None:
    """Store a row that is not there, at the end unless its own place is free."""
    if isinstance(row, Placed):
        beside = type(row)._default_manager.filter(**{row.world_path: row.owning_world})
        if row.position is None or beside.filter(**{"position": row.position}).exists():
            last = beside.aggregate(last=Max("position"))["last"]
            row.position = 0 if last is None else last + 1
    row.validate_constraints(exclude={"position"})
    row.save(force_insert=True)


@contextmanager
def _refuse_repeated(model: type[Editable]) -> Iterator[None]:
    """Raise ValidationError, with the sentence of the constraint, where the database refuses a repeated row."""
    try:
        with transaction.atomic():
            yield
    except IntegrityError as error:
        named = (each for each in model._meta.constraints if each.name in str(error))
        broken = next(named, None)
        said = broken.get_violation_error_message() if broken else "There is such a row already."
        raise ValidationError(said) from error
