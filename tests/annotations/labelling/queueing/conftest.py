from __future__ import annotations

import pytest

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import refill
from annotations.labelling.item_answers import answer
from annotations.models import Assignment, Utterance, Verdict
from annotations.models.worlds import Role
from tests.conftest import member

BRING = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
GO = '( go " <room> " )'


@pytest.fixture
def utterances(world, annotator) -> list[Utterance]:
    """Three utterances without a form, in a world whose queue is empty."""
    collect(world, ["bring me tea", "go to the kitchen", "find the milk"], by=annotator)
    return list(world.utterances.order_by("pk"))


@pytest.fixture
def queue(world, utterances):
    """The open items of the world, once they are filled from its rows."""
    assert refill(world) == 3
    return world.work_items.open()


@pytest.fixture
def berta(world):
    return member(world, "berta", Role.ANNOTATOR)


@pytest.fixture
def carl(world):
    return member(world, "carl", Role.ANNOTATOR)


def say(assignment: Assignment, form: str = BRING, verdict: str = Verdict.FORM, reason: str = ""):
    """The person labels what they hold. Returns the label."""
    utterance = Utterance.objects.get(pk=assignment.item.utterance_id)
    return answer(utterance, verdict, form, assignment.person, utterance.version, reason=reason)


def kinds(world) -> list[str]:
    return sorted(world.work_items.open().values_list("kind", flat=True))
