"""What annotators do with entities that came up in dialogues."""

from __future__ import annotations

import pytest

from annotations.language.plans import Offer
from annotations.language.texts.errors import Refusal
from annotations.models import Entity
from parser_service.models import OfferState
from parser_service.serving.entity_offers import confirm, offer, refuse
from tests.parser_service.served import make_home


@pytest.fixture
def home(world):
    make_home(world)
    return world


def test_an_offer_is_counted_and_not_repeated(home):
    for _ in range(3):
        row = offer(home, Offer("object", "flurb"), "bring me the flurb")
    row.refresh_from_db()
    assert row.times == 3 and home.offered_entities.count() == 1


def test_another_word_becomes_an_alias(home, annotator):
    row = offer(home, Offer("object", "bowl", "flurb"), "bring me the flurb")
    assert confirm(row, annotator).aliases == ["flurb"]
    with pytest.raises(Refusal) as refused:
        refuse(row, annotator)
    assert refused.value.code == "offer_decided"


def test_a_confirmed_entity_is_not_added_twice(home, annotator):
    row = offer(home, Offer("object", "Bowl"), "bring me the Bowl")
    confirm(row, annotator)
    assert Entity.objects.filter(text__iexact="bowl").count() == 1


def test_an_alias_of_what_is_gone_stays_waiting(home, annotator):
    row = offer(home, Offer("object", "spoon", "flurb"), "bring me the flurb")
    with pytest.raises(Refusal) as refused:
        confirm(row, annotator)
    assert refused.value.code == "entity_gone"
    row.refresh_from_db()
    assert row.state == OfferState.WAITING


def test_a_refused_entity_stays_out(home, annotator):
    row = offer(home, Offer("object", "flurb"), "bring me the flurb")
    refuse(row, annotator)
    row.refresh_from_db()
    assert (row.state, row.decided_by) == (OfferState.REFUSED, annotator)
    assert not Entity.objects.filter(text="flurb").exists()
