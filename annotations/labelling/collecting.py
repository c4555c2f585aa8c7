"""Verb: collect utterances that have no form yet."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from django.db import transaction

from annotations.labelling.proposals import request_proposals
from annotations.labelling.spans import anonymized_by, anonymizer_of
from annotations.language.errors import LanguageError, Position, Problem, error_at
from annotations.language.limits import require_writable
from annotations.models import Origin, User, Utterance, World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.rows.synchronise import BATCH, batches

MOST_AT_ONCE = 5_000  # utterances of one paste or upload


@dataclass(frozen=True, slots=True)
class Collected:
    """What became of the texts. With an error among the problems nothing was stored.

    ``duplicates`` are the texts that the world has already, or that came twice, in their order.
    """

    added: int = 0
    duplicates: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()

    def as_json(self) -> dict[str, Any]:
        return {
            "added": self.added,
            "duplicates": list(self.duplicates),
            "problems": [str(problem) for problem in self.problems],
        }


def collect(
    world: World, texts: Iterable[str], origin: str = Origin.PASTED, by: User | None = None
) -> Collected:
    """Store each text as an utterance of ``world``, with its entities found.

    Whitespace is normalised; empty texts are left out. Texts that the world has already are reported,
    never stored twice.
    """
    wanted, problems = _read(texts)
    if problems:
        return Collected(problems=problems)
    with transaction.atomic():
        World.objects.select_for_update().get(pk=world.pk)
        known = _find_known(world, wanted)
        new = [text for text in dict.fromkeys(wanted) if text not in known]
        anonymizer = anonymizer_of(world)
        rows = [
            Utterance(
                world=world,
                text=text,
                origin=origin,
                created_by=by,
                **anonymized_by(anonymizer, text),
            )
            for text in new
        ]
        Utterance.objects.bulk_create(rows, batch_size=BATCH)
    request_proposals(world, by)
    return Collected(len(rows), tuple(_repetitions(wanted, known)))


def _read(texts: Iterable[str]) -> tuple[list[str], tuple[Problem, ...]]:
    """Return the texts that are not empty, and what is wrong with any; lines count from 1."""
    wanted: list[str] = []
    problems: list[Problem] = []
    for line, text in enumerate(texts, start=1):
        place = Position(line=line)
        if len(wanted) == MOST_AT_ONCE:
            hint = f"{MOST_AT_ONCE:,} is the limit; add the rest afterwards"
            problems.append(error_at(place, "there are too many utterances", hint))
            break
        said = " ".join(text.split())
        try:
            require_writable(said, place)
        except LanguageError as error:
            problems.append(error.problem)
        if len(said) > MOST_CHARACTERS:
            message = f"the utterance has {len(said):,} characters"
            problems.append(error_at(place, message, f"{MOST_CHARACTERS} is the limit"))
        if said:
            wanted.append(said)
    return wanted, tuple(problems)


def _find_known(world: World, texts: list[str]) -> set[str]:
    known: set[str] = set()
    for some in batches(texts):
        rows = Utterance.objects.filter(world=world, text__in=some)
        known.update(rows.values_list("text", flat=True))
    return known


def _repetitions(texts: list[str], known: set[str]) -> Iterator[str]:
    """Yield the texts that were not stored, in their order."""
    seen = set(known)
    for text in texts:
        if text in seen:
            yield text
        seen.add(text)
