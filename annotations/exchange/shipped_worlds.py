"""Verb: load a world that comes with this project: its files, commands, paraphrases and splits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from django.db.models import QuerySet

from annotations.background.progress import UNWATCHED, PartOfProgress, Progress
from annotations.background.requesting import request_job
from annotations.background.watching import JobProgress
from annotations.exchange.generator_import import import_generator
from annotations.exchange.pair_import import import_pairs
from annotations.exchange.target_world import require_world_name
from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs
from annotations.language.corpus import Criterion
from annotations.language.templates import EVERYTHING, Balance, SampleRequest
from annotations.language.texts import LanguageError
from annotations.models import (
    Entity,
    Job,
    JobKind,
    Production,
    SemanticTemplate,
    User,
    World,
)

SHIPPED_FOLDER = Path(__file__).resolve().parents[1] / "starter"
SPLITS = {Criterion.COMMAND: "by-command", Criterion.LOGICAL_FORM: "by-form"}
PARAPHRASES = "published"  # the name of the pairs among the world's sources


@dataclass(frozen=True, slots=True)
class ShippedWorld:
    """A world whose files lie in ``annotations/starter/NAME/``, and the commands that are made of it."""

    name: str
    description: str
    commands: SampleRequest = EVERYTHING

    @property
    def folder(self) -> Path:
        return SHIPPED_FOLDER / self.name


SHIPPED_WORLDS: Mapping[str, ShippedWorld] = {
    each.name: each
    for each in (
        ShippedWorld("household", "A household of seven rooms, to look around in and to train on."),
        ShippedWorld(
            "competition",
            "The commands of RoboCup@Home in 2025 and 2026; import a competition's folder into it.",
            SampleRequest(3_000, balance=Balance.FORMS),
        ),
    )
}


@dataclass(frozen=True, slots=True)
class LoadedWorld:
    """What was loaded: rows by kind, and the names of the splits."""

    world: str
    shipped: str
    rows: Mapping[str, int]
    splits: tuple[str, ...]

    def as_json(self) -> dict[str, Any]:
        return {**asdict(self), "rows": dict(self.rows), "splits": list(self.splits)}


def load_world(
    shipped: ShippedWorld, name: str, by: User | None = None, progress: Progress = UNWATCHED
) -> LoadedWorld:
    """Import, generate and freeze a shipped world as the world ``name``.

    Args:
        name: created if it does not exist; else it has to be empty.
        by: who asked; they become the admin of a world that this creates.

    Raises:
        LanguageError: the name will not do, the world holds something already, or as ``import_generator``.
    """
    require_world_name(name)
    existing = World.objects.filter(name=name).first()
    if existing is not None and not is_empty(existing):
        raise LanguageError(
            f"the world “{name}” is not empty", hint="choose another name, or delete it first"
        )
    return fill_world(shipped, name, by, progress)


def fill_world(
    shipped: ShippedWorld, name: str, by: User | None = None, progress: Progress = UNWATCHED
) -> LoadedWorld:
    """Make the world ``name`` the shipped one, whatever it holds. Raises as ``load_world``."""
    report = import_generator(name, shipped.folder, by, PartOfProgress(progress, 0, 0.2))
    if report.is_refused:
        raise LanguageError(f"the files of “{shipped.name}” are damaged: {report.errors[0]}")
    world = World.objects.get(name=name)
    if not world.description:
        world.description = shipped.description
        world.save(update_fields=["description"])
    generate_pairs(world, progress=PartOfProgress(progress, 0.2, 0.7), request=shipped.commands)
    import_pairs(name, PARAPHRASES, shipped.folder, by, PartOfProgress(progress, 0.7, 0.9))
    progress.report(0.9, "freezing splits")
    for criterion, split in SPLITS.items():
        freeze_split(world, split, criterion, by=by)
    return LoadedWorld(name, shipped.name, _count_rows(world), tuple(SPLITS.values()))


def is_empty(world: World) -> bool:
    """Return whether nobody has described or collected anything in the world yet."""
    return not any(_count_rows(world).values()) and not world.splits.exists()


def _count_rows(world: World) -> dict[str, int]:
    rows: dict[str, QuerySet[Any]] = {
        "entities": Entity.objects.filter(ontology__world=world),
        "productions": Production.objects.filter(grammar__world=world),
        "templates": SemanticTemplate.objects.filter(grammar__world=world),
        "predicates": world.predicates.all(),
        "commands": world.commands.all(),
        "paraphrases": world.paraphrases.all(),
    }
    return {name: each.count() for name, each in rows.items()}


def request_load(shipped: str, world: World, by: User) -> Job:
    """Queue the loading of a shipped world into an empty one."""
    return request_job(JobKind.LOAD_WORLD, world.name, by, {"shipped": shipped})


def load_world_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    shipped = SHIPPED_WORLDS[job.arguments["shipped"]]
    return load_world(shipped, job.world_name, job.created_by, progress).as_json()
