"""A folder of published pairs (docs/reference/formats.md, Pairs), as parts to train and test on without a database."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Callable, Container, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from hashlib import sha256
from pathlib import Path

from annotations.language.corpus import (
    CORPUS_FOLDERS,
    KNOWN,
    PART_FILES,
    TRIPLES_FILE,
    Criterion,
    Part,
    Record,
    RecordFile,
    SplitItem,
    hold_out_known,
    read_pairs,
    read_triples,
    split,
)
from annotations.language.texts import LanguageError, Refusal
from parser_service.parsers.interface import Pair

Parts = Mapping[tuple[str, str], tuple[Pair, ...]]


@dataclass(frozen=True)
class Corpus:
    """The pairs of a folder under one criterion, by part and source in the order of the files.

    ``source_of`` is paraphrase → the generated command behind it, where that is known.
    """

    criterion: str
    parts: Parts
    source_of: Mapping[str, str] = field(default_factory=dict)

    def pairs(self, part: str, sources: Iterable[str]) -> list[Pair]:
        """Return the pairs of a part from some sources; none where the folder has none."""
        return [pair for source in sources for pair in self.parts.get((part, source), ())]

    def cluster(self, pair: Pair) -> str:
        """Return what pairs share that are right or wrong together: the form where the split is by form, else
        the source command."""
        by_form = self.criterion == Criterion.LOGICAL_FORM
        return self.item(pair).key(Criterion.LOGICAL_FORM if by_form else Criterion.SOURCE_COMMAND)

    def item(self, pair: Pair) -> SplitItem:
        return _item(pair, self.source_of)

    @cached_property
    def content_hash(self) -> str:
        """The SHA-256 of all pairs, by part and source."""
        rows = [
            [part, source, pair.utterance, pair.form]
            for (part, source), pairs in sorted(self.parts.items())
            for pair in pairs
        ]
        return sha256(json.dumps(rows, ensure_ascii=False).encode()).hexdigest()

    def with_known(self, seed: int) -> Corpus:
        """Return the corpus with a part ``known``, held out of the training part: pairs of forms that stay in
        training, by whole source commands. Equal pairs and seeds give equal parts."""
        train = [
            pair for (part, _), pairs in self.parts.items() if part == "train" for pair in pairs
        ]
        held_out = hold_out_known(
            [self.item(pair) for pair in train], f"{self.content_hash}:{seed}"
        )
        parts: dict[tuple[str, str], list[Pair]] = defaultdict(list)
        for pair, is_held_out in zip(train, held_out, strict=True):
            parts[KNOWN if is_held_out else "train", pair.source].append(pair)
        others = {key: pairs for key, pairs in self.parts.items() if key[0] != "train"}
        new = {key: tuple(pairs) for key, pairs in parts.items()}
        return replace(self, parts={**others, **new})


def read_corpus(folder: Path, criterion: str, source_of: Mapping[str, str] | None = None) -> Corpus:
    """Read the published split of ``folder`` by ``command`` or ``logical_form``.

    Raises LanguageError at the first fault of a file, Refusal where there is no such split.
    """
    parts = {
        (part, source): tuple(
            Pair(record.utterance, record.canonical_form, source)
            for record in _read_records(read_pairs, folder / name / file)
        )
        for name, (source, kind) in CORPUS_FOLDERS.items()
        for part, file in PART_FILES.items()
        if kind == criterion and (folder / name / file).is_file()
    }
    if not parts:
        names = ", ".join(name for name, (_, kind) in CORPUS_FOLDERS.items() if kind == criterion)
        raise Refusal(
            f"{folder} has no split by {criterion}: it holds none of {names}.", "no_such_split"
        )
    return Corpus(criterion, parts, source_of or {})


def new_split(
    folder: Path,
    criterion: str,
    seed: int,
    source_of: Mapping[str, str] | None = None,
    unresolved: Container[str] = frozenset(),
) -> Corpus:
    """Make a new split, 70/10/20 by any criterion, of the train and validation pairs of ``folder``.

    Args:
        source_of: paraphrase → source command (``source_commands``). By source command, paraphrases
            that it lacks are left out; a generated command is its own source.
        unresolved: paraphrases whose source command is no generated one. By source command they go to
            the training part, since nobody can tell what else they share.

    Raises LanguageError and Refusal as ``read_corpus`` does.
    """
    by_source = criterion == Criterion.SOURCE_COMMAND
    published = read_corpus(folder, Criterion.COMMAND if by_source else criterion)
    known = source_of or {}
    pool = [
        pair
        for (part, _), pairs in published.parts.items()
        for pair in pairs
        if part != "test"
        and not (
            by_source
            and source_of is not None
            and pair.source != "generated"
            and pair.utterance not in source_of
        )
    ]
    items = [_item(pair, known) for pair in pool]
    kept = {
        item.key(Criterion.SOURCE_COMMAND): Part.TRAIN
        for item in items
        if by_source and item.source != "generated" and item.utterance in unresolved
    }
    parts: dict[tuple[str, str], list[Pair]] = defaultdict(list)
    dealt = split(items, Criterion(criterion), seed=seed, kept=kept)
    for pair, part in zip(pool, dealt, strict=True):
        parts[part, pair.source].append(pair)
    return Corpus(criterion, {key: tuple(pairs) for key, pairs in parts.items()}, known)


def _item(pair: Pair, source_of: Mapping[str, str]) -> SplitItem:
    """Return what decides the part of a pair; an empty source command means the utterance itself."""
    command = "" if pair.source == "generated" else source_of.get(pair.utterance, "")
    return SplitItem(pair.source, pair.utterance, command, pair.form)


def source_commands(folder: Path, text_behind: Callable[[str], str]) -> dict[str, str]:
    """Map each paraphrase of ``paraphrasings.txt`` to the command that it rewrites, which ``text_behind``
    returns for its prompt (``SourceFinder.text``).

    Raises Refusal where the folder has no such file, LanguageError at its first fault.
    """
    path = folder / TRIPLES_FILE
    if not path.is_file():
        raise Refusal(
            f"{folder} has no {TRIPLES_FILE}, so no source command is known.", "no_triples"
        )
    records = _read_records(read_triples, path)
    return {record.paraphrase: text_behind(record.command) for record in records}


def _read_records(
    read: Callable[[bytes, str], RecordFile[Record]], path: Path
) -> tuple[Record, ...]:
    """Read the records of a file. Raises LanguageError with the first of its problems."""
    file = read(path.read_bytes(), str(path))
    for problem in file.problems:
        raise LanguageError(problem.message, problem.position, problem.hint)
    return file.records
