"""Findings of an audit replace those of the one before; what people have decided stays."""

from __future__ import annotations

from annotations.editing.edits import change
from annotations.labelling.audit_findings import store_findings
from annotations.labelling.label_decisions import decide, take_back_decision
from annotations.language.corpus.label_errors import Reason
from annotations.models import FindingStatus, WorkKind
from tests.annotations.labelling.label_audit.conftest import finding_of
from tests.doubted_labels import FEMALE, GO, MALE, doubt, say


def test_a_finding_says_what_the_audit_said(world, girls):
    stored = store_findings(world, [doubt(girls, FEMALE, Reason.COMMAND, Reason.WORD)])
    assert (stored.open, stored.new, stored.decided, stored.queued) == (1, 1, 0, 0)
    row = finding_of(girls)
    assert (row.text, row.form, row.suggested_form) == (girls.utterance, MALE, FEMALE)
    assert (row.rank, row.score, row.source_command) == (1, 2.0, "how many girls")
    assert [each.reason for each in row.reasons.all()] == ["command", "word"]
    assert list(world.audit_findings.with_reason("word")) == [row]
    assert not world.audit_findings.with_reason("parser").exists()


def test_the_first_ones_go_into_the_work_queue_with_the_reason(world, girls, women):
    suspects = [doubt(women, FEMALE, Reason.WORD, Reason.COMMAND), doubt(girls)]
    assert store_findings(world, suspects, to_queue=1).queued == 1
    item = world.work_items.get()
    assert (item.kind, item.utterance) == (WorkKind.AUDIT, women)
    assert item.reason == (
        "The command behind it has another form and a word of it contradicts the form."
    )


def test_an_audit_replaces_what_nobody_has_decided(world, findings, girls, women):
    first = finding_of(women)
    stored = store_findings(world, [doubt(women, GO, Reason.PARSER)])
    assert (stored.open, stored.new) == (1, 0)
    row = findings.get()
    assert (row.pk, row.rank, row.suggested_form) == (first.pk, 1, GO)
    assert row.reasons.get().reason == "parser"
    assert world.work_items.open().get().utterance == women


def test_what_is_decided_does_not_come_back(world, findings, girls, women, annotator):
    decide(finding_of(girls), FindingStatus.KEPT, annotator)
    decide(finding_of(women), FindingStatus.CORRECTED, annotator)
    for row in (girls, women):
        row.refresh_from_db()
    stored = store_findings(world, [doubt(girls), doubt(women, MALE)])
    assert (stored.open, stored.decided) == (0, 2)
    assert findings.count() == 2 and not world.work_items.open().exists()


def test_it_comes_back_once_its_label_has_changed(world, findings, girls, annotator):
    decide(finding_of(girls), FindingStatus.KEPT, annotator)
    girls.refresh_from_db()
    changed = change(girls, {"logical_form": GO}, annotator, girls.version)
    assert store_findings(world, [doubt(changed)]).new == 1
    assert [row.form for row in girls.audit_findings.open()] == [GO]


def test_a_pair_that_is_accepted_again_after_it_was_excluded_comes_back(
    world, findings, girls, annotator
):
    decide(finding_of(girls), FindingStatus.EXCLUDED, annotator)
    girls.refresh_from_db()
    change(girls, {"status": "accepted"}, annotator, girls.version)
    assert store_findings(world, [doubt(girls)]).new == 1


def test_a_decision_of_before_is_taken_back_beside_a_newer_audit(world, findings, girls, annotator):
    made = decide(finding_of(girls), FindingStatus.KEPT, annotator)
    girls.refresh_from_db()
    changed = change(girls, {"logical_form": GO}, annotator, girls.version)
    store_findings(world, [doubt(changed)])
    change(girls, {"logical_form": MALE}, annotator, changed.version)
    take_back_decision(made, annotator)
    assert girls.audit_findings.get().decisions.get() == made


def test_a_pair_that_is_gone_meanwhile_is_left_out(world, girls, women):
    suspects = [doubt(girls), doubt(women)]
    girls.delete()
    assert store_findings(world, suspects).open == 1


def test_many_findings_cost_few_queries(world, django_assert_max_num_queries):
    suspects = [doubt(say(world, f"girls {number}")) for number in range(40)]
    with django_assert_max_num_queries(20):
        store_findings(world, suspects)
    with django_assert_max_num_queries(20):
        store_findings(world, suspects)
