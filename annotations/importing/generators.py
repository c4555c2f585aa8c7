"""Imports a command generator (FORMATS §1–§3) into a world."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from annotations.background.progress import UNWATCHED, Progress
from annotations.generation.coverage import count_coverage, store_coverage
from annotations.importing.files import gather
from annotations.importing.generator_files import Generator, read_generator
from annotations.importing.report import ImportReport
from annotations.importing.storing import PreparedProductions, removals_of, store
from annotations.importing.worlds import locked_world, require_world_name
from annotations.language.errors import LanguageError
from annotations.language.predicates import Predicate
from annotations.models import User, World
from annotations.rows.composition import own_template_source
from annotations.rows.from_rows import predicates_of


def import_generator(
    world_name: str,
    source: Path | str | Mapping[str, bytes],
    by: User | None = None,
    progress: Progress = UNWATCHED,
    may_remove: bool = True,
) -> ImportReport:
    """Makes a world's ontology, grammar, templates and predicates those of a generator.

    Args:
        world_name: the world to import into; it is made where there is none of that name.
        source: a folder, or the files of an upload as name → bytes.
        by: who asked. They become the admin of a world that this makes.
        may_remove: whether what the files do not have any more may go. If not, and something would,
            nothing is stored and the report says what it is.

    Returns:
        What was read and done. With an error among its problems nothing was stored; warnings are stored
        beside what they are about. Rows that are right already are not touched, and neither are
        templates, entities and predicates that people wrote or changed.
    """
    try:
        require_world_name(world_name)
        files = gather(source)
    except LanguageError as error:
        return ImportReport(world_name, problems=(error.problem,))
    progress.report(0.05, "reading the files")
    generator = read_generator(files, _edited_predicates(world_name))
    progress.check()
    report = _report(world_name, generator)
    if report.is_refused:
        return report
    world = World.objects.filter(name=world_name).first()
    removals = removals_of(world, generator)
    if removals and not may_remove:
        return replace(report, removals=removals, is_waiting=True)
    progress.report(0.6, "counting the commands of the grammar")
    coverage = count_coverage(generator.texts.categories(), _commands_of(world))
    progress.report(0.8, "writing")
    with PreparedProductions(world, generator) as productions, progress.writing():
        world = locked_world(world_name, by)
        changes = store(world, generator, productions, by)
        store_coverage(world, coverage)
        report = replace(report, changes=changes, removals=removals)
        progress.conclude(report.as_json())
    return report


def _commands_of(world: World | None) -> frozenset[str]:
    if world is None:
        return frozenset()
    return frozenset(world.commands.values_list("anonymized_text", flat=True))


def _edited_predicates(world_name: str) -> dict[str, Predicate]:
    world = World.objects.filter(name=world_name).first()
    return predicates_of(world, world.predicates.filter(is_edited=True)) if world else {}


def _report(world_name: str, generator: Generator) -> ImportReport:
    texts = generator.texts
    return ImportReport(
        world_name,
        productions={name: len(file.productions) for name, file in texts.grammars.files.items()},
        templates={
            each.name: len(texts.templates.get(own_template_source(each), ()))
            for each in texts.compositions
        },
        entities=dict(Counter(each.entity_class for each in generator.ontology.entities)),
        predicates=len(generator.predicates),
        problems=generator.all_problems,
    )
