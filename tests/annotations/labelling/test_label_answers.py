"""Answers: what they make of an utterance, and that taking one back is exact."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import AnsweredMeanwhile, accept, label, take_back_label
from annotations.language.texts.errors import Refusal
from annotations.models import Label, Utterance, Verdict

BRING = '(bring (λ$1:e (is_a $1 "<object>")))'
CANONICAL = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
GO = '( go " <room> " )'


@pytest.fixture
def utterance(tiny_world, annotator) -> Utterance:
    collect(tiny_world, ["bring me tea"], by=annotator)
    return tiny_world.utterances.get()


def state_of(utterance: Utterance) -> tuple[str, str]:
    stored = Utterance.objects.get(pk=utterance.pk)
    return stored.status, stored.logical_form


def test_a_form_is_stored_in_canonical_text_with_its_time(utterance, annotator):
    row = label(utterance, Verdict.FORM, BRING, annotator, 1, seconds=4.5)
    assert row.seconds == 4.5
    assert state_of(utterance) == ("labelled", CANONICAL)


def test_the_second_of_two_people_is_told(utterance, annotator, admin):
    label(utterance, Verdict.FORM, BRING, annotator, 1)
    with pytest.raises(AnsweredMeanwhile, match=annotator.username) as clash:
        label(utterance, Verdict.FORM, GO, admin, 1)
    assert clash.value.current.logical_form == CANONICAL
    assert Label.objects.count() == 1


def test_a_skip_decides_nothing_and_goes_to_others(utterance, annotator, admin, tiny_world):
    label(utterance, Verdict.SKIP, "", annotator, 99)
    assert state_of(utterance) == ("unlabelled", "")
    assert not tiny_world.utterances.unlabelled().unanswered_by(annotator)
    assert tiny_world.utterances.unlabelled().unanswered_by(admin).count() == 1


def test_blind_answers_decide_once_one_is_accepted(utterance, annotator, admin):
    first = label(utterance, Verdict.FORM, BRING, annotator, 1, is_blind=True)
    label(utterance, Verdict.FORM, GO, admin, 1, is_blind=True)
    assert state_of(utterance) == ("unlabelled", "")
    accept(first, admin)
    assert state_of(utterance) == ("labelled", CANONICAL)


@pytest.mark.parametrize(
    ("verdict", "form", "code", "named"),
    [
        ("form", "(bring", "unreadable", None),
        ("form", "(bring {kobject})", "unreadable", "<object>"),
        ("form", '($vbbring "<object>")', "unreadable", "<object>"),
        ("form", "UNKNOWN", "unreadable", "UNKNOWN"),
        ("form", "x" * 6000, "unreadable", "6,000"),
        ("dispute", "", "no_reason", None),
        ("maybe", "", "no_such_answer", "'maybe'"),
    ],
)
def test_what_is_no_answer_is_refused(utterance, annotator, verdict, form, code, named):
    with pytest.raises(Refusal, match=named) as refused:
        label(utterance, verdict, form, annotator, 1)
    assert refused.value.code == code
    assert not Label.objects.exists()


def test_only_the_person_takes_an_answer_back_and_once(utterance, annotator, admin):
    row = label(utterance, Verdict.UNKNOWN, "", annotator, 1)
    with pytest.raises(Refusal) as refused:
        take_back_label(row, admin)
    assert (refused.value.code, refused.value.status) == ("not_their_answer", 409)
    take_back_label(row, annotator)
    with pytest.raises(Refusal) as refused:
        take_back_label(row, annotator)
    assert (refused.value.code, refused.value.status) == ("already_taken_back", 409)


ANSWERS = st.tuples(
    st.sampled_from(
        [("form", BRING), ("form", GO), ("unknown", ""), ("skip", ""), ("dispute", "")]
    ),
    st.booleans(),
)


@settings(
    max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None
)
@given(answers=st.lists(ANSWERS, max_size=6))
def test_taking_back_brings_back_what_was_there(utterance, annotator, answers):
    Label.objects.all().delete()
    Utterance.objects.update(status="unlabelled", logical_form="")
    states, rows = [state_of(utterance)], []
    for (verdict, form), is_blind in answers:
        version = Utterance.objects.get(pk=utterance.pk).version
        rows.append(label(utterance, verdict, form, annotator, version, None, "why", is_blind))
        states.append(state_of(utterance))
    for row in reversed(rows):
        assert state_of(utterance) == states.pop()
        take_back_label(row, annotator)
    assert state_of(utterance) == ("unlabelled", "")
