"""What a split holds to learn from, and the parser that is recommended for it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from annotations.generation.split_statistics import figures_of
from annotations.language.corpus import Criterion, Overlap, together
from annotations.models import Entity, Split, World
from annotations.models.splits import Source
from parser_service.parsers.conditions import SOURCE_WORDS, SOURCES
from parser_service.parsers.pretrained_files import Gap, find_gaps
from parser_service.parsers.recommendation import Recommendation, TrainingMaterial, recommend
from parser_service.parsers.registry import make_config, parsers

# What most people ask for is known forms said in another way; a split by form asks for new ones.
USUAL_ORDER = (Criterion.COMMAND, Criterion.SOURCE_COMMAND, Criterion.LOGICAL_FORM)


def usual_split(world: World) -> Split | None:
    """Return the split to train on where nobody names one; None where there is none.

    Splits with paraphrases to learn from come first, of these those by command, then by source command; of several
    the newest.
    """

    def place(split: Split) -> tuple[bool, int]:
        has_paraphrases = bool(train_sources(split) - {Source.GENERATED})
        return not has_paraphrases, USUAL_ORDER.index(Criterion(split.criterion))

    return min(world.splits.order_by("-created_at", "-pk"), key=place, default=None)


def train_sources(split: Split) -> set[str]:
    """Return the sources of the training pairs of a split."""
    return {each.source for each in figures_of(split).counts if each.train}


@dataclass(frozen=True, slots=True)
class SplitContents:
    """The pairs of a split: those to train on by their source, how many the other parts have, and, by source, how much
    of the validation part training has."""

    split: Split
    train: Counter[str] = field(default_factory=Counter)
    validation: int = 0
    test: int = 0
    overlaps: Mapping[str, Overlap] = field(default_factory=dict)

    @property
    def by_source(self) -> list[tuple[str, int]]:
        """The sources of training pairs in words, each with its number of pairs."""
        return [
            (SOURCE_WORDS[name], self.train[source])
            for name, source in SOURCES.items()
            if self.train[source]
        ]

    @property
    def of_new_forms(self) -> int:
        """How many validation pairs have a form that no training pair has."""
        return together(self.overlaps.values()).examples_of_new_forms


def contents_of(split: Split) -> SplitContents:
    """Return what the figures of a split say."""
    figures = figures_of(split)
    return SplitContents(
        split,
        Counter({each.source: each.train for each in figures.counts}),
        sum(each.validation for each in figures.counts),
        sum(each.test for each in figures.counts),
        figures.overlaps,
    )


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
        overlaps=contents.overlaps if contents else {},
        trained=frozenset(trained.distinct()),
    )


@dataclass(frozen=True, slots=True)
class Advice:
    """The parser to train next on a split, and what says so. ``contents`` is None without a split, and ``gaps`` what
    each parser lacks before it can be trained with its defaults; empty where nothing."""

    contents: SplitContents | None
    material: TrainingMaterial
    gaps: Mapping[str, list[Gap]]
    recommendation: Recommendation


def advise(world: World, split: Split | None) -> Advice:
    """Return the parser to train next on ``split``. Two queries."""
    contents = contents_of(split) if split else None
    material = material_of(world, contents)
    gaps = {name: find_gaps(make_config(name), anywhere=False) for name in parsers()}
    lacking = {name for name, of_parser in gaps.items() if of_parser}
    return Advice(contents, material, gaps, recommend(material, lacking))
