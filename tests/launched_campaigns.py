"""A world that campaigns draw prompts from, and campaigns in it."""

from __future__ import annotations

from typing import Any

from annotations.campaigns.launching import PromptChoice, launch
from annotations.generation.generating import generate_pairs
from annotations.importing.generator_import import import_generator
from annotations.models import Campaign, User, World
from annotations.worlds.starter_world import STARTER_FOLDER


def fill_household(world: World) -> World:
    """Put grammar, entities and commands of the starter world into an empty world, without paraphrases."""
    import_generator(world.name, STARTER_FOLDER)
    generate_pairs(world)
    return world


def launch_in(
    world: World, by: User, choice: dict[str, Any] | None = None, **values: Any
) -> Campaign:
    """Launch a small campaign: ``values`` of ``Campaign``, ``choice`` of ``PromptChoice``."""
    values = {"name": "first", "task_size": 4, "free_commands": 1, **values}
    chosen = PromptChoice(**{"prompts_per_form": 2, **(choice or {})})
    return launch(Campaign(world=world, **values), chosen, by)
