"""Verb: let a worker parse a batch that is too large, or not urgent enough, for an answer at once."""

from __future__ import annotations

from http import HTTPStatus

from django.core.files.base import ContentFile
from django.db import transaction

from annotations.background.requesting import request_job
from annotations.language.texts import Refusal
from annotations.models import Job, JobKind, User, World

MOST_AT_ONCE = 3  # batches of one person that wait or run


def request_batch(
    world: World, lines: bytes, beam: int, run: int | None, by: User, parser: str = ""
) -> Job:
    """Let a worker parse JSON lines, in ``beam`` ways each. ``run`` None asks the promoted parser, or ``parser``,
    one that needs no run.

    Raises Refusal where ``MOST_AT_ONCE`` batches of the person wait or run.
    """
    upload = ContentFile(lines, name="lines.jsonl")
    with transaction.atomic():
        User.objects.select_for_update(no_key=True).get(pk=by.pk)  # one of two requests waits
        active = Job.objects.active().filter(kind=JobKind.PARSE, created_by=by)
        if active.count() >= MOST_AT_ONCE:
            raise Refusal(
                f"{MOST_AT_ONCE} of your batches wait or run already. Send this one when one of them has ended.",
                "too_many_batches",
                HTTPStatus.CONFLICT,
            )
        arguments = {"beam": beam, "run": run, "parser": parser}
        return request_job(JobKind.PARSE, world.name, by, arguments, [upload])
