"""What a benchmark has still to measure, and measuring it."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence
from dataclasses import replace
from functools import cache
from itertools import groupby
from pathlib import Path

from annotations.language.corpus import TRIPLES_FILE, Criterion
from annotations.language.texts import Refusal
from annotations.models import World
from parser_service.benchmarking.benchmark_cells import (
    Cell,
    CellFile,
    TrialGroup,
    agreement_without_world,
)
from parser_service.benchmarking.corpus import Corpus, new_split, read_corpus
from parser_service.benchmarking.in_parallel import measure_in_parallel
from parser_service.benchmarking.paraphrase_sources import Sources, find_sources
from parser_service.benchmarking.trials import Trial
from parser_service.parsers.interface import Knowledge
from parser_service.runs.content_key import knowledge_hash
from parser_service.runs.knowledge import knowledge_of, plan_agreement_of


def find_missing(
    trials: Sequence[Trial], cells: CellFile, folder: Path, world: World | None
) -> tuple[list[TrialGroup], list[str]]:
    """Return the trials that have no cell yet, grouped by training, and for those that cannot be measured
    the sentences why.

    Args:
        trials: those of one training follow each other.
        cells: the file that has the cells measured so far.
        folder: the pair files.
        world: whose predicates, ontology and grammar may be known, if any. Plans are compared by its recipes.
    """
    groups, failures = [], []
    same_plan = plan_agreement_of(world) if world else agreement_without_world()
    sources = cache(lambda: find_sources(folder, world))
    corpora = cache(
        lambda criterion, split: load_corpus(folder, criterion, split, world, sources())
    )
    known = cache(
        lambda protocol: (
            (knowledge_of(world, protocol), knowledge_hash(world, protocol))
            if world
            else (Knowledge(), "")
        )
    )
    for _, alike in groupby(trials, key=lambda trial: trial.training):
        first, *others = alike
        try:
            corpus = corpora(first.criterion, first.split)
            corpus = corpus.with_known(first.seed) if first.by_form else corpus
            group = TrialGroup((first, *others), corpus, *known(first.protocol), same_plan)
        except Refusal as error:
            failures.append(first.refuse(str(error)))
            continue
        if left := tuple(trial for trial in group.trials if not cells.has(group.key(trial))):
            groups.append(replace(group, trials=left))
    return groups, failures


def measure_all(groups: Iterable[TrialGroup], at_once: int) -> Generator[Cell | str, None, None]:
    """Yield what ``TrialGroup.measure`` yields for all ``groups``: in this process where it is one
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
    ``split``. ``sources`` are found unless given. Raises Refusal."""
    if not folder.is_dir():
        raise Refusal(f"{folder} is not a folder.", "not_a_folder")
    if criterion == Criterion.SOURCE_COMMAND and world is None:
        raise Refusal(
            "The split by source_command needs the ontology of a --world.", "ontology_missing"
        )
    known_sources = sources or find_sources(folder, world)
    if split is None:
        return read_corpus(folder, criterion, known_sources.source_of)
    if criterion == Criterion.SOURCE_COMMAND and not known_sources.source_of:
        raise Refusal(
            f"{folder} has no {TRIPLES_FILE}, so no source command is known.", "no_triples"
        )
    return new_split(folder, criterion, split, known_sources.source_of, known_sources.unresolved)
