"""Offer entities from dialogues for the ontology; annotators confirm or refuse them."""

from __future__ import annotations

from http import HTTPStatus

from django.core.exceptions import ValidationError
from django.db import transaction
from django.db.models import F
from django.utils import timezone

from annotations.editing.edits import add, change
from annotations.language.plans import Offer
from annotations.language.texts import Refusal
from annotations.models import Entity, User, World
from parser_service.models import OfferedEntity, OfferState


def offer(world: World, offered: Offer, said_in: str) -> OfferedEntity:
    """Store an offer, or count that one more dialogue makes it. One that was refused stays refused."""
    row, is_new = OfferedEntity.objects.get_or_create(
        world=world,
        entity_class=offered.entity_class,
        text=offered.text,
        alias=offered.alias,
        defaults={"said_in": said_in},
    )
    if not is_new:
        OfferedEntity.objects.filter(pk=row.pk).update(times=F("times") + 1)
    return row


def confirm(row: OfferedEntity, by: User) -> Entity:
    """Put an offered entity, or the other word for one, into the ontology.

    Raises Refusal where it was decided before, the world has no ontology, or the entity that the word
    is for is gone.
    """
    with transaction.atomic():
        _decide(row, OfferState.CONFIRMED, by)
        entities = Entity.objects.filter(
            ontology__world=row.world, entity_class=row.entity_class, text__iexact=row.text
        )
        there = [
            change(entity, {"aliases": [*entity.aliases, row.alias]}, by, entity.version)
            if row.alias and row.alias not in entity.aliases
            else entity
            for entity in entities
        ]
        if there:
            return there[0]
        if row.alias:
            raise Refusal(
                f"There is no {row.entity_class} {row.text} any more.",
                "entity_gone",
                HTTPStatus.CONFLICT,
            )
        ontology = getattr(row.world, "ontology", None)
        if ontology is None:
            raise Refusal(
                "This world has no ontology yet. Import one first.",
                "no_ontology",
                HTTPStatus.CONFLICT,
            )
        unsaved = Entity(ontology=ontology, entity_class=row.entity_class, text=row.text)
        try:
            return add(unsaved, by)
        except ValidationError as error:
            raise Refusal(
                " ".join(error.messages), "entity_refused", HTTPStatus.CONFLICT
            ) from error


def refuse(row: OfferedEntity, by: User) -> None:
    """Keep an offered entity out of the ontology. Raises Refusal where it was decided before."""
    with transaction.atomic():
        _decide(row, OfferState.REFUSED, by)


def _decide(row: OfferedEntity, state: OfferState, by: User) -> None:
    waiting = OfferedEntity.objects.filter(pk=row.pk, state=OfferState.WAITING)
    if not waiting.update(state=state, decided_by=by, decided_at=timezone.now()):
        raise Refusal(
            f"Somebody has decided about {row} already.", "offer_decided", HTTPStatus.CONFLICT
        )
    row.refresh_from_db()
