"""What a benchmark has still to measure, and measuring it."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence
from dataclasses import replace
from functools import cache
from itertools import groupby
from pathlib import Path

from annotations.language.corpus import Criterion
from annotations.models import World
from parser_service.benchmarking.cells import Cell, CellFile, Group, Job
from parser_service.benchmarking.corpus import Corpus, new_split, read_corpus, source_commands
from parser_service.benchmarking.in_parallel import measure_in_parallel
from parser_service.parsers.interface import Knowledge
from parser_service.runs.content_key import knowledge_hash
from parser_service.runs.knowledge import anonymizer_of, knowledge_of


def find_missing(
    jobs: Sequence[Job], cells: CellFile, folder: Path, world: World | None
) -> tuple[list[Group], list[str]]:
    """Return the jobs that have no cell yet, grouped by training, and for those that cannot be measured
    the sentences why.

    Args:
        jobs: those of one training follow each other.
        cells: the file that has the cells measured so far.
        folder: the pair files.
        world: whose predicates, ontology and grammar may be known, if any.
    """
    groups, failures = [], []
    corpora = cache(lambda criterion, split: load_corpus(folder, criterion, split, world))
    known = cache(lambda protocol: _find_knowledge(world, protocol))
    for _, alike in groupby(jobs, key=lambda job: job.training):
        first, *others = alike
        try:
            group = Group(
                (first, *others), corpora(first.criterion, first.split), *known(first.protocol)
            )
        except ValueError as error:
            failures.append(first.refuse(str(error)))
            continue
        if left := tuple(job for job in group.jobs if not cells.has(group.key(job))):
            groups.append(replace(group, jobs=left))
    return groups, failures


def measure_all(groups: Iterable[Group], at_once: int) -> Generator[Cell | str, None, None]:
    """Yield what ``Group.measure`` yields for all ``groups``: in this process where it is one
    ``at_once``, otherwise in as many others."""
    if at_once > 1:
        return measure_in_parallel(groups, at_once)
    return (answer for group in groups for answer in group.measure())


def load_corpus(folder: Path, criterion: str, split: int | None, world: World | None) -> Corpus:
    """Return the pairs of ``folder`` by ``criterion``: the published split, or a new one of the seed
    ``split``. Raises ValueError, a sentence."""
    if not folder.is_dir():
        raise ValueError(f"{folder} is not a folder.")
    if split is None:
        return read_corpus(folder, criterion)
    if criterion != Criterion.SOURCE_COMMAND:
        return new_split(folder, criterion, split)
    if world is None:
        raise ValueError("The split by source_command needs the ontology of a --world.")
    return new_split(folder, criterion, split, source_commands(folder, anonymizer_of(world)))


def _find_knowledge(world: World | None, protocol: str) -> tuple[Knowledge, str]:
    """Return what a parser may know, and the hash of it."""
    if world is None:
        return Knowledge(), ""
    return knowledge_of(world, protocol), knowledge_hash(world, protocol)
