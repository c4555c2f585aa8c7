"""Import published pairs into a world: frozen splits as they are, and paraphrases."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from operator import attrgetter

from django.db.models import Max

from annotations.background.progress import UNWATCHED, Progress
from annotations.exchange.import_reports import PairsReport
from annotations.exchange.pair_files import Notation, PairFolder, gather_pairs, read_pair_folder
from annotations.exchange.prompt_sources import PromptSource, SourceFinder
from annotations.exchange.source_files import FileSource, GatheredFiles
from annotations.exchange.target_world import lock_world, require_world_name
from annotations.generation.freezing import PreparedSplit
from annotations.language.corpus import GroundedTriple, Part, WrittenPair, distance
from annotations.language.texts import LanguageError
from annotations.models import Example, Paraphrase, User, World
from annotations.models.splits import Source
from annotations.rows.decisions import respect
from annotations.rows.stored_problems import first_problems
from annotations.rows.synchronise import RowPlan

MOST_ATTEMPTS = 3


def import_pairs(
    world_name: str,
    name: str,
    source: FileSource | GatheredFiles,
    by: User | None = None,
    progress: Progress = UNWATCHED,
    brings_back: bool = False,
    most_bytes: int | None = None,
    encoding: str = "",
    notation: str = Notation.OURS,
) -> PairsReport:
    """Take the splits and paraphrases of a corpus into a world, all of them or nothing.

    Args:
        world_name: made where there is none.
        name: of the splits: ``name-command`` and ``name-logical_form``.
        source: what ``read_files`` takes, or what ``gather_pairs`` has made of it, with any of ``gen para gen_logical
            para_logical`` and ``paraphrasings.txt``.
        most_bytes: of all files. What is uploaded packs well, so the default is small.
        encoding: of the files that are not UTF-8 (``decoding.ENCODINGS``); without one, they are errors.
        notation: of the forms. Of another corpus, what cannot be read is left out and counted by reason.

    A split that is there already with the same pairs is left alone; one with other pairs is an
    error, since a frozen split never changes. A paraphrase that is there already is not doubled, and one
    that people have deleted stays away unless ``brings_back``.
    """
    progress.report(0, "reading the pairs")
    try:
        if not isinstance(source, GatheredFiles):
            source = gather_pairs(source, notation, most_bytes)
        files = read_pair_folder(source, encoding, notation)
    except LanguageError as error:
        return PairsReport(world_name, problems=(error.problem,))
    counts: dict[str, dict[str, dict[str, int]]] = {}
    for (criterion, source, part), pairs in files.pairs.items():
        counts.setdefault(criterion, {}).setdefault(source, {})[part] = len(pairs)
    report = PairsReport(
        world_name,
        counts=counts,
        splits={criterion: f"{name}-{criterion}" for criterion in files.criteria},
        paraphrases=len(files.triples),
        problems=first_problems(files.problems),
    )
    try:
        require_world_name(world_name)
        if report.is_refused:
            return report
        for _ in range(MOST_ATTEMPTS):
            stored = _store(report, name, files, by, progress, brings_back)
            if stored is not None:
                return stored
        raise LanguageError("the commands were generated anew meanwhile", hint="import once more")
    except LanguageError as error:
        return replace(report, problems=(*report.problems, error.problem))


def _store(
    report: PairsReport,
    name: str,
    files: PairFolder,
    by: User | None,
    progress: Progress,
    brings_back: bool,
) -> PairsReport | None:
    """Prepare everything, then write it. Return None where commands were generated in between."""
    world = World.objects.filter(name=report.world).first()
    finder = SourceFinder(world)
    progress.report(0.3, "finding the source of each paraphrase")
    sources, forms = [], []
    for triple in files.triples:
        progress.check()
        sources.append(finder.source(triple.command, triple.form))
        forms.append(triple.canonical_form)
    progress.report(0.5, "preparing the splits")
    with ExitStack() as stack:
        splits = [
            stack.enter_context(split)
            for split in _prepare_splits(name, files, sources, finder, progress)
        ]
        progress.report(0.9, "writing")
        with progress.writing():
            locked = lock_world(report.world, by)
            if world is not None and locked.generations != world.generations:
                return None
            if (
                not locked.entity_classes.exists()
            ):  # begun by hand; published pairs are of a household
                locked.entity_classes.add_of_household(locked)
            paraphrases = plan_paraphrases(locked, files.triples, forms, sources, brings_back)
            added = paraphrases.apply(by).added
            for split in splits:
                _, is_new = split.store(locked, by)
                added += is_new * (1 + len(split.examples))
            left_out = tuple(f"{row} ({why})" for row, why in paraphrases.left_out)
            stored = replace(report, added=added, left_out=left_out)
            progress.conclude(stored.as_json())
    return stored


def _prepare_splits(
    name: str,
    files: PairFolder,
    sources: Sequence[PromptSource],
    finder: SourceFinder,
    progress: Progress,
) -> Iterator[PreparedSplit]:
    behind: dict[str, list[tuple[GroundedTriple, PromptSource]]] = defaultdict(list)
    for triple, origin in zip(files.triples, sources, strict=True):
        behind[triple.paraphrase].append((triple, origin))
    canonical: dict[str, str] = {}  # form as it is written → canonical text
    for criterion in files.criteria:
        examples = []
        for (of, source, part), pairs in files.pairs.items():
            if of == criterion:
                for position, pair in enumerate(pairs):
                    progress.check()
                    if (form := canonical.get(pair.written_form)) is None:
                        form = canonical[pair.written_form] = pair.canonical_form
                    examples.append(_example(pair, form, position, part, source, behind, finder))
        tests_on_models = any(
            each.source == Source.MODEL and each.part != Part.TRAIN for each in examples
        )
        yield PreparedSplit(
            f"{name}-{criterion}", criterion, examples, tests_on_models=tests_on_models
        )


# Utterance → the records that it stands in.
Behind = Mapping[str, Sequence[tuple[GroundedTriple, PromptSource]]]


def _example(
    pair: WrittenPair,
    form: str,
    position: int,
    part: str,
    source: str,
    behind: Behind,
    finder: SourceFinder,
) -> Example:
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


def plan_paraphrases(
    world: World,
    triples: Sequence[GroundedTriple],
    forms: Sequence[str],
    sources: Sequence[PromptSource],
    brings_back: bool,
) -> RowPlan[Paraphrase]:
    """Plan to add the records that are not there, each once, behind those that are. ``forms`` are their canonical
    texts."""
    known = set(world.paraphrases.values_list("prompt", "utterance", "grounded_form"))
    last = world.paraphrases.aggregate(last=Max("position"))["last"]
    following = 0 if last is None else last + 1
    new: list[Paraphrase] = []
    for triple, form, source in zip(triples, forms, sources, strict=True):
        key = (triple.command, triple.paraphrase, form)
        if key not in known:
            known.add(key)
            apart = distance(triple.paraphrase, triple.command)
            new.append(
                Paraphrase(
                    world=world,
                    command=source.command,
                    prompt=triple.command,
                    utterance=triple.paraphrase,
                    grounded_form=form,
                    logical_form=source.logical_form,
                    edit_distance=apart.edit,
                    jaccard_distance=apart.jaccard,
                    position=following + len(new),
                )
            )
    key_of = attrgetter("prompt", "utterance", "grounded_form")
    return respect(RowPlan(Paraphrase, (), new, [], [], []), world, key_of, brings_back)
