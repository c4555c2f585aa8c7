"""The forms that the grammar derives for an utterance, and those of the known utterances that share the most words
with it: both in the web process."""

from __future__ import annotations

from collections import Counter
from functools import lru_cache

from django.db.models import Count, Max, Sum

from annotations.labelling.entity_spans import anonymizer_of
from annotations.language.forms import CLASS_TOKEN
from annotations.language.texts import LanguageError
from annotations.models import World
from annotations.rows.from_rows import task_categories
from annotations.rows.synchronise import BATCH
from parser_service.parsers.interface import Candidate, Knowledge, Pair
from parser_service.parsers.knn import NearestNeighbour
from parser_service.parsers.oracle import GrammarOracle

MOST_COMMANDS = 100_000
MOST_PARAPHRASES = 20_000  # the newest; each is anonymized when the index is built
MOST_LABELLED = 5_000  # the newest; this index is built again after each answer
LOOKED_AT = 30  # forms that are ranked
MISMATCH = 0.05  # of the share of common words, which is 0 to 1
KEPT_WORLDS = 4

# What an index was built from: the key of the world, and what changes when its pairs do.
Stamp = tuple[int | None, ...]


def derived_forms(world: World, anonymized_text: str, how_many: int) -> list[Candidate]:
    """Return the forms of all derivations, first the one that generation keeps; none outside the grammar."""
    oracle = _oracle(world.pk, world.revision, world.generations)
    return oracle.predict([anonymized_text], how_many)[0] if oracle else []


@lru_cache(maxsize=KEPT_WORLDS)
def _oracle(world_id: int, revision: int, generations: int) -> GrammarOracle | None:
    """Return the chart of the grammar as it is at this revision; None where it cannot be read."""
    try:
        categories = task_categories(World.objects.get(pk=world_id))
        return GrammarOracle(knowledge=Knowledge(grammar=categories)) if categories else None
    except LanguageError:
        return None


def nearest_forms(world: World, anonymized_text: str, how_many: int) -> list[Candidate]:
    """Return the forms of the nearest pairs of ``world``, each once.

    The score is the share of common words, less ``MISMATCH`` for each class token that either the form
    or the text has and the other lacks.
    """
    paraphrases, labelled = world.paraphrases.accepted(), world.utterances.labelled()
    of_paraphrases = paraphrases.aggregate(Count("pk"), Max("pk"), Sum("version")).values()
    of_labelled = labelled.aggregate(Count("pk"), Max("pk"), Max("labels__pk")).values()
    indices = (
        _index_commands(world.pk, (world.revision, world.generations, *of_paraphrases)),
        _index_labelled(world.pk, tuple(of_labelled)),
    )
    best: dict[str, float] = {}
    for index in indices:
        for candidate in index.predict([anonymized_text], LOOKED_AT)[0] if index else ():
            best[candidate.form] = max(candidate.score, best.get(candidate.form, 0.0))
    said = Counter(CLASS_TOKEN.findall(anonymized_text))
    candidates = []
    for form, score in best.items():
        if score > 0:
            in_form = Counter(CLASS_TOKEN.findall(form))
            mismatches = (in_form - said).total() + (said - in_form).total()
            candidates.append(Candidate(form, score - MISMATCH * mismatches))
    return sorted(candidates, key=lambda each: -each.score)[:how_many]


@lru_cache(maxsize=KEPT_WORLDS)
def _index_commands(world_id: int, stamp: Stamp) -> NearestNeighbour | None:
    """Return the index of commands and paraphrases."""
    world = World.objects.get(pk=world_id)
    commands = world.commands.values_list("anonymized_text", "logical_form__text")
    pairs = [Pair(text, form) for text, form in commands[:MOST_COMMANDS].iterator(chunk_size=BATCH)]
    anonymizer = anonymizer_of(world)
    newest = world.paraphrases.accepted().order_by("-position")
    texts = newest.values_list("utterance", "logical_form")
    for text, form in texts[:MOST_PARAPHRASES].iterator(chunk_size=BATCH):
        pairs.append(Pair(anonymizer.anonymize(text).command, form))
    return _index(pairs)


@lru_cache(maxsize=KEPT_WORLDS)
def _index_labelled(world_id: int, stamp: Stamp) -> NearestNeighbour | None:
    rows = World.objects.get(pk=world_id).utterances.labelled().order_by("-pk")
    texts = rows.values_list("anonymized_text", "logical_form")[:MOST_LABELLED]
    return _index([Pair(text, form) for text, form in texts])


def _index(pairs: list[Pair]) -> NearestNeighbour | None:
    if not pairs:
        return None
    index = NearestNeighbour()
    index.fit(pairs)
    return index


KEPT_WORLDS = 4
