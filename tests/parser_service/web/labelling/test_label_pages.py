"""The labelling page as a browser without scripts and as its own script see it."""

from __future__ import annotations

import pytest

from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import label
from annotations.models import Entity, JobKind, Label, Proposal, Utterance, Verdict
from annotations.web.corpus.utterance_pages import SORTS

FIND = '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'
AS_SCRIPT = {"headers": {"accept": "application/json"}}


@pytest.fixture
def said(sample, annotator) -> list[Utterance]:
    collect(sample.world, ["find the tea", "go somewhere", "hello <b>there</b>"], by=annotator)
    return list(sample.world.utterances.order_by("pk"))


def url(row: Utterance, what: str) -> str:
    return f"/w/home/label/{row.pk}/{what}/"


def test_the_page_shows_the_next_utterance_with_its_candidates(said, anna):
    answer = anna.get("/w/home/label/")
    assert answer.context["row"] == said[0]
    assert answer.context["candidates"][0].form == FIND
    assert answer.context["candidates"][0].sources == ("grammar", "nearest utterance")
    assert "find the tea" in answer.content.decode()


def test_the_filters_of_the_url_hold(said, anna):
    assert anna.get("/w/home/label/?q=somewhere").context["row"] == said[1]
    assert anna.get("/w/home/label/?origin=review").context["row"] is None
    label(said[0], Verdict.UNKNOWN, "", said[0].created_by, 1)
    assert anna.get("/w/home/label/?status=unknown").context["row"] is None  # answered by herself
    assert anna.get(f"/w/home/label/?utterance={said[0].pk}").context["row"] == said[0]


def test_what_the_page_has_already_is_not_given_again(said, anna):
    answer = anna.get(f"/w/home/label/item/?without={said[0].pk},x,{said[1].pk}")
    assert answer.context["row"] == said[2]
    assert "hello &lt;b&gt;there" in answer.content.decode()


def test_a_form_sent_without_a_script_goes_on(said, anna):
    answer = anna.post(url(said[0], "answer"), {"form": FIND, "version": 1})
    assert answer.url == "/w/home/label/"
    assert Utterance.objects.get(pk=said[0].pk).logical_form == FIND


def test_a_clash_is_told_with_the_utterance(said, anna, admin):
    label(said[0], Verdict.UNKNOWN, "", admin, 1)
    answer = anna.post(url(said[0], "answer"), {"form": FIND, "version": 1}, **AS_SCRIPT)
    assert answer.status_code == 409
    assert "adam" in answer.json()["refusal"].split()
    answer = anna.post(url(said[0], "answer"), {"form": FIND, "version": 1})
    assert answer.url == f"/w/home/label/?utterance={said[0].pk}"


@pytest.mark.parametrize("sent", [{"form": "(go"}, {"verdict": "dispute"}, {}])
def test_what_is_no_answer_is_refused(said, anna, sent):
    answer = anna.post(url(said[0], "answer"), {**sent, "version": 1}, **AS_SCRIPT)
    assert answer.status_code == 422
    assert answer.json()["refusal"]
    assert not Label.objects.exists()


def test_the_last_answer_is_taken_back(said, anna):
    anna.post(url(said[0], "answer"), {"verdict": "unknown", "version": 1, "seconds": "2.5"})
    row = Label.objects.get()
    assert row.seconds == 2.5
    answer = anna.post(f"/w/home/label/answers/{row.pk}/take-back/", **AS_SCRIPT)
    assert answer.json()["utterance"] == said[0].pk
    assert Utterance.objects.get(pk=said[0].pk).status == "unlabelled"
    again = anna.post(f"/w/home/label/answers/{row.pk}/take-back/", **AS_SCRIPT)
    assert again.status_code == 409


def test_the_checker_knows_the_predicates_and_the_utterance(said, anna):
    answer = anna.post(url(said[0], "check"), {"form": '(fidn "<room>")'}).json()
    unknown, unnamed = answer["problems"]
    assert "fidn" in unknown["message"]
    assert unnamed["column"] == 9 and "room" in unnamed["message"]
    misspelt = {"form": '(fidn (λ$1:e (is_a $1 "<object>")))'}
    answer = anna.post(url(said[0], "check"), misspelt).json()
    repairs = [repair["label"] for repair in answer["problems"][0]["repairs"]]
    assert any("find" in label for label in repairs)
    for odd in ("(go", "UNKNOWN", "($v {room})", "x" * 9000, ""):
        assert anna.post(url(said[0], "check"), {"form": odd}).json()["problems"]


def test_an_utterance_of_a_review_is_sent_to_be_labelled(said, anna):
    for text in ("bring  me something", said[0].text):
        answer = anna.post("/w/home/label/send/", {"text": text})
        row = Utterance.objects.get(text=" ".join(text.split()))
        assert answer.url == f"/w/home/label/?utterance={row.pk}"
    assert Utterance.objects.get(text="bring me something").origin == "review"
    assert anna.post("/w/home/label/send/", {"text": "x" * 501}).url.endswith("/new/")


def test_words_become_an_alias(said, anna):
    sent = {"words": "Somewhere", "entity": "kitchen (room)", "version": 1}
    anna.post(url(said[1], "mend"), sent)
    assert Entity.objects.get(text="kitchen").aliases == ["somewhere"]
    assert Utterance.objects.get(pk=said[1].pk).anonymized_text == "go <room>"
    for wrong in ({"words": "nowhere"}, {"entity": "moon (room)"}, {"version": 1}):
        answer = anna.post(url(said[1], "mend"), {**sent, **wrong}, **AS_SCRIPT)
        assert answer.status_code in (409, 422)


@pytest.mark.parametrize(
    "text, words",
    [("take the Weißbier to the galley", "GALLEY"), ("put the Weißbier by my chai", "chai")],
)
def test_words_after_a_letter_that_folds_to_two_become_an_alias(
    sample, anna, annotator, text, words
):
    collect(sample.world, [text], by=annotator)
    row = sample.world.utterances.get(text=text)
    answer = anna.post(
        url(row, "mend"), {"words": words, "entity": "kitchen (room)", "version": 1}, **AS_SCRIPT
    )
    assert answer.status_code == 200
    assert Entity.objects.get(text="kitchen").aliases == [text.rpartition(" ")[2]]
    inside = {"words": "all", "entity": "kitchen (room)", "version": 2}
    assert anna.post(url(row, "mend"), inside, **AS_SCRIPT).status_code == 422


def test_every_order_of_the_list_is_one_of_its_columns(said, anna):
    for name in SORTS:
        assert anna.get(f"/w/home/utterances/?sort={name}").status_code == 200


def waits(anna, row):
    return anna.get(f"/w/home/label/item/?utterance={row.pk}&waiting")


def test_the_page_says_that_a_parser_is_asked_until_its_candidates_have_come(said, sample, anna):
    assert anna.get("/w/home/label/").context["awaited"] == "Nearest neighbour"
    assert waits(anna, said[0]).status_code == 204
    Proposal.objects.create(
        utterance=said[0], source="knn", run=sample.run.pk, rank=1, form=FIND, score=0
    )
    assert waits(anna, said[0]).context["has_come"] is True
    assert anna.get("/w/home/label/").context["awaited"] == ""


def test_nothing_is_promised_once_the_job_has_ended(said, sample, anna):
    sample.world.jobs.filter(kind=JobKind.PROPOSE).update(status="failed")
    assert anna.get("/w/home/label/").context["awaited"] == ""
    assert waits(anna, said[0]).context["has_come"] is False


def test_nothing_is_promised_without_a_parser(said, sample, anna):
    sample.world.runs.update(status="failed")
    assert anna.get("/w/home/label/").context["awaited"] == ""
