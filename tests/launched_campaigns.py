"""A world that campaigns draw prompts from, and campaigns in it."""

from __future__ import annotations

from typing import Any

from annotations.campaigns.launching import PromptChoice, launch
from annotations.exchange.generator_import import import_generator
from annotations.exchange.starter_world import STARTER_FOLDER
from annotations.generation.generating import generate_pairs
from annotations.models import Campaign, User, World


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


def small_campaign(world: World, **values: Any) -> Campaign:
    """Store a campaign of two prompts in any world, each of which names an entity of its own."""
    values = {"name": "first", "task_size": 2, "free_commands": 1, **values}
    campaign = Campaign.objects.create(world=world, **values)
    for position, (text, entity) in enumerate(
        (
            ("bring me the apple from the kitchen table", "apple"),
            ("tell me how many people are in the living room", "living room"),
        ),
        start=1,
    ):
        campaign.prompts.create(
            logical_form=f"( go {position} )",
            prompt=text,
            grounded_form=f"( go {position} )",
            shown=text,
            entities=[{"text": entity, "aliases": [], "is_described": False}],
            position=position,
        )
    return campaign
