"""``benchmark DIR --parsers a,b --json FILE``: the accuracy table over a folder of pairs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser
from tqdm import tqdm

from annotations.language.splitting import Criterion
from annotations.management.base import find_world
from annotations.models import World
from parser_service.benchmarking import SETTINGS, CellFile, Job, Training, cell_key, jobs, measure
from parser_service.content_key import knowledge_hash
from parser_service.corpus import Corpus, read_corpus, split_by_source_command
from parser_service.knowledge import anonymizer_of, knowledge_of
from parser_service.management.options import read_hyperparameters
from parser_service.models.runs import Protocol
from parser_service.parsers.interface import Knowledge
from parser_service.parsers.registry import PARSERS


class Command(BaseCommand):
    help = (
        "Trains and tests parsers on a folder of pair files (gen, para, gen_logical, para_logical, "
        "paraphrasings.txt). A cell that FILE has already is not measured again."
    )
    requires_system_checks: list[str] = []

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("folder", type=Path)
        parser.add_argument("--world", help="whose predicates, ontology and grammar may be known")
        _add_list(parser, "--parsers", list(PARSERS))
        _add_list(parser, "--train-test", SETTINGS)  # --settings, as manage.py passes it on
        _add_list(parser, "--criteria", list(Criterion))
        _add_list(parser, "--protocols", Protocol.values)
        parser.add_argument("--seeds", type=int, default=1, help="seeds 0 to N - 1")
        parser.add_argument(
            "--config",
            nargs="*",
            default=[],
            metavar="PARSER.KEY=VALUE",
            help="hyperparameters that differ from their defaults",
        )
        parser.add_argument("--json", type=Path, required=True, help="the file of cells")

    def handle(self, *args: Any, folder: Path, world: str | None, **options: Any) -> None:
        try:
            failures = self._run(folder, find_world(world) if world else None, options)
        except (ValueError, OSError) as error:
            raise CommandError(str(error)) from error
        if failures:
            raise CommandError("\n".join(dict.fromkeys(failures)))

    def _run(self, folder: Path, world: World | None, options: dict[str, Any]) -> list[str]:
        """Measures what is missing; what could not be measured, and why."""
        todo = list(
            jobs(
                read_names(options["parsers"], list(PARSERS)),
                read_names(options["train_test"], SETTINGS),
                read_names(options["criteria"], list(Criterion)),
                read_names(options["protocols"], Protocol.values),
                options["seeds"],
                read_configurations(options["config"]),
            )
        )
        cells, training = CellFile(options["json"]), Training()
        corpora = cache(lambda criterion: corpus_of(folder, criterion, world))
        failures = []
        for job in (bar := tqdm(todo, disable=None, unit="cell")):
            bar.set_description(f"{job.parser} {job.setting} by {job.criterion}")
            try:
                self._measure(job, corpora(job.criterion), world, cells, training)
            except ValueError as error:
                failures.append(f"{job.parser}, {job.protocol}: {error}")
        return failures

    def _measure(
        self, job: Job, corpus: Corpus, world: World | None, cells: CellFile, training: Training
    ) -> None:
        known = knowledge_hash(world, job.protocol) if world else ""
        key = cell_key(job, corpus, known)
        if not cells.has(key):
            knowledge = knowledge_of(world, job.protocol) if world else Knowledge()
            cells.append({**measure(job, corpus, knowledge, training), "key": key})


def corpus_of(folder: Path, criterion: str, world: World | None) -> Corpus:
    """The pairs of ``folder`` by ``criterion``. Raises ValueError, a sentence."""
    if not folder.is_dir():
        raise ValueError(f"{folder} is no folder.")
    if criterion != Criterion.SOURCE_COMMAND:
        return read_corpus(folder, criterion)
    if world is None:
        raise ValueError("The split by source_command needs the ontology of a --world.")
    return split_by_source_command(folder, anonymizer_of(world))


def read_configurations(assignments: Sequence[str]) -> dict[str, dict[str, Any]]:
    """``PARSER.KEY=VALUE`` texts as hyperparameters by parser. Raises ValueError."""
    texts: dict[str, list[str]] = {}
    for assignment in assignments:
        parser, has_dot, rest = assignment.partition(".")
        if not has_dot or parser not in PARSERS:
            raise ValueError(f"--config {assignment!r} has to be PARSER.KEY=VALUE.")
        texts.setdefault(parser, []).append(rest)
    return {parser: read_hyperparameters(parser, found) for parser, found in texts.items()}


def _add_list(parser: CommandParser, name: str, known: Sequence[str]) -> None:
    parser.add_argument(
        name, default=",".join(known), metavar="A,B", help=f"some of {', '.join(known)}"
    )


def read_names(text: str, known: Sequence[str]) -> list[str]:
    """Names with commas between them. Raises ValueError where one is not ``known``."""
    names = [name.strip() for name in text.split(",")]
    for name in names:
        if name not in known:
            raise ValueError(f"{name!r} is none of {', '.join(known)}.")
    return names
