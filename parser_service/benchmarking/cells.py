"""Cells of an accuracy table: a parser, trained and tested once under stated conditions."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from hashlib import sha256
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

from annotations.language.corpus import Criterion
from parser_service.analysis.scores import NO_ANSWER, Judgement, judge, score
from parser_service.benchmarking.code_version import code_version
from parser_service.benchmarking.corpus import Corpus
from parser_service.parsers.conditions import TEST_SOURCES, Setting
from parser_service.parsers.interface import Knowledge, Pair, Parser
from parser_service.parsers.registry import config_values, entry, load_class, make_config
from parser_service.runs.evaluating import BEAM_WIDTH

Cell = dict[str, Any]


class Column(NamedTuple):
    """A column of the table. ``setting`` is train sources and test source, as in ``gen+para-mixed``."""

    setting: str
    criterion: str
    protocol: str


@dataclass(frozen=True, slots=True)
class Job:
    """What one cell measures: a parser in a column, with a seed.

    ``split`` is the seed of a new split of the train and validation pairs; None is the published split.
    """

    parser: str
    configuration: tuple[tuple[str, Any], ...]
    setting: str
    criterion: str
    protocol: str
    seed: int
    split: int | None = None

    @property
    def training(self) -> tuple[Any, ...]:
        """Return everything that decides the training; jobs with the same value can share one."""
        trained_on = (
            _train_sources(self.setting),
            self.criterion,
            self.protocol,
            self.seed,
            self.split,
        )
        return self.parser, self.configuration, *trained_on

    @property
    def train_sources(self) -> tuple[str, ...]:
        return Setting.read(self.setting).train_sources.sources

    @property
    def test_sources(self) -> tuple[str, ...]:
        return TEST_SOURCES[Setting.read(self.setting).test_source]

    def refuse(self, why: str) -> str:
        """Return the sentence that replaces the cell; jobs refused for the same reason share it."""
        return f"{self.parser}, {self.protocol}: {why}"


def jobs(
    parsers: Sequence[str],
    columns: Sequence[Column],
    seeds: int,
    configurations: Mapping[str, Mapping[str, Any]] | None = None,
    new_splits: Sequence[int] = (),
) -> Iterator[Job]:
    """Yield all jobs; a parser only has those of the protocols that it supports.

    Jobs of the same ``training`` follow each other. ``configurations`` changes hyperparameters of some
    parsers. ``new_splits`` are the seeds of splits that replace the published one, or the one of seed 0
    by source command, of which none was published. Raises ValueError, a sentence.
    """
    changed = configurations or {}
    configured = {
        name: tuple(config_values(make_config(name, changed.get(name))).items()) for name in parsers
    }
    settings, criteria, protocols = (dict.fromkeys(parts) for parts in zip(*columns, strict=True))
    # Settings last, so that those with the same training follow each other.
    for criterion, name, protocol, seed in product(criteria, configured, protocols, range(seeds)):
        if protocol not in entry(name).protocols:
            continue
        for split, setting in product(
            _splits(criterion, new_splits), sorted(settings, key=_train_sources)
        ):
            if Column(setting, criterion, protocol) in columns:
                yield Job(name, configured[name], setting, criterion, protocol, seed, split)


def _splits(criterion: str, new_splits: Sequence[int]) -> Sequence[int | None]:
    return new_splits or [0 if criterion == Criterion.SOURCE_COMMAND else None]


@dataclass(frozen=True, slots=True)
class Fitted:
    """A trained parser, the seconds it took, and the number of its training pairs."""

    parser: Parser
    seconds: float
    n_train: int


@dataclass(frozen=True)
class Group:
    """Jobs of the same ``training``, the pairs they are measured on and what the parser may know.

    It holds no rows of the database, so any process can measure it.
    """

    jobs: tuple[Job, ...]
    corpus: Corpus
    knowledge: Knowledge
    knowledge_hash: str

    def __str__(self) -> str:
        first = self.jobs[0]
        settings = ", ".join(job.setting for job in self.jobs)
        return f"{first.parser} {settings} by {first.criterion}"

    def key(self, job: Job) -> str:
        """Return the key of the cell of ``job``."""
        return cell_key(job, self.corpus, self.knowledge_hash)

    def measure(self) -> Iterator[Cell | str]:
        """Train once and test each job; yield its cell, or the sentence why there is none."""
        training = cache(lambda: _fit(self.jobs[0], self.corpus, self.knowledge))
        for job in self.jobs:
            try:
                cell = {**measure_cell(job, self.corpus, training), "key": self.key(job)}
            except ValueError as error:
                yield job.refuse(str(error))
            else:
                yield cell


def _train_sources(setting: str) -> str:
    return Setting.read(setting).train_sources


def _fit(job: Job, corpus: Corpus, knowledge: Knowledge) -> Fitted:
    train = corpus.pairs("train", job.train_sources)
    if not train:
        raise ValueError(f"{job.setting} by {job.criterion}: the folder has no pairs to train on.")
    config = make_config(job.parser, dict(job.configuration))
    parser = load_class(job.parser)(config, job.seed, knowledge.limited_to(job.protocol))
    began = time.perf_counter()
    parser.fit(train, corpus.pairs("validation", job.train_sources))
    return Fitted(parser, time.perf_counter() - began, len(train))


def measure_cell(job: Job, corpus: Corpus, training: Callable[[], Fitted]) -> Cell:
    """Test the parser of ``training``. Accuracies are fractions of 1; that of an absent test part is None.

    Well-formedness and speed are those of the test part, or of the validation part where there is
    none. Raises ValueError, a sentence, where there is nothing to train on or to test on.
    """
    asked = {part: corpus.pairs(part, job.test_sources) for part in ("validation", "test")}
    if not asked["validation"]:
        raise ValueError(f"{job.setting} by {job.criterion}: there are no pairs to validate with.")
    fitted = training()
    parser = fitted.parser
    on_validation, validation_ms = _judge_all(parser, asked["validation"])
    validation = corpus.pairs("validation", job.train_sources)
    on_test, test_ms = _judge_all(parser.for_test_part(validation), asked["test"])
    return {
        **asdict(job),
        "configuration": dict(job.configuration),
        "n_train": fitted.n_train,
        "n_test": len(asked["test"]),
        "n_validation": len(asked["validation"]),
        "accuracy_validation": score(on_validation).accuracy,
        "accuracy_test": score(on_test).accuracy if on_test else None,
        "well_formed": score(on_test or on_validation).well_formed,
        "seconds_train": round(fitted.seconds, 3),
        "milliseconds_per_command": round(test_ms if on_test else validation_ms, 3),
        "parameters": parser.parameters(),
        "code_version": code_version(),
    }


def _judge_all(parser: Parser, pairs: Sequence[Pair]) -> tuple[list[Judgement], float]:
    """Compare the first answers with the forms; return the judgements and the milliseconds per answer."""
    if not pairs:
        return [], 0.0
    began = time.perf_counter()
    answers = parser.predict([pair.utterance for pair in pairs], BEAM_WIDTH)
    milliseconds = (time.perf_counter() - began) * 1000 / len(pairs)
    judgements = [
        judge(ranked[0].form, pair.form) if ranked else NO_ANSWER
        for ranked, pair in zip(answers, pairs, strict=True)
    ]
    return judgements, milliseconds


def cell_key(job: Job, corpus: Corpus, knowledge_hash: str) -> str:
    """Return the SHA-256 of everything that decides a cell: conditions, pairs, knowledge and code."""
    used = {*job.train_sources, *job.test_sources}
    pairs = [
        [part, pair.source, pair.utterance, pair.form, pair.task_category]
        for part in ("train", "validation", "test")
        for pair in corpus.pairs(part, sorted(used))
    ]
    conditions = [asdict(job), entry(job.parser).version, knowledge_hash, code_version(), pairs]
    return sha256(json.dumps(conditions, ensure_ascii=False).encode()).hexdigest()


class CellFile:
    """A JSON list of cells. A finished cell is added at once, so a killed benchmark loses none."""

    def __init__(self, path: Path):
        """Read the cells of ``path``. Raises ValueError, a sentence, where it holds something else."""
        self.path = path
        self.cells: list[Cell] = _read_cells(path)

    def has(self, key: str) -> bool:
        return any(cell["key"] == key for cell in self.cells)

    def append(self, cell: Cell) -> None:
        """Add a cell: write a new file beside the old one and rename it."""
        self.cells.append(cell)
        unfinished = self.path.with_name(f".{self.path.name}.{os.getpid()}")
        text = json.dumps(self.cells, ensure_ascii=False, indent=1)
        unfinished.write_text(text + "\n", encoding="utf-8")
        os.replace(unfinished, self.path)


def _read_cells(path: Path) -> list[Cell]:
    if not path.exists():
        return []
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        cells = None
    if not isinstance(cells, list) or any("key" not in cell for cell in cells):
        raise ValueError(f"{path} holds something other than cells; name another file.")
    return cells
