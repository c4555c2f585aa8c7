"""The forms that the grammar derives for an utterance, and those of the known utterances that share the most words
with it: both in the web process."""

from __future__ import annotations

from collections import Counter, OrderedDict
from collections.abc import Callable, Iterable
from functools import lru_cache
from threading import Lock
from typing import Any

from django.db.models import Count, Max, QuerySet, Sum

from annotations.labelling.entity_spans import anonymizer_of
from annotations.language.forms import CLASS_TOKEN
from annotations.language.texts import LanguageError
from annotations.models import Command, World
from annotations.rows.from_rows import task_categories
from annotations.rows.synchronise import BATCH, batches
from parser_service.labelling.known_pairs import KnownPairs
from parser_service.parsers.interface import Candidate, Knowledge
from parser_service.parsers.oracle import GrammarOracle

MOST_COMMANDS = 100_000
MOST_PARAPHRASES = 20_000  # the newest
MOST_LABELLED = 5_000  # the newest
LOOKED_AT = 30  # forms that are ranked
MISMATCH = 0.05  # of the share of common words, which is 0 to 1
KEPT_CHARTS = 4  # of the grammars of as many worlds
MOST_KEPT = 500_000  # pairs that a process keeps, of the worlds that were asked about last; some hundred bytes each


def derived_forms(world: World, anonymized_text: str, how_many: int) -> list[Candidate]:
    """Return the forms of all derivations, first the one that generation keeps; none outside the grammar."""
    oracle = _oracle(world.pk, world.revision, world.generations)
    return oracle.predict([anonymized_text], how_many)[0] if oracle else []


@lru_cache(maxsize=KEPT_CHARTS)
def _oracle(world_id: int, revision: int, generations: int) -> GrammarOracle | None:
    """Return the chart of the grammar as it is at this revision; None where it cannot be read."""
    try:
        categories = task_categories(World.objects.get(pk=world_id))
        return GrammarOracle(knowledge=Knowledge(grammar=categories)) if categories else None
    except LanguageError:
        return None


class _Kept:
    """The index of one kind of pairs of a world. ``base`` is what it was begun with, and ``stamp`` changes when its
    pairs do."""

    def __init__(self, base: tuple[Any, ...]) -> None:
        self.base = base
        self.stamp: tuple[Any, ...] = ()
        self.pairs = KnownPairs()
        self.lock = Lock()


Kind = tuple[str, int]  # of the pairs, and the key of the world
# Those that were asked last stand last.
_kept: OrderedDict[Kind, _Kept] = OrderedDict()
_keeping = Lock()


def nearest_forms(world: World, anonymized_text: str, how_many: int) -> list[Candidate]:
    """Return the forms of the nearest pairs of ``world``, each once.

    The score is the share of common words, less ``MISMATCH`` for each class token that either the form
    or the text has and the other lacks. Two queries where nothing has changed.
    """
    base = world.created_at, world.revision, world.generations
    commands = world.commands.order_by("position")[:MOST_COMMANDS]
    said = world.paraphrases.accepted().order_by("-position")[:MOST_PARAPHRASES]
    labelled = world.utterances.labelled().order_by("-pk")[:MOST_LABELLED]

    def read_commands(keys: list[int]) -> Iterable[tuple[int, int, str, str]]:
        rows = world.commands.filter(pk__in=keys).order_by()
        for key, text, form in rows.values_list("pk", "anonymized_text", "logical_form__text"):
            yield key, 0, text, form

    def read_paraphrases(keys: list[int]) -> Iterable[tuple[int, int, str, str]]:
        anonymizer = anonymizer_of(world)
        rows = world.paraphrases.filter(pk__in=keys).order_by()
        for key, version, text, form in rows.values_list(
            "pk", "version", "utterance", "logical_form"
        ):
            yield key, version, anonymizer.anonymize(text).command, form

    def read_labelled(keys: list[int]) -> Iterable[tuple[int, int, str, str]]:
        rows = world.utterances.filter(pk__in=keys).order_by()
        return rows.values_list("pk", "version", "anonymized_text", "logical_form")

    best: dict[str, float] = {}
    for kind, begun_with, newest, read in (
        ("commands", base, commands, read_commands),
        ("paraphrases", base, said, read_paraphrases),
        ("labelled", (world.created_at,), labelled, read_labelled),
    ):
        kept = _keep((kind, world.pk), begun_with)
        with kept.lock:
            _bring_up_to_date(kept, newest, read)
            nearest = kept.pairs.nearest(anonymized_text, LOOKED_AT)
        for form, score in nearest:
            best[form] = max(score, best.get(form, 0.0))
    said_classes = Counter(CLASS_TOKEN.findall(anonymized_text))
    candidates = []
    for form, score in best.items():
        in_form = Counter(CLASS_TOKEN.findall(form))
        mismatches = (in_form - said_classes).total() + (said_classes - in_form).total()
        candidates.append(Candidate(form, score - MISMATCH * mismatches))
    return sorted(candidates, key=lambda each: -each.score)[:how_many]


def _keep(kind: Kind, base: tuple[Any, ...]) -> _Kept:
    """Return the index that is kept of this kind and begun with ``base``, or a new one. Drop those that nobody has
    asked for longest, where they are too many pairs together."""
    with _keeping:
        kept = _kept.pop(kind, None)
        if kept is None or kept.base != base:
            kept = _Kept(base)
        _kept[kind] = kept
        while len(_kept) > 3 and sum(len(each.pairs) for each in _kept.values()) > MOST_KEPT:
            _kept.popitem(last=False)
    return kept


def _bring_up_to_date(
    kept: _Kept,
    newest: QuerySet[Any],
    read: Callable[[list[int]], Iterable[tuple[int, int, str, str]]],
) -> None:
    """Put into the index what has changed of the ``newest`` rows since it was asked last: key, version, text, form."""
    if newest.model is Command:  # they change with the base alone
        versions = {} if kept.stamp else dict.fromkeys(newest.values_list("pk", flat=True), 0)
        stamp: tuple[Any, ...] = ("read",)
    else:
        amounts = newest.aggregate(rows=Count("pk"), last=Max("pk"), versions=Sum("version"))
        stamp = tuple(amounts.values())
        versions = {} if stamp == kept.stamp else dict(newest.values_list("pk", "version"))
    if stamp == kept.stamp:
        return
    if kept.pairs.is_sparse:
        kept.pairs = KnownPairs()
    for key in kept.pairs.versions.keys() - versions.keys():
        kept.pairs.drop(key)
    changed = [key for key, version in versions.items() if kept.pairs.versions.get(key) != version]
    for some in batches(changed, BATCH):
        for row in read(some):
            kept.pairs.put(*row)
    kept.stamp = stamp
