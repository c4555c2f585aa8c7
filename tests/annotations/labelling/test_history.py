"""The versions of an utterance: who made each, and that any of them comes back with its answer."""

from __future__ import annotations

import pytest

from annotations.editing.row_versions import history_of_row
from annotations.labelling.collecting import collect
from annotations.labelling.entity_spans import mend_span
from annotations.labelling.label_answers import label, restore_utterance, take_back_label
from annotations.models import Label, Utterance, Verdict
from annotations.rows.row_kinds import KINDS
from tests.annotations.labelling.test_label_answers import BRING, CANONICAL, GO, state_of


@pytest.fixture
def utterance(tiny_world, annotator) -> Utterance:
    collect(tiny_world, ["bring me tea", "bring me a cuppa"], by=annotator)
    return tiny_world.utterances.first()


def versions_of(utterance):
    return history_of_row(KINDS["utterance"], utterance.world, utterance.pk).versions


def entry_of(utterance, version):
    return utterance.history.filter(version=version).latest("history_id")


def test_each_answer_that_counts_is_a_version_with_its_author(utterance, annotator, admin):
    label(utterance, Verdict.FORM, BRING, annotator, 1)
    label(utterance, Verdict.SKIP, "", admin, 2)
    last = label(utterance, Verdict.FORM, GO, admin, 2)
    take_back_label(last, admin)
    versions = versions_of(utterance)
    assert [(each.number, each.author) for each in versions] == [
        (4, admin),
        (3, admin),
        (2, annotator),
        (1, None),
    ]
    assert versions[0].is_current
    assert {change.label for change in versions[2].changes} == {"Status", "Logical form"}


def test_an_older_version_is_restored_with_its_answer(utterance, annotator, admin):
    label(utterance, Verdict.FORM, BRING, annotator, 1)
    label(utterance, Verdict.FORM, GO, admin, 2)
    restored = restore_utterance(entry_of(utterance, 2), admin)
    assert state_of(utterance) == ("labelled", CANONICAL)
    assert restored.version == 4
    assert restored.accepted_label.annotator == admin
    take_back_label(restored.accepted_label, admin)
    assert state_of(utterance) == ("labelled", GO)


def test_the_first_version_is_restored_without_an_answer(utterance, annotator, admin):
    given = label(utterance, Verdict.FORM, BRING, annotator, 1)
    restore_utterance(entry_of(utterance, 1), admin)
    assert state_of(utterance) == ("unlabelled", "")
    assert Label.objects.get() == given
    label(utterance, Verdict.FORM, BRING, annotator, 3)
    assert state_of(utterance) == ("labelled", CANONICAL)


def test_a_mended_span_is_a_version_of_all_that_it_changes(utterance, tiny_world, annotator):
    other = tiny_world.utterances.last()
    collect(tiny_world, ["take the cuppa"], by=annotator)
    third = tiny_world.utterances.last()
    entity = tiny_world.ontology.entities.get(text="tea")
    start = other.text.index("cuppa")
    mended = mend_span(other, start, len(other.text), entity, annotator, 1)
    assert mended.anonymized_text == "bring me a <object>"
    for row in (other, third):
        assert [(each.number, each.author) for each in versions_of(row)] == [
            (2, annotator),
            (1, None),
        ]
    assert versions_of(utterance) == ()
    again = restore_utterance(entry_of(other, 1), annotator)
    assert (again.anonymized_text, again.spans) == (other.text, [])


def test_the_history_page_restores(utterance, anna, annotator):
    label(utterance, Verdict.FORM, BRING, annotator, 1)
    path = f"/w/home/history/utterance/{utterance.pk}/"
    page = anna.get(path).content.decode()
    assert 'name="entry"' in page and "anna" in page
    assert path in anna.get(f"/w/home/utterances/{utterance.pk}/").content.decode()
    anna.post(path, {"entry": entry_of(utterance, 1).history_id})
    assert state_of(utterance) == ("unlabelled", "")
