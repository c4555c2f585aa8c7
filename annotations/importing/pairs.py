"""Imports published pairs into a world: frozen splits as they are, and paraphrases."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from django.db import transaction
from django.db.models import Max

from annotations.freezing import store_split
from annotations.importing.pair_files import PairFolder, read_pair_folder
from annotations.importing.worlds import locked_world, require_world_name
from annotations.language.distances import distance
from annotations.language.errors import LanguageError, Problem
from annotations.language.pairs import GroundedTriple, WrittenPair
from annotations.models import Example, Paraphrase, User, World
from annotations.problems import as_json
from annotations.prompts import Source, SourceFinder
from annotations.rows import BATCH


@dataclass(frozen=True, slots=True)
class PairsReport:
    """``counts`` are pairs by criterion, source and part; ``splits`` their names by criterion.

    With an error among the ``problems`` nothing was stored.
    """

    world: str
    counts: Mapping[str, Mapping[str, Mapping[str, int]]] = field(default_factory=dict)
    splits: Mapping[str, str] = field(default_factory=dict)
    paraphrases: int = 0
    added: int = 0
    problems: tuple[Problem, ...] = ()

    @property
    def errors(self) -> tuple[Problem, ...]:
        return tuple(problem for problem in self.problems if problem.is_error)

    @property
    def is_refused(self) -> bool:
        return bool(self.errors)

    def as_json(self) -> dict[str, Any]:
        return {
            "world": self.world,
            "counts": self.counts,
            "splits": self.splits,
            "paraphrases": self.paraphrases,
            "problems": [as_json(problem) for problem in self.problems],
            "changes": {"added": self.added},
        }


def import_pairs(
    world_name: str, name: str, folder: Path | str, by: User | None = None
) -> PairsReport:
    """Takes the splits and paraphrases of ``folder`` into a world, all of them or nothing.

    Args:
        world_name: made where there is none.
        name: of the splits: ``name-command`` and ``name-logical_form``.
        folder: with any of ``gen para gen_logical para_logical`` and ``paraphrasings.txt``.

    A split that is there already with the same pairs is left alone; one with other pairs is an
    error, since a frozen split never changes. A paraphrase that is there already is not doubled.
    """
    files = read_pair_folder(Path(folder))
    report = _report(world_name, name, files)
    try:
        require_world_name(world_name)
        if report.is_refused:
            return report
        with transaction.atomic():
            return replace(report, added=_store(locked_world(world_name, by), name, files, by))
    except LanguageError as trouble:
        return replace(report, problems=(*report.problems, trouble.problem))


def _report(world_name: str, name: str, files: PairFolder) -> PairsReport:
    counts: dict[str, dict[str, dict[str, int]]] = {}
    for (criterion, source, part), pairs in files.pairs.items():
        counts.setdefault(criterion, {}).setdefault(source, {})[part] = len(pairs)
    return PairsReport(
        world_name,
        counts=counts,
        splits={criterion: f"{name}-{criterion}" for criterion in files.criteria},
        paraphrases=len(files.triples),
        problems=files.problems,
    )


def _store(world: World, name: str, files: PairFolder, by: User | None) -> int:
    """How many rows were added."""
    finder = SourceFinder(world)
    sources = [finder.source(triple.command, triple.form) for triple in files.triples]
    added = _store_paraphrases(world, files.triples, sources)
    behind = _by_utterance(files.triples, sources)
    for criterion in files.criteria:
        examples = [
            _example(pair, position, part, source, behind, finder)
            for (of, source, part), pairs in files.pairs.items()
            for position, pair in enumerate(pairs)
            if of == criterion
        ]
        _, is_new = store_split(world, f"{name}-{criterion}", criterion, examples, by=by)
        added += is_new * (1 + len(examples))
    return added


Behind = Mapping[str, Sequence[tuple[GroundedTriple, Source]]]


def _by_utterance(triples: Sequence[GroundedTriple], sources: Sequence[Source]) -> Behind:
    """Utterance → the records it stands in."""
    found: dict[str, list[tuple[GroundedTriple, Source]]] = defaultdict(list)
    for triple, source in zip(triples, sources, strict=True):
        found[triple.paraphrase].append((triple, source))
    return found


def _example(
    pair: WrittenPair, position: int, part: str, source: str, behind: Behind, finder: SourceFinder
) -> Example:
    form = pair.canonical_form
    example = Example(
        position=position,
        part=part,
        source=source,
        utterance=pair.utterance,
        logical_form=form,
        written_form="" if pair.written_form == form else pair.written_form,
    )
    if source == "generated":
        command = finder.command(pair.utterance)
        example.source_command = pair.utterance
        example.task_category = command.task_category if command else ""
    elif records := behind.get(pair.utterance):
        fitting = (record for record in records if record[1].logical_form == form)
        triple, origin = next(fitting, records[0])
        example.source_command = origin.anonymized_text
        example.task_category = origin.task_category
        example.grounded_form = triple.canonical_form
    return example


def _store_paraphrases(
    world: World, triples: Sequence[GroundedTriple], sources: Sequence[Source]
) -> int:
    """Adds the records that are not there, behind those that are; says how many."""
    known = set(world.paraphrases.values_list("prompt", "utterance", "grounded_form"))
    last = world.paraphrases.aggregate(last=Max("position"))["last"]
    following = 0 if last is None else last + 1
    new: list[Paraphrase] = []
    for triple, source in zip(triples, sources, strict=True):
        key = (triple.command, triple.paraphrase, triple.canonical_form)
        if key not in known:
            known.add(key)
            new.append(_paraphrase(world, triple, source, following + len(new)))
    Paraphrase.objects.bulk_create(new, batch_size=BATCH)
    return len(new)


def _paraphrase(world: World, triple: GroundedTriple, source: Source, position: int) -> Paraphrase:
    apart = distance(triple.paraphrase, triple.command)
    return Paraphrase(
        world=world,
        command=source.command,
        prompt=triple.command,
        utterance=triple.paraphrase,
        grounded_form=triple.canonical_form,
        logical_form=source.logical_form,
        edit_distance=apart.edit,
        jaccard_distance=apart.jaccard,
        position=position,
    )
