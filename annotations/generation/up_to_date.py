"""Verb: make commands and forms what templates and grammar say, with the change that was just made.

Only what changed is expanded: the rest is kept from before (``kept_expansions``).
"""

from __future__ import annotations

from dataclasses import dataclass

from django.db import connection

from annotations import models
from annotations.background.requesting import request_job
from annotations.generation.generated_world import GeneratedWorld, counters_of
from annotations.generation.kept_expansions import generate_at_once
from annotations.generation.language_size import is_large, make_commands
from annotations.language.texts import LanguageError
from annotations.rows.from_rows import annotated_categories
from annotations.rows.synchronise import Changes

NOTHING = Changes()


@dataclass(frozen=True, slots=True)
class UpdateOutcome:
    """Whether the commands are those of the templates now, what it took, and how many got another form.

    ``trouble`` is a sentence about why they are not.
    """

    is_up_to_date: bool
    changes: Changes = NOTHING
    new_forms: int = 0
    trouble: str = ""


def bring_up_to_date(world: models.World) -> UpdateOutcome:
    """Write the commands, forms, conflicts and coverage that ``generate_pairs`` would give.

    To be called inside the transaction that changed a template or the grammar, which has marked the
    world as changed. A sample is drawn anew with its seed. A world that is too large, or that cannot be expanded, is
    left as it is and stays marked. Rows that are right already are not touched.
    """
    locked = models.World.objects.hold().get(pk=world.pk)
    if not locked.commands_are_stale:
        return UpdateOutcome(True)
    try:
        categories = annotated_categories(locked)
        values = [category.value for category in categories]
        request, sample = locked.sample_request, None
        if request.size and is_large(locked):
            return UpdateOutcome(False, trouble=f"a sample of {request.size:,} commands is drawn")
        if request.size:
            generated, sample = make_commands(values, request, None)
        else:
            generated = generate_at_once(values)
    except LanguageError as error:
        return UpdateOutcome(False, trouble=str(error))
    with GeneratedWorld(locked, categories, generated, sample=sample) as rows:
        changes = rows.write(counters_of(locked))
        return UpdateOutcome(True, changes, rows.commands.new_forms)


def start_update(world: models.World, by: models.User) -> UpdateOutcome:
    """Bring commands up to date with a change, in the caller's transaction, or ask a worker to.

    The world was marked as changed before. A job that waits to generate it already is enough. While others wait to
    write, it is left to the last of them, or to the worker: expanding templates takes longer than all else.
    """
    outcome = UpdateOutcome(False) if _others_wait() else bring_up_to_date(world)
    if not outcome.is_up_to_date:
        waiting = models.Job.objects.queued().filter(kind=models.JobKind.GENERATE, world=world)
        if not waiting.exists():
            request_job(models.JobKind.GENERATE, world.name, by)
    return outcome


def _others_wait() -> bool:
    """Return whether somebody waits for what this transaction holds; SQLite does not say."""
    if connection.vendor != "postgresql":
        return False
    with connection.cursor() as cursor:
        cursor.execute(
            "SELECT EXISTS (SELECT FROM pg_locks WHERE NOT granted AND pg_backend_pid() = ANY(pg_blocking_pids(pid)))"
        )
        return bool(cursor.fetchone()[0])
