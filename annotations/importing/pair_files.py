"""Reads a folder of published pairs (FORMATS §5, §6). Nothing is stored here."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from annotations.language.corpus import (
    CORPUS_FOLDERS,
    PART_FILES,
    GroundedTriple,
    WrittenPair,
    read_pairs,
    read_triples,
)
from annotations.language.decoding import MAX_FILE_BYTES, read_folder
from annotations.language.errors import LanguageError, Position, Problem, error_at, warning_at
from annotations.language.grammar import TRIPLE_FILES

PARTS = {file: part for part, file in PART_FILES.items()}


@dataclass(frozen=True)
class PairFolder:
    """``pairs`` are by criterion, source and part, each file's in its order."""

    pairs: Mapping[tuple[str, str, str], tuple[WrittenPair, ...]]
    triples: tuple[GroundedTriple, ...]
    problems: tuple[Problem, ...]

    @property
    def criteria(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(criterion for criterion, _, _ in self.pairs))


def read_pair_folder(folder: Path, most_bytes: int = MAX_FILE_BYTES) -> PairFolder:
    """Read ``gen para gen_logical para_logical`` and the grounded triples, those that are there.

    A file with more than ``most_bytes`` is a problem. Nothing is raised; a folder with none of them is a problem too.
    """
    pairs: dict[tuple[str, str, str], tuple[WrittenPair, ...]] = {}
    triples: list[GroundedTriple] = []
    problems: list[Problem] = []
    for path, data in _contents(folder, most_bytes, problems):
        directory, _, name = path.rpartition("/")
        if not directory:
            records = read_triples(data, path)
            triples += records.records
        elif name in PARTS:
            records = read_pairs(data, path)
            source, criterion = CORPUS_FOLDERS[directory]
            pairs[criterion, source, PARTS[name]] = records.records
        else:
            hint = f"known are {', '.join(PARTS)}"
            problems.append(warning_at(Position(path), "not a pair file; ignored", hint))
            continue
        problems += records.problems
    if not (pairs or triples or problems):
        names = ", ".join([*CORPUS_FOLDERS, *sorted(TRIPLE_FILES)])
        problems.append(
            error_at(Position(folder.name), "there are no pairs here", f"known are {names}")
        )
    return PairFolder(pairs, tuple(triples), tuple(sorted(problems)))


def _contents(
    folder: Path, most_bytes: int, problems: list[Problem]
) -> Iterator[tuple[str, bytes]]:
    """Yield path inside the folder → bytes, for every file that may be one of a corpus."""
    try:
        for name, data in read_folder(folder, "paraphras*.txt", most_bytes).items():
            if name in TRIPLE_FILES:
                yield name, data
        for directory in CORPUS_FOLDERS:
            if (folder / directory).is_dir():
                files = read_folder(folder / directory, "*.txt", most_bytes)
                for name, data in files.items():
                    yield f"{directory}/{name}", data
    except LanguageError as error:
        problems.append(error.problem)
