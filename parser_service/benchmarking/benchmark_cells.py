"""Cells of an accuracy table: a parser, trained and tested once under stated conditions."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path
from typing import Any

from django.conf import settings

from annotations.language.corpus import KNOWN, harmonic_mean
from annotations.language.forms import read_form
from annotations.language.plans import default_book
from annotations.language.texts import Refusal
from annotations.language.world import Ontology, infer_signatures
from parser_service.analysis.plan_agreement import PlanAgreement
from parser_service.analysis.scores import score
from parser_service.benchmarking.corpus import Corpus
from parser_service.benchmarking.measured_answers import (
    PartAnswers,
    ask,
    ask_cross_fitted,
    intervals,
)
from parser_service.benchmarking.trials import Declared, Trial
from parser_service.parsers.interface import Knowledge, Pair, Parser
from parser_service.parsers.registry import entry, load_class, make_config

Cell = dict[str, Any]
# Where the code is that decides figures.
DECIDING = ("annotations/language", "parser_service/parsers", "parser_service/neural")


@dataclass(frozen=True, slots=True)
class Fitted:
    """A trained parser, the seconds it took, and the number of its training pairs."""

    parser: Parser
    seconds: float
    n_train: int


def agreement_without_world() -> PlanAgreement:
    """Return what compares plans by the shipped recipes alone."""
    return PlanAgreement(Ontology(()), {}, default_book())


@dataclass(frozen=True)
class TrialGroup:
    """Trials of the same ``training``, the pairs they are measured on, what the parser may know, and what compares
    the plans of its answers.

    It holds no rows of the database, so any process can measure it.
    """

    trials: tuple[Trial, ...]
    corpus: Corpus
    knowledge: Knowledge
    knowledge_hash: str
    same_plan: PlanAgreement = field(default_factory=agreement_without_world)

    def __str__(self) -> str:
        first = self.trials[0]
        settings = ", ".join(trial.setting for trial in self.trials)
        return f"{first.parser} {settings} by {first.criterion}"

    def key(self, trial: Trial) -> str:
        """Return the key of the cell of ``trial``."""
        book = self.same_plan.book
        recipes = [str(row) for row in (*book.primitives, *book.recipes)]
        return cell_key(trial, self.corpus, self.knowledge_hash, recipes)

    def measure(self) -> Iterator[Cell | str]:
        """Train once and test each trial; yield its cell, or the sentence why there is none."""
        training = cache(lambda: _fit(self.trials[0], self.corpus, self.knowledge))
        for trial in self.trials:
            try:
                measured = measure_cell(trial, self.corpus, training, self.same_plan)
                cell = {**measured, "key": self.key(trial)}
            except Refusal as error:
                yield trial.refuse(str(error))
            else:
                yield cell


def _fit(trial: Trial, corpus: Corpus, knowledge: Knowledge) -> Fitted:
    train = corpus.pairs("train", trial.train_sources)
    if not train:
        raise Refusal(
            f"{trial.setting} by {trial.criterion}: the folder has no pairs to train on.",
            "no_training_pairs",
        )
    config = make_config(trial.parser, dict(trial.configuration))
    allowed = knowledge.limited_to(trial.protocol)
    if trial.declared == Declared.TRAINING:
        allowed = declared_by(train, allowed)
    parser = load_class(trial.parser)(config, trial.seed, allowed)
    began = time.perf_counter()
    parser.fit(train, corpus.pairs("validation", trial.train_sources))
    return Fitted(parser, time.perf_counter() - began, len(train))


def declared_by(train: Sequence[Pair], knowledge: Knowledge) -> Knowledge:
    """Return ``knowledge`` with only the predicates, and only the signatures of them, that the forms of training
    pairs have. They keep their glosses."""
    seen = infer_signatures(read_form(form) for form in {pair.form for pair in train})
    declared = knowledge.predicates or {}
    kept = {
        name: replace(declared[name], signatures=each.signatures) if name in declared else each
        for name, each in seen.items()
    }
    return replace(knowledge, predicates=kept)


def measure_cell(
    trial: Trial, corpus: Corpus, training: Callable[[], Fitted], same_plan: PlanAgreement
) -> Cell:
    """Test the parser of ``training``. Accuracies are fractions of 1; that of an absent part is None.

    The validation part is cross-fitted: what answers a pair was not calibrated on its cluster. Of the
    part ``known`` (by form) only pairs count whose form is in training. Well-formedness and speed are
    those of the test part, or of the validation part where there is none. Raises Refusal
    where there is nothing to train on or to test on.
    """
    trial.require_unseen()
    parts = ("validation", KNOWN, "test") if trial.by_form else ("validation", "test")
    asked = {part: corpus.pairs(part, trial.test_sources) for part in parts}
    if not asked["validation"]:
        raise Refusal(
            f"{trial.setting} by {trial.criterion}: there are no pairs to validate with.",
            "no_test_pairs",
        )
    trained = {pair.form for pair in corpus.pairs("train", trial.train_sources)}
    if KNOWN in asked:
        asked[KNOWN] = [pair for pair in asked[KNOWN] if pair.form in trained]
    fitted = training()
    answers = _ask_all(
        fitted.parser, asked, corpus.pairs("validation", trial.train_sources), corpus, same_plan
    )
    over_both = None  # the unseen forms of the validation part and known ones
    if trial.by_form:
        unseen, known = answers["validation"].accuracy, answers[KNOWN].accuracy
        if unseen is not None and known is not None:
            over_both = harmonic_mean(unseen, known)
    last = answers["test"] if asked["test"] else answers["validation"]
    return {
        **asdict(trial),
        "configuration": dict(trial.configuration),
        "version": entry(trial.parser).version,
        "n_train": fitted.n_train,
        **{f"n_{part}": len(pairs) for part, pairs in asked.items()},
        **{f"accuracy_{part}": each.accuracy for part, each in answers.items()},
        **({"harmonic_mean": over_both} if trial.by_form else {}),
        **{f"same_plan_{part}": each.same_plan for part, each in answers.items()},
        **dict(intervals(answers)),
        "outcomes": {part: each.tally() for part, each in answers.items() if each.of},
        "outcomes_same_plan": {
            part: each.tally(by_plan=True) for part, each in answers.items() if each.of
        },
        "score_kind": fitted.parser.score_kind,
        "calibration": {part: each.calibration() for part, each in answers.items() if each.of},
        "well_formed": score(last.judgements).well_formed,
        "seconds_train": round(fitted.seconds, 3),
        "milliseconds_per_command": round(last.milliseconds, 3),
        "parameters": fitted.parser.parameters(),
        "answered_by": fitted.parser.answered_by,
        "code_version": code_version(),
    }


def _ask_all(
    parser: Parser,
    asked: dict[str, list[Pair]],
    calibrating: Sequence[Pair],
    corpus: Corpus,
    same_plan: PlanAgreement,
) -> dict[str, PartAnswers]:
    """Return the answers to each part of ``asked``."""
    answering = {KNOWN: parser, "test": parser.for_test_part(calibrating)}
    return {
        part: ask_cross_fitted(parser, pairs, calibrating, corpus.cluster, same_plan)
        if part == "validation"
        else ask(answering[part], pairs, corpus.cluster, same_plan)
        for part, pairs in asked.items()
    }


def cell_key(trial: Trial, corpus: Corpus, knowledge_hash: str, recipes: Sequence[str] = ()) -> str:
    """Return the SHA-256 of everything that decides a cell: conditions, pairs, knowledge, recipes and code."""
    used = {*trial.train_sources, *trial.test_sources}
    pairs = [
        [part, pair.source, pair.utterance, pair.form, pair.task_category]
        for part in ("train", "validation", KNOWN, "test")
        for pair in corpus.pairs(part, sorted(used))
    ]
    clusters = sorted({corpus.cluster(pair) for pair in corpus.pairs("validation", sorted(used))})
    conditions = [asdict(trial), entry(trial.parser).version, knowledge_hash, code_version(), pairs]
    conditions += [clusters, list(recipes)]
    return sha256(json.dumps(conditions, ensure_ascii=False).encode()).hexdigest()


class CellFile:
    """A JSON list of cells. A finished cell is added at once, so a killed benchmark loses none."""

    def __init__(self, path: Path):
        """Read the cells of ``path``. Raises Refusal where it holds something else."""
        self.path = path
        self.cells: list[Cell] = []
        if not path.exists():
            return
        try:
            cells = json.loads(path.read_text(encoding="utf-8"))
        except (ValueError, RecursionError):
            cells = None
        if not isinstance(cells, list) or any("key" not in cell for cell in cells):
            raise Refusal(
                f"{path} holds something other than cells; name another file.", "not_a_cells_file"
            )
        self.cells = cells

    def has(self, key: str) -> bool:
        return any(cell["key"] == key for cell in self.cells)

    def append(self, cell: Cell) -> None:
        """Add a cell: write a new file beside the old one and rename it."""
        self.cells.append(cell)
        unfinished = self.path.with_name(f".{self.path.name}.{os.getpid()}")
        text = json.dumps(self.cells, ensure_ascii=False, indent=1)
        unfinished.write_text(text + "\n", encoding="utf-8")
        os.replace(unfinished, self.path)


@cache
def code_version() -> str:
    """Return the version of the package and twelve digits of the SHA-256 of all code that decides figures:
    the language core, the parsers and their networks."""
    digest = sha256()
    for folder in DECIDING:
        for path in sorted((Path(settings.BASE_DIR) / folder).rglob("*")):
            if path.suffix in (".py", ".lark"):
                digest.update(path.relative_to(settings.BASE_DIR).as_posix().encode())
                digest.update(path.read_bytes())
    try:
        version = metadata.version("gpsr-workbench")
    except metadata.PackageNotFoundError:
        version = "0"
    return f"{version}+{digest.hexdigest()[:12]}"
