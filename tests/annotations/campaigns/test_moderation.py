from __future__ import annotations

import pytest

from annotations.campaigns.answering import save_answer
from annotations.campaigns.closing import forget
from annotations.campaigns.moderation import (
    DecidedAlready,
    accept,
    accept_with_doubt,
    accept_with_form,
    mend,
    reject,
    take_back_moderation,
)
from annotations.campaigns.progress import progress_of
from annotations.campaigns.tasks import begin
from annotations.editing.edits import change
from annotations.labelling.collecting import collect
from annotations.language.corpus import distance
from annotations.language.texts.errors import LanguageError, Refusal
from annotations.models import Origin, Paraphrase, Submission, Utterance
from annotations.rows.history import history_of
from tests.at_once import at_once


@pytest.fixture
def submissions(launched) -> list[Submission]:
    """Three rewrites and a free command, each with a text of its own."""
    contributor = begin(launched(task_size=3, free_commands=1), "somebody")
    places = contributor.submissions.order_by("position")
    return [save_answer(place, f"do number {place.position}", 9) for place in places]


def reread(row: Submission) -> Submission:
    return Submission.objects.get(pk=row.pk)


def test_accepted_rewrites_become_paraphrases(submissions, admin):
    first, *_ = submissions
    assert accept(submissions[:3], admin) == 3
    made = Paraphrase.objects.get(pk=reread(first).paraphrase_id)
    prompt = first.prompt
    assert (made.utterance, made.prompt, made.status) == (first.text, prompt.prompt, "accepted")
    assert (made.logical_form, made.command) == (prompt.logical_form, prompt.command)
    assert made.contributor == first.contributor
    apart = distance(first.text, prompt.prompt)
    assert (made.edit_distance, made.jaccard_distance) == (apart.edit, apart.jaccard)
    assert made.history.count() == 1
    assert len(set(Paraphrase.objects.values_list("position", flat=True))) == 3
    assert reread(first).decided_by == admin
    assert progress_of(first.contributor.campaign).accepted == 3


def test_an_accepted_free_command_waits_to_be_labelled(submissions, admin):
    accept([submissions[3]], admin)
    utterance = Utterance.objects.get()
    assert (utterance.text, utterance.origin) == ("do number 4", Origin.CONTRIBUTOR)
    assert reread(submissions[3]).utterance == utterance


def test_a_decision_counts_once(submissions, admin):
    assert accept(submissions[:2], admin) == 2
    assert accept(submissions[:3], admin) == 1
    assert reject(submissions[:3], admin) == 0
    assert Paraphrase.objects.count() == 3


@pytest.mark.django_db(transaction=True)
def test_two_who_decide_at_once_decide_once(submissions, admin):
    decided = at_once(lambda: accept(submissions, admin), lambda: reject(submissions, admin))
    assert sorted(decided) == [0, 4]
    assert Paraphrase.objects.count() in (0, 3)


def test_a_decision_is_taken_back(submissions, admin):
    accept(submissions, admin)
    for row in submissions:
        assert take_back_moderation(row, admin).status == "pending"
    assert not Paraphrase.objects.exists()
    assert not Utterance.objects.exists()
    reject(submissions[:1], admin)
    take_back_moderation(submissions[0], admin)
    with pytest.raises(Refusal) as refused:
        take_back_moderation(submissions[0], admin)
    assert refused.value.code == "not_decided"
    assert accept(submissions, admin) == 4
    assert Utterance.objects.count() == 1


def test_what_was_edited_since_is_not_taken_back(submissions, admin):
    accept(submissions[:1], admin)
    row = Paraphrase.objects.get()
    change(row, {"utterance": "another"}, admin, row.version)
    with pytest.raises(Refusal) as refused:
        take_back_moderation(submissions[0], admin)
    assert refused.value.code == "edited_since"
    assert reread(submissions[0]).status == "accepted"


def test_a_typing_error_is_mended_and_what_was_written_is_kept(submissions, admin):
    mended = mend(submissions[0], " do number  one ")
    assert (mended.text, mended.raw) == ("do number one", "do number 1")
    assert (mend(mended, "do it").raw, reread(mended).text) == ("do number 1", "do it")
    for text in ("", "word " * 200):
        with pytest.raises(Refusal):
            mend(mended, text)
    accept([mended], admin)
    with pytest.raises(DecidedAlready):
        mend(mended, "do that")


def test_mending_a_name_takes_its_flag_away(submissions):
    row = Submission.objects.exclude(prompt__entities=[]).exclude(prompt=None).first()
    save_answer(row, "do something else", 9)
    assert "lost_entity" in {flag["code"] for flag in reread(row).flags}
    names = " and ".join(entity["text"] for entity in row.prompt.entities)
    assert "lost_entity" not in {flag["code"] for flag in mend(row, f"do it with {names}").flags}


def test_a_rewrite_that_asks_for_something_else_gets_that_form(submissions, admin):
    with pytest.raises(LanguageError):
        accept_with_form(submissions[0], "( go", admin)
    assert reread(submissions[0]).status == "pending"
    accept_with_form(submissions[0], '(go "<room>")', admin)
    made = Paraphrase.objects.get()
    assert made.logical_form == '( go " <room> " )'
    assert made.command is None
    with pytest.raises(Refusal) as refused:
        accept_with_form(submissions[3], '(go "<room>")', admin)
    assert refused.value.code == "no_rewrite"


def test_a_doubted_label_goes_to_the_audit(submissions, admin):
    accept_with_doubt(submissions[0], "it says less", admin)
    finding = Paraphrase.objects.get().audit_findings.get()
    assert finding.status == "open"
    with pytest.raises(DecidedAlready):
        accept_with_doubt(submissions[0], "again", admin)


def test_who_is_forgotten_leaves_no_decision_that_was_taken_back(submissions, admin):
    accept(submissions, admin)
    for row in submissions:
        take_back_moderation(row, admin)
    assert Utterance.with_deleted.exists()
    assert forget(submissions[0].contributor) == 4
    assert not Utterance.with_deleted.exists()
    assert not history_of(Utterance).exists()
    assert not history_of(Paraphrase).exists()


@pytest.fixture
def same(launched, admin) -> tuple[Submission, Submission]:
    """The same free command, accepted of two contributors; the first one's has the utterance."""
    campaign = launched(task_size=1, free_commands=1)
    rows = []
    for name in ("one", "two"):
        place = begin(campaign, name).submissions.get(kind="free")
        rows.append(save_answer(place, "water the plants on the balcony", 9))
    accept(rows, admin)
    return reread(rows[0]), reread(rows[1])


def test_an_utterance_that_was_here_before_is_not_theirs(launched, household, admin):
    text = "please close every door on the third floor"
    collect(household, [text], by=admin)
    contributor = begin(launched(task_size=1, free_commands=1), "somebody")
    row = save_answer(contributor.submissions.get(kind="free"), text, 9)
    accept([row], admin)
    assert reread(row).utterance is None
    take_back_moderation(reread(row), admin)
    accept([reread(row)], admin)
    forget(contributor)
    assert Utterance.objects.get(text=text).origin == Origin.PASTED


@pytest.mark.parametrize("goes", [take_back_moderation, None])
def test_what_two_people_say_stays_while_one_of_them_does(same, admin, goes):
    first, second = same
    utterance = first.utterance
    assert utterance and second.utterance is None
    for row, other in ((first, second), (second, None)):
        if goes is None:
            forget(row.contributor)
        else:
            take_back_moderation(reread(row), admin)
        if other is not None:
            assert reread(other).utterance == utterance
    assert not Utterance.objects.exists()
