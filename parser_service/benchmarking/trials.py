"""What a benchmark is asked to measure: parsers, columns, seeds and splits."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import product
from typing import Any, NamedTuple

from annotations.language.corpus import Criterion
from annotations.language.texts import Refusal
from parser_service.parsers.conditions import (
    GENERATED,
    TEST_SOURCES,
    Protocol,
    Setting,
    sources_of,
)
from parser_service.parsers.registry import config_values, entry, make_config


class Declared(StrEnum):
    """Which forms declare the predicates that *domain* knows: those of all templates, as the world has them,
    or those of the training pairs alone."""

    ALL = "all"
    TRAINING = "training"


class TrialColumn(NamedTuple):
    """A column of the table. ``setting`` is train sources and test source, as in ``gen+para-mixed``;
    ``declared`` says which forms declare predicates."""

    setting: str
    criterion: str
    protocol: str
    declared: str = Declared.ALL


@dataclass(frozen=True, slots=True)
class Trial:
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
    declared: str = Declared.ALL

    @property
    def training(self) -> tuple[Any, ...]:
        """Return everything that decides the training; trials with the same value can share one."""
        trained_on = (
            train_sources_of(self.setting),
            self.criterion,
            self.protocol,
            self.seed,
            self.split,
            self.declared,
        )
        return self.parser, self.configuration, *trained_on

    @property
    def train_sources(self) -> tuple[str, ...]:
        return sources_of(Setting.read(self.setting).train_sources)

    @property
    def test_sources(self) -> tuple[str, ...]:
        return TEST_SOURCES[Setting.read(self.setting).test_source]

    @property
    def by_form(self) -> bool:
        return self.criterion == Criterion.LOGICAL_FORM

    def require_unseen(self) -> None:
        """Raise Refusal where a parser would be tested on what its protocol gives it to learn from."""
        is_given = self.protocol == Protocol.GRAMMAR and GENERATED in self.test_sources
        if is_given and entry(self.parser).learns:
            raise Refusal(
                f"{self.setting} would test it on what it has learned: this protocol gives it the "
                "templates, and with them every generated command and its form. Test on paraphrases.",
                "tests_on_training_data",
            )

    def refuse(self, why: str) -> str:
        """Return the sentence that replaces the cell; trials refused for the same reason share it."""
        return f"{self.parser}, {self.protocol}: {why}"


def trials(
    parsers: Sequence[str],
    columns: Sequence[TrialColumn],
    seeds: Sequence[int],
    configurations: Mapping[str, Mapping[str, Any]] | None = None,
    new_splits: Sequence[int] = (),
    new_criteria: Collection[str] = tuple(Criterion),
) -> Iterator[Trial]:
    """Yield all trials; a parser only has those of the protocols that it supports.

    Trials of the same ``training`` follow each other. ``seeds`` are those of the trainings.
    ``configurations`` changes hyperparameters of some parsers. ``new_splits`` are the seeds of splits
    that replace the published one, or the one of seed 0 by source command, of which none was published,
    where the criterion is among ``new_criteria``. Raises Refusal.
    """
    changed = configurations or {}
    configured = {
        name: tuple(config_values(make_config(name, changed.get(name))).items()) for name in parsers
    }
    settings, criteria, protocols, declared = (
        dict.fromkeys(parts) for parts in zip(*columns, strict=True)
    )
    # Settings last, so that those with the same training follow each other.
    for criterion, name, protocol, seed in product(criteria, configured, protocols, seeds):
        if protocol not in entry(name).protocols:
            continue
        published = 0 if criterion == Criterion.SOURCE_COMMAND else None
        new = new_splits if criterion in new_criteria else ()
        splits: Sequence[int | None] = [*new] or [published]
        ordered = sorted(settings, key=train_sources_of)
        for split, of, setting in product(splits, declared, ordered):
            if (column := TrialColumn(setting, criterion, protocol, of)) in columns:
                yield Trial(name, configured[name], *column[:3], seed, split, str(of))


def train_sources_of(setting: str) -> str:
    return Setting.read(setting).train_sources
