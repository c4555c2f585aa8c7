"""Read a folder of published pairs (docs/reference/formats.md, Pairs and Triples). Nothing is stored here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum

from annotations.exchange.gathered_files import convert
from annotations.exchange.source_files import FileSource, GatheredFiles, by_place, read_files
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
from annotations.language.grammar import TRIPLE_FILES
from annotations.language.texts import Position, Problem, error_at, warning_at

_TABLES = (".csv", ".tsv")
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
    found: GatheredFiles,
    encoding: str = "",
    notation: str = Notation.OURS,
) -> PairFolder:
    """Read ``gen para gen_logical para_logical`` and the grounded triples, those that are there, in whatever folders.

    The case of letters plays no part in names of files and folders. Nothing is raised; a folder with none of them is a
    problem. With ``Notation.LAMBDA`` it reads ``train``, ``dev`` and ``test`` of another corpus.
    """
    pairs: dict[tuple[str, str, str], tuple[WrittenPair, ...]] = {}
    paths: dict[tuple[str, str, str], str] = {}
    triples: list[GroundedTriple] = []
    problems: list[Problem] = []
    is_foreign = notation == Notation.LAMBDA
    for path in () if is_foreign else filter(_is_table, found.others):
        hint = "import results of a crowd market on the page Campaigns"
        problems.append(warning_at(Position(path), "a table is no pair file; ignored", hint))
    gathered = convert(by_place(found, _places(notation)), encoding)
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
        problems.append(error_at(Position(), "there are no pairs here", f"known are {names}"))
    return PairFolder(pairs, tuple(triples), tuple(sorted(problems)))


def gather_pairs(
    source: FileSource, notation: str = Notation.OURS, most_bytes: int | None = None
) -> GatheredFiles:
    """Return the files that may be of a corpus. Raises LanguageError as ``read_files``."""
    place_of = _places(notation)
    return read_files(source, lambda path: bool(place_of(path)), most_bytes)


def _places(notation: str) -> Callable[[str], str]:
    return _name_alone if notation == Notation.LAMBDA else _place_of_pairs


def _is_table(path: str) -> bool:
    return path.lower().endswith(_TABLES)


def _place_of_pairs(path: str) -> str:
    """Return where a file of a corpus belongs; empty for any other."""
    *_, directory, name = f"//{path}".split("/")
    if name.lower() in TRIPLE_FILES:
        return name
    is_corpus = directory.lower() in CORPUS_FOLDERS and name.lower().endswith(".txt")
    return f"{directory}/{name}" if is_corpus else ""


def _name_alone(path: str) -> str:
    """Return where a file of another corpus belongs, beside the others; empty for any other."""
    name = path.rsplit("/", 1)[-1]
    return name if foreign_part(name) else ""
