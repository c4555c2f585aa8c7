"""Verb: load the starter world, so that a new installation has something to look at and train on."""

from __future__ import annotations

from collections.abc import Callable

from annotations.exchange.shipped_worlds import SHIPPED_WORLDS, SPLITS, fill_world
from annotations.language.corpus import Criterion
from annotations.models import Split, World

STARTER_WORLD = "household"
STARTER_FOLDER = SHIPPED_WORLDS[STARTER_WORLD].folder


def load_starter_world(say: Callable[[str], object]) -> dict[Criterion, Split]:
    """Load the starter world; one that has its splits is left as it is.

    Args:
        say: takes a sentence for whoever watches.

    Returns:
        The frozen splits by criterion; fewer where somebody has removed one.
    """
    world = World.objects.filter(name=STARTER_WORLD).first()
    if world is None or not world.splits.exists():
        say(f"Loading the starter world “{STARTER_WORLD}”.")
        fill_world(SHIPPED_WORLDS[STARTER_WORLD], STARTER_WORLD)
        world = World.objects.get(name=STARTER_WORLD)
    names = set(SPLITS.values())
    return {Criterion(each.criterion): each for each in world.splits.filter(name__in=names)}
