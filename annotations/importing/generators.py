"""Import a command generator (FORMATS §1–§3) into a world."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from annotations.background.progress import UNWATCHED, Progress
from annotations.checking import check_again
from annotations.generation.coverage import count_coverage, store_coverage
from annotations.importing.files import gather
from annotations.importing.generator_files import Generator, read_generator
from annotations.importing.plans import Texts, differences_of
from annotations.importing.report import ImportReport
from annotations.importing.storing import PreparedProductions, store
from annotations.importing.worlds import locked_world, require_world_name
from annotations.language.errors import LanguageError
from annotations.language.predicates import Predicate
from annotations.models import Entity, Production, User, World
from annotations.rows.from_rows import predicates_of, task_categories


def import_generator(
    world_name: str,
    source: Path | str | Mapping[str, bytes],
    by: User | None = None,
    progress: Progress = UNWATCHED,
    may_remove: bool = True,
    brings_back: bool = False,
) -> ImportReport:
    """Make a world's ontology, grammar, templates and predicates those of a generator.

    Args:
        world_name: the world to import into; created if it does not exist.
        source: a folder, or the files of an upload as name → bytes.
        by: who asked; they become the admin of a world that this creates.
        may_remove: whether rows that the files no longer have may be deleted. If not, and there are
            any, nothing is stored and the report lists them.
        brings_back: whether rows that people have deleted here are restored. If not, their lines are
            left out and the report lists them.

    Returns:
        What was read and done. If any problem is an error, nothing was stored; warnings are stored with
        their rows. What is right already, and what people wrote, changed, moved or renamed, is not touched.
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
    return _compare_and_store(generator, report, by, progress, may_remove, brings_back)


def _compare_and_store(
    generator: Generator,
    report: ImportReport,
    by: User | None,
    progress: Progress,
    may_remove: bool,
    brings_back: bool,
) -> ImportReport:
    """Say what would change in the world, and store it unless that has to be asked first."""
    world = World.objects.filter(name=report.world).first()
    apart = differences_of(world, generator, brings_back)
    report = replace(report, removals=apart.removals, left_out=apart.left_out)
    if apart.removals and not may_remove:
        return replace(report, is_waiting=True)
    prepared = PreparedProductions(world, generator, apart.productions, brings_back)
    return _store(world, generator, prepared, report, by, progress, brings_back)


def _store(
    world: World | None,
    generator: Generator,
    prepared: PreparedProductions,
    report: ImportReport,
    by: User | None,
    progress: Progress,
    brings_back: bool,
) -> ImportReport:
    """Count the grammar's commands, then write everything in one transaction."""
    progress.report(0.6, "counting the commands of the grammar")
    coverage = count_coverage(generator.texts.categories(), _commands_of(world))
    progress.report(0.8, "writing")
    with prepared as productions, progress.writing():
        world = locked_world(report.world, by)
        changes = store(world, generator, productions, by, brings_back)
        if report.left_out.productions:  # the grammar is not that of the files
            coverage = count_coverage(task_categories(world), _commands_of(world))
        store_coverage(world, coverage)
        _check_what_is_stored(world, report.left_out)
        report = replace(report, changes=changes)
        progress.conclude(report.as_json())
    return report


def _check_what_is_stored(world: World, left_out: Texts) -> None:
    """Store the problems of the rows anew where they are not those of the files."""
    if left_out.productions or left_out.templates:
        check_again(world, Production)
    if left_out.entities:
        check_again(world, Entity)


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
            each.name: len(texts.templates.get(each.own_template_file, ()))
            for each in texts.compositions
        },
        entities=dict(Counter(each.entity_class for each in generator.ontology.entities)),
        predicates=len(generator.predicates),
        problems=generator.all_problems,
    )
