"""Verb: collect utterances, each text once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from django.db import transaction
from django.db.models import Count, Max, Sum
from django.utils import timezone

from annotations.labelling.entity_spans import anonymized_by, anonymizer_of
from annotations.labelling.proposal_requests import request_proposals
from annotations.language.texts import (
    LanguageError,
    Position,
    Problem,
    error_at,
    normalise_line,
    require_writable,
)
from annotations.models import (
    Entity,
    Label,
    Origin,
    Upload,
    User,
    Utterance,
    UtteranceStatus,
    Verdict,
    World,
)
from annotations.models.corpus import MOST_CHARACTERS
from annotations.rows.staging import Staging
from annotations.rows.synchronise import BATCH, batches

MOST_AT_ONCE = 5_000  # utterances of one paste or upload
COLUMNS = tuple(
    field.column
    for field in Utterance._meta.concrete_fields
    if field.column and not field.primary_key
)


@dataclass(frozen=True, slots=True)
class CollectedTexts:
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
    world: World,
    texts: Iterable[str],
    origin: str = Origin.PASTED,
    by: User | None = None,
    upload: Upload | None = None,
    forms: Mapping[str, str] | None = None,
) -> CollectedTexts:
    """Store each text as an utterance of ``world``, with its entities found.

    Each is normalised to one line; empty texts are left out. Texts that the world has already are reported,
    never stored twice.

    Args:
        upload: the row for what was sent, which may be unsaved; stored and counted where a text is new.
            One that was stored before adds nothing more.
        forms: text → canonical form, which becomes an answer of ``by`` that counts; with an upload only.
    """
    wanted, problems = _read(texts)
    if problems:
        return CollectedTexts(problems=problems)
    stored = None
    while stored is None:
        stored = _store(world, wanted, origin, by, upload, forms or {})
    added, known = stored
    request_proposals(world, by)
    repeated = []
    for text in wanted:
        if text in known:
            repeated.append(text)
        known.add(text)
    return CollectedTexts(added, tuple(repeated))


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
        said, problem = read_text(text, place)
        if problem:
            problems.append(problem)
        if said:
            wanted.append(said)
    return wanted, tuple(problems)


def read_text(text: str, place: Position) -> tuple[str, Problem | None]:
    """Return a text as an utterance has it, and why it cannot be one, if so. An empty one has no problem."""
    said = normalise_line(text)
    try:
        require_writable(said, place)
    except LanguageError as error:
        return said, error.problem
    if len(said) > MOST_CHARACTERS:
        message = f"the utterance has {len(said):,} characters"
        return said, error_at(place, message, f"{MOST_CHARACTERS} is the limit")
    return said, None


def _store(
    world: World,
    wanted: list[str],
    origin: str,
    by: User | None,
    upload: Upload | None,
    forms: Mapping[str, str],
) -> tuple[int, set[str]] | None:
    """Find the entities, then write in one short transaction.

    Returns the number of new rows and the known texts; None where somebody has changed entities or
    added one of the texts meanwhile.
    """
    entities = _stamp_of_entities(world)
    anonymizer = anonymizer_of(world)
    known = find_known(world, wanted)
    new = [text for text in dict.fromkeys(wanted) if text not in known]
    if not new:
        return 0, known
    if upload is not None and upload.pk is None:
        upload.save()  # rows refer to it; it waits until they are stored
    rows = [
        Utterance(
            world=world,
            text=text,
            origin=origin,
            created_by=by,
            upload=upload,
            logical_form=forms.get(text, ""),
            status=UtteranceStatus.LABELLED if text in forms else UtteranceStatus.UNLABELLED,
            **anonymized_by(anonymizer, text),
        )
        for text in new
    ]
    with Staging(Utterance, COLUMNS) as staging:
        staging.add_new(rows)
        with transaction.atomic():
            locked = World.objects.hold().get(pk=world.pk)
            if upload is not None and Upload.objects.stored().filter(pk=upload.pk).exists():
                return 0, known  # its form was sent twice, and the other one was first
            if _stamp_of_entities(locked) != entities or find_known(locked, new):
                return None
            added = staging.insert()
            if upload is not None:
                _conclude(upload, added, by)
            return added, known


def _conclude(upload: Upload, added: int, by: User | None) -> None:
    """Say that an upload is stored, and make answers of ``by`` of the forms that came with it."""
    upload.added, upload.stored_at, upload.content = added, timezone.now(), b""
    upload.save()
    labels = [
        Label(
            utterance_id=key,
            annotator=by,
            verdict=Verdict.FORM,
            form=form,
            reason="Uploaded with the utterance.",
            created_at=upload.stored_at,
            accepted_at=upload.stored_at,
        )
        for key, form in upload.utterances.labelled().values_list("pk", "logical_form")
    ]
    Label.objects.bulk_create(labels, batch_size=BATCH)


def _stamp_of_entities(world: World) -> dict[str, Any]:
    """Return what changes whenever the entities do."""
    rows = Entity.objects.filter(ontology__world=world)
    return rows.aggregate(Count("pk"), Max("pk"), Sum("version"))


def find_known(world: World, texts: list[str]) -> set[str]:
    """Return those of ``texts``, which are normalised, that ``world`` has as utterances."""
    known: set[str] = set()
    for some in batches(texts):
        rows = Utterance.objects.filter(world=world, text__in=some)
        known.update(rows.values_list("text", flat=True))
    return known
