"""What a split holds to learn from, and the parser that is recommended for it."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from django.db.models import Count

from annotations.language.corpus import Criterion, Part
from annotations.models import Entity, Split, World
from annotations.models.splits import Source
from parser_service.parsers.conditions import SOURCE_WORDS, SOURCES
from parser_service.parsers.pretrained_files import Gap, find_gaps
from parser_service.parsers.recommendation import Recommendation, TrainingMaterial, recommend
from parser_service.parsers.registry import PARSERS, make_config


@dataclass(frozen=True, slots=True)
class SplitContents:
    """The pairs of a split: those to train on by their source, and how many the other parts have."""

    split: Split
    train: Counter[str] = field(default_factory=Counter)
    validation: int = 0
    test: int = 0

    @property
    def by_source(self) -> list[tuple[str, int]]:
        """The sources of training pairs in words, each with its number of pairs."""
        return [
            (SOURCE_WORDS[name], self.train[source])
            for name, source in SOURCES.items()
            if self.train[source]
        ]


def contents_of(split: Split) -> SplitContents:
    """Count the pairs of a split. One query."""
    rows = split.examples.order_by().values_list("part", "source").annotate(Count("pk"))
    train: Counter[str] = Counter()
    others: Counter[str] = Counter()
    for part, source, count in rows:
        if part == Part.TRAIN:
            train[source] += count
        else:
            others[part] += count
    return SplitContents(split, train, others[Part.VALIDATION], others[Part.TEST])


def material_of(world: World, contents: SplitContents | None) -> TrainingMaterial:
    """Return what decides which parser is recommended. Two queries."""
    trained = (
        world.runs.scored_or_active().on_all_pairs().order_by().values_list("parser", flat=True)
    )
    train = contents.train if contents else Counter()
    return TrainingMaterial(
        generated=train[Source.GENERATED],
        paraphrases=train.total() - train[Source.GENERATED],
        has_ontology=Entity.objects.filter(ontology__world=world).exists(),
        criterion=Criterion(contents.split.criterion) if contents else Criterion.COMMAND,
        trained=frozenset(trained.distinct()),
    )


def gaps_of_parsers() -> dict[str, list[Gap]]:
    """Return what each parser lacks before it can be trained with its defaults; empty where nothing."""
    return {name: find_gaps(make_config(name), anywhere=False) for name in PARSERS}


def recommendation_for(world: World, split: Split | None = None) -> Recommendation:
    """Return the parser to train next on ``split``, or on the newest one of ``world``."""
    split = split or world.splits.first()
    lacking = {name for name, gaps in gaps_of_parsers().items() if gaps}
    return recommend(material_of(world, contents_of(split) if split else None), lacking)
