"""Starts imports for pages: at once where they are quick, otherwise as jobs, which a worker carries out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from annotations.background.job_files import kept_uploads
from annotations.background.job_weight import MOST_BYTES, MOST_COMMANDS
from annotations.background.requesting import keep_question, request_job
from annotations.background.watching import JobProgress
from annotations.exchange.competition_import import (
    CompetitionReport,
    gather_competition,
    import_competition,
)
from annotations.exchange.gathered_files import gather
from annotations.exchange.generator_files import classes_to_read
from annotations.exchange.generator_import import import_generator
from annotations.exchange.import_reports import ImportReport, PairsReport
from annotations.exchange.pair_files import gather_pairs
from annotations.exchange.pair_import import import_pairs
from annotations.language.forms import EntityClasses
from annotations.language.templates import generation_size, read_generator_files
from annotations.language.texts import LanguageError
from annotations.language.world import CLASSES_FILE, read_ontology
from annotations.models import Job, JobKind, User, World


def start_generator_import(
    world: World,
    uploads: Sequence[Any],
    by: User,
    brings_back: bool = False,
    encoding: str = "",
) -> Job | ImportReport:
    """Import now, or queue a job. An import that would remove something becomes a job that asks.

    Raises:
        LanguageError: the uploads cannot be read.
    """
    kind = JobKind.IMPORT_GENERATOR
    choices = {"brings_back": brings_back, "encoding": encoding}
    files = gather(uploads, encoding)
    if is_heavy_generator(files.files, classes_to_read(world, files.files)):
        return request_job(kind, world.name, by, choices, uploads)
    report = import_generator(world.name, files, by, may_remove=False, brings_back=brings_back)
    if report.is_waiting:
        return keep_question(kind, world.name, by, choices, uploads, report.as_json())
    return report


def is_heavy_generator(files: Mapping[str, bytes], classes: EntityClasses) -> bool:
    """Return whether importing these files takes long: they are large, or their templates make many commands.

    ``classes`` are those of the world.
    """
    if sum(map(len, files.values())) > MOST_BYTES:
        return True
    declared = {name: data for name, data in files.items() if name.lower() == CLASSES_FILE}
    ontology, _ = read_ontology(declared, classes)
    texts = read_generator_files(files, ontology.classes)
    if texts.has_errors:
        return False
    try:
        return generation_size(texts.categories()) > MOST_COMMANDS
    except LanguageError:
        return False


def import_generator_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    with kept_uploads(job) as uploads:
        files = gather(uploads, job.arguments.get("encoding", ""))
    report = import_generator(
        *(job.world_name, files, job.created_by, progress),
        may_remove=bool(job.arguments.get("is_confirmed")),
        brings_back=bool(job.arguments.get("brings_back")),
    )
    return report.as_json()


def start_competition_import(
    world: World, uploads: Sequence[Any], by: User, **choices: Any
) -> Job | CompetitionReport:
    """Import now, or queue a job. A folder with several arenas becomes a job that asks for one.

    Args:
        choices: ``brings_back``, ``encoding`` and ``arena`` of ``import_competition``.

    Raises:
        LanguageError: the uploads cannot be read.
    """
    kind, files = JobKind.IMPORT_COMPETITION, gather_competition(uploads)
    if sum(map(len, files.files.values())) > MOST_BYTES:
        return request_job(kind, world.name, by, choices, uploads)
    report = import_competition(world.name, files, by, **choices)
    if report.is_waiting:
        return keep_question(kind, world.name, by, choices, uploads, report.as_json())
    return report


def import_competition_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    with kept_uploads(job) as uploads:
        files = gather_competition(uploads)
    names = ("brings_back", "encoding", "arena")
    choices = {name: job.arguments[name] for name in names if name in job.arguments}
    return import_competition(job.world_name, files, job.created_by, progress, **choices).as_json()


def start_pairs_import(
    world: World,
    name: str,
    uploads: Sequence[Any],
    by: User,
    brings_back: bool = False,
    encoding: str = "",
    notation: str = "",
) -> Job | PairsReport:
    """Import now, or queue a job. Raises LanguageError where the uploads cannot be read."""
    files = gather_pairs(uploads, notation)
    choices = {"brings_back": brings_back, "encoding": encoding, "notation": notation}
    if sum(map(len, files.files.values())) > MOST_BYTES:
        return request_job(JobKind.IMPORT_PAIRS, world.name, by, {"name": name, **choices}, uploads)
    return import_pairs(
        *(world.name, name, files, by),
        brings_back=brings_back,
        encoding=encoding,
        notation=notation,
    )


def import_pairs_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    encoding, notation = (job.arguments.get(name, "") for name in ("encoding", "notation"))
    with kept_uploads(job) as uploads:
        files = gather_pairs(uploads, notation)
    report = import_pairs(
        *(job.world_name, job.arguments["name"], files, job.created_by, progress),
        brings_back=bool(job.arguments.get("brings_back")),
        encoding=encoding,
        notation=notation,
    )
    return report.as_json()
