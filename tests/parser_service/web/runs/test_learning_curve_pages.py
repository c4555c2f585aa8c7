"""The page of learning curves and the button that starts their runs."""

from __future__ import annotations

import re

import pytest

from annotations.people.rate_limits import STARTED_RUNS
from parser_service.models import TrainingRun
from parser_service.results.learning_curves import curves_url
from parser_service.runs.learning_curve import SHARES
from tests.notices import levels
from tests.parser_service.made_up import make_split
from tests.sample_world import scored_run

pytestmark = pytest.mark.usefixtures("no_messages")
PAGE = "/w/home/results/curves/"


def on_share(sample, share: float, right: int, pairs: int, **columns) -> TrainingRun:
    """Store a run of knn on a share of the training pairs that has ``right`` answers right."""
    run = scored_run(sample.world, sample.split, "knn", right, seed=TrainingRun.objects.count())
    TrainingRun.objects.filter(pk=run.pk).update(
        **{"train_share": share, "train_pairs": pairs, "seed": 0, **columns}
    )
    return run


@pytest.fixture
def curve(sample):
    """Three of the four runs of a learning curve of knn."""
    TrainingRun.objects.update(train_pairs=24)
    on_share(sample, 0.1, 1, 3)
    on_share(sample, 0.5, 2, 12)
    return sample


def test_the_points_are_pairs_accuracy_and_interval(curve, anna):
    data = anna.get(PAGE + "data/").json()
    (series,) = data["series"]
    assert series["name"] == "Nearest neighbour"
    assert [point[0] for point in series["points"]] == [3, 12, 24]
    assert [round(point[1], 1) for point in series["points"]] == [8.3, 16.7, 25.0]
    assert all(low <= 60 and high == 60 for _, _, low, high in series["points"])
    assert (data["kind"], data["done"]) == ("points", True)


def test_the_table_says_the_same_and_has_a_place_for_what_is_missing(curve, anna, adam):
    page = anna.get(PAGE).content.decode()
    for text in ("8.3", "16.7", "25.0", "3 pairs", "24 pairs", "10 % of the pairs"):
        assert text in page
    for offered in ("1 seed: 1 run missing", "3 seeds: 9 runs missing", "5 seeds: 17 runs missing"):
        assert offered not in page
        assert offered in adam.get(PAGE).content.decode()


def test_several_seeds_are_one_point(curve, anna):
    on_share(curve, 0.5, 4, 14, seed=7)
    (series,) = anna.get(PAGE + "data/").json()["series"]
    pairs, percent, low, high = series["points"][1]
    assert (pairs, round(percent, 1)) == (13, 25.0)
    assert (round(low, 1), round(high, 1)) == (0.0, 54.2)  # over seeds and clusters


def test_other_versions_protocols_and_sources_are_left_out(curve, anna):
    on_share(curve, 0.25, 4, 6, parser_version=0)
    on_share(curve, 0.3, 4, 6, protocol="domain")
    on_share(curve, 0.35, 4, 6, train_sources="gen+para")
    query = {"protocol": "strict", "setting": "gen-gen"}
    (series,) = anna.get(PAGE + "data/", query).json()["series"]
    assert [point[0] for point in series["points"]] == [3, 12, 24]


def test_one_button_starts_the_missing_runs_and_shows_the_curves(sample, adam):
    answer = adam.post(f"/w/home/runs/{sample.run.pk}/learning-curve/", {"test": "para"})
    assert answer["Location"] == curves_url(sample.world, sample.run, "para")
    runs = TrainingRun.objects.order_by("train_share")
    assert [run.train_share for run in runs] == list(SHARES)
    assert {str(run.created_by) for run in runs if run.train_share < 1} == {"adam"}
    page = adam.get(answer["Location"])
    assert levels(page) == ["info"] and " 3 " in str(*page.context["messages"])
    assert page.context["shown"].is_active
    adam.post(f"/w/home/runs/{sample.run.pk}/learning-curve/")
    assert TrainingRun.objects.count() == 4


def test_several_seeds_are_started_at_once(sample, adam):
    address = f"/w/home/runs/{sample.run.pk}/learning-curve/"
    answer = adam.post(address, {"seeds": "3"}, follow=True)
    assert " 11 " in str(*answer.context["messages"])
    assert "3 seeds:" not in answer.content.decode()
    assert sorted(set(TrainingRun.objects.values_list("seed", flat=True))) == [0, 1, 2]
    for odd in ("0", "6", "-1", "x", "²", "9" * 30, ""):
        again = adam.post(address, {"seeds": odd}, follow=True)
        assert levels(again) == ["info"] and TrainingRun.objects.count() == 12


def test_more_runs_than_somebody_may_start_are_refused(sample, adam, monkeypatch):
    monkeypatch.setattr(type(STARTED_RUNS), "left", lambda self, key: 2)
    answer = adam.post(f"/w/home/runs/{sample.run.pk}/learning-curve/", follow=True)
    assert levels(answer) == ["error"]
    assert re.findall(r"\d+", str(*answer.context["messages"])) == ["3", "2"]
    assert TrainingRun.objects.count() == 1


def test_what_the_address_misspells_is_that_of_the_newest_run(curve, anna):
    odd = {"split": "no", "setting": "x", "protocol": "y", "part": "z", "measure": "?"}
    choices = anna.get(PAGE, odd).context["choices"]
    assert (choices.split, str(choices.setting)) == (curve.split, "gen-gen")
    assert (choices.protocol, choices.part, choices.measure) == ("strict", "validation", "exact")


def test_the_part_is_one_on_which_the_split_was_tested(curve, anna):
    other = make_split(curve.world, "tested")
    run = scored_run(curve.world, other, "seq2seq", 3)
    run.evaluations.update(part="test")
    assert anna.get(PAGE, {"split": "tested"}).context["choices"].part == "test"
    assert anna.get(PAGE, {"split": curve.split.name}).context["choices"].part == "validation"


def test_a_column_without_runs_says_so(sample, anna):
    page = anna.get(PAGE, {"setting": "para-para"})
    assert not page.context["shown"].curves and "home-split" in page.content.decode()


def test_a_world_without_runs_says_what_would_be_there(world, anna, adam):
    start = 'href="/w/home/runs/new/'
    assert start not in anna.get(PAGE).content.decode()
    assert start in adam.get(PAGE).content.decode()
    assert anna.get(PAGE + "data/").json() == {"series": [], "done": True}


def test_the_page_costs_no_query_a_run(curve, anna, django_assert_max_num_queries):
    for number, share in enumerate((0.2, 0.3, 0.4, 0.6)):
        on_share(curve, share, number, 5 + number)
    with django_assert_max_num_queries(18):
        anna.get(PAGE)


def test_runs_and_their_pages_say_that_they_learned_from_a_share(curve, anna):
    run = TrainingRun.objects.get(train_share=0.1)
    page = " ".join(anna.get(f"/w/home/runs/{run.pk}/").content.decode().split())
    assert "10 % of gen" in page and "3, 10 % " in page
    assert "10 %</span>" in anna.get("/w/home/runs/").content.decode()
    assert "10 % of gen of home-split" in anna.get("/w/home/parse/?beside=usual").content.decode()
