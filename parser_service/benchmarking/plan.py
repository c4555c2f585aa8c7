"""What a benchmark has still to measure, and measuring it."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence
from dataclasses import replace
from functools import cache
from itertools import groupby
from pathlib import Path

from annotations.language.corpus import TRIPLES_FILE, Criterion
from annotations.models import World
from parser_service.benchmarking.cells import Cell, CellFile, Group, Job
from parser_service.benchmarking.corpus import Corpus, new_split, read_corpus
from parser_service.benchmarking.in_parallel import measure_in_parallel
from parser_service.benchmarking.sources import Sources, find_sources
from parser_service.parsers.interface import Knowledge
from parser_service.runs.carrying_out.knowledge import knowledge_of
from parser_service.runs.requests.content_key import knowledge_hash


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
    sources = cache(lambda: find_sources(folder, world))
    corpora = cache(
        lambda criterion, split: load_corpus(folder, criterion, split, world, sources())
    )
    known = cache(lambda protocol: _find_knowledge(world, protocol))
    for _, alike in groupby(jobs, key=lambda job: job.training):
        first, *others = alike
        try:
            corpus = corpora(first.criterion, first.split)
            corpus = corpus.with_known(first.seed) if first.by_form else corpus
            group = Group((first, *others), corpus, *known(first.protocol))
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


def load_corpus(
    folder: Path,
    criterion: str,
    split: int | None,
    world: World | None,
    sources: Sources | None = None,
) -> Corpus:
    """Return the pairs of ``folder`` by ``criterion``: the published split, or a new one of the seed
    ``split``. ``sources`` are found unless given. Raises ValueError, a sentence."""
    if not folder.is_dir():
        raise ValueError(f"{folder} is not a folder.")
    if criterion == Criterion.SOURCE_COMMAND and world is None:
        raise ValueError("The split by source_command needs the ontology of a --world.")
    found = sources or find_sources(folder, world)
    if split is None:
        return read_corpus(folder, criterion, found.source_of)
    if criterion == Criterion.SOURCE_COMMAND and not found.source_of:
        raise ValueError(f"{folder} has no {TRIPLES_FILE}, so no source command is known.")
    return new_split(folder, criterion, split, found.source_of, found.unresolved)


def _find_knowledge(world: World | None, protocol: str) -> tuple[Knowledge, str]:
    """Return what a parser may know, and the hash of it."""
    if world is None:
        return Knowledge(), ""
    return knowledge_of(world, protocol), knowledge_hash(world, protocol)
