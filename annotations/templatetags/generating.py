"""What waits to be generated, for the pages that say so."""

from __future__ import annotations

from django import template

from annotations.generation.waiting import WaitingCommands, waiting_commands
from annotations.models import Job, JobKind, World

register = template.Library()


@register.simple_tag
def commands_to_generate(world: World) -> WaitingCommands | None:
    """Return the commands that wait for the first generation, counted; None where none do."""
    return waiting_commands(world)


@register.simple_tag
def generation_job(world: World) -> Job | None:
    """Return the job that makes the commands of ``world`` now, or is about to."""
    return world.jobs.active().filter(kind=JobKind.GENERATE).first()
