"""Runs that answer beside each other on Parse."""

from __future__ import annotations

import re

from annotations.models import Job
from parser_service.models import Tryout
from parser_service.reviews.tryout_answers import MOST_TEXT, answer_jobs
from parser_service.runs.promoting import promote
from parser_service.templatetags.provenance import cut_in_words
from parser_service.web.serving.beside_pages import TriedAnswer
from tests.annotations.conftest import import_tiny
from tests.parser_service.live_server import parse_server  # noqa: F401
from tests.parser_service.reviews.analyses.conftest import done, home, train_one  # noqa: F401
from tests.parser_service.reviews.analyses.made_parsers import DEFAULT
from tests.parser_service.served import make_home, trained_run
from tests.sample_world import scored_run


def ask_for(client, text: str, *runs: object, path: str = ""):
    return client.post(f"/w/home/parse/beside/{path}", {"text": text, "beside": list(runs)})


def test_nothing_is_chosen_until_it_is_asked_for(sample, anna):
    page = anna.get("/w/home/parse/")
    assert not page.context["is_beside"] and 'id="beside"' not in page.content.decode()
    usual = anna.get("/w/home/parse/?beside=usual")
    assert usual.context["chosen_beside"] == [sample.run]


def test_an_old_address_leads_to_the_same_runs(sample, anna):
    example = sample.example.pk
    answer = anna.get(f"/w/home/try/?run=3&run=4&text=bring+it&example={example}")
    assert answer["Location"] == f"/w/home/parse/?text=bring+it&example={example}&beside=3&beside=4"
    assert anna.get("/w/home/try/")["Location"] == "/w/home/parse/?beside=usual"


def test_without_a_trained_parser_the_page_says_so(world, anna, adam):
    import_tiny(world)
    for client, is_offered in ((anna, False), (adam, True)):
        page = client.get("/w/home/parse/?beside=usual").content.decode()
        assert '<div class="empty">' in page
        assert ("/runs/new/" in page) is is_offered


def test_the_url_names_runs_and_text(sample, anna):
    other = scored_run(sample.world, sample.split, seed=1)
    page = anna.get("/w/home/parse/", {"beside": [other.pk, "x", "-1"], "text": "bring <it>"})
    assert page.context["chosen_beside"] == [other]
    assert 'value="bring &lt;it&gt;"' in page.content.decode()


def test_an_example_gives_its_text(sample, anna, other_sample):
    page = anna.get("/w/home/parse/", {"example": sample.example.pk})
    assert page.context["text"] == sample.example.utterance
    for odd in (other_sample.example.pk, "x", "9" * 30, "²"):
        assert "example" not in anna.get("/w/home/parse/", {"example": odd}).context


def test_a_text_is_asked_and_the_address_follows(sample, anna):
    answer = ask_for(anna, "  bring   it\0 ", sample.run.pk)
    assert not answer.context["tryout"].is_answered
    assert "every 500ms" in answer.content.decode() and 'role="alert"' in answer.content.decode()
    assert answer["HX-Replace-Url"] == f"/w/home/parse/?text=bring+it&beside={sample.run.pk}"
    assert answer_jobs(sample.world).count() == 1


def test_typing_makes_no_further_jobs(sample, anna, annotator):
    for length in range(1, 9):
        ask_for(anna, "bring it"[:length], sample.run.pk)
    assert answer_jobs(sample.world).count() == 1
    assert Tryout.objects.get(person=annotator).text == "bring it"


def test_what_is_missing_is_said(sample, anna):
    answers = [ask_for(anna, "", sample.run.pk), ask_for(anna, "bring")]
    assert [each.context["tryout"] for each in answers] == [None, None]
    without_text, without_run = (
        re.search('<p class="quiet">(.+?)</p>', each.content.decode())[1] for each in answers
    )
    assert without_text != without_run
    assert not Job.objects.exists()


def test_that_a_run_read_only_the_beginning_is_said(sample, anna, annotator):
    run = sample.run
    answers = {str(run.pk): {"answers": [{"form": DEFAULT, "score": 0.5, "is_cut": True}]}}
    Tryout.objects.create(
        world=sample.world, person=annotator, text="go", runs=[run.pk], answers=answers
    )
    page = anna.post("/w/home/parse/beside/?waiting", {"text": "go", "beside": run.pk})
    (answered,) = page.context["answers"]
    assert answered.is_cut and page.content.decode().count(cut_in_words(run.parser)) == 2


def test_a_long_text_is_cut_and_a_run_of_another_world_is_not_asked(sample, other_sample, anna):
    ask_for(anna, "x" * 10_000, sample.run.pk, other_sample.run.pk)
    row = Tryout.objects.get()
    assert (len(row.text), row.runs) == (MOST_TEXT, [sample.run.pk])


def test_the_answers_come_when_a_worker_has_them(train_one, anna, settings):  # noqa: F811
    settings.WORK_TEMPO = 10_000
    run = train_one("always-one")
    Job.objects.all().delete()
    ask_for(anna, "bring it", run.pk)
    done(answer_jobs(run.world).get())
    page = ask_for(anna, "", path="?waiting")
    assert page.context["tryout"].is_answered and "every 500ms" not in page.content.decode()
    assert Tryout.objects.get().answers[str(run.pk)]["answers"][0]["form"] == DEFAULT


def test_whoever_waits_gets_a_new_job_where_the_last_is_gone(sample, anna):
    ask_for(anna, "bring it", sample.run.pk)
    Job.objects.all().delete()
    ask_for(anna, "", path="?waiting")
    assert answer_jobs(sample.world).count() == 1
    assert Tryout.objects.get().text == "bring it"


def test_what_somebody_types_is_no_script(sample, anna):
    text = "<script>alert(1)</script>"
    assert text not in ask_for(anna, text, sample.run.pk).content.decode()
    assert (
        text not in anna.get("/w/home/parse/", {"text": text, "beside": "usual"}).content.decode()
    )


def test_the_parse_server_answers_where_there_is_one(world, anna, parse_server):  # noqa: F811
    run = trained_run(make_home(world))
    promote(run, None)
    parse_server.update()
    page = ask_for(anna, "find the bowl", run.pk)
    assert page.context["tryout"].is_answered and "every 500ms" not in page.content.decode()
    assert Tryout.objects.get().answers[str(run.pk)]["answers"][0]["form"].startswith("( find")
    assert not Job.objects.filter(kind="answer").exists()


def test_further_candidates_that_are_no_forms_are_counted_and_not_listed(sample):
    form = '( go " <room> " )'
    answers = [{"form": each, "score": 0.1} for each in (form, "( go", form)]
    tried = TriedAnswer(sample.run, answers, "", None)
    assert [each["number"] for each in tried.further] == [3]
    assert tried.n_malformed == 1
