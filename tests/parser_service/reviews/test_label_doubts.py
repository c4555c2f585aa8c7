"""A wrong label goes to the work queue."""

from __future__ import annotations

import pytest

from annotations.labelling.audit_findings import store_findings
from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import label
from annotations.labelling.label_decisions import decide
from annotations.language.texts.errors import Refusal
from annotations.models import FindingStatus, Paraphrase, Verdict
from parser_service.reviews.label_doubts import doubt_label
from tests.sample_world import make_paraphrase

GO = '( go " <room> " )'
IN_DOUBT = "In the work queue, as a label in doubt."
SENT = "1 item added to the work queue."


@pytest.fixture
def pair(run, wrong) -> Paraphrase:
    """The paraphrase that the example was copied from."""
    forms = {"logical_form": wrong.logical_form, "grounded_form": wrong.logical_form}
    return make_paraphrase(run.world, "go", wrong.utterance, **forms)


def item_of(run):
    return run.world.work_items.get()


def test_a_paraphrase_becomes_a_label_in_doubt_with_the_right_form(run, wrong, pair, reviewer):
    assert doubt_label(wrong, " It says\n go. ", reviewer, "go(⟨room⟩)") == IN_DOUBT
    item = item_of(run)
    assert (item.kind, item.paraphrase) == ("audit", pair)
    assert item.reason.startswith("rene ") and item.reason.endswith(" It says go.")
    assert item.open_finding.suggested_form == GO
    assert item.open_finding.doubts == ["a reviewer"]


def test_the_corrected_label_is_that_of_the_paraphrase(run, wrong, pair, reviewer, annotator):
    doubt_label(wrong, "It says go.", reviewer, GO)
    decide(item_of(run).open_finding, FindingStatus.CORRECTED, annotator)
    pair.refresh_from_db()
    assert pair.logical_form == GO and not item_of(run).is_open
    wrong.refresh_from_db()
    assert wrong.logical_form != GO  # the split stays as it was
    with pytest.raises(Refusal) as refused:
        doubt_label(wrong, "Once more.", reviewer)
    assert refused.value.code == "label_changed"


def test_without_a_form_somebody_else_writes_it(run, wrong, pair, reviewer):
    doubt_label(wrong, "Odd.", reviewer)
    assert not item_of(run).open_finding.offers_form


def test_a_second_doubt_is_a_further_reason(run, wrong, pair, reviewer, admin):
    doubt_label(wrong, "Odd.", reviewer)
    doubt_label(wrong, "It says go.", admin, GO)
    finding = item_of(run).open_finding
    assert finding.reasons.count() == 2 and finding.suggested_form == GO


def test_an_audit_leaves_what_reviewers_doubt(run, wrong, pair, reviewer):
    doubt_label(wrong, "Odd.", reviewer)
    store_findings(run.world, [])
    sentence = item_of(run).open_finding.reasons.get().sentence
    assert sentence.startswith("rene ") and sentence.endswith(" Odd.")


def test_a_labelled_utterance_becomes_a_label_in_doubt(run, wrong, reviewer, annotator):
    collect(run.world, [wrong.utterance], by=annotator)
    row = run.world.utterances.get()
    label(row, Verdict.FORM, wrong.logical_form, annotator, row.version)
    assert doubt_label(wrong, "Odd.", reviewer) == IN_DOUBT
    assert (item_of(run).kind, item_of(run).utterance) == ("audit", row)


def test_a_generated_command_leads_to_its_template(run, reviewer):
    command = run.world.commands.filter(template__isnull=False).first()
    example = run.split.examples.filter(source="generated").first()
    example.utterance, example.logical_form = command.anonymized_text, command.logical_form.text
    assert doubt_label(example, "Odd.", reviewer) == SENT
    item = item_of(run)
    assert (item.kind, item.template) == ("requested", command.template)
    assert "1 " in doubt_label(example, "Odd again.", reviewer)
    assert item_of(run) == item
    example.logical_form = "UNKNOWN"
    with pytest.raises(Refusal) as refused:
        doubt_label(example, "Odd.", reviewer)
    assert refused.value.code == "label_changed"


def test_what_nothing_is_behind_is_collected(run, wrong, reviewer):
    assert doubt_label(wrong, "Odd.", reviewer) == SENT
    row = run.world.utterances.get()
    assert (row.text, row.origin) == (wrong.utterance, "review")
    assert item_of(run).utterance == row
    assert item_of(run).reason.startswith("rene ") and item_of(run).reason.endswith(" Odd.")


@pytest.mark.parametrize(
    ("reason", "form", "code"),
    [(" \0 ", "", "reason_missing"), ("Odd.", "( go (", "suggested_form_unreadable")],
)
def test_what_cannot_be_stored_is_refused(reason, form, code, run, wrong, reviewer):
    with pytest.raises(Refusal) as refused:
        doubt_label(wrong, reason, reviewer, form)
    assert refused.value.code == code
    assert not run.world.work_items.exists()
