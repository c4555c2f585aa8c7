"""Compares the paraphrases of a file with those of a world."""

from __future__ import annotations

from collections.abc import Sequence

from django.db.models import Max

from annotations.importing.prompts import Source
from annotations.language.corpus import GroundedTriple, distance
from annotations.models import Paraphrase, World
from annotations.rows.decisions import respect
from annotations.rows.synchronise import Plan


def plan_paraphrases(
    world: World, triples: Sequence[GroundedTriple], sources: Sequence[Source], brings_back: bool
) -> Plan[Paraphrase]:
    """Plan to add the records that are not there, each once, behind those that are."""
    known = set(world.paraphrases.values_list("prompt", "utterance", "grounded_form"))
    last = world.paraphrases.aggregate(last=Max("position"))["last"]
    following = 0 if last is None else last + 1
    new: list[Paraphrase] = []
    for triple, source in zip(triples, sources, strict=True):
        key = (triple.command, triple.paraphrase, triple.canonical_form)
        if key not in known:
            known.add(key)
            new.append(_paraphrase(world, triple, source, following + len(new)))
    return respect(Plan(Paraphrase, (), new, [], [], []), world, _key_of_paraphrase, brings_back)


def _key_of_paraphrase(row: Paraphrase) -> tuple[str, str, str]:
    return row.prompt, row.utterance, row.grounded_form


def _paraphrase(world: World, triple: GroundedTriple, source: Source, position: int) -> Paraphrase:
    apart = distance(triple.paraphrase, triple.command)
    return Paraphrase(
        world=world,
        command=source.command,
        prompt=triple.command,
        utterance=triple.paraphrase,
        grounded_form=triple.canonical_form,
        logical_form=source.logical_form,
        edit_distance=apart.edit,
        jaccard_distance=apart.jaccard,
        position=position,
    )
