"""The form that starts a run: which parsers it offers, and which choices it keeps."""

from __future__ import annotations

import re
from html import unescape
from urllib.parse import parse_qs, urlsplit

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from parser_service.models import Evaluation, TrainingRun
from parser_service.parsers import pretrained_files
from parser_service.parsers.registry import parsers
from parser_service.runs import run_requests
from parser_service.runs.recommended import advise
from parser_service.web.runs.new_run_pages import picker_of
from tests.parser_service.made_up import make_split
from tests.parser_service.web.runs.forms_of_pages import PageForm

NEW = "/w/home/runs/new/"


def words_of(page) -> str:
    """The text of a page as a browser shows it: with single spaces."""
    return " ".join(page.content.decode().split())


@pytest.fixture
def second_split(sample):
    return make_split(sample.world, "second")


def options_of(world, split=None):
    return {each.name: each for each in picker_of(world, split, advise(world, split)).options}


def test_every_parser_is_offered_once_with_a_sentence(sample):
    picker = picker_of(sample.world, sample.split, advise(sample.world, sample.split))
    assert sorted(each.name for each in picker.options) == sorted(parsers())
    assert not picker.recommended.gaps and not any(each.gaps for each in picker.able)
    assert all(each.gaps for each in picker.lacking)
    for entry in parsers().values():
        assert entry.in_short.endswith("."), entry.title


def test_a_parser_that_lacks_weights_is_folded_away_and_says_what_to_do(
    sample, adam, tmp_path, monkeypatch
):
    monkeypatch.setattr(pretrained_files, "_encoders", tmp_path)
    gaps = options_of(sample.world)["seq2seq-glove-elmo"].gaps
    assert [gap.name for gap in gaps] == ["glove.6B.100d.txt", "elmo"]
    page = unescape(adam.get(NEW).content.decode())
    folded = page.partition('<details class="parser-group">')[2].partition("</details>")[0]
    assert all(gap.sentence in folded for gap in gaps)
    assert page.count('id="parser-seq2seq-glove-elmo"') == 1
    page = adam.get(NEW, {"parser": "seq2seq-glove-elmo"}).content.decode()
    assert '<details class="parser-group" open>' in page


def test_the_page_says_what_the_split_holds(sample, second_split, adam):
    page = adam.get(NEW, {"split": second_split.pk})
    contents = page.context["picker"].contents
    assert contents.split == second_split
    assert contents.by_source == [("generated commands", 24), ("paraphrases", 24)]
    assert (contents.validation, contents.test) == (12, 12)
    assert "24 generated commands and 24 paraphrases to train on" in words_of(page)


def test_a_parser_says_how_long_it_took_and_how_well_it_did_here(sample, other_sample, adam):
    TrainingRun.objects.filter(pk=sample.run.pk).update(seconds_trained=90)
    TrainingRun.objects.filter(pk=other_sample.run.pk).update(seconds_trained=5000)
    Evaluation.objects.filter(run=other_sample.run).update(accuracy=1)
    option = options_of(sample.world, sample.split)["knn"]
    ((source, score),) = option.scores
    assert (option.seconds, source, score.accuracy) == (90, "generated commands", 0.25)
    page = words_of(adam.get(NEW))
    assert re.search(r"about 1 min 30 s · validation (<[^>]+>)?generated commands 25\.0", page)
    assert options_of(sample.world, sample.split)["seq2seq"].seconds is None


def test_a_split_is_looked_at_once_for_the_whole_form(sample, django_assert_num_queries):
    """Two queries for what has been trained, two for times and accuracies, none for the examples of the split."""
    with django_assert_num_queries(2):
        advice = advise(sample.world, sample.split)
    with django_assert_num_queries(2):
        picker_of(sample.world, sample.split, advice)


def test_the_form_asks_nothing_twice(sample, adam):
    adam.get(NEW)
    with CaptureQueriesContext(connection) as queries:
        adam.get(NEW)
    asked = [each["sql"] for each in queries]
    assert not [sql for sql in asked if "annotations_example" in sql]
    twice = {sql for sql in asked if asked.count(sql) > 1}
    assert all('FROM "annotations_split"' in sql for sql in twice)  # the list of the field is one


def test_figures_of_here_stand_instead_of_what_to_expect(sample, second_split, adam):
    """A page that says both says two things of one parser."""
    for split, is_expected in ((sample.split, False), (second_split, True)):
        page = words_of(adam.get(NEW, {"split": split.pk}))
        card = page.partition('id="parser-knn"')[2].partition("</label>")[0]
        assert ("Expect" in card) == is_expected


def test_the_page_says_how_much_of_validation_training_does_not_have(sample, adam):
    contents = adam.get(NEW).context["picker"].contents
    validation = sample.split.examples.filter(part="validation")
    train = sample.split.examples.filter(part="train").values("logical_form")
    assert contents.of_new_forms == validation.exclude(logical_form__in=train).count() > 0


def test_choices_survive_a_change_of_parser_without_scripts(sample, second_split, adam):
    made = {
        "parser": "ranker",
        "split": second_split.pk,
        "train_sources": "gen+para",
        "protocol": "strict",
        "seed": 42,
        "seeds": 3,
        "config-epochs": 7,
    }
    answer = adam.post(f"{NEW}?parser=seq2seq", made)
    assert not TrainingRun.objects.filter(seed=42).exists()
    asked = parse_qs(urlsplit(answer.url).query)
    assert asked["parser"] == ["ranker"] and "config-epochs" not in asked
    values = PageForm(adam.get(answer.url).content.decode()).values
    for name in ("split", "train_sources", "protocol", "seed", "seeds"):
        assert values[name] == str(made[name]), name


def test_showing_the_settings_again_keeps_changed_hyperparameters(sample, adam):
    made = {"parser": "seq2seq", "choose": "1", "config-epochs": 7, "config-dropout": "0.1"}
    answer = adam.post(f"{NEW}?parser=seq2seq", made)
    assert "config-epochs=7" in answer.url and "dropout" not in answer.url
    page = adam.get(answer.url)
    assert page.context["form"].changed == ["Epochs"]
    assert '<details class="advanced" open>' in page.content.decode()


def test_hyperparameters_are_folded_away_at_their_defaults(sample, adam):
    answer = adam.get(NEW, {"parser": "seq2seq"})
    form, page = answer.context["form"], words_of(answer)
    assert '<details class="advanced">' in page
    assert (len(form.hyperparameters), form.changed) == (11, [])
    assert "11 hyperparameters" in page
    assert all(f" {default}." in page for default in ("0.1", "150"))


def test_what_has_to_be_named_is_not_folded_away(sample, adam):
    page = adam.get(NEW, {"parser": "llm"}).content.decode()
    folded = page.partition('<details class="advanced">')[2].partition("</details>")[0]
    assert 'name="config-decoding"' in folded and "5 hyperparameters" in " ".join(folded.split())
    assert 'name="config-model"' in page and 'name="config-model"' not in folded
    assert "Default: none" not in page


def test_a_parser_that_asks_a_server_says_that_it_has_none(sample, adam):
    page = adam.get(NEW, {"parser": "llm"}).content.decode()
    assert page.count("GPSR_LLM_URL") > 1
    made = {**PageForm(page).values, "config-model": "tiny"}
    answer = adam.post(f"{NEW}?parser=llm", made)
    (told,) = answer.context["form"].non_field_errors()
    assert "GPSR_LLM_URL" in told and told in unescape(answer.content.decode())
    assert not TrainingRun.objects.filter(parser="llm").exists()


@pytest.mark.parametrize("parser", parsers())
def test_no_form_opens_with_changed_hyperparameters(parser, sample, adam):
    assert adam.get(NEW, {"parser": parser}).context["form"].changed == []


def test_a_wrong_hyperparameter_is_not_folded_away(sample, adam):
    made = {"config-epochs": "0", "split": sample.split.pk}
    page = adam.post(f"{NEW}?parser=seq2seq", made).content.decode()
    assert '<details class="advanced" open>' in page


def test_a_run_is_asked_for_again_with_its_own_values(sample, second_split, adam):
    run, _ = run_requests.request(
        sample.world,
        second_split,
        "ranker",
        config={"steps": 12, "label_smoothing": 0.2},
        protocol="domain",
        train_sources="gen+para",
        seed=9,
        send=False,
    )
    TrainingRun.objects.filter(pk=run.pk).update(status="failed")
    page = adam.get(f"/w/home/runs/{run.pk}/").content.decode()
    assert f'href="{NEW}?like={run.pk}"' in page
    page = adam.get(NEW, {"like": run.pk})
    form, values = page.context["form"], PageForm(page.content.decode()).values
    assert (form.parser, form.changed) == ("ranker", ["Steps", "Label smoothing"])
    assert (values["split"], values["train_sources"]) == (str(second_split.pk), "gen+para")
    assert (values["protocol"], values["seed"]) == ("domain", "9")


def test_a_run_of_another_world_is_not_copied(sample, other_sample, adam):
    form = adam.get(NEW, {"like": other_sample.run.pk}).context["form"]
    assert form.initial["split"] == sample.split.pk


@pytest.mark.parametrize("like", ["x", "-1", "9" * 30, "²", ""])
def test_a_wrong_number_of_a_run_is_ignored(like, sample, adam):
    assert adam.get(NEW, {"like": like, "split": like}).status_code == 200


def test_a_protocol_that_the_parser_lacks_is_told(sample, adam):
    answer = adam.get(NEW, {"parser": "seq2seq", "protocol": "domain"})
    note = answer.context["note"]
    assert "domain" in note and "strict" in note and note in answer.content.decode()
    assert PageForm(answer.content.decode()).values["protocol"] == "strict"


def test_words_of_the_form(sample, adam):
    page = adam.get(NEW, {"parser": "knn"}).content.decode()
    assert "Minimum overlap" in page
    assert "One run per seed, counting up." in page
    assert "Pairs per step." in adam.get(NEW, {"parser": "seq2seq"}).content.decode()
