"""Pairs whose labels an audit doubts."""

from __future__ import annotations

import pytest

from annotations.labelling.audit_findings import store_findings
from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import label
from annotations.models import AuditFinding, Paraphrase, Utterance, Verdict
from annotations.models.worlds import Role
from tests.conftest import member
from tests.doubted_labels import MALE, doubt, say


def finding_of(row: Paraphrase | Utterance) -> AuditFinding:
    return row.audit_findings.get()


@pytest.fixture
def girls(world) -> Paraphrase:
    """A paraphrase about girls whose label says male."""
    return say(world, "how many girls are in the kitchen")


@pytest.fixture
def women(world, annotator) -> Utterance:
    """An utterance about women whose label says male."""
    collect(world, ["count the women"], by=annotator)
    row = world.utterances.get()
    label(row, Verdict.FORM, MALE, annotator, row.version)
    row.refresh_from_db()
    return row


@pytest.fixture
def findings(world, girls, women):
    """The findings of an audit that doubts both labels, the utterance's less; both are in the queue."""
    store_findings(world, [doubt(girls), doubt(women)], to_queue=2)
    return world.audit_findings


@pytest.fixture
def berta(world):
    return member(world, "berta", Role.ANNOTATOR)
