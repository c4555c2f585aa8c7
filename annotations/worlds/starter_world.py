"""Verb: load the starter world, so that a new installation has something to look at and train on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from annotations.generation.generating import generate_pairs
from annotations.importing.generator_import import import_generator
from annotations.importing.pair_import import import_pairs
from annotations.language.corpus import Criterion
from annotations.models import Split, World
from annotations.splits.freezing import freeze_split

STARTER_FOLDER = Path(__file__).resolve().parents[1] / "starter"
STARTER_WORLD = "household"
STARTER_SPLITS = {
    Criterion.COMMAND: "by-command",
    Criterion.LOGICAL_FORM: "by-form",
}


def load_starter_world(say: Callable[[str], object]) -> dict[Criterion, Split]:
    """Import, generate and freeze the starter world; one that has its splits is left as it is.

    Args:
        say: takes a sentence for whoever watches.

    Returns:
        The frozen splits by criterion; fewer where somebody has removed one.
    """
    world = World.objects.filter(name=STARTER_WORLD).first()
    if world is None or not world.splits.exists():
        say(f"Loading the starter world “{STARTER_WORLD}”.")
        import_generator(STARTER_WORLD, STARTER_FOLDER)
        world = World.objects.get(name=STARTER_WORLD)
        if not world.description:
            world.description = "A household of seven rooms, to look around in and to train on."
            world.save(update_fields=["description"])
        generate_pairs(world)
        import_pairs(STARTER_WORLD, "published", STARTER_FOLDER)
        for criterion, name in STARTER_SPLITS.items():
            freeze_split(world, name, criterion)
    names = set(STARTER_SPLITS.values())
    return {Criterion(each.criterion): each for each in world.splits.filter(name__in=names)}
