"""The forms of the utterances that share the most words: over the known pairs of a world, in the web process."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import lru_cache
from itertools import chain

from django.db.models import Count, Max, Sum

from annotations.labelling.spans import anonymizer_of
from annotations.language.forms import CLASS_TOKEN
from annotations.models import World
from annotations.rows.synchronise import BATCH
from parser_service.parsers.interface import Candidate, Pair
from parser_service.parsers.knn import NearestNeighbour

MOST_COMMANDS = 100_000
MOST_PARAPHRASES = 20_000  # the newest; each is anonymized when the index is built
MOST_LABELLED = 5_000  # the newest; this index is built again after each answer
LOOKED_AT = 30  # forms that are ranked
MISMATCH = 0.05  # of the share of common words, which is 0 to 1
KEPT_WORLDS = 4

# What an index was built from: the key of the world, and what changes when its pairs do.
Stamp = tuple[int | None, ...]


def nearest_forms(world: World, anonymized_text: str, how_many: int) -> list[Candidate]:
    """Return the forms of the nearest pairs of ``world``, each once.

    The score is the share of common words, less ``MISMATCH`` for each class token that either the form
    or the text has and the other lacks.
    """
    indices = (
        _index_commands(world.pk, _stamp_of_written(world)),
        _index_labelled(world.pk, _stamp_of_labelled(world)),
    )
    best: dict[str, float] = {}
    for index in indices:
        for candidate in index.predict([anonymized_text], LOOKED_AT)[0] if index else ():
            best[candidate.form] = max(candidate.score, best.get(candidate.form, 0.0))
    said = Counter(CLASS_TOKEN.findall(anonymized_text))
    candidates = [
        Candidate(form, score - MISMATCH * _mismatches(said, form))
        for form, score in best.items()
        if score > 0
    ]
    return sorted(candidates, key=lambda each: -each.score)[:how_many]


def _mismatches(said: Counter[str], form: str) -> int:
    """Count the class tokens that the form has beyond those of the text, and the other way round."""
    in_form = Counter(CLASS_TOKEN.findall(form))
    return (in_form - said).total() + (said - in_form).total()


def _stamp_of_written(world: World) -> Stamp:
    counted = world.paraphrases.accepted().aggregate(Count("pk"), Max("pk"), Sum("version"))
    return (world.revision, world.generations, *counted.values())


def _stamp_of_labelled(world: World) -> Stamp:
    counted = world.utterances.labelled().aggregate(Count("pk"), Max("pk"), Max("labels__pk"))
    return tuple(counted.values())


@lru_cache(maxsize=KEPT_WORLDS)
def _index_commands(world_id: int, stamp: Stamp) -> NearestNeighbour | None:
    """Return the index of commands and paraphrases."""
    world = World.objects.get(pk=world_id)
    return _index(chain(_commands(world), _paraphrases(world)))


@lru_cache(maxsize=KEPT_WORLDS)
def _index_labelled(world_id: int, stamp: Stamp) -> NearestNeighbour | None:
    rows = World.objects.get(pk=world_id).utterances.labelled().order_by("-pk")
    texts = rows.values_list("anonymized_text", "logical_form")[:MOST_LABELLED]
    return _index(Pair(text, form) for text, form in texts)


def _commands(world: World) -> Iterator[Pair]:
    texts = world.commands.values_list("anonymized_text", "logical_form__text")
    for text, form in texts[:MOST_COMMANDS].iterator(chunk_size=BATCH):
        yield Pair(text, form)


def _paraphrases(world: World) -> Iterator[Pair]:
    anonymizer = anonymizer_of(world)
    rows = world.paraphrases.accepted().order_by("-position")
    texts = rows.values_list("utterance", "logical_form")
    for text, form in texts[:MOST_PARAPHRASES].iterator(chunk_size=BATCH):
        yield Pair(anonymizer.anonymize(text).command, form)


def _index(pairs: Iterator[Pair]) -> NearestNeighbour | None:
    known = list(pairs)
    if not known:
        return None
    index = NearestNeighbour()
    index.fit(known)
    return index
