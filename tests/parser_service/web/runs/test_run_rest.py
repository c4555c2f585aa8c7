"""/api/v1/worlds/<w>/runs/ and what hangs on a run."""

from __future__ import annotations

import pytest

from annotations.people.rate_limits import Rate
from parser_service.models import TrainingRun

HOME = "worlds/home/"


@pytest.fixture(autouse=True)
def nobody_listens(monkeypatch):
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)


@pytest.fixture
def call(call_as, admin):
    """A function: the answer to a request of the admin, with JSON and headers."""
    return lambda method, path, data=None, **headers: call_as(
        admin, method, HOME + path, data, **headers
    )


def test_runs_are_started_once_watched_and_cancelled(call, sample):
    sent = {
        "split": sample.split.pk,
        "parser": "knn",
        "config": {"least_overlap": 0.25},
        "seeds": 2,
    }
    started = call("post", "runs/", sent, idempotency_key="k")
    assert started.status_code == 201, started.json()
    assert started.json()["new"] == 2
    first, second = started.json()["runs"]
    assert (first["seed"], second["seed"], first["status"]) == (0, 1, "queued")
    assert first["config"]["least_overlap"] == 0.25
    assert call("post", "runs/", sent, idempotency_key="k")["Idempotency-Replayed"] == "true"
    again = call("post", "runs/", sent)
    assert (again.status_code, again.json()["new"]) == (200, 0)
    path = f"runs/{first['id']}/"
    assert call("post", f"{path}cancel/").json()["status"] == "cancelled"
    assert call("post", f"{path}cancel/").status_code == 409
    (line,) = call("get", f"{path}log/").json()["results"]
    assert "ancel" in line["message"]
    listed = call("get", "runs/?status=queued").json()["results"]
    assert [row["id"] for row in listed] == [second["id"]]


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"config": {"moon": 1}}, "config.moon"),
        ({"config": {"least_overlap": 7}}, "config.least_overlap"),
        ({"parser": "none"}, "parser"),
        ({"split": 10**6}, "split"),
    ],
)
def test_what_cannot_be_trained_is_refused(change, field, call, sample):
    sent = {"split": sample.split.pk, "parser": "knn", **change}
    answer = call("post", "runs/", sent)
    assert answer.status_code == 400
    assert answer.json()["problems"][0]["field"] == field
    assert TrainingRun.objects.count() == 1


def test_too_many_within_the_hour_are_refused(call, sample, monkeypatch):
    monkeypatch.setattr("parser_service.runs.starting.STARTED_RUNS", Rate("few", 0, 60))
    sent = {"split": sample.split.pk, "parser": "knn", "seed": 7}
    assert call("post", "runs/", sent).status_code == 429


def test_what_a_run_answers(call, sample):
    path = f"runs/{sample.run.pk}/"
    wrong = call("get", f"{path}predictions/?outcome=wrong").json()["results"]
    assert wrong
    assert not any(row["is_exact_match"] or row["is_cut"] for row in wrong)
    sample.run.predictions.filter(pk=wrong[0]["id"]).update(is_cut=True)
    listed = call("get", f"{path}predictions/?outcome=wrong").json()["results"]
    assert [row["is_cut"] for row in listed].count(True) == 1
    assert call("get", f"{path}predictions/?outcome=late").status_code == 400
    (score,) = call("get", f"evaluations/?run={sample.run.pk}").json()["results"]
    assert score["correct"] == 3
    for measure in ("equivalent", "same_plan"):
        low, high = score[f"{measure}_interval"]
        assert 0 <= low < score[measure] < high < 1
    sample.run.evaluations.update(same_plan=None, outcomes={})
    (score,) = call("get", f"evaluations/?run={sample.run.pk}").json()["results"]
    assert score["same_plan"] is score["same_plan_interval"] is None
    assert len(score["equivalent_interval"]) == 2
    (epoch,) = call("get", f"{path}curves/").json()["results"]
    assert epoch["train_loss"] == 2.5
    assert call("get", f"{path}candidates/?rank=1&limit=3").json()["next"]
    assert call("get", "results/").json()["world"] == "home"


def test_an_answer_is_reviewed(call, sample, admin):
    wrong = sample.run.predictions.best().filter(is_exact_match=False).first()
    path = f"runs/{sample.run.pk}/examples/{wrong.example_id}/"
    read = call("get", f"{path}review/")
    assert read.json() == {"own": None}
    code = call("get", "error-categories/").json()["results"][0]["code"]
    sent = {"category": code, "note": "why?"}
    tagged = call("patch", f"{path}review/", sent, if_match=read["ETag"])
    assert (tagged.json()["own"]["category"], tagged.json()["own"]["note"]) == (code, "why?")
    stale = call("patch", f"{path}review/", {"category": None}, if_match=read["ETag"])
    assert (stale.status_code, stale.json()["current"]) == (412, tagged.json())
    (listed,) = call("get", f"reviews/?category={code}").json()["results"]
    assert listed["reviewer"] == admin.username
    back = call("patch", f"{path}review/", {"category": None, "note": ""}, if_match="*")
    assert back.json() == {"own": None}
    refused = call("patch", f"{path}review/", {"accept": True}, if_match="*")
    assert "no proposal" in refused.json()["detail"]
    assert "said" in call("post", f"{path}doubt/", {"reason": "odd"}).json()


def test_slices_and_error_categories(call, sample):
    made = call("post", "slices/", {"name": "wrong", "query": "outcome=wrong"})
    assert made.status_code == 201, made.json()
    path = f"slices/{made.json()['id']}/"
    assert call("patch", path, {"name": "bad"}, if_match='"x"').status_code == 412
    assert call("patch", path, {"name": "bad"}, if_match=made["ETag"]).json()["name"] == "bad"
    assert call("post", "slices/", {"name": "all", "query": ""}).status_code == 400
    new = {"name": "Odd", "slice": made.json()["id"]}
    odd = call("post", "error-categories/", new)
    assert (odd.status_code, odd.json()["slice"]) == (201, made.json()["id"])
    of_odd = f"error-categories/{odd.json()['id']}/"
    assert call("post", "error-categories/", new).status_code == 409
    changed = call("patch", of_odd, {"description": "Odd ones."}, if_match=odd["ETag"])
    assert (changed.json()["name"], changed.json()["description"]) == ("Odd", "Odd ones.")
    moved = call("post", f"{of_odd}move/", {"step": -1}).json()
    assert moved["position"] == odd.json()["position"] - 1
    assert call("delete", of_odd, if_match="*").status_code == 204
    assert call("delete", path, if_match="*").status_code == 204


def test_a_run_is_analysed_its_curve_trained_and_its_answers_sent(call, sample):
    path = f"runs/{sample.run.pk}/"
    job = call("post", f"{path}analysis/")
    assert (job.status_code, job.json()["kind"]) == (202, "analyse")
    assert call("post", f"{path}analysis/").json()["id"] == job.json()["id"]
    curve = call("post", f"{path}learning-curve/", {"seeds": 1})
    shares = [run["train_share"] for run in curve.json()["runs"]]
    assert (curve.status_code, shares) == (201, [0.1, 0.25, 0.5])
    assert call("post", f"{path}learning-curve/", {}).json() == {"new": 0, "runs": []}
    queued = call("get", f"runs/{curve.json()['runs'][0]['id']}/").json()["id"]
    assert call("post", f"runs/{queued}/analysis/").status_code == 409
    sent = call("post", f"{path}predictions/send/?outcome=wrong", {"reason": "odd"})
    assert sent.json()["queued"] > 0, sent.json()
    assert call("post", f"{path}predictions/send/", {"reason": ""}).status_code == 400


def test_what_another_world_has_is_not_named_in_a_body(call, sample, other_sample):
    wrong = sample.run.predictions.best().filter(is_exact_match=False).first()
    answer = f"runs/{sample.run.pk}/examples/"
    elsewhere = {
        "runs/": {"split": other_sample.split.pk, "parser": "knn"},
        "error-categories/": {"name": "Odd", "slice": slice_in(other_sample).pk},
    }
    for path, sent in elsewhere.items():
        assert call("post", path, sent).status_code == 400, path
    of_others = f"{answer}{other_sample.example.pk}/"
    assert call("get", f"{of_others}review/").status_code == 404
    assert call("post", f"{of_others}doubt/", {"reason": "odd"}).status_code == 404
    name = other_sample.world.error_categories.create(code="theirs", name="x", position=1).code
    sent = {"category": name}
    own = f"{answer}{wrong.example_id}/review/"
    assert call("patch", own, sent, if_match="*").status_code == 400
    predictions = f"runs/{sample.run.pk}/predictions/"
    assert call("get", f"{predictions}?slice={slice_in(other_sample).pk}").status_code == 400
    first = call("get", "error-categories/").json()["results"][0]["id"]
    theirs = other_sample.world.error_categories.get().pk
    moved = call("delete", f"error-categories/{first}/?move_to={theirs}", if_match="*")
    assert moved.status_code == 400


def slice_in(sample):
    return sample.world.slices.get_or_create(name="theirs", query="outcome=wrong")[0]
