"""The label of a paraphrase is corrected, with history, and splits keep the old one."""

from __future__ import annotations

import pytest

from annotations.editing.edits import Overtaken
from annotations.labelling.audit_findings import store_findings
from annotations.labelling.enqueuing import WantedItem, enqueue
from annotations.labelling.giving import NotForThem
from annotations.labelling.label_decisions import correct_label
from annotations.language.texts.errors import LanguageError
from annotations.models import WorkItem, WorkKind
from annotations.rows.history import entry_at
from tests.doubted_labels import doubt
from tests.sample_world import make_paraphrase

BEFORE, AFTER = '( go " <room> " )', '( find " <room> " )'


@pytest.fixture
def row(world):
    return make_paraphrase(world, logical_form=BEFORE, grounded_form='( go " kitchen " )')


def test_a_label_in_any_notation_becomes_the_next_version(row, reviewer):
    stored = correct_label(row, '(find "<room>")', reviewer, row.version)
    assert (stored.logical_form, stored.grounded_form) == (AFTER, '( find " kitchen " )')
    assert stored.version == row.version + 1
    assert entry_at(stored, row.version).logical_form == BEFORE


def test_a_label_may_become_unknown(row, reviewer):
    stored = correct_label(row, " UNKNOWN ", reviewer, row.version)
    assert (stored.logical_form, stored.grounded_form) == ("UNKNOWN", "UNKNOWN")
    assert correct_label(stored, BEFORE, reviewer, stored.version).logical_form == BEFORE


def test_what_the_queue_asks_about_it_is_done(row, annotator):
    enqueue(row.world, WorkKind.REQUESTED, [WantedItem(row, "Is that right?")])
    correct_label(row, AFTER, annotator, row.version)
    assert not WorkItem.objects.open().exists()


def test_a_finding_of_an_audit_is_decided_by_it(row, reviewer):
    store_findings(row.world, [doubt(row, "UNKNOWN")])
    correct_label(row, AFTER, reviewer, row.version)
    finding = row.audit_findings.get()
    assert (finding.status, finding.decided_form) == ("corrected", AFTER)


def test_the_same_label_changes_nothing(row, reviewer):
    enqueue(row.world, WorkKind.REQUESTED, [WantedItem(row, "Is that right?")])
    assert correct_label(row, BEFORE, reviewer, row.version).version == row.version
    assert WorkItem.objects.open().exists()


def test_an_older_version_is_refused(row, reviewer):
    correct_label(row, AFTER, reviewer, row.version)
    row.refresh_from_db()
    with pytest.raises(Overtaken):
        correct_label(row, '( say " <room> " )', reviewer, row.version - 1)


@pytest.mark.parametrize("text", ["", "( go", "(go $room)"])
def test_what_is_no_label_is_refused(row, reviewer, text):
    with pytest.raises(LanguageError):
        correct_label(row, text, reviewer, row.version)


def test_people_of_other_worlds_do_not_correct(row, stranger):
    with pytest.raises(NotForThem):
        correct_label(row, AFTER, stranger, row.version)
