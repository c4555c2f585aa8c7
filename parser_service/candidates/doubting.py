"""Puts utterances that parsers are unsure of in front of the work queue."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from annotations.models import Proposal, Utterance, WorkKind, World
from annotations.queueing import WantedItem, enqueue
from parser_service.candidates.composing import say_source
from parser_service.candidates.grammar import derived_forms
from parser_service.candidates.neighbours import nearest_forms

UNSURE_SHARE = 0.1  # scores compare within one parser only, so the least sure tenth is taken


def enqueue_doubts(world: World, rows: Sequence[Utterance]) -> int:
    """Ask first for those of ``rows`` that the parser is least sure of, or that it and the nearest
    utterance give different forms. Returns how many items are new."""
    tops = Proposal.objects.filter(utterance__in=rows, rank=1).select_related("utterance")
    best = sorted(tops, key=lambda top: top.score)
    disagreements = enqueue(world, WorkKind.DISAGREEMENT, _disagreements(world, best))
    return disagreements + enqueue(world, WorkKind.LOW_CONFIDENCE, _unsure(best))


def _disagreements(world: World, tops: Sequence[Proposal]) -> Iterator[WantedItem]:
    for top in tops:
        text = top.utterance.anonymized_text
        nearest = nearest_forms(world, text, 1)
        is_certain = bool(derived_forms(world, text, 1))  # a command of the grammar
        if nearest and nearest[0].form != top.form and not is_certain:
            reason = f"{say_source(top.source)} and the nearest utterance give different forms."
            yield WantedItem(top.utterance, reason)


def _unsure(tops: Sequence[Proposal]) -> Iterator[WantedItem]:
    for top in tops[: int(len(tops) * UNSURE_SHARE)]:
        reason = f"{say_source(top.source)} is less sure of its answer here than of most others."
        yield WantedItem(top.utterance, reason)
