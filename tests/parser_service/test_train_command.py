"""``manage.py train``: a run in the foreground."""

from __future__ import annotations

import json
from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from parser_service.models import TrainingRun
from tests.parser_service.made_up import make_split


@pytest.fixture
def split(world, transactional_db):
    return make_split(world)


def call(*arguments: str) -> dict:
    out = StringIO()
    call_command("train", *arguments, "--json", stdout=out, stderr=StringIO())
    return json.loads(out.getvalue())


HERE = ("--world", "home", "--split", "home")


def test_it_prints_one_object_with_the_figures(split):
    report = call("knn", *HERE, "--sources", "gen,para", "--seed", "7")
    assert report["status"] == "succeeded"
    assert (report["train_sources"], report["seed"]) == ("gen+para", 7)
    assert len(report["evaluations"]) == 6
    for figures in report["evaluations"]:
        assert 0 <= figures["interval"][0] <= figures["accuracy"] <= figures["interval"][1] <= 1


def test_what_was_trained_already_is_reported_again(split):
    first = call("knn", *HERE)
    assert call("knn", *HERE) == first
    assert TrainingRun.objects.count() == 1


def test_a_hyperparameter_is_read_as_what_it_is(split):
    report = call("knn", *HERE, "--config", "least_overlap=0.5")
    assert report["configuration"] == {"least_overlap": 0.5}


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("knn", "--world", "nowhere", "--split", "home"), "There is no world “nowhere”"),
        (("knn", "--world", "home", "--split", "away"), "There is no split “away” in home"),
        (("knn", *HERE, "--sources", "all"), "--sources is 'all'"),
        (("knn", *HERE, "--config", "least_overlap"), "has to be KEY=VALUE"),
        (("knn", *HERE, "--config", "least_overlap=much"), "has to be of type float"),
        (("knn", *HERE, "--config", "k=2"), "No hyperparameter is called k"),
        (("knn", *HERE, "--protocol", "domain"), "knn has no protocol 'domain'"),
    ],
)
def test_bad_input_is_a_sentence(split, arguments, sentence):
    with pytest.raises(CommandError) as refused:
        call(*arguments)
    assert sentence in str(refused.value)
    assert not TrainingRun.objects.exists()


def test_a_run_that_fails_prints_its_report_and_exits_with_its_reason(split):
    out = StringIO()
    with pytest.raises(CommandError, match="The grammar oracle parses with") as refused:
        call_command("train", "grammar-oracle", *HERE, "--json", stdout=out, stderr=StringIO())
    assert refused.value.returncode == 1
    assert json.loads(out.getvalue())["status"] == "failed"


def test_the_split_is_found_by_its_name_and_criterion(split):
    split.name = "home-logical_form"
    split.criterion = "logical_form"
    split.save()
    report = call("knn", *HERE, "--criterion", "logical_form")
    assert (report["split"], report["criterion"]) == ("home-logical_form", "logical_form")
