"""``manage.py train``: a run in the foreground."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from io import StringIO

import pytest
from django.conf import settings as site
from django.core.management import CommandError, call_command
from django.utils import timezone

from annotations.models import Split
from parser_service.models import TrainingRun
from parser_service.runs import lifecycle, run_requests
from tests.parser_service.made_up import LONG, make_split
from tests.parser_service.worker_process import ROOT, database_url, wait_for_epochs
from tests.waiting import PATIENCE_SECONDS, wait_for

UNREADABLE = "hyperparameter_unreadable"


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
        for share, name in (
            ("accuracy", "interval"),
            ("equivalent", "equivalent_interval"),
            ("same_plan", "same_plan_interval"),
        ):
            low, high = figures[name]
            assert 0 <= low <= figures[share] <= high <= 1


def test_what_was_trained_already_is_reported_again(split):
    first = call("knn", *HERE)
    assert call("knn", *HERE) == first
    assert TrainingRun.objects.count() == 1


def test_a_hyperparameter_is_read_as_what_it_is(split):
    report = call("knn", *HERE, "--config", "least_overlap=0.5")
    assert report["configuration"] == {"least_overlap": 0.5}


@pytest.mark.parametrize(
    ("arguments", "code", "named"),
    [
        (("knn", "--world", "nowhere", "--split", "home"), None, "“nowhere”"),
        (("knn", "--world", "home", "--split", "away"), None, "“away”.*: home"),
        (("knn", *HERE, "--seeds", "11"), "seeds_out_of_range", r"\b11\b.*\b10\b"),
        (("knn", *HERE, "--sources", "all"), "sources_unreadable", "--sources.*'all'"),
        (("knn", *HERE, "--config", "least_overlap"), UNREADABLE, "KEY=VALUE"),
        (("knn", *HERE, "--config", "least_overlap=much"), UNREADABLE, "float"),
        (("knn", *HERE, "--config", "k=2"), "unknown_hyperparameter", r"\bk\b"),
        (("knn", *HERE, "--protocol", "domain"), "unknown_protocol", "knn.*'domain'"),
    ],
)
def test_bad_input_is_told_by_a_code_and_its_name(split, arguments, code, named):
    with pytest.raises(CommandError, match=named) as refused:
        call(*arguments)
    assert getattr(refused.value.__cause__, "code", None) == code
    assert not TrainingRun.objects.exists()


def test_a_run_that_fails_prints_its_report_and_exits_with_its_reason(split):
    out = StringIO()
    with pytest.raises(CommandError) as refused:
        call_command("train", "grammar-oracle", *HERE, "--json", stdout=out, stderr=StringIO())
    assert refused.value.returncode == 1
    assert "grammar" in split.runs.get().failure == str(refused.value)
    assert json.loads(out.getvalue())["status"] == "failed"


def test_the_split_is_found_by_its_name_and_criterion(split):
    split.name = "home-logical_form"
    split.criterion = "logical_form"
    split.save()
    report = call("knn", *HERE, "--criterion", "logical_form")
    assert (report["split"], report["criterion"]) == ("home-logical_form", "logical_form")


def test_several_seeds_report_each_run_and_mean_and_spread(split):
    report = call("knn", *HERE, "--sources", "gen,para", "--seed", "7", "--seeds", "2")
    assert report["seeds"] == [7, 8]
    assert [run["status"] for run in report["runs"]] == ["succeeded", "succeeded"]
    assert len(report["means"]) == len(report["runs"][0]["evaluations"])
    for each, *figures in zip(
        report["means"], *(run["evaluations"] for run in report["runs"]), strict=True
    ):
        # knn draws nothing, so that its seeds agree.
        assert each["mean"] == pytest.approx(figures[0]["accuracy"])
        assert (each["spread"], each["n_seeds"]) == (pytest.approx(0), 2)
        assert each["test_source"] == figures[0]["test_source"]
    assert call("knn", *HERE, "--sources", "gen,para", "--seed", "8") == report["runs"][1]


def test_mean_and_spread_are_printed_for_a_person(split):
    out = StringIO()
    call_command("train", "knn", *HERE, "--seeds", "2", stdout=out, stderr=StringIO())
    assert re.search(r" ± [1-9][0-9.]* % over 2 seeds, standard deviation 0\.0\n", out.getvalue())


def test_by_form_the_harmonic_mean_is_reported(split):
    Split.objects.update(criterion="logical_form")
    report = call("knn", *HERE, "--sources", "gen,para")
    assert report["harmonic_means"]
    for each in report["harmonic_means"]:
        unseen, known = each["unseen"], each["known"]
        expected = 2 * unseen * known / (unseen + known) if unseen and known else 0
        assert each["harmonic_mean"] == pytest.approx(expected)
        low, high = each["interval"]
        assert low <= each["harmonic_mean"] <= high


def test_seeds_that_fail_are_reported_together(split):
    out = StringIO()
    with pytest.raises(CommandError) as refused:
        call_command(
            "train",
            "grammar-oracle",
            *HERE,
            "--seeds",
            "2",
            "--json",
            stdout=out,
            stderr=StringIO(),
        )
    report = json.loads(out.getvalue())
    assert [run["status"] for run in report["runs"]] == ["failed", "failed"]
    assert report["means"] == []
    assert all(run.failure in str(refused.value) for run in split.runs.all())


@pytest.mark.processes
def test_ctrl_c_cancels_the_run(split):
    options = [f"{name}={value}" for name, value in LONG.items()]
    command = ["manage.py", "train", "seq2seq", *HERE, "--sources", "gen", "--config", *options]
    process = subprocess.Popen(
        [sys.executable, *command],
        cwd=ROOT,
        env={**os.environ, "DATABASE_URL": database_url(), "GPSR_VAR_DIR": str(site.VAR_DIR)},
        stderr=subprocess.PIPE,
        text=True,
    )
    wait_for(TrainingRun.objects.exists, "the run is asked for")
    run = TrainingRun.objects.get()
    wait_for_epochs(run, 1)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=PATIENCE_SECONDS)
    run.refresh_from_db()
    assert (process.returncode, run.status) == (1, "cancelled")
    assert "Epoch 1: loss" in told
    assert f"Run {run.pk} was cancelled." in told
    assert "Traceback" not in told


def test_a_run_whose_worker_is_gone_is_finished_here(split):
    run, _ = run_requests.request(split.world, split, "knn", train_sources="gen+para", send=False)
    lifecycle.claim("cpu-1@elsewhere", run.queue, run)
    TrainingRun.objects.update(lease_until=timezone.now())
    assert call("knn", *HERE)["attempts"] == 2


def test_a_share_of_the_pairs_is_enough(split):
    report = call("knn", *HERE, "--share", "0.25")
    whole = call("knn", *HERE)
    assert (report["train_share"], whole["train_share"]) == (0.25, 1.0)
    assert 0 < report["train_pairs"] < whole["train_pairs"] == 48


def test_a_share_of_nothing_is_refused(split):
    with pytest.raises(CommandError, match=r"\b0 .*\b0\.01\b.*\b1\b") as refused:
        call("knn", *HERE, "--share", "0")
    assert refused.value.__cause__.code == "share_out_of_range"
