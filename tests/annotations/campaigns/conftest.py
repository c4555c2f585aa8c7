from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from annotations.campaigns.launching import PromptChoice, launch
from annotations.generation.generating import generate_pairs
from annotations.importing.generator_import import import_generator
from annotations.models import Campaign, World
from annotations.worlds.starter_world import STARTER_FOLDER
from tests.replaying import made_once


def fill(world: World) -> World:
    import_generator(world.name, STARTER_FOLDER)
    generate_pairs(world)
    return world


@pytest.fixture
def household(world) -> World:
    """``world`` with the grammar, entities and commands of the starter world, without paraphrases."""
    return made_once(fill, world)


@pytest.fixture
def launched(household, admin) -> Callable[..., Campaign]:
    """Launches a campaign: columns of ``Campaign``, and ``choice`` for those of ``PromptChoice``."""

    def launch_it(choice: dict[str, Any] | None = None, **values: Any) -> Campaign:
        values = {"name": "first", "task_size": 4, "free_commands": 1, **values}
        chosen = PromptChoice(**{"prompts_per_form": 2, **(choice or {})})
        return launch(Campaign(world=household, **values), chosen, admin)

    return launch_it
