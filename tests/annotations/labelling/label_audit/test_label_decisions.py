"""Keep, correct or exclude a pair whose label an audit doubts; take it back."""

from __future__ import annotations

import pytest

from annotations.editing.edits import change
from annotations.generation.freezing import freeze_split
from annotations.labelling.giving import NotForThem, next_item
from annotations.labelling.item_answers import answer
from annotations.labelling.label_changes import examples_before
from annotations.labelling.label_decisions import DecidedMeanwhile, decide, take_back_decision
from annotations.labelling.utterance_deletion import delete_utterances
from annotations.language.texts.errors import LanguageError, Refusal
from annotations.models import (
    AuditDecision,
    AuditFinding,
    FindingStatus,
    Label,
    Paraphrase,
    Verdict,
    WorkKind,
)
from annotations.rows.history import history_of
from tests.annotations.labelling.label_audit.conftest import finding_of
from tests.doubted_labels import FEMALE, GO, MALE, say

KEEP, CORRECT, EXCLUDE = FindingStatus.KEPT, FindingStatus.CORRECTED, FindingStatus.EXCLUDED
EVERY = (KEEP, CORRECT, EXCLUDE)


def state_of(row) -> tuple[str, str, str]:
    row.refresh_from_db()
    return row.status, row.logical_form, getattr(row, "grounded_form", "")


def test_a_kept_label_stays(findings, girls, annotator):
    before = state_of(girls)
    made = decide(finding_of(girls), KEEP, annotator, reason="  it is   fine ")
    assert (made.reason, made.decided_by, made.form) == ("it is fine", annotator, MALE)
    assert state_of(girls) == before and girls.version == 1
    assert finding_of(girls).status == KEEP


def test_the_offered_form_becomes_the_label_of_a_paraphrase_with_its_entities(
    findings, girls, annotator
):
    decide(finding_of(girls), CORRECT, annotator)
    assert state_of(girls) == ("accepted", FEMALE, FEMALE.replace("<room>", "kitchen"))
    entry = history_of(Paraphrase).filter(id=girls.pk).first()
    assert (entry.history_user, entry.logical_form) == (annotator, FEMALE)


def test_another_form_becomes_the_label(findings, girls, annotator):
    decide(finding_of(girls), CORRECT, annotator, form='(go "<room>")')
    assert state_of(girls)[1:] == (GO, '( go " kitchen " )')


def test_what_no_form_says_becomes_unknown(findings, girls, women, annotator):
    for row in (girls, women):
        decide(finding_of(row), CORRECT, annotator, form="UNKNOWN")
    assert state_of(girls) == ("accepted", "UNKNOWN", "UNKNOWN")
    assert state_of(women)[0] == "unknown"
    assert women.accepted_label.verdict == Verdict.UNKNOWN
    assert finding_of(women).decided_form == "UNKNOWN"
    take_back_decision(finding_of(women).decision, annotator)
    assert state_of(women)[:2] == ("labelled", MALE)


def test_an_utterance_gets_an_answer_with_the_reason(findings, women, annotator):
    made = decide(finding_of(women), CORRECT, annotator, reason="women")
    assert state_of(women)[:2] == ("labelled", FEMALE)
    assert (made.label, made.label.reason) == (women.accepted_label, "women")


def test_what_is_excluded_stays_out_of_new_splits(world, findings, girls, women, annotator):
    say(world, "go there", GO)
    say(world, "walk there", GO)
    kept = say(world, "count the boys")
    before = freeze_split(world, "before")
    for row in (girls, women):
        decide(finding_of(row), EXCLUDE, annotator)
    after = freeze_split(world, "after")
    texts = {each.utterance for each in after.examples.all()}
    assert texts == {"go there", "walk there", kept.utterance}
    assert {each.utterance for each in examples_before(before)} == {girls.utterance, women.text}
    assert not examples_before(after).exists()


@pytest.mark.parametrize("decision", EVERY)
@pytest.mark.parametrize("name", ["girls", "women"])
def test_taken_back_it_is_as_before(decision, name, findings, annotator, request):
    row = request.getfixturevalue(name)
    before = state_of(row)
    made = decide(finding_of(row), decision, annotator)
    assert take_back_decision(made, annotator).is_open
    assert state_of(row) == before
    assert finding_of(row) in findings.open()
    assert finding_of(row).decision is None and AuditDecision.objects.count() == 1
    with pytest.raises(Refusal) as refused:
        take_back_decision(made, annotator)
    assert (refused.value.code, refused.value.status) == ("already_taken_back", 409)


def test_only_who_decided_takes_it_back(findings, girls, annotator, berta):
    made = decide(finding_of(girls), KEEP, annotator)
    with pytest.raises(Refusal) as refused:
        take_back_decision(made, berta)
    assert (refused.value.code, refused.value.status) == ("not_their_decision", 409)
    assert finding_of(girls).status == KEEP


def test_nothing_that_others_did_since_is_undone(findings, girls, women, annotator, berta):
    corrected = decide(finding_of(girls), CORRECT, annotator)
    girls.refresh_from_db()
    change(girls, {"logical_form": GO}, berta, girls.version)
    kept = decide(finding_of(women), KEEP, annotator)
    answer(women, Verdict.FORM, GO, berta, women.version)
    for made in (corrected, kept):
        with pytest.raises(Refusal) as refused:
            take_back_decision(made, annotator)
        assert (refused.value.code, refused.value.status) == ("changed_since", 409)
    assert [state_of(girls)[1], state_of(women)[1]] == [GO, GO]


def test_the_second_decision_is_refused(findings, girls, annotator, berta):
    decide(finding_of(girls), KEEP, annotator)
    with pytest.raises(DecidedMeanwhile, match=annotator.username):
        decide(finding_of(girls), EXCLUDE, berta)
    assert state_of(girls)[0] == "accepted"


def test_nothing_is_decided_about_a_deleted_utterance(findings, women, annotator):
    made = decide(finding_of(women), KEEP, annotator)
    delete_utterances([women.pk], annotator)
    with pytest.raises(Refusal):
        take_back_decision(made, annotator)
    AuditFinding.objects.filter(utterance=women).update(status=FindingStatus.OPEN)
    AuditDecision.objects.all().delete()
    with pytest.raises(DecidedMeanwhile) as refused:
        decide(finding_of(women), KEEP, annotator)
    assert refused.value.code == "deleted_since"


def test_a_label_that_has_changed_is_not_doubted_any_more(findings, girls, annotator):
    change(girls, {"logical_form": GO}, annotator, girls.version)
    assert finding_of(girls) not in findings.open()
    with pytest.raises(DecidedMeanwhile) as refused:
        decide(finding_of(girls), KEEP, annotator)
    assert refused.value.code == "changed_since"


@pytest.mark.parametrize(
    ("decision", "form", "error"),
    [
        ("open", "", ValueError),
        (CORRECT, MALE, ValueError),
        (CORRECT, "(go", LanguageError),
        (CORRECT, "(go $room)", LanguageError),
    ],
)
def test_what_is_no_decision_changes_nothing(decision, form, error, findings, girls, annotator):
    with pytest.raises(error):
        decide(finding_of(girls), decision, annotator, form)
    assert finding_of(girls).is_open and state_of(girls)[1] == MALE
    assert not AuditDecision.objects.exists()


def test_nobody_decides_without_a_role(findings, girls, stranger):
    with pytest.raises(NotForThem):
        decide(finding_of(girls), KEEP, stranger)


def test_a_reviewer_gets_audits_from_the_queue(world, findings, girls, reviewer):
    part = next_item(reviewer, world)
    assert (part.item.kind, part.item.open_finding) == (WorkKind.AUDIT, finding_of(girls))


def test_a_decision_ends_the_item_and_taking_it_back_opens_it(world, findings, girls, annotator):
    held = next_item(annotator, world)
    made = decide(finding_of(girls), EXCLUDE, annotator)
    held.item.refresh_from_db()
    assert held.item.closed_at and held.item.assignments.get().outcome == "done"
    take_back_decision(made, annotator)
    assert next_item(annotator, world).item == held.item


def test_a_decision_ends_the_item_of_somebody_else(world, findings, girls, annotator, berta):
    held = next_item(berta, world)
    made = decide(finding_of(girls), KEEP, annotator)
    assert next_item(berta, world).item != held.item
    take_back_decision(made, annotator)
    assert world.work_items.open().count() == 2


def test_labelling_an_utterance_anew_ends_the_doubt(world, findings, girls, women, annotator):
    answer(women, Verdict.FORM, GO, annotator, women.version)
    decide(finding_of(girls), KEEP, annotator)
    assert next_item(annotator, world) is None
    assert not world.work_items.open().exists()
    assert Label.objects.filter(utterance=women, form=GO).exists()
