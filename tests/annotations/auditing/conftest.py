"""Pairs whose labels an audit doubts."""

from __future__ import annotations

import pytest

from annotations.auditing import FoundPair, store_findings
from annotations.labelling import collect, label
from annotations.language.auditing import LabelledPair, Reason, Suspect
from annotations.language.auditing.findings import Finding
from annotations.models import AuditFinding, Paraphrase, Utterance, Verdict
from annotations.models.worlds import Role
from tests.conftest import member
from tests.sample_world import make_paraphrase

MALE = '( say ( count ( lambda $1 e ( person $1 ) ( male $1 ) ( at $1 " <room> " ) ) ) )'
FEMALE = MALE.replace("male", "female")
GO = '( go " <room> " )'


def say(world, utterance: str, form: str = MALE, **columns) -> Paraphrase:
    """Store a paraphrase that names the kitchen."""
    return make_paraphrase(
        world,
        prompt="tell me how many people in the kitchen are girls",
        utterance=utterance,
        logical_form=form,
        grounded_form=form.replace("<room>", "kitchen"),
        **columns,
    )


def found(row: Paraphrase | Utterance, suggested: str = FEMALE, *reasons: Reason) -> FoundPair:
    """What an audit says against the label of ``row``."""
    name = "utterance" if isinstance(row, Utterance) else "paraphrase"
    text = row.anonymized_text if name == "utterance" else row.utterance
    pair = LabelledPair(f"{name}-{row.pk}", text, row.logical_form, "how many girls", suggested)
    findings = [
        Finding(pair, reason, f"The {reason} says so.", suggested, 1.0)
        for reason in reasons or (Reason.COMMAND,)
    ]
    return FoundPair((name, row.pk), Suspect(pair, tuple(findings)))


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
    store_findings(world, [found(girls), found(women)], to_queue=2)
    return world.audit_findings


@pytest.fixture
def berta(world):
    return member(world, "berta", Role.ANNOTATOR)
