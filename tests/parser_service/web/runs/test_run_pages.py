"""Starting, watching and cancelling runs by page."""

from __future__ import annotations

import re
from dataclasses import replace
from datetime import timedelta

import pytest
from django.utils import timezone
from django.utils.html import escape

from annotations.people.rate_limits import STARTED_RUNS
from parser_service.models import RunEvent, TrainingRun, Worker
from parser_service.parsers.interface import EpochReport
from parser_service.parsers.registry import config_fields, parsers
from parser_service.runs import lifecycle, run_requests
from tests.notices import levels
from tests.parser_service.made_up import make_split
from tests.sample_world import scored_run


def defaults(parser, **changes):
    values = {f"config-{each.name}": each.default for each in config_fields(parser)}
    return {**{k: v for k, v in values.items() if v is not False}, **changes}


def form(sample, parser="seq2seq", **changes):
    general = {"split": sample.split.pk, "train_sources": "para", "seed": 7, "seeds": 1}
    general["protocol"] = parsers()[parser].protocols[0]
    return {**general, **defaults(parser, **changes)}


@pytest.mark.parametrize("path", ["", "runs/"])
def test_a_run_in_a_list_leads_to_its_split(path, sample, adam):
    page = adam.get(f"/w/home/{path}").content.decode()
    assert (
        f'href="/w/home/splits/{sample.split.pk}/">{sample.split.name}</a>'
        in page.split("<table", 1)[1]
    )


@pytest.mark.parametrize("parser", parsers())
def test_every_parser_has_a_form_with_its_hyperparameters(parser, sample, adam):
    page = adam.get("/w/home/runs/new/", {"parser": parser})
    shown = page.context["form"]
    declared = config_fields(parser)
    for fields, is_required in ((shown.named, True), (shown.hyperparameters, False)):
        names = [f"config-{each.name}" for each in declared if each.is_required == is_required]
        assert [field.name for field in fields] == names
    for each in config_fields(parser):
        assert each.description in page.content.decode().replace("&#x27;", "'")


def test_an_admin_starts_a_run(sample, adam, admin, no_messages):
    answer = adam.post("/w/home/runs/new/?parser=seq2seq", form(sample, **{"config-epochs": 3}))
    run = TrainingRun.objects.latest("pk")
    assert answer.url == f"/w/home/runs/{run.pk}/"
    assert (run.parser, run.train_sources, run.seed, run.status) == ("seq2seq", "para", 7, "queued")
    assert run.config["epochs"] == 3
    assert run.created_by == admin
    assert run.changed_hyperparameters() == (("epochs", 3),)


def test_the_same_is_trained_once(sample, adam, no_messages):
    first = adam.post("/w/home/runs/new/?parser=seq2seq", form(sample))
    again = adam.post("/w/home/runs/new/?parser=seq2seq", form(sample), follow=True)
    assert again.redirect_chain[-1][0] == first.url
    assert levels(again) == ["info"]
    assert TrainingRun.objects.filter(parser="seq2seq").count() == 1


def test_several_seeds_start_as_one_request_and_are_listed(sample, adam, no_messages):
    asked = {**form(sample), "seeds": 3}
    answer = adam.post("/w/home/runs/new/?parser=seq2seq", asked, follow=True)
    assert levels(answer) == ["info"]
    assert re.findall(r"\d+", str(*answer.context["messages"])) == ["3", "7", "9"]
    assert [run.seed for run in answer.context["listing"].rows] == [9, 8, 7]


def test_seeds_that_were_trained_already_are_listed_with_the_new_ones(sample, adam, no_messages):
    adam.post("/w/home/runs/new/?parser=seq2seq", {**form(sample), "seed": 8})
    asked = {**form(sample), "seeds": 3}
    answer = adam.post("/w/home/runs/new/?parser=seq2seq", asked, follow=True)
    assert re.findall(r"\d+", str(*answer.context["messages"])) == ["2", "7", "9", "1"]
    again = adam.post("/w/home/runs/new/?parser=seq2seq", asked, follow=True)
    assert re.findall(r"\d+", str(*again.context["messages"])) == ["3"]
    assert again.context["listing"].total == TrainingRun.objects.filter(parser="seq2seq").count()


@pytest.mark.parametrize(
    ("changes", "field", "code"),
    [
        ({"config-epochs": 0}, "config-epochs", "min_value"),
        ({"config-dropout": "much"}, "config-dropout", "invalid"),
        ({"config-dropout": "nan"}, "config-dropout", "invalid"),
        ({"split": 999999}, "split", "invalid_choice"),
        ({"train_sources": "all"}, "train_sources", "invalid_choice"),
        ({"protocol": "grammar"}, "protocol", "invalid_choice"),
        ({"seed": -1}, "seed", "min_value"),
        ({"seeds": 0}, "seeds", "min_value"),
        ({"seeds": 11}, "seeds", "max_value"),
        ({"seed": 2**32 - 2, "seeds": 3}, "seeds", None),
    ],
)
def test_what_cannot_be_trained_is_told_beside_its_field(changes, field, code, sample, adam):
    answer = adam.post("/w/home/runs/new/?parser=seq2seq", {**form(sample), **changes})
    errors = answer.context["form"].errors.as_data()
    assert {name: [each.code for each in told] for name, told in errors.items()} == {field: [code]}
    assert escape(errors[field][0].messages[0]) in answer.content.decode()
    assert TrainingRun.objects.count() == 1


def test_a_source_that_the_split_lacks_is_told_in_a_sentence(sample, adam):
    sample.split.examples.filter(source="paraphrased").delete()
    answer = adam.post("/w/home/runs/new/?parser=seq2seq", form(sample))
    (told,) = answer.context["form"].non_field_errors()
    assert "paraphrased" in told and told in answer.content.decode()


def test_a_split_of_another_world_is_no_choice(sample, other_world, adam):
    foreign = make_split(other_world, "foreign")
    answer = adam.post("/w/home/runs/new/?parser=seq2seq", {**form(sample), "split": foreign.pk})
    assert answer.context["form"].has_error("split", "invalid_choice")


def test_there_is_a_limit_to_the_runs_of_an_hour(sample, adam, admin, no_messages):
    for _ in range(STARTED_RUNS.limit):
        STARTED_RUNS.take(str(admin.pk))
    answer = adam.post("/w/home/runs/new/?parser=seq2seq", form(sample))
    (told,) = answer.context["form"].non_field_errors()
    assert f" {STARTED_RUNS.limit} " in told and told in answer.content.decode()


def test_every_seed_counts_towards_the_limit(sample, adam, admin, no_messages):
    key = str(admin.pk)
    for _ in range(STARTED_RUNS.limit - 4):
        STARTED_RUNS.take(key)
    asked = {**form(sample), "seeds": 3}
    adam.post("/w/home/runs/new/?parser=seq2seq", asked)
    assert STARTED_RUNS.left(key) == 1
    answer = adam.post("/w/home/runs/new/?parser=seq2seq", {**asked, "seed": 20})
    (told,) = answer.context["form"].non_field_errors()
    assert re.findall(r"\d+", told) == ["3", "1"] and told in answer.content.decode()
    assert not TrainingRun.objects.filter(seed__gte=20).exists()


def test_a_run_that_waits_asks_for_itself_again(sample, anna):
    run, _ = run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    answer = anna.get(f"/w/home/runs/{run.pk}/")
    page, waiting = answer.content.decode(), answer.context["waiting"]
    assert f'hx-get="/w/home/runs/{run.pk}/state/"' in page
    assert waiting.workers == 0 and waiting.sentence in page
    assert waiting.sentence != replace(waiting, workers=1).sentence


def test_a_queued_run_says_its_place_and_the_likely_times(sample, anna):
    now = timezone.now()
    for minutes in (4, 6, 8):
        earlier = scored_run(sample.world, sample.split, "seq2seq", seed=minutes)
        TrainingRun.objects.filter(pk=earlier.pk).update(
            attempt=1, started_at=now - timedelta(minutes=minutes), finished_at=now
        )
    asked = [
        run_requests.request(sample.world, sample.split, "seq2seq", seed=seed, send=False)[0]
        for seed in (20, 21, 22)
    ]
    TrainingRun.objects.filter(pk=asked[0].pk).update(
        status="running", attempt=1, started_at=now - timedelta(minutes=2), progress=0.25
    )
    Worker.objects.create(name="w", host="h", process_id=1, queue="cpu,gpu")
    answer = anna.get(f"/w/home/runs/{asked[2].pk}/")
    waiting = answer.context["waiting"]
    assert (waiting.ahead, waiting.workers) == (2, 1)
    assert (round(waiting.starts_in / 60), round(waiting.takes / 60)) == (12, 6)
    assert re.findall(r"\d+", waiting.sentence) == ["2", "12", "6"]
    assert waiting.sentence in answer.content.decode()
    assert not anna.get(f"/w/home/runs/{asked[0].pk}/state/").context["waiting"]


def test_a_short_run_has_nothing_ahead_in_its_own_queue(sample, anna):
    run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    short, _ = run_requests.request(sample.world, sample.split, "knn", seed=5, send=False)
    Worker.objects.create(name="w", host="h", process_id=1, queue="cpu,gpu,quick")
    answer = anna.get(f"/w/home/runs/{short.pk}/")
    assert answer.context["waiting"].ahead == 0
    assert answer.context["waiting"].sentence in answer.content.decode()


def test_charts_are_drawn_once_there_is_something_to_draw(sample, anna):
    run, _ = run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    url = f"/w/home/runs/{run.pk}/charts/"
    page = anna.get(f"/w/home/runs/{run.pk}/").content.decode()
    assert "data-chart-url" not in page
    assert f'hx-get="{url}"' in page
    report = EpochReport(1, 2.0, 1.5, 0.5, 1.0)
    lifecycle.record_epoch(lifecycle.claim("w", "cpu", run), report)
    charts = anna.get(url).content.decode()
    assert charts.count("data-chart-url") == 3
    assert "hx-get" not in charts
    short, _ = run_requests.request(sample.world, sample.split, "knn", seed=5, send=False)
    assert "run-charts" not in anna.get(f"/w/home/runs/{short.pk}/").content.decode()


def test_a_run_that_has_ended_does_not(sample, anna):
    page = anna.get(f"/w/home/runs/{sample.run.pk}/state/").content.decode()
    assert "hx-get" not in page


def test_the_state_shows_progress_log_and_failure(sample, anna):
    TrainingRun.objects.filter(pk=sample.run.pk).update(
        status="running", progress=0.42, activity="epoch 3 of 8", failure="The disk is full."
    )
    RunEvent.objects.create(run=sample.run, attempt=1, message="Attempt 1 begins.")
    page = anna.get(f"/w/home/runs/{sample.run.pk}/state/").content.decode()
    for text in ("42 %", "epoch 3 of 8", "Attempt 1 begins.", "The disk is full."):
        assert text in page


def test_only_admins_see_what_only_admins_may_do(sample, anna, adam):
    run, _ = run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    cancel = f'action="/w/home/runs/{run.pk}/cancel/"'
    assert cancel not in anna.get(f"/w/home/runs/{run.pk}/").content.decode()
    assert cancel in adam.get(f"/w/home/runs/{run.pk}/").content.decode()


def test_cancelling_a_run_that_waits_ends_it_at_once(sample, adam):
    run, _ = run_requests.request(sample.world, sample.split, "seq2seq", send=False)
    adam.post(f"/w/home/runs/{run.pk}/cancel/")
    run.refresh_from_db()
    assert run.status == "cancelled"


def test_cancelling_a_run_that_has_ended_is_told(sample, adam):
    answer = adam.post(f"/w/home/runs/{sample.run.pk}/cancel/", follow=True)
    assert levels(answer) == ["warning"] and str(sample.run.pk) in str(*answer.context["messages"])


def test_the_curves_are_what_the_charts_read(sample, anna):
    loss = anna.get(f"/w/home/runs/{sample.run.pk}/curves/?show=loss").json()
    assert loss["done"] is True
    assert loss["x"]["values"] == [1]
    assert [(each["name"], each["values"]) for each in loss["series"]] == [
        ("training", [2.5]),
        ("validation", [2.0]),
    ]
    accuracy = anna.get(f"/w/home/runs/{sample.run.pk}/curves/?show=accuracy").json()
    assert accuracy["series"][0]["values"] == [25.0]
    seconds = anna.get(f"/w/home/runs/{sample.run.pk}/curves/?show=seconds").json()
    assert seconds["series"][0]["values"] == [sample.run.epochs.get().seconds]
    assert seconds["y"]["unit"] == "s"


@pytest.mark.parametrize(
    ("parser", "unit"), [("seq2seq", "nats a token"), ("ranker", "nats an utterance")]
)
def test_the_chart_says_in_what_the_parser_counts_its_loss(parser, unit, sample, anna):
    run, _ = run_requests.request(sample.world, sample.split, parser, send=False)
    lifecycle.record_epoch(lifecycle.claim("w", "cpu", run), EpochReport(1, 2.0, 1.5, 0.5, 1.0))
    assert f", {unit}" in anna.get(f"/w/home/runs/{run.pk}/").content.decode()


def test_the_table_of_runs_costs_no_query_a_run(sample, anna, django_assert_max_num_queries):
    for seed in range(8):
        run_requests.request(sample.world, sample.split, "seq2seq", seed=seed, send=False)
    with django_assert_max_num_queries(9):
        anna.get("/w/home/runs/table/")


def test_runs_are_filtered_and_newest_first(sample, anna):
    scored_run(sample.world, sample.split, "seq2seq")
    rows = anna.get("/w/home/runs/").context["listing"].rows
    assert [run.parser for run in rows] == ["seq2seq", "knn"]
    rows = anna.get("/w/home/runs/", {"parser": "knn"}).context["listing"].rows
    assert [run.parser for run in rows] == ["knn"]


def test_the_figures_of_a_run_lead_to_its_predictions(sample, anna):
    page = anna.get("/w/home/runs/table/").content.decode()
    url = f"/w/home/runs/{sample.run.pk}/predictions/?part=validation&amp;source=generated"
    assert f'href="{url}"' in page


def test_the_seeds_of_a_run_of_another_world_are_not_shown(sample, other_world, anna):
    foreign = scored_run(other_world, make_split(other_world, "foreign"))
    page = anna.get("/w/home/runs/", {"seeds_of": foreign.pk})
    assert page.context["listing"].total == 0


def test_the_list_of_seeds_costs_no_query_a_run(sample, anna, django_assert_max_num_queries):
    asked = run_requests.request_seeds(
        sample.world, sample.split, "seq2seq", seeds=range(9), send=False
    )
    with django_assert_max_num_queries(11):
        page = anna.get("/w/home/runs/table/", {"seeds_of": asked[0][0].pk})
    assert "seed 0" in page.content.decode()
    assert "seed 8" in page.content.decode()
