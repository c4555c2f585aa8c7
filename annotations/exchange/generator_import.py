"""Import a command generator (docs/reference/formats.md) into a world."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import Any, Self

from annotations import models
from annotations.background.progress import UNWATCHED, Progress
from annotations.exchange.gathered_files import gather
from annotations.exchange.generator_files import Generator, classes_to_read, read_generator
from annotations.exchange.import_plans import (
    categories_of_people,
    differences_of,
    plan_categories,
    plan_classes,
    plan_entities,
    plan_predicates,
    plan_productions,
    plan_templates,
)
from annotations.exchange.import_reports import ImportReport
from annotations.exchange.source_files import FileSource, GatheredFiles
from annotations.exchange.target_world import lock_world, require_world_name
from annotations.generation.coverage import count_coverage, known_commands, store_coverage
from annotations.generation.world_problems import check_again
from annotations.language.texts import LanguageError
from annotations.models import Entity, Production, User, World
from annotations.models.description import ProblemSubject
from annotations.rows.from_rows import predicates_of, task_categories
from annotations.rows.staging import Staging
from annotations.rows.stored_problems import store_problems, store_problems_of_import
from annotations.rows.synchronise import Changes, RowPlan


def import_generator(
    world_name: str,
    source: FileSource | GatheredFiles,
    by: User | None = None,
    progress: Progress = UNWATCHED,
    may_remove: bool = True,
    brings_back: bool = False,
    encoding: str = "",
) -> ImportReport:
    """Make a world's ontology, grammar, templates and predicates those of a generator.

    Args:
        world_name: the world to import into; created if it does not exist.
        source: a folder, files as name → bytes, or the files of an upload.
        by: who asked; they become the admin of a world that this creates.
        may_remove: whether rows that the files no longer have may be deleted. If not, and there are
            any, nothing is stored and the report lists them.
        brings_back: whether rows that people have deleted here are restored. If not, their lines are
            left out and the report lists them.
        encoding: of the files that are not UTF-8 (``decoding.ENCODINGS``); without one, they are errors.

    Returns:
        What was read and done. If any problem is an error, nothing was stored; warnings are stored with
        their rows. What is right already, and what people wrote, changed, moved or renamed, is not touched.
    """
    try:
        require_world_name(world_name)
        gathered = gather(source, encoding)
    except LanguageError as error:
        return ImportReport(world_name, problems=(error.problem,))
    progress.report(0.05, "reading the files")
    world = World.objects.filter(name=world_name).first()
    edited = predicates_of(world, world.predicates.filter(is_edited=True)) if world else {}
    classes = classes_to_read(world, gathered.files)
    generator = read_generator(gathered.files, edited, gathered.problems, classes)
    progress.check()
    texts = generator.texts
    report = ImportReport(
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
    progress.report(0.6, "counting the commands of the grammar")
    coverage = count_coverage(generator.texts.categories(), known_commands(world))
    progress.report(0.8, "writing")
    with prepared as productions, progress.writing():
        world = lock_world(report.world, by, is_bare=True)  # the files say which classes it has
        changes = store(world, generator, productions, by, brings_back)
        # The grammar is not that of the files where lines were left out or people have changed a task category.
        if report.left_out.productions or apart.has_own_categories:
            coverage = count_coverage(task_categories(world), known_commands(world))
        store_coverage(world, coverage)
        # The problems of the rows are not those of the files where lines were left out.
        if report.left_out.productions or report.left_out.templates:
            check_again(world, Production)
        if report.left_out.entities:
            check_again(world, Entity)
        report = replace(report, changes=changes)
        progress.conclude(report.as_json())
    return report


class PreparedProductions:
    """The productions of ``generator``, collected before the transaction, so that writing many is quick.

    ``planned`` is what it takes to store them in ``world`` as it was read.
    """

    COLUMNS = ("source", "line", "nonterminal", "expansion", "task_category", "position", "version")

    def __init__(
        self,
        world: models.World | None,
        generator: Generator,
        planned: RowPlan[models.Production],
        brings_back: bool,
    ) -> None:
        self._generator = generator
        self._brings_back = brings_back
        self._revision = world.revision if world else 0
        self._plan = planned
        self._staging = Staging(models.Production, self.COLUMNS)

    def __enter__(self) -> Self:
        self._staging.__enter__().add_new(self._plan.new)
        return self

    def __exit__(self, *raised: Any) -> None:
        self._staging.__exit__(*raised)

    def apply(
        self, world: models.World, grammar: models.Grammar, by: models.User | None
    ) -> Changes:
        """Write them, inside a transaction; compare again if somebody has changed the world since."""
        if world.revision != self._revision:
            of_people = categories_of_people(grammar)
            planned = plan_productions(grammar, self._generator, self._brings_back, of_people)
            return planned.apply(by)
        self._plan.apply_to_stored(by)
        self._staging.insert(grammar_id=str(int(grammar.pk)))
        return self._plan.changes


def store(
    world: models.World,
    generator: Generator,
    productions: PreparedProductions,
    by: models.User | None = None,
    brings_back: bool = False,
) -> Changes:
    """Make the world's ontology, grammar, templates and predicates those of ``generator``.

    What a person has changed keeps what it says; a template that a person wrote stays, behind those of
    the files. What a person has deleted stays away unless ``brings_back``. To be called inside a
    transaction, where all but the productions is compared once more: edits of entities, predicates and
    drafts do not change the world's revision.
    """
    grammar, _ = models.Grammar.objects.select_related("world").get_or_create(world=world)
    ontology, _ = models.Ontology.objects.select_related("world").get_or_create(world=world)
    of_people = categories_of_people(grammar)
    changes = plan_categories(grammar, generator, of_people).apply(by)
    changes += productions.apply(world, grammar, by)
    changes += plan_templates(grammar, generator, brings_back, of_people).apply(by)
    if not changes.is_none or changes.moved:
        world.mark_changed()
    changes += plan_classes(world, generator).apply(by)
    changes += plan_entities(ontology, generator, brings_back).apply(by)
    changes += plan_predicates(world, generator, brings_back).apply(by)
    for subject, problems in generator.problems.items():
        store_problems(world, subject, problems)
    store_problems_of_import(grammar, generator.problems[ProblemSubject.TEMPLATES])
    return changes
