"""What a split holds to learn from, and the parser that is recommended for it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from django.db.models import Case, Exists, OuterRef, Value, When

from annotations.generation.overlaps import form_counts, overlaps_of
from annotations.language.corpus import Criterion, Overlap, Part, together
from annotations.models import Entity, Example, Split, World
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
    learned = Example.objects.of(Part.TRAIN).exclude(source=Source.GENERATED)
    places = [When(criterion=each, then=Value(place)) for place, each in enumerate(USUAL_ORDER)]
    return (
        world.splits.annotate(
            has_paraphrases=Exists(learned.filter(split=OuterRef("pk"))),
            place=Case(*places, default=Value(len(places))),
        )
        .order_by("-has_paraphrases", "place", "-created_at", "-pk")
        .first()
    )


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
    """Count the pairs of a split. Two queries."""
    train: Counter[str] = Counter()
    others: Counter[str] = Counter()
    counts = form_counts(split)
    for (part, source, _), count in counts.items():
        if part == Part.TRAIN:
            train[source] += count
        else:
            others[part] += count
    overlaps = overlaps_of(split, counts)
    return SplitContents(split, train, others[Part.VALIDATION], others[Part.TEST], overlaps)


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


def gaps_of_parsers() -> dict[str, list[Gap]]:
    """Return what each parser lacks before it can be trained with its defaults; empty where nothing."""
    return {name: find_gaps(make_config(name), anywhere=False) for name in parsers()}


def recommendation_for(world: World, split: Split | None = None) -> Recommendation:
    """Return the parser to train next on ``split``, or on ``usual_split``."""
    split = split or usual_split(world)
    lacking = {name for name, gaps in gaps_of_parsers().items() if gaps}
    return recommend(material_of(world, contents_of(split) if split else None), lacking)
