"""Import the folder of a competition since 2024 into a world: its names, rooms, locations and objects."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from annotations import models
from annotations.background.progress import UNWATCHED, Progress
from annotations.exchange.gathered_files import convert
from annotations.exchange.import_reports import Refusable
from annotations.exchange.source_files import FileSource, GatheredFiles, read_files
from annotations.exchange.target_world import lock_world, require_world_name
from annotations.generation.entity_check import entity_problems
from annotations.generation.world_problems import check_again
from annotations.language.templates import TaskCategory
from annotations.language.texts import LanguageError, Problem
from annotations.language.world import (
    COMPETITION_CLASSES,
    PUBLISHED_GENERATORS,
    Entity,
    Ontology,
    choose_files,
    guess_room,
    lost_rows,
    may_be_in_folder,
    read_competition,
    warnings_of_lost,
)
from annotations.models import User, World
from annotations.rows.decisions import respect
from annotations.rows.from_rows import ontology_of, predicates_of, task_categories
from annotations.rows.history import keys_changed_by_people
from annotations.rows.stored_problems import as_json, first_problems
from annotations.rows.synchronise import Changes, RowPlan, plan


@dataclass(frozen=True, slots=True)
class CompetitionReport(Refusable):
    """What was read and done. ``entities`` counts them by class, ``without_room`` locations whose room nobody has said.

    ``lost`` counts, by published generator and class, the rows that the generator does not read as they are meant; its
    ``problems`` say which, and what grammar and templates ask for that no entity of the world is.

    With an error among the ``problems`` nothing was stored. ``left_out`` are entities that people have deleted or
    renamed here. ``guessed_rooms`` are those that the names of such locations say; nobody has stored them. With
    ``arenas`` nothing was stored either: the folder has files of several, and one has to be chosen.
    """

    world: str
    entities: Mapping[str, int] = field(default_factory=dict)
    without_room: tuple[str, ...] = ()
    lost: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    problems: tuple[Problem, ...] = ()
    changes: Changes = field(default_factory=Changes)
    left_out: tuple[str, ...] = ()
    guessed_rooms: Mapping[str, str] = field(default_factory=dict)
    arenas: tuple[str, ...] = ()

    @property
    def is_waiting(self) -> bool:
        return bool(self.arenas) and not self.is_refused

    def as_json(self) -> dict[str, Any]:
        told = {
            name: getattr(self, name) for name in ("world", "without_room", "left_out", "arenas")
        }
        return {
            **{
                name: list(value) if isinstance(value, tuple) else value
                for name, value in told.items()
            },
            "entities": dict(self.entities),
            "lost": {name: dict(counts) for name, counts in self.lost.items()},
            "problems": [as_json(problem) for problem in self.problems],
            "changes": asdict(self.changes),
            "guessed_rooms": dict(self.guessed_rooms),
            "is_waiting": self.is_waiting,
        }


def import_competition(
    world_name: str,
    source: FileSource | GatheredFiles,
    by: User | None = None,
    progress: Progress = UNWATCHED,
    brings_back: bool = False,
    encoding: str = "",
    arena: str = "",
) -> CompetitionReport:
    """Make the names, rooms, locations and objects of a world those of a folder.

    Grammar, templates and the entities of classes that such a folder does not have stay. A location keeps its room,
    and an entity the aliases and attributes that people have added. The same folder twice changes nothing.

    Args:
        world_name: created if it does not exist.
        source: what ``read_files`` takes, which the four files may lie in at any depth; or what ``gather_competition``
            has made of it.
        by: who asked; they become the admin of a world that this creates.
        brings_back: whether entities that people have deleted here are restored.
        encoding: of the files that are not UTF-8.
        arena: whose files are taken where the folder has those of several.

    Returns:
        What was read and done. If any problem is an error, nothing was stored.
    """
    try:
        require_world_name(world_name)
        gathered = source if isinstance(source, GatheredFiles) else gather_competition(source)
    except LanguageError as error:
        return CompetitionReport(world_name, problems=(error.problem,))
    progress.report(0.2, "reading the files")
    choice = choose_files(gathered.files, arena, gathered.others)
    if choice.arenas and not choice.problems:
        return CompetitionReport(world_name, arenas=choice.arenas)
    paths = choice.paths.items()
    files = convert(GatheredFiles({place: gathered.files[path] for place, path in paths}), encoding)
    ontology, unread = read_competition(files.files)
    found = [*gathered.problems, *choice.problems, *files.problems, *unread]
    report = CompetitionReport(
        world_name,
        entities=dict(Counter(each.entity_class for each in ontology.entities)),
        problems=first_problems(found),
    )
    if report.is_refused:
        return report
    lost = tuple(lost_rows(files.files, ontology))
    of_generators = {
        name: Counter(row.entity.entity_class for row in lost if row.generator == name)
        for name in PUBLISHED_GENERATORS
    }
    found += warnings_of_lost(lost)
    categories = _categories_of(world_name)
    progress.report(0.6, "writing")
    with progress.writing():
        world = lock_world(world_name, by)
        world.entity_classes.add_of_household(world)
        stored, _ = models.Ontology.objects.select_related("world").get_or_create(world=world)
        planned = plan_competition(stored, ontology, brings_back)
        changes = planned.apply(by)
        check_again(world, models.Entity)
        if categories:
            found += entity_problems(categories, ontology_of(world), predicates_of(world))
        report = replace(
            report,
            lost=of_generators,
            problems=first_problems(found),
            changes=changes,
            without_room=(without_room := tuple(_without_room(world))),
            guessed_rooms=_guess_rooms(without_room, ontology),
            left_out=tuple(f"{row} ({why})" for row, why in planned.left_out),
        )
        progress.conclude(report.as_json())
    return report


def plan_competition(
    stored: models.Ontology, read: Ontology, brings_back: bool = False
) -> RowPlan[models.Entity]:
    """Plan the entities of the folder's classes; those of other classes come behind them, as they are."""
    rows = list(stored.entities.order_by("position"))
    rooms = {row.text: row.attributes["room"] for row in rows if row.attributes.get("room")}
    changed_by_people = keys_changed_by_people(models.Entity, stored.world)
    changed = {_key_of(row): row for row in rows if row.pk in changed_by_people}
    wanted = [_row_of(stored, each, rooms) for each in read.entities]
    for row in wanted:
        if kept := changed.get(_key_of(row)):
            # The folder decides what it says; rooms, aliases and the like are what people have added.
            row.aliases, row.attributes = kept.aliases, {**kept.attributes, **row.attributes}
    for row in rows:
        if row.entity_class not in COMPETITION_CLASSES:
            texts = {"entity_class": row.entity_class, "text": row.text, "aliases": row.aliases}
            place = {"attributes": row.attributes, "source": row.source, "line": row.line}
            wanted.append(models.Entity(ontology=stored, **texts, **place))
    for position, row in enumerate(wanted):
        row.position = position
    fields = ["aliases", "attributes", "source", "line", "position"]
    return respect(
        plan(stored.entities.all(), wanted, _key_of, fields), stored.world, _key_of, brings_back
    )


def _row_of(stored: models.Ontology, entity: Entity, rooms: Mapping[str, str]) -> models.Entity:
    attributes = dict(entity.attributes)
    room = rooms.get(entity.text) if entity.entity_class == "location" else None
    return models.Entity(
        ontology=stored,
        entity_class=entity.entity_class,
        text=entity.text,
        aliases=list(entity.aliases),
        attributes={**attributes, "room": room} if room else attributes,
        source=entity.position.source,
        line=entity.position.line,
    )


def _key_of(row: models.Entity) -> tuple[str, str, str]:
    """Return what tells entities apart: a category stands once for each place where its objects belong."""
    beside = {"category": "defaultLocation", "object": "category"}.get(row.entity_class, "")
    return row.entity_class, row.text, row.attributes.get(beside, "")


def _categories_of(world_name: str) -> tuple[TaskCategory, ...]:
    """Return the task categories of the world; none where there is none, or where a stored line cannot be read, which
    its page says."""
    world = World.objects.filter(name=world_name).first()
    try:
        return task_categories(world) if world else ()
    except LanguageError:
        return ()


def _without_room(world: World) -> list[str]:
    locations = models.Entity.objects.filter(ontology__world=world, entity_class="location")
    return [each.text for each in locations.order_by("position") if not each.attributes.get("room")]


def _guess_rooms(locations: Iterable[str], ontology: Ontology) -> dict[str, str]:
    rooms = [each.text for each in ontology.of_class("room")]
    return {each: room for each in locations if (room := guess_room(each, rooms))}


def gather_competition(source: FileSource) -> GatheredFiles:
    """Return the files that may be of a competition's folder. Raises LanguageError as ``read_files``."""
    return read_files(source, may_be_in_folder)
