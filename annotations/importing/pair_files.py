"""Read a folder of published pairs (docs/reference/formats.md, Pairs and Triples). Nothing is stored here."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from annotations.importing.gathered_files import GatheredFiles, convert
from annotations.language.corpus import (
    CORPUS_FOLDERS,
    PARTS,
    GroundedTriple,
    RecordFile,
    WrittenPair,
    foreign_part,
    read_foreign_pairs,
    read_pairs,
    read_triples,
)
from annotations.language.decoding import MAX_FILE_BYTES, MAX_FILES, read_folder
from annotations.language.errors import LanguageError, Position, Problem, error_at, warning_at
from annotations.language.grammar import TRIPLE_FILES

_TEXTS = "*.[tT][xX][tT]"
_TABLES = (".csv", ".tsv")
_TRIPLES = f"[pP][aA][rR][aA]{_TEXTS}"
_OF_OTHERS = "paraphrased", "command"  # people ask, and no two parts share a question


class Notation(StrEnum):
    """How the forms of pairs are written: as this project writes them, or as other λ-corpora do."""

    OURS = ""
    LAMBDA = "lambda"


@dataclass(frozen=True)
class PairFolder:
    """``pairs`` are by criterion, source and part, each file's in its order."""

    pairs: Mapping[tuple[str, str, str], tuple[WrittenPair, ...]]
    triples: tuple[GroundedTriple, ...]
    problems: tuple[Problem, ...]

    @property
    def criteria(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(criterion for criterion, _, _ in self.pairs))


def read_pair_folder(
    folder: Path,
    most_bytes: int = MAX_FILE_BYTES,
    encoding: str = "",
    notation: str = Notation.OURS,
) -> PairFolder:
    """Read ``gen para gen_logical para_logical`` and the grounded triples, those that are there.

    The case of letters plays no part in names of files and folders. A file with more than ``most_bytes`` is
    a problem. Nothing is raised; a folder with none of them is a problem too.

    With ``Notation.LAMBDA`` it reads ``train``, ``dev`` and ``test`` of another corpus directly in ``folder``.
    """
    pairs: dict[tuple[str, str, str], tuple[WrittenPair, ...]] = {}
    paths: dict[tuple[str, str, str], str] = {}
    triples: list[GroundedTriple] = []
    problems: list[Problem] = []
    is_foreign = notation == Notation.LAMBDA
    contents = dict(_contents(folder, is_foreign, most_bytes, problems))
    for name in () if is_foreign else _tables(folder):
        hint = "import results of a crowd market on the page Campaigns"
        problems.append(warning_at(Position(name), "a table is no pair file; ignored", hint))
    gathered = convert(GatheredFiles(contents), encoding)
    problems += gathered.problems
    for path, data in gathered.files.items():
        directory, _, name = path.lower().rpartition("/")
        part = foreign_part(name) if is_foreign else PARTS.get(name, "")
        read: Callable[[bytes, str], RecordFile[WrittenPair]]
        read = read_foreign_pairs if is_foreign else read_pairs
        if not (directory or is_foreign):
            records = read_triples(data, path)
            triples += records.records
            problems += records.problems
        elif part:
            source, criterion = _OF_OTHERS if is_foreign else CORPUS_FOLDERS[directory]
            key = criterion, source, part
            if key in paths:
                sentence = f"{paths[key]} holds the {part} part already"
                problems.append(error_at(Position(path), sentence, "keep one of the two files"))
            paths[key] = path
            written = read(data, path)
            pairs[key] = written.records
            problems += written.problems
        else:
            hint = f"known are {', '.join(PARTS)}"
            problems.append(warning_at(Position(path), "not a pair file; ignored", hint))
    if not (pairs or triples or any(problem.is_error for problem in problems)):
        names = ", ".join([*CORPUS_FOLDERS, *sorted(TRIPLE_FILES)])
        problems.append(
            error_at(Position(folder.name), "there are no pairs here", f"known are {names}")
        )
    return PairFolder(pairs, tuple(triples), tuple(sorted(problems)))


def is_table(name: str) -> bool:
    return name.lower().endswith(_TABLES) and not name.startswith(".")


def _tables(folder: Path) -> list[str]:
    """Return the names of tables in ``folder``, which hold no pairs."""
    return sorted(path.name for path in folder.glob("*") if is_table(path.name))[:MAX_FILES]


def _contents(
    folder: Path, is_foreign: bool, most_bytes: int, problems: list[Problem]
) -> Iterator[tuple[str, bytes]]:
    """Yield path inside the folder → bytes, for every file that may be one of a corpus."""
    try:
        if is_foreign:
            yield from read_folder(folder, "[!.]*", most_bytes).items()
            return
        for name, data in read_folder(folder, _TRIPLES, most_bytes).items():
            if name.lower() in TRIPLE_FILES:
                yield name, data
        folders = sorted(path.name for path in folder.iterdir() if path.is_dir())
        for known in CORPUS_FOLDERS:
            for directory in folders:
                if directory.lower() == known:
                    files = read_folder(folder / directory, _TEXTS, most_bytes)
                    for name, data in files.items():
                        yield f"{directory}/{name}", data
    except LanguageError as error:
        problems.append(error.problem)
