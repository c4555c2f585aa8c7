"""``benchmark DIR --parsers a,b --json FILE``: the accuracy table over a folder of pairs."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from functools import cache
from itertools import groupby, product
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser
from tqdm import tqdm

from annotations.language.splitting import Criterion
from annotations.management.base import find_world
from annotations.models import World
from parser_service.benchmarking import SETTINGS, Cell, CellFile, Column, Group, Job, jobs
from parser_service.benchmarking_in_parallel import measured_in_parallel
from parser_service.content_key import knowledge_hash
from parser_service.corpus import Corpus, new_split, read_corpus, source_commands
from parser_service.knowledge import anonymizer_of, knowledge_of
from parser_service.management.options import (
    read_column,
    read_configurations,
    read_names,
    read_split_seeds,
)
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
        for name, known in (
            ("--parsers", PARSERS),
            ("--train-test", SETTINGS),  # --settings, as manage.py passes it on
            ("--criteria", list(Criterion)),
            ("--protocols", Protocol.values),
        ):
            names = ", ".join(known)
            parser.add_argument(name, metavar="A,B", help=f"some of {names} (default: all)")
        parser.add_argument(
            "--columns",
            metavar="A,B",
            help="instead of --settings, --criteria and --protocols: some of their combinations, each "
            "SETTING:CRITERION:PROTOCOL",
        )
        parser.add_argument("--seeds", type=int, default=1, help="seeds 0 to N - 1")
        parser.add_argument(
            "--new-splits",
            default="0",
            metavar="N|A-B",
            help="split the train and validation pairs anew, 70/10/20, N times, or with the seeds A to B "
            "(default: the published split, and one new by source command)",
        )
        parser.add_argument(
            "--config",
            nargs="*",
            default=[],
            metavar="PARSER.KEY=VALUE",
            help="hyperparameters that differ from their defaults",
        )
        parser.add_argument(
            "--jobs", type=int, default=1, metavar="N", help="trainings at a time (default: 1)"
        )
        parser.add_argument("--json", type=Path, required=True, help="the file of cells")

    def handle(self, *args: Any, folder: Path, world: str | None, **options: Any) -> None:
        try:
            failures = self._run(folder, find_world(world) if world else None, options)
        except (ValueError, OSError) as error:
            raise CommandError(str(error)) from error
        except KeyboardInterrupt:
            raise CommandError(
                f"Stopped. {options['json']} keeps the cells that were finished; the same command "
                "measures the others."
            ) from None
        if failures:
            raise CommandError("\n".join(dict.fromkeys(failures)))

    def _run(self, folder: Path, world: World | None, options: dict[str, Any]) -> list[str]:
        """Measures what is missing; what could not be measured, and why."""
        at_once = options["jobs"]
        for name in ("jobs", "seeds"):
            if (given := options[name]) < 1:
                raise ValueError(f"--{name} is {given}; it has to be 1 or more.")
        todo = list(
            jobs(
                read_names(options["parsers"], list(PARSERS)),
                _columns(**options),
                options["seeds"],
                read_configurations(options["config"]),
                read_split_seeds(options["new_splits"]),
            )
        )
        cells = CellFile(options["json"])
        groups, failures = missing(todo, cells, folder, world)
        done = len(todo) - sum(len(group.jobs) for group in groups)
        with (
            tqdm(total=len(todo), initial=done, disable=None, unit="cell") as bar,
            closing(measured(_announced(groups, bar), at_once)) as answers,
        ):
            for answer in answers:
                if isinstance(answer, str):
                    failures.append(answer)
                else:
                    cells.append(answer)
                bar.update()
        return failures


def _columns(
    columns: str | None,
    train_test: str | None,
    criteria: str | None,
    protocols: str | None,
    **others: Any,
) -> list[Column]:
    """The columns that the options name. Raises ValueError, a sentence."""
    if columns is None:
        named = product(
            read_names(train_test, SETTINGS),
            read_names(criteria, list(Criterion)),
            read_names(protocols, Protocol.values),
        )
        return [Column(*parts) for parts in named]
    if train_test or criteria or protocols:
        raise ValueError(
            "--columns says all that --settings, --criteria and --protocols say; leave either away."
        )
    return [read_column(text) for text in columns.split(",")]


def _announced(groups: Iterable[Group], bar: tqdm) -> Iterator[Group]:
    """The groups; the bar names each when its turn comes."""
    for group in groups:
        bar.set_description(str(group))
        yield group


def measured(groups: Iterable[Group], at_once: int) -> Generator[Cell | str, None, None]:
    """What ``Group.measured`` gives for all ``groups``, here where it is one ``at_once``."""
    if at_once > 1:
        return measured_in_parallel(groups, at_once)
    return (answer for group in groups for answer in group.measured())


def missing(
    todo: Sequence[Job], cells: CellFile, folder: Path, world: World | None
) -> tuple[list[Group], list[str]]:
    """What ``cells`` has not, and for jobs that cannot be measured the sentences why."""
    groups, failures = [], []
    corpora = cache(lambda criterion, split: corpus_of(folder, criterion, split, world))
    known = cache(lambda protocol: _known(world, protocol))
    for _, alike in groupby(todo, key=lambda job: job.training):
        first, *others = alike
        try:
            group = Group(
                (first, *others), corpora(first.criterion, first.split), *known(first.protocol)
            )
        except ValueError as error:
            failures.append(first.refused(str(error)))
            continue
        if left := tuple(job for job in group.jobs if not cells.has(group.key(job))):
            groups.append(replace(group, jobs=left))
    return groups, failures


def _known(world: World | None, protocol: str) -> tuple[Knowledge, str]:
    """What a parser may know, and the hash of it."""
    if world is None:
        return Knowledge(), ""
    return knowledge_of(world, protocol), knowledge_hash(world, protocol)


def corpus_of(folder: Path, criterion: str, split: int | None, world: World | None) -> Corpus:
    """The pairs of ``folder`` by ``criterion``, as published or split anew.

    Raises ValueError, a sentence.
    """
    if not folder.is_dir():
        raise ValueError(f"{folder} is no folder.")
    if split is None:
        return read_corpus(folder, criterion)
    if criterion != Criterion.SOURCE_COMMAND:
        return new_split(folder, criterion, split)
    if world is None:
        raise ValueError("The split by source_command needs the ontology of a --world.")
    return new_split(folder, criterion, split, source_commands(folder, anonymizer_of(world)))
