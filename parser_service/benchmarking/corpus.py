"""A folder of published pairs (FORMATS §5, §6), as parts to train and test on without a database."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from annotations.language.corpus import (
    CORPUS_FOLDERS,
    PART_FILES,
    TRIPLES_FILE,
    Criterion,
    Record,
    RecordFile,
    SplitItem,
    read_pairs,
    read_triples,
    split,
)
from annotations.language.errors import LanguageError
from parser_service.parsers.interface import Pair


@dataclass(frozen=True)
class Corpus:
    """The pairs of a folder under one criterion, by part and source in the order of the files."""

    criterion: str
    parts: Mapping[tuple[str, str], tuple[Pair, ...]]

    def pairs(self, part: str, sources: Iterable[str]) -> list[Pair]:
        """Return the pairs of a part from some sources; none where the folder has none."""
        return [pair for source in sources for pair in self.parts.get((part, source), ())]


def read_corpus(folder: Path, criterion: str) -> Corpus:
    """Read the published split of ``folder`` by ``command`` or ``logical_form``.

    Raises LanguageError at the first fault of a file, ValueError where there is no such split.
    """
    parts = {
        (part, source): tuple(
            Pair(record.utterance, record.canonical_form, source)  # type: ignore[arg-type]
            for record in _read_records(read_pairs, folder / name / file)
        )
        for name, (source, kind) in CORPUS_FOLDERS.items()
        for part, file in PART_FILES.items()
        if kind == criterion and (folder / name / file).is_file()
    }
    if not parts:
        names = ", ".join(name for name, (_, kind) in CORPUS_FOLDERS.items() if kind == criterion)
        raise ValueError(f"{folder} has no split by {criterion}: it holds none of {names}.")
    return Corpus(criterion, parts)


def new_split(
    folder: Path, criterion: str, seed: int, source_of: Mapping[str, str] | None = None
) -> Corpus:
    """Make a new split, 70/10/20 by any criterion, of the train and validation pairs of ``folder``.

    Where ``source_of`` is given (paraphrase → source command, see ``source_commands``), paraphrases
    that it lacks are left out; a generated command is its own source. Raises LanguageError and
    ValueError as ``read_corpus`` does.
    """
    kept_as = Criterion.COMMAND if criterion == Criterion.SOURCE_COMMAND else criterion
    published = read_corpus(folder, kept_as)
    pool = [
        pair
        for (part, _), pairs in published.parts.items()
        for pair in pairs
        if part != "test"
        and (source_of is None or pair.source == "generated" or pair.utterance in source_of)
    ]
    items = [
        SplitItem(pair.source, pair.utterance, _source(pair, source_of or {}), pair.form)
        for pair in pool
    ]
    parts: dict[tuple[str, str], list[Pair]] = defaultdict(list)
    for pair, part in zip(pool, split(items, Criterion(criterion), seed=seed), strict=True):
        parts[part, pair.source].append(pair)
    return Corpus(criterion, {key: tuple(pairs) for key, pairs in parts.items()})


def _source(pair: Pair, source_of: Mapping[str, str]) -> str:
    """Return the source command; an empty one means the utterance itself."""
    return "" if pair.source == "generated" else source_of.get(pair.utterance, "")


def source_commands(folder: Path, anonymize: Callable[[str], str]) -> dict[str, str]:
    """Map each paraphrase of ``paraphrasings.txt`` to the command that it rewrites, anonymized.

    Raises ValueError where the folder has no such file, LanguageError at its first fault.
    """
    path = folder / TRIPLES_FILE
    if not path.is_file():
        raise ValueError(f"{folder} has no {TRIPLES_FILE}, so no source command is known.")
    records = _read_records(read_triples, path)
    return {record.paraphrase: anonymize(record.command) for record in records}


def _read_records(
    read: Callable[[bytes, str], RecordFile[Record]], path: Path
) -> tuple[Record, ...]:
    """Read the records of a file. Raises LanguageError with the first of its problems."""
    file = read(path.read_bytes(), str(path))
    for problem in file.problems:
        raise LanguageError(problem.message, problem.position, problem.hint)
    return file.records
