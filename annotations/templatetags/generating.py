"""What waits to be generated, for the pages that say so."""

from __future__ import annotations

from django import template

from annotations.generation.waiting import WaitingCommands, waiting_commands
from annotations.models import World

register = template.Library()


@register.simple_tag
def commands_to_generate(world: World) -> WaitingCommands | None:
    """Return the commands that wait for the first generation, counted; None where none do."""
    return waiting_commands(world)
